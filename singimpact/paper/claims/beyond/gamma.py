"""Theorems t:t2 and t:t3 with numbers: gamma of x'' + x = cos 2t at a tangency and at a swan, and of a Duffing model.

`b:gamma-tangency`, `b:gamma-swan` : one restitution. `b:gamma-interval` : all restitutions of an interval at once.
`b:gamma-nonlinear` : a damped Duffing oscillator.
How it is proved: `dynamics.gamma_proof`; longer intervals of r: `osc.certified_gamma(restitution=)`.
"""

from fractions import Fraction
from itertools import pairwise
from typing import NamedTuple

from singimpact.algebra.numbers import exact
from singimpact.dynamics.gamma_proof.proof import CertifiedGamma, certified_gamma
from singimpact.inputs import InputError
from singimpact.oscillator.model import Oscillator
from singimpact.paper.claims.claim import Check, Encoding
from singimpact.paper.claims.verifiers import every

BEFORE = 2  # a phase with a_c < 0 between the zero before tau_* and tau_*, at c = 0.3 and at c = 1


class Stated(NamedTuple):
    """A statement about x'' + f = cos 2t.

    Attributes
    ----------
    clearance, restitution : of the model. order : of contact. reach : of S, which is tan(tau_* - tau) for f = x and
        tau_* - tau for others. velocity : on gamma at S = reach, and by how much it may differ. grows : distances
        across gamma grow by more than this, an impact.
    after : at a tangency the time after tau_* in which at most one impact comes; at a swan the launch speed dy/ds up to
        which chatter completes for all S <= reach; for a nonlinear f the launch speed up to which all this is shown.
    force : f.
    """

    clearance: str
    restitution: str
    order: int
    reach: str
    velocity: tuple[str, str]
    grows: str
    after: str
    force: str = "x"


def _certified(stated: Stated) -> Check:
    """Whether gamma is proved up to the reach, with these numbers; and what comes after tau_*."""
    try:
        osc = Oscillator(stated.force, "cos(2*t)", stated.clearance, stated.restitution)
        proof = certified_gamma(osc, BEFORE, reach=stated.reach)
    except InputError as reason:
        return Check(False, "certified", str(reason), {"fails": str(reason)})
    at, (velocity, off) = proof.at_reach(), map(Fraction, stated.velocity)
    close = abs(exact("value", at.value) - velocity) + exact("radius", at.radius) < off
    return every(
        [
            (f"tau_* = {proof.tau} is a zero of a_c of order {proof.order}", proof.order == stated.order),
            (
                f"for S <= {proof.reach} the drift lemma holds on {proof.boxes[0].boxes} boxes, the residual is below "
                f"{float(proof.boxes[0].R):.3g} S^6: gamma is one graph with |l - L(S)| <= {proof.Kl:.3g} S^6, below "
                "it chatter completes before tau_*, above it finitely many impacts come before tau_*",
                proof.reach == Fraction(stated.reach),
            ),
            (f"gamma has v = {at} at S = {proof.reach}", close),
            (f"distances across gamma grow by {proof.grow:.4g} per impact", proof.grow > float(stated.grows)),
            _after(proof, stated),
        ],
        "certified",
    )


def _after(proof: CertifiedGamma, stated: Stated) -> tuple[str, bool]:
    """The proof of the time after tau_*, and whether it covers the statement."""
    if proof.lost:
        time = proof.lost.time
        return f"after tau_* at most one impact comes within {float(time):.6g}", time >= Fraction(stated.after)
    if proof.fastest:
        fastest = exact("fastest", proof.fastest.value) - exact("radius", proof.fastest.radius)
        return f"for every launch speed up to {float(fastest):.3g}", fastest >= Fraction(stated.after)
    if proof.settled is None:
        return "what comes after tau_* is not decided", False
    launch, speed, _, end = proof.settled
    return (
        f"above gamma, with dy/ds <= {float(speed):.3g} and S <= {launch}, tau_* is passed, chatter completes before "
        f"s = {end}",
        launch >= Fraction(stated.reach) and speed >= Fraction(stated.after),
    )


def _for_all(stated: tuple[str, tuple[str, str], str, str]) -> Check:
    """(c, (low, high), reach, K): gamma is proved for all these r, with |l - L(S)| <= K S^6."""
    clearance, between, reach, bound = stated
    try:
        osc = Oscillator("x", "cos(2*t)", clearance, between[0])
        proof = certified_gamma(osc, BEFORE, reach=reach, restitution=between)
    except InputError as reason:
        return Check(False, "certified", str(reason), {"fails": str(reason)})
    touch = all(one.high == other.low for one, other in pairwise(proof.boxes))
    return every(
        {
            f"{len(proof.boxes)} boxes of lambda touch, and hold that of every r in {list(between)}": touch,
            f"the lemmas hold for S <= {proof.reach} on each of them": proof.reach == Fraction(reach),
            f"|l - L(S)| <= {proof.Kl:.3g} S^6 on gamma": proof.Kl <= float(bound),
        },
        "certified",
    )


TANGENCY = Stated("3/10", "1/2", 1, "1/4", ("0.0177931543", "1e-4"), "1.8", "1.25")
SWAN = Stated("1", "1/2", 2, "1/4", ("0.0031225", "1e-5"), "1.8", "0.00317")
DUFFING = Stated("3/10", "1/2", 1, "1/4", ("0.01857755", "1e-4"), "1.8", "4", "x + x**3/5 + xdot/10")
INTERVAL = ("3/10", ("0.48", "0.52"), "1/4", "0.5")

CLAIMS = {
    "b:gamma-tangency": Encoding(
        TANGENCY,
        _certified,
        (
            TANGENCY._replace(reach="9/10"),
            TANGENCY._replace(velocity=("0.0181", "1e-4")),
            TANGENCY._replace(restitution="0.51"),
            TANGENCY._replace(grows="2.2"),
            TANGENCY._replace(order=2),
            TANGENCY._replace(after="1.27"),
        ),
    ),
    "b:gamma-swan": Encoding(
        SWAN,
        _certified,
        (
            SWAN._replace(reach="9/10"),
            SWAN._replace(velocity=("0.00325", "1e-5")),
            SWAN._replace(clearance="9/10"),
            SWAN._replace(after="0.01"),
        ),
    ),
    "b:gamma-interval": Encoding(
        INTERVAL, _for_all, (("3/10", ("0.48", "0.52"), "9/10", "0.5"), ("3/10", ("0.48", "0.52"), "1/4", "0.05"))
    ),
    "b:gamma-nonlinear": Encoding(
        DUFFING,
        _certified,
        (
            DUFFING._replace(reach="9/10"),
            DUFFING._replace(velocity=("0.0189", "1e-4")),
            DUFFING._replace(restitution="0.51"),
            DUFFING._replace(after="400"),
            DUFFING._replace(force="x + x**3/4 + xdot/10"),
        ),
    ),
}
