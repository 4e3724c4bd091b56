"""The Taylor recurrence of x'' = g(t) - f(x, x', t), as the source of one Python function.

The text holds loops and integer constants alone, so that it runs on doubles (compiled or not) and on mpmath numbers.
Every constant part of f and g is an entry of the argument `p`: it is computed elsewhere, once, correctly rounded,
and models that differ in parameter values share one text.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import (
    Call,
    Expression,
    Name,
    Number,
    Power,
    Product,
    Sum,
    add,
    multiply,
    names_in,
    number,
    subtract,
)
from singimpact.codegen.disc import (
    MOVING,
    DiscWriter,
    columns_source,
    disc_source,
    is_whole,
    logistic_argument,
    rounding_source,
    slope_of_call,
    softplus_argument,
)
from singimpact.inputs import InputError, refuse

MOST_ROWS = 600  # of a recurrence; one of 600 takes 10 ms a Taylor step in Python and 20 s to compile


@dataclass(frozen=True)
class Recurrence:
    """The emitted function with what it expects.

    Parameters
    ----------
    source : text of `coefficients(launch, time, z, u, shift, n, p, work)`; `launch[0]` is the time of the launch.
        After it, `disc(X, W, n, R, p)` bounds on a disc how far x'' is from its value, and `rounding(X, W, unit, p)`
        how well x'' is known; `variations(launch, time, z, u, n, p, X, W, A, B, Z)` adds three columns of the
        variational equation, whose entries 0 and 1 are given; `disc_of_columns(X, W, A, B, Z, n, R, p)` bounds them.
    constants : trees whose values fill p[1], p[2], ...; p[0] is the clearance.
    rows : rows that the work array W needs.
    suspects : the parts that may be singular; `disc` reports the k-th as k + 1.
    sums : sums over products of coefficients in a coefficient of the motion, which is what a Taylor step takes.
    """

    source: str
    constants: tuple[Expression, ...]
    rows: int
    suspects: tuple[Expression, ...] = ()
    sums: int = 0

    @property
    def price(self) -> float:
        """The cost of a Taylor step, in such sums, of 10 to 25 us in Python; a row without a sum is a tenth of one."""
        return max(self.sums + self.rows / 10, 1.0)


@dataclass(frozen=True)
class _Series:
    """Where coefficient i of a part is found: `at.format(i)`; affine parts stop after coefficient 1."""

    at: str
    affine: bool = False

    def __call__(self, index: str) -> str:
        return self.at.format(index)


@dataclass
class _Writer:
    constants: list[Expression] = field(default_factory=list)
    lines: list[str] = field(default_factory=list)
    known: dict[Expression, _Series] = field(default_factory=dict)
    products: dict[frozenset[_Series], _Series] = field(default_factory=dict)
    rows: int = 0
    whole: tuple[str, Expression] = ("f", number(0))  # the expression that is written, with its name

    def row(self, affine: bool = False) -> _Series:
        self.rows += 1
        if self.rows > MOST_ROWS:
            name, tree = self.whole
            raise refuse(
                name,
                tree,
                f"an expression with at most {MOST_ROWS} products, sums and functions, its derivatives "
                f"included; a flight computes the Taylor coefficients of each, and this one has more",
            )
        return _Series(f"W[{self.rows - 1}, {{}}]", affine)

    def constant(self, tree: Expression) -> str:
        if tree not in self.constants:
            self.constants.append(tree)
        return f"p[{self.constants.index(tree) + 1}]"

    def emit(self, *lines: str) -> None:
        self.lines.extend(lines)

    def product(self, left: _Series, right: _Series) -> _Series:
        """The sum from both ends inwards: two sums run abreast, and a square needs one of them.

        A pair has one product, in either order: both orders add the same numbers.
        """
        pair = frozenset((left, right))
        if pair in self.products:
            return self.products[pair]
        target = self.products[pair] = self.row()
        same = left is right
        self.emit("i, j, s, s1 = 0, k, zero, zero", "while i < j:", f"    s += {left('i')} * {right('j')}")
        self.emit(*([] if same else [f"    s1 += {left('j')} * {right('i')}"]), "    i += 1", "    j -= 1")
        self.emit("s = 2 * s" if same else "s += s1", "if i == j:", f"    s += {left('i')} * {right('i')}")
        self.emit(f"{target('k')} = s")
        return target

    def disc(self, refusal: str = "inf, {}", unit: str = "") -> DiscWriter:
        """Writes radii of the parts whose series have been written."""
        return DiscWriter(lambda tree: self.known[tree]("0"), self.constant, refusal, unit)

    def starts(self, target: _Series, start: str, *otherwise: str) -> None:
        self.emit("if k == 0:", f"    {target('k')} = {start}", "else:", *(f"    {line}" for line in otherwise))


def recurrence(force: Expression, forcing: Expression, push: Expression | None = None) -> Recurrence:
    """The recurrence for the Taylor coefficients of a flight and of its variational equation, with their bounds.

    Parameters
    ----------
    force, forcing : f in x, xdot, t and parameters; g in t and parameters.
    push : what drives the third column: g' - f_t without it, for the derivative by the launch time; with g_p - f_p that
        column is the derivative by a parameter p.

    Raises
    ------
    InputError : abs occurs, which has no Taylor series where it matters; or the recurrence has too many rows.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> made = recurrence(parse("3*x", ["x"]), parse("t", ["t"]))
    >>> [str(tree) for tree in made.constants], made.rows
    (['3', '1'], 2)
    """
    writer = _Writer()
    motion = _motion(writer, force, forcing)
    parts, steady = [*_parted(forcing)[1], *_parted(force)[1]], [_parted(forcing)[0], _parted(force)[0]]
    bound = writer.disc()
    body = [*motion, "if k == 0:", "    X[2] += shift"]
    source = [_function("coefficients(launch, time, z, u, shift, n, p, work)", body), disc_source(bound, parts)]
    source.append(rounding_source(writer.disc("", "unit"), parts, steady))
    source += _columns(writer, motion, force, time_derivative(force, forcing) if push is None else push)
    sums = sum(line.strip().startswith(("while ", "for i in ")) for line in motion)
    return Recurrence("\n\n".join(source), tuple(writer.constants), max(writer.rows, 1), tuple(bound.suspects), sums)


def time_derivative(force: Expression, forcing: Expression) -> Expression:
    """g' - f_t: x'' by t at fixed x and x'."""
    slope = derivative(forcing, "t")
    return subtract(slope, derivative(force, "t")) if "t" in names_in(force) else slope


def _columns(writer: _Writer, motion: list[str], force: Expression, push: Expression) -> list[str]:
    """The source for columns A'' = -f_x A - f_x' A', the same for B, and Z'' = -f_x Z - f_x' Z' + push."""
    writer.lines.clear()
    by_x, by_xdot = derivative(force, "x"), derivative(force, "xdot")
    pushes = _terms(writer, push, "", "by_tau")
    pulls = _linear_pull(writer, by_x, "{0}[{1}]")
    pulls += _linear_pull(writer, by_xdot, "({1} + 1) * {0}[{1} + 1]")
    body = [
        *motion,
        *writer.lines,
        "by_x, by_v, by_tau = zero, zero, zero",
        *pushes,
        *pulls,
        "part = one / ((k + 1) * (k + 2))",
        "A[k + 2], B[k + 2], Z[k + 2] = by_x * part, by_v * part, by_tau * part",
    ]
    bound = columns_source(writer.disc("inf, inf, inf"), _parted(push)[1], by_x, by_xdot)
    unpacked = "A, B, Z = columns.A, columns.B, columns.Z"
    return [_function("variations(launch, time, z, u, n, p, work, columns)", body, unpacked), bound]


def _motion(writer: _Writer, force: Expression, forcing: Expression) -> list[str]:
    writer.whole = "g", forcing
    pulls = _terms(writer, forcing, "")
    writer.whole = "f", force
    pulls += _terms(writer, force, "-")
    return [*writer.lines, "total = 0.0", *pulls, "X[k + 2] = total * (one / ((k + 1) * (k + 2)))"]


def _function(head: str, body: list[str], unpacked: str = "") -> str:
    lines = [f"def {head}:", "    X, W = work.X, work.W", *([f"    {unpacked}"] if unpacked else [])]
    lines += ["    t = launch[0] + time", "    X[0] = p[0] + z", "    X[1] = u"]
    lines += ["    zero = 0 * (p[0] + z + u)", "    one = 1 + zero"]
    lines += ["    for k in range(n - 1):", "        part = one / max(k, 1)"]
    return "\n".join([*lines, *(f"        {line}" for line in body)]) + "\n"


def _linear_pull(writer: _Writer, slope: Expression, coefficient: str) -> list[str]:
    """Lines that take slope times a column, or times its derivative, from the sums."""
    if slope == number(0):
        return []
    names = (("by_x", "A"), ("by_v", "B"), ("by_tau", "Z"))
    if not names_in(slope) & MOVING:
        factor = writer.constant(slope)
        return [f"{total} -= {factor} * {coefficient.format(array, 'k')}" for total, array in names]
    series = _series(writer, slope)
    steps = [f"    {total} -= {series('i')} * {coefficient.format(array, '(k - i)')}" for total, array in names]
    return ["for i in range(0, k + 1):", *steps]


def _terms(writer: _Writer, tree: Expression, sign: str, total: str = "total") -> list[str]:
    steady, moving = _parted(tree)
    lines = [f"{total} {sign or '+'}= {_series(writer, part)('k')}" for part in moving]
    if steady != number(0):
        lines += ["if k == 0:", f"    {total} {sign or '+'}= {writer.constant(steady)}"]
    return lines


def _parted(tree: Expression) -> tuple[Expression, list[Expression]]:
    """A sum as its constant part and the rest."""
    parts = tree.terms if isinstance(tree, Sum) else (tree,)
    moving = [part for part in parts if names_in(part) & MOVING]
    return add(number(0), *(part for part in parts if not names_in(part) & MOVING)), moving


def _series(writer: _Writer, tree: Expression) -> _Series:
    if tree not in writer.known:
        writer.known[tree] = _made(writer, tree)
    return writer.known[tree]


def _made(writer: _Writer, tree: Expression) -> _Series:
    match tree:
        case Name("x"):
            return _Series("X[{}]")
        case Name("xdot"):
            target = writer.row()
            writer.emit(f"{target('k')} = (k + 1) * X[k + 1]")
            return target
        case Name("t"):
            target = writer.row(affine=True)
            writer.emit(f"{target('k')} = 1.0 if k == 1 else 0.0", "if k == 0:", f"    {target('k')} = t")
            return target
        case Sum():
            return _sum(writer, tree)
        case Product(factors):
            return _product(writer, factors)
        case Power(base, exponent):
            return _power(writer, base, exponent)
        case Call(function, argument):
            if function == "sqrt":
                return _power(writer, argument, Number(Fraction(1, 2)))
            if function not in _CALLS:
                raise InputError(
                    f"{tree} is not smooth, as f and g must be: round its corner, sqrt(u**2 + 1e-6) in place of abs(u)"
                )
            return _CALLS[function](writer, argument)
    raise TypeError(f"a constant has no series of its own: {tree}")


def _sum(writer: _Writer, tree: Expression) -> _Series:
    steady, moving = _parted(tree)
    parts = [_series(writer, part) for part in moving]
    target = writer.row(affine=all(part.affine for part in parts))
    writer.emit(f"{target('k')} = {' + '.join(part('k') for part in parts)}")
    if steady != number(0):
        writer.emit("if k == 0:", f"    {target('k')} += {writer.constant(steady)}")
    return target


def _product(writer: _Writer, factors: Sequence[Expression]) -> _Series:
    steady = [part for part in factors if not names_in(part) & MOVING]
    result, *rest = [_series(writer, part) for part in factors if names_in(part) & MOVING]
    for part in rest:
        result = writer.product(result, part)
    if not steady:
        return result
    target = writer.row(affine=result.affine)
    writer.emit(f"{target('k')} = {writer.constant(multiply(*steady))} * {result('k')}")
    return target


def _power(writer: _Writer, base: Expression, exponent: Expression) -> _Series:
    if isinstance(exponent, Number) and is_whole(exponent):
        return _whole_power(writer, _series(writer, base), int(exponent.value))
    if (argument := logistic_argument(Power(base, exponent))) is not None:
        return _logistic(writer, argument)
    if not names_in(exponent) & MOVING and names_in(base) & MOVING:
        return _general_power(writer, _series(writer, base), exponent)
    return _exp(writer, multiply(exponent, Call("log", base)))


def _whole_power(writer: _Writer, base: _Series, exponent: int) -> _Series:
    """By repeated squaring: no division, so the base may vanish."""
    result: _Series | None = None
    while True:
        if exponent & 1:
            result = base if result is None else writer.product(result, base)
        exponent >>= 1
        if not exponent:
            assert result is not None
            return result
        base = writer.product(base, base)


def _general_power(writer: _Writer, base: _Series, exponent: Expression) -> _Series:
    """w = b^q from b w' = q b' w."""
    target, power = writer.row(), writer.constant(exponent)
    writer.starts(
        target,
        f"real_power({base('0')}, {power})",
        "s = 0.0",
        "for i in range(1, k + 1):",
        f"    s += ({power} * i - (k - i)) * {base('i')} * {target('k - i')}",
        f"{target('k')} = quotient(s, k * {base('0')})",
    )
    return target


def _driven(target: _Series, inner: _Series, slope: _Series, sign: str = "") -> tuple[str, ...]:
    """Lines for target' = [sign] slope inner'; an affine inner function needs no sum."""
    if inner.affine:
        return (f"{target('k')} = {sign}{inner('1')} * {slope('k - 1')} * part",)
    return (
        "s = 0.0",
        "for i in range(1, k + 1):",
        f"    s += i * {inner('i')} * {slope('k - i')}",
        f"{target('k')} = {sign}s * part",
    )


def _exp(writer: _Writer, argument: Expression) -> _Series:
    inner, target = _series(writer, argument), writer.row()
    writer.starts(target, f"exp({inner('0')})", *_driven(target, inner, target))
    return target


def _circular(writer: _Writer, argument: Expression) -> tuple[_Series, _Series]:
    inner, sine, cosine = _series(writer, argument), writer.row(), writer.row()
    writer.known[Call("sin", argument)], writer.known[Call("cos", argument)] = sine, cosine
    writer.starts(sine, f"sin({inner('0')})", *_driven(sine, inner, cosine))
    writer.starts(cosine, f"cos({inner('0')})", *_driven(cosine, inner, sine, "-"))
    return sine, cosine


def _log(writer: _Writer, argument: Expression) -> _Series:
    if (inner := softplus_argument(Call("log", argument))) is not None:
        return _softplus(writer, inner)
    base, target = _series(writer, argument), writer.row()
    writer.starts(
        target,
        f"log({base('0')})",
        "s = 0.0",
        "for i in range(1, k):",
        f"    s += i * {target('i')} * {base('k - i')}",
        f"{target('k')} = quotient({base('k')} - s / k, {base('0')})",
    )
    return target


def _logistic(writer: _Writer, argument: Expression) -> _Series:
    """y = 1/(1 + e^w) from y' = -y (1 - y) w'; neither y nor y (1 - y) starts from a difference or from e^w > 1."""
    inner, target, slope = _series(writer, argument), writer.row(), writer.row()
    writer.starts(
        target,
        f"(exp(-abs({inner('0')})) if {inner('0')} > 0 else one) / (1 + exp(-abs({inner('0')})))",
        *_driven(target, inner, slope, "-"),
    )
    writer.starts(
        slope,
        f"exp(-abs({inner('0')})) / ((1 + exp(-abs({inner('0')}))) * (1 + exp(-abs({inner('0')}))))",
        f"s = {target('k')}",
        "for i in range(0, k + 1):",
        f"    s -= {target('i')} * {target('k - i')}",
        f"{slope('k')} = s",
    )
    return target


def _softplus(writer: _Writer, argument: Expression) -> _Series:
    """y = log(1 + e^w) from y' = w'/(1 + e^-w)."""
    logistic = Power(Sum((number(1), Call("exp", multiply(number(-1), argument)))), number(-1))
    inner, slope, target = _series(writer, argument), _series(writer, logistic), writer.row()
    writer.starts(
        target,
        f"({inner('0')} if {inner('0')} > 0 else zero) + log1p(exp(-abs({inner('0')})))",
        *_driven(target, inner, slope),
    )
    return target


def _atan(writer: _Writer, argument: Expression) -> _Series:
    """y' (1 + b^2) = b'."""
    inner = _series(writer, argument)
    square, target = writer.product(inner, inner), writer.row()
    writer.starts(
        target,
        f"atan({inner('0')})",
        "s = 0.0",
        "for i in range(1, k):",
        f"    s += i * {target('i')} * {square('k - i')}",
        f"{target('k')} = ({inner('k')} - s / k) / (1 + {square('0')})",
    )
    return target


def _riccati(writer: _Writer, argument: Expression, function: str, start: str, sign: str) -> _Series:
    """y' = (1 + sign y^2) b'; the row of 1 + sign y^2 starts from `start`, where nothing cancels."""
    inner, target, slope = _series(writer, argument), writer.row(), writer.row()
    # the derivative of the call, as `algebra.derivatives` writes it, need not be computed from its difference
    writer.known[slope_of_call(Call(function, argument))] = slope
    writer.starts(target, f"{function}({inner('0')})", *_driven(target, inner, slope))
    writer.starts(
        slope,
        start.format(w=inner("0"), y=target("0")),
        "s = 0.0",
        "for i in range(0, k + 1):",
        f"    s += {target('i')} * {target('k - i')}",
        f"{slope('k')} = {sign}s",
    )
    return target


# 1/cosh^2 w; its difference 1 - tanh^2 w would lose all digits where tanh saturates
SECH_SQUARE = "4 * exp(-2 * abs({w})) / ((1 + exp(-2 * abs({w}))) * (1 + exp(-2 * abs({w}))))"

_CALLS: dict[str, Callable[[_Writer, Expression], _Series]] = {
    "exp": _exp,
    "sin": lambda writer, argument: _circular(writer, argument)[0],
    "cos": lambda writer, argument: _circular(writer, argument)[1],
    "log": _log,
    "atan": _atan,
    "tan": lambda writer, argument: _riccati(writer, argument, "tan", "1 + {y} * {y}", ""),
    "tanh": lambda writer, argument: _riccati(writer, argument, "tanh", SECH_SQUARE, "-"),
}
