"""The source of a bound: how far F = g - f along a Taylor polynomial can be from its value at the start, on a disc.

The recurrence gives a polynomial P of degree n with P'' = F up to s^(n-2).  If F is analytic on |s| <= R and
|F(s) - F(0)| <= M there, Cauchy's estimate bounds the coefficients that P leaves out by M/R^k.  M comes from the
expression tree in disc arithmetic: every part has a centre, which the recurrence has computed, and a radius.  A part
that may be singular on the disc has the radius inf, so no pole, branch point or kink is missed, whatever the function
is called.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from fractions import Fraction

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
    power,
)

MOVING = frozenset({"x", "xdot", "t"})
LEAVES = {"x": "r_x", "xdot": "r_xdot", "t": "R"}
ENTIRE = ("exp", "sin", "cos")


@dataclass
class DiscWriter:
    """Radii of the parts of a tree, as lines of source.

    Parameters
    ----------
    centre : gives the source of the centre of a part. constant : gives the source of a constant part.
    refusal : what is returned where a part may be singular; "" goes on with inf.
    unit : "", or the source of a relative rounding error that every part adds to its radius.

    Attributes
    ----------
    lines : one assignment a part. suspects : parts that may be singular; the k-th is reported as the number k + 1.
    """

    centre: Callable[[Expression], str]
    constant: Callable[[Expression], str]
    refusal: str = "inf, {}"
    unit: str = ""
    lines: list[str] = field(default_factory=list)
    suspects: list[Expression] = field(default_factory=list)
    known: dict[Expression, str] = field(default_factory=dict)

    def radius(self, tree: Expression) -> str:
        """The name of the radius of a part that moves."""
        if isinstance(tree, Name):
            return LEAVES[tree.name]
        if tree not in self.known:
            text = self._bound(tree) + (f" + {self.unit} * {self._rounded(tree)}" if self.unit else "")
            name = f"r_{len(self.known)}"
            self.lines.append(f"{name} = {text}")
            self.known[tree] = name
            if self.refusal and _may_be_singular(tree):
                self.suspects.append(tree)
                self.lines += [f"if not {name} < 1e280:", f"    return {self.refusal.format(len(self.suspects))}"]
        return self.known[tree]

    def _rounded(self, tree: Expression) -> str:
        """The sizes to which the rounding error of a part is relative: its value, and the constant that it adds."""
        steady = [term for term in tree.terms if not moves(term)] if isinstance(tree, Sum) else []
        constants = [f"abs({self.constant(add(number(0), *steady))})"] if steady else []
        return " + ".join([f"abs({self.centre(tree)})", *constants]).join("()")

    def _bound(self, tree: Expression) -> str:
        match tree:
            case Sum(terms):
                if (call := call_of_slope(tree)) is not None:
                    return f"whole_power_radius({self.centre(call)}, {self.radius(call)}, 2)"
                return " + ".join(self.radius(term) for term in terms if moves(term))
            case Product(factors):
                return self._product(factors)
            case Power(base, exponent):
                return self._power(tree, base, exponent)
            case Call(function, argument):
                return self._call(tree, function, argument)
        raise TypeError(f"no part of a force: {tree!r}")

    def _product(self, factors: tuple[Expression, ...]) -> str:
        steady = [factor for factor in factors if not moves(factor)]
        moving = [factor for factor in factors if moves(factor)]
        size, radius, *others = [text for part in moving for text in (f"abs({self.centre(part)})", self.radius(part))]
        for other, more in zip(others[::2], others[1::2], strict=True):
            # |uv - u0 v0| <= r_u (|v0| + r_v) + |u0| r_v; one line a factor, as Python nests 200 brackets at most
            self.lines.append(f"of_all, size = {radius} * ({other} + {more}) + {size} * {more}, {size} * {other}")
            size, radius = "size", "of_all"
        return f"abs({self.constant(multiply(*steady))}) * {radius}" if steady else radius

    def _power(self, tree: Expression, base: Expression, exponent: Expression) -> str:
        if is_whole(exponent):
            return f"whole_power_radius({self.centre(base)}, {self.radius(base)}, {exponent})"
        value = self.centre(tree)
        if moves(exponent):  # e^(exponent log base)
            inner = multiply(exponent, Call("log", base))
            return f"exp_radius({value}, {self.centre(inner)}, {self.radius(inner)})"
        # 1/(1 + e^w) = (1 - tanh(w/2))/2: poles of tanh alone, and no overflow
        if (argument := logistic_argument(tree)) is not None:
            return f"0.5 * tanh_radius({self.centre(argument)} * 0.5, {self.radius(argument)} * 0.5)"
        return self._shaped(base, exponent, "power", f"{value}, ")

    def _call(self, tree: Expression, function: str, argument: Expression) -> str:
        value = self.centre(tree)
        match function:
            case "sqrt":
                return self._shaped(argument, Number(Fraction(1, 2)), "power", f"{value}, ")
            case "log":
                if (inner := softplus_argument(tree)) is not None:
                    return f"softplus_radius({self.centre(inner)}, {self.radius(inner)})"
                return self._shaped(argument, None, "log", "")
        centre, radius = self.centre(argument), self.radius(argument)
        match function:
            case "exp":
                plain = f"exp_radius({value}, {centre}, {radius})"
                square = square_in(argument)
                if square is None or square.shift is not None:
                    return plain
                at = f"{self.centre(square.root)}, {self.radius(square.root)}"
                return f"min({plain}, bell_radius({value}, {at}, -{self.constant(square.factor)}))"
            case "sin" | "cos":
                # |sin(u + d) - sin u| <= |cos u| |sin d| + |sin u| |1 - cos d| on the disc
                other = Call("cos" if function == "sin" else "sin", argument)
                return f"circular_radius({value}, {self.centre(other)}, {radius})"
            case "tan":
                return f"tan_radius({value}, {radius})"
        return f"{function}_radius({centre}, {radius})"

    def _shaped(self, base: Expression, exponent: Expression | None, kind: str, value: str) -> str:
        """The bound of base^exponent or log(base), and the better one where base = kappa + w^2."""
        at = f"{self.centre(base)}, {self.radius(base)}"
        last = "" if exponent is None else f", {self.constant(exponent)}"
        plain = f"{kind}_radius({value}{at}{last})"
        square = square_in(base)
        if square is None or square.shift is None:
            return plain
        root = f"{self.centre(square.root)}, {self.radius(square.root)}"
        kappa = f"{self.constant(square.shift)}, {self.constant(square.factor)}"
        return f"min({plain}, {kind}_of_square_radius({value}{root}{last}, {kappa}))"


@dataclass(frozen=True)
class Square:
    """shift + factor root^2 with constants shift (None for 0) and factor."""

    root: Expression
    factor: Expression
    shift: Expression | None


def moves(tree: Expression) -> bool:
    """Whether a part depends on x, x' or t."""
    return bool(names_in(tree) & MOVING)


def is_whole(exponent: Expression) -> bool:
    """Whether a power is computed by products."""
    return isinstance(exponent, Number) and exponent.value.denominator == 1 and 1 <= exponent.value <= 1000


def square_in(tree: Expression) -> Square | None:
    """A tree as a constant plus a multiple of a square, if it is one.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> square = square_in(parse("2 + 3*(x - 1)**2", ["x"]))
    >>> print(square.root, square.factor, square.shift)
    x - 1 3 2
    """
    parts = tree.terms if isinstance(tree, Sum) else (tree,)
    moving = [term for term in parts if moves(term)]
    steady = [term for term in parts if not moves(term)]
    if len(moving) != 1 or len(steady) > 1:
        return None
    factors = moving[0].factors if isinstance(moving[0], Product) else (moving[0],)
    roots = [factor for factor in factors if moves(factor)]
    if len(roots) != 1 or not isinstance(roots[0], Power) or roots[0].exponent != number(2):
        return None
    factor = multiply(number(1), *(factor for factor in factors if not moves(factor)))
    return Square(roots[0].base, factor, steady[0] if steady else None)


def _one_plus_exp(tree: Expression) -> Expression | None:
    """w of 1 + e^w."""
    if isinstance(tree, Sum) and len(tree.terms) == 2 and number(1) in tree.terms:
        (other,) = (term for term in tree.terms if term != number(1))
        if isinstance(other, Call) and other.function == "exp" and moves(other):
            return other.argument
    return None


def logistic_argument(tree: Expression) -> Expression | None:
    """w of 1/(1 + e^w), which is computed so that e^w may overflow."""
    return _one_plus_exp(tree.base) if isinstance(tree, Power) and tree.exponent == number(-1) else None


def softplus_argument(tree: Expression) -> Expression | None:
    """w of log(1 + e^w)."""
    return _one_plus_exp(tree.argument) if isinstance(tree, Call) and tree.function == "log" else None


def slope_of_call(call: Call) -> Expression:
    """1 - tanh^2 or 1 + tan^2, as derivatives write it; its series is computed without the difference."""
    sign = number(-1 if call.function == "tanh" else 1)
    return add(number(1), multiply(sign, power(call, number(2))))


def call_of_slope(tree: Sum) -> Call | None:
    """The call whose `slope_of_call` a sum is."""
    for term in tree.terms:
        parts = term.factors if isinstance(term, Product) else (term,)
        for part in parts:
            if isinstance(part, Power) and isinstance(part.base, Call) and part.base.function in ("tanh", "tan"):
                return part.base if slope_of_call(part.base) == tree else None
    return None


def _may_be_singular(tree: Expression) -> bool:
    match tree:
        case Power(_, exponent):
            return not is_whole(exponent) and not moves(exponent)
        case Call(function, _):
            return function not in ENTIRE
    return False


# How far a polynomial and its derivative move on the disc
SUMS = """{1}, {1}dot, power = R * abs({0}[1]), 0 * R, R
for k in range(2, n + 1):
    power *= R
    {1} += abs({0}[k]) * power
    {1}dot += k * abs({0}[k]) * power
{1}dot /= R""".splitlines()


def disc_source(writer: DiscWriter, parts: list[Expression]) -> str:
    """The text of `disc(X, W, n, R, p)`: the bound for the sum of the parts, and which suspect has none, else 0."""
    total = [writer.radius(part) for part in parts]
    lines = [*(line.format("X", "r_x") for line in SUMS), *writer.lines, f"return {_sum(total)}, 0"]
    return _function("disc(X, W, n, R, p)", lines)


def columns_source(writer: DiscWriter, push: list[Expression], by_x: Expression, by_xdot: Expression) -> str:
    """The text of `disc_of_columns(work, columns, n, R, p)`: the bounds for the right-hand sides of three columns.

    Parameters
    ----------
    push : moving parts of g'. by_x, by_xdot : derivatives of f.
    """
    pushed = _sum([writer.radius(term) for term in push])
    slopes = [(by_x, "{0}[0]", "r_{1}"), (by_xdot, "{0}[1]", "r_{1}dot")]
    parts = []
    for slope, centre, radius in slopes:
        if moves(slope):
            size, more = f"abs({writer.centre(slope)})", writer.radius(slope)
            parts.append(f"({size} + {more}) * {radius} + abs({centre}) * {more}")
        elif slope != number(0):
            parts.append(f"abs({writer.constant(slope)}) * {radius}")
    lines = ["X, W, A, B, Z = work.X, work.W, columns.A, columns.B, columns.Z"]
    lines += [line.format(name, f"r_{name.lower()}") for name in "XABZ" for line in SUMS]
    bounds = [_sum([term.format(name, name.lower()) for term in parts]) for name in "ABZ"]
    lines += [*writer.lines, f"return {bounds[0]}, {bounds[1]}, {bounds[2]} + {pushed}"]
    return _function("disc_of_columns(work, columns, n, R, p)", lines)


def rounding_source(writer: DiscWriter, parts: list[Expression], steady: list[Expression]) -> str:
    """The text of `rounding(X, W, unit, p)`: how well x'' is known where every operation has the relative error unit.

    Parameters
    ----------
    parts : moving parts of g and f. steady : their constant parts.
    """
    radii = [writer.radius(term) for term in parts]
    sizes = [writer.centre(term) for term in parts]
    sizes += [writer.constant(term) for term in steady if term != number(0)]
    time = f"unit * abs({writer.centre(Name('t'))})" if any("t" in names_in(term) for term in parts) else "0 * unit"
    lines = [
        f"r_x, r_xdot, R = unit * abs(X[0]), unit * abs(X[1]), {time}",
        *writer.lines,
        f"return {' + '.join([*radii, *(f'unit * abs({size})' for size in sizes)]) or '0 * unit'}",
    ]
    return _function("rounding(X, W, unit, p)", lines)


def _sum(parts: list[str]) -> str:
    return " + ".join(parts) or "0 * R"


def _function(head: str, lines: list[str]) -> str:
    return f"def {head}:\n" + "\n".join(f"    {line}" for line in lines) + "\n"
