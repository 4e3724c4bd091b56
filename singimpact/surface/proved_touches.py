"""Which lips, beaks and swallowtails a model has in a window: all of them, by balls.

Of a linear model x - c = u(tau, t) of a flight from rest at tau is a sum of exponentials and waves (other models are
flown in boxes: `enclosed_touches`).  Lips and beaks are the solutions of

    a_c(tau) = 0,   u = 0,   u_t = 0        with t != 0, in tau, t and the number that is varied,

swallowtails the zeros t != 0 of u at a swan.  At t = 0 the equations hold for every tau with a_c(tau) = 0.  There, u,
u_t and u_tt vanish at 0 and u, u_t at t, so by Rolle's theorem u_ttt has two zeros between and u_tttt one: a box whose
hull with t = 0 has u_ttt or u_tttt free of zeros holds no solution but t = 0.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np

from singimpact.algebra.analytic import Recorder
from singimpact.algebra.balls import Balls
from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import Expression, Name, names_in
from singimpact.algebra.isolated_zeros import SETTINGS as BOXES
from singimpact.algebra.isolated_zeros import IsolatedZeros, isolated_zeros
from singimpact.algebra.precision import balls_at
from singimpact.oscillator.linear import form_of, linear_flight
from singimpact.oscillator.moving_number import CLEARANCE
from singimpact.surface.enclosed_touches import EnclosedTouches
from singimpact.surface.swan_families import MARGIN, STEPS, Family, Transition

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
            (-longest / MARGIN, longest * Fraction(MARGIN + 1, MARGIN)),
            _ends(times),
            _ends(ends),
        )
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
    periods = family.periods(np.linspace(*ends, STEPS + 1))
    if "t" not in names_in(family.model.forcing(() if family.over == CLEARANCE else (family.over,))):
        return ()  # a_c is constant
    if not periods:
        return (
            "lips, beaks and swallowtails are met on a grid: balls show that there are no others of models "
            "with a period alone",
        )
    flight: RestFlight | EnclosedTouches = rest_flight(family) or EnclosedTouches(family.model, family.over)
    events, length = list(listed), max(periods.values())
    proof = flight.touches(length, ends, times)
    doubts = _undecided(proof, 2, f"lips and beaks for {family.over}")
    listed_places = [
        (event.tau, event.t, event.value) for event in events if event.kind in ("lips", "beaks", "undecided")
    ]
    for zero in proof.found:
        tau, t, value = (float(number.mid()) for number in zero)
        turn = next(iter(family.periods(np.array([value])).values()), length)
        inside = -NEAR * turn <= tau < turn * (1 - NEAR) and _within(t, times) and _within(value, ends)
        if inside and not any(_near((tau, t, value), other) for other in listed_places):
            doubts.append(f"the list lacks lips or beaks at {family.over} = {value:.12g}, tau = {tau:.6g}, t = {t:.6g}")
    for swan in (event for event in events if event.kind.startswith("swan")):
        crossings = flight.swallowtails(_rounded(swan.tau), _rounded(swan.value), times)
        doubts += _undecided(crossings, 0, "swallowtails at t")
        listed_there = [(event.t,) for event in events if event.kind == "swallowtail" and event.value == swan.value]
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
    flight = linear_flight(form, clearance)
    if flight is None:
        return None
    heights = [flight.from_rest]
    for _ in range(4):
        heights.append(derivative(heights[-1], "t"))
    return RestFlight(family.over, flight.push, tuple(heights))


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
