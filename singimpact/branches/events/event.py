"""Events of a branch of periodic orbits."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from singimpact.branches.events.kind import EventKind
from singimpact.branches.events.table import KINDS, kind_of
from singimpact.branches.events.unit_multipliers import NormalForm, normal_form
from singimpact.inputs import InputError, refuse
from singimpact.result import Result

if TYPE_CHECKING:
    from singimpact.branches.enclosed_event import EnclosedEvent
    from singimpact.branches.orbits import PeriodicOrbit

NEAR = 1e-6  # how far, relative to 1 or the parameter, an event in doubles is from the one that is proved


@dataclass(frozen=True, eq=False)
class Event(Result):
    """An event at a point of a branch.

    Parameters
    ----------
    kind : "fold" (two orbits meet), "period-doubling" (multiplier -1), "torus" (two multipliers on the unit circle),
        "graze" (an impact of the orbit has no velocity), "hidden impact" (a flight touches the wall on its way);
        "pitchfork" (two branches of orbits of so many impacts and periods cross, one of which turns back there: such as
        doubled orbits at the doubling that they begin at), "transcritical" (they cross and neither turns back),
        "branch point" (they cross, and the other one was not reached).
    parameter : the value of the parameter. orbit : the orbit. index : it lies after this point of the branch; the next
        point is the event itself where that is no graze or hidden impact.
    impact : which impact grazes, or after which one the flight does, from 0: a column of `tau` and `v` of the branch
        (an orbit itself begins at its least phase). time : of a hidden impact after its launch.
    other : at a pitchfork or transcritical point an orbit of the branch that is crossed.
    """

    kind: str
    parameter: float
    orbit: PeriodicOrbit
    index: int
    impact: int = 0
    time: float = np.nan
    over: str = ""
    other: PeriodicOrbit | None = None

    def as_dict(self) -> dict[str, Any]:
        """Kind, parameter, states and visibility of the orbit, and the point of the branch after which it lies."""
        return {
            "kind": self.kind,
            "parameter": self.parameter,
            "tau": np.array([float(tau) for tau in self.orbit.tau]),
            "v": np.array([float(v) for v in self.orbit.v]),
            "visible": bool(self.orbit.visible),
            "after_point": self.index,
        }

    @property
    def described(self) -> EventKind:
        """The kind of the event, as an object."""
        return kind_of(self.kind)

    @cached_property
    def normal_form(self) -> NormalForm:
        """The first coefficient of the normal form at a doubling or a torus, computed when it is first read.

        Returns
        -------
        NormalForm : `.value`, c of w -> -w + c w^3 at a doubling, at a torus the real part of a of
            z -> z e^(i theta) (1 + a |z|^2), where w and z are lengths in (tau, v) just after the first impact;
            `.error`, an estimate. Both are nan where flights beside the orbit leave the domain of f or g, at other
            events, of orbits without impact and of limit cycles.

        Notes
        -----
        From derivatives of flights, which are exact up to rounding, and two differences of these of the eighth order.
        A strong resonance (1:3, 1:4) has other normal forms.
        Source: Kuznetsov, Elements of Applied Bifurcation Theory, 5.4; the same as `nf` of MatCont. Supported.

        Examples
        --------
        >>> from singimpact.branches.branch import branch
        >>> from singimpact.branches.periodic import periodic
        >>> from singimpact.oscillator.model import Oscillator
        >>> ball = Oscillator("1", "G*cos(t)", 0, "0.5", {"G": "1.4"})
        >>> doubling = branch(periodic(ball, 1, 1)[1], "G", (1.2, 2)).events[-1]
        >>> doubling, round(doubling.normal_form.value, 9)
        (<period-doubling at G = 1.52682370052, supercritical>, 1.760184629)
        """
        return normal_form(self.orbit, self.described.gentle)

    @property
    def criticality(self) -> str:
        """Whether the orbits that leave the branch are stable beside it ("supercritical") or not ("subcritical").

        "degenerate" where the coefficient is not distinguished from 0; empty where there is none, see `normal_form`.
        """
        value, error = self.normal_form
        if not np.isfinite(value):
            return ""
        gentle = "supercritical" if value * self.described.gentle > 0 else "subcritical"
        return gentle if abs(value) > error else "degenerate"

    def others(self) -> list[PeriodicOrbit]:
        """Orbits of the other branches that meet this one here, to be followed by `branch`.

        Returns
        -------
        list : at a doubling the orbit of 2n impacts in 2k periods next to it; at a graze the orbit without that impact;
            at a hidden impact the orbit with an impact there; at a pitchfork of a doubled branch the orbit of half as
            many impacts, at other branch points one of the branch that is crossed. Empty at folds and tori.
        """
        if self.other is not None:
            return [self.other]
        return self.described.others(self.orbit, self.over, self.parameter)

    @property
    def graze_time(self) -> float:
        """When the orbit touches the wall, of a graze or a hidden impact: `at` of `singimpact.theory.grazing_map`."""
        if not self.described.touches:
            raise refuse("event", self.kind, " or ".join(f"a {kind.name}" for kind in KINDS if kind.touches))
        return self.described.graze_time(self.orbit)

    def certified(self, digits: int = 20) -> EnclosedEvent:
        """The event, proved to exist and to be the only one in a box: its parameter and its states with radii.

        Parameters
        ----------
        digits : after the point, of the parameter, tau and v.

        Raises
        ------
        InputError : an event of virtual orbits, or one that is not proved, with the reason.

        Notes
        -----
        A graze or hidden impact is a zero of smooth equations, alone in a box by Krawczyk's operator. At a fold,
        doubling or torus all orbits in a box lie on one curve, along which the test of the event varies at a rate of
        one sign: it vanishes once. The box is `unique_within`. An event at which the rate vanishes, such as two
        doublings that meet, is refused. It takes 0.02 to 2 s.

        Examples
        --------
        >>> from singimpact.branches.branch import branch
        >>> from singimpact.branches.periodic import periodic
        >>> from singimpact.oscillator.model import Oscillator
        >>> model = Oscillator("x + 0.1*xdot", "-A*cos(0.8*t)", -1, "0.8", {"A": "0.45"})
        >>> graze = branch(periodic(model, 1, 1)[0], "A", (0.3, 0.5)).events[0]
        >>> print(graze.certified(25).parameter)  # sqrt(0.36**2 + 0.08**2)
        0.3687817782917154924000910
        """
        from singimpact.branches.enclosed_event import enclosed_event
        from singimpact.flights.impact_map import checked_digits

        touches = self.described.touches
        if not self.described.proof:
            *names, last = (kind.name for kind in KINDS if kind.proof)
            raise InputError(
                f"{self!r} is not certified: no proof covers an event of this kind, only a {', '.join(names)} or "
                f"{last}{self._instead()}"
            )
        if not (touches or self.orbit.n):
            raise InputError(f"{self!r} is not accepted: of orbits without impact a graze alone can be certified")
        rests = not touches or (self.orbit.n and self.described.at_impact)
        at = self.orbit if rests else self.others()[0]
        enclosure = enclosed_event(self.kind, at, self.over, self.parameter, checked_digits(digits))
        if isinstance(enclosure, str):
            virtual = "" if self.orbit.visible else "its orbit is virtual: "
            raise InputError(f"{self!r} is not certified: {virtual}{enclosure}")
        if not abs(enclosure.parameter.value - self.parameter) <= NEAR * max(1.0, abs(self.parameter)):
            raise InputError(f"{self!r} is not certified: Newton's method leaves for {enclosure.parameter}")
        return enclosure

    def _instead(self) -> str:
        half = self.other
        if half is None or half.k == self.orbit.k:
            return ""
        name = f"({half.n:.0f}, {half.k})"
        return f"; the period doubling of the {name} orbits here has one: si.branch(event.others()[0], {self.over!r})"

    def __repr__(self) -> str:
        which = f" of impact {self.impact + 1}" if self.described.at_impact and self.orbit.n else ""
        word = f", {self.criticality}" if self.criticality else ""
        return f"<{self.kind}{which} at {self.over} = {self.parameter:.12g}{word}>"
