"""The command `singimpact`: one file a command, loaded when it is called.

Not here: anything a Python caller could want too (`impact_oscillator`), nor tables and documents (`documents`).
Files: `group` (the list of commands, refusals), `model` (the options that name an oscillator), `output` (-o, --json),
`columns` (rows of text), `pictures` (picture files), `followed` (orbits and their branches), `steep` (tables of
`bench states --family steep`).
Commands on a model: `map`, `orbit`, `section`, `lyapunov`, `chatter`, `threshold`, `sweep`, `basins`, `bifurcation`,
`branch`, `border`, `events`, `classify`, `explore`, `scene`, `selftest`, `certify`, `fixed_points`; on the paper:
`verify`, `claims`, `errata`, `derive`, `figure`; on the package: `bench`, `stress`, `cite`.
"""

from singimpact.cli.group import main as main
from singimpact.handed_on import names_of

_FILES = {
    "border": "told",
    "certify": "EVENTS",
    "events": "on_curve",
    "group": "COMMANDS main",
}
__getattr__ = names_of(__name__, _FILES)
