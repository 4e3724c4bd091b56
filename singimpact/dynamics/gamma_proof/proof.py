"""`certified_gamma`: gamma of an analytic model proved on an interval of launch times before a contact point."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import pairwise
from math import ceil, floor, pi
from typing import Any

from flint import arb

from singimpact.algebra.balls import Balls
from singimpact.algebra.certified import Certified, from_ball
from singimpact.algebra.expressions import Expression, evaluate, names_in, number
from singimpact.algebra.numbers import as_float, as_fraction, compare, constant, rational_ends, rational_number
from singimpact.algebra.precision import balls_at
from singimpact.contact.zero_ahead import ContactZero, next_zero
from singimpact.dynamics.gamma_proof import gravity
from singimpact.dynamics.gamma_proof.after import PIECES, Lost, Settled, lost_contact, settled
from singimpact.dynamics.gamma_proof.folded import between
from singimpact.dynamics.gamma_proof.lemmas import BoxProof, ProofSettings, Undecided, prove_box, rational
from singimpact.dynamics.gamma_proof.nonlinear import NonlinearRelation, nonlinear_relation
from singimpact.inputs import InputError, need, refuse, require
from singimpact.oscillator.linear import linear_form
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.wall_acceleration import sign_of_acceleration

BITS = 96  # of the balls
DIGITS = 20  # that bounds and places are printed with
BELOW_ONE = "two rational numbers (low, high), 0 < low < high < 1"
PHASES = 64  # of a period, tried for a start with a_c < 0
# Reaches that are tried where none is given, in units of 1/omega_d or of the fastest forcing
REACHES = tuple(
    Fraction(*part)
    for part in ((1, 2), (3, 8), (1, 4), (3, 16), (1, 8), (1, 12), (1, 16), (1, 24), (1, 32), (1, 64), (1, 128))
)
# Settings that are tried in turn for a box
TRIED = (
    ProofSettings(),
    ProofSettings(thin=400),
    ProofSettings(N=8, D=28, pieces=96),
    ProofSettings(N=8, D=28, thin=400, pieces=96),
    ProofSettings(thin=1600, pieces=128),
    ProofSettings(N=8, D=28, thin=1600, pieces=192),
)
# Width of a box of lambda in units of min(lambda, 1 - lambda): the first, its growth on success, the least
WIDEST, GROWTH, NARROWEST = 0.02, 1.3, 2.0**-20
CUT, FINE = 7, 25  # decimals of the cuts between boxes of lambda, and of the lambda of one r
LAUNCHES = 9  # halvings of the launch place, + 1, from which chatter is followed past a swan
FAR, MARGIN = 100.0, 0.99  # time after tau_* where a_c has no further zero; part of the time to that zero
COARSE = 2.0**-16  # tail of the series there, in units of b_j
# Parts of the disc of convergence on which |A| is looked at after a swan
AFTER = (Fraction(3, 4), Fraction(1, 2), Fraction(1, 4))


@dataclass(frozen=True, repr=False)
class CertifiedGamma:
    """gamma on an interval of launch times before a contact point, proved for one r or for all r of an interval.

    For launches (tau, v) with 0 < S <= reach, S = tan(omega_d (tau_* - tau))/omega_d, and any v > 0: there is one
    Gamma(tau) > 0, a graph that is Lipschitz, from which infinitely many impacts accumulate at tau_*; below it chatter
    completes before tau_*, above it finitely many impacts come before tau_*.  For a nonlinear model S = tau_* - tau,
    and v goes up to `fastest`.

    Attributes
    ----------
    oscillator : the model. zero : tau_* with its contact order. tau : tau_*. reach, asked : of S, rationals.
    duration : tau_* - tau at S = reach. restitution : (low, high), rationals or None where r is no rational.
    boxes : proofs for boxes of lambda, which touch. lost : after an odd order, the time after tau_* in which at most
        one impact comes. settled : after a swan, the launches (S <= launch, y' <= speed) that pass tau_* and whose
        chatter is shown to complete, and where in s > 0. fastest : of v, None for any. notes : how far it got, and why
        not farther.
    """

    oscillator: Oscillator
    zero: ContactZero
    reach: Fraction
    asked: Fraction | None
    restitution: tuple[Fraction, Fraction] | None
    boxes: tuple[BoxProof, ...]
    tau: Certified
    duration: Certified
    lost: Lost | None
    settled: Settled | None
    fastest: Certified | None = None
    notes: dict[str, str] = field(default_factory=dict)

    @property
    def of_model(self) -> bool:
        """Whether it is a proof for the restitution of the model alone."""
        return self.restitution is None or self.restitution[0] == self.restitution[1]

    @property
    def order(self) -> int:
        """The contact order j."""
        return self.zero.order

    @property
    def series(self) -> tuple[Certified, ...]:
        """L_0 = lambda, L_1, ...: the landing ratio of gamma in powers of S; for one r."""
        return tuple(from_ball(part, DIGITS) for part in self._one().series)

    @property
    def Kl(self) -> float:
        """|landing ratio - L(S)| <= Kl S^N on gamma; the largest of all boxes."""
        return max(float(box.Kl.upper()) for box in self.boxes)

    @property
    def grow(self) -> float:
        """Factor by which distances across gamma grow at least, per impact; the least of all boxes."""
        return min(float(box.grow.lower()) for box in self.boxes)

    def threshold(self, tau: Any) -> Certified:
        """v on gamma at a launch time, with its proved radius; for one r.

        Raises
        ------
        InputError : tau is not in the interval, or the proof is one for an interval of r.
        """
        box, phase = self._one(), constant("tau", tau)
        with balls_at(BITS):
            square = gravity.clock_of(self.oscillator, self.zero, BITS).square
            T = self.zero.moved(BITS) - evaluate(phase, {}, Balls(BITS))
            flights = flights_before(self.oscillator, self.zero, self.reach)
            S = gravity.place_of(square, T) if T > 0 and gravity.time_of(square, flights.s0) >= T else None
            if S is None or not S > 0:
                first = as_float(constant("tau", str(self.tau))) - float(self.duration.value)
                raise refuse("tau", tau, f"a launch time from {first:.12g} to {self.tau}")
            return from_ball(self._velocity(box, flights, S), DIGITS)

    def _velocity(self, box: BoxProof, flights: gravity.Flights, S: Any) -> Any:
        S = S.min(flights.s0)
        return _gauged(box, flights, S) * gravity.speed_factor(gravity.clock_of(self.oscillator, self.zero, BITS), S)

    def at_reach(self) -> Certified:
        """v on gamma at S = reach, for one r."""
        with balls_at(BITS):
            flights = flights_before(self.oscillator, self.zero, self.reach)
            return from_ball(self._velocity(self._one(), flights, flights.s0), DIGITS)

    def _one(self) -> BoxProof:
        need(self.of_model, InputError("gamma is proved for an interval of r here: ask for one restitution"))
        return self.boxes[0]

    def __repr__(self) -> str:
        r = self.oscillator.restitution if self.restitution is None else self.restitution[0]
        low, high = (r, r) if self.restitution is None else self.restitution
        which = f"r = {r}" if low == high else f"all r in [{low}, {high}], {len(self.boxes)} boxes of lambda"
        return (
            f"<gamma before tau_* = {self.tau} (order {self.order}), proved for {which} and launches less than "
            f"{float(self.duration.value):.6g} before tau_* (S <= {self.reach}): |l - L(S)| <= {self.Kl:.3g} S^N, "
            f"distances grow by {self.grow:.4g}>"
        )


def certified_gamma(
    osc: Oscillator, tau: Any = None, *, reach: Any = None, restitution: tuple[Any, Any] | None = None
) -> CertifiedGamma:
    """gamma before the next zero of a_c, proved by three lemmas in balls: it exists, is unique, and decides the fate.

    Parameters
    ----------
    osc : a model with analytic f and g; its restitution a number in (0, 1). tau : a phase with a_c(tau) < 0; None for
        the first one of a period. reach : S = tan(omega_d (tau_* - tau))/omega_d, tau_* - tau itself for a nonlinear
        model, goes up to this rational number; None for as far as the proof gets. A reach that is not proved is
        halved, and `notes` says so. restitution : (low, high) for a proof for all r of an interval.

    Returns
    -------
    CertifiedGamma : `.reach`, `.boxes`, `.series`, `.Kl`, `.threshold(tau)`, `.notes`; `si.certify` makes it a file.

    Raises
    ------
    InputError : a model that is not analytic, no zero of a_c with a gamma ahead, or no reach at which the lemmas hold.

    Examples
    --------
    >>> from singimpact.impact_oscillator import linear
    >>> found = certified_gamma(linear(2, "0.3", "1/2"), reach="1/4")
    >>> found.order, found.reach, found.Kl < 0.2, found.grow > 1.8
    (1, Fraction(1, 4), True, True)
    >>> print(f"{float(found.threshold('2.4').value):.6f}")
    0.003454
    """
    if osc.parametric:
        raise InputError(
            f"f = {osc.f} depends on t: gamma is certified for f in x and xdot alone; si.threshold takes digits="
        )
    zero = _zero_ahead(osc, tau)
    ends = _ends(osc, restitution)
    wanted = None if reach is None else rational_number("reach", reach)
    if wanted is not None and not 0 < wanted <= 1000:
        raise refuse("reach", reach, "a rational number > 0")
    with balls_at(BITS):
        tried: list[str] = []
        for s0 in _reaches(wanted, osc, zero):
            try:
                relation = flights_before(osc, zero, s0)
                steps = [relation.s0 * i / PIECES for i in range(PIECES + 1)]
                # U^(S, 1) is half of |A|/S^j
                if not all(relation.hats(between(a, b), arb(1)).U > 0 for a, b in pairwise(steps)):
                    raise Undecided("a_c is not shown to be negative on all of the interval")
                boxes = _covered(relation, ends)
            except (Undecided, InputError) as reason:
                tried.append(f"S <= {s0}: {reason}")
                continue
            return _found(osc, zero, (s0, wanted), ends, boxes, tried)
    raise InputError(f"gamma is not certified before tau_* = {zero.tau:.12g}: {tried[-1]}")


def flights_before(osc: Oscillator, zero: ContactZero, reach: Fraction, bits: int = BITS) -> gravity.Flights:
    """The relation of two flights: of a linear model as a ball under gravity, of others by their series."""
    if linear_form(osc) is None:
        return nonlinear_relation(osc, zero, reach, bits)
    return gravity.Relation(gravity.gravity(osc, zero, reach, bits))


class _Ends:
    """The r for which gamma is to be proved: one ball, or an interval of rationals."""

    def __init__(self, low: Any, high: Any, tree: Expression | None) -> None:
        self.low, self.high, self.tree = low, high, tree

    @property
    def told(self) -> tuple[Fraction, Fraction] | None:
        """(low, high), or None where r is no rational."""
        return None if self.low is None else (self.low, self.high)


def _ends(osc: Oscillator, restitution: tuple[Any, Any] | None) -> _Ends:
    if restitution is None:
        if names_in(osc.restitution):
            raise InputError(f"restitution = {osc.restitution} is not accepted: gamma is certified for a number r")
        if not (compare(osc.restitution, number(0)) > 0 > compare(osc.restitution, number(1))):
            raise InputError(f"restitution = {osc.restitution} is not accepted: give a number in (0, 1)")
        exact = as_fraction(osc.restitution)
        return _Ends(exact, exact, osc.restitution)
    low, high = rational_ends("restitution", restitution, BELOW_ONE)
    require(0 < low < high < 1, "restitution", restitution, BELOW_ONE)
    return _Ends(low, high, None)


def _zero_ahead(osc: Oscillator, tau: Any) -> ContactZero:
    """The next zero of a_c after tau, or after the first phase with a_c < 0."""
    start = phase_below(osc) if tau is None else constant("tau", tau)
    if start is not None and sign_of_acceleration(osc, start) >= 0:
        start = None
    if start is None:
        raise InputError(
            f"tau = {tau} is not accepted: give a phase with a_c(tau) < 0"
            if tau is not None
            else "a_c < 0 at no phase of a period: no gamma ends anywhere, or give tau"
        )
    ahead = next_zero(osc, start)
    if ahead.zero is None:
        raise InputError(
            f"after tau = {start} a_c has no zero: no gamma lies ahead"
            if ahead.decided
            else f"the next zero of a_c after tau = {start}, or its order, is not decided"
        )
    return ahead.zero


def phase_below(osc: Oscillator) -> Expression | None:
    """The first of some phases of a period with a_c < 0."""
    need(osc.period is not None, InputError("g is not seen to be periodic: give tau, a phase with a_c(tau) < 0"))
    length = as_float(osc.period)
    phases = (number(Fraction(k * length / PHASES).limit_denominator(10**6)) for k in range(PHASES))
    return next((phase for phase in phases if sign_of_acceleration(osc, phase) < 0), None)


def _reaches(wanted: Fraction | None, osc: Oscillator, zero: ContactZero) -> Iterator[Fraction]:
    """The reaches that are tried, from the largest."""
    if wanted is not None:
        return (wanted / 2**k for k in range(7))
    if linear_form(osc) is None:
        return iter(REACHES)
    numbers = gravity.numbers_of(osc, zero, BITS)
    fastest = max(
        [1e-6, abs(float(numbers.square.mid())) ** 0.5, *(abs(float(wave[0].mid())) / 4 for wave in numbers.waves)]
    )
    unit = 1 / Fraction(fastest).limit_denominator(64) if fastest > 1 / 32 else Fraction(1 / fastest)
    return (unit * share for share in REACHES)


def _covered(relation: gravity.Flights, ends: _Ends) -> tuple[BoxProof, ...]:
    """Proofs for boxes of lambda that touch and contain all r asked for."""
    if ends.tree is not None:
        r = evaluate(ends.tree, {}, Balls(BITS))
        return (_tried(relation, ratio(relation.j, r, FINE), r),)
    x = ratio(relation.j, Balls(BITS).rational(ends.low), CUT)[0]
    end = ratio(relation.j, Balls(BITS).rational(ends.high), CUT)[1]
    proofs, width = [], WIDEST
    while x < end:
        while True:
            y = min(Fraction(f"{float(x) + width * min(float(x), 1 - float(x)):.{CUT}f}"), end)
            try:
                proofs.append(_tried(relation, (x, y), None, width < WIDEST / 4))
                break
            except Undecided as reason:
                width = width / 2
                if width < NARROWEST:
                    r = float(gravity.restitution_at(relation.j, rational(x)).mid())
                    raise Undecided(f"r = {r:.4g}: {reason}") from None
        x, width = y, width * GROWTH
    return tuple(proofs)


def _tried(relation: gravity.Flights, box: tuple[Fraction, Fraction], r: Any, patient: bool = True) -> BoxProof:
    """A proof with the first settings that allow one."""
    reasons: list[Undecided] = []
    for settings in TRIED if patient else TRIED[:2]:
        try:
            return prove_box(relation, box, settings, r)
        except Undecided as reason:
            reasons.append(reason)
    raise reasons[0]


def ratio(j: int, r: Any, digits: int) -> tuple[Fraction, Fraction]:
    """Two decimals, so many digits long, between which lies the lambda of r.

    Examples
    --------
    >>> [str(float(end)) for end in ratio(1, arb(5) / 16, 6)]
    ['0.499998', '0.500002']
    """
    low, high = Fraction(0), Fraction(1)
    for _ in range(4 * digits):
        for share in (Fraction(1, 2), Fraction(3, 7)):  # next to lambda itself nothing is decided
            middle = low + share * (high - low)
            value = gravity.restitution_at(j, rational(middle))
            if value < r or value > r:
                low, high = (middle, high) if value < r else (low, middle)
                break
    unit = 10**digits
    return Fraction(floor(low * unit) - 1, unit), Fraction(ceil(high * unit) + 1, unit)


def _found(
    osc: Oscillator,
    zero: ContactZero,
    reaches: tuple[Fraction, Fraction | None],
    ends: _Ends,
    boxes: tuple[BoxProof, ...],
    tried: list[str],
) -> CertifiedGamma:
    """The result, with what comes after tau_*."""
    s0, wanted = reaches
    flights, notes = flights_before(osc, zero, s0), {}
    if tried:
        notes["reach"] = "; ".join(tried)
    outcome: dict[str, Any] = {"lost": None, "settled": None}
    if isinstance(flights, NonlinearRelation):
        outcome["fastest"] = from_ball(flights.fastest, DIGITS)
        notes["after"] = "what comes after tau_* is proved for linear models alone"
    elif zero.order % 2:
        outcome["lost"] = _lost(osc, zero, s0)
        if outcome["lost"] is None:
            notes["after"] = "that contact is lost after tau_* is not decided"
    else:
        outcome["settled"] = _settled(osc, zero, s0, boxes)
        if outcome["settled"] is None:
            notes["after"] = f"that chatter completes after tau_* is not decided for r = {float(boxes[-1].r.mid()):.4g}"
    duration = gravity.time_of(gravity.clock_of(osc, zero, BITS).square, flights.s0)
    return CertifiedGamma(
        osc,
        zero,
        s0,
        wanted,
        ends.told,
        boxes,
        from_ball(zero.moved(BITS), DIGITS),
        from_ball(duration, DIGITS),
        notes=notes,
        **outcome,
    )


def _lost(osc: Oscillator, zero: ContactZero, s0: Fraction) -> Lost | None:
    """The time after tau_* in which at most one impact comes: nearly up to the next zero of a_c."""
    numbers = gravity.numbers_of(osc, zero, BITS)
    for near in (s0, s0 / 4, s0 / 16):
        o = gravity.gravity(osc, zero, near, BITS)
        start = zero.moved(BITS) + gravity.time_of(numbers.square, o.s0()) / 2
        phase = number(Fraction(float(start.mid())))
        if sign_of_acceleration(osc, phase) <= 0:
            continue
        ahead = next_zero(osc, phase)
        until = FAR if ahead.zero is None else MARGIN * (ahead.zero.tau - zero.tau)
        if numbers.square > 0:  # the gauge ends at a quarter turn
            until = min(until, MARGIN * pi / 2 / float(numbers.square) ** 0.5)
        lost = lost_contact(o, numbers, near, Fraction(f"{until:.6g}"))
        if lost is not None:
            return lost
    return None


def _settled(osc: Oscillator, zero: ContactZero, s0: Fraction, boxes: tuple[BoxProof, ...]) -> Settled | None:
    """The launch speeds for which chatter completes after a swan, for the largest launch place at which these exceed
    gamma."""
    square = abs(gravity.numbers_of(osc, zero, BITS).square).upper()
    widest = Fraction(f"{float(1 / square.sqrt()):.3g}") if square > 1e-9 else 16 * s0
    relation, r = gravity.Relation(gravity.gravity(osc, zero, s0, BITS)), arb(boxes[-1].r.upper())
    for k in range(LAUNCHES):
        launch, best = s0 / 2**k, None
        for share in AFTER:
            try:
                o = gravity.gravity(osc, zero, max(widest * share, launch), BITS, COARSE)
            except InputError:
                continue
            bound = settled(o, launch, r, widest * share)
            if bound is not None and (best is None or bound.speed > best.speed):
                best = bound
        if best is not None and rational(best.speed) > _gauged(boxes[0], relation, rational(launch)):
            return best
    return None


def _gauged(box: BoxProof, relation: gravity.Flights, S: Any) -> Any:
    """gamma at S as a ball of y'."""
    N, ell = len(box.series), arb(0)
    for part in reversed(box.series):
        ell = ell * S + part
    ell = ell + arb(0, 1) * (box.Kl * S**N)
    return S ** (relation.j + 1) * (1 - ell) * relation.hats(S, ell).W
