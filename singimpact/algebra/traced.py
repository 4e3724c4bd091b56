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
from typing import Any

import numpy as np

from singimpact.algebra.expressions import FUNCTIONS, MINUS_ONE, Call, Expression, Name, add, multiply, negate, subtract
from singimpact.algebra.parsing import LIMITS, bounded_power, defined, parse, refused_function
from singimpact.inputs import InputError

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
    """A number of which only the tree is known, and how many parts it has; `OF_ONE`, `OF_TWO` are its operations."""

    def __init__(self, tree: Expression, parts: int = 1) -> None:
        self.tree, self.parts = tree, parts
        if parts > LIMITS.characters:
            raise InputError(f"its formula has more than {LIMITS.characters} parts")

    def with_number(self, value: object, build: Callable[[Expression, Expression], Expression]) -> Letter:
        """A number built of this one and another."""
        other = _letter(value)
        return Letter(build(self.tree, other.tree), self.parts + other.parts + 1)

    def __getattr__(self, name: str) -> Callable[[], Letter]:
        """A function of the number, under the name by which numpy asks for it."""
        if name.startswith("_"):
            raise AttributeError(name)
        function = defined(name)
        if function is None:
            raise InputError(refused_function(name))
        return lambda: Letter(function(self.tree), (1 if name in FUNCTIONS else 4) * self.parts + 5)

    def decided(self, *_: object) -> object:
        """Refuse what needs a value."""
        raise InputError("this needs the value of a number, which has none while the formula is read")


for _name, _one in OF_ONE.items():
    setattr(Letter, f"__{_name}__", lambda self, build=_one: Letter(build(self.tree), self.parts + 1))
for _name, _two in OF_TWO.items():
    setattr(Letter, f"__{_name}__", lambda self, other, build=_two: self.with_number(other, build))
    setattr(Letter, _name, getattr(Letter, f"__{_name}__"))  # math.pow asks for pow
    setattr(Letter, f"__r{_name}__", lambda self, other, build=_two: _letter(other).with_number(self, build))
for _name in DECIDING:
    setattr(Letter, f"__{_name}__", Letter.decided)


def _letter(value: object) -> Letter:
    """A number in a function; a float is the shortest decimal that rounds to it, as it is written there."""
    plain = value.item() if isinstance(value, np.generic | np.ndarray) and not value.shape else value
    return plain if isinstance(plain, Letter) else Letter(parse(str(plain), (), "a number in it"))


def _of_letters(function: Any) -> Callable[..., Any]:
    """A function of `math` that takes letters too."""
    return lambda first, *others: (
        getattr(first, function.__name__)(*others) if isinstance(first, Letter) else function(first, *others)
    )


def _read(part: Any) -> Any:
    """A function, or what one reads, where `math` and its functions take letters."""
    if part is math:
        return types.SimpleNamespace(**{name: _read(value) for name, value in vars(math).items()})
    if isinstance(part, types.FunctionType):
        return lambda *values, **named: _copied(part)(*values, **named)
    return _of_letters(part) if isinstance(part, types.BuiltinFunctionType) and part.__module__ == "math" else part


def _copied(function: types.FunctionType) -> types.FunctionType:
    """A function that reads all its names by `_read`."""
    names = {name: _read(part) for name, part in function.__globals__.items()}
    cells = tuple(types.CellType(_read(cell.cell_contents)) for cell in function.__closure__ or ())
    copied = types.FunctionType(function.__code__, names, function.__name__, function.__defaults__, cells)
    copied.__kwdefaults__ = function.__kwdefaults__
    return copied


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
        # functions of numpy have a signature in newer versions alone; they take as much as these two
        likened = (math.cos, math.atan2)[function.nin - 1] if isinstance(function, np.ufunc) else function
        accepted = inspect.signature(likened).parameters.values()
        takes = [item for item in accepted if item.default is item.empty or item.name in names]
        if len(takes) > len(names) or any(item.kind in (item.VAR_POSITIONAL, item.VAR_KEYWORD) for item in takes):
            raise InputError(f"give a function of {', '.join(names)}, or of some of them")
        letters = [Letter(Name(item.name if item.name in names else names[at])) for at, item in enumerate(takes)]
        text = str(_letter(_read(function)(*letters)).tree)
    except Exception as error:
        causes = error, error.__cause__, error.__context__
        reason = next((cause for cause in causes if isinstance(cause, InputError)), error)
        file = getattr(getattr(function, "__code__", None), "co_filename", None)
        lines = [frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename == file]
        line = f"line {lines[-1].lineno}, {lines[-1].line}: " if lines else ""
        raise InputError(f"{what} is not accepted: {line}{reason}") from None
    return parse(text, names, what)
