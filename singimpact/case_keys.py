"""The key of stored results: a function with everything that it names, its cases, and the version of the package.

One walk visits the code of the function, its defaults and closure, the globals that its code names, and what these are
made of: numbers, containers, objects, classes with all their attributes, modules that are not installed packages.
The name and version of an installed package stand for its code; its numbers, and Python functions that were put in the
place of its own, are part of the key. What has no key is refused, because results of another function must not be
returned in silence.

Not here: which names a code has (`case_names`), reading and writing results (`cases`).  Files that a function reads and
the state of random generators are not part of the key.
"""

import copyreg
import functools
import hashlib
import os
import pkgutil
import sys
import types
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from singimpact.case_names import (
    MISSING,
    REACHING,
    UNSEEN,
    Chain,
    attribute_names,
    chains,
    followed,
    imports,
    is_found_by_name,
    is_installed,
    is_written_only,
    name_in_library,
    precision_of,
)
from singimpact.inputs import InputError, shown

DEEPEST = 100  # containers, functions and classes inside one another; Python's stack ends at 200
PLAIN = {int, float, str, bool}
WAY_OUT = "leave output= out, or give a function that names numbers, text, arrays, dataclasses and functions of modules"
METHODS = (
    types.BuiltinFunctionType,
    types.MethodDescriptorType,
    types.WrapperDescriptorType,
    types.MethodWrapperType,
    types.ClassMethodDescriptorType,
    types.GetSetDescriptorType,
    types.MemberDescriptorType,
)
"""Written in C: a name stands for the code."""
OF_CLASSES = {
    "__abstractmethods__",
    "__annotate__",
    "__annotate_func__",
    "__annotations__",
    "__annotations_cache__",
    "__dataclass_fields__",
    "__dataclass_params__",
    "__dict__",
    "__doc__",
    "__firstlineno__",
    "__module__",
    "__orig_bases__",
    "__parameters__",
    "__static_attributes__",
    "__type_params__",
    "__weakref__",
    "_abc_impl",
}
"""Attributes of classes that decide nothing, or that repeat others."""
OF_MODULES = {
    "__annotations__",
    "__builtins__",
    "__cached__",
    "__doc__",
    "__file__",
    "__loader__",
    "__path__",
    "__spec__",
}


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
    version = sys.modules[__name__.partition(".")[0]].__version__  # of the root, which is there before its rooms
    digest = _Digest()
    digest.add("version", version.encode())
    digest.value(function, 0)
    return digest.hash.hexdigest()


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
    digest = _Digest()
    if set(map(type, cases)) <= PLAIN:  # the bytes that they give one by one, four times as fast
        parts = [(type(case).__name__.encode(), repr(case).encode("utf-8", "surrogatepass")) for case in cases]
        digest.hash.update(b"".join(b"%b %d %b" % (kind, len(text), text) for kind, text in parts))
    else:
        for case in cases:
            digest.value(case, 0)
            digest.visited.clear()  # whether two cases share an object is no difference
    return digest.hash.hexdigest()


class _Digest:
    """A hash of tagged values, each with its length, so that no two lists of values have the same bytes.

    An object that is met again adds the digest of its first visit; one that contains itself adds its depth there.
    """

    def __init__(self) -> None:
        self.hash = hashlib.sha256()
        self.visited: dict[int, tuple[Any, bytes]] = {}  # with the object, so that no other one gets its number
        self.names: list[str] = []  # by which the walk came here, for refusals

    def add(self, tag: str, content: bytes = b"") -> None:
        self.hash.update(f"{tag} {len(content)} ".encode() + content)

    def text(self, tag: str, content: str) -> None:
        self.add(tag, content.encode("utf-8", "surrogatepass"))

    def value(self, value: Any, depth: int) -> None:
        """Any value."""
        kind = type(value)
        if value is None or kind in (bool, int, float, complex, str):
            self.text(kind.__qualname__, repr(value))
        elif kind is bytes:
            self.add("bytes", value)
        elif id(value) in self.visited:
            self.add("visited", self.visited[id(value)][1])
        else:
            self._visit(value, depth)

    def _visit(self, value: Any, depth: int) -> None:
        if depth > DEEPEST:
            raise self._refused(value, "it is nested too deep")
        outer, self.hash = self.hash, hashlib.sha256()
        self.visited[id(value)] = value, f"around {depth}".encode()
        try:
            self._inside(value, depth + 1)
        except RecursionError:
            raise self._refused(value, "it is nested too deep") from None
        finally:
            inner, self.hash = self.hash.digest(), outer
        self.visited[id(value)] = value, inner
        self.add("visited", inner)

    def _refused(self, value: Any, reason: str) -> InputError:
        name = f" ({'.'.join(self.names[-3:])})" if self.names else ""
        return InputError(f"{shown(value)}{name} has no key for stored results, {reason}: {WAY_OUT}")

    def _inside(self, value: Any, depth: int) -> None:
        kind = type(value)
        if kind in (list, tuple, set, frozenset, dict, types.MappingProxyType):
            self._container(value, depth)
        elif kind is np.ndarray:
            self._array(value, depth)
        elif isinstance(value, np.generic) and is_installed(kind.__module__):
            self.add(f"number {value.dtype!r}", value.tobytes())
        elif isinstance(value, types.ModuleType):
            self._module(value, depth)
        elif isinstance(value, type):
            self._class(value, depth)
        elif kind is types.FunctionType:
            self._function(value, depth)
        elif kind is types.CodeType:
            self._code(value, depth)
        elif kind is types.CellType:
            self._all("cell", _content(value), depth)
        elif isinstance(value, METHODS):
            self._written_in_c(value, depth)
        elif isinstance(value, np.ufunc):
            self._universal(value)
        else:
            self._wrapper_or_object(value, depth)

    def _all(self, tag: str, values: Sequence[Any], depth: int) -> None:
        self.add(f"{tag} {len(values)}")
        for value in values:
            self.value(value, depth)

    def _named(self, items: Mapping[str, Any], depth: int) -> None:
        """Values by name; their order is no difference."""
        self.add(f"names {len(items)}")
        for name in sorted(items):
            self.text("name", name)
            self.names.append(name)
            self.value(items[name], depth)
            self.names.pop()

    # ---- data

    def _container(self, value: Any, depth: int) -> None:
        kind = type(value).__qualname__
        if isinstance(value, set | frozenset):
            self.add(kind, b"".join(sorted(self._alone(each, depth) for each in value)))
        elif isinstance(value, list | tuple):
            self._all(kind, value, depth)
        else:
            self._all(kind, [part for pair in value.items() for part in pair], depth)

    def _alone(self, value: Any, depth: int) -> bytes:
        """The digest of an element of a set, whatever was visited before it."""
        digest = _Digest()
        digest.visited, digest.names = dict(self.visited), list(self.names)
        digest.value(value, depth)
        return digest.hash.digest()

    def _array(self, value: np.ndarray[Any, Any], depth: int) -> None:
        self.text("array", f"{value.dtype!r} {value.dtype.str} {value.shape}")
        if value.dtype.hasobject or value.dtype.kind == "V":
            self._all("items", value.ravel().tolist(), depth)
        else:
            self.add("bytes", np.ascontiguousarray(value).tobytes())

    # ---- code

    def _function(self, function: types.FunctionType, depth: int) -> None:
        space = function.__globals__
        library = is_installed(space.get("__name__"))
        self.text("function", _name(function))
        # `functools.wraps` gives what a library made of a function the module of this function
        if library and is_installed(function.__module__) and is_found_by_name(function):
            self._package(function.__module__)
            return
        self.names.append(function.__name__)
        if library and isinstance(registry := vars(function).get("registry"), types.MappingProxyType):
            self._all("of singledispatch", [registry], depth)  # the rest of it repeats this, or is a cache
            self.names.pop()
            return
        self._code(function.__code__, depth)
        self._all("defaults", [function.__defaults__, function.__kwdefaults__], depth)
        self._all("closure", function.__closure__ or (), depth)
        self._named(vars(function), depth)
        if not library:  # a version stands for the names of a package
            for name in sorted(attribute_names(function.__code__) & REACHING):
                raise self._refused(function, f"{name} reaches what the code does not name")
            for chain in sorted(chains(function.__code__)):
                self._chain(chain, space, depth)
            package = space.get("__package__") or str(space.get("__name__", "")).rpartition(".")[0]
            for module, name in sorted(imports(function.__code__, package)):
                self._imported(module, name, depth)
        self.names.pop()

    def _code(self, code: types.CodeType, depth: int) -> None:
        self.add("code", code.co_code)
        self.add("handlers", getattr(code, "co_exceptiontable", b""))
        self.text("names", repr((code.co_names, code.co_varnames, code.co_freevars, code.co_flags)))
        self._all("constants", code.co_consts, depth)

    def _chain(self, chain: Chain, space: dict[str, Any], depth: int) -> None:
        """A global name with the attributes that follow it."""
        value, rest, library = followed(chain, space)
        self.text("global", ".".join(chain))
        self.names += chain[: len(chain) - len(rest)]
        self._require_seen(value)
        if value is MISSING:
            self.add("unbound")
        elif library:
            self._of_library(value, rest, depth)
        elif is_written_only(value, rest):
            self.add("written only")
        elif (name := None if isinstance(value, type) else name_in_library(value)) is not None:
            self.text("library", name)
            self._package(name)
        else:
            self.value(value, depth)
        del self.names[len(self.names) - len(chain) + len(rest) :]

    def _require_seen(self, value: Any) -> None:
        if value is os.environ:  # its text has the values of all variables
            raise self._refused(os, "the environment may change")
        if any(value is each for each in UNSEEN):
            raise self._refused(value, "it reaches what the code does not name")

    def _of_library(self, value: Any, rest: Chain, depth: int) -> None:
        """The text of an object of an installed package: its name and version, if it is the package's own.

        Numbers, and functions that a program has put in there, count with their values.
        """
        while isinstance(value, types.ModuleType):
            self._module(value, depth)
            if not rest:
                return
            value, rest = getattr(value, rest[0], MISSING), rest[1:]
        self._require_seen(value)
        if value is None or type(value) in (*PLAIN, complex, bytes) or _is_put_in(value) or is_found_by_name(value):
            self.value(value, depth)
        else:
            self.text("library", _name(value))

    def _imported(self, module: str, name: str, depth: int) -> None:
        """A module that a function imports when it is called."""
        self.text("import", f"{module} {name}")
        if is_installed(module) and not name:
            self._package(module)
            return
        try:
            value: Any = pkgutil.resolve_name(module)
        except (ImportError, ValueError, AttributeError):
            self.add("unbound")
            return
        self._chain(("module", name) if name else ("module",), {"module": value}, depth)

    def _module(self, module: types.ModuleType, depth: int) -> None:
        """An installed package by its name, any other module by all its values."""
        self.text("module", module.__name__)
        if is_installed(module.__name__):
            self._package(module.__name__)
            return
        self._named({name: value for name, value in vars(module).items() if name not in OF_MODULES}, depth)

    def _class(self, kind: type, depth: int) -> None:
        self.text("class", _name(kind))
        if is_installed(kind.__module__) and is_found_by_name(kind):
            self._package(kind.__module__)
            self._named({name: member for name, member in vars(kind).items() if _is_put_in(member)}, depth)
            return
        self.names.append(kind.__name__)
        self._all("bases", [*kind.__bases__, type(kind)], depth)
        self._named({name: value for name, value in vars(kind).items() if name not in OF_CLASSES}, depth)
        self.names.pop()

    def _written_in_c(self, value: Any, depth: int) -> None:
        self.text("named", _name(value))
        owner = getattr(value, "__self__", None)
        if owner is not None and not isinstance(owner, types.ModuleType):
            self.value(owner, depth)
        module = sys.modules.get(getattr(value, "__module__", None) or "")
        if module is not None and not is_installed(module.__name__) and getattr(module, "__file__", None):
            self.add("file", hashlib.sha256(Path(str(module.__file__)).read_bytes()).digest())

    def _universal(self, value: np.ufunc) -> None:
        """A function of numpy or scipy by its name; one made of a Python function hides it."""
        if not any(vars(module).get(value.__name__) is value for module in list(sys.modules.values())):
            raise self._refused(value, "it hides a Python function")
        self.text("ufunc", value.__name__)

    def _wrapper_or_object(self, value: Any, depth: int) -> None:
        """The text of an object: its functions where it holds some, else the values that pickle builds it from."""
        functions: list[Any] | None = None
        if isinstance(value, functools.partial):
            functions = [value.func, value.args, value.keywords]
        elif isinstance(value, types.MethodType):
            functions = [value.__func__, value.__self__]
        elif isinstance(value, staticmethod | classmethod):
            functions = [value.__func__]
        elif isinstance(value, property):
            functions = [value.fget, value.fset, value.fdel]
        elif isinstance(value, functools.cached_property):
            functions = [value.func]
        elif isinstance(value, functools._lru_cache_wrapper):
            functions = [value.__wrapped__, value.cache_parameters()]
        elif is_installed(type(value).__module__) and isinstance(getattr(value, "py_func", None), types.FunctionType):
            functions = [value.py_func, getattr(value, "targetoptions", None)]  # of numba, which adds a random number
        if functions is None:
            self._object(value, depth)
        else:
            self.text("holder", _name(type(value)))
            self._all("functions", functions, depth)

    def _object(self, value: Any, depth: int) -> None:
        try:
            parts = value.__reduce_ex__(2)
        except Exception as error:
            raise self._refused(value, str(error)) from None
        self.value(type(value), depth)
        if isinstance(parts, str):
            self.text("global", parts)
            return
        function, arguments, state, items, pairs, *rest = (*parts, None, None, None)[: max(5, len(parts))]
        self._all("built", [function, arguments], depth)
        self._dropped(value, state, depth)
        state = {} if state is None else state  # of an object whose attributes are not computed yet
        if isinstance(state, dict) and all(isinstance(name, str) for name in state):
            self._named(
                {name: attribute for name, attribute in state.items() if not _is_cached(type(value), name)}, depth
            )
        else:
            self.value(state, depth)
        # iterators of the elements of lists and dicts
        self._all("items", list(items or ()), depth)
        self._all("pairs", list(pairs or ()), depth)
        self._all("rest", rest, depth)

    def _dropped(self, value: Any, state: Any, depth: int) -> None:
        """Attributes that an object of a program leaves out when it is pickled; locks and files are no data."""
        if is_installed(type(value).__module__):
            return
        slots = copyreg._slotnames(type(value))  # type: ignore[attr-defined]
        held = getattr(value, "__dict__", {}) | {name: getattr(value, name) for name in slots if hasattr(value, name)}
        parts = [piece for piece in (state if isinstance(state, tuple) else (state,)) if isinstance(piece, dict)]
        self.add("dropped")
        for name in sorted(set(held).difference(*parts)):
            if not _is_cached(type(value), name):
                try:
                    content = self._alone(held[name], depth)
                except InputError:
                    continue
                self.add(f"name {name}", content)

    def _package(self, module: str) -> None:
        """The version of an installed package, and the precision at which it computes."""
        version = getattr(sys.modules.get(module.partition(".")[0]), "__version__", "")
        self.text("version", f"{version} {precision_of(module)}")


def _is_put_in(value: Any) -> bool:
    """Whether a Python function or class of no installed package stands where a package has its own."""
    if isinstance(value, types.FunctionType) and not is_installed(value.__globals__.get("__name__")):
        return True
    return isinstance(value, types.FunctionType | type) and not is_installed(value.__module__)


def _content(cell: types.CellType) -> list[Any]:
    try:
        return [cell.cell_contents]
    except ValueError:  # not bound yet
        return []


def _is_cached(kind: type, name: str) -> bool:
    """Whether an attribute of an object only repeats what is computed from its others."""
    return any(isinstance(vars(each).get(name), functools.cached_property) for each in kind.__mro__)


def _name(value: Any) -> str:
    return f"{getattr(value, '__module__', '')}.{getattr(value, '__qualname__', getattr(value, '__name__', '?'))}"
