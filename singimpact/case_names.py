"""Names in the code of a function, and which modules are installed packages.

Not here: the key of what is named (`case_keys`).
"""

import builtins
import decimal
import dis
import os
import site
import sys
import sysconfig
import types
from collections.abc import Iterator, Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

PACKAGE = __name__.partition(".")[0]
LOADS = {"LOAD_GLOBAL", "LOAD_NAME", "LOAD_FROM_DICT_OR_GLOBALS"}
ATTRIBUTES = {"LOAD_ATTR", "LOAD_METHOD"}
# Instructions that may stand between a name and its attribute
BETWEEN = {"EXTENDED_ARG", "CACHE", "NOP", "PUSH_NULL"}
MISSING = object()
Chain = tuple[str, ...]


def codes(code: types.CodeType) -> Iterator[types.CodeType]:
    """A code and the codes inside it."""
    yield code
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield from codes(constant)


def _steps(code: types.CodeType) -> list[dis.Instruction]:
    return [step for each in codes(code) for step in dis.get_instructions(each) if step.opname not in BETWEEN]


def chains(code: types.CodeType) -> set[Chain]:
    """Global names that a code and the codes inside it load, each with the attributes that follow it.

    Examples
    --------
    >>> sorted(chains(compile("units.scale(v) + len(v)", "<example>", "eval")))
    [('len',), ('units', 'scale'), ('v',)]
    """
    names: set[Chain] = {()}
    chain: Chain = ()
    for step in _steps(code):  # each code ends with an instruction that loads nothing
        if chain and step.opname in ATTRIBUTES:
            chain = (*chain, step.argval)
        else:
            names.add(chain)
            chain = (step.argval,) if step.opname in LOADS else ()
    return names - {()}


def imports(code: types.CodeType) -> set[tuple[str, str]]:
    """Modules that a code and the codes inside it import: (module, name taken from it, "" for the module itself).

    Examples
    --------
    >>> sorted(imports(compile("import math\\nfrom .units import R", "<example>", "exec")))
    [('.units', 'R'), ('math', '')]
    """
    steps = _steps(code)
    return {
        ("." * level.argval + step.argval, name)
        for level, names, step in zip(steps, steps[1:], steps[2:], strict=False)
        if step.opname == "IMPORT_NAME"
        for name in names.argval or ("",)
    }


def followed(chain: Chain, space: Mapping[str, Any]) -> tuple[Any, list[str], list[types.ModuleType]]:
    """The value that a chain of names leads to through modules.

    Returns
    -------
    (value, the attributes that are left, the modules); `MISSING` is the value of a name that is not bound.
    """
    first, *rest = chain
    modules = [] if first in space else [builtins]
    value = space[first] if first in space else getattr(builtins, first, MISSING)
    while rest and isinstance(value, types.ModuleType):
        modules.append(value)
        value = getattr(value, rest.pop(0), MISSING)
    return value, rest, modules


def is_installed(name: Any) -> bool:
    """Whether a module of this name belongs to Python, to this package or to an installed package.

    Examples
    --------
    >>> is_installed("numpy.linalg"), is_installed("json"), is_installed("__main__")
    (True, True, False)
    """
    if not isinstance(name, str) or name == "__main__":
        return False
    top = name.partition(".")[0]
    if top == PACKAGE:
        return True
    for module in map(sys.modules.get, (name, top)):
        for file in (getattr(module, "__file__", None), *(getattr(module, "__path__", None) or ())):
            if isinstance(file, str):
                return _is_library(file)
    return top in sys.builtin_module_names or top in sys.stdlib_module_names


@lru_cache(maxsize=4096)
def _is_library(file: str) -> bool:
    path = Path(os.path.abspath(file))
    if {"site-packages", "dist-packages"} & set(path.parts):
        return True
    return any(path.is_relative_to(root) for root in _library_folders())


@lru_cache(maxsize=1)
def _library_folders() -> set[str]:
    paths = sysconfig.get_paths()
    roots = [paths[key] for key in ("stdlib", "platstdlib", "purelib", "platlib")]
    roots += [*getattr(site, "getsitepackages", list)(), site.getusersitepackages()]
    return {*map(os.path.abspath, roots), *map(os.path.realpath, roots)}


def version_of(module: str) -> str:
    """The version of the package of a module, and the digits at which it computes, where a program sets them.

    Examples
    --------
    >>> version_of("math"), version_of("json") != version_of("decimal")
    ('', True)
    """
    top = module.partition(".")[0]
    numbers = [getattr(sys.modules.get(top), "__version__", "")]
    if top == "mpmath":
        numbers += [getattr(getattr(sys.modules.get(top), name, None), "prec", "") for name in ("mp", "iv")]
    if top in ("decimal", "_decimal", "_pydecimal"):
        numbers += [getattr(decimal.getcontext(), name) for name in ("prec", "rounding", "Emin", "Emax", "clamp")]
    return " ".join(map(str, numbers))


def is_found_by_name(value: Any) -> bool:
    """Whether the module and the qualified name of a function or a class lead back to it."""
    target: Any = sys.modules.get(getattr(value, "__module__", None) or "")
    for name in getattr(value, "__qualname__", "?").split("."):
        target = getattr(target, name, MISSING)
    return target is value


def name_in_library(value: Any) -> str | None:
    """The name of an object that an installed package holds, such as `mpmath.mp`; None for any other object."""
    module = type(value).__module__
    if module == "builtins" or not is_installed(module):
        return None
    holders = [name for name in (module, module.partition(".")[0]) if name in sys.modules]
    return next(
        (f"{name}.{key}" for name in holders for key, held in vars(sys.modules[name]).items() if held is value), None
    )
