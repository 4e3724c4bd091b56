"""The command `singimpact`: one file a command, loaded when it is called.

Not here: anything a Python caller could want too (`impact_oscillator`), nor tables and documents (`documents`).
"""

from singimpact.cli.group import main as main
from singimpact.handed_on import names_of

_FILES = {
    "border_command": "as_listed",
    "certify_command": "EVENTS",
    "events_command": "on_curve",
    "group": "COMMANDS main",
}
__getattr__ = names_of(__name__, _FILES)
