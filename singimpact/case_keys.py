"""The key of kept results: the code of a function with all that it closes over, the bytes of its cases, the version.

Not here: reading and writing results (`cases`).  What has no key is refused, for results of another function that are
taken up in silence are worse than none.
"""

from __future__ import annotations

import functools
import hashlib
import sys
import types
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from singimpact.inputs import InputError, shown

DEEPEST = 40  # containers and functions inside one another; a loop of references ends here too
PLAIN = {int, float, str, bool}
WAY_OUT = "leave output= out, or give a function of a module and cases of numbers, text, arrays or dataclasses"


def function_key(function: Callable[[Any], Any]) -> str:
    """The digest of a function and of the version of the package.

    Raises
    ------
    InputError : something in it has no lasting text, as an open file or a lock.

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
    digest.function(function, 0)
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
    kinds = set(map(type, cases))
    if kinds <= PLAIN:  # the bytes that they give one by one, four times as fast
        parts = [(type(case).__name__.encode(), repr(case).encode("utf-8", "surrogatepass")) for case in cases]
        digest.hash.update(b"".join(b"%b %d %b" % (kind, len(text), text) for kind, text in parts))
    else:
        for case in cases:
            digest.value(case, 0)
    return digest.hash.hexdigest()


class _Digest:
    """A hash of tagged parts, each with its length, so that no two lists of parts have the same bytes."""

    def __init__(self) -> None:
        self.hash, self.seen = hashlib.sha256(), set[int]()

    def add(self, tag: str, content: bytes) -> None:
        self.hash.update(f"{tag} {len(content)} ".encode() + content)

    def function(self, function: Any, depth: int) -> None:
        """The code of a function, its defaults, what it closes over and the functions and numbers that it names."""
        if isinstance(function, functools.partial):
            self.add("partial", b"")
            self.function(function.func, depth + 1)
            self.value([function.args, function.keywords], depth + 1)
        elif isinstance(function, types.MethodType):
            self.add("method", b"")
            self.function(function.__func__, depth + 1)
            self.value(function.__self__, depth + 1)
        elif isinstance(function, types.FunctionType):
            self._python(function, depth)
        elif isinstance(function, types.BuiltinFunctionType | type | np.ufunc | types.MethodDescriptorType):
            self.add("named", _name(function).encode())
            owner = getattr(function, "__self__", None)
            if owner is not None and not isinstance(owner, types.ModuleType | type):
                self.value(owner, depth + 1)
        elif isinstance(type(function).__call__, types.FunctionType):
            self.add("callable", b"")
            self.function(type(function).__call__, depth + 1)
            self.value(function, depth + 1)
        elif hasattr(function, "__qualname__"):  # written in C, with a name that stands for its code
            self.add("named", _name(function).encode())
        else:
            self.value(function, depth + 1)

    def _python(self, function: types.FunctionType, depth: int) -> None:
        self.add("function", _name(function).encode())
        if id(function) in self.seen:
            return
        self.seen.add(id(function))
        self._code(function.__code__, depth)
        self.value([function.__defaults__, function.__kwdefaults__], depth + 1)
        for cell in function.__closure__ or ():
            self.value(cell.cell_contents, depth + 1)
        if not function.__module__.startswith("singimpact."):  # the version stands for the package's own
            for name in sorted(_names(function.__code__)):
                self._global(name, function.__globals__.get(name), depth)

    def _code(self, code: types.CodeType, depth: int) -> None:
        self.add("code", code.co_code)
        self.add("names", repr((code.co_names, code.co_varnames, code.co_freevars, code.co_flags)).encode())
        for part in code.co_consts:
            if isinstance(part, types.CodeType):
                self._code(part, depth + 1)
            else:
                self.value(part, depth + 1)

    def _global(self, name: str, value: Any, depth: int) -> None:
        """Functions and plain values that a function names; modules and classes by their name."""
        if isinstance(value, types.FunctionType):
            self.function(value, depth + 1)
        elif isinstance(value, bool | int | float | complex | str | bytes | tuple | frozenset | np.ndarray | Fraction):
            self.add("global", name.encode())
            self.value(value, depth + 1)
        elif isinstance(value, types.ModuleType | type):
            self.add("global", f"{name} {_name(value)}".encode())

    def value(self, value: Any, depth: int) -> None:
        """A case, an argument or a value closed over."""
        if depth > DEEPEST:
            raise InputError(f"{shown(value)} is nested too deep for the key of kept results: {WAY_OUT}")
        kind = type(value).__qualname__
        if value is None or isinstance(value, bool | int | float | complex | str | bytes):
            self.add(kind, repr(value).encode("utf-8", "surrogatepass"))
        elif isinstance(value, np.ndarray) and value.dtype.kind not in "OV":
            self.add(f"array {value.dtype.str} {value.shape}", np.ascontiguousarray(value).tobytes())
        elif isinstance(value, np.generic):
            self.add(f"number {value.dtype.str}", value.tobytes())
        elif isinstance(value, list | tuple | np.ndarray):
            self.add(f"{kind} {getattr(value, 'shape', len(value))}", b"")
            for part in value.ravel().tolist() if isinstance(value, np.ndarray) else value:
                self.value(part, depth + 1)
        elif isinstance(value, dict):
            self.add(f"{kind} {len(value)}", b"")
            for name, part in value.items():
                self.value(name, depth + 1)
                self.value(part, depth + 1)
        elif isinstance(value, set | frozenset):
            self.add(kind, b"".join(sorted(_alone(part, depth) for part in value)))
        elif isinstance(value, types.ModuleType | type):
            self.add("named", _name(value).encode())
        elif isinstance(value, types.FunctionType | types.MethodType | types.BuiltinFunctionType | functools.partial):
            self.function(value, depth)
        else:
            self._object(value, depth)

    def _object(self, value: Any, depth: int) -> None:
        """Any other object by the parts that it is built again from."""
        try:
            parts = value.__reduce_ex__(2)
        except Exception as error:
            raise InputError(f"{shown(value)} has no key for kept results ({error}): {WAY_OUT}") from None
        self.add("object", _name(type(value)).encode())
        self.value(list(parts) if isinstance(parts, tuple) else parts, depth + 1)


def _alone(part: Any, depth: int) -> bytes:
    digest = _Digest()
    digest.value(part, depth + 1)
    return digest.hash.digest()


def _name(value: Any) -> str:
    return f"{getattr(value, '__module__', '')}.{getattr(value, '__qualname__', getattr(value, '__name__', '?'))}"


def _names(code: types.CodeType) -> set[str]:
    """Names that a code and the codes inside it use."""
    inner = (part for part in code.co_consts if isinstance(part, types.CodeType))
    return set(code.co_names).union(*(_names(part) for part in inner))
