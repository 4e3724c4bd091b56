"""The series of the theory to any order, for generic symbols or for a model, as data and in every format."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import sympy

from singimpact.codegen.formulas import Coefficient, Exponents, function_source, module_source
from singimpact.documents.steps import Section, Step
from singimpact.inputs import InputError
from singimpact.oscillator.model import Oscillator
from singimpact.theory import chatter_limit, dynamics_on_gamma, fibre, gamma, normal_form, v_c
from singimpact.theory.contact_points import points_of
from singimpact.theory.fold_form import FoldForm
from singimpact.theory.formulas import LIMITS
from singimpact.theory.frozen import COMMAND, curve_functions, sheet_functions
from singimpact.theory.homogeneous import r_of_lambda
from singimpact.theory.notation import latex
from singimpact.theory.plane_forms import HIGHEST
from singimpact.theory.power_series import PowerSeries

TEXT_FORMS = ("sympy", "numpy")
NAMES = {0: "generic", 1: "tangency", 2: "swan"}
PIECE = 1800  # characters of LaTeX in one displayed equation, at most about half a page


@dataclass(frozen=True)
class Series:
    """One series.

    Attributes
    ----------
    name : a Python name, such as v_c_tangency. says : what it is, in words. left : the left-hand side, LaTeX.
    variables : its small variables. order : the last degree.
    terms : exponents of the variables -> sympy coefficient. expression : the whole in sympy.
    """

    name: str
    says: str
    left: str
    variables: tuple[str, ...]
    order: int
    terms: Mapping[Exponents, Any]
    expression: Any


def _of_power_series(name: str, says: str, left: str, found: PowerSeries) -> Series:
    terms: dict[Exponents, Any] = {(n,): value for n, value in found.coefficients.items() if value != 0}
    return Series(name, says, left, (found.variable,), found.order, terms, found.as_expr())


def _of_polynomial(name: str, says: str, left: str, order: int, found: Any, *variables: str) -> Series:
    letters = [sympy.Symbol(each) for each in variables]
    terms = {tuple(map(int, key)): value for key, value in sympy.Poly(found, *letters).terms()}
    return Series(name, says, left, variables, order, terms, found)


@dataclass(frozen=True)
class Asked:
    """What series are asked for.

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
        """What a function of the theory answers for this model, point and letters."""
        return function(order, model=self.model, tau=self.tau, digits=self.digits, keep=self.keep, **at)

    def capped(self, most: int) -> int:
        """The order, or the highest with symbols."""
        return min(self.order, most) if self.model is None or self.keep else self.order

    def places(self) -> list[int]:
        """The contact orders to tell of."""
        if self.model is None or (self.keep and self.tau is None):
            return [0, 1, 2]
        return points_of(self.model, self.tau)


def series(asked: Asked) -> Iterator[Series]:
    """The series, one after the other.

    Examples
    --------
    >>> [each.name for each in series(Asked(3))][:3]
    ['v_c_generic', 'fibre', 'chatter_limit']
    >>> next(series(Asked(3))).terms[(0, 1)]
    -a/2
    """
    for j in asked.places():
        at, top = NAMES[j], asked.capped(LIMITS.sheet)
        what = f"Launch velocity of the flight that lands after $t$, at a {at} point"
        yield _of_polynomial(f"v_c_{at}", what, "v_c", top, asked.of(v_c, top, at=at), "sigma", "t")
        yield from _at_regular(asked) if j == 0 else _on_gamma(asked, at, j)


def _at_regular(asked: Asked) -> Iterator[Series]:
    what = "Velocity on the stable fibre, where chatter ends at $\\sigma = 0$"
    yield _of_power_series("fibre", what, "v", asked.of(fibre, asked.capped(LIMITS.curve)))
    ends = asked.of(chatter_limit, asked.capped(LIMITS.completion))
    yield _of_power_series("chatter_limit", "End of complete chatter", r"\tau_\infty - \tau", ends)


def _on_gamma(asked: Asked, at: str, j: int) -> Iterator[Series]:
    along = asked.of(gamma, max(asked.capped(LIMITS.curve), j + 1), at=at)
    yield _of_power_series(f"gamma_{at}", f"Velocity on the invariant curve at a {at} point", "v", along)
    motion = asked.of(dynamics_on_gamma, max(asked.capped(LIMITS.curve) - j, 1), at=at)
    yield _of_power_series(f"motion_{at}", "The next impact on it", r"\bar\sigma", motion)
    if j == 1 and not asked.keep:
        top = asked.capped(HIGHEST["tangency"])
        what = "The outline of $p$, the image of the horizon"
        yield _of_polynomial("outline_tangency", what, "v", top, _outline(asked, top), "sigma")


def _outline(asked: Asked, top: int) -> Any:
    form = normal_form(top, "tangency", asked.model, asked.tau, asked.digits)
    return form.outline_of_p if isinstance(form, FoldForm) else form.offset


def series_text(asked: Asked, form: str) -> str:
    """All series as ``sympy`` assignments, as ``numpy`` source that runs by itself, or as ``json``.

    Examples
    --------
    >>> print(series_text(Asked(3), "sympy").splitlines()[3][:56])
    v_c_tangency = -a_d1*sigma*t/2 - a_d1*t**2/6 - a_d2*sigm
    """
    if form == "numpy" and asked.model is None:
        sheets, curves = sheet_functions(asked.capped(LIMITS.sheet)), curve_functions(asked.order)
        return module_source(f"Series to order {asked.order} in jets.", COMMAND, [*sheets, *curves])
    found = list(series(asked))
    if form == "numpy":
        return module_source(f"Series of {asked.model!r}.", "singimpact derive", [_function(each) for each in found])
    if form == "json":
        return json.dumps({"order": asked.order, "series": [_as_data(each) for each in found]}, indent=2) + "\n"
    return "".join(f"{each.name} = {each.expression}\n" for each in found)


def _as_data(each: Series) -> dict[str, Any]:
    return {"name": each.name, "says": each.says, "variables": list(each.variables), "order": each.order,
            "sympy": str(each.expression), "latex": f"{each.left} = {' '.join(_terms(each))}"}  # fmt: skip


def series_section(asked: Asked) -> Section:
    """All series as a section of the derivations; a long one in several displayed equations."""
    of = "generic jets" if asked.model is None else "a model"
    return Section("series", f"Series for {of}", (_LETTERS, *(step for each in series(asked) for step in _steps(each))))


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
    says = f"{each.name} to order {each.order}; coefficients to 30 digits or exact."
    return function_source(each.name, list(each.variables), (), terms, says)


def _ratio(value: Any) -> Fraction:
    """A coefficient as a rational: a decimal of its digits when it is not one."""
    exact = sympy.sympify(value)
    if exact.free_symbols:
        raise InputError("numpy source needs numbers: a coefficient of this series has symbols")
    if exact.is_Rational:
        return Fraction(int(exact.p), int(exact.q))
    return Fraction(str(sympy.N(exact, 30)))
