"""Impact oscillators x'' + f(x, x') = g(t), x >= c: simulation, periodic orbits, and exact theory near grazes.

Everything public is reached from here; a name loads its room when it is first used. `__init__.pyi` has the list.
"""

from importlib import import_module
from pathlib import Path
from typing import Any

from singimpact.handed_on import homes_in

__version__ = "1.3.0"

_HOMES = homes_in(Path(__file__).with_suffix(".pyi"))
"""Public name -> the module that has it."""
_ROOMS = {"claims": "singimpact.paper.claims", "models": "singimpact.models", "theory": "singimpact.theory"}
"""Modules that are used like a collection."""
__all__ = sorted({*_ROOMS, *_HOMES})


def __getattr__(name: str) -> Any:
    if name in _ROOMS:
        return import_module(_ROOMS[name])
    if name in _HOMES:
        value = globals()[name] = getattr(__import__(_HOMES[name], fromlist=[name]), name)
        return value
    raise AttributeError(_no_such(name))


def _no_such(name: str) -> str:
    if name.startswith("__"):
        return f"module 'singimpact' has no attribute {name!r}"
    from singimpact.inputs import nearest

    near = nearest(name, __all__)
    hint = f"the nearest known are {', '.join(near)}" if near else "dir(singimpact) lists what it has"
    return f"module 'singimpact' has no attribute {name!r}: {hint}"


def __dir__() -> list[str]:
    return __all__
