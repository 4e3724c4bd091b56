"""Numbers on demand: what a caller wrote, kept exact, and given to any number of digits.

A float means its exact binary value; a string, int, Fraction or sympy Rational means what is written.  A number is
a constant expression tree, so ``pi/2.8`` and ``sqrt(2)`` are numbers too.
"""

import inspect
import math
import traceback
import types
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from decimal import Decimal
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np

from singimpact.algebra import expressions
from singimpact.algebra.balls import Balls, as_rational
from singimpact.algebra.expressions import Expression, Number
from singimpact.algebra.parsing import LIMITS, bounded_power, defined, from_sympy, parse, refused_function
from singimpact.inputs import InputError, refuse, require, require_memory, shown

Array = np.ndarray[Any, Any]
EPSILON = 2.0**-52  # from 1 to the next double
LONGEST = 1_000_000  # bits of a rational that stands for a ball
ACCEPTED = "a finite real number, or text such as '0.3', '1/3' or 'pi/2.8'"


def exact(name: str, value: Any) -> Fraction:
    """The rational that a Python, numpy or mpmath number is, exactly.

    Examples
    --------
    >>> exact("r", 0.5), exact("r", np.float64(0.25))
    (Fraction(1, 2), Fraction(1, 4))
    """
    require(not isinstance(value, bool | np.bool_), name, value, ACCEPTED)
    if isinstance(value, int | float | Fraction | np.integer | np.floating):
        try:
            if isinstance(value, float | np.floating):
                return Fraction(float(value))
            # a Fraction of a numpy integer keeps numpy integers inside, and they overflow
            return value if isinstance(value, Fraction) else Fraction(int(value))
        except (ValueError, OverflowError):
            raise refuse(name, value, ACCEPTED) from None
    if hasattr(value, "_mpf_"):
        sign, mantissa, exponent, _ = value._mpf_
        if mantissa or not exponent:
            return (-1 if sign else 1) * Fraction(int(mantissa)) * Fraction(2) ** int(exponent)
    raise refuse(name, value, ACCEPTED)


def tree_of(value: Any, names: Iterable[str] = (), what: str = "expression") -> Expression:
    """A tree from text, a function, a sympy object, a number or a tree already made.

    Examples
    --------
    >>> tree_of(0.5) == tree_of("1/2")
    True
    """
    if isinstance(value, str | Decimal):
        return parse(str(value), names, what)
    if isinstance(value, Expression):
        return value
    if str(type(value).__module__).partition(".")[0] == "sympy" and hasattr(value, "args"):
        return from_sympy(value, names, what)
    if callable(value) and names:
        return traced(value, tuple(names), what)
    if names and not isinstance(value, int | float | Fraction | np.number) and not hasattr(value, "_mpf_"):
        raise refuse(what, value, f"an expression in {', '.join(names)}: text, a function, a sympy object or a number")
    return Number(exact(what, value))


def constant(name: str, value: Any) -> Expression:
    """A number as a constant tree; text and sympy constants are accepted.

    Raises
    ------
    InputError : the value is not a finite real number.

    Examples
    --------
    >>> print(constant("tau", "pi/2.8"))
    (5/14)*pi
    >>> constant("r", "1/2") == constant("r", 0.5)
    True
    """
    tree = tree_of(value, (), name)
    require(not expressions.names_in(tree), name, value, ACCEPTED)
    require(isinstance(tree, Number) or _ball(tree, 64).is_finite(), name, value, ACCEPTED)
    return tree


def _ball(tree: Expression, bits: int) -> Any:
    return Balls(bits).evaluate(tree, {})


def as_fraction(tree: Expression) -> Fraction | None:
    """The rational a constant tree is, if it is written as one."""
    return tree.value if isinstance(tree, Number) else None


def rational_number(name: str, value: Any) -> Fraction:
    """A rational that a user gives, as a number or as text.

    Examples
    --------
    >>> rational_number("reach", "0.25"), rational_number("reach", "1/3")
    (Fraction(1, 4), Fraction(1, 3))
    """
    exact_value = as_fraction(constant(name, value))
    if exact_value is None:
        raise refuse(name, value, "a rational number")
    return exact_value


def rational_ends(
    name: str, values: object, accepted: str, read: Callable[[str, object], Fraction] = rational_number
) -> tuple[Fraction, Fraction]:
    """Two rational numbers, the first below the second, or a refusal.

    Parameters
    ----------
    read : makes a rational number of each.

    Examples
    --------
    >>> rational_ends("between", ("0.7", 1), "two rational numbers low < high")
    (Fraction(7, 10), Fraction(1, 1))
    """
    if isinstance(values, tuple | list | np.ndarray) and len(values) == 2:
        with suppress(TypeError, ValueError):
            low, high = (read(name, end) for end in values)
            if low < high:
                return low, high
    raise refuse(name, values, accepted)


def near_rational(name: str, value: object) -> Fraction:
    """The rational that a user gives, or one within 2^-64, relative, of another constant.

    Examples
    --------
    >>> near_rational("v", "1/3"), float(near_rational("v", "pi"))
    (Fraction(1, 3), 3.141592653589793)
    """
    return rational_near(constant(name, value), 64)


def rational_near(tree: Expression, bits: int) -> Fraction:
    """A rational within about 2^-bits, relative, of a constant tree; the number itself where it is rational.

    A number below 2^-1000000 that is not written as a rational becomes 0: its digits would take seconds and gigabytes.

    Rationals and their products with pi, which is what a model in doubles is made of, need no balls: these take 20
    milliseconds to load.

    Raises
    ------
    OverflowError : the number is above 2^1000000, or out of the range of balls.

    Examples
    --------
    >>> rational_near(constant("tau", "1/3"), 64)
    Fraction(1, 3)
    >>> float(rational_near(constant("tau", "2*pi"), 64) - rational_near(constant("tau", "2*pi"), 256)) < 2.0**-62
    True
    """
    match tree:
        case Number(value):
            return value
        case expressions.Pi():
            return _pi(bits)
        case expressions.Product((Number(value), expressions.Pi())):
            return value * _pi(bits)
    ball = _ball(tree, bits)
    if not ball.is_finite():  # flint puts 0 where a number is out of its range
        raise OverflowError("out of the range of balls")
    if abs(exponent := int(ball.mid().man_exp()[1])) > LONGEST:
        if exponent > 0:
            raise OverflowError(f"above 2^{LONGEST}")
        return Fraction(0)
    return as_rational(ball)


@cache
def _pi(bits: int) -> Fraction:
    """pi to more than these bits by Machin's formula 16 arctan(1/5) - 4 arctan(1/239), in whole numbers."""
    one = 1 << (bits + 64)

    def arctan(n: int) -> int:
        power, total, k = one // n, 0, 0
        while power:
            total += (-1) ** k * (power // (2 * k + 1))
            power, k = power // (n * n), k + 1
        return total

    return Fraction(16 * arctan(5) - 4 * arctan(239), one)


def as_float(tree: Expression | None) -> float:
    """The nearest double of a constant tree; nan where there is no number, such as the period of a model without one.

    Raises
    ------
    InputError : the number is larger than every double, or out of the range of balls too.

    Examples
    --------
    >>> as_float(constant("tau", "pi/2"))
    1.5707963267948966
    """
    if tree is None:
        return math.nan
    try:
        value = float(rational_near(tree, 160))
    except OverflowError:
        value = math.inf
    if not math.isfinite(value):
        raise InputError(f"number = {shown(str(tree))} is not accepted: give one that a double holds, below 1.8e308")
    return value


def as_mpf(tree: Expression, context: Any) -> Any:
    """The value of a constant tree in an mpmath context, at that context's precision."""
    from singimpact.algebra.rings import Multiprecision

    return expressions.evaluate(tree, {}, Multiprecision(context))


def sign_of(tree: Expression) -> int:
    """The sign of a constant, decided by balls of growing precision; 0 only for an exact zero.

    Raises
    ------
    InputError : not decided with 4096 bits and not written as a rational.
    """
    if isinstance(tree, Number):
        return (tree.value > 0) - (tree.value < 0)
    if sign := _sign_of_parts(tree):
        return sign
    for bits in (64, 256, 1024, 4096):
        ball = _ball(tree, bits)
        if ball > 0 or ball < 0:
            return 1 if ball > 0 else -1
    advice = "is not decided with 4096 bits: write the number as a rational if it is zero"
    raise InputError(f"the sign of {shown(str(tree), 200)} {advice}")


def _sign_of_parts(tree: Expression) -> int:
    """The sign of a product of numbers and pi; 0 where balls must decide. It spares a session that asks for no more
    the loading of them.
    """
    if isinstance(tree, Number):
        return (tree.value > 0) - (tree.value < 0)
    if isinstance(tree, expressions.Product):
        return math.prod(_sign_of_parts(factor) for factor in tree.factors)
    return 1 if isinstance(tree, expressions.Pi) else 0


def compare(left: Expression, right: Expression | int) -> int:
    """-1, 0 or 1 as left is less than, equal to or greater than right."""
    other = expressions.number(right) if isinstance(right, int) else right
    return 0 if left == other else sign_of(expressions.subtract(left, other))


def require_unmasked(name: str, values: Any) -> None:
    """Refuse an array in which numbers are masked: numpy drops the mask, and hidden numbers would be flown.

    Examples
    --------
    >>> require_unmasked("tau", np.ma.array([1.0, 2.0], mask=[0, 0]))
    """
    if isinstance(values, np.ma.MaskedArray) and np.ma.getmaskarray(values).any():
        raise refuse(name, values.tolist(), "an array without masked numbers: give .compressed() or .filled(number)")


def float_array(name: str, values: Any) -> np.ndarray[Any, np.dtype[np.float64]]:
    """An array of doubles from numbers, text, or arrays of them; nan and inf are refused.

    Examples
    --------
    >>> float_array("tau", ["pi/2", 1]).tolist()
    [1.5707963267948966, 1.0]
    """
    require_unmasked(name, values)
    raw = np.asarray(values)
    require_memory(name, raw.shape, 16)  # itself and a result
    if raw.dtype.kind not in "iuf":
        raw = np.array([as_float(constant(name, item)) for item in raw.ravel().tolist()]).reshape(raw.shape)
    array = raw.astype(np.float64)
    if not np.all(np.isfinite(array)):
        raise refuse(name, array.ravel()[~np.isfinite(array.ravel())][0], "finite numbers only")
    return array


# A Python function as an expression tree: it is called once, with letters in place of numbers.
#
# Operators, and the functions of numpy and of `math`, build the tree.  What depends on a value (a branch, a comparison,
# a conversion to float) has no tree and is refused with the line of the function.

OF_ONE: dict[str, Callable[[Expression], Expression]] = {
    "neg": expressions.negate,
    "pos": lambda tree: tree,
    "abs": lambda tree: expressions.Call("abs", tree),
}
OF_TWO: dict[str, Callable[[Expression, Expression], Expression]] = {
    "add": expressions.add,
    "sub": expressions.subtract,
    "mul": expressions.multiply,
    "truediv": lambda left, right: expressions.multiply(left, bounded_power(right, expressions.MINUS_ONE)),
    "pow": bounded_power,
}
# Operations that need a value
DECIDING = ("bool", "float", "int", "index", "complex", "lt", "le", "gt", "ge", "eq", "ne", "floordiv", "mod", "round")


class Letter:
    """A number of which only the tree is known, and how many parts it has; `OF_ONE`, `OF_TWO` are its operations."""

    def __init__(self, tree: Expression, parts: int = 1) -> None:
        self.tree, self.parts = tree, parts
        if parts > LIMITS.characters:
            raise InputError(f"its formula has more than {LIMITS.characters} parts")

    def with_number(self, value: object, build: Callable[[Expression, Expression], Expression]) -> "Letter":
        """A number built of this one and another."""
        other = _letter(value)
        return Letter(build(self.tree, other.tree), self.parts + other.parts + 1)

    def __getattr__(self, name: str) -> "Callable[[], Letter]":
        """A function of the number, under the name by which numpy asks for it."""
        if name.startswith("_"):
            raise AttributeError(name)
        function = defined(name)
        if function is None:
            raise InputError(refused_function(name))
        return lambda: Letter(function(self.tree), (1 if name in expressions.FUNCTIONS else 4) * self.parts + 5)

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


def _read(thing: Any) -> Any:
    """A function, or what one reads, where `math` and its functions take letters."""
    if thing is math:
        return types.SimpleNamespace(**{name: _read(value) for name, value in vars(math).items()})
    if isinstance(thing, types.FunctionType):
        return lambda *values, **named: _copied(thing)(*values, **named)
    if not isinstance(thing, types.BuiltinFunctionType) or thing.__module__ != "math":
        return thing
    return lambda first, *others: (
        getattr(first, thing.__name__)(*others) if isinstance(first, Letter) else thing(first, *others)
    )


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
        letters = [
            Letter(expressions.Name(item.name if item.name in names else names[at])) for at, item in enumerate(takes)
        ]
        text = str(_letter(_read(function)(*letters)).tree)
    except Exception as error:
        causes = (error, error.__cause__, error.__context__)
        reason = next((cause for cause in causes if isinstance(cause, InputError)), error)
        file = getattr(getattr(function, "__code__", None), "co_filename", None)
        lines = [frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename == file]
        line = f"line {lines[-1].lineno}, {lines[-1].line}: " if lines else ""
        raise InputError(f"{what} is not accepted: {line}{reason}") from None
    return parse(text, names, what)
