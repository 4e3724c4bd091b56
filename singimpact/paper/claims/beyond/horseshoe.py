"""Chaos of an impact oscillator, certified: x'' + x = cos 2.8 t, c = 0, r = 4/5.

`b:homoclinic` : a transverse homoclinic orbit, the hypothesis of the theorem of Smale and Birkhoff.
`b:horseshoe` : sets that are crossed by images of one another, from which chaos follows without that theorem.
"""

from fractions import Fraction
from functools import cache
from math import pi
from typing import Any, NamedTuple

from singimpact.algebra import Certified, exact
from singimpact.branches.homoclinic import Crossing, homoclinic_points
from singimpact.branches.periodic import periodic
from singimpact.inputs import InputError
from singimpact.oscillator.model import Oscillator
from singimpact.paper.claims.claim import Check, Encoding
from singimpact.paper.claims.verifiers import every

DIGITS = 30
# Impacts farther than this from the saddle, in tau or in v, are those of the excursion; the others are within 0.07.
NEAR = Fraction(1, 10)


class Stated(NamedTuple):
    """A statement about the model with a restitution: decimals, correct to half a unit of their last place.

    saddle : (tau, v) of the (1, 1) orbit. away : the impacts that are not near it. angle : at the second of these.
    """

    restitution: str
    saddle: tuple[str, str]
    away: tuple[tuple[str, str], ...]
    angle: str


@cache
def _first(restitution: str) -> Crossing | None:
    """The homoclinic orbit of fewest impacts, in doubles, of a saddle among the (1, 1) orbits."""
    orbits = periodic(Oscillator("x", "cos(2.8*t)", 0, restitution), 1, 1)
    saddles = [orbit for orbit in orbits if orbit.visible and not orbit.stable]
    return next(iter(homoclinic_points(saddles[0], v=1)), None) if saddles else None


@cache
def _proved(restitution: str, what: str) -> Any:
    """Itself with its digits, or the horseshoe beside it, proved; or why it is not."""
    found = _first(restitution)
    if found is None:
        return f"r = {restitution}: no crossing of W^u and W^s of a (1, 1) saddle is found"
    try:
        return found.certified(DIGITS) if what == "crossing" else found.horseshoe()
    except InputError as reason:
        return str(reason)


def _is(ball: Certified, text: str, period: float = 0.0) -> bool:
    """Whether every number of a ball rounds to a decimal, or to one a period away."""
    value, unit = exact("value", ball.value), Fraction(1, 10 ** len(text.partition(".")[2]))
    turns = round((float(value) - float(text)) / period) if period else 0
    # a period in doubles moves the value by 1e-15: nothing beside half a unit
    off = abs(value - turns * Fraction(period) - Fraction(text))
    return off + exact("radius", ball.radius) < unit / 2


def _crosses(stated: Stated) -> Check:
    """Whether the certified orbit is the stated one."""
    crossing = _proved(stated.restitution, "crossing")
    if isinstance(crossing, str):
        return Check(False, "certified", crossing, {"fails": crossing})
    period = 2 * pi / 2.8
    at, multipliers = crossing.unstable, [pair[0] for pair in crossing.unstable.multipliers or ()]
    away = [state for state in crossing.states if not _near(state, (at.tau[0], at.v[0]), period)]
    places = ", ".join(f"({float(tau.value) % period:.6f}, {float(v.value):.6f})" for tau, v in away)
    return every(
        [
            (
                f"the (1, 1) orbit ({at.tau[0]}, {at.v[0]}) exists",
                _is(at.tau[0], stated.saddle[0], period) and _is(at.v[0], stated.saddle[1]),
            ),
            (
                f"it is a saddle, with the multipliers {' and '.join(map(str, multipliers))}",
                at.stable is False and len(multipliers) == 2,
            ),
            (
                f"an orbit of {crossing.impacts} impacts from W^u to W^s exists, the only one within "
                f"{float(crossing.unique_within):.1g}; all flights next to its closure are proved to be first hits "
                "with "
                "x' < 0: G is smooth along it",
                crossing.kind == "homoclinic",
            ),
            (
                f"{len(away)} of its impacts are farther than {float(NEAR)} from the saddle: {places}",
                len(away) == len(stated.away)
                and all(_is(tau, t, period) and _is(v, w) for (tau, v), (t, w) in zip(away, stated.away, strict=True)),
            ),
            (
                f"W^u and W^s cross at ({crossing.tau}, {crossing.v}) at the angle {crossing.angle}: transversally",
                _is(crossing.angle, stated.angle) and crossing.angle.value > crossing.angle.radius,
            ),
        ],
        "certified",
    )


def _near(state: tuple[Certified, Certified], saddle: tuple[Certified, Certified], period: float) -> bool:
    """Whether a state is within `NEAR` of the saddle; balls and the period in doubles are far narrower than the gap."""
    tau, v = (float(part.value) - float(of.value) for part, of in zip(state, saddle, strict=True))
    return max(abs(tau - period * round(tau / period)), abs(v)) < NEAR


def _chaotic(stated: tuple[str, tuple[int, int], str]) -> Check:
    """(r, loops, h): loops of these lengths are followed in any order, and the entropy is at least h."""
    restitution, loops, entropy = stated
    horseshoe = _proved(restitution, "horseshoe")
    if isinstance(horseshoe, str):
        return Check(False, "certified", horseshoe, {"fails": horseshoe})
    bound = exact("value", horseshoe.entropy.value) - exact("radius", horseshoe.entropy.radius)
    return every(
        {
            f"{len(horseshoe.sets)} parallelograms, round the saddle and along the homoclinic orbit, are crossed "
            "by "
            f"images of one another: loops of {horseshoe.loops[0]} and {horseshoe.loops[1]} impacts follow in any "
            "order": horseshoe.loops == loops,
            f"the entropy of G is at least {horseshoe.entropy}": Fraction(entropy) <= bound,
        },
        "certified",
    )


TRUE = Stated(
    "4/5",
    ("2.2146319327", "0.2689418160"),
    (("0.1342436603", "0.1959835644"), ("1.7728431769", "0.4281979913"), ("0.2448057373", "0.4468342542")),
    "1.2963606016",
)

CHAOS = ("4/5", (1, 17), "0.1256")

CLAIMS = {
    "b:homoclinic": Encoding(
        TRUE,
        _crosses,
        (
            TRUE._replace(restitution="1/10"),
            TRUE._replace(away=TRUE.away[:2]),
            TRUE._replace(away=(TRUE.away[0], ("1.7728431669", "0.4281979913"), TRUE.away[2])),
            TRUE._replace(saddle=("0.2757899", "0.3556722")),
            TRUE._replace(angle="0.0000000000"),
            TRUE._replace(restitution="0.8000001"),
        ),
    ),
    "b:horseshoe": Encoding(
        CHAOS,
        _chaotic,
        (("1/10", *CHAOS[1:]), ("4/5", (1, 16), "0.1256"), ("4/5", (2, 17), "0.1256"), ("4/5", (1, 17), "0.1257")),
    ),
}
