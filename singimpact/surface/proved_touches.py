"""Which lips, beaks and swallowtails a linear model has in a window: all of them, by balls.

x - c = u(tau, t) of a flight from rest at tau is a sum of exponentials and waves.  Lips and beaks are the solutions of

    a_c(tau) = 0,   u = 0,   u_t = 0        with t != 0, in tau, t and the number that is varied,

swallowtails the zeros t != 0 of u at a swan.  At t = 0 the equations hold for every tau with a_c(tau) = 0.  There, u,
u_t and u_tt vanish at 0 and u, u_t at t, so by Rolle's theorem u_ttt has two zeros between and u_tttt one: a box whose
hull with t = 0 has u_ttt or u_tttt free of zeros holds no solution but t = 0.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np

from singimpact.algebra.analytic import Recorder
from singimpact.algebra.balls import Balls
from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import (
    Call,
    Expression,
    Name,
    Power,
    add,
    multiply,
    names_in,
    negate,
    number,
    subtract,
)
from singimpact.algebra.isolated_zeros import SETTINGS as BOXES
from singimpact.algebra.isolated_zeros import IsolatedZeros, isolated_zeros
from singimpact.algebra.numbers import sign_of
from singimpact.algebra.precision import balls_at
from singimpact.inputs import InputError
from singimpact.oscillator.linear import Harmonic, LinearForm, form_of
from singimpact.oscillator.moving_number import CLEARANCE
from singimpact.surface.swan_families import MARGIN, STEPS, Family, Transition

Pair = tuple[Expression, Expression]
TAU, T = Name("tau"), Name("t")
NEAR = 1e-8
"""Relative distance below which an isolated zero is the transition of the list."""
SEARCH = replace(BOXES, bits=96, most=60_000, least=Fraction(1, 2**18))


@dataclass(frozen=True)
class RestFlight:
    """x - c of the flights from rest of a linear model, as formulas in tau, t and the number that is varied.

    Parameters
    ----------
    over : its name. push : a_c(tau). heights : u and its derivatives by t up to the fourth.
    """

    over: str
    push: Expression
    heights: tuple[Expression, ...]

    def touches(self, period: float, ends: tuple[float, float], times: tuple[float, float]) -> IsolatedZeros:
        """(tau, t, value) of all lips and beaks in a period of tau."""
        longest = Fraction(period)
        window = (
            (-longest / MARGIN, longest * Fraction(MARGIN + 1, MARGIN)), _ends(times), _ends(ends),
        )  # fmt: skip
        names = ("tau", "t", self.over)
        excluded = _no_other_than_at_zero(self.heights[3:], names)
        return isolated_zeros((self.push, *self.heights[:2]), names, window, excluded=excluded, settings=SEARCH)

    def swallowtails(self, tau: Any, value: Any, times: tuple[float, float]) -> IsolatedZeros:
        """All t != 0 at which the flight from a swan, given by balls, crosses x = c again."""
        fixed = {"tau": tau, self.over: value}
        excluded = _no_other_than_at_zero(self.heights[4:], ("t",), fixed)
        return isolated_zeros(
            self.heights[:1], ("t",), (_ends(times),), fixed=fixed, excluded=excluded, settings=SEARCH
        )


def doubts_left(
    family: Family, ends: tuple[float, float], times: tuple[float, float], listed: Iterable[Transition]
) -> tuple[str, ...]:
    """Why lips, beaks or swallowtails may be missing in a list; nothing where balls show that none is."""
    flight, periods = rest_flight(family), family.periods(np.linspace(*ends, STEPS + 1))
    if "t" not in names_in(family.model.forcing(() if family.over == CLEARANCE else (family.over,))):
        return ()  # a_c is constant
    if flight is None or not periods:
        return ("lips, beaks and swallowtails are met on a grid: balls show that there are no others of linear models "
                "with a period alone, at numbers that leave damping and stiffness as they are",)  # fmt: skip
    found, length = list(listed), max(periods.values())
    made = flight.touches(length, ends, times)
    doubts = _undecided(made, 2, f"lips and beaks for {family.over}")
    known = [(each.tau, each.t, each.value) for each in found if each.kind in ("lips", "beaks", "undecided")]
    for zero in made.found:
        tau, t, value = (float(part.mid()) for part in zero)
        turn = next(iter(family.periods(np.array([value])).values()), length)
        inside = -NEAR * turn <= tau < turn * (1 - NEAR) and _within(t, times) and _within(value, ends)
        if inside and not any(_near((tau, t, value), other) for other in known):
            doubts.append(f"the list lacks lips or beaks at {family.over} = {value:.12g}, tau = {tau:.6g}, t = {t:.6g}")
    for swan in (each for each in found if each.kind.startswith("swan")):
        crossings = flight.swallowtails(_rounded(swan.tau), _rounded(swan.value), times)
        doubts += _undecided(crossings, 0, "swallowtails at t")
        listed_there = [(each.t,) for each in found if each.kind == "swallowtail" and each.value == swan.value]
        for (zero,) in crossings.found:
            t = float(zero.mid())
            if _within(t, times) and not any(_near((t,), other) for other in listed_there):
                doubts.append(f"the list lacks a swallowtail at {family.over} = {swan.value:.12g}, t = {t:.6g}")
    return tuple(doubts)


def _undecided(made: IsolatedZeros, which: int, what: str) -> list[str]:
    if made.complete:
        return []
    low, high = min(float(box[which][0]) for box in made.undecided), max(float(box[which][1]) for box in made.undecided)
    return [f"{what} from {low:.9g} to {high:.9g} are not decided by {made.looked_at} boxes"]


def _within(value: float, ends: tuple[float, float]) -> bool:
    return ends[0] <= value <= ends[1]


def _near(one: tuple[float, ...], other: tuple[float, ...]) -> bool:
    return all(abs(a - b) < NEAR * (1 + abs(a)) for a, b in zip(one, other, strict=True))


def _rounded(value: float) -> Any:
    """All numbers of which a double is a rounding; a swan at 0 is known to 2^-80 of the window."""
    exact, spare = Fraction(value), Fraction(abs(value)) / 2**51 + Fraction(1, 2**70)
    return Balls(SEARCH.bits).interval(exact - spare, exact + spare)


def rest_flight(family: Family) -> RestFlight | None:
    """The formulas of a family; None where the model is not linear, or the number is in its frequencies or damping.

    Examples
    --------
    >>> from singimpact.oscillator.model import Oscillator
    >>> found = rest_flight(Family(Oscillator("x", "cos(2*t)", 0, "1/2"), "clearance"))
    >>> print(found.push)
    cos(2*tau) - clearance
    """
    names = () if family.over == CLEARANCE else (family.over,)
    form = form_of(family.model.force(names), family.model.forcing(names))
    clearance = Name(CLEARANCE) if family.over == CLEARANCE else family.model.clearance
    if form is None or names_in(form.damping) or names_in(form.stiffness):
        return None
    try:
        height = _height(form, clearance)
    except InputError:  # a sign that is not decided
        return None
    if height is None:
        return None
    heights = [height]
    for _ in range(4):
        heights.append(derivative(heights[-1], "t"))
    push = _waves(form, TAU, [(wave.cosine, wave.sine) for wave in form.harmonics])
    return RestFlight(
        family.over, add(push, form.constant, negate(multiply(form.stiffness, clearance))), tuple(heights)
    )


def _height(form: LinearForm, clearance: Expression) -> Expression | None:
    """u: the steady motion at tau + t, and the free one that takes it to rest at c at t = 0."""
    k, d = form.stiffness, form.damping
    responses = [_response(form, wave) for wave in form.harmonics]
    sizes = [part for part in responses if part is not None]
    if sign_of(k) == 0 or len(sizes) < len(responses):
        return None
    steady = multiply(form.constant, Power(k, number(-1)))

    def waves(at: Expression) -> Expression:
        return add(steady, _waves(form, at, sizes))

    below = subtract(clearance, waves(TAU))
    speed = negate(derivative(waves(TAU), "tau"))
    beta = multiply(number(Fraction(1, 2)), d)
    square = subtract(k, multiply(beta, beta))
    even, odd = _free(square)
    decay = Call("exp", negate(multiply(beta, T))) if sign_of(d) else number(1)
    free = multiply(decay, add(multiply(below, even), multiply(add(speed, multiply(beta, below)), odd)))
    return add(waves(add(TAU, T)), free, negate(clearance))


def _free(square: Expression) -> tuple[Expression, Expression]:
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


def _waves(form: LinearForm, at: Expression, parts: Sequence[Pair]) -> Expression:
    """Waves of the forcing's rates and phases at a time, with these cosines and sines."""
    terms = []
    for wave, (cosine, sine) in zip(form.harmonics, parts, strict=True):
        angle = add(multiply(wave.rate, at), wave.phase)
        terms += [multiply(cosine, Call("cos", angle)), multiply(sine, Call("sin", angle))]
    return add(*terms) if terms else number(0)


def _no_other_than_at_zero(
    trees: tuple[Expression, ...], names: tuple[str, ...], fixed: dict[str, Any] | None = None
) -> Callable[[tuple[Any, ...]], bool]:
    """Whether one of the trees has no zero between a box and t = 0."""
    recorder = Recorder()
    program = recorder.program([recorder.record(tree) for tree in trees])
    with balls_at(SEARCH.bits):
        run = program.prepared(fixed or {})
    where = names.index("t")

    def excluded(place: tuple[Any, ...]) -> bool:
        hull = tuple(part.union(0) if k == where else part for k, part in enumerate(place))
        return any(not value.contains(0) for value in run(dict(zip(names, hull, strict=True))))

    return excluded


def _ends(pair: tuple[float, float]) -> tuple[Fraction, Fraction]:
    return Fraction(pair[0]), Fraction(pair[1])
