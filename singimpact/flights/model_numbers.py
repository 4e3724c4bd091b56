"""The numbers of a model as doubles, and what the doubles leave out."""

from collections.abc import Mapping
from fractions import Fraction
from functools import lru_cache, reduce
from typing import Any

import numpy as np

from singimpact.algebra.expressions import (
    Expression,
    Number,
    Pi,
    evaluate,
    multiply,
    names_in,
    number,
    power,
    substitute,
)
from singimpact.algebra.numbers import Array, as_float, sign_of
from singimpact.algebra.rings import DOUBLES
from singimpact.codegen.taylor_recurrence import Recurrence, recurrence
from singimpact.flights.kernels.state import Linear
from singimpact.oscillator.linear import at_rest, form_of, linear_form
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.moving_number import period_over


@lru_cache(maxsize=256)
def recurrence_of(osc: Oscillator) -> Recurrence:
    """The emitted recurrence of a model; models of one structure have one text."""
    return recurrence(osc.f, osc.g)


@lru_cache(maxsize=256)
def constants_of(osc: Oscillator, linear: bool = True) -> tuple[Expression, ...]:
    """The exact numbers of a model: of its closed form, or of its recurrence, whose first is the clearance."""
    form = linear_form(osc) if linear else None
    if form is None:
        parts = (substitute(tree, osc.parameters) for tree in recurrence_of(osc).constants)
        return (osc.clearance, *parts)
    damping, stiffness = as_float(form.damping), as_float(form.stiffness)
    # the largest rate is only a scale, so a double of it is enough
    scale = max(abs(damping), abs(stiffness) ** 0.5, *(abs(as_float(wave.rate)) for wave in form.harmonics), 0.0)
    numbers = osc.clearance, form.damping, form.stiffness, at_rest(form, osc.clearance), Number(Fraction(scale))
    return (*numbers, *(tree for wave in form.harmonics for tree in (wave.rate, wave.cosine, wave.sine)))


@lru_cache(maxsize=256)
def has_table(osc: Oscillator) -> bool:
    """Whether a model is linear, and its rates are in the range of doubles."""
    return linear_form(osc) is not None and fastest(osc) < 1e100


@lru_cache(maxsize=256)
def fastest(osc: Oscillator) -> float:
    """The largest modulus of a root of s^2 + d s + k, or of a wave's rate, of a linear model."""
    form = linear_form(osc)
    if form is None:
        return 0.0
    d, k = as_float(form.damping), as_float(form.stiffness)
    root = np.sqrt(complex(d * d / 4 - k))
    rates = [abs(as_float(wave.rate)) for wave in form.harmonics]
    return float(max([abs(-d / 2 + root), abs(-d / 2 - root), *rates, 0.0]))


def numbers_of_flow(osc: Oscillator, flow: Recurrence) -> Array:
    """The clearance and the constants of a recurrence with the model's parameters put in."""
    return np.array([as_float(substitute(tree, osc.parameters)) for tree in (osc.clearance, *flow.constants)])


def linear_waves(osc: Oscillator) -> tuple[Any, ...]:
    """The waves of a linear model."""
    form = linear_form(osc)
    assert form is not None
    return form.harmonics


def linear_numbers(osc: Oscillator, value: Any) -> Linear:
    """The numbers of a linear model as `value` gives them, over lists."""
    _clearance, damping, stiffness, steady, scale, *_waves = constants_of(osc)
    rows = [[value(part) for part in (wave.rate, wave.phase, wave.cosine, wave.sine)] for wave in linear_waves(osc)]
    return Linear(value(damping), value(stiffness), value(steady), value(scale), rows)


@lru_cache(maxsize=256)
def fastest_rate(osc: Oscillator) -> float:
    """A rate that flights show: of the waves and of the free motion; without a closed form, of the period.

    Examples
    --------
    >>> fastest_rate(Oscillator("9*x", "cos(2*t)", 0, 1))
    3.0
    """
    return float(fastest_rates(osc, {}))


def fastest_rates(osc: Oscillator, over: Mapping[str, Any]) -> Any:
    """`fastest_rate` of models some of whose numbers are arrays."""
    form = form_of(osc.force(over), osc.forcing(over))
    if form is not None:
        rates = [np.abs(valued(wave.rate, over)) for wave in form.harmonics]
        damping, stiffness = np.abs(valued(form.damping, over)), np.abs(valued(form.stiffness, over))
        return reduce(np.maximum, [stiffness**0.5, damping, 0.5, *rates])
    period = period_over(osc, over)
    return np.maximum(2.0, 0.0 if period is None else 4 * np.pi / np.abs(valued(period, over)))


def valued(tree: Expression, over: Mapping[str, Any]) -> Any:
    """A tree of constants and letters in doubles; without letters the double nearest to it."""
    if not over or names_in(tree).isdisjoint(over):
        return np.float64(as_float(tree))
    with np.errstate(all="ignore"):  # what is no number is refused by who reads it
        return evaluate(tree, over, DOUBLES)


@lru_cache(maxsize=256)
def turn(rate: Expression) -> Expression:
    """The time 2 pi/|rate| of a turn."""
    return multiply(number(2 * sign_of(rate)), Pi(), power(rate, number(-1)))
