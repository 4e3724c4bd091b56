"""Chatter limits: impacts are flown until the series of the completion map gives the rest to rounding."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import islice
from math import ceil, log
from typing import Any

import numpy as np

from singimpact.algebra.certified import Certified
from singimpact.algebra.expressions import Expression, names_in
from singimpact.algebra.numbers import EPSILON, as_float, as_mpf, compare
from singimpact.algebra.precision import bits_at, digits_at, for_user
from singimpact.algebra.rings import Multiprecision
from singimpact.contact.contact import Contact, series_of_rho
from singimpact.dynamics import enclosed
from singimpact.dynamics.remaining import chatter_completes, remaining, stays_below
from singimpact.flights.blocks import gathered
from singimpact.flights.causes import decoded
from singimpact.flights.compiled_model import compiled_model
from singimpact.flights.derivative import derivative
from singimpact.flights.impact_map import checked_digits, impact_map
from singimpact.flights.kernels.chatter import CLOSE, COMPLETED, EXHAUSTED, LIFTED, NO_ROOM, REPEATS, TOO_WIDE
from singimpact.flights.orbits import orbit_segment
from singimpact.flights.states import States
from singimpact.flights.walls import at_walls
from singimpact.inputs import whole
from singimpact.oscillator.model import Oscillator, require_smooth_rho
from singimpact.oscillator.wall_acceleration import acceleration
from singimpact.result import Result, in_words
from singimpact.status import Cause, Status, status_array
from singimpact.theory.completion import by_velocity

# Statuses and causes of the codes of `kernels.chatter`
ENDED = {
    COMPLETED: (Status.complete, Cause.decided),
    LIFTED: (Status.lifts_off, Cause.decided),
    EXHAUSTED: (Status.unresolved, Cause.impacts_exhausted),
    TOO_WIDE: (Status.unresolved, Cause.overflow),
    REPEATS: (Status.unresolved, Cause.settled),
}


@dataclass(frozen=True)
class Ending:
    """When the series of the completion map replaces further impacts, and the error estimate."""

    order: int = 4  # terms of the series in doubles; the cost grows with the fourth power
    many: int = 8  # terms with digits=
    # longest remaining time, as a part of the time scale of a_c; successive terms then fall by a factor above 10
    near: float = 1 / 64
    kept: int = 20_000  # impacts of sequences that are flown abreast
    elastic: int = 256  # impacts between two estimates where r = 1
    impacts: int = 1_000_000  # default limit; r = 0.9999 from v = 1 to 1e-17 takes 400 000
    # factor on the error estimate: the last term, and the rounding error of every impact carried to the end
    trust: float = 4.0


ENDING = Ending()


@dataclass(frozen=True, repr=False)
class ChatterLimit(Result):
    """The end of a chatter sequence.

    Parameters
    ----------
    tau : the accumulation time; at `lifts_off` the first impact with a_c >= 0; nan if neither
        was reached.
    impacts : flown before the series gave the rest.
    error : estimate of the error of tau, rounding of the given state included.
    status : `complete`, `lifts_off`, or the status of a flight that ended the sequence.
    certified : tau with a proved radius, when digits were asked for and the restitution is a number; else
        None.
    cause : int8, see `singimpact.status.Cause`: why the status is `unresolved`.
    oscillator, launch : beside `certified`, the model and the exact launch time and velocity.
    wall : int8, where the impacts accumulate, or of the last one, of a model with two walls; else None.
    """

    tau: Any
    impacts: Any
    error: Any
    status: Any
    certified: Any = None
    cause: Any = 0
    oscillator: Oscillator | None = field(default=None, repr=False)
    launch: tuple[Expression, ...] = field(default=(), repr=False)
    wall: Any = None

    __repr__ = in_words

    @property
    def sentence(self) -> Any:
        """The status or cause in words, and the remedy.

        Examples
        --------
        >>> end = chatter_limit(Oscillator("x", "cos(2.8*t)", 0, "0.8"), "0.9", "0.005", impacts=3)
        >>> print(end.sentence.partition(":")[0])
        the impacts neither accumulate nor lift off within the number given
        """
        pairs = zip(np.ravel(self.status).tolist(), np.ravel(self.cause).tolist(), strict=True)
        texts = [(Cause(cause) if cause else Status(status)).sentence for status, cause in pairs]
        return np.array(texts, dtype=object).reshape(np.shape(self.status))[()]


def chatter_limit(
    osc: Oscillator, tau: Any, v: Any, *, digits: int | None = None, impacts: int = ENDING.impacts, wall: Any = None
) -> ChatterLimit:
    """The time at which infinitely many impacts accumulate.

    Parameters
    ----------
    osc : the model. tau, v : states, v >= 0; they broadcast, and the fields have their shape.
    digits : decimal digits of tau, which is then an mpmath number.
    impacts : at most; the status is then `unresolved`. The limit bounds the time of a call.
    wall : of the states of a model with two walls, as for the impact map.

    Notes
    -----
    With restitution 0 the first impact is the end, or at `lifts_off` the mass leaves there at once.
    With digits, tau of a model with one wall and a number for restitution is enclosed (`dynamics.enclosed`):
    `certified` has value and radius, and `error` covers them.  For other models `error` is an estimate from the last
    terms.

    Examples
    --------
    >>> end = chatter_limit(Oscillator("x", "cos(2.8*t)", 0, "0.8"), "0.9", "0.005")
    >>> print(f"{end.tau:.14f}", Status(end.status).name, bool(end.error < 1e-13))
    0.95935923442208 complete True
    """
    if wall is not None:
        return at_walls(partial(chatter_limit, digits=digits, impacts=impacts), osc, wall, (tau, v))  # type: ignore[no-any-return]
    states, most = (
        States.of(osc, tau, v, digits if isinstance(digits, int) else 15),
        whole("impacts", impacts, 1, 10**7),
    )
    if states.shape and digits is not None:
        limits = [
            chatter_limit(osc, *states.given(index), digits=digits, impacts=impacts) for index in range(states.v.size)
        ]
        return gathered(ChatterLimit, limits, states.shape)  # type: ignore[no-any-return]
    if osc.plastic:
        return _one_impact(osc, tau, v, digits)
    rough = _in_doubles(osc, states, most)
    if digits is None or rough.status not in (Status.complete, Status.lifts_off):
        return rough
    if rough.status == Status.complete:
        require_smooth_rho(osc, "a chatter limit with digits=")
    proved = _enclosed(osc, states, checked_digits(digits)) if osc.upper is None else None
    return proved or _precise(osc, states, rough, digits)


def _one_impact(osc: Oscillator, tau: Any, v: Any, digits: int | None) -> ChatterLimit:
    """The first impact, where impacts leave no velocity: the mass rests where a_c presses it there, else lifts off."""
    step = impact_map(osc, tau, v, digits=digits)
    landed, hit = step.tau, np.asarray(step.status) == Status.hit
    status, end = np.array(step.status), np.array(landed, dtype=float if digits is None else object)
    stays = np.asarray(impact_map(osc, end[hit], 0.0, digits=digits).status) == Status.sticks
    status[hit], end[~hit] = np.where(stays, Status.complete, Status.lifts_off), np.nan
    if digits is None:
        error = np.where(hit, step.time_error * step.flight_time, np.nan) + EPSILON * np.abs(end)
        return ChatterLimit(end[()], hit.astype(np.int64)[()], error[()], status_array(status), cause=step.cause)
    if not hit:
        return ChatterLimit(np.nan, 0, np.nan, status_array(status), cause=step.cause)
    proved = step.certified.tau if step.certified is not None else None
    with digits_at(digits) as mp:
        error = _covering(proved) if proved is not None else abs(landed) * mp.mpf(10) ** -digits
    launch = States.of(osc, tau, v, digits)
    exact = launch.exact_tau(0), launch.exact_v(0)
    return ChatterLimit(landed, 1, for_user(error), status_array(status), proved, 0, osc if proved else None, exact)


def _in_doubles(osc: Oscillator, states: States, most: int) -> ChatterLimit:
    """The limits of states: by the compiled loop for a linear model, else one after the other."""
    model, count = compiled_model(osc), states.v.size
    at = np.flatnonzero((states.v > 0) & (np.abs(states.tau) < model.nearest))
    near = 0.0 if compare(osc.slope_at_rest(), 1) == 0 else ENDING.near
    compiled = model.limits(states.tau[at], states.v[at], (near, float(most), ENDING.trust)) if at.size else None
    tau, error, impacts = (np.full(count, np.nan) for _ in range(3))
    above = np.zeros(count, np.int8)
    codes = np.full(count, NO_ROOM, np.int8)
    if compiled is not None:
        codes[at], (tau[at], error[at], impacts[at]) = compiled
        # summed up without a flight that shows that the other wall is out of reach
        summed = np.flatnonzero((codes == COMPLETED) & (impacts == 0) & (osc.upper is not None))
        if summed.size:
            pushes = acceleration(osc, states.tau[summed])
            codes[summed[~stays_below(osc, states.v[summed], pushes)]] = NO_ROOM
        if not isinstance(states.turns, float):
            tau += states.turns
            error += np.where(states.turns == 0, 0.0, np.abs(tau) * EPSILON / 2)
    status, cause = decoded(codes)
    for code, (ended, why) in ENDED.items():
        status[codes == code], cause[codes == code] = ended, why
    none = (status != Status.complete) & (status != Status.lifts_off)
    tau[none] = error[none] = np.nan
    for flown in _abreast(osc, states, most, np.flatnonzero(codes == NO_ROOM).tolist()):
        index, one = flown.index, flown.ended()
        tau[index], error[index], impacts[index] = one.tau, one.error, one.impacts
        status[index], cause[index], above[index] = one.status, one.cause, flown.wall
    parts = tau, impacts.astype(np.int64), error, status_array(status), np.full(count, None), cause, above
    shaped: list[Any] = [column.reshape(states.shape)[()] for column in parts]
    if not states.shape:
        shaped[1] = int(shaped[1])
    wall = None if osc.upper is None else shaped[6]
    return ChatterLimit(shaped[0], shaped[1], shaped[2], shaped[3], shaped[4], shaped[5], wall=wall)


def _enclosed(osc: Oscillator, states: States, digits: int) -> ChatterLimit | None:
    """The limit in balls, where the model and the state allow it."""
    enclosure = enclosed.chatter_limit(osc, states, digits) if enclosed.enclosable(osc) else None
    if enclosure is None:
        return None
    status = Status.lifts_off if enclosure.lost else Status.complete
    rounded = _rounded(enclosure.tau.value, enclosure.impacts, _covering(enclosure.tau), status, digits)
    launch = states.exact_tau(0), states.exact_v(0)
    return replace(rounded, certified=enclosure.tau, oscillator=osc, launch=launch)


def _covering(found: Certified) -> Any:
    """The radius plus the error of rounding the value to its digits."""
    with bits_at(53) as mp:
        return mp.convert(found.radius) + abs(mp.convert(found.value)) * mp.mpf(10) ** -found.digits


def chatter_left(osc: Oscillator, tau: float, v: float) -> tuple[float, float] | None:
    """The remaining time of a complete chatter and the last term of its series; None where a_c >= 0."""
    a = acceleration(osc, np.array([tau]))
    if not a[0] < 0 or not chatter_completes(osc):
        return None
    left, error = remaining(osc, np.array([tau]), np.array([v]), a)
    return float(left[0]), float(error[0])


def impacts_until(osc: Oscillator, error: float, wanted: float) -> int:
    """Impacts after which the last term of the series, now `error`, is below `wanted`; 1 if it is not finite."""
    if not np.isfinite(error):
        return 1
    r = as_float(osc.slope_at_rest())
    if r == 1:  # the speeds fall like a power of the number of impacts, not geometrically
        return ENDING.elastic
    order = ENDING.order if osc.smooth_at_rest else 2
    return max(1, ceil(log(error / (wanted + 1e-300)) / (order * -log(r))))


def _abreast(osc: Oscillator, states: States, most: int, at: list[int]) -> "Iterator[_Flown]":
    """The sequences of some of the states, in blocks in which a formula is evaluated for all states at once."""
    begin, many = 0, 4
    laws = [_Law(model) for model in ((osc,) if osc.upper is None else (osc, osc.mirrored))]
    while begin < len(at):
        block = [_Flown(laws, states, most, index) for index in at[begin : begin + many]]
        going = block
        while going := [flown for flown in going if flown.over is None and flown.status == Status.hit]:
            for wall, law in enumerate(laws):
                _look_ahead(law.osc, [flown for flown in going if flown.wall == wall])
        _differentiate(osc, [flown for flown in block if flown.over and len(flown.matrices) < len(flown.times) - 1])
        yield from block
        begin += many
        # as many as have about so many impacts together: model is kept until the block ends
        many = max(1, min(4 * many, ENDING.kept * len(block) // sum(len(flown.times) for flown in block)))


def _look_ahead(osc: Oscillator, going: "list[_Flown]") -> None:
    """Estimate what is left of each sequence at the lower wall, which ends or is flown further."""
    if not going:
        return
    tau, v = np.array([(flown.times[-1], flown.speeds[-1]) for flown in going]).T
    a = acceleration(osc, tau)
    left, error = np.full((2, tau.size), np.nan)
    summed = np.array([flown.short or flown.law.tried for flown in going]) & (a < 0)
    if summed.any():
        left[summed], error[summed] = remaining(osc, tau[summed], v[summed], a[summed])
    for flown, *numbers in zip(going, a.tolist(), left.tolist(), error.tolist(), strict=True):
        flown.go_on(*numbers)


def _differentiate(osc: Oscillator, flown: "list[_Flown]") -> None:
    launches = [launch for one in flown for launch in zip(one.times[:-1], one.speeds[:-1], one.walls[:-1], strict=True)]
    tau, v, walls = np.array(launches).reshape(-1, 3).T
    wall = None if osc.upper is None else walls.astype(np.int8)
    matrices = iter(derivative(osc, tau, v, wall=wall).matrix.tolist() if launches else ())
    for one in flown:
        one.matrices = list(islice(matrices, len(one.times) - 1))


class _Law:
    """The restitution at rest that all chatter sequences of a model share.

    Parameters
    ----------
    osc : the model. Attributes are r = -rho'(0), whether it is 1, and whether chatter completes nevertheless.
    """

    def __init__(self, osc: Oscillator) -> None:
        self.osc, slope = osc, osc.slope_at_rest()
        self.r, self.elastic = as_float(slope), compare(slope, 1) == 0
        # where r = 1 no time is short by the rules of the kernels, which know r alone: the sum is tried in any case
        self.tried = self.elastic and chatter_completes(osc)
        self.has_slopes = not names_in(osc.restitution) and compiled_model(osc).linear


class _Flown:
    """A chatter sequence in doubles, for any model; `kernels.chatter` is the compiled version for linear models."""

    def __init__(self, laws: list[_Law], states: States, most: int, index: int) -> None:
        self.laws, self.given, self.most, self.index = laws, states.given(index), most, index
        self.walls = [0]
        self.turns = float(np.broadcast_to(states.turns, states.tau.shape)[index])
        self.times, self.speeds, self.cause = [float(states.tau[index])], [float(states.v[index])], Cause.decided
        self.short = False  # whether the rest is summed up from the last impact
        self.matrices: list[Any] = []
        self.over: tuple[float, float, Status] | None = None
        self.status, self.push = self._first(), np.nan

    @property
    def wall(self) -> int:
        """The wall of the last impact."""
        return self.walls[-1]

    @property
    def law(self) -> _Law:
        """The restitution there."""
        return self.laws[self.wall]

    def go_on(self, a: float, left: float, error: float) -> None:
        """End, or fly further impacts.

        Parameters
        ----------
        a : a_c at the last impact. left, error : what is left of the chatter, and the last term of its series.
        """
        tau, v, self.push = self.times[-1], self.speeds[-1], a
        summed = self.short or (self.law.tried and a < 0)
        crosses = summed and not stays_below(self.law.osc, v, a)
        if a >= 0 and len(self.times) > 1:
            self.over = tau, 0.0, Status.lifts_off
        elif summed and not crosses and (error <= EPSILON * max(abs(tau), left) / 4 or v < 1e-290):
            self.over = tau + left, error, Status.complete
        elif self.short and not crosses and not np.isfinite(error):  # a derivative of a_c leaves the range of doubles
            self.status, self.cause = Status.unresolved, Cause.overflow
        elif len(self.times) > self.most:
            self.status, self.cause = Status.unresolved, Cause.impacts_exhausted
        else:
            count = 1 if crosses else 256
            if summed and not crosses:
                count = impacts_until(self.law.osc, error, EPSILON * abs(tau) / 8)
            self.status = self._fly(count, 0.0 if self.short or self.law.elastic else ENDING.near)

    def ended(self) -> ChatterLimit:
        """The limit of a sequence that is not going on."""
        count = len(self.times) - 1
        if self.over is None:
            return ChatterLimit(np.nan, count, np.nan, np.int8(self.status), cause=np.int8(self.cause))
        tau, error, status = self.over
        total = ENDING.trust * error + self.rounding(tau, status)
        if self.turns:
            tau, total = tau + self.turns, total + EPSILON / 2 * abs(tau + self.turns)
        return ChatterLimit(np.float64(tau), count, np.float64(total), np.int8(status))

    def _first(self) -> Status:
        """Fly the first impact of a start at rest by the impact map, which handles rest and lift-off."""
        if self.speeds[0] > 0:
            return Status.hit
        step = impact_map(self.law.osc, *self.given)
        if step.status == Status.hit:
            self.times.append(float(step.tau) - self.turns)
            self.speeds.append(float(step.v))
            self.walls.append(0 if step.wall is None else int(step.wall))
        self.cause = Cause(int(step.cause))
        return Status(int(step.status))

    def _fly(self, count: int, near: float) -> Status:
        """Fly further impacts; the sequence is cut after the first impact with a_c >= 0."""
        segment = orbit_segment(
            self.law.osc, self.times[-1], self.speeds[-1], min(count, 4096, self.most + 1 - len(self.times)), near
        )
        lifted = np.flatnonzero(segment.acceleration[1:] >= 0)
        length, wall = int(lifted[0]) + 1 if lifted.size else segment.tau.size, self.wall
        if self.law.has_slopes:
            r, slopes = self.law.r, segment.slopes.T[:length].tolist()
            if len(self.laws) == 1:
                self.matrices += [((1 + a, b), (-r * c, -r * d)) for a, b, c, d in slopes]
        self.times += segment.tau[:length].tolist()
        self.speeds += segment.v[:length].tolist()
        self.walls += (segment.wall[:length] ^ np.int8(wall)).tolist()
        if length != segment.tau.size:
            return Status.hit
        if segment.status and len(self.times) > 1 and acceleration(self.law.osc, np.array(self.times[-1:]))[0] >= 0:
            return Status.hit  # the mass lifts off here, so the status of the flight after it does not matter
        self.cause, self.short = Cause(segment.cause), self.short or segment.short
        if not segment.status and not self.short and self._is_settled(length):
            self.cause = Cause.settled
            return Status.unresolved
        return Status(segment.status)

    def _is_settled(self, count: int) -> bool:
        """Whether the last of so many impacts repeats one of the others, see `CLOSE`."""
        if self.law.osc.period is None:
            return False
        turns = np.array(self.times[-count:]) / as_float(self.law.osc.period)
        apart, speeds = np.abs(turns[:-1] - turns[-1]), np.array(self.speeds[-count:])
        # times lose digits in their size
        close = np.abs(apart - np.round(apart)) <= CLOSE + EPSILON * abs(turns[-1])
        return bool((close & (np.abs(speeds[:-1] - speeds[-1]) <= CLOSE * speeds[-1])).any())

    def rounding(self, end: float, status: Status) -> float:
        """The rounding errors of all impacts, carried to the end by D G: an adjoint sweep from the last impact."""
        first, times, speeds = self.times[0], self.times, self.speeds
        by_tau, by_v = 1.0, 0.0
        if status == Status.complete:
            by_v = -2 / self.push / (1 - self.law.r) if self.law.osc.smooth_at_rest else self._end_by_v()
        total = 0.0
        for index in range(len(times) - 1, -1, -1):
            total += abs(by_tau) * (abs(times[index]) + abs(times[index] - first)) + 4 * abs(by_v) * speeds[index]
            if index:
                (a, b), (c, d) = self.matrices[index - 1]
                by_tau, by_v = by_tau * a + by_v * c, by_tau * b + by_v * d
        return ENDING.trust * EPSILON * (total + abs(end))

    def _end_by_v(self) -> float:
        """The derivative of the end by the last velocity, from the time left at two velocities."""
        v = self.speeds[-1]
        (less, _), (more, _) = (chatter_left(self.law.osc, self.times[-1], speed) or (0.0, 0.0) for speed in (v / 2, v))
        return 2 * (more - less) / v if v > 0 else 0.0


def _precise(osc: Oscillator, states: States, rough: ChatterLimit, digits: int) -> ChatterLimit:
    """A sequence of chatter in many digits, continued until the last term is below them."""
    amplified = max(float(rough.error) / (EPSILON * max(abs(float(rough.tau)), 1e-300)), 1.0)
    precision = digits + 10 + ceil(log(amplified, 10))
    with digits_at(precision) as mp:
        small = mp.mpf(10) ** (-digits - 1)
        tau, v = states.given(0)
        if not states.rest:
            tau, v = (as_mpf(tree, mp) for tree in (states.exact_tau(0), states.exact_v(0)))
        count, wanted, ring = 0, int(rough.impacts), Multiprecision(mp)
        while True:
            while count < wanted:
                step = impact_map(osc, tau, v, digits=precision)
                tau, v, count = mp.convert(step.tau), mp.convert(step.v), count + 1
                osc = osc.mirrored if step.wall else osc
            if rough.status == Status.lifts_off:
                return replace(_rounded(tau, count, small * abs(tau), Status.lifts_off, digits), wall=rough.wall)
            r = as_mpf(osc.slope_at_rest(), mp)
            rho = {k: value for k, value in series_of_rho(osc, ENDING.many, ring).items() if k > 1}
            contact = Contact.of(osc, tau, 0, ENDING.many, ring)
            terms = [c * v**n for n, c in by_velocity(contact, r, rho, ENDING.many).items()]
            first, *_, before, last = terms
            # a coefficient may happen to be small: the term before it lets expect the last one
            error = max(abs(last), abs(before) * abs(before / first) ** (first * 0 + 1 / (len(terms) - 2)))
            end = tau + sum(reversed(terms))
            if ENDING.trust * error <= small * abs(end) or v == 0:
                limit = _rounded(end, count, ENDING.trust * error + small * abs(end), Status.complete, digits)
                return replace(limit, wall=rough.wall)
            wanted = count + max(1, int(mp.ceil(mp.log(small * abs(end) / (5 * error)) / mp.log(r) / ENDING.many)))


def _rounded(tau: Any, count: int, error: Any, status: Status, digits: int) -> ChatterLimit:
    with digits_at(digits) as mp:
        end = +mp.convert(tau)
        off = mp.convert(error) + abs(end) * mp.eps  # what rounding to these digits adds
        return ChatterLimit(for_user(end), count, for_user(off), np.int8(status))
