"""Text and sympy objects into expression trees, through a whitelist of names and operations.

Nothing here evaluates text as code.  What is refused is refused before it can cost time or memory: the length of the
text, its depth, and the size of a constant power are bounded (`Limits`).
"""

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from fractions import Fraction
from itertools import islice
from typing import Any

from singimpact.algebra import expressions
from singimpact.algebra.expressions import Expression, Number
from singimpact.inputs import InputError, meant, need, shown


@dataclass(frozen=True)
class Limits:
    """Limits of an expression; a model of mechanics stays far below each of them.

    Parameters
    ----------
    parts : of the argument of a function that is written out, in which it stands several times.
    zeros : evaluations of a part of a function while its one root is told from others; 0.2 s measured.
    roots : in a text.
    """

    characters: int = 10_000
    depth: int = 60
    digits: int = 4_000
    exponent: int = 1_000
    parts: int = 500
    zeros: int = 8_000
    roots: int = 20


LIMITS = Limits()
_TOKEN = re.compile(
    r"\s*(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|(?P<name>[^\W\d]\w*)|(?P<sign>\*\*|[-+*/(),^.]))", re.ASCII
)
# Analytic functions in terms of `FUNCTIONS`, which are put in when an expression is read
DEFINITIONS = {
    "sinh": "(exp(w) - exp(-w))/2",
    "cosh": "(exp(w) + exp(-w))/2",
    "asin": "atan(w/sqrt(1 - w**2))",
    "acos": "pi/2 - atan(w/sqrt(1 - w**2))",
    "asinh": "log((1 + sqrt(1 + w**2) + w)/(1 + sqrt(1 + w**2) - w))",
    "acosh": "log(w + sqrt(w**2 - 1))",
    "atanh": "log((1 + w)/(1 - w))/2",
    "sec": "1/cos(w)",
    "csc": "1/sin(w)",
    "cot": "cos(w)/sin(w)",
    "expm1": "exp(w) - 1",
    "exp2": "2**w",
    "log1p": "log(1 + w)",
    "log2": "log(w)/log(2)",
    "log10": "log(w)/log(10)",
}
_LANGUAGE = f"numbers, + - * / **, pi and {' '.join(expressions.FUNCTIONS)} {' '.join(DEFINITIONS)}"
SYNONYMS = {"ln": "log", "Abs": "abs", "fabs": "abs", "absolute": "abs"} | {
    f"arc{name[1:]}": name for name in ("atan", "asin", "acos", "asinh", "acosh", "atanh")
}
# What stands for functions that are not smooth, with a small number eps
SMOOTH = {
    "sign": "tanh(w/eps) for sign(w)",
    "Heaviside": "(1 + tanh(w/eps))/2 for Heaviside(w)",
    "Max": "(a + b + sqrt((a - b)**2 + eps**2))/2 for Max(a, b)",
    "Min": "(a + b - sqrt((a - b)**2 + eps**2))/2 for Min(a, b)",
    "Piecewise": "left + (right - left)*(1 + tanh(w/eps))/2 for the two sides of w = 0",
}
ROUGH = {"sgn": "sign", "heaviside": "Heaviside", "where": "Piecewise"} | {
    name: name.title()[:3] for name in ("max", "min", "maximum", "minimum")
}


def parse(text: str, names: Iterable[str] = (), what: str = "expression") -> Expression:
    """The tree of a text.

    Parameters
    ----------
    text : the expression, e.g. ``"x + 0.1*xdot"``; numbers are exact decimals.
    names : the variables and parameters that may occur.
    what : what to call the input in an error.

    Raises
    ------
    InputError : in one line, for anything outside the language.

    Examples
    --------
    >>> print(parse("x + 0.1*xdot + x**3/4", ["x", "xdot"]))
    x + 0.1*xdot + 0.25*x**3
    >>> parse("__import__('os')")
    Traceback (most recent call last):
    singimpact.inputs.InputError: expression = "__import__('os')" is not accepted: unknown function '__import__'; \
accepted are numbers, + - * / **, pi and sin cos tan exp log sqrt tanh atan abs sinh cosh asin acos asinh acosh atanh \
sec csc cot expm1 exp2 log1p log2 log10
    """
    if len(text) > LIMITS.characters:
        raise InputError(f"{what} has {len(text)} characters: at most {LIMITS.characters} are accepted")
    return _Parser(text, tuple(names), what).whole()


def defined(name: str) -> Callable[[Expression], Expression] | None:
    """A function of trees by its name, its own or another; None for one that is not accepted.

    Examples
    --------
    >>> sinh = defined("sinh")
    >>> print(sinh(expressions.Name("x")), defined("gamma"))
    0.5*(exp(x) - exp(-x)) None
    """
    name = SYNONYMS.get(name, name)
    if name in expressions.FUNCTIONS:
        return lambda argument: expressions.Call(name, argument)
    if name not in DEFINITIONS:
        return None
    definition = parse(DEFINITIONS[name], ("w",))

    def written_out(argument: Expression) -> Expression:
        if sum(1 for _ in islice(expressions.walk(argument), LIMITS.parts)) == LIMITS.parts:
            raise InputError(f"the argument of {name} has {LIMITS.parts} parts or more")
        return expressions.substitute(definition, {"w": argument})

    return written_out


def refused_function(name: str) -> str:
    """The sentence about a function that is not accepted."""
    name = ROUGH.get(name, name)
    if name in SMOOTH:
        return f"{name} is not smooth: write {SMOOTH[name]}, with a small number in place of eps, such as 0.01"
    return f"unknown function {shown(name)}; accepted are {_LANGUAGE}"


class _Parser:
    """Precedence climbing over the tokens of one text."""

    def __init__(self, text: str, names: tuple[str, ...], what: str) -> None:
        self.text, self.names, self.what = text.rstrip(), names, what
        self.at = self.depth = self.roots = 0
        self.token = self.kind = ""
        self.before = "", ""
        self.advance()

    def refusal(self, reason: str) -> InputError:
        return InputError(f"{self.what} = {shown(self.text)} is not accepted: {reason}")

    def advance(self) -> None:
        if self.at == len(self.text):
            self.token, self.kind = "", "end"
            return
        token = _TOKEN.match(self.text, self.at)
        if token is None:
            bad = self.text[self.at :].lstrip()[0]
            if bad in "'\N{RIGHT SINGLE QUOTATION MARK}\N{PRIME}" and "xdot" in self.names:
                raise self.refusal("the velocity x' is written xdot")
            raise self.refusal(f"the character {bad!r} has no meaning here; accepted are {_LANGUAGE}")
        self.before = self.kind, self.token
        self.at = token.end()
        self.kind = str(token.lastgroup)
        self.token = token.group(self.kind)

    def take(self, sign: str) -> bool:
        if self.kind == "sign" and self.token == sign:
            self.advance()
            return True
        return False

    def whole(self) -> Expression:
        if self.kind == "end":
            raise self.refusal(f"it is empty; accepted are {_LANGUAGE}")
        tree = self.sum()
        if self.kind != "end":
            raise self.refusal(self.unexpected())
        return tree

    def unexpected(self) -> str:
        if self.token == "^":
            return "'^' has no meaning here; write a power as **"
        if self.token == ".":
            return f"'.' has no meaning here (there are no attributes); accepted are {_LANGUAGE}"
        if not self.token:
            return "it ends too early"
        kind, before = self.before
        if self.token in ("deg", "degree", "degrees"):
            return f"angles are in radians: write {shown(before)[1:-1]}*pi/180"
        if (kind in ("number", "name") or before == ")") and (self.kind in ("number", "name") or self.token == "("):
            return f"a product is written with its *, {shown(f'{before}*{self.token}')[1:-1]}"
        return f"{shown(self.token)} is out of place"

    def sum(self) -> Expression:
        self.depth += 1
        if self.depth > LIMITS.depth:
            raise self.refusal(f"it is nested deeper than {LIMITS.depth} levels")
        terms = [self.product()]
        while self.kind == "sign" and self.token in "+-":
            minus = self.token == "-"
            self.advance()
            terms.append(expressions.negate(self.product()) if minus else self.product())
        self.depth -= 1
        return expressions.add(*terms) if len(terms) > 1 else terms[0]

    def product(self) -> Expression:
        factors = [self.signed()]
        while self.kind == "sign" and self.token in ("*", "/"):
            divide = self.token == "/"
            self.advance()
            factor = self.signed()
            factors.append(self.raised(factor, expressions.MINUS_ONE) if divide else factor)
        return expressions.multiply(*factors) if len(factors) > 1 else factors[0]

    def signed(self) -> Expression:
        minus = False
        while self.kind == "sign" and self.token in ("+", "-"):
            minus ^= self.token == "-"
            self.advance()
        tree = self.powered()
        return expressions.negate(tree) if minus else tree

    def powered(self) -> Expression:
        base = self.atom()
        if not self.take("**"):
            return base
        self.depth += 1
        if self.depth > LIMITS.depth:
            raise self.refusal(f"it is nested deeper than {LIMITS.depth} levels")
        exponent = self.signed()
        self.depth -= 1
        return self.raised(base, exponent)

    def raised(self, base: Expression, exponent: Expression) -> Expression:
        try:
            return bounded_power(base, exponent)
        except InputError as error:
            raise self.refusal(str(error)) from None

    def atom(self) -> Expression:
        token, kind = self.token, self.kind
        if kind == "number":
            self.advance()
            return self.number(token)
        if kind == "name":
            self.advance()
            return self.named(token)
        if self.take("("):
            tree = self.sum()
            if not self.take(")"):
                raise self.refusal(self.unexpected() if self.kind != "end" else "a bracket is not closed")
            return tree
        raise self.refusal(self.unexpected())

    def number(self, token: str) -> Expression:
        exponent = re.search(r"[eE]([+-]?\d+)$", token)
        if len(token) > LIMITS.digits or (exponent and (len(exponent[1]) > 6 or abs(int(exponent[1])) > LIMITS.digits)):
            raise self.refusal(f"a number has more than {LIMITS.digits} digits")
        return Number(Fraction(token))

    def root(self) -> Expression:
        """root(function of u, low, high): the one zero between two rationals."""
        from singimpact.algebra.isolated_zeros import is_one_root

        outer, self.names = self.names, (expressions.BOUND,)
        function = self.sum()
        self.names, ends = outer, []
        while self.take(","):
            ends.append(self.sum())
        if not self.take(")") or len(ends) != 2 or not all(isinstance(end, Number) for end in ends):
            raise self.refusal("root takes a function of u and two rationals, root(u**2 - 2, 1, 2)")
        low, high = (end.value for end in ends if isinstance(end, Number))
        root_ = expressions.Root(function, low, high)
        self.roots += 1
        if self.roots > LIMITS.roots:
            raise self.refusal(f"it has more than {LIMITS.roots} roots")
        pieces = LIMITS.zeros // (self.roots**2 * sum(1 for _ in expressions.walk(function)))
        if not low < high or not is_one_root(root_, pieces):
            raise self.refusal(
                f"{shown(str(root_))} is not one zero: the function must change sign once between the two numbers"
            )
        return root_

    def named(self, token: str) -> Expression:
        if token == "root" and self.take("("):
            return self.root()
        if self.kind == "sign" and self.token == "(":
            function = defined(token)
            if function is None:
                raise self.refusal(refused_function(token))
            self.advance()
            argument = self.sum()
            if not self.take(")"):
                raise self.refusal(f"{token} takes one argument" if self.token == "," else "a bracket is not closed")
            try:
                return function(argument)
            except InputError as error:
                raise self.refusal(str(error)) from None
        if self.token == "." and token in ("np", "numpy", "math", "sympy", "sp", "cmath"):
            raise self.refusal(f"write the names of functions and numbers without {token}., as in cos(2*t)")
        if token in self.names:
            return expressions.Name(token)
        if token == "pi":
            return expressions.Pi()
        raise self.refusal(unknown_name(token, self.names))


def unknown_name(token: str, names: Iterable[str]) -> str:
    """The sentence about a symbol that has no value."""
    known = list(names)
    instead = meant(token, known)
    hint = f"; did you mean {instead}?" if instead else ""
    if token == "t" and "xdot" in known:
        hint = "; what depends on t is g, and a force that depends on x and t together is not accepted"
    listed = f"known names are {', '.join(known)}" if known else "a number is expected here"
    return f"the symbol {shown(token)} has no value ({listed}){hint}"


def bounded_power(base: Expression, exponent: Expression) -> Expression:
    """base ** exponent, refused when the exact result would be huge or is a division by zero."""
    if isinstance(exponent, Number):
        if abs(exponent.value) > LIMITS.exponent or exponent.value.denominator > LIMITS.exponent:
            raise InputError(
                f"the exponent {shown(exponent.value)} is too large; at most {LIMITS.exponent} is accepted"
            )
        if isinstance(base, Number) and expressions.bits_of_power(base, exponent) > expressions.FOLDING.bits:
            raise InputError(f"a constant power has more than {expressions.FOLDING.bits} bits")
    try:
        return expressions.power(base, exponent)
    except ZeroDivisionError:
        raise InputError("it divides by zero") from None


def from_sympy(tree: Any, names: Iterable[str] = (), what: str = "expression") -> Expression:
    """The tree of a sympy expression, through the same whitelist; a sympy Float means its exact binary value."""
    known = tuple(names)
    if sum(1 for _ in _first(tree, LIMITS.characters)) >= LIMITS.characters:
        raise InputError(f"{what} has more than {LIMITS.characters} parts: it is too large")
    try:
        return _convert(tree, known, 0)
    except InputError as error:
        raise InputError(f"{what} = {shown(tree)} is not accepted: {error}") from None


def _first(tree: Any, count: int) -> Iterable[Any]:
    stack = [tree]
    while stack and count:
        part = stack.pop()
        count -= 1
        yield part
        stack.extend(part.args)


def _convert(tree: Any, names: tuple[str, ...], depth: int) -> Expression:
    kind = type(tree).__name__
    if depth > LIMITS.depth:
        raise InputError(f"it is nested deeper than {LIMITS.depth} levels")
    if tree.is_Rational:
        return Number(Fraction(int(tree.p), int(tree.q)))
    if tree.is_Float:
        need(tree.is_finite, InputError("it contains a number that is not finite"))
        sign, mantissa, exponent, _ = tree._mpf_
        return Number((-1 if sign else 1) * Fraction(int(mantissa)) * Fraction(2) ** int(exponent))
    if kind == "Pi":
        return expressions.Pi()
    if tree.is_Symbol:
        if tree.name not in names:
            raise InputError(unknown_name(tree.name, names))
        return expressions.Name(tree.name)
    if kind == "Exp1":
        return expressions.Call("exp", Number(Fraction(1)))
    parts = [_convert(argument, names, depth + 1) for argument in tree.args]
    if tree.is_Add:
        return expressions.add(*parts)
    if tree.is_Mul:
        return expressions.multiply(*parts)
    if tree.is_Pow:
        half = isinstance(parts[1], Number) and parts[1].value == Fraction(1, 2)
        return expressions.Call("sqrt", parts[0]) if half else bounded_power(parts[0], parts[1])
    function = defined(kind) if len(parts) == 1 else None
    if function is None:
        rough = ROUGH.get(kind, kind) in SMOOTH
        raise InputError(refused_function(kind) if rough else f"{shown(kind)} is not one of {_LANGUAGE}")
    return function(parts[0])
