"""The series of the theory to any order, for generic symbols or for a model, as data and in every format."""

import json
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from keyword import iskeyword
from typing import Any

import sympy
from mpmath.libmp import to_str
from sympy.printing.str import StrPrinter

from singimpact.algebra import Balls, balls_at
from singimpact.codegen.polynomial_source import RATIO_SOURCE, Coefficient, Exponents, function_source, module_source
from singimpact.documents.document_steps import Section, Step
from singimpact.inputs import InputError, need, unknown
from singimpact.oscillator.model import Oscillator
from singimpact.theory import (
    COMMAND,
    HIGHEST,
    HIGHEST_NUMBERS,
    LIMITS,
    TRUST,
    FoldForm,
    Place,
    PowerSeries,
    chatter_limit,
    curve_functions,
    dynamics_on_gamma,
    fibre,
    gamma,
    latex,
    normal_form,
    place,
    points_of,
    r_of_lambda,
    sheet_functions,
    v_c,
)

NAMES = {0: "generic", 1: "tangency", 2: "swan"}
POINTS = ("a regular point", "a tangency point with $a' > 0$", "a swan point with $a'' < 0$")  # where gamma ends
VALID = 1e-12  # the error that `valid` of a series allows
DIGITS_BITS = 160  # bits that hold 30 digits of tau_*
PIECE = 1800  # characters of LaTeX in one displayed equation, at most about half a page


@dataclass(frozen=True)
class Series:
    """One series.

    Attributes
    ----------
    name : a Python name, such as v_c_tangency. says : what it is, in words. left : the left-hand side, LaTeX.
    variables : its small variables. order : the last degree.
    terms : exponents of the variables -> sympy coefficient. expression : the whole in sympy.
    valid : radius of the small variables within which the cut series is accurate to VALID, estimated from the terms
        that follow: relative to its value, for v_c relative to the sum of the sizes of its terms. None with symbols,
        and where no further term is computed.
    """

    name: str
    says: str
    left: str
    variables: tuple[str, ...]
    order: int
    terms: Mapping[Exponents, Any]
    expression: Any
    valid: float | None = None


def _of_power_series(name: str, says: str, left: str, answer: PowerSeries) -> Series:
    terms: dict[Exponents, Any] = {(n,): value for n, value in answer.coefficients.items() if value != 0}
    return Series(
        name,
        says,
        left,
        (answer.variable,),
        answer.order,
        terms,
        answer.as_expr(),
        answer.valid_within(VALID) if answer.further else None,
    )


def _of_polynomial(
    name: str,
    says: str,
    left: str,
    variables: tuple[str, ...],
    order: int,
    further: int | None,
    to: Callable[[int], Any],
) -> Series:
    """A series from its polynomial `to` an order; `valid` is estimated from the one to a further order."""
    polynomial = to(order)
    valid = None if further is None else _valid_box(order, _terms_of(to(further), variables))
    return Series(name, says, left, variables, order, _terms_of(polynomial, variables), polynomial, valid)


def _terms_of(found: Any, variables: Sequence[str]) -> dict[Exponents, Any]:
    letters = [sympy.Symbol(each) for each in variables]
    return {tuple(map(int, key)): value for key, value in sympy.Poly(found, *letters).terms()}


def _valid_box(order: int, terms: Mapping[Exponents, Any]) -> float:
    """The largest box |variable| <= radius on which the terms above the order are small beside those up to it.

    The terms of a degree are bounded by the sum of their sizes times radius^degree, so one variable is left.
    """
    sizes: dict[int, float] = {}
    for key, value in terms.items():
        sizes[sum(key)] = sizes.get(sum(key), 0.0) + abs(float(value))
    kept, further = ({n: size for n, size in sizes.items() if (n > order) == cut} for cut in (False, True))
    return PowerSeries("radius", order, kept, further=further or {order + 1: 0.0}).valid_within(VALID)


@dataclass(frozen=True)
class SeriesRequest:
    """The model, the point and the order of the series to be written.

    Attributes
    ----------
    order : total degree, at least 3; with symbols each series stops at the highest order that it is taken to.
    model : without one, symbols stand for the jets. tau : a point of the model; without it its tangency and swan
        points. keep : parameters that stay letters. digits : of numbers.
    """

    order: int = 6
    model: Oscillator | None = None
    tau: str | None = None
    keep: Sequence[str] = ()
    digits: int = 30

    def __post_init__(self) -> None:
        if isinstance(self.order, bool) or not isinstance(self.order, int) or not 3 <= self.order <= 40:
            raise InputError(f"order = {self.order} is not accepted: an integer from 3 to 40")
        if self.model is None and (self.tau is not None or self.keep):
            raise InputError("tau and keep belong to a model: give one")

    def of(self, function: Callable[..., Any], order: int, **at: Any) -> Any:
        """The value of a function of the theory for this model, point and letters."""
        return function(order, model=self.model, tau=self.tau, digits=self.digits, keep=self.keep, **at)

    def capped(self, most: int) -> int:
        """The order, or the highest with symbols."""
        return min(self.order, most) if self.model is None or self.keep else self.order

    def longer(self, order: int, most: int) -> int | None:
        """The order to which terms are computed to estimate `valid`; None with symbols, and at the highest order."""
        beyond = min(order + TRUST.further, most)
        return None if self.model is None or self.keep or beyond <= order else beyond

    def point(self, j: int) -> Place | None:
        """The point of contact order j at which the series are expanded; None with symbols."""
        return None if self.model is None or self.keep else place(self.model, j, self.tau)

    def contact_orders(self) -> list[int]:
        """The contact orders of the points at which series are written."""
        if self.model is None or (self.keep and self.tau is None):
            return [0, 1, 2]
        return points_of(self.model, self.tau)


def series(request: SeriesRequest) -> Iterator[Series]:
    """The series, one after the other.

    Examples
    --------
    >>> [each.name for each in series(SeriesRequest(3))][:3]
    ['v_c_generic', 'fibre', 'chatter_limit']
    >>> next(series(SeriesRequest(3))).terms[(0, 1)]
    -a/2
    """
    for j in request.contact_orders():
        at, top = NAMES[j], request.capped(LIMITS.sheet)
        what = f"Launch velocity of the flight that lands after $t$, at a {at} point"
        further, sheet_to = request.longer(top, LIMITS.sheet_numbers), partial(request.of, v_c, at=at)
        yield _of_polynomial(f"v_c_{at}", what, "v_c", ("sigma", "t"), top, further, sheet_to)
        yield from _at_regular(request) if j == 0 else _on_gamma(request, at, j)


def _at_regular(request: SeriesRequest) -> Iterator[Series]:
    what = "Velocity on the stable fibre, where chatter ends at $\\sigma = 0$"
    yield _of_power_series("fibre", what, "v", request.of(fibre, request.capped(LIMITS.curve)))
    ends = request.of(chatter_limit, request.capped(LIMITS.completion))
    yield _of_power_series("chatter_limit", "End of complete chatter", r"\tau_\infty - \tau", ends)


def _on_gamma(request: SeriesRequest, at: str, j: int) -> Iterator[Series]:
    along = request.of(gamma, max(request.capped(LIMITS.curve), j + 1), at=at)
    yield _of_power_series(f"gamma_{at}", f"Velocity on the invariant curve at a {at} point", "v", along)
    motion = request.of(dynamics_on_gamma, max(request.capped(LIMITS.curve) - j, 1), at=at)
    yield _of_power_series(f"motion_{at}", "The next impact on it", r"\bar\sigma", motion)
    if j == 1 and not request.keep:
        top = request.capped(HIGHEST["tangency"])
        what = "The outline of $p$, the image of the horizon"
        further, outline_to = request.longer(top, HIGHEST_NUMBERS), partial(_outline, request)
        yield _of_polynomial("outline_tangency", what, "v", ("sigma",), top, further, outline_to)


def _outline(request: SeriesRequest, top: int) -> Any:
    form = normal_form(top, "tangency", request.model, request.tau, request.digits)
    return form.outline_of_p if isinstance(form, FoldForm) else form.offset


def series_text(request: SeriesRequest, form: str) -> str:
    """All series as a file of ``sympy`` assignments, as ``numpy`` source that runs by itself, or as ``json``.

    Examples
    --------
    >>> print(series_text(SeriesRequest(3), "sympy").splitlines()[-7][:56])
    v_c_tangency = -a_d1*sigma*t/2 - a_d1*t**2/6 - a_d2*sigm
    """
    if form == "numpy" and request.model is None:
        sheets, curves = sheet_functions(request.capped(LIMITS.sheet)), curve_functions(request.order)
        return module_source(f"Series to order {request.order} in jets.", COMMAND, [*sheets, *curves])
    answers = list(series(request))
    if form == "numpy":
        points = {name: repr(float(text)) for name, text in _points(request).items()}
        valid = {item.name: _rounded(item.valid) for item in answers}
        head = [_assigned("TAU_STAR", points), _assigned("VALID_WITHIN", valid), RATIO_SOURCE]
        return module_source(_title(request), "singimpact derive", [*head, *(_function(item) for item in answers)])
    if form == "json":
        listed = [
            {
                "name": item.name,
                "says": item.says,
                "variables": list(item.variables),
                "order": item.order,
                "valid_within": None if item.valid == float("inf") else item.valid,
                "sympy": str(item.expression),
                "latex": f"{item.left} = {' '.join(_terms(item))}",
            }
            for item in answers
        ]
        data = {"order": request.order, "tau_star": _points(request), "series": listed}
        return json.dumps(data, indent=2) + "\n"
    return sympy_source(
        f"Series to order {request.order}, in sympy.",
        "singimpact derive",
        {item.name: item.expression for item in answers},
    )


def _points(request: SeriesRequest) -> dict[str, str]:
    """Name of the contact order -> tau_* in 30 digits; empty with symbols."""
    found = {}
    for j in request.contact_orders():
        if (where := request.point(j)) is not None:
            with balls_at(DIGITS_BITS):
                found[NAMES[j]] = str(where.tau_in(Balls(DIGITS_BITS)).str(30, radius=False))
    return found


def _title(request: SeriesRequest) -> str:
    """The model, the points of expansion, the letters, and the accuracy, as the head of a source file."""
    lines = [f"Series of {request.model!r}.", ""]
    for j in request.contact_orders():
        if (where := request.point(j)) is not None:
            name, exact = NAMES[j], f" = {where.exact}" if where.exact is not None else ""
            tau = f"TAU_STAR[{name!r}]: tau_*{exact} = {_points(request)[name]}"
            lines.append(f"{tau}, {POINTS[j]}.".replace("$", ""))
    lines += [
        "sigma = tau - tau_* is the phase of a launch from that point, t the flight time, v_c the launch velocity.",
        f"VALID_WITHIN: each function is accurate to {VALID:g} for |sigma| and |t| up to this radius, relative to its",
        "value; v_c relative to the sum of the sizes of its terms. Estimated from the terms that follow, not proved.",
    ]
    return "\n".join(lines)


def _assigned(name: str, values: Mapping[str, str]) -> str:
    """Source in which a name is a dict of numbers, one a line."""
    rows = "".join(f'    "{key}": {value},\n' for key, value in values.items())
    return f"{name} = {{\n{rows}}}\n"


def _rounded(radius: float | None) -> str:
    """A radius in three digits, rounded down; "None" for a radius that is not known, float("inf") of a polynomial."""
    if radius is None or radius == float("inf"):
        return "None" if radius is None else 'float("inf")'
    return f"{radius * 0.995:.3g}"


def series_section(request: SeriesRequest) -> Section:
    """All series as a section of the derivations; a long one in several displayed equations."""
    stars = zip(request.contact_orders(), _points(request).values(), strict=False)
    opening = [Step(f"Expanded at $\\tau_* = {tau}$, {POINTS[j]}.") for j, tau in stars] or [_LETTERS]
    if request.model is not None:
        opening.insert(0, Step(f"The model is {request.model._repr_latex_()}."))
    of = "generic jets" if request.model is None else "a model"
    return Section(
        "series", f"Series for {of}", (*opening, *(step for each in series(request) for step in _steps(each)))
    )


def series_formulas(request: SeriesRequest, name: str) -> list[str]:
    """The series of a name, or of names that begin with it, each as one formula in LaTeX, below a comment where there
    are several; of a model the comment has the point of expansion.

    Examples
    --------
    >>> print(series_formulas(SeriesRequest(3, None, None, ()), "gamma_swan")[0])
    v = \\tfrac{1}{24} a'' \\sigma^{3} (1 - \\lambda) (\\lambda^{2} + 2 \\lambda + 3) + O(4)
    """
    listed = list(series(request))
    chosen = [one for one in listed if one.name == name or one.name.startswith(f"{name}_")]
    if not chosen:
        raise unknown("series", name, [one.name for one in listed])
    stars = {name: f", tau_* = {tau}" for name, tau in _points(request).items()}
    points = [stars.get(one.name.rpartition("_")[2], stars.get("generic", "")) for one in chosen]
    said = [f"% {one.says}{at}\n" if at or len(chosen) > 1 else "" for one, at in zip(chosen, points, strict=True)]
    formulas = (f"{one.left} = {' '.join(_terms(one))} + O({one.order + 1})" for one in chosen)
    return [words + formula for words, formula in zip(said, formulas, strict=True)]


_LETTERS = Step(
    "In these series $\\rho_n$ is the coefficient of $v^n$ in $\\rho(v) = -r v + \\rho_2 v^2 + \\ldots$, zero in the "
    "paper. $\\lambda$ stands for $r$: at a regular point they are equal, at a tangency point "
    f"$r = {latex(r_of_lambda(1))}$, at a swan point $r = {latex(r_of_lambda(2))}$."
)


def _steps(each: Series) -> Iterator[Step]:
    text, left = f"{each.says}, to order {each.order}:", f"{each.left} = "
    piece = ""
    for term in _terms(each):
        if piece and len(piece) + len(term) > PIECE:
            yield Step(text, left + piece)
            text, left, piece = "and further", r"\cdots ", ""
        piece += term if not piece else f" {term}"
    yield Step(text, f"{left}{piece} + O({each.order + 1})")


def _terms(each: Series) -> list[str]:
    """The terms by rising degree, each with its sign; the first without a plus."""
    letters = [sympy.Symbol(name) for name in each.variables]
    order = sorted(each.terms, key=lambda key: (sum(key), [-power for power in key]))
    powers = (sympy.prod(x**n for x, n in zip(letters, key, strict=True)) for key in order)
    pairs = zip(order, powers, strict=True)
    first, *rest = [term for key, power in pairs for term in _shown(sympy.sympify(each.terms[key]), power)]
    return [first, *(f"- {term[1:]}" if term.startswith("-") else f"+ {term}" for term in rest)]


def _shown(coefficient: Any, monomial: Any) -> list[str]:
    """A coefficient beside its monomial; one that would not fit a page beside it term by term."""
    if coefficient.is_Float:
        return [rf"{latex(coefficient)}\, {latex(monomial)}"]
    if not coefficient.is_Add:
        return [latex(coefficient * monomial)]
    inside = latex(coefficient)
    if len(inside) <= PIECE:
        return [rf"\bigl({inside}\bigr) {latex(monomial)}"]
    return [f"{latex(part)}\\, {latex(monomial)}" for part in sympy.Add.make_args(coefficient)]


def _function(each: Series) -> str:
    terms: dict[Exponents, Coefficient] = {key: {(): _ratio(c)} for key, c in each.terms.items()}
    words = each.says.replace("$", "").replace("\\", "")
    says = f"{words}: to order {each.order}; coefficients exact or to 30 digits."
    return function_source(each.name, list(each.variables), (), terms, says, "ratio")


def _ratio(value: Any) -> Fraction:
    """A coefficient as a rational: a decimal of its digits when it is not one."""
    if hasattr(value, "_mpf_"):  # sympy would round it to the precision of mpmath at this moment
        return Fraction(to_str(value._mpf_, 30))
    exact = sympy.sympify(value)
    need(not exact.free_symbols, InputError("numpy source needs numbers: a coefficient of this series has symbols"))
    return Fraction(int(exact.p), int(exact.q)) if exact.is_Rational else Fraction(str(sympy.N(exact, 30)))


# Expressions as a Python file that defines its letters and keeps every number exact.


class _Exact(StrPrinter):
    """Python text of an expression: no quotient of two whole numbers, and decimals with all their digits."""

    def _print_Float(self, expr: Any) -> str:
        return f'Float("{expr!s}", {max(round(expr._prec * 0.30103), 15)})'

    def _print_Rational(self, expr: Any) -> str:
        return f"S({expr.p})/{expr.q}"

    def _print_Symbol(self, expr: Any) -> str:
        return _letter(str(expr.name))


def _letter(name: str) -> str:
    """A name in Python: lambda is a word of the language."""
    return f"{name}_" if iskeyword(name) else name


def sympy_source(title: str, command: str, expressions: Mapping[str, Any]) -> str:
    """A file in which each expression is a variable of its name.

    Examples
    --------
    >>> print(sympy_source("One.", "me", {"y": sympy.sqrt(2) + sympy.Symbol("lambda")/3}), end="")
    \"\"\"One.
    <BLANKLINE>
    Generated by `me`: not to be edited by hand.
    \"\"\"
    <BLANKLINE>
    from sympy import S, Symbol, sqrt
    <BLANKLINE>
    lambda_ = Symbol("lambda")
    <BLANKLINE>
    y = lambda_/3 + sqrt(2)
    """
    printer = _Exact({"full_prec": True})  # type: ignore[no-untyped-call]
    texts = {
        name: str(printer.doprint(sympy.sympify(expression)))  # type: ignore[no-untyped-call]
        for name, expression in expressions.items()
    }
    letters = sorted({str(symbol) for value in expressions.values() for symbol in sympy.sympify(value).free_symbols})
    own = {_letter(name) for name in letters}
    words = {word for text in texts.values() for word in re.findall(r"[A-Za-z_]\w*", text)}
    names = {"S", "Symbol"} | {word for word in words - own if hasattr(sympy, word)}
    lines = [
        f'"""{title}',
        "",
        f"Generated by `{command}`: not to be edited by hand.",
        '"""',
        "",
        f"from sympy import {', '.join(sorted(names))}",
        "",
    ]
    lines += [f'{_letter(name)} = Symbol("{name}")' for name in letters]
    return "\n".join([*lines, "", *(f"{name} = {text}" for name, text in texts.items())]) + "\n"
