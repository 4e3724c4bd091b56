"""Names that `cli` hands on, with their homes: `__init__.py` loads each from here when it is used."""

from singimpact.cli.branch_commands import EVENTS as EVENTS, as_listed as as_listed, on_curve as on_curve
from singimpact.cli.group import COMMANDS as COMMANDS, main as main
