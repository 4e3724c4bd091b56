"""W^s and W^u of a periodic saddle in the plane (tau, v) of states after impacts, cut at discontinuities of the map."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array, as_float, constant
from singimpact.branches.cylinder import Nearby, apart, distances
from singimpact.branches.orbits import Notes, PeriodicOrbit
from singimpact.branches.saddle_arcs import LocalArc, checked_saddle, directions, local_arc
from singimpact.branches.solutions import orbit_period
from singimpact.dynamics import LEFT, LOST, NATURAL, TORN, Carried, Piece, before, model_step
from singimpact.flights.results import counted
from singimpact.inputs import checked_keywords, require
from singimpact.oscillator.wall_acceleration import acceleration, largest_push
from singimpact.result import Result
from singimpact.surface.curve import RESOLUTION, STATES, Curve, Mark, Window


@dataclass(frozen=True)
class ManifoldSettings:
    """Limits of the growth of a manifold."""

    # the highest v computed: in largest velocities of the orbit, and in largest a_c times a period
    highest: tuple[float, float] = (3.0, 0.25)
    # states are followed up to this part of the highest v: from there they may come back
    reach: float = 2.0
    # a flight that is longer, in periods times k/n or 1, is given up: undamped ones may go on for a thousand
    horizon: float = 20.0
    # points of one piece, and of all
    piece: int = 100_000
    points: int = 1_000_000
    # images of the fundamental piece, of every impact of the orbit
    turns: int = 2000
    # a piece within this distance of the curve so far, in resolutions, is left out
    distinct: float = 0.25
    # but a whole turn of a side is followed on, for so many turns, while it is longer than this
    lingering: int = 400
    least: float = 0.01
    # a cut is a graze if the image of its slower side is its other side, within so many resolutions
    touching: float = 8.0


SETTINGS = ManifoldSettings()


@dataclass(frozen=True)
class Cut(Result):
    """A cut of a manifold at a discontinuity of the map.

    Parameters
    ----------
    kind : "graze", when the slower side, which ends at v = 0, goes on to the other side: of two flights next to each
        other one meets the wall and the other does not; "unresolved" otherwise. tau, v : the state at the cut.
    sides : states that its two sides go to, by the map for W^u and by its inverse for W^s, shape (2, 2).
    impacts : images that lie between the saddle and the cut.
    """

    kind: str
    tau: float
    v: float
    sides: Array
    impacts: int

    def __repr__(self) -> str:
        ends = " and ".join(f"({tau:.6g}, {v:.6g})" for tau, v in self.sides)
        return f"<{self.kind} at ({self.tau:.9g}, {self.v:.9g}): its sides go to {ends}>"


@dataclass(frozen=True, eq=False)
class Manifold(Result):
    """W^s or W^u of a saddle.

    Parameters
    ----------
    saddle : the orbit. stable : whether it is W^s. multiplier : the one that belongs to it.
    directions : unit tangents at the impacts of the orbit, shape (n, 2).
    pieces : curves in (tau, v), tau within a period (a vertex beyond its end is the next one of the piece); the marks
        are "saddle", "cut" (at a discontinuity of the map), "leaves" (v passes the limit) and "end".
    cuts : in the order in which they were met.
    window : what is looked at, with the resolution. length : of all pieces, in sides of the window.
    spacing : the longest chord, in the same unit. error : of the arc at the saddle, in periods and largest velocities.
    flights : spent. notes : why the growth ended, and what is not in the result.
    """

    saddle: PeriodicOrbit
    stable: bool
    multiplier: float
    directions: Array
    pieces: tuple[Curve, ...]
    cuts: tuple[Cut, ...]
    window: Window
    length: float
    spacing: float
    error: float
    flights: int
    notes: tuple[str, ...]
    arc: LocalArc = field(repr=False)
    grown: tuple[tuple[int, Piece], ...] = field(repr=False)

    @property
    def name(self) -> str:
        """The name in pictures."""
        return "W^s" if self.stable else "W^u"

    def distance(self, points: Any) -> Array:
        """Of states (tau, v), shape (m, 2), from the nearest piece: in periods, and in highest velocities, shape (m,).

        Examples
        --------
        >>> from singimpact.impact_oscillator import linear
        >>> (saddle,) = linear("2.8", 0, "0.8").periodic(1, 1)
        >>> bool(manifold(saddle, length=1).distance([(saddle.tau[0], saddle.v[0])])[0] < 1e-15)
        True
        """
        lines = [piece.points for piece in self.pieces]
        return distances(np.asarray(points, dtype=float), lines, self.window.sides, self.window.resolution)

    def as_dict(self) -> dict[str, Any]:
        """Of each vertex the piece, tau, v and mark (empty where there is none); length, flights and notes."""
        points = np.concatenate([piece.points for piece in self.pieces]) if self.pieces else np.empty((0, 2))
        return {
            "piece": np.repeat(np.arange(1, len(self.pieces) + 1), [len(piece) for piece in self.pieces]),
            "tau": points[:, 0],
            "v": points[:, 1],
            "mark": np.array([mark for piece in self.pieces for mark in _names(piece)], dtype=object),
            "stable": self.stable,
            "multiplier": self.multiplier,
            "length": self.length,
            "flights": self.flights,
            "cuts": [cut.as_dict() for cut in self.cuts],
            "notes": list(self.notes),
        }

    def __repr__(self) -> str:
        n, k = int(self.saddle.n), self.saddle.k
        grazes = sum(cut.kind == "graze" for cut in self.cuts)
        others = f", {len(self.cuts) - grazes} unresolved cuts" if grazes < len(self.cuts) else ""
        points = sum(len(piece) for piece in self.pieces)
        lines = [
            f"<{self.name} of a ({n}, {k}) saddle, multiplier {self.multiplier:.6g}: {len(self.pieces)} pieces, "
            f"{points} points, cut at {grazes} grazes{others}",
            f"  length {self.length:.4g} in sides of {self.window.x[1]:.6g} x {self.window.y[1]:.6g}, chords to "
            f"{self.spacing:.2g}, arc at the saddle to {self.error:.1g}, {self.flights} flights",
        ]
        return "\n".join([*lines, *(f"  {note}" for note in self.notes)]) + ">"


def _names(piece: Curve) -> list[str]:
    names = [""] * len(piece)
    for mark in piece.marks:
        names[mark.index] = mark.name
    return names


@checked_keywords
def manifold(
    saddle: PeriodicOrbit, stable: bool = True, *, v: Any = None, length: Any = 50, resolution: Any = RESOLUTION.usual
) -> Manifold:
    """W^s (or W^u) of a periodic saddle, grown from its impacts, in the plane of states after impacts.

    Parameters
    ----------
    saddle : an unstable orbit of `osc.periodic(n, k)` with impacts.
    stable : True for W^s, which is grown with the inverse of the impact map; False for W^u, grown with the map.
    v : the highest velocity looked at; without it three times the largest one of the orbit, or what the largest a_c
        gives in a quarter of a period where that is more.
    length : the growth ends with the generation in which the length passes this; tau in periods, v in the highest v.
    resolution : of the curve, a share of the window from 1e-6 to 1/16.

    Returns
    -------
    Manifold : `.pieces`, `.cuts`, `.notes`; `si.plot` draws it, alone or over basins.

    Raises
    ------
    InputError : an orbit that is no saddle, is virtual, or has no impacts.

    Notes
    -----
    Vertices are images of an arc at the saddle whose error is measured (`error`, about 1e-13); errors across the curve
    shrink on the way, errors along it only move its vertices. The impact map is discontinuous where a flight
    grazes; the flow is not. W^u ends there at v = 0 and begins again on P, at the image of that end; W^s likewise,
    backwards.

    Examples
    --------
    >>> from singimpact.impact_oscillator import linear
    >>> (saddle,) = linear("2.8", 0, "0.8").periodic(1, 1)
    >>> found = manifold(saddle, stable=False, length=4)
    >>> found.name, bool(found.length > 4), {cut.kind for cut in found.cuts} <= {"graze"}
    ('W^u', True, True)
    """
    saddle = checked_saddle(saddle)
    require(isinstance(stable, bool | np.bool_), "stable", stable, "True for W^s, False for W^u")
    period = orbit_period(saddle)
    fastest = float(np.max(np.asarray(saddle.v, dtype=float)))
    highest = _highest(saddle, fastest) if v is None else as_float(constant("v", v))
    require(highest > fastest, "v", v, f"a velocity above the largest of the orbit, {fastest:.6g}")
    longest = as_float(constant("length", length))
    require(longest > 0, "length", length, "a number > 0, in sides of the window")
    window = Window.read((0, period), (0, highest), resolution, STATES)
    with counted() as count:
        grown = _Grown(saddle, bool(stable), window, longest)
        grown.grow()
    pieces = tuple(grown.curves())
    chords = [np.hypot(*(np.diff(piece.points, axis=0) / window.sides).T) for piece in pieces]
    arc = grown.arc
    return Manifold(
        saddle,
        bool(stable),
        arc.multiplier,
        directions(arc),
        pieces,
        tuple(grown.cuts),
        window,
        float(sum(lengths.sum() for lengths in chords)),
        float(max(lengths.max() for lengths in chords)),
        arc.error,
        count.flights,
        tuple(grown.notes.sentences),
        arc,
        tuple(grown.done),
    )


def _highest(saddle: PeriodicOrbit, fastest: float) -> float:
    push = largest_push(saddle.oscillator)
    return max(SETTINGS.highest[0] * fastest, SETTINGS.highest[1] * push * orbit_period(saddle))


class _Grown:
    """A manifold while it is grown: pieces of both sides of the saddle, generation by generation."""

    def __init__(self, saddle: PeriodicOrbit, stable: bool, window: Window, longest: float) -> None:
        self.saddle, self.stable, self.window, self.longest = saddle, stable, window, longest
        self.arc, self.notes = local_arc(saddle, stable), Notes()
        self.horizon = SETTINGS.horizon * max(1.0, saddle.k / saddle.n) * window.x[1]
        self.recurs = int(saddle.n) * self.arc.turns
        self.done: list[tuple[int, Piece]] = []  # the side of the arc they come from, and the piece
        self.cuts: list[Cut] = []
        self._lingered: dict[tuple[int, int], int] = {}  # turns of a side that added little
        self.carried = Carried(
            window,
            self.arc.points,
            self._step,
            lambda points: points[:, 1] <= 1.2 * window.y[1],
            lambda points: points[:, 1] <= SETTINGS.reach * window.y[1],
            SETTINGS.piece,
            located=True,
        )
        self._nearby = Nearby(window.sides, SETTINGS.distinct * window.resolution)

    def _step(self, points: Array, generation: int) -> Array:
        """The next generation; the periods of the orbit are taken off, so that times stay small."""
        points = (before if self.stable else model_step)(self.saddle.oscillator, points, self.horizon)
        if (generation + 1) % int(self.saddle.n) == 0:
            span = self.saddle.k * self.window.sides[0]
            points = points + np.array([span if self.stable else -span, 0.0])
        return points

    def grow(self) -> None:
        """All generations, until nothing is added or the length is reached."""
        pieces = [(number, self._first(self._inner(number), side)) for number, side in enumerate(self.arc.sides)]
        total, points = 0.0, 0
        for flown in range(SETTINGS.turns * int(self.saddle.n)):
            self.done += pieces
            total += sum(self._length(piece) for _, piece in pieces)
            points += sum(len(piece.s) for _, piece in pieces)
            if total > self.longest:
                reason = f"where its length passes {self.longest:g}: it goes on (length=)"
                self.notes.add(f"ends after {flown} impacts, {reason}")
                return
            if points > SETTINGS.points:
                self.notes.add(f"ends after {flown} impacts, where {SETTINGS.points} points are spent")
                return
            self._nearby.add([piece.points for _, piece in pieces])
            pieces = [image for number, piece in pieces for image in self._images(number, piece)]
            if not pieces:
                self.notes.add("ends where further images lie within a quarter of the resolution of what is there")
                return
        self.notes.add(f"ends after {self.done[-1][1].generation} impacts, the most that are flown")

    def _images(self, number: int, piece: Piece) -> list[tuple[int, Piece]]:
        images = self.carried.images(piece)
        if any(image.coarse for image in images):
            self.notes.add(
                f"a piece after {piece.generation + 1} impacts has over {SETTINGS.piece} points: it is not resolved"
            )
        self._note_ends(piece, images)
        growing = []
        for image in images:
            if self._at_saddle(image.points) or self._adds(image.points) or self._lingers(number, image):
                growing.append((number, image))
            elif self._rests(image.points):
                self.notes.add("states that come to rest in complete chatter lift off together: the curve ends there")
        return growing

    def _at_saddle(self, points: Array) -> bool:
        """Whether a piece has not come away from the orbit yet: the curve there is shorter than the resolution."""
        places = np.stack([np.asarray(part, dtype=float) for part in (self.saddle.tau, self.saddle.v)], axis=1)
        away = apart(points[:, None] - places, self.window.sides)
        return bool((away.min(axis=1) < self.window.resolution).all())

    def _adds(self, points: Array) -> bool:
        """Whether a piece is away from the curve so far; so are pieces above the window, which may return to it."""
        seen = points[points[:, 1] <= self.window.y[1]]
        return not len(seen) or not self._nearby.all_on(seen)

    def _lingers(self, number: int, piece: Piece) -> bool:
        """Whether a whole piece adds little, next to a weak saddle or a weak attractor, but may add more in time."""
        whole = piece.s[-1] == self.arc.sides[number] and piece.s[0] == self._inner(number)
        step = np.hypot(*((piece.points[-1] - piece.points[0]) / self.window.sides))
        if not whole or step < SETTINGS.least * self.window.resolution:
            return False
        at = (number, piece.generation % self.recurs)
        self._lingered[at] = self._lingered.get(at, 0) + 1
        if self._lingered[at] > SETTINGS.lingering:
            why = f"turns add less than {SETTINGS.distinct} of the resolution is given up after {SETTINGS.lingering}"
            self.notes.add(f"a side whose {why} of them")
            return False
        return True

    def _first(self, low: float, high: float) -> Piece:
        return self.carried.refined(self.carried.first(low, high))

    def _inner(self, number: int) -> float:
        return float(self.arc.ratio**-self.arc.turns * self.arc.sides[number])

    def _note_ends(self, piece: Piece, images: list[Piece]) -> None:
        for one, other in pairwise(images):
            if one.ends[1] == other.ends[0] == TORN:
                sides = np.stack([one.points[-1], other.points[0]])
                kind = "graze" if self._grazes(sides, image=one.generation) else "unresolved"
                middle = np.array([(one.s[-1] + other.s[0]) / 2])
                tau, v = self.carried.image(middle, piece.generation)[0].tolist()
                sides[:, 0] = np.mod(sides[:, 0], self.window.x[1])
                self.cuts.append(Cut(kind, tau % self.window.x[1], v, sides, piece.generation))
        ends = {end for image in images for end in image.ends}
        if any(cut.kind == "unresolved" for cut in self.cuts):
            self.notes.add(
                "at unresolved cuts the curve is stretched beyond what doubles of s resolve, or graze follows graze"
            )
        if LEFT in ends:
            self.notes.add(f"parts with v > {SETTINGS.reach * self.window.y[1]:.6g} are not followed (v=)")
        if LOST in ends:
            self.notes.add(f"parts with no impact within {self.horizon:.4g} units of time are left out")

    def _grazes(self, sides: Array, image: int) -> bool:
        """Whether the slower side goes on to the other one: the flight that meets the wall there and the one beside it
        are one flight, up to a graze.
        """
        slow, fast = sides[np.argsort(sides[:, 1])]
        away = apart(self._step(slow[None], image)[0] - fast, self.window.sides)
        return bool(away < SETTINGS.touching * self.window.resolution)

    def _rests(self, points: Array) -> bool:
        """Whether a piece is pressed to the wall, slower than the resolution shows."""
        slow = points[:, 1].max() < 10 * self.window.resolution * self.window.y[1]
        return bool(slow and (acceleration(self.saddle.oscillator, points[:, 0]) < 0).all())

    def _length(self, piece: Piece) -> float:
        points = piece.points[piece.points[:, 1] <= self.window.y[1]]
        return float(np.hypot(*(np.diff(points, axis=0) / self.window.sides).T).sum())

    # ---- results

    def curves(self) -> Iterator[Curve]:
        """Pieces that follow one another, from the saddle outwards, cut where they leave the window or a period."""
        name = "W^s" if self.stable else "W^u"
        for chain in self._chains():
            points = np.vstack([chain[0].points, *(piece.points[1:] for piece in chain[1:])])
            marks = [Mark(0, "saddle" if chain[0].s[0] == 0 else _ended(chain[0].ends[0]))]
            marks.append(Mark(len(points) - 1, _ended(chain[-1].ends[1])))
            for part in _windowed(points, marks, self.window):
                yield Curve(name, part[0], STATES, tuple(part[1]))

    def _chains(self) -> list[list[Piece]]:
        """Pieces joined where the image of one end of the fundamental piece is the other end."""
        chains: list[list[Piece]] = []
        open_: dict[tuple[int, int], list[Piece]] = {}  # by side and generation of the piece that goes on
        for number in range(len(self.arc.sides)):
            piece = self._first(0.0, self._inner(number))
            for generation in range(self.recurs):
                chain = [self.carried.refined(Piece(piece.s, self.carried.image(piece.s, generation), generation))]
                chains.append(chain)
                open_[number, generation] = chain
        for number, piece in self.done:
            side = self.arc.sides[number]
            joined = open_.pop((number, piece.generation), None) if piece.s[0] == self._inner(number) else None
            if joined is None:
                joined = []
                chains.append(joined)
            joined.append(piece)
            if piece.s[-1] == side:
                open_[number, piece.generation + self.recurs] = joined
        return chains


def _ended(kind: str) -> str:
    return {NATURAL: "end", TORN: "cut", LEFT: "leaves", LOST: "end"}[kind]


def _windowed(points: Array, marks: list[Mark], window: Window) -> Iterator[tuple[Array, list[Mark]]]:
    """Stretches of a curve inside the window, tau within a period, each with the next vertex beyond its ends."""
    period, count = window.x[1], len(points)
    turns, inside = np.floor(points[:, 0] / period), points[:, 1] <= window.y[1]
    breaks = np.flatnonzero((turns[1:] != turns[:-1]) | (inside[1:] != inside[:-1])) + 1
    for stretch in np.split(np.arange(count), breaks):
        begin, end = max(int(stretch[0]) - 1, 0), min(int(stretch[-1]) + 1, count - 1)
        if not inside[stretch[0]] or begin == end:
            continue
        own = {mark.index: mark.name for mark in marks}
        own |= {i: "leaves" for i in (begin, end) if not inside[i]}
        shift = np.array([turns[stretch[0]] * period, 0.0])
        yield points[begin : end + 1] - shift, [Mark(i - begin, own[i]) for i in sorted(own) if begin <= i <= end]
