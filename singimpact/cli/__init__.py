"""The command `singimpact`: one file a command, loaded when it is called.

Not here: anything a Python caller could want too (`impact_oscillator`), nor tables and documents (`documents`).
Files: `group` (the list of commands, refusals), `model` (the options that name an oscillator), `output` (-o, --json).
"""

from singimpact.cli.group import main as main
