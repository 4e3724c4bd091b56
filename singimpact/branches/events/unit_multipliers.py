"""Kinds that a multiplier on the unit circle decides, and the first coefficients of the normal forms of two of them.

    period doubling w -> -w + c w^3,    Neimark-Sacker z -> z e^(i theta) (1 + a |z|^2),  a complex

The formulas are those of Kuznetsov (Elements of Applied Bifurcation Theory, 5.4), for closing conditions F(s, P(s)) = 0
of all states s in place of the return map P itself: with J(mu) of `closing.Loop`, J(mu) q = 0, p J(mu) = 0 and the
derivatives B and C of F, of order two and three, along Q = (q, mu q),

    -mu' (p . (C(Q, Q, Q') / 2 + B(Q', h_20) / 2 + B(Q, h_11))) / (p . wrap q)

is a, where ' is the complex conjugate; of a doubling, where mu = -1, it is -3 c.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.branches.closing import Closing, Loop
from singimpact.branches.events.kind import CurveLook, OrbitState, ReturnMapKind
from singimpact.branches.orbits import PeriodicOrbit
from singimpact.branches.solutions import AnyClosing, closing_of, point_of

NEAR = 1e-3  # distance of a multiplier of a limit cycle from that of its event
ROUNDING = 1e-9  # of the difference of two terms, of their sizes
# Steps along Q, in scaled unknowns, of the differences of D F, which is exact to rounding: a difference of the eighth
# order has an error of 1e-9 or less where it and that of half the step agree.
STEPS = (1e-2, 5e-3)
FIRST, SECOND = (4 / 5, -1 / 5, 4 / 105, -1 / 280), (8 / 5, -1 / 5, 8 / 315, -1 / 560)


class NormalForm(NamedTuple):
    """A coefficient, for q of length 1 in the (tau, v) of the first impact, and an estimate of its error."""

    value: float
    error: float


class MultiplierKind(ReturnMapKind):
    """A kind at which a real multiplier passes 1 or -1: 1 - mu t + d vanishes, t the trace of M, d its determinant."""

    multiplier = 1.0

    def occurs(self, loop: Loop) -> bool:
        """Whether the multiplier is there; det J(mu) of a limit cycle vanishes at its graze too."""
        return loop.clocked or bool(abs(loop.multipliers()[0] - self.multiplier) < NEAR)

    def equation(self, state: OrbitState) -> float:
        """det J(mu) of `closing.Loop`, of scaled unknowns."""
        return state.determinant(self.multiplier)

    def of_return_map(self, total: Any) -> Any:
        """1 - mu t + d."""
        return 1 - int(self.multiplier) * trace(total) + total.det()

    def rate_of_return_map(self, total: Any, change: Any) -> Any:
        """Its rate."""
        return -int(self.multiplier) * trace(change) + rate_of_determinant(total, change)


def trace(matrix: Any) -> Any:
    """The trace of a matrix of balls."""
    return matrix[0, 0] + matrix[1, 1]


def rate_of_determinant(total: Any, change: Any) -> Any:
    """The rate of the determinant where the matrix changes at a rate."""
    return (
        change[0, 0] * total[1, 1]
        + total[0, 0] * change[1, 1]
        - change[0, 1] * total[1, 0]
        - total[0, 1] * change[1, 0]
    )


class Fold(MultiplierKind):
    """Saddle-node bifurcation: a multiplier is 1.

    Its test is the component of the tangent by the parameter; on a curve, and in a proof, 1 - t + d.
    """

    name = "fold"
    word = "fold (saddle-node bifurcation)"
    marker = "o"
    look = CurveLook("blue", "solid", 2.8)
    may_meet = True
    multiplier = 1.0
    proof = "the orbits form one curve, on which the parameter turns back once: a multiplier is 1"

    def test(self, state: OrbitState) -> float:
        """The last component of the tangent."""
        return float(state.tangent[-1])

    def degenerate(self, state: OrbitState, gradient: Callable[[], Array]) -> dict[str, float]:
        """A cusp, a doubling at the fold, a second multiplier that is 1, an impact that grazes."""
        size = 2 * state.closing.n
        # at a fold the conditions have a null vector; at a cusp it is tangent to the curve of folds (Kuznetsov, ch. 8)
        vector = np.linalg.svd(state.loop.slope[:, :size] * state.scales[:size])[2][-1]
        slope = gradient()[:size] * state.scales[:size]
        turned = vector if vector[int(np.argmax(np.abs(vector)))] > 0 else -vector
        tests = {"cusp": float(slope @ turned), "fold and doubling": state.determinant(-1.0)}
        return tests | {"1:1 resonance": NEIMARK_SACKER.distinct(state)} | super().degenerate(state, gradient)


FOLD = Fold()


class PeriodDoubling(MultiplierKind):
    """Flip bifurcation: a multiplier is -1.

    Its test is det J(-1) of `closing.Loop`; in a proof 1 + t + d.
    """

    name = "period-doubling"
    word = "period doubling (flip bifurcation)"
    label = "doubling"
    marker = "s"
    look = CurveLook("vermillion", "dashes", 1.8)
    gentle = 1
    multiplier = -1.0
    proof = (
        "the orbits form one curve, on which 1 + trace + determinant of the return map vanishes once, at a rate that "
        "is not 0: a multiplier is -1"
    )

    def test(self, state: OrbitState) -> float:
        """det J(-1)."""
        return state.characteristic.doubling

    def others(self, orbit: PeriodicOrbit, over: str, parameter: float) -> list[PeriodicOrbit]:
        """The orbit of 2n impacts in 2k periods next to the doubling."""
        from singimpact.branches.branch_points import doubled

        return doubled(orbit, over, parameter)

    def degenerate(self, state: OrbitState, gradient: Callable[[], Array]) -> dict[str, float]:
        """A fold at the doubling, a second multiplier that is -1, a coefficient of 0, an impact that grazes."""
        tests = {"fold and doubling": state.determinant(1.0), "1:2 resonance": NEIMARK_SACKER.distinct(state)}
        return (
            tests
            | {"generalized flip": coefficient(state.closing, state.at, True)}
            | super().degenerate(state, gradient)
        )


PERIOD_DOUBLING = PeriodDoubling()


class NeimarkSacker(ReturnMapKind):
    """Neimark-Sacker bifurcation: the product of two complex multipliers is 1.

    Its test is the determinant of the return map less 1, times the last coefficient of det J(mu); in a proof 1 - d,
    where t^2 < 4 d.
    """

    name = "torus"
    word = "Neimark-Sacker bifurcation (torus)"
    marker = "D"
    look = CurveLook("purple", "solid", 1.8)
    conserved = True
    gentle = -1
    proof = (
        "the orbits form one curve, on which the product of two complex multipliers passes 1 once, at a rate that is "
        "not 0"
    )

    def test(self, state: OrbitState) -> float:
        """The first coefficient of det J(mu) less the last."""
        return state.characteristic.torus

    def size(self, state: OrbitState) -> float:
        """The sum of the sizes of both coefficients."""
        return abs(state.characteristic.zero) + abs(state.characteristic.two)

    def occurs(self, loop: Loop) -> bool:
        """Where the multipliers are complex: real ones whose product is 1 are no bifurcation."""
        return loop.characteristic().are_complex

    def distinct(self, state: OrbitState) -> float:
        """The product of the multipliers less 1, by its sign; 0 where it is rounding, as of models without losses."""
        test = self.test(state) * float(np.sign(state.characteristic.two))  # both coefficients change sign at a graze
        return test if abs(test) > ROUNDING * self.size(state) else 0.0

    def equation(self, state: OrbitState) -> float:
        """The test function of scaled unknowns."""
        return 2 * state.determinant(0.0) - (state.determinant(1.0) + state.determinant(-1.0)) / 2

    def degenerate(self, state: OrbitState, gradient: Callable[[], Array]) -> dict[str, float]:
        """Strong resonances, by the trace, a coefficient of 0, an impact that grazes."""
        _, one, two = state.characteristic
        tests = {f"1:{q} resonance": one + cosine * two for q, cosine in ((1, 2), (2, -2), (3, -1), (4, 0))}
        # the coefficient of a neutral saddle, whose multipliers are real, has no meaning
        cubic = coefficient(state.closing, state.at, False) if state.characteristic.are_complex else np.nan
        return tests | {"Chenciner": cubic} | super().degenerate(state, gradient)

    def of_return_map(self, total: Any) -> Any:
        """1 - d."""
        return 1 - total.det()

    def rate_of_return_map(self, total: Any, change: Any) -> Any:
        """Its rate."""
        return -rate_of_determinant(total, change)

    def refusal(self, total: Any) -> str:
        """Whether the multipliers are shown to be complex."""
        return "" if trace(total) ** 2 < 4 * total.det() else "the multipliers are not shown to be complex"


NEIMARK_SACKER = NeimarkSacker()


def normal_form(orbit: PeriodicOrbit, gentle: int) -> NormalForm:
    """The first coefficient at an event of a kind, whose `gentle` tells doublings from tori and from other kinds."""
    if not gentle or not orbit.n:
        return NormalForm(np.nan, np.nan)
    closing = closing_of(orbit.oscillator, orbit.word, orbit.k, ())
    coarse, fine = (coefficient(closing, point_of(closing, orbit), gentle > 0, step) for step in STEPS)
    return NormalForm(fine, abs(fine - coarse))


@np.errstate(divide="ignore", invalid="ignore")
def coefficient(closing: AnyClosing, at: Array, flips: bool, step: float = STEPS[1]) -> float:
    """The first coefficient of the normal form, c where the period doubles, else the real part of a.

    Parameters
    ----------
    at : the point of an orbit of which a multiplier is -1, or two have the product 1. step : of the differences.

    Returns
    -------
    float : nan of limit cycles, of orbits without impact, and where a flight beside the orbit leaves the domain of f.
    """
    from singimpact.branches.branch_points import repeated

    n, loop = closing.n, closing.at(at)
    if not isinstance(closing, Closing) or not closing.clocked or not np.isfinite(loop.slope).all():
        return np.nan
    first = loop.multipliers()[0]
    mu = -1.0 if flips else complex(first.real, abs(first.imag)) / abs(first)
    left, _, right = np.linalg.svd(loop.at_multiplier(mu))
    p, q = left[:, -1].conj(), right[-1].conj() / np.linalg.norm(right[-1][[0, n]])
    twice = closing_of(closing.family.osc, 2 * closing.word, 2 * closing.k, closing.over)
    point = repeated(closing, twice, at)

    def both(states: Array, multiplier: complex) -> Array:
        return np.concatenate([states[:n], multiplier * states[:n], states[n:], multiplier * states[n:]])

    def slope(away: Array) -> Array:
        return twice.at(point + np.append(away, np.zeros(len(at) - 2 * n))).slope[: 2 * n, : 4 * n]

    Q, scales = both(q, mu), twice.scales(point)[: 4 * n]
    B, C = differences(slope, Q.real, scales, step)  # B(Q, .) and C(Q, Q', .)
    if not flips:
        across = differences(slope, Q.imag, scales, step)
        B, C = B + 1j * across[0], C + across[1]
    h_20 = both(np.linalg.pinv(loop.at_multiplier(mu * mu)) @ (-B @ Q), mu * mu)
    h_11 = both(np.linalg.pinv(loop.at_multiplier(1.0)) @ (-B @ Q.conj()), 1.0)
    cubic = p @ (C @ Q / 2 + B.conj() @ h_20 / 2 + B @ h_11) / (p @ loop.wrap @ q)
    return float((np.conj(mu) * cubic).real) / 3 if flips else -float((np.conj(mu) * cubic).real)


def differences(slope: Callable[[Array], Array], along: Array, scales: Array, step: float) -> tuple[Array, Array]:
    """The first and second derivative of a matrix along a direction, by central differences of the eighth order."""
    share = step / max(float(np.abs(along / scales).max()), 1e-300)
    ahead, behind = (np.array([slope(sign * i * share * along) for i in range(1, 5)]) for sign in (1, -1))
    first = np.tensordot(FIRST, ahead - behind, 1) / share
    second = (np.tensordot(SECOND, ahead + behind, 1) - 2 * sum(SECOND) * slope(0 * along)) / share**2
    return first, second
