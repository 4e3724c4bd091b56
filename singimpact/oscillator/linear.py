"""Linear models recognised from their expressions, x'' + d x' + k x = h0 + sum of harmonics, and their motion.

Formulas in the launch time, the time since, and the launch velocity:

    x - c = u(tau, t) + v B(t),     u = steady(tau + t) - c + the free motion that starts (x, x') at (c, 0)
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import NamedTuple

from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import (
    Call,
    Expression,
    Name,
    Power,
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
from singimpact.algebra.numbers import sign_of
from singimpact.inputs import InputError
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.period import affine


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
    pull = affine(force, ("x", "xdot"))
    if pull is None or "t" in names_in(pull[0]) | names_in(pull[1]):
        return None
    stiffness, damping, offset = pull
    if "t" in names_in(offset):  # a part of f in t alone drives the mass like g
        offset, forcing = number(0), subtract(forcing, offset)
    waves = _waves(forcing)
    if waves is None:
        return None
    steady, harmonics = waves
    return LinearForm(damping, stiffness, subtract(steady, offset), tuple(harmonics))


def _waves(tree: Expression, factor: Expression | None = None) -> tuple[Expression, list[Harmonic]] | None:
    factor = factor or number(1)
    if "t" not in names_in(tree):
        return multiply(factor, tree), []
    if isinstance(tree, Sum):
        return _summed([_waves(term, factor) for term in tree.terms])
    if isinstance(tree, Product):
        moving = [operand for operand in tree.factors if "t" in names_in(operand)]
        rest = [operand for operand in tree.factors if operand is not moving[0]]
        return _waves(moving[0], multiply(factor, *rest)) if len(moving) == 1 else None
    return _wave(tree, factor) if isinstance(tree, Call) and tree.function in ("sin", "cos") else None


def _wave(tree: Call, factor: Expression) -> tuple[Expression, list[Harmonic]] | None:
    inner = affine(tree.argument, ("t",))
    if inner is None:
        return None
    rate, phase = inner
    if rate == number(0):
        return multiply(factor, substitute(tree, {"t": number(0)})), []
    zero = number(0)
    return zero, [Harmonic(rate, phase, *((factor, zero) if tree.function == "cos" else (zero, factor)))]


def _summed(parts: list[tuple[Expression, list[Harmonic]] | None]) -> tuple[Expression, list[Harmonic]] | None:
    found = [part for part in parts if part is not None]
    if len(found) < len(parts):
        return None
    return add(*(steady for steady, _ in found)), [wave for _, waves in found for wave in waves]


def at_rest(form: LinearForm, clearance: Expression) -> Expression:
    """The constant part of the acceleration at the obstacle, h0 - k c."""
    return add(form.constant, negate(multiply(form.stiffness, clearance)))


# The motion as formulas: the free motion, the steady one, and what each harmonic adds to it.

Pair = tuple[Expression, Expression]
TAU, T = Name("tau"), Name("t")


class LinearFlight(NamedTuple):
    """u(tau, t) from rest, B(t), and a_c(tau)."""

    from_rest: Expression
    by_speed: Expression
    push: Expression


def linear_flight(form: LinearForm, clearance: Expression) -> LinearFlight | None:
    """The formulas of a model; None at resonance, at stiffness 0, or where a sign is not decided.

    Examples
    --------
    >>> from singimpact.oscillator.linear import linear_form
    >>> from singimpact.oscillator.model import Oscillator
    >>> flight = linear_flight(linear_form(Oscillator("x", "cos(2*t)", 0, "1/2")), number(0))
    >>> print(flight.push)
    cos(2*tau)
    """
    try:
        formulas = _formulas(form, clearance)
    except InputError:
        return None
    if formulas is None:
        return None
    push = waves(form, TAU, [(wave.cosine, wave.sine) for wave in form.harmonics])
    return LinearFlight(*formulas, add(push, form.constant, negate(multiply(form.stiffness, clearance))))


def steady_motion(form: LinearForm, at: Expression) -> Expression | None:
    """The motion with the period of the forcing, as a formula in a time; None at resonance or at stiffness 0.

    Examples
    --------
    >>> from singimpact.oscillator.linear import linear_form
    >>> from singimpact.oscillator.model import Oscillator
    >>> print(steady_motion(linear_form(Oscillator("x", "cos(2*t)", 0, "1/2")), Name("t")))
    -3/9*cos(2*t)
    """
    sizes = [response for response in (_response(form, wave) for wave in form.harmonics) if response is not None]
    if sign_of(form.stiffness) == 0 or len(sizes) < len(form.harmonics):
        return None
    return add(multiply(form.constant, Power(form.stiffness, number(-1))), waves(form, at, sizes))


def _formulas(form: LinearForm, clearance: Expression) -> Pair | None:
    k, d = form.stiffness, form.damping
    here, there = (steady_motion(form, at) for at in (TAU, add(TAU, T)))
    if here is None or there is None:
        return None
    below = subtract(clearance, here)
    speed = negate(derivative(here, "tau"))
    beta = multiply(number(Fraction(1, 2)), d)
    even, odd = _free(subtract(k, multiply(beta, beta)))
    decay = Call("exp", negate(multiply(beta, T))) if sign_of(d) else number(1)
    free = multiply(decay, add(multiply(below, even), multiply(add(speed, multiply(beta, below)), odd)))
    return add(there, free, negate(clearance)), multiply(decay, odd)


def _free(square: Expression) -> Pair:
    """The solutions of y'' + square y = 0 with (y, y') = (1, 0) and (0, 1) at t = 0."""
    sign = sign_of(square)
    if sign == 0:
        return number(1), T
    rate = Power(square if sign > 0 else negate(square), number(Fraction(1, 2)))
    inverse = Power(rate, number(-1))
    if sign > 0:
        return Call("cos", multiply(rate, T)), multiply(inverse, Call("sin", multiply(rate, T)))
    half, up, down = number(Fraction(1, 2)), Call("exp", multiply(rate, T)), Call("exp", negate(multiply(rate, T)))
    return multiply(half, add(up, down)), multiply(half, inverse, subtract(up, down))


def _response(form: LinearForm, wave: Harmonic) -> Pair | None:
    """Cosine and sine of the steady motion under a wave; None at resonance."""
    p, q = subtract(form.stiffness, multiply(wave.rate, wave.rate)), multiply(form.damping, wave.rate)
    size = add(multiply(p, p), multiply(q, q))
    if not names_in(size) and sign_of(size) == 0:
        return None
    inverse, a, b = Power(size, number(-1)), wave.cosine, wave.sine
    return (
        multiply(inverse, subtract(multiply(p, a), multiply(q, b))),
        multiply(inverse, add(multiply(q, a), multiply(p, b))),
    )


def waves(form: LinearForm, at: Expression, parts: Sequence[Pair]) -> Expression:
    """Waves of the forcing's rates and phases at a time, with these cosines and sines."""
    terms = []
    for wave, (cosine, sine) in zip(form.harmonics, parts, strict=True):
        angle = add(multiply(wave.rate, at), wave.phase)
        terms += [multiply(cosine, Call("cos", angle)), multiply(sine, Call("sin", angle))]
    return add(*terms) if terms else number(0)
