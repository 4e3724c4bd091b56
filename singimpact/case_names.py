"""Names in the code of a function, and which modules are installed packages.

Not here: the key of what is named (`case_keys`).
"""

import builtins
import decimal
import dis
import os
import pkgutil
import site
import sys
import sysconfig
import types
from collections import Counter, OrderedDict, defaultdict, deque
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import Any

PACKAGE = __name__.partition(".")[0]
LOADS = {"LOAD_GLOBAL", "LOAD_NAME", "LOAD_FROM_DICT_OR_GLOBALS"}
ATTRIBUTES = {"LOAD_ATTR", "LOAD_METHOD"}
BETWEEN = {"EXTENDED_ARG", "CACHE", "NOP", "PUSH_NULL"}
"""Instructions that may stand between a name and its attribute."""
LOGS = (list, set, dict, deque, bytearray, Counter, OrderedDict, defaultdict)
WRITES = {"append", "appendleft", "add", "extend", "extendleft", "insert", "clear"}
"""Methods of these that return None: a function that only calls them does not depend on the content."""
UNSEEN = (
    globals,
    locals,
    eval,
    exec,
    __import__,
    pkgutil.resolve_name("importlib:import_module"),
    sys.modules,
    sys._getframe,
    os.environ,
    os.getenv,
)
"""Through these a function reaches values that its code does not name."""
REACHING = {"__globals__", "f_globals", "f_locals", "f_builtins"}
"""Attributes that do."""
MISSING = object()
Chain = tuple[str, ...]


def chains(code: types.CodeType) -> set[Chain]:
    """Global names that a code and the codes inside it load, each with the attributes that follow it.

    Examples
    --------
    >>> sorted(chains(compile("units.scale(v) + len(v)", "<example>", "eval")))
    [('len',), ('units', 'scale'), ('v',)]
    """
    names: set[Chain] = set()
    chain: Chain = ()
    for step in dis.get_instructions(code):
        if step.opname in BETWEEN:
            continue
        if chain and step.opname in ATTRIBUTES:
            chain = (*chain, step.argval)
            continue
        if chain:
            names.add(chain)
        chain = (step.argval,) if step.opname in LOADS else ()
    return names.union(*(chains(constant) for constant in code.co_consts if isinstance(constant, types.CodeType)))


def attribute_names(code: types.CodeType) -> set[str]:
    """The global and attribute names of a code and the codes inside it.

    Examples
    --------
    >>> sorted(attribute_names(compile("h.__globals__['k']", "<example>", "eval")))
    ['__globals__', 'h']
    """
    inside = (attribute_names(part) for part in code.co_consts if isinstance(part, types.CodeType))
    return set(code.co_names).union(*inside)


def imports(code: types.CodeType, package: str) -> set[tuple[str, str]]:
    """Modules that a code and the codes inside it import: (module, name taken from it, "" for the module itself)."""
    pairs: set[tuple[str, str]] = set()
    level, module = 0, ""
    constants: list[Any] = []
    for step in dis.get_instructions(code):
        if step.opname in BETWEEN:
            continue
        if step.opname == "IMPORT_NAME":
            level = next((constant for constant in constants[-2:] if isinstance(constant, int)), 0)
            module = _absolute(step.argval, level, package)
            pairs.add((module, ""))
        elif step.opname == "IMPORT_FROM" and module:
            pairs.discard((module, ""))
            pairs.add((module, step.argval))
        elif not step.opname.startswith("STORE"):
            module = ""
        constants.append(step.argval)
    return pairs.union(*(imports(inner, package) for inner in code.co_consts if isinstance(inner, types.CodeType)))


def _absolute(name: str, level: int, package: str) -> str:
    if not level:
        return name
    base = package.rsplit(".", level - 1)[0]
    return f"{base}.{name}" if name else base


def followed(chain: Chain, space: dict[str, Any]) -> tuple[Any, Chain, bool]:
    """The value that a chain of names begins with, after modules that are not installed packages.

    Returns
    -------
    (value, the attributes that are left, whether it belongs to an installed package); `MISSING` is the value of a name
    that is not bound.
    """
    value = space.get(chain[0], MISSING)
    library = value is MISSING
    if library:
        value = getattr(builtins, chain[0], MISSING)
    rest = chain[1:]
    while isinstance(value, types.ModuleType) and rest:
        library = is_installed(value.__name__)
        if library and not any(vars(value).get(rest[0], MISSING) is prefix for prefix in UNSEEN):
            return value, rest, True
        value, rest = getattr(value, rest[0], MISSING), rest[1:]
    return value, rest, library


def is_written_only(value: Any, rest: Chain) -> bool:
    """Whether a function uses a global container only to write into it, as a log of its calls."""
    return type(value) in LOGS and bool(rest) and rest[0] in WRITES


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
    for module in (name, top):
        file = _file(sys.modules.get(module))
        if file is not None:
            return _is_library(file)
    return top in sys.builtin_module_names or top in sys.stdlib_module_names


def _file(module: Any) -> str | None:
    file = getattr(module, "__file__", None)
    if isinstance(file, str):
        return file
    folders: Iterator[Any] = iter(getattr(module, "__path__", ()))
    folder = next(folders, None)
    return os.path.join(folder, "") if isinstance(folder, str) else None


@lru_cache(maxsize=4096)
def _is_library(file: str) -> bool:
    path = Path(os.path.abspath(file))
    if {"site-packages", "dist-packages"} & set(path.parts):
        return True
    return any(path.is_relative_to(root) for root in _library_folders())


@lru_cache(maxsize=1)
def _library_folders() -> tuple[str, ...]:
    paths = sysconfig.get_paths()
    roots = [paths[key] for key in ("stdlib", "platstdlib", "purelib", "platlib")]
    roots += [*getattr(site, "getsitepackages", list)(), site.getusersitepackages()]
    return tuple({place for root in roots for place in (os.path.abspath(root), os.path.realpath(root))})


def precision_of(module: str) -> str:
    """The digits at which a package computes, where a program sets them for all of it; "" of other packages.

    Examples
    --------
    >>> precision_of("numpy")
    ''
    """
    match module.partition(".")[0]:
        case "mpmath":
            contexts = [getattr(sys.modules.get("mpmath"), name, None) for name in ("mp", "iv")]
            return " ".join(str(getattr(context, "prec", "")) for context in contexts)
        case "decimal" | "_decimal" | "_pydecimal":
            context = decimal.getcontext()
            return " ".join(str(getattr(context, name)) for name in ("prec", "rounding", "Emin", "Emax", "clamp"))
    return ""


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
    for name in (module, module.partition(".")[0]):
        for key, held in vars(sys.modules[name]).items() if name in sys.modules else ():
            if held is value:
                return f"{name}.{key}"
    return None
