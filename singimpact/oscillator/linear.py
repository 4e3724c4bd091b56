"""Linear models recognised from their expressions: x'' + d x' + k x = h0 + sum of harmonics."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

from singimpact.algebra.expressions import (
    Call,
    Expression,
    Name,
    Product,
    Sum,
    add,
    multiply,
    names_in,
    negate,
    number,
    substitute,
    subtract,
)
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.period import linear_in_t

MOVING = frozenset({"x", "xdot"})
"""Names in f that are no parameters."""


@dataclass(frozen=True)
class Harmonic:
    """cosine cos(rate t + phase) + sine sin(rate t + phase)."""

    rate: Expression
    phase: Expression
    cosine: Expression
    sine: Expression


@dataclass(frozen=True)
class LinearForm:
    """x'' + damping x' + stiffness x = constant + sum of harmonics; every number an exact tree."""

    damping: Expression
    stiffness: Expression
    constant: Expression
    harmonics: tuple[Harmonic, ...]


@lru_cache(maxsize=256)
def linear_form(osc: Oscillator) -> LinearForm | None:
    """The linear form of a model, or None when f or g is not seen to be linear.

    Examples
    --------
    >>> form = linear_form(Oscillator("x + 0.2*xdot - 1", "cos(2*t + 1)/3", 0, 1))
    >>> print(form.damping, form.stiffness, form.constant, form.harmonics[0].cosine)
    0.2 1 1 1/3
    >>> print(linear_form(Oscillator("x**3", "cos(2*t)", 0, 1)))
    None
    """
    return form_of(osc.force(), osc.forcing())


def form_of(force: Expression, forcing: Expression) -> LinearForm | None:
    """The linear form of f and g, in which parameters may be letters.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> form = form_of(parse("k*x", ["k", "x"]), parse("a*cos(w*t)", ["a", "w", "t"]))
    >>> print(form.stiffness, form.harmonics[0].rate)
    k w
    """
    pull = _affine(force)
    waves = _waves(forcing)
    if pull is None or waves is None:
        return None
    stiffness, damping, offset = pull
    steady, harmonics = waves
    return LinearForm(damping, stiffness, subtract(steady, offset), tuple(harmonics))


def _affine(tree: Expression) -> tuple[Expression, Expression, Expression] | None:
    """(k, d, m) of k x + d xdot + m."""
    names = names_in(tree) & MOVING
    if not names:
        return number(0), number(0), tree
    if isinstance(tree, Name):
        return number(int(tree.name == "x")), number(int(tree.name == "xdot")), number(0)
    if isinstance(tree, Sum):
        parts = [_affine(term) for term in tree.terms]
        forms = [form for form in parts if form is not None]
        if len(forms) < len(parts):
            return None
        return add(*(p[0] for p in forms)), add(*(p[1] for p in forms)), add(*(p[2] for p in forms))
    if isinstance(tree, Product):
        moving = [factor for factor in tree.factors if names_in(factor) & MOVING]
        inner = _affine(moving[0]) if len(moving) == 1 else None
        if inner is None:
            return None
        rest = [factor for factor in tree.factors if factor is not moving[0]]
        return multiply(*rest, inner[0]), multiply(*rest, inner[1]), multiply(*rest, inner[2])
    return None


def _waves(tree: Expression, factor: Expression | None = None) -> tuple[Expression, list[Harmonic]] | None:
    factor = factor or number(1)
    if "t" not in names_in(tree):
        return multiply(factor, tree), []
    if isinstance(tree, Sum):
        return _summed([_waves(term, factor) for term in tree.terms])
    if isinstance(tree, Product):
        moving = [part for part in tree.factors if "t" in names_in(part)]
        rest = [part for part in tree.factors if part is not moving[0]]
        return _waves(moving[0], multiply(factor, *rest)) if len(moving) == 1 else None
    if isinstance(tree, Call) and tree.function in ("sin", "cos"):
        return _wave(tree, factor)
    return None


def _wave(tree: Call, factor: Expression) -> tuple[Expression, list[Harmonic]] | None:
    inner = linear_in_t(tree.argument)
    if inner is None:
        return None
    rate, phase = inner
    if rate == number(0):
        return multiply(factor, substitute(tree, {"t": number(0)})), []
    zero = number(0)
    return zero, [Harmonic(rate, phase, *((factor, zero) if tree.function == "cos" else (zero, factor)))]


def _summed(
    parts: list[tuple[Expression, list[Harmonic]] | None],
) -> tuple[Expression, list[Harmonic]] | None:
    found = [part for part in parts if part is not None]
    if len(found) < len(parts):
        return None
    return add(*(steady for steady, _ in found)), [wave for _, waves in found for wave in waves]


def at_rest(form: LinearForm, clearance: Expression) -> Expression:
    """The constant part of the acceleration at the obstacle, h0 - k c."""
    return add(form.constant, negate(multiply(form.stiffness, clearance)))
