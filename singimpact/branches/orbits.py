"""`PeriodicOrbit`: with impacts, with complete chatter and rest, or without impact."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from singimpact.algebra.numbers import as_float
from singimpact.handed_on import Study
from singimpact.inputs import InputError
from singimpact.oscillator.model import Oscillator
from singimpact.result import Result, Results, plain
from singimpact.status import Status

if TYPE_CHECKING:
    from singimpact.branches.krawczyk import EnclosedOrbit

Sentences = tuple[str, ...]
EQUAL = 1e-9  # halves of an orbit that differ by less, of its period and of its largest velocity, are equal


class OfImpacts(Result):
    """A result on orbits of n impacts; `wall` is that of each, between two walls."""

    n: Any
    wall: Any

    @property
    def word(self) -> tuple[int, ...]:
        """The walls of the impacts, 0 or 1."""
        return (0,) * int(self.n) if self.wall is None else self.walls

    @property
    def walls(self) -> tuple[int, ...]:
        """The walls of the impacts between two walls; empty of a model with one."""
        return () if self.wall is None else tuple(self.wall.tolist())

    @property
    def impacts(self) -> Any:
        """The number of impacts, or between two walls their word, as `osc.periodic` takes them."""
        return self.n if self.wall is None else "".join("lu"[wall] for wall in self.word)


@dataclass(frozen=True, eq=False)
class PeriodicOrbit(OfImpacts):
    """An orbit that closes after k periods of the forcing, or a limit cycle of a model without one.

    Parameters
    ----------
    tau, v : states just after its n impacts, the first phase in [0, period). Of chatter the lift-off, with v = 0; of an
        orbit without impacts one time, with x' there.
    multipliers : eigenvalues of the derivative of its return map, the larger first: stable where both are below 1.
    miss : by how much it misses closing. status : `hit`; `unresolved` when the digits asked for were not reached.
    oscillator : the model. n, k : impacts (inf for chatter) in k periods.
    kind : "impacts"; "chatter", which completes, rests and lifts off; "free", without impact.
    visible : whether no flight is below the wall and every v >= 0; a virtual orbit solves the equations alone.
    x : of an orbit without impacts, x at the time `tau`.
    span : of a limit cycle its period; None where the forcing has one.
    wall : int8, of each impact, of a model with two walls; else None.

    Notes
    -----
    A graze has v = 0 and an infinite multiplier.
    """

    tau: Any
    v: Any
    multipliers: Any
    miss: Any
    status: Any = Status.hit
    oscillator: Any = None
    n: float = 1
    k: int = 1
    kind: str = "impacts"
    visible: bool = True
    x: Any = None
    span: Any = None
    wall: Any = None

    branch, manifold, homoclinic_points = Study(), Study(), Study()  # functions of `singimpact`, documented there

    def as_dict(self) -> dict[str, Any]:
        """n (none for chatter), k, kind, stability, visibility, states and multipliers."""
        return {
            "n": None if self.kind == "chatter" else int(self.n),
            "k": self.k,
            "period": self.period,
            "kind": self.kind,
            "stable": self.stable,
            "visible": bool(self.visible),
            "tau": np.array(self.tau),
            "v": np.array(self.v),
            "multipliers": np.array(self.multipliers),
        } | ({} if self.wall is None else {"wall": plain(self.wall, "wall"), "symmetric": self.symmetric})

    def arrays(self) -> dict[str, tuple[tuple[str, ...], Any]]:
        """States by impact, and both multipliers."""
        values = self.as_dict()
        states = {name: (("impact",), values[name]) for name in ("tau", "v", "wall") if name in values}
        return states | {"multipliers": (("multiplier",), values["multipliers"])}

    @property
    def period(self) -> float:
        """The time after which the orbit closes: k periods of the forcing, or the period of a limit cycle."""
        return float(self.k * as_float(self.oscillator.period)) if self.span is None else float(self.span)

    @property
    def stable(self) -> bool:
        """Whether both multipliers are below 1 in size."""
        return bool(np.all([abs(complex(each)) < 1 for each in self.multipliers]))

    @property
    def symmetric(self) -> bool:
        """Whether half a period later the orbit is its mirror image at the other wall.

        Examples
        --------
        >>> from singimpact.impact_oscillator import linear
        >>> pair = linear("2.8", "-0.5", "0.8").replace(upper="0.5")
        >>> [orbit.symmetric for orbit in pair.periodic("lu", 1)]
        [True, True]
        """
        if self.wall is None or len(self.wall) % 2 or self.k % 2 == 0:
            return False
        half = len(self.wall) // 2
        tau, v = (np.asarray(row, dtype=float) for row in (self.tau, self.v))
        late = (tau[half:] - tau[:half]) / self.period - 0.5
        fast = max(float(np.abs(v).max()), 1e-300)
        mirrored = bool((self.wall[half:] != self.wall[:half]).all())
        return mirrored and bool(np.abs(late).max() < EQUAL and np.abs(v[half:] - v[:half]).max() < EQUAL * fast)

    def certified(self, digits: int = 30) -> EnclosedOrbit:
        """The orbit, proved to exist and to be the only one in a box, with its multipliers.

        Raises
        ------
        InputError : an orbit of chatter or without impact, or one that is not proved, with the reason.

        Examples
        --------
        >>> from singimpact.branches.periodic import periodic
        >>> from singimpact.oscillator.model import Oscillator
        >>> (orbit,) = periodic(Oscillator("x", "cos(4.3*t)", 0, "0.5"), 1, 2)
        >>> print(orbit.certified(20).v[0], orbit.certified(20).stable)
        0.28319534613206575959 True
        """
        from singimpact.branches.krawczyk import enclosed_orbit

        if self.span is not None:
            raise InputError(f"{self!r} is not certified: proofs are of orbits with the period of a forcing")
        if self.kind != "impacts":
            raise InputError(f"{self!r} is not accepted: an orbit with impacts, none of which rests, can be certified")
        enclosure = enclosed_orbit(
            self.oscillator, self.tau, self.v, self.k, digits, () if self.wall is None else self.word
        )
        if isinstance(enclosure, str):
            raise InputError(f"{self!r} is not certified: {enclosure}")
        return enclosure

    def __repr__(self) -> str:
        count = f"{self.n:.0f} impact{'s' * (self.n > 1)}"
        cycle = None if self.span is None else f"limit cycle of {count}, period {self.span:.9g}"
        words = cycle or {"chatter": f"(inf, {self.k}) orbit: chatter and rest", "free": "orbit without impact"}.get(
            self.kind, f"({self.n:.0f}, {self.k}) orbit"
        )
        if self.wall is not None:
            words = f"({self.impacts}, {self.k}) orbit{', symmetric' if self.symmetric else ''}"
        kind = ("stable" if self.stable else "unstable") if self.visible else "virtual"
        states = ", ".join(f"({float(t):.6g}, {float(v):.6g})" for t, v in zip(self.tau[:4], self.v[:4], strict=True))
        more = ", ..." if len(self.tau) > 4 else ""
        return f"<{words}, {kind}: (tau, v) = {states}{more}>"


def chatter_orbit(osc: Oscillator, lift_off: float, k: int, miss: float) -> PeriodicOrbit:
    """The orbit that chatters, rests and lifts off again k periods later, with that miss."""
    phase = np.mod(lift_off, as_float(osc.period))
    return PeriodicOrbit(
        np.array([phase]), np.zeros(1), np.zeros(2), miss, np.int8(Status.hit), osc, np.inf, k, "chatter"
    )


def same_states(one: PeriodicOrbit, other: PeriodicOrbit, within: float) -> bool:
    """Whether two orbits of as many impacts have the same states, from whichever they begin.

    Parameters
    ----------
    within : how far apart they may be, of the period and of the largest velocity.

    Examples
    --------
    >>> from singimpact.impact_oscillator import linear
    >>> first, second = (PeriodicOrbit(np.array(tau), np.array(v), None, 0.0, oscillator=linear(1, 0, 1))
    ...                  for tau, v in (([0.1, 2.0], [1.0, 0.5]), ([2.0, 0.1], [0.5, 1.0])))
    >>> same_states(first, second, 1e-9)
    True
    """
    cycles = one.span is not None
    period = one.period if cycles else as_float(one.oscillator.period)
    tau, v, times, speeds = (np.asarray(row, dtype=float) for row in (one.tau, one.v, other.tau, other.v))
    fast = max(float(np.abs(v).max()), float(np.abs(speeds).max()), 1e-12)  # at a graze v is rounding
    for shift in range(len(tau)):
        gaps = np.roll(tau, shift) - times
        gaps = (gaps - gaps[0] if cycles else gaps) / period
        gaps -= np.rint(gaps)
        if np.abs(gaps).max() < within and np.abs(np.roll(v, shift) - speeds).max() < within * fast:
            return True
    return False


class PeriodicOrbits(Results, list[PeriodicOrbit]):
    """Periodic orbits, and whether the list is shown to be complete.

    Parameters
    ----------
    doubts : why there may be others, or a computation that finds out when it is asked. notes : what else to know.
    """

    called = "orbits"

    def __init__(
        self,
        orbits: Iterable[PeriodicOrbit] = (),
        doubts: Sentences | Callable[[], Sentences] = (),
        notes: Sentences = (),
    ) -> None:
        super().__init__(orbits)
        self._doubts, self._notes = doubts, notes

    if not TYPE_CHECKING:

        def __getitem__(self, index: Any) -> Any:
            """An orbit; where there is none, an IndexError that says how many there are and why."""
            try:
                return super().__getitem__(index)
            except IndexError:
                doubts = () if callable(self._doubts) else self._doubts  # a proof is not run for a sentence
                notes = " ".join((*self._notes, *doubts)) or "others, of other n and k, may attract: see si.basins"
                raise IndexError(f"there is no orbit {index} of these {len(self)}: {notes}") from None

    @property
    def doubts(self) -> Sentences:
        """Why there may be others; empty where it is shown that there are none. The proof runs when this is read."""
        if callable(self._doubts):
            self._doubts = self._doubts()
        return self._doubts

    @property
    def complete(self) -> bool:
        """Whether it is shown that there are no others."""
        return not self.doubts

    @property
    def notes(self) -> Sentences:
        """Notes on how the orbits were found, and why there may be others."""
        return (*self._notes, *self.doubts)


@dataclass
class Notes:
    """Notes on a result, each sentence once."""

    sentences: dict[str, None] = field(default_factory=dict)

    def add(self, sentence: str) -> None:
        """Add a sentence."""
        self.sentences[sentence] = None
