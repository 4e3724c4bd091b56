"""The key of stored results: a function with everything that it names, its cases, and the version of the package.

One walk visits the code of the function, its defaults and closure, the globals that its code names, and what these are
made of: numbers, containers, objects, classes with all their attributes, modules that are not installed packages.
The name and version of an installed package stand for its code; its numbers, and Python functions that were put in the
place of its own, are part of the key. What has no key is refused, because results of another function must not be
returned in silence.

Not here: reading and writing results (`cases`).  Files that a function reads and the state of random generators are
not part of the key.
"""

import builtins
import copyreg
import decimal
import dis
import functools
import hashlib
import os
import pkgutil
import site
import sys
import sysconfig
import types
from collections import Counter, OrderedDict, defaultdict, deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from operator import methodcaller
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from singimpact.inputs import InputError, shown

PACKAGE = __name__.partition(".")[0]
LOADS = {"LOAD_GLOBAL", "LOAD_NAME", "LOAD_FROM_DICT_OR_GLOBALS"}
ATTRIBUTES = {"LOAD_ATTR", "LOAD_METHOD"}
# Instructions that may stand between a name and its attribute
BETWEEN = {"EXTENDED_ARG", "CACHE", "NOP", "PUSH_NULL"}
MISSING = object()
Chain = tuple[str, ...]
DEEPEST = 100  # containers, functions and classes inside one another; Python's stack ends at 300
PLAIN = {type(None), bool, int, float, complex, str, bytes}
WAY_OUT = "leave output= out, or give a function that names numbers, text, arrays, dataclasses and functions of modules"
IN_C = ("__module__", "__qualname__", "__self__", "__objclass__")  # a name stands for the code
# Attributes that an object is made of, where they are not what pickle builds it from
HOLDERS: dict[type, tuple[str, ...]] = {
    functools.partial: ("func", "args", "keywords"),
    functools.cached_property: ("func",),
    functools._lru_cache_wrapper: ("__wrapped__", "cache_parameters"),
    staticmethod: ("__func__",),
    classmethod: ("__func__",),
    property: ("fget", "fset", "fdel"),
    types.MethodType: ("__func__", "__self__"),
    types.CellType: ("cell_contents",),
    types.CodeType: ("co_code", "co_exceptiontable", "co_names", "co_varnames", "co_freevars", "co_flags", "co_consts"),
    types.BuiltinFunctionType: IN_C,
    types.MethodDescriptorType: IN_C,
    types.WrapperDescriptorType: IN_C,
    types.MethodWrapperType: IN_C,
    types.ClassMethodDescriptorType: IN_C,
    types.GetSetDescriptorType: IN_C,
    types.MemberDescriptorType: IN_C,
}
# Attributes of classes that decide nothing, or that repeat others
_NOT_OF_CLASSES = (
    "__abstractmethods__ __annotate__ __annotate_func__ __annotations__ __annotations_cache__ "
    "__dataclass_fields__ __dataclass_params__ __dict__ __doc__ __firstlineno__ __module__ __orig_bases__ "
    "__parameters__ __slotnames__ __static_attributes__ __type_params__ __weakref__ _abc_impl"
)
NOT_OF_CLASSES = set(_NOT_OF_CLASSES.split())
_NOT_OF_MODULES = "__annotations__ __builtins__ __cached__ __doc__ __file__ __loader__ __path__ __spec__"
NOT_OF_MODULES = set(_NOT_OF_MODULES.split())
LOGS = (list, set, dict, deque, bytearray, Counter, OrderedDict, defaultdict)
# Methods of these that return None: a function that only calls them does not depend on the content
WRITES = {"append", "appendleft", "add", "extend", "extendleft", "insert", "clear"}
# Through these a function reaches values that its code does not name
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
# Attributes that do
REACHING = {"__globals__", "f_globals", "f_locals", "f_builtins"}


def function_key(function: Callable[[Any], Any]) -> str:
    """The digest of a function with everything that it names, and of the version of the package.

    Raises
    ------
    InputError : something that it names has no lasting text, such as an open file or a lock.

    Examples
    --------
    >>> def times(n):
    ...     return lambda x: n * x
    >>> function_key(times(2)) == function_key(times(2)), function_key(times(2)) == function_key(times(3))
    (True, False)
    """
    return hashlib.sha256(_Walk().digest([version_of(PACKAGE), function])).hexdigest()


def cases_key(cases: Sequence[Any]) -> str:
    """The digest of consecutive cases.

    Raises
    ------
    InputError : something in them has no lasting text, as an open file or a lock.

    Examples
    --------
    >>> cases_key([1.0, 2.0]) == cases_key([1.0, 2.0]), cases_key([1, 2]) == cases_key([1.0, 2.0])
    (True, False)
    """
    # whether two cases share an object is no difference
    digests = [_plain(case) if type(case) in PLAIN else _Walk().digest(case) for case in cases]
    return hashlib.sha256(b"".join(digests)).hexdigest()


def _plain(value: Any) -> bytes:
    """The bytes of a number or a text, with their kind and length, so that no two lists of values have the same."""
    content = value if type(value) is bytes else repr(value).encode("utf-8", "surrogatepass")
    return b"%b %d %b" % (type(value).__name__.encode(), len(content), content)


class _Parts(NamedTuple):
    """The text and the values that a value is made of; names of the values, where they have some."""

    text: str
    values: Sequence[Any] = ()
    names: Sequence[str] = ()


def _by_name(text: str, items: Mapping[str, Any]) -> _Parts:
    """Values by name; their order is no difference."""
    names = sorted(items)
    return _Parts(text, [items[name] for name in names], names)


@dataclass
class _Walk:
    """Digests of values: each is made of a text and of the digests of the values that it is made of.

    An object that is met again has the digest of its first visit; one that contains itself has its depth there.
    """

    visited: dict[int, tuple[Any, bytes]] = field(default_factory=dict)  # an object that is held keeps its number
    names: list[str] = field(default_factory=list)  # by which the walk came here, for refusals

    def digest(self, value: Any, name: str = "") -> bytes:
        """The digest of any value; `name` is its name in the value that it belongs to."""
        if type(value) in PLAIN:
            return _plain(value)
        if id(value) in self.visited:
            return self.visited[id(value)][1]
        self.names.append(name)
        if len(self.names) > DEEPEST:
            raise self._refused(type(value).__name__, "it is nested too deep")
        self.visited[id(value)] = value, b"around %d" % len(self.names)
        parts = value if isinstance(value, _Parts) else self._parts(value)
        content = hashlib.sha256(_plain(f"{parts.text} {len(parts.values)} {parts.names}"))
        for inner, label in zip(parts.values, parts.names or [""] * len(parts.values), strict=True):
            content.update(self.digest(inner, label))
        self.names.pop()
        self.visited[id(value)] = value, content.digest()
        return content.digest()

    def _alone(self, value: Any) -> bytes:
        """The digest of a value whatever is visited beside it."""
        return _Walk(dict(self.visited), list(self.names)).digest(value)

    def _refused(self, value: Any, reason: str) -> InputError:
        names = list(filter(None, self.names))[-3:]
        name = f" ({'.'.join(names)})" if names else ""
        return InputError(f"{shown(value)}{name} has no key for stored results, {reason}: {WAY_OUT}")

    def _parts(self, value: Any) -> _Parts:
        kind = type(value)
        text = _name(kind)
        if kind in (list, tuple):
            return _Parts(text, value)
        if kind in (dict, types.MappingProxyType):
            return _Parts(text, [item for pair in value.items() for item in pair])
        if kind in (set, frozenset):
            return _Parts(text, sorted(map(self._alone, value)))
        if kind is np.ndarray or (isinstance(value, np.generic) and kind.__module__ == "numpy"):
            content = value.tolist() if value.dtype.kind in "OVT" else value.tobytes()
            return _Parts(f"{text} {value.dtype!r} {value.shape}", [content])
        if isinstance(value, types.ModuleType):
            return _module(value)
        if isinstance(value, type):
            return _class(value)
        if kind is types.FunctionType:
            return self._function(value)
        if kind is types.CellType and value == types.CellType():
            return _Parts("not bound yet")
        holder = next((base for base in kind.__mro__ if base in HOLDERS), None)
        if holder is not None:
            return _Parts(text, [getattr(value, name, None) for name in HOLDERS[holder]])
        if is_installed(kind.__module__) and isinstance(getattr(value, "py_func", None), types.FunctionType):
            return _Parts(text, [value.py_func, getattr(value, "targetoptions", None)])  # numba adds a random number
        return self._object(value)

    # ---- code

    def _function(self, function: types.FunctionType) -> _Parts:
        space, code, text = function.__globals__, function.__code__, f"function {_name(function)}"
        library = is_installed(space.get("__name__"))
        # `functools.wraps` gives what a library made of a function the module of this function
        if library and is_installed(function.__module__) and is_found_by_name(function):
            return _Parts(text, [version_of(function.__module__)])
        registry = vars(function).get("registry")
        if library and isinstance(registry, types.MappingProxyType):
            return _Parts(text, [registry])  # of singledispatch: the rest of it repeats this, or is a cache
        attributes = _by_name("attributes", vars(function))
        own = [code, function.__defaults__, function.__kwdefaults__, function.__closure__, attributes]
        if library:  # a version stands for the names of a package
            return _Parts(text, own)
        if names := REACHING.intersection(*(inner.co_names for inner in codes(code))):
            raise self._refused(function, f"{min(names)} reaches what the code does not name")
        named = {".".join(chain): self._global(chain, space) for chain in chains(code)}
        package = space.get("__package__") or str(space.get("__name__", "")).rpartition(".")[0]
        taken = {f"{module}:{name}": self._imported(module, name, package) for module, name in imports(code)}
        return _Parts(text, [*own, _by_name("globals", named), _by_name("imports", taken)])

    def _global(self, chain: Chain, space: Mapping[str, Any]) -> _Parts:
        """A global name with the attributes that follow it."""
        value, rest, modules = followed(chain, space)
        if any(value is unseen for unseen in UNSEEN):
            raise self._refused(".".join(chain), "it reaches what the code does not name")
        name = None if isinstance(value, type) else name_in_library(value)
        if value is MISSING:
            value = _Parts("not bound")
        elif modules and is_installed(modules[-1].__name__):
            # numbers, and functions that a program has put in there, count with their values
            if type(value) not in PLAIN and not _is_put_in(value) and not is_found_by_name(value):
                value = _Parts(f"library {_name(value)}")
        elif type(value) in LOGS and rest and rest[0] in WRITES:
            value = _Parts("written only")
        elif name is not None:
            value = _Parts(f"library {name}", [version_of(name)])
        return _Parts("through", [*(module for module in modules if is_installed(module.__name__)), value])

    def _imported(self, module: str, name: str, package: str) -> _Parts:
        """A module that a function imports when it is called."""
        name_of_module = module.lstrip(".")
        if name_of_module != module:  # relative to the package
            base = package.rsplit(".", len(module) - len(name_of_module) - 1)[0]
            module = f"{base}.{name_of_module}".strip(".")
        if is_installed(module) and not name:
            return _Parts("version", [version_of(module)])
        try:
            value = pkgutil.resolve_name(module)
        except (ImportError, ValueError, AttributeError):
            return _Parts("not bound")
        return self._global(("module", name) if name else ("module",), {"module": value})

    # ---- data

    def _object(self, value: Any) -> _Parts:
        """An object: the values that pickle builds it from."""
        kind = type(value)
        modules = list(sys.modules.values()) if isinstance(value, np.ufunc) else ()
        if modules and not any(vars(module).get(value.__name__) is value for module in modules):
            raise self._refused(value, "it hides a Python function")
        reduced: Callable[[Any], Any] = copyreg.dispatch_table.get(kind, methodcaller("__reduce_ex__", 2))
        try:
            parts = reduced(value)
        except Exception as error:
            raise self._refused(value, str(error)) from None
        if isinstance(parts, str):
            return _Parts(f"global {parts}", [kind])
        function, arguments, state, items, pairs, *rest = (*parts, None, None, None)[: max(5, len(parts))]
        dropped = _by_name("dropped", self._dropped(value, state))
        state = {} if state is None else state  # of an object whose attributes are not computed yet
        if isinstance(state, dict) and all(isinstance(name, str) for name in state):
            state = _by_name("state", {name: state[name] for name in state if not _is_cached(kind, name)})
        # iterators of the elements of lists and dicts
        return _Parts("object", [kind, function, arguments, dropped, state, [*(items or ())], [*(pairs or ())], rest])

    def _dropped(self, value: Any, state: Any) -> dict[str, bytes]:
        """Attributes that an object of a program leaves out when it is pickled; locks and files are no data."""
        digests: dict[str, bytes] = {}
        if is_installed(type(value).__module__):
            return digests
        slots = copyreg._slotnames(type(value))  # type: ignore[attr-defined]
        held = getattr(value, "__dict__", {}) | {name: getattr(value, name) for name in slots if hasattr(value, name)}
        states = [piece for piece in (state if isinstance(state, tuple) else (state,)) if isinstance(piece, dict)]
        for name in set(held).difference(*states):
            if not _is_cached(type(value), name):
                with suppress(InputError):
                    digests[name] = self._alone(held[name])
        return digests


def _module(module: types.ModuleType) -> _Parts:
    """An installed package by its name, any other module by all its values, or by its file if it is written in C."""
    text, file = f"module {module.__name__}", str(getattr(module, "__file__", None))
    if is_installed(module.__name__):
        return _Parts(text, [version_of(module.__name__)])
    if file.endswith((".so", ".pyd")):
        return _Parts(text, [Path(file).read_bytes()])
    return _by_name(text, {name: value for name, value in vars(module).items() if name not in NOT_OF_MODULES})


def _class(kind: type) -> _Parts:
    text = f"class {_name(kind)}"
    if is_installed(kind.__module__) and is_found_by_name(kind):
        put_in = {name: member for name, member in vars(kind).items() if _is_put_in(member)}
        return _Parts(text, [version_of(kind.__module__), _by_name("put in", put_in)])
    members = {name: member for name, member in vars(kind).items() if name not in NOT_OF_CLASSES}
    return _Parts(text, [*kind.__bases__, type(kind), _by_name("members", members)])


def _is_put_in(value: Any) -> bool:
    """Whether a Python function or class of no installed package stands where a package has its own."""
    if isinstance(value, types.FunctionType) and not is_installed(value.__globals__.get("__name__")):
        return True
    return isinstance(value, types.FunctionType | type) and not is_installed(value.__module__)


def _is_cached(kind: type, name: str) -> bool:
    """Whether an attribute of an object only repeats what is computed from its others."""
    return any(isinstance(vars(each).get(name), functools.cached_property) for each in kind.__mro__)


def _name(value: Any) -> str:
    return f"{getattr(value, '__module__', '')}.{getattr(value, '__qualname__', getattr(value, '__name__', '?'))}"


# ---- names in the code of a function, and which modules are installed packages


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


@functools.lru_cache(maxsize=4096)
def _is_library(file: str) -> bool:
    path = Path(os.path.abspath(file))
    if {"site-packages", "dist-packages"} & set(path.parts):
        return True
    return any(path.is_relative_to(root) for root in _library_folders())


@functools.lru_cache(maxsize=1)
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
