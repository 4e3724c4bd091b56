"""Border orbits: released at a zero of a_c, back exactly on gamma of such a zero, where complete chatter ends.

On one side of it, in a number of the model, the chatter of the released orbit completes before that zero, on the other
the orbit passes the zero after finitely many impacts.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np

from singimpact.algebra import EPSILON, as_float, compare, halved, text_of
from singimpact.branches.border_digits import in_digits
from singimpact.branches.branch import interval
from singimpact.branches.cascade import Cascade, cascade
from singimpact.branches.orbits import Notes
from singimpact.branches.resting import Released, Releases, Return, clock
from singimpact.dynamics.long_run import rising_zeros
from singimpact.dynamics.threshold import threshold
from singimpact.flights.impact_map import checked_digits
from singimpact.inputs import InputError, checked_keywords, require, whole
from singimpact.oscillator import RESTITUTION, Oscillator, require_rebound, value_of, with_number
from singimpact.result import Result, Results
from singimpact.status import Status
from singimpact.surface.curve import window_ends


@dataclass(frozen=True)
class SearchSettings:
    """Settings of the search for border orbits."""

    # the next piece of a search begins so far from a border orbit, in units of the distance between two values
    away: float = 1e-3
    # border orbits at most: with many periods they accumulate
    most: int = 100
    # a velocity next to gamma differs from it by less, relative; else what was found is no border orbit
    near: float = 1e-8
    # half the width of the difference that gives the slope, in units of the distance between two values
    width: float = 1e-4
    # roundings of phase and velocity where the orbit comes back
    roundings: float = 8.0
    # least number of digits where `digits` is given
    digits: int = 16
    # roundings of the number: of 28 that were compared with 22 digits the worst was off by 2.8
    ulps: float = 4.0


SETTINGS = SearchSettings()


@dataclass(frozen=True, eq=False, repr=False)
class BorderOrbit(Result):
    """An orbit released at rest at a zero of a_c whose impacts accumulate exactly at a later one.

    Parameters
    ----------
    oscillator : the model there; exactly so only where `parameter` is a double that is exact.
    over : the number that is varied.
    parameter : its value; an mpmath number with digits. error : an estimate of its error, or a bound where `certified`.
    certified : a value with a radius in which a border orbit is proved to be; None without digits, and where balls do
        not decide. For analytic models whose restitution is a number.
    release, end : the zeros of a_c at which it begins and ends. period : from one to the other, in periods of the
        forcing: a whole number where both are one zero; nan without a period.
    tau, v : its first state after which a_c presses up to the end. slope : d(v - gamma)/d(parameter) there.
    side : "above" where chatter completes for larger values of the parameter, "below" for smaller ones.
    status : `hit`; `unresolved` where the fate of the orbit changes and v is not seen to be on gamma.
    notes : sentences on what is not known. digits : that were asked for, or None.
    returned : the flights that show it, in doubles.
    """

    oscillator: Oscillator
    over: str
    parameter: Any
    error: Any
    certified: Any
    release: float
    end: float
    period: float
    tau: float
    v: float
    slope: float
    side: str
    status: Any
    notes: tuple[str, ...]
    digits: int | None
    returned: Return

    @cached_property
    def cascade(self) -> Cascade:
        """The edges between numbers of impacts beside it, to `digits` digits; computed when first read."""
        value = None if self.digits is None else self.parameter
        scale = abs(self.v / self.slope) if self.slope else np.nan
        return cascade(self.returned, self.oscillator, (value, self.error, scale), self.digits)

    def as_dict(self) -> dict[str, Any]:
        """The number with its error or enclosure, both ends, the state on gamma, and the side of complete chatter."""
        return {
            "parameter": float(self.parameter) if self.digits is None else self.value_text,
            "error": float(self.error),
            "certified": None if self.certified is None else self.certified.as_dict(),
            "release": self.release,
            "end": self.end,
            "periods": self.period if np.isfinite(self.period) else None,
            "tau": self.tau,
            "v": self.v,
            "chatter_completes": self.side,
            "notes": list(self.notes),
        }

    @property
    def value_text(self) -> str:
        """The value of the parameter with `digits` digits, or as a double."""
        if self.digits is None:
            return f"{float(self.parameter):.16g}"
        return text_of(self.parameter, self.digits)

    def __repr__(self) -> str:
        where = f"{self.over} = {self.value_text} +- {float(self.error):.1e}"
        if self.certified is not None:
            where += " (certified)"
        later = "one period" if self.period == 1 else f"{self.period:.9g} periods"
        later = f"the time {self.end - self.release:.9g}" if self.oscillator.period is None else later
        back = f"released at tau = {self.release:.9g}, back on gamma after {later}"
        if self.status != Status.hit:
            return f"<no border orbit is resolved at {where}: {back}>"
        return f"<border orbit at {where}: {back}; chatter completes {self.side}>"


class BorderOrbits(Results, list[BorderOrbit]):
    """Border orbits in the order of the number that is varied.

    Parameters
    ----------
    complete : whether it is shown that there are no others. notes : how they were found, and what may be missing.
    """

    called = "orbits"

    def __init__(self, orbits: Iterable[BorderOrbit] = (), complete: bool = False, notes: tuple[str, ...] = ()) -> None:
        super().__init__(orbits)
        self.complete, self.notes = complete, notes


@checked_keywords
def border_orbits(
    osc: Oscillator,
    over: str = "clearance",
    between: Any = None,
    *,
    digits: int | None = None,
    periods: int = 1,
    points: int = 200,
) -> BorderOrbits:
    """Where an orbit released at rest at a zero of a_c returns exactly onto gamma of such a zero.

    Parameters
    ----------
    osc : r < 1, with a period, or with a polynomial g: then all later zeros are looked at.
    over : the number that is varied: "clearance", "restitution", a parameter, or another that `with_number` puts in.
    between : its ends; about the model's value without them.
    digits : decimal digits of the number, 16 or more, which is certified where the restitution is a number.
    periods : of the forcing, within which the orbit returns.
    points : values at which orbits are flown before the places between them are refined.

    Returns
    -------
    list of `BorderOrbit`, with `.complete` and `.notes`: two border orbits between neighbouring values are missed.

    Raises
    ------
    InputError : a model without a period or with r = 1; a number that it does not have; ends that are none.

    Notes
    -----
    What the orbit does is continuous in the number but for gamma. So the fate of its chatter changes at border orbits
    alone, and halving finds them; that v is on gamma there is confirmed by `threshold`.

    Examples
    --------
    >>> [found] = border_orbits(Oscillator("x", "cos(2.8*t)", 0, "1/2"), between=("0.6", "0.61"), points=5)
    >>> print(f"{found.parameter:.13f}", found.period, found.side)
    0.6046031976978 1.0 above
    """
    require(isinstance(osc, Oscillator), "osc", osc, "an ImpactOscillator")
    require_rebound(osc, "a border orbit, which ends on gamma,")
    osc = with_number(osc, over)
    releases = Releases(osc, over, whole("periods", periods, 1, 1000))
    returns = osc.period is not None or len(rising_zeros(osc)) > 1
    require(returns, "model", osc, "one with a period, or with a later zero where a_c rises, to which orbits can come")
    low, high = _ends(osc, over, between)
    digits = None if digits is None else max(checked_digits(digits), SETTINGS.digits)
    whole("points", points, 2, 10**6)
    search = _Search(releases, np.linspace(low, high, points).tolist())
    search.scan()
    orbits = search.orbits()
    if digits is not None:
        orbits = [_with_digits(orbit, digits) for orbit in orbits]
    return BorderOrbits(orbits, False, search.what_may_be_missing(points))


def _ends(osc: Oscillator, over: str, between: Any) -> tuple[float, float]:
    low, high = interval(over, None, value_of(osc, over)) if between is None else window_ends(over, between)
    require(over != RESTITUTION or 0 < low < high <= 1, "between", between, "two numbers low < high in (0, 1)")
    if over == RESTITUTION and between is None:
        high = min(high, 1 - 1e-3)
    for value in (low, high):
        if compare(osc.replace(**{over: value}).slope_at_rest(), 1) >= 0:
            raise InputError(f"{over} = {value:.9g} gives r = 1, and chatter completes only for r < 1")
    return low, high


class _Search:
    """Border orbits found so far, and the notes."""

    def __init__(self, releases: Releases, values: list[float]) -> None:
        self.releases, self.values, self.spacing = releases, values, values[1] - values[0]
        self.found: list[Return] = []
        self.notes = Notes()

    def scan(self) -> None:
        """Compare the orbits of neighbouring values."""
        last: tuple[float, tuple[float, ...], list[Released]] | None = None
        for value in self.values:
            model = self.releases.model(value)
            phases = rising_zeros(model)
            if model.period is not None and last is not None and len(phases) == len(last[1]):
                phases = _aligned(phases, last[1], as_float(model.period))
            here = value, phases, [self.releases.orbit(model, phases, index) for index in range(len(phases))]
            if last is not None:
                self._compared(last, here)
            last = here

    def _compared(self, one: Any, other: Any) -> None:
        if len(one[1]) != len(other[1]):
            over = self.releases.over
            self.notes.add(
                f"between {over} = {one[0]:.9g} and {other[0]:.9g} the number of releases changes (a swan): "
                "not searched there"
            )
            return
        # after the last zero of a polynomial there is none to come back to
        for index in range(len(one[1]) - (self.releases.osc.period is None)):
            self._piece(index, one[1], (one[0], one[2][index]), (other[0], other[2][index]))

    def _piece(
        self, index: int, phases: tuple[float, ...], low: tuple[float, Released], high: tuple[float, Released]
    ) -> None:
        pieces = [(low, high)]
        while pieces and len(self.found) < SETTINGS.most:
            one, other = pieces.pop()
            if not (one[1].decided and other[1].decided):
                over = self.releases.over
                self.notes.add(f"between {over} = {one[0]:.9g} and {other[0]:.9g} doubles do not decide the orbit")
                continue
            if one[1].place == other[1].place:
                continue
            pieces += self._changed(index, phases, one, other)
        if pieces:
            self.notes.add(f"only {SETTINGS.most} border orbits are given: there are more")

    def _changed(
        self, index: int, phases: tuple[float, ...], low: tuple[float, Released], high: tuple[float, Released]
    ) -> list[Any]:
        """One change of fate between two values, and the pieces on both sides of it."""
        last = self.releases.periods * len(phases)
        goal = min(end[1].place or last + 1 for end in (low, high))

        def in_time(orbit: Released) -> bool:
            return 0 < orbit.place <= goal

        side = 1 if in_time(high[1]) else -1
        ends = halved(lambda x: in_time(self.releases.flown(x, index, phases)) != (side > 0), low[0], high[0])
        value = ends[side > 0]
        at = self.releases.flown(value, index, phases)
        entry = at.entry(at.place) if at.place else 0
        reach = max(value - self.values[0], self.values[-1] - value)
        near = self.releases.followed(self.releases.model(value), phases)
        self.found.append(Return(self.releases, value, near, index, at.place, entry, side, reach))
        gap = SETTINGS.away * self.spacing
        beside = [(end, self.releases.flown(end, index, phases)) for end in (value - gap, value + gap)]
        return [(a, b) for a, b in ((low, beside[0]), (beside[1], high)) if a[0] < b[0]]

    def orbits(self) -> list[BorderOrbit]:
        """The border orbits, each once."""
        return [_border(each, self.spacing) for each in sorted(self.found, key=lambda each: each.value)]

    def what_may_be_missing(self, points: int) -> tuple[str, ...]:
        """Notes on the list."""
        over, periods = self.releases.over, self.releases.periods
        many = f"{periods} periods" if periods > 1 else "one period"
        later = f"returns that take more than {many} are not looked for: periods= looks further"
        return (
            f"looked for at {points} values of {over}, {self.spacing:.3g} apart: two border orbits between neighbours "
            "may be missed",
            *([] if self.releases.osc.period is None else [later]),
            *self.notes.sentences,
        )


def _aligned(phases: tuple[float, ...], before: tuple[float, ...], period: float) -> tuple[float, ...]:
    """Phases in the order of those before, moved by whole periods: one that leaves the first period goes on.

    Examples
    --------
    >>> _aligned((0.1, 1.5), (1.4, 1.9), 2.0)
    (1.5, 2.1)
    """
    turned = [[*phases[first:], *(phase + period for phase in phases[:first])] for first in range(len(phases))]
    gaps = [np.array(row) - before for row in turned]
    moved = [np.array(row) - period * np.rint(gap[0] / period) for row, gap in zip(turned, gaps, strict=True)]
    return tuple(min(moved, key=lambda row: float(np.abs(row - before).max())).tolist()) if phases else phases


def _border(returned: Return, spacing: float) -> BorderOrbit:
    """A change of fate with its state next to gamma."""
    model = returned.releases.model(returned.value)
    release, end = returned.ends(model)
    notes: list[str] = []
    gap, tau, v, error = _gap(returned, returned.value)
    width = SETTINGS.width * spacing
    near = [_gap(returned, returned.value + shift)[0] for shift in (-width, width)]
    slope = (near[1] - near[0]) / (2 * width)
    resolved = bool(abs(gap) < SETTINGS.near * v and np.isfinite(slope) and slope)
    if not resolved:
        notes.append("the fate of the orbit changes here, and its velocity is not seen to be on gamma in doubles")
    error = error / abs(slope) + SETTINGS.ulps * EPSILON * abs(returned.value) if resolved else np.inf
    return BorderOrbit(
        model,
        returned.releases.over,
        returned.value,
        error,
        None,
        release,
        end,
        float(round((end - release) / clock(model), 12)) if model.period is not None else np.nan,
        tau,
        v,
        float(slope),
        "above" if returned.side > 0 else "below",
        np.int8(Status.hit if resolved else Status.unresolved),
        tuple(notes),
        None,
        returned,
    )


def _gap(returned: Return, value: float) -> tuple[float, float, float, float]:
    """v - gamma where the orbit of a value comes back, tau and v there, and the error of the difference."""
    orbit = returned.flown(value)
    if not 0 < returned.entry <= orbit.times.size:
        return np.nan, np.nan, np.nan, np.nan
    tau, v = float(orbit.times[returned.entry - 1]), float(orbit.speeds[returned.entry - 1])
    if not tau < orbit.zeros[returned.place - 1]:
        return np.nan, tau, v, np.nan
    edge = threshold(orbit.model, tau)
    # on gamma |dv/dtau| is below |a_c| of its beginning
    rounding = SETTINGS.roundings * EPSILON * (v + abs(tau) * v / (orbit.zeros[returned.place - 1] - tau))
    return v - float(edge.v), tau, v, float(edge.error) + rounding


def _with_digits(rough: BorderOrbit, digits: int) -> BorderOrbit:
    if rough.status != Status.hit:
        return replace(rough, digits=digits)
    precise = in_digits(rough.returned, abs(rough.v / rough.slope), digits)
    if precise is None:
        return replace(rough, notes=(*rough.notes, f"not resolved to {digits} digits: the number is a double's"))
    notes = rough.notes if precise.certified is not None else (*rough.notes, precise.note)
    exact: Fraction = precise.exact
    return replace(
        rough,
        oscillator=rough.returned.releases.model(exact),
        parameter=precise.value,
        error=precise.error,
        certified=precise.certified,
        digits=digits,
        notes=notes,
    )
