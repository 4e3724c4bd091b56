"""The numbers of a model as doubles, and what the doubles leave out."""

from collections.abc import Iterable
from fractions import Fraction
from functools import lru_cache
from math import frexp, ldexp
from typing import Any

import numpy as np

from singimpact.algebra.expressions import Expression, Number, Pi, multiply, number, power, substitute
from singimpact.algebra.numbers import Array, as_float, rational_near, sign_of
from singimpact.codegen.taylor_recurrence import Recurrence, recurrence
from singimpact.flights.kernels.state import Linear
from singimpact.inputs import InputError
from singimpact.oscillator.linear import LinearForm, at_rest, linear_form
from singimpact.oscillator.model import Oscillator


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


def numbers_of(osc: Oscillator) -> tuple[Array, Array]:
    """`constants_of` as doubles, and the parts below the doubles; those of a recurrence where the model has no rate.

    Raises
    ------
    InputError : a number does not fit a double.
    """
    return _numbers_of(osc, has_table(osc))


@lru_cache(maxsize=256)
def _numbers_of(osc: Oscillator, linear: bool) -> tuple[Array, Array]:
    trees = constants_of(osc, linear)
    numbers = _in_range(trees)
    return numbers, np.array([_below(tree) for tree in trees]) if linear else np.zeros(numbers.size)


def numbers_of_flow(osc: Oscillator, flow: Recurrence) -> Array:
    """The clearance and the constants of a recurrence with the model's parameters put in."""
    return _in_range([osc.clearance, *(substitute(tree, osc.parameters) for tree in flow.constants)])


def _in_range(trees: Iterable[Expression]) -> Array:
    numbers = np.array([as_float(tree) for tree in trees])
    if not np.all(np.isfinite(numbers)):
        raise InputError("a constant of the model is too large for a double: scale the model, or ask with digits=")
    return numbers


def phases_of(osc: Oscillator) -> tuple[Array, Array]:
    """The phases of the waves of a linear model as doubles, and the parts below them."""
    phases = [wave.phase for wave in linear_waves(osc)]
    return np.array([as_float(tree) for tree in phases]), np.array([_below(tree) for tree in phases])


def _below(tree: Expression) -> float:
    high = as_float(tree)
    return float(rational_near(tree, 256) - Fraction(high)) if np.isfinite(high) else 0.0


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
def turn_of(osc: Oscillator) -> tuple[float, ...]:
    """The period and its parts of 26 bits, whose products with fewer than 2^26 periods are exact; zeros without one."""
    if osc.period is None:
        return (0.0,) * 5
    left, parts = rational_near(osc.period, 600), [as_float(osc.period)]
    for _ in range(4):
        unit = Fraction(2) ** (frexp(float(left))[1] - 26) if left else Fraction(1)
        parts.append(float(round(left / unit) * unit))
        left -= round(left / unit) * unit
    return tuple(parts)


def batch_turn_of(osc: Oscillator) -> tuple[float, float, float]:
    """The period in two parts, the first of 33 bits, and its inverse; zeros without a period."""
    if osc.period is None:
        return 0.0, 0.0, 0.0
    exact = rational_near(osc.period, 256)
    fraction, exponent = frexp(float(exact))
    high = ldexp(int(ldexp(fraction, 33)), exponent - 33)
    return high, float(exact - Fraction(high)), 1 / float(exact)


@lru_cache(maxsize=256)
def fastest_rate(osc: Oscillator) -> float:
    """A rate that flights show: of the waves and of the free motion; without a closed form, of the period.

    Examples
    --------
    >>> fastest_rate(Oscillator("9*x", "cos(2*t)", 0, 1))
    3.0
    """
    form: LinearForm | None = linear_form(osc)
    if form is not None:
        waves = [abs(as_float(wave.rate)) for wave in form.harmonics]
        return float(max([abs(as_float(form.stiffness)) ** 0.5, abs(as_float(form.damping)), 0.5, *waves]))
    return max(2.0, 0.0 if osc.period is None else 4 * np.pi / as_float(osc.period))


@lru_cache(maxsize=256)
def turn(rate: Expression) -> Expression:
    """The time 2 pi/|rate| of a turn."""
    return multiply(number(2 * sign_of(rate)), Pi(), power(rate, number(-1)))


def step_with_few_bits(reach: float, rate: float, bits: int) -> float:
    """reach/rate with few bits, so that multiples of it are exact."""
    fraction, exponent = frexp(reach / rate)
    return ldexp(int(ldexp(fraction, bits)), exponent - bits)
