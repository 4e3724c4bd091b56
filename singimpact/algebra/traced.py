"""A Python function as an expression tree: it is called once, with letters in place of numbers.

Operators, and the functions of numpy and of `math`, build the tree.  What depends on a value (a branch, a comparison, a
conversion to float) has no tree and is refused with the line of the function.
"""

from __future__ import annotations

import inspect
import math
import traceback
import types
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from singimpact.algebra.expressions import MINUS_ONE, Call, Expression, Name, Number, add, multiply, negate, subtract
from singimpact.algebra.parsing import bounded_power, defined, refused_function
from singimpact.inputs import InputError, refuse

OF_ONE: dict[str, Callable[[Expression], Expression]] = {
    "neg": negate,
    "pos": lambda tree: tree,
    "abs": lambda tree: Call("abs", tree),
}
OF_TWO: dict[str, Callable[[Expression, Expression], Expression]] = {
    "add": add,
    "sub": subtract,
    "mul": multiply,
    "truediv": lambda left, right: multiply(left, bounded_power(right, MINUS_ONE)),
    "pow": bounded_power,
}
DECIDING = ("bool", "float", "int", "index", "complex", "lt", "le", "gt", "ge", "eq", "ne", "floordiv", "mod", "round")
"""Operations that need a value."""


class Letter:
    """A number of which only the tree is known; `OF_ONE` and `OF_TWO` have its operations."""

    def __init__(self, tree: Expression) -> None:
        self.tree = tree

    def __getattr__(self, name: str) -> Callable[[], Letter]:
        """A function of the number, under the name by which numpy asks for it."""
        if name.startswith("_"):
            raise AttributeError(name)
        function = defined(name)
        if function is None:
            raise InputError(refused_function(name))
        return lambda: Letter(function(self.tree))

    def decided(self, *_: object) -> object:
        """Refuse what needs a value."""
        raise InputError("this needs the value of a number, which has none while the formula is read")


for _name, _one in OF_ONE.items():
    setattr(Letter, f"__{_name}__", lambda self, build=_one: Letter(build(self.tree)))
for _name, _two in OF_TWO.items():
    setattr(Letter, f"__{_name}__", lambda self, other, build=_two: Letter(build(self.tree, _tree(other))))
    setattr(Letter, f"__r{_name}__", lambda self, other, build=_two: Letter(build(_tree(other), self.tree)))
for _name in DECIDING:
    setattr(Letter, f"__{_name}__", Letter.decided)


def _tree(value: object) -> Expression:
    """The tree of a number in a function; a float is the shortest decimal that rounds to it, as it is written there."""
    plain = value.item() if isinstance(value, np.generic | np.ndarray) and not value.shape else value
    if isinstance(plain, Letter):
        return plain.tree
    try:
        return Number(Fraction(repr(plain)))
    except ValueError:
        raise InputError(f"{plain!r} is no number") from None


def _of_letters(function: Any) -> Callable[..., Any]:
    """A function of `math` that takes letters too."""

    def called(first: Any, *others: Any) -> Any:
        if not isinstance(first, Letter):
            return function(first, *others)
        return first ** others[0] if function is math.pow else getattr(first, function.__name__)(*others)

    return called


def _read(part: object) -> object:
    """A global of a function, where `math` and its functions take letters."""
    if part is math:
        return types.SimpleNamespace(**{name: _read(value) for name, value in vars(math).items()})
    return _of_letters(part) if isinstance(part, types.BuiltinFunctionType) and part.__module__ == "math" else part


def traced(function: Callable[..., Any], names: Sequence[str], what: str) -> Expression:
    """The tree of a function.

    Parameters
    ----------
    function : of some of the names, in their order or under them. names : variables, then parameters. what : the input,
        for an error.

    Raises
    ------
    InputError : it takes something else, branches on a value, or calls what has no tree; with the line.

    Examples
    --------
    >>> print(traced(lambda x, xdot, b: x + b * np.sin(x) - 0.1 * xdot**3, ("x", "xdot", "b"), "f"))
    x + b*sin(x) - 0.1*xdot**3
    """
    try:
        accepted = inspect.signature(function).parameters.values()
        takes = [item for item in accepted if item.default is item.empty or item.name in names]
    except ValueError:  # of numpy's functions
        takes = [inspect.Parameter(names[0], inspect.Parameter.POSITIONAL_ONLY)]
    if len(takes) > len(names) or any(item.kind in (item.VAR_POSITIONAL, item.VAR_KEYWORD) for item in takes):
        raise refuse(what, function, f"a function of {', '.join(names)}, or of some of them")
    letters = [Letter(Name(item.name if item.name in names else names[at])) for at, item in enumerate(takes)]
    try:
        return _tree(_with_letters(function)(*letters))
    except Exception as error:
        causes = error, error.__cause__, error.__context__
        reason = next((cause for cause in causes if isinstance(cause, InputError)), error)
        raise InputError(f"{what} is not accepted: {_line(error, function)}{reason}") from None


def _with_letters(function: Any) -> Any:
    """The function where what it reads of `math` takes letters."""
    if not isinstance(function, types.FunctionType):
        return function
    names = {name: _read(part) for name, part in function.__globals__.items()}
    made = types.FunctionType(function.__code__, names, function.__name__, function.__defaults__, function.__closure__)
    made.__kwdefaults__ = function.__kwdefaults__
    return made


def _line(error: BaseException, function: object) -> str:
    """The last line of the function's file on the way to an error."""
    file = getattr(getattr(function, "__code__", None), "co_filename", None)
    lines = [frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename == file]
    return f"line {lines[-1].lineno}, {lines[-1].line}: " if lines else ""
