"""Where W^u of a saddle crosses W^s: homoclinic and heteroclinic orbits, by Newton's method on all of their impacts.

    z_0 = K_u(s_u),   G(z_i) = z_{i+1},   z_N = K_s(s_s)        i = 0, ..., N - 1

K_u and K_s are the arcs next to the saddles.  The unknowns are s_u, s_s and z_1 ... z_{N-1}: no error grows along the
orbit, as it would if z_N were flown from z_0.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.branches.cylinder import apart, meetings
from singimpact.branches.manifold import Manifold, manifold
from singimpact.branches.orbits import PeriodicOrbit
from singimpact.branches.saddle_arcs import LocalArc, checked_saddle
from singimpact.dynamics import Piece, before, model_step
from singimpact.flights.derivative import derivative
from singimpact.flights.impact_map import checked_digits
from singimpact.inputs import InputError, checked_keywords, refuse, require
from singimpact.result import Result, Results
from singimpact.surface.curve import RESOLUTION

if TYPE_CHECKING:
    from singimpact.branches.enclosed_crossing import EnclosedCrossing
    from singimpact.branches.horseshoe import Horseshoe, HorseshoeFamily


@dataclass(frozen=True)
class CrossingSettings:
    """When a crossing of two polylines is one of the curves; lengths are in sides of the window."""

    # a chord longer than this is one outside the window, where curves are not resolved
    longest: float = 0.05
    # Newton's method: rounds, and the step that is rounding
    rounds: int = 12
    arrived: float = 1e-13
    # by how much impacts may miss one another in the end
    residual: float = 1e-11
    # how far the crossing may move from that of the polylines, in resolutions
    moved: float = 8.0
    # two orbits whose s_u differ by less than this, relative, are one
    same: float = 1e-7
    # how near to a saddle the ends of an orbit are, in s, and turns of the saddle for that at most
    ends: float = 1e-5
    turns: int = 60


SETTINGS = CrossingSettings()


@dataclass(frozen=True, eq=False)
class Crossing(Result):
    """An orbit that leaves one saddle along W^u and comes to a saddle along W^s.

    Parameters
    ----------
    tau, v : the impact that is farthest from both saddles, a point of W^u and of W^s.
    angle : at which they cross there, in radians, of tau and v as numbers; angles : at all impacts.
    states : all impacts from next to one saddle to next to the other, shape (N + 1, 2), tau within a period.
    index : of (tau, v) among them. residual : the largest miss of an impact, in sides of the window.
    error : of the states, estimated from the last step of Newton's method and the error of the arcs, in the same unit.
    s : the places on the two arcs. unstable, stable : the saddles that the orbit leaves and comes to.
    """

    tau: float
    v: float
    angle: float
    angles: Array
    states: Array
    index: int
    residual: float
    error: float
    s: tuple[float, float]
    unstable: PeriodicOrbit
    stable: PeriodicOrbit

    @property
    def kind(self) -> str:
        """Homoclinic: to the saddle that it leaves; heteroclinic: to another one."""
        one, other = self.unstable, self.stable
        same = (one.n, one.k) == (other.n, other.k) and all(
            np.allclose(np.asarray(a, dtype=float), np.asarray(b, dtype=float), rtol=0, atol=1e-9)
            for a, b in ((one.tau, other.tau), (one.v, other.v))
        )
        return "homoclinic" if same else "heteroclinic"

    @property
    def weakest(self) -> float:
        """The least v of the impacts: near 0 the orbit nearly grazes."""
        return float(self.states[:, 1].min())

    def certified(self, digits: int = 30) -> EnclosedCrossing:
        """The orbit, proved to exist: a transverse crossing of the true W^u and W^s.

        Parameters
        ----------
        digits : of the point; its angle and the impacts at both ends may have fewer, each number has its radius.

        Raises
        ------
        InputError : an orbit that is not proved, with the reason.

        Notes
        -----
        Of a homoclinic orbit this is what the theorem of Smale and Birkhoff assumes; `horseshoe` does without it.

        Examples
        --------
        >>> from singimpact.impact_oscillator import linear
        >>> (saddle,) = linear("2.8", 0, "0.8").periodic(1, 1)
        >>> homoclinic_points(saddle)[0].certified(12)
        <certified homoclinic point (1.77284317690, 0.428197991347), angle 1.29636, 28 impacts>
        """
        from singimpact.branches.enclosed_crossing import enclosed_crossing

        wanted = checked_digits(digits)
        ends = (self.unstable, self.unstable if self.kind == "homoclinic" else self.stable)
        enclosure = enclosed_crossing(ends, self.states, self.index, wanted)
        if isinstance(enclosure, str):
            raise InputError(f"{self!r} is not certified: {enclosure}")
        return enclosure

    def horseshoe(self) -> Horseshoe:
        """Chaos next to a homoclinic orbit, proved: loops near the saddle and along the orbit, in any order.

        Raises
        ------
        InputError : a heteroclinic orbit; one of which no horseshoe is proved, with the reason.

        Examples
        --------
        >>> from singimpact.impact_oscillator import linear
        >>> (saddle,) = linear("2.8", 0, "0.8").periodic(1, 1)
        >>> homoclinic_points(saddle)[0].horseshoe()
        <certified horseshoe: loops of 1 and 17 impacts in any order, entropy >= 0.125665>
        """
        from singimpact.branches.horseshoe import horseshoe

        loops = horseshoe(self._comes_back().unstable, self.states)
        if isinstance(loops, str):
            raise InputError(f"no horseshoe is proved next to {self!r}: {loops}")
        return loops

    def horseshoes(self, over: str, between: Any) -> HorseshoeFamily:
        """Chaos for all values of a number of the model, proved: horseshoes whose sets follow it.

        Parameters
        ----------
        over : restitution, clearance, or another number that the period does not depend on, as `branch` takes them.
        between : its least and largest value, rationals, not far from the model's: the orbit is followed from there.

        Raises
        ------
        InputError : as of `horseshoe`; a number that is not accepted.

        Examples
        --------
        >>> from singimpact.impact_oscillator import linear
        >>> (saddle,) = linear("2.8", 0, "0.8").periodic(1, 1)
        >>> homoclinic_points(saddle)[0].horseshoes("restitution", ("0.8", "0.8004"))
        <certified horseshoes for all restitution in [0.8, 0.8004], pieces: 1, entropy >= 0.137023>
        """
        from singimpact.branches.horseshoe import horseshoe_family

        family = horseshoe_family(self._comes_back().unstable, self.states, over, between)
        if isinstance(family, str):
            raise InputError(f"no horseshoes are proved next to {self!r} for all {over} in {between}: {family}")
        return family

    def _comes_back(self) -> Crossing:
        if self.kind != "homoclinic":
            raise InputError(f"{self!r} is not accepted: a horseshoe needs an orbit that comes back to its saddle")
        return self

    def __repr__(self) -> str:
        return (
            f"<{self.kind} point ({self.tau:.12g}, {self.v:.12g}), angle {self.angle:.6g}, {len(self.states)} impacts, "
            f"residual {self.residual:.1g}>"
        )


class Crossings(Results, list[Crossing]):
    """Orbits in which W^u and W^s cross, each once, those of fewest impacts first.

    Parameters
    ----------
    notes : what may be missing. manifolds : W^u and W^s.
    """

    called = "orbits"

    def __init__(self, found: Iterable[Crossing], notes: tuple[str, ...], manifolds: tuple[Manifold, Manifold]) -> None:
        super().__init__(found)
        self.notes, self.manifolds = notes, manifolds


@checked_keywords
def homoclinic_points(
    saddle: PeriodicOrbit,
    to: PeriodicOrbit | None = None,
    *,
    v: Any = None,
    length: Any = 6,
    resolution: Any = RESOLUTION.usual,
) -> Crossings:
    """Where W^u of a saddle crosses its W^s, each homoclinic orbit once.

    Parameters
    ----------
    saddle, v, length, resolution : as in `manifold`; both curves are grown to this length.
    to : another saddle of the same model, for the heteroclinic orbits from `saddle` to it.

    Returns
    -------
    Crossings : a list of `Crossing`, with `.notes` and `.manifolds`; empty where none is found.

    Raises
    ------
    InputError : as in `manifold`; saddles of two models.

    Notes
    -----
    Each is one orbit; its other impacts, `.states`, are crossings too. A longer `length` has more of them: where there
    is one transverse homoclinic orbit there are infinitely many.

    Examples
    --------
    >>> from singimpact.impact_oscillator import linear
    >>> (saddle,) = linear("2.8", 0, "0.8").periodic(1, 1)
    >>> first = homoclinic_points(saddle)[0]
    >>> first.residual < 1e-13, first.angle > 0.1
    (True, True)
    """
    ask = {"v": v, "length": length, "resolution": resolution}
    target = checked_saddle(saddle if to is None else to)
    if to is not None and target.oscillator != checked_saddle(saddle).oscillator:
        raise refuse("to", repr(to), "a saddle of the same model")
    return crossings(manifold(saddle, False, **ask), manifold(target, True, **ask))


def crossings(one: Manifold, other: Manifold) -> Crossings:
    """Where a W^u and a W^s cross, of one saddle or of two of one model: see `Crossings`."""
    for curve in (one, other):
        require(isinstance(curve, Manifold), "manifold", curve, "a result of si.manifold")
    if one.stable == other.stable:
        raise InputError(f"two curves {one.name}: give W^u of one saddle and W^s of one (stable=)")
    if one.saddle.oscillator != other.saddle.oscillator:
        raise InputError("the saddles are of two models: give manifolds of one")
    unstable, stable = (other, one) if one.stable else (one, other)
    return _Search(unstable, stable).found()


@dataclass(frozen=True)
class _Place:
    """A point of a manifold: by its arc, the images since, and s."""

    s: float
    generation: int
    side: int


@dataclass(frozen=True)
class Ends:
    """The arcs at both saddles, and the conditions of an orbit between them.

    Parameters
    ----------
    unstable, stable : arcs of W^u and W^s. period : of the forcing.
    """

    unstable: LocalArc
    stable: LocalArc
    period: float

    def missed(self, states: Array) -> tuple[Array, Array]:
        """G(z_i) - z_{i+1}, whole periods taken off, shape (N, 2), and D G at z_0 ... z_{N-1}."""
        osc = self.unstable.saddle.oscillator
        miss = model_step(osc, states[:-1]) - states[1:]
        miss[:, 0] -= self.period * np.rint(miss[:, 0] / self.period)
        return miss, derivative(osc, states[:-1, 0], states[:-1, 1]).matrix

    def matrix(self, slopes: Array, s: Array) -> Array:
        """Derivatives of the misses by s_u, z_1 ... z_{N-1}, s_s: of row i and column j the entry [1 + i - j, j]."""
        count = 2 * len(slopes)
        matrix = np.zeros((4, count))  # two diagonals below the main one and one above
        for i, slope in enumerate(slopes):
            if i == 0:
                matrix[[1, 2], 0] = slope @ self.unstable.slope(float(s[0]))
            else:
                for column in (0, 1):
                    at = 2 * i - 1 + column
                    matrix[[1 + 2 * i - at, 2 + 2 * i - at], at] = slope[:, column]
            if i < len(slopes) - 1:
                matrix[0, [2 * i + 1, 2 * i + 2]] = -1.0
        matrix[[0, 1], count - 1] = -self.stable.slope(float(s[1]))
        return matrix

    def angles(self, slopes: Array, s: Array) -> Array:
        """Angles between the tangents at all impacts, in (0, pi/2]."""
        away, home = [_unit(self.unstable.slope(float(s[0])))], [_unit(self.stable.slope(float(s[1])))]
        for slope in slopes:
            away.append(_unit(slope @ away[-1]))
        for slope in slopes[::-1]:
            home.append(_unit(np.linalg.solve(slope, home[-1])))
        cross = [abs(float(u[0] * w[1] - u[1] * w[0])) for u, w in zip(away, home[::-1], strict=True)]
        return np.arcsin(np.minimum(cross, 1.0))


@dataclass
class _Search:
    """Crossings of two polylines, refined one by one."""

    unstable: Manifold
    stable: Manifold
    rejected: dict[str, int] = field(default_factory=dict)

    def found(self) -> Crossings:
        """Each orbit once."""
        distinct: list[tuple[int, Crossing]] = []
        seen: list[tuple[int, Array]] = []
        for away, home, point in self._polylines():
            if any(side == away.side and self._passes(states, away, point) for side, states in seen):
                continue
            states, s, first = self._guess(away, home)
            crossing = self._refined(states, s, (first + away.generation, point))
            if isinstance(crossing, str):
                self.rejected[crossing] = self.rejected.get(crossing, 0) + 1
                continue
            seen.append((away.side, crossing.states[first:]))
            if not any(side == away.side and self._same(crossing, old) for side, old in distinct):
                distinct.append((away.side, crossing))
        notes = [f"W^u {note}" for note in self.unstable.notes] + [f"W^s {note}" for note in self.stable.notes]
        notes += [
            f"{count} crossings of the drawn curves are not in the list: {why}" for why, count in self.rejected.items()
        ]
        ordered = sorted((orbit for _, orbit in distinct), key=lambda orbit: (len(orbit.states), abs(orbit.s[0])))
        return Crossings(ordered, tuple(notes), (self.unstable, self.stable))

    def _passes(self, states: Array, away: _Place, point: Array) -> bool:
        """Whether a known orbit has an impact at a crossing, after as many images."""
        if away.generation >= len(states):
            return False
        gap = apart(states[away.generation] - point, self.unstable.window.sides)
        return bool(gap < 0.5 * self.unstable.window.resolution)

    def _same(self, one: Crossing, other: Crossing) -> bool:
        turn = self.unstable.arc.multiplier
        return any(abs(one.s[0] * turn**power / other.s[0] - 1) < SETTINGS.same for power in (-2, -1, 0, 1, 2))

    # ---- crossings of polylines

    def _polylines(self) -> list[tuple[_Place, _Place, Array]]:
        """Places of both manifolds at the crossings of their chords, in the order of W^u, and the point."""
        sides = self.unstable.window.sides
        away, home = (_chords(grown, sides) for grown in (self.unstable, self.stable))
        met = meetings((away.start, away.step), (home.start, home.step))
        points = (away.start[met.one] + met.along[:, None] * away.step[met.one]) * sides
        rows = [
            (away.place(i, along), home.place(j, across), point)
            for i, j, along, across, point in zip(met.one, met.other, met.along, met.across, points, strict=True)
        ]
        return sorted(rows, key=lambda row: (row[0].generation, row[0].side, abs(row[0].s)))

    # ---- Newton's method

    def _refined(self, states: Array, s: Array, expected: tuple[int, Array]) -> Crossing | str:
        """The orbit near some states, or why there is none; `expected` is the place of one of them on the polylines."""
        from scipy.linalg import solve_banded

        sides, size = self.unstable.window.sides, np.inf
        ends = Ends(self.unstable.arc, self.stable.arc, sides[0])
        if not np.isfinite(states).all():
            return "a flight between their impacts has no end"
        for _ in range(SETTINGS.rounds):
            if not (states[:, 1] > 0).all():
                return "Newton's method leaves v > 0"
            miss, slopes = ends.missed(states)
            if not np.isfinite(miss).all() or not np.isfinite(slopes).all():
                return "a flight next to them grazes"
            try:
                step = solve_banded((2, 1), ends.matrix(slopes, s), miss.ravel())
            except np.linalg.LinAlgError:
                return "they touch without crossing, or the orbit grazes"
            s = s - step[[0, -1]]
            states[1:-1] -= step[1:-1].reshape(-1, 2)
            states[0], states[-1] = self.unstable.arc.points(s[:1])[0], self.stable.arc.points(s[1:])[0]
            last, size = size, float(np.abs(step[1:-1].reshape(-1, 2) / sides).max(initial=0.0))
            if size < SETTINGS.arrived or (size >= last / 2 and size < 1e-11):
                break
        if not (states[:, 1] > 0).all():
            return "Newton's method leaves v > 0"
        miss, slopes = ends.missed(states)
        residual = float(np.abs(miss / sides).max())
        if not residual < SETTINGS.residual:
            return "Newton's method does not end"
        if not apart(states[expected[0]] - expected[1], sides) < SETTINGS.moved * self.unstable.window.resolution:
            return "Newton's method leaves them for another one"
        if not (np.abs(s) > 1e-12 * np.array([self.unstable.arc.size, self.stable.arc.size])).all():
            return "Newton's method ends in the saddle"
        states[:, 0] = np.mod(states[:, 0], sides[0])
        angles = ends.angles(slopes, s)
        index = int(np.argmax(self._distances(states)))
        error = size + max(self.unstable.error, self.stable.error)
        tau, v = states[index].tolist()
        return Crossing(
            tau,
            v,
            float(angles[index]),
            angles,
            states,
            index,
            residual,
            error,
            (float(s[0]), float(s[1])),
            self.unstable.saddle,
            self.stable.saddle,
        )

    def _guess(self, away: _Place, home: _Place) -> tuple[Array, Array, int]:
        """States near the orbit, s_u and s_s of its ends, and the index of the state on W^u that `away` began with.

        Images of the place on W^u up to the crossing, then those of the place on W^s, from the crossing on; on both
        arcs turns more, until the ends are next to the saddles.
        """
        osc = self.unstable.saddle.oscillator
        before_it, s_u = self._turns(self.unstable.arc, away.s)
        forward = [*before_it, self.unstable.arc.points(np.array([away.s]))]
        for _ in range(away.generation):
            forward.append(model_step(osc, forward[-1]))
        after_it, s_s = self._turns(self.stable.arc, home.s)
        # at generation 0 the crossing itself lies on the arc of W^s
        backward = [self.stable.arc.points(np.array([home.s]))] if home.generation else []
        for _ in range(home.generation - 1):
            backward.append(before(osc, backward[-1]))
        return np.vstack([*forward, *backward[::-1], *after_it]), np.array([s_u, s_s]), len(before_it)

    def _turns(self, arc: LocalArc, s: float) -> tuple[list[Array], float]:
        """States of whole turns between the end next to a saddle and K(s), in the order of time, and s of that end."""
        count = int(np.ceil(np.log(abs(s) / SETTINGS.ends) / np.log(arc.ratio))) if abs(s) > SETTINGS.ends else 0
        count = min(count, SETTINGS.turns)
        inwards = arc.multiplier if arc.stable else 1 / arc.multiplier
        added: list[Array] = []
        for turn in range(count):
            # of W^s the turn begins at K(s mu^turn) and its first state is there already; of W^u it ends before K(s)
            states = [arc.points(np.array([s * inwards**turn if arc.stable else s * inwards ** (count - turn)]))]
            for _ in range(int(arc.saddle.n)):
                states.append(model_step(arc.saddle.oscillator, states[-1]))
            added += states[1:-1] if arc.stable else states[:-1]
            if arc.stable:
                added.append(arc.points(np.array([s * inwards ** (turn + 1)])))
        return added, s * inwards**count

    def _distances(self, states: Array) -> Array:
        """Of states from the impacts of both saddles."""
        both = [
            np.stack([np.asarray(each.tau, dtype=float), np.asarray(each.v, dtype=float)], axis=1)
            for each in (self.unstable.saddle, self.stable.saddle)
        ]
        return np.asarray(apart(states[:, None] - np.vstack(both), self.unstable.window.sides).min(axis=1))


def _unit(vector: Array) -> Array:
    return np.asarray(vector / np.linalg.norm(vector))


@dataclass(frozen=True)
class _Chords:
    """Chords of a manifold in sides of the window, with the pieces that they are of."""

    start: Array
    step: Array
    s: Array
    owner: Array
    pieces: tuple[tuple[int, Piece], ...]

    def place(self, index: int, share: float) -> _Place:
        """A point of a chord."""
        side, piece = self.pieces[int(self.owner[index])]
        low, high = self.s[index]
        return _Place(float(low + share * (high - low)), piece.generation, side)


def _chords(grown: Manifold, sides: Array) -> _Chords:
    start, step, s, owner = [], [], [], []
    for number, (_, piece) in enumerate(grown.grown):
        points = piece.points / sides
        chord = np.diff(points, axis=0)
        drawn = (piece.points[:-1, 1] <= grown.window.y[1]) & (np.hypot(*chord.T) < SETTINGS.longest)
        start.append(points[:-1][drawn])
        step.append(chord[drawn])
        s.append(np.stack([piece.s[:-1], piece.s[1:]], axis=1)[drawn])
        owner.append(np.full(int(drawn.sum()), number))
    return _Chords(np.concatenate(start), np.concatenate(step), np.concatenate(s), np.concatenate(owner), grown.grown)
