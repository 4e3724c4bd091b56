"""A homoclinic or heteroclinic orbit that is proved to exist, with a proved angle of W^u and W^s.

    F = (G(K_u(s_u)) - z_1, G(z_1) - z_2, ..., G(z_(N-1)) - K_s(s_s)),      whole periods taken off

The unknowns are s_u, z_1, ..., z_(N-1), s_s. K_u(s) = p + E (s, w(s)) is W^u next to the saddle that the orbit leaves,
K_s(s) = q + E (w(s), s) is W^s next to the one it comes to; of w it is proved that |w(s)| <= L |s| and |w'| <= L
(`saddle_cones`). Balls of these widths stand for w and w' in Krawczyk's operator, so its zero is an orbit on the true
manifolds. D F is regular there: W^u and W^s cross transversally. The ends of the orbit are moved towards the saddles
until the width of the wedges, contracted by the flights in between, is below the digits asked for.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import ceil, log
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra import BITS_A_DIGIT, Array, Certified, balls_at, exact, from_ball
from singimpact.branches.krawczyk import KRAWCZYK, EnclosedOrbit, Image, Krawczyk, proved, upper
from singimpact.branches.orbits import PeriodicOrbit
from singimpact.branches.saddle_cones import Cones, Pair, smooth
from singimpact.dynamics.invariant_arcs import model_step
from singimpact.flights import ProvedImpact, Refused
from singimpact.handed_on import flint
from singimpact.inputs import need
from singimpact.oscillator.model import Oscillator


@dataclass(frozen=True)
class EnclosedCrossingSettings:
    """Distances from the saddles at which an orbit is cut off.

    Parameters
    ----------
    spare : digits beside those asked for, of the balls and of the wedges; a wedge of length s is 10^3 s^2 wide or less.
    attempts, more : where the digits are not reached, so often so many digits are added.
    moved : how far, in tau and in v, the proved states may lie from those that are given.
    impacts : of an orbit at most. digits : at most, so that places on the wedges are doubles.
    """

    spare: int = 10
    attempts: int = 3
    more: int = 6
    moved: Fraction = Fraction(1, 10**4)
    impacts: int = 1000
    digits: int = 500


SETTINGS = EnclosedCrossingSettings()


@dataclass(frozen=True)
class EnclosedCrossing:
    """An orbit that leaves one saddle along W^u and comes to a saddle along W^s, proved to exist.

    Attributes
    ----------
    tau, v : `Certified` impact that is farthest from both saddles, a transverse crossing of W^u and W^s.
    angle : at which they cross there, in radians, of tau and v as numbers: `Certified`, above 0.
    states : all impacts as pairs of `Certified`, from W^u next to one saddle to W^s next to the other; those at both
        ends have fewer digits. index : of (tau, v) among them.
    unique_within : no other orbit of as many impacts from the wedge of W^u to that of W^s has all its states within
        this distance, in tau and in v.
    kind : "homoclinic" or "heteroclinic". unstable, stable : the saddles that it leaves and comes to, proved.
    oscillator : the model.
    slopes : (L_u, L_s): at the ends W^u and W^s deviate from the eigenvectors' lines by slopes of at most these.

    Notes
    -----
    Every flight between the impacts, and from every state of the boxes around the two saddles, is proved to be the
    first hit, with x' < 0: the impact map is a smooth local diffeomorphism along the closure of the orbit.
    """

    tau: Certified
    v: Certified
    angle: Certified
    states: tuple[tuple[Certified, Certified], ...]
    index: int
    unique_within: Fraction
    kind: str
    unstable: EnclosedOrbit
    stable: EnclosedOrbit
    oscillator: Oscillator
    slopes: tuple[Fraction, Fraction]

    @property
    def impacts(self) -> int:
        """Of the orbit from end to end."""
        return len(self.states)

    @property
    def slowest(self) -> Certified:
        """The v of the weakest impact."""
        return min((v for _, v in self.states), key=lambda each: float(each.value))

    def __repr__(self) -> str:
        return (
            f"<certified {self.kind} point ({self.tau}, {self.v}), angle {float(self.angle.value):.6g}, "
            f"{self.impacts} impacts>"
        )


def enclosed_crossing(
    ends: tuple[PeriodicOrbit, PeriodicOrbit], states: Array, index: int, digits: int
) -> EnclosedCrossing | str:
    """The orbit next to some states, proved; or the reason why it is not.

    Parameters
    ----------
    ends : the saddle that it leaves and the one that it comes to, one object for a homoclinic orbit.
    states : impacts from next to the first impact of one saddle to next to that of the other, shape (N + 1, 2), about.
    index : of the state with all digits. digits : of that state.
    """
    if digits > SETTINGS.digits:
        return f"at most {SETTINGS.digits} digits are certified"
    why = ""
    for attempt in range(SETTINGS.attempts):
        working = digits + SETTINGS.spare + attempt * SETTINGS.more
        bits = ceil(working * BITS_A_DIGIT) + 64
        with balls_at(bits):
            enclosure = proved(lambda w=working, b=bits: _enclosed(ends, states, index, (digits, w, b)))  # type: ignore[misc]
        if isinstance(enclosure, str):  # nearer to the saddles the boxes are smaller
            why = enclosure
            continue
        radius = max(exact("radius", coordinate.radius) for coordinate in (enclosure.tau, enclosure.v))
        if radius < Fraction(1, 10**digits):
            return enclosure  # type: ignore[no-any-return]
        why = f"the enclosure has a radius of {float(radius):.1g}"
    return why


def _enclosed(
    ends: tuple[PeriodicOrbit, PeriodicOrbit], states: Array, index: int, wanted: tuple[int, int, int]
) -> EnclosedCrossing:
    digits, working, bits = wanted
    leave = Cones(ends[0], working, bits)
    come = leave if ends[1] is ends[0] else Cones(ends[1], working, bits)
    near, start, turned = prolonged(leave, come, states, working)
    between = _Between(leave, come, start)
    first = [near[0], *(Fraction(float(x)) for state in start[1:-1] for x in state), near[1]]
    small = Fraction(1, 10 ** (working + 2))
    operator = Krawczyk(between, first, small, between.radii)
    at = operator.solved(first)
    if max(abs(one - other) for one, other in zip(at, first, strict=True)) > SETTINGS.moved:
        raise Refused("Newton's method leaves the states")
    step = operator.step(at)
    own = [max(KRAWCZYK.margin * upper(component), small) for component in step]
    tight = operator.tight(at, step, own)
    for end, radius in ((at[0], own[0]), (at[-1], own[-1])):
        need(abs(end) > radius, Refused("an end of the orbit is not told from the saddle"))
    position = turned + index
    angle = _angle(between, tight, position)
    need(angle > 0, Refused("the angle of W^u and W^s is not told from 0"))
    least = min(radius / unit for radius, unit in zip(own, between.radii(Fraction(1)), strict=True))
    unique = operator.unique_within(at, step, least)
    shown = [(_shown(tau, digits), _shown(v, digits)) for tau, v in between.states(tight)]
    return EnclosedCrossing(
        *shown[position],
        _shown(angle, digits),
        tuple(shown),
        position,
        unique,
        "homoclinic" if come is leave else "heteroclinic",
        leave.orbit,
        come.orbit,
        leave.saddle.oscillator,
        (between.leaving(at[0], own[0]).slope, between.coming(at[-1], own[-1]).slope),
    )


def _shown(ball: Any, digits: int) -> Certified:
    """A ball as a number, which prints the digits that are known of it."""
    return from_ball(ball, max(min(digits, int(ball.rel_accuracy_bits() / BITS_A_DIGIT)), 1))


# ---- the ends


def prolonged(leave: Cones, come: Cones, states: Array, working: int) -> tuple[tuple[Fraction, Fraction], Array, int]:
    """s_u and s_s about, the states with turns added at both saddles, and how many impacts were added at the first.

    A wedge at s is s^2 wide, and the width at the middle is that times what the turns in between contract:
    |s|^(2 + e), where |s|^e is the contraction of the |s|^(-1) by which the other direction is stretched.
    """
    sizes = [[abs(float(pair[0].value)) for pair in cones.orbit.multipliers or ()] for cones in (leave, come)]
    if not all(len(pair) == 2 and pair[0] > 1 > pair[1] for pair in sizes):
        raise Refused("the orbit is not proved to be a saddle")
    period = float(leave.map.period)
    xi, eta = _coordinates(leave, states[0], period)[0], _coordinates(come, states[-1], period)[1]
    (far, near), (out, inward) = sizes
    mu = [float(cones.orbit.multipliers[i][0].value) for i, cones in enumerate((leave, come))]  # type: ignore[index]
    lengths = 10 ** (-working / (2 - log(near) / log(far))), 10 ** (-working / (2 - log(out) / log(inward)))
    before = max(ceil(log(abs(xi) / lengths[0]) / log(far)), 0)
    after = max(ceil(log(lengths[1] / abs(eta)) / log(inward)), 0)
    n, m = int(leave.saddle.n), int(come.saddle.n)
    if len(states) + n * before + m * after > SETTINGS.impacts:
        raise Refused(
            f"the ends are near enough to the saddles after {len(states) + n * before + m * after} impacts, "
            f"more than {SETTINGS.impacts}: ask for fewer digits"
        )
    added = [state for turn in range(before) for state in _turn(leave, (xi * mu[0] ** (turn - before), 0.0))[:-1]]
    behind = [state for turn in range(after) for state in _turn(come, (0.0, eta * mu[1] ** turn))[1:]]
    ends = Fraction(xi * mu[0] ** -before), Fraction(eta * mu[1] ** after)
    return ends, np.vstack([*added, states, *behind]), n * before


def _coordinates(cones: Cones, state: Array, period: float) -> tuple[float, float]:
    away = np.array([float(state[0] - float(cones.centre[0])), float(state[1] - float(cones.centre[1]))])
    away[0] -= period * np.rint(away[0] / period)
    xi, eta = np.array([[float(part) for part in row] for row in cones.coordinates]) @ away
    return float(xi), float(eta)


def _turn(cones: Cones, place: tuple[float, float]) -> list[Array]:
    """States of one turn from a point next to a saddle, both ends among them."""
    found = [np.array([float(part) for part in cones.state(Fraction(place[0]), Fraction(place[1]))[0]])]
    for _ in range(int(cones.saddle.n)):
        found.append(model_step(cones.saddle.oscillator, found[-1][None])[0])
    return found


class _End(NamedTuple):
    """A box of states on a manifold next to a saddle: centre and radii, and the slope of its wedge."""

    centre: Pair
    radii: Pair
    slope: Fraction


class _Slopes(NamedTuple):
    """D G over the boxes of z_0 ... z_(N-1), and the slopes of both wedges."""

    hits: list[ProvedImpact]
    ends: Pair


class _Between:
    """F and D F between two saddles."""

    def __init__(self, leave: Cones, come: Cones, start: Array) -> None:
        self.leave, self.come, self.map = leave, come, leave.map
        self.balls, self.count = leave.map.balls, len(start) - 1
        period = float(leave.map.period)
        places = np.vstack([[float(part) for part in leave.centre], start[1:-1], [float(part) for part in come.centre]])
        landed = model_step(leave.saddle.oscillator, places[:-1])
        need(np.isfinite(landed).all(), Refused("a flight of the orbit has no end"))
        # the first state moves by less than half a period until it is z_0
        self.turns = [int(turn) for turn in np.rint((landed[:, 0] - places[1:, 0]) / period)]

    def leaving(self, s: Fraction, radius: Fraction) -> _End:
        """The box of K_u over a ball of s."""
        slope = self.leave.wedge(abs(s) + radius).unstable
        return _End(*self.leave.state(s, Fraction(0), (radius, slope * (abs(s) + radius))), slope)

    def coming(self, s: Fraction, radius: Fraction) -> _End:
        """The box of K_s over a ball of s."""
        slope = self.come.wedge(abs(s) + radius).stable
        return _End(*self.come.state(Fraction(0), s, (slope * (abs(s) + radius), radius)), slope)

    def ball(self, centre: Fraction, radius: Fraction) -> Any:
        """All numbers within a radius."""
        return self.balls.rational(centre) + flint.arb(0, self.balls.rational(radius).upper())

    def miss(self, at: list[Fraction]) -> Any:
        """F at a point, as a column."""
        none, rows = Fraction(0), []
        first, last = self.leaving(at[0], none), self.coming(at[-1], none)
        for i in range(self.count):
            hit = self.map(at[2 * i - 1 : 2 * i + 1]) if i else self.map(first.centre, first.radii)
            after = (
                [self.balls.rational(coordinate) for coordinate in at[2 * i + 1 : 2 * i + 3]]
                if i < self.count - 1
                else list(map(self.ball, last.centre, last.radii))
            )
            rows += [[hit.tau - after[0] - self.turns[i] * self.map.period], [hit.v - after[1]]]
        return flint.arb_mat(rows)

    def slopes(self, at: list[Fraction], radii: Sequence[Fraction]) -> _Slopes:
        """D G over the box round each state."""
        first, last = self.leaving(at[0], radii[0]), self.coming(at[-1], radii[-1])
        hits = [self.map(first.centre, first.radii)]
        hits += [self.map(at[2 * i - 1 : 2 * i + 1], radii[2 * i - 1 : 2 * i + 1]) for i in range(1, self.count)]
        return _Slopes(list(map(smooth, hits)), (first.slope, last.slope))

    def matrix(self, slopes: _Slopes) -> Any:
        """D F: a column of s_u, blocks beside the diagonal, a column of s_s."""
        size = 2 * self.count
        rows = [[flint.arb(0)] * size for _ in range(size)]
        tangent = flint.arb_mat(slopes.hits[0].derivative) * self.tangent(self.leave, slopes.ends[0], 0)
        end = self.tangent(self.come, slopes.ends[1], 1)
        for p in (0, 1):
            rows[p][0] = tangent[p, 0]
            rows[size - 2 + p][size - 1] = -end[p, 0]
            for i in range(1, self.count):
                for q in (0, 1):
                    rows[2 * i + p][2 * i - 1 + q] = slopes.hits[i].derivative[p][q]
                rows[2 * i - 2 + p][2 * i - 1 + p] = flint.arb(-1)
        return flint.arb_mat(rows)

    def tangent(self, cones: Cones, slope: Fraction, along: int) -> Any:
        """K' over a wedge."""
        rows = [
            [self.balls.rational(row[along]) + self.ball(Fraction(0), slope) * self.balls.rational(row[1 - along])]
            for row in cones.frame
        ]
        return flint.arb_mat(rows)

    def radii(self, distance: Fraction) -> list[Fraction]:
        """Of s at both ends as far as the coordinates of states within the distance go."""
        ends = [distance * sum(map(abs, cones.coordinates[i])) for i, cones in enumerate((self.leave, self.come))]
        return [ends[0], *[distance] * (2 * self.count - 2), ends[1]]

    def states(self, zero: Image) -> list[list[Any]]:
        """Balls of all impacts, with tau as it was given."""
        inner = [self.balls.rational(x) + off for x, off in zip(zero.centre, zero.offsets, strict=True)]
        first = self.leaving(zero.centre[0], upper(zero.offsets[0]))
        last = self.coming(zero.centre[-1], upper(zero.offsets[-1]))
        boxes = [list(map(self.ball, each.centre, each.radii)) for each in (first, last)]
        return [boxes[0], *(inner[2 * i - 1 : 2 * i + 1] for i in range(1, self.count)), boxes[1]]


def _angle(between: _Between, zero: Image, index: int) -> Any:
    """A ball of the angle of W^u and W^s at a state."""
    slopes = [flint.arb_mat(hit.derivative) for hit in zero.slopes.hits]
    start = between.tangent(between.leave, zero.slopes.ends[0], 0)
    end = between.tangent(between.come, zero.slopes.ends[1], 1)
    u = _carried(start, slopes[:index])
    w = _carried(end, [slope.inv() for slope in reversed(slopes[index:])])
    crossed = abs(u[0, 0] * w[1, 0] - u[1, 0] * w[0, 0])
    sizes = [(direction.transpose() * direction)[0, 0] for direction in (u, w)]
    return (crossed / (sizes[0] * sizes[1]).sqrt()).asin()


def _carried(vector: Any, slopes: list[Any]) -> Any:
    """A vector along a direction after some maps.

    It is kept as t + kappa t', t a point and t' orthogonal to it: maps that draw directions together shrink kappa.
    """
    image, kappa = flint.arb_mat([[component, 0] for component in vector.entries()]), flint.arb(0)
    for slope in [*slopes, None]:
        x, y = ((image[row, 0] + kappa.mid() * image[row, 1]).mid() for row in (0, 1))
        length = (x * x + y * y).sqrt().mid()
        x, y = (x / length).mid(), (y / length).mid()
        frame = flint.arb_mat([[x, -y], [y, x]])
        turned = frame.transpose() * image
        kappa = (turned[1, 0] + kappa * turned[1, 1]) / (turned[0, 0] + kappa * turned[0, 1])
        if slope is not None:
            image = slope * frame
    return frame * flint.arb_mat([[1], [kappa]])
