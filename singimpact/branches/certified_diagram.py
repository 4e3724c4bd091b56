"""A bifurcation diagram over the clearance of which every line is a theorem: all orbits, and where they change.

The orbits of n impacts in k periods of a linear model with one harmonic lie on curves (`clearance_curves`). Balls
isolate all places on them where c turns back (a fold), 1 + t + d of the return map vanishes (a doubling), a flight
touches the wall, or c or a velocity is at an end of its window. Between two of these nothing changes: one orbit tells
of all whether they lie in the window, are visible, and are stable. c is monotone there.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial, reduce
from itertools import chain, pairwise
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra import (
    Array,
    Certified,
    as_rational,
    balls_at,
    from_ball,
    names_in,
    rational_ends,
    series_of_any_length,
    sign_of,
)
from singimpact.algebra.isolated_zeros import SETTINGS as BOXES, Place, zeros_of
from singimpact.branches.clearance_curves import Ball, ClearanceCurve, OrbitOnCurve, Series
from singimpact.branches.events.graze import GRAZE, INTERIOR_GRAZE
from singimpact.branches.events.unit_multipliers import FOLD, PERIOD_DOUBLING
from singimpact.handed_on import flint
from singimpact.inputs import checked_keywords, require, whole
from singimpact.oscillator import Oscillator, linear_form, require_model
from singimpact.result import Result

SEARCH = replace(BOXES, least=Fraction(1, 2**24), lost=40)
ALONG = Fraction(1, 64)  # boxes of p and a time of flight are this part as long in p
BEYOND = Fraction(1, 2**12)  # of its length, p goes beyond its ends
DIGITS = 15
POINTS = 33  # of an arc that are computed
PIECES = 2**12  # of a flight, before it is open whether it is first to hit
ORDERED = "two rational numbers low < high"
ACCEPTED = "a linear model with one harmonic, stiffness that is not 0, a number > 0 for restitution and one wall"


@dataclass(frozen=True)
class Joint(Result):
    """A place where orbits change, proved to be there and to be the only one of its kind within its radii.

    Attributes
    ----------
    kind : "fold", "period-doubling", "graze", "hidden impact", or "window": c or a velocity is at an end of its window.
    n, k : of the orbits. clearance, v : of the orbit there, `Certified`; v after each impact.
    """

    kind: str
    n: int
    k: int
    clearance: Certified
    v: tuple[Certified, ...]


@dataclass(frozen=True, eq=False)
class Arc(Result):
    """Orbits between two joints: exactly one for every clearance between those of its ends.

    Attributes
    ----------
    n, k : of the orbits. stable : whether all of them are, except at the joints.
    ends : the two joints; None where an open part begins.
    clearance : of some of the orbits, shape (m,). tau, v : their states, shape (m, n).
    """

    n: int
    k: int
    stable: bool
    ends: tuple[Joint | None, Joint | None]
    clearance: Array
    tau: Array
    v: Array


@dataclass(frozen=True)
class OpenPart(Result):
    """Where there may be orbits of n impacts in k periods that are not shown, and arcs that end.

    Attributes
    ----------
    n, k : of the orbits. between, v : their clearances and velocities.
    """

    n: int
    k: int
    between: tuple[float, float]
    v: tuple[float, float]


@dataclass(frozen=True, eq=False, repr=False)
class CertifiedDiagram(Result):
    """All orbits of some kinds in a window.

    Attributes
    ----------
    model : its clearance plays no part. orbits : the pairs (n, k). between, v : the window, of the clearance and of
        every velocity after an impact.
    arcs, joints : lines of orbits, and where they end. open_parts : what is not decided.
    """

    model: Oscillator
    orbits: tuple[tuple[int, int], ...]
    between: tuple[Fraction, Fraction]
    v: tuple[Fraction, Fraction]
    arcs: tuple[Arc, ...]
    joints: tuple[Joint, ...]
    open_parts: tuple[OpenPart, ...]

    @property
    def complete(self) -> bool:
        """Whether nothing is left open."""
        return not self.open_parts

    def __repr__(self) -> str:
        kinds = [joint.kind for joint in self.joints]
        told = ", ".join(f"{kinds.count(kind)} {kind}" for kind in dict.fromkeys(kinds))
        left = f"{len(self.open_parts)} parts open" if self.open_parts else "complete"
        return f"CertifiedDiagram({len(self.arcs)} arcs; {told}; {left})"


class _Window(NamedTuple):
    # where orbits are looked for

    between: tuple[Ball, Ball]
    v: tuple[Ball, Ball]

    def misses(self, orbit: OrbitOnCurve) -> bool:
        # whether every orbit over a ball is outside
        sides = [(orbit.c[0], self.between), *((v[0], self.v) for v in orbit.v)]
        return any(value < low or value > high for value, (low, high) in sides)

    def holds(self, orbit: OrbitOnCurve) -> bool:
        # whether every orbit over a ball is inside
        sides = [(orbit.c[0], self.between), *((v[0], self.v) for v in orbit.v)]
        return all(low < value < high for value, (low, high) in sides)


@dataclass(frozen=True)
class _Along:
    # zeros of a function of p in the window: a `System`

    curve: ClearanceCurve
    window: _Window
    value: Callable[[OrbitOnCurve], Series]

    def without_zeros(self, box: Place) -> bool:
        orbit = self.curve.at(box[0])
        return orbit is not None and (self.window.misses(orbit) or not self.value(orbit)[0].contains(0))

    def linearised(self, box: Place, middle: Place) -> tuple[Sequence[Ball], Sequence[Sequence[Ball]]] | None:
        over, at = self.curve.at(box[0]), self.curve.at(middle[0])
        return None if over is None or at is None else ([self.value(at)[0]], [[self.value(over)[1]]])


@dataclass(frozen=True)
class _Touches:
    # zeros (p, t) of the height of a flight and of its rate, t after the launch: a `System`

    curve: ClearanceCurve
    window: _Window
    flight: int

    def without_zeros(self, box: Place) -> bool:
        p, t = box
        orbit = self.curve.at(p)
        if orbit is None or t < 0 or t > orbit.spans[self.flight] or self.window.misses(orbit):
            return orbit is not None
        start, motion = orbit.launched(self.flight, 0), self.curve.motion
        state = motion(t) * start
        # a flight that is convex or concave from the touch to one of its ends, at the wall, is not at the wall there
        ends = t * 0, orbit.spans[self.flight]
        bent = ((motion.A * motion(t.union(end)) * start)[1, 0] for end in ends)
        return not (state[0, 0].contains(0) and state[1, 0].contains(0)) or any(not force.contains(0) for force in bent)

    def linearised(self, box: Place, middle: Place) -> tuple[Sequence[Ball], Sequence[Sequence[Ball]]] | None:
        over, at = self.curve.at(box[0]), self.curve.at(middle[0])
        if over is None or at is None:
            return None
        flow, here = self.curve.motion(box[1]), self.curve.motion(middle[1]) * at.launched(self.flight, 0)
        state, moved = (flow * over.launched(self.flight, order) for order in (0, 1))
        rate = self.curve.motion.A * state
        return [here[0, 0], here[1, 0]], [[moved[i, 0], rate[i, 0]] for i in (0, 1)]


class _Stretch(NamedTuple):
    # a stretch of p: of an event, or one that is not decided

    p: Ball
    kind: str | None


@checked_keywords
def certified_diagram(
    osc: Oscillator,
    orbits: Sequence[tuple[int, int]] = ((1, 1), (1, 2), (2, 2)),
    *,
    between: tuple[Any, Any],
    v: tuple[Any, Any],
) -> CertifiedDiagram:
    """All orbits of one or two impacts, for all clearances of an interval, with the places where they change.

    Parameters
    ----------
    osc : linear with one harmonic, with one wall; its clearance plays no part.
    orbits : pairs (n, k), of n = 1 or 2 impacts in k periods of the forcing.
    between : (low, high), the clearances. v : (low, high), the window of all velocities after impacts.

    Raises
    ------
    InputError : another model, or windows that are none.

    Examples
    --------
    >>> from singimpact.impact_oscillator import linear
    >>> found = certified_diagram(linear("2.8", 0, "0.8"), [(1, 1)], between=("-0.2", "0.2"), v=("0.1", 1))
    >>> found
    CertifiedDiagram(2 arcs; 2 window, 1 period-doubling; complete)
    >>> print(found.joints[1].clearance, [arc.stable for arc in found.arcs])
    0.0685756522788391 [False, True]
    """
    require_model("osc", osc)
    paired = isinstance(orbits, tuple | list) and orbits and all(np.shape(pair) == (2,) for pair in orbits)
    require(paired, "orbits", orbits, "pairs (n, k)")
    pairs = tuple((whole("n", n, 1, 2), whole("k", k, 1, 1000)) for n, k in orbits)
    ends = rational_ends("between", between, ORDERED), rational_ends("v", v, ORDERED)
    require(ends[1][0] >= 0, "v", v, "two rational numbers 0 <= low < high")
    form = linear_form(osc)
    linear = form is not None and len({wave.rate for wave in form.harmonics}) == 1 and sign_of(form.stiffness)
    require(linear and not (osc.upper or osc.plastic or names_in(osc.restitution)), "model", osc, ACCEPTED)
    with balls_at(SEARCH.bits), series_of_any_length():
        curves = [ClearanceCurve(osc, pair, SEARCH.bits, sign) for pair in pairs for sign in (1, -1)[: pair[0]]]
        arcs, joints, parts = zip(*(_searched(curve, ends) for curve in curves), strict=True)
    return CertifiedDiagram(osc, pairs, *ends, *(tuple(chain.from_iterable(kind)) for kind in (arcs, joints, parts)))


def _searched(
    curve: ClearanceCurve, ends: Sequence[tuple[Fraction, Fraction]]
) -> tuple[list[Arc], list[Joint], list[OpenPart]]:
    # the arcs of a curve, their joints, and what is open
    window = _Window(*((curve.balls.rational(low), curve.balls.rational(high)) for low, high in ends))
    stretches = _events(curve, window)
    arcs, joints = list[Arc](), dict[int, Joint]()
    left = [stretch.p for stretch in stretches if stretch.kind is None]
    for index, (one, other) in enumerate(pairwise(stretches)):
        middle = curve.at(curve.balls.rational((as_rational(one.p.upper()) + as_rational(other.p.lower())) / 2))
        if middle is None or not (window.misses(middle) or window.holds(middle)):
            left.append(one.p.union(other.p))
        elif window.holds(middle):
            seen, stable = _visible(middle), _stable(middle)
            if seen is None or stable is None:
                left.append(one.p.union(other.p))
            elif seen:
                for at, stretch in ((index, one), (index + 1, other)):
                    if stretch.kind is not None:
                        joints.setdefault(at, _joint(curve, stretch))
                between = float(one.p.mid()), float(other.p.mid())
                arcs.append(_arc(curve, between, stable, (joints.get(index), joints.get(index + 1))))
    return arcs, [joints[at] for at in sorted(joints)], _open_parts(curve, window, left)


def _events(curve: ClearanceCurve, window: _Window) -> list[_Stretch]:
    # all events of a curve in the window, in the order of p; what overlaps is not decided
    low, high = (Fraction(end) for end in curve.ends)
    long = high - low
    along = low - long * BEYOND, high + long * BEYOND
    tests: list[tuple[str, Callable[[OrbitOnCurve], Series]]] = [
        (FOLD.name, lambda orbit: orbit.c.derivative()),
        (PERIOD_DOUBLING.name, lambda orbit: orbit.test(-1)),
        *(("window", partial(_above, edge, None)) for edge in window.between),
        *(
            ("window" if edge > 0 else GRAZE.name, partial(_above, edge, i))
            for edge in window.v
            for i in range(curve.n)
        ),
    ]
    searches = [(kind, zeros_of(_Along(curve, window, test), (along,), SEARCH)) for kind, test in tests]
    end = as_rational(curve.span)
    box, sizes = (along, (-end * BEYOND, end * (1 + BEYOND))), (long * ALONG, end)
    searches += [
        (INTERIOR_GRAZE.name, zeros_of(_Touches(curve, window, flight), box, SEARCH, sizes))
        for flight in range(curve.n)
    ]
    stretches = [_Stretch(zero[0], kind) for kind, zeros in searches for zero in zeros.found]
    stretches += [_Stretch(curve.balls.interval(*box[0]), None) for _, zeros in searches for box in zeros.undecided]
    merged = list[_Stretch]()
    for stretch in sorted(stretches, key=lambda stretch: float(stretch.p.mid())):
        if any(stretch.p > alike for alike in curve.alike):
            continue
        if stretch.kind == FOLD.name and any(stretch.p.overlaps(alike) for alike in curve.alike):
            # of the orbit of one impact: by symmetry c turns back there
            stretch = _Stretch(stretch.p, PERIOD_DOUBLING.name)
        # a wide one may reach several before it
        while merged and merged[-1].p.overlaps(stretch.p):
            stretch = _Stretch(merged.pop().p.union(stretch.p), None)
        merged.append(stretch)
    return merged


def _above(edge: Ball, impact: int | None, orbit: OrbitOnCurve) -> Series:
    return (orbit.c if impact is None else orbit.v[impact]) - edge


def _stable(orbit: OrbitOnCurve) -> bool | None:
    # both multipliers are below 1 in size where their product and both tests say so
    tests = [orbit.test(multiplier)[0] / orbit.traced[1][0] for multiplier in (1, -1)]
    if orbit.curve.determinant < 1 and all(test > 0 for test in tests):
        return True
    return False if orbit.curve.determinant >= 1 or any(test < 0 for test in tests) else None


def _visible(orbit: OrbitOnCurve) -> bool | None:
    # whether the heights of all flights, which rise at first and fall at last, are positive; None where it is open
    balls = orbit.curve.balls
    for flight, span in enumerate(orbit.spans):
        start = orbit.launched(flight, 0)
        pieces, tried = [(Fraction(0), Fraction(1))], 0
        while pieces:
            low, high = pieces.pop()
            middle, tried = (low + high) / 2, tried + 1
            state = orbit.curve.motion(span * balls.interval(low, high)) * start
            if state[0, 0] > 0 or (low == 0 and state[1, 0] > 0) or (high == 1 and state[1, 0] < 0):
                continue
            if (orbit.curve.motion(span * balls.rational(middle)) * start)[0, 0] < 0:
                return False
            if tried > PIECES:
                return None
            pieces += [(low, middle), (middle, high)]
    return True


def _joint(curve: ClearanceCurve, stretch: _Stretch) -> Joint:
    orbit = curve.at(stretch.p)
    assert orbit is not None
    c, *v = (from_ball(series[0], DIGITS) for series in (orbit.c, *orbit.v))
    return Joint(str(stretch.kind), curve.n, curve.k, c, tuple(v))


def _arc(
    curve: ClearanceCurve, between: tuple[float, float], stable: bool, ends: tuple[Joint | None, Joint | None]
) -> Arc:
    rows = []
    for p in np.linspace(*between, POINTS).tolist():
        orbit = curve.at(flint.arb(p))
        assert orbit is not None
        phases = [np.mod(float(curve.phase(launch)), float(curve.period)) for launch in orbit.launches]
        rows.append([float(orbit.c[0]), *phases, *(float(v[0]) for v in orbit.v)])
    table = np.array(rows)
    return Arc(curve.n, curve.k, stable, ends, table[:, 0], table[:, 1 : 1 + curve.n], table[:, 1 + curve.n :])


def _open_parts(curve: ClearanceCurve, window: _Window, left: list[Ball]) -> list[OpenPart]:
    # the parts of the window in which the orbits over these stretches of p may be
    parts = []
    for p in left:
        orbit = curve.at(p)
        if orbit is None or not window.misses(orbit):
            rows = ([], []) if orbit is None else ([orbit.c[0]], [v[0] for v in orbit.v])
            # what is not bounded is left to the whole window
            reached = (reduce(flint.arb.union, balls or ends) for balls, ends in zip(rows, window, strict=True))
            inner = (
                (max(float(low), float(side.lower())), min(float(high), float(side.upper())))
                for side, (low, high) in zip(reached, window, strict=True)
            )
            parts.append(OpenPart(curve.n, curve.k, *inner))
    return parts
