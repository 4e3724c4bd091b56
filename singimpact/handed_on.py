"""Names that a room hands on, each loaded from its file when it is first used, and functions as methods (`Study`).

So are `flint` and `sympy`: a session in doubles needs neither, and they take 20 ms and 0.3 s to load.

A room's own files import one another by file; whoever stands outside (the public names, the tests) asks the room.
"""

import re
from collections.abc import Callable, Mapping
from functools import lru_cache
from importlib import import_module
from pathlib import Path
from types import MethodType
from typing import TYPE_CHECKING, Any

__all__ = ["Study", "flint", "homes_in", "names_of", "public", "sympy"]

_LISTED = re.compile(r"^from (\S+) import (?:\(([^)]*)\)|(.*))$", re.MULTILINE)


class _OnDemand:
    """A module that is loaded when one of its names is first used; later uses find the name in the instance."""

    def __init__(self, name: str) -> None:
        self._module = name

    def __getattr__(self, name: str) -> Any:
        value = self.__dict__[name] = getattr(import_module(self._module), name)
        return value


if TYPE_CHECKING:
    import flint
    import sympy
else:
    flint, sympy = _OnDemand("flint"), _OnDemand("sympy")


def homes_in(stub: Path) -> dict[str, str]:
    """Name -> the module that has it, as a stub `__init__.pyi` imports it."""
    return {
        name: home
        for home, *lists in _LISTED.findall(stub.read_text(encoding="utf-8"))
        for name in re.findall(r"\b(\w+) as \1\b", " ".join(lists))
    }


def names_of(room: str, files: Mapping[str, str] | None = None) -> Callable[[str], Any]:
    """The `__getattr__` of a room: the stub beside it has its names; or `files` those of files, divided by blanks.

    A value is looked up in its file each time, so a test that replaces it there replaces it here.
    """

    @lru_cache(maxsize=1)
    def homes() -> Mapping[str, str]:
        if files is None:
            return homes_in(Path(__file__).parent.joinpath(*room.split(".")[1:], "__init__.pyi"))
        return {name: f"{room}.{file}" for file, names in files.items() for name in names.split()}

    def value_of(name: str) -> Any:
        if name in homes():
            return getattr(import_module(homes()[name]), name)
        raise AttributeError(f"module {room!r} has no attribute {name!r}")

    return value_of


Function = Callable[..., Any]


def public(name: str) -> Function:
    """The function of `singimpact` of a name."""
    return getattr(import_module("singimpact"), name)  # type: ignore[no-any-return]


class Study:
    """A function of `singimpact` as a method: `osc.basins(...)` is `si.basins(osc, ...)`, and has its documentation.

    Examples
    --------
    >>> import singimpact as si
    >>> si.ImpactOscillator.lyapunov is si.lyapunov
    True
    """

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    def __get__(self, thing: object, kind: type) -> Function:
        return public(self.name) if thing is None else MethodType(public(self.name), thing)
