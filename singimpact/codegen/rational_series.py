"""A power series whose coefficients are rational in lambda and polynomial in jets, as source.

Jets are first measured in the unit that the leading one gives, so that every division by it is done once.  Factors of
numerators and denominators stay factors: near lambda = 1, where they vanish, nothing cancels.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from singimpact.codegen.polynomial_source import Exponents, horner, power_text

Poly = tuple[int, ...]  # whole coefficients, constant first
LAMBDA, ONE = "lambda_", "one"  # a quotient of whole numbers alone would be a double


@dataclass(frozen=True)
class Factored:
    """content times polynomials in lambda to whole powers, negative ones for a denominator."""

    content: Fraction
    factors: Mapping[Poly, int] = field(default_factory=dict)


@dataclass(frozen=True)
class Unit:
    """The unit of length.

    Attributes
    ----------
    leading : the name of the leading jet. divisor : j!, so that the unit is leading/divisor.
    weights : jet -> the power of the unit of length that it carries.
    """

    leading: str
    divisor: int
    weights: Mapping[str, int]


@dataclass(frozen=True)
class RationalSeries:
    """coefficients[n][exponents of the names] times variable^n.

    Attributes
    ----------
    value : power of the unit that the sum is multiplied by. argument : that the variable is divided by.
    apart : the terms are returned, lowest first, in place of their sum.
    """

    variable: str
    names: tuple[str, ...]
    coefficients: Mapping[int, Mapping[Exponents, Factored]]
    unit: Unit
    value: int = 0
    argument: int = 0
    apart: bool = False


def rational_series_source(name: str, series: RationalSeries, says: str) -> str:
    """The source of a function of the variable, lambda (where it occurs) and the jets that occur.

    Examples
    --------
    >>> leading = {2: {(): Factored(Fraction(1, 6), {(1, -1): 1, (2, 1): 1})}}
    >>> unit = Unit("a_d1", 1, {})
    >>> print(rational_series_source("g", RationalSeries("sigma", (), leading, unit, 1), "gamma."), end="")
    def g(sigma: Any, lambda_: Any, a_d1: Any) -> Any:
        \"\"\"gamma.\"\"\"
        q_1 = (1 - lambda_)
        q_2 = (2 + lambda_)
        c_2 = q_1 * q_2 / 6
        return a_d1 * (sigma**2 * c_2)
    """
    parts = [term for terms in series.coefficients.values() for term in terms.values()]
    keys = [key for terms in series.coefficients.values() for key in terms]
    used = [n for n in range(len(series.names)) if any(key[n] for key in keys)]
    factors = sorted({poly for term in parts for poly in term.factors})
    unit, labels = series.unit, {poly: f"q_{n}" for n, poly in enumerate(factors, 1)}
    jets = [series.names[n] for n in used]
    arguments = [series.variable, *([LAMBDA] if factors else []), unit.leading, *jets]
    lines = [f"def {name}({', '.join(f'{argument}: Any' for argument in arguments)}) -> Any:", f'    """{says}"""']
    length = unit.leading if unit.divisor == 1 else "unit"
    lines += [] if unit.divisor == 1 else [f"    unit = {unit.leading} / {unit.divisor}"]
    lines += [f"    {label} = {_horner_of(poly)}" for poly, label in labels.items()]
    lines += [f"    {jet} = {_measured(jet, unit.weights[jet], length)}" for jet in jets if unit.weights[jet]]
    if series.argument:
        lines.append(f"    {series.variable} = {series.variable} / {power_text(length, series.argument)}")
    shown = {n: _sum(terms, series.names, labels) for n, terms in sorted(series.coefficients.items()) if terms}
    if any(ONE in re.split(r"\W", text) for text in shown.values()):
        lines.append(f"    {ONE} = {unit.leading}**0")
    lines += [f"    c_{n} = {text}" for n, text in shown.items()]
    return "\n".join([*lines, f"    return {_returned(series, shown, length)}"]) + "\n"


def _returned(series: RationalSeries, powers: Iterable[int], length: str) -> str:
    if series.apart:
        return "(" + ", ".join(f"{power_text(series.variable, n)} * c_{n}" for n in powers) + ")"
    scale = f"{power_text(length, series.value)} * " if series.value else ""
    return scale + horner(series.variable, {n: f"c_{n}" for n in powers})


def _measured(jet: str, weight: int, unit: str) -> str:
    """A jet in the unit: a jet that carries lengths to `weight` is divided by the unit to that power, turned round."""
    return f"{jet} * {power_text(unit, weight)}" if weight > 0 else f"{jet} / {power_text(unit, -weight)}"


def _horner_of(poly: Poly) -> str:
    text = str(poly[-1])
    for value in poly[-2::-1]:
        inner = text.replace("1", LAMBDA) if text in ("1", "-1") else f"{LAMBDA} * {text}"
        text = f"({value} + {inner})".replace("+ -", "- ") if value else inner
    return text


def _sum(terms: Mapping[Exponents, Factored], names: Sequence[str], labels: Mapping[Poly, str]) -> str:
    shown = [_product(part, key, names, labels) for key, part in sorted(terms.items(), reverse=True)]
    return " + ".join(shown).replace("+ -", "- ")


def _product(term: Factored, key: Exponents, names: Sequence[str], labels: Mapping[Poly, str]) -> str:
    above = [power_text(labels[poly], e) for poly, e in term.factors.items() if e > 0]
    below = [power_text(labels[poly], -e) for poly, e in term.factors.items() if e < 0]
    above += [power_text(name, e) for name, e in zip(names, key, strict=True) if e]
    whole, under = abs(term.content.numerator), term.content.denominator
    above = above or [ONE]
    above = [str(whole), *above] if whole != 1 else above
    below = [str(under), *below] if under != 1 else below
    text = " * ".join(above)
    if below:
        text += f" / {below[0]}" if len(below) == 1 else f" / ({' * '.join(below)})"
    return f"-{text}" if term.content < 0 else text
