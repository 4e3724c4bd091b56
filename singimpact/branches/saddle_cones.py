"""W^u and W^s next to a saddle as graphs in narrow wedges, proved by cones.

    z = p + xi e_u + eta e_s,      N = {|xi| <= a, |eta| <= a},      R = G^n less k periods,      M in E^-1 D R(N) E

p is the saddle, E = (e_u, e_s) are vectors next to its eigenvectors. R(z) - R(z') = E M E^-1 (z - z') with an M in the
hull of the derivatives over N, which is convex. If for every such M

    |m21| + L_u |m22| <= L_u (|m11| - L_u |m12|),      |m11| - L_u |m12| > 1,

R maps the cone |eta| <= L_u |xi| into itself and stretches it. Images of a short piece of W^u at p have tangents in it
and grow until they are a graph eta = w(xi), |xi| <= a, |w'| <= L_u. If moreover

    |m12| + L_s |m22| + L_s^2 |m21| <= L_s |m11|,   |m11| - |m12|/L_s > 1,   |m11| - |m12| > 1,   |m21| + |m22| < 1,

the complement |xi| >= L_s |eta| of the other cone is mapped into itself and stretched, and R(N) crosses N from side to
side. So each segment eta = const has one point whose images stay in N, any two such points differ by a vector of the
cone |xi| <= L_s |eta|, and with |m22| + L_s |m21| < 1 they converge to p: they are the graph xi = w(eta) of W^s. Both
graphs are pieces of smooth manifolds, so |w'| <= L holds at every point.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import frexp
from typing import Any

from singimpact.algebra import as_rational, exact
from singimpact.branches.ball_closing import POINT, EnclosedMap
from singimpact.branches.krawczyk import enclosed_orbit, upper
from singimpact.branches.orbits import PeriodicOrbit
from singimpact.flights import ProvedImpact, Refused
from singimpact.handed_on import flint
from singimpact.inputs import need

Pair = tuple[Fraction, Fraction]


@dataclass(frozen=True)
class Wedge:
    """The cone conditions that are proved of the box |xi|, |eta| <= reach at a saddle.

    Attributes
    ----------
    unstable : L_u, of W^u: |w'| <= L_u, so |w(xi)| <= L_u |xi|. stable : L_s of W^s.
    expansion : least factor by which R stretches xi in both cones. contraction : largest factor of eta on W^s.
    """

    reach: Fraction
    unstable: Fraction
    stable: Fraction
    expansion: float
    contraction: float


class Cones:
    """Coordinates at a saddle, and the wedges in which its manifolds lie.

    Parameters
    ----------
    saddle : the orbit. digits : of its states. bits : of the balls.

    Raises
    ------
    Refused : the orbit is not proved, or not to be a saddle.
    """

    def __init__(self, saddle: PeriodicOrbit, digits: int, bits: int) -> None:
        self.saddle, self.map = saddle, EnclosedMap(saddle.oscillator, digits, bits)
        proved_orbit = enclosed_orbit(saddle.oscillator, saddle.tau, saddle.v, saddle.k, digits)
        if isinstance(proved_orbit, str):
            raise Refused(f"the saddle is not proved: {proved_orbit}")
        self.orbit = proved_orbit
        # tau and v of p, and their radii
        self.centre: Pair = (exact("tau", self.orbit.tau[0].value), exact("v", self.orbit.v[0].value))
        self.radii: Pair = (exact("tau", self.orbit.tau[0].radius), exact("v", self.orbit.v[0].radius))
        self.frame = _eigenvectors(self._derivative(self.radii))
        self._known: dict[Fraction, Wedge] = {}

    @cached_property
    def coordinates(self) -> list[list[Fraction]]:
        """E^-1."""
        (a, b), (c, d) = self.frame
        det = a * d - b * c
        return [[d / det, -b / det], [-c / det, a / det]]

    def state(self, xi: Fraction, eta: Fraction, spread: Pair = (Fraction(0), Fraction(0))) -> tuple[Pair, Pair]:
        """Centre and radii of a box that contains p + E (xi, eta), each coordinate with a spread."""
        (a, b), (c, d) = self.frame
        middle = (self.centre[0] + a * xi + b * eta, self.centre[1] + c * xi + d * eta)
        radii = (
            self.radii[0] + abs(a) * spread[0] + abs(b) * spread[1],
            self.radii[1] + abs(c) * spread[0] + abs(d) * spread[1],
        )
        return middle, radii

    def wedge(self, reach: Fraction) -> Wedge:
        """The wedge of both manifolds for |xi|, |eta| <= reach, or a little more.

        Raises
        ------
        Refused : the conditions do not hold over that box; the one that fails.
        """
        rounded = Fraction(2) ** frexp(float(reach))[1] if reach else Fraction(0)
        if rounded not in self._known:
            self._known[rounded] = self._shown(rounded)
        return self._known[rounded]

    def _shown(self, reach: Fraction) -> Wedge:
        spread = self.state(Fraction(0), Fraction(0), (reach, reach))[1]
        M = self.matrix(self.coordinates) * self._derivative(spread) * self.matrix(self.frame)
        (m11, m12), (m21, m22) = [[abs(entry) for entry in row] for row in M.table()]
        far, m12, m21, m22 = flint.arb(m11.lower()), *(flint.arb(entry.upper()) for entry in (m12, m21, m22))
        need(far > 1, Refused("the return map is not shown to stretch next to the saddle"))
        least = self.map.balls.rational(Fraction(1, 2**self.map.balls.bits))
        L_u, L_s = (flint.arb((2 * entry / (far - 1) + least).upper()) for entry in (m21, m12))
        expansion, contraction = far - L_u * m12, m22 + L_s * m21
        other = far - m12 / L_s
        conditions = {
            "the unstable cone is not mapped into itself": m21 + L_u * m22 < L_u * expansion,
            "the unstable cone is not stretched": expansion > 1,
            "the stable cone is not mapped into itself": m12 + L_s * m22 + L_s * L_s * m21 < L_s * far,
            "vectors outside the stable cone are not stretched": other > 1,
            "W^s is not shown to contract": contraction < 1,
            "the image of the box does not cross it": far - m12 > 1 and m21 + m22 < 1,
            "the cones are wider than the box": L_u < 1 and L_s < 1,
        }
        for why, holds in conditions.items():
            if not holds:
                raise Refused(f"{why}, within {float(reach):.1g} of the saddle")
        factors = (float(min(expansion.lower(), other.lower())), float(contraction.upper()))
        return Wedge(reach, upper(L_u), upper(L_s), *factors)

    def _derivative(self, radii: Pair) -> Any:
        """D R over the box of these radii round the saddle."""
        return derivative_over(self.map, self.centre, radii, int(self.saddle.n))

    def matrix(self, rows: Sequence[Sequence[Fraction]]) -> Any:
        """Rational rows as a matrix of balls."""
        return flint.arb_mat([[self.map.balls.rational(part) for part in row] for row in rows])


def derivative_over(flown: EnclosedMap, centre: Pair, radii: Pair, impacts: int) -> Any:
    """D G^m over a box, for m impacts, each shown to be smooth; a number that moves is the last unknown."""
    own = 2 + bool(flown.over)
    total = flint.arb_mat([[int(row == column) for column in range(own)] for row in range(own)])
    for _ in range(impacts):
        hit = smooth(flown(centre, radii), invertible=not flown.over)
        total = flint.arb_mat([*hit.derivative, [0, 0, 1]][:own]) * total
        centre = as_rational(hit.tau), as_rational(hit.v)
        radii = upper(hit.tau - hit.tau.mid()), upper(hit.v - hit.v.mid())
    return total


def image_of(flown: EnclosedMap, centre: Pair, impacts: int) -> tuple[Any, Any]:
    """Balls of tau and v of a state after some impacts."""
    radii = POINT
    for _ in range(impacts):
        hit = flown(centre, radii)
        centre = as_rational(hit.tau), as_rational(hit.v)
        radii = upper(hit.tau - hit.tau.mid()), upper(hit.v - hit.v.mid())
    return hit.tau, hit.v


def smooth(hit: ProvedImpact, invertible: bool = True) -> ProvedImpact:
    """The impact, if G is shown to be smooth, or a local diffeomorphism, at every launch of its box.

    Raises
    ------
    Refused : x' may vanish at the hit, v after it, or det D G.
    """
    (a, b, *_), (c, d, *_) = hit.derivative
    if not (hit.velocity < 0 and hit.v > 0):
        raise Refused("a flight next to the orbit is not shown to hit with x' < 0 and to leave with v > 0")
    if invertible and ((a * d - b * c).contains(0) or not (a * d - b * c).is_finite()):
        raise Refused("G is not shown to be invertible next to the orbit")
    return hit


def _eigenvectors(matrix: Any) -> list[list[Fraction]]:
    """Columns next to the eigenvectors of the multipliers outside and inside the unit circle, of largest entry 1."""
    a, b, c, d = (entry.mid() for entry in matrix.entries())
    half = (a + d) / 2
    under = half * half - (a * d - b * c)
    need(under > 0, Refused("the multipliers are not shown to be real and different"))
    far = half + under.sqrt() if half > 0 else half - under.sqrt()
    near = (a * d - b * c) / far
    columns = []
    for other in (near, far):  # a column of (matrix - other) is an eigenvector of the eigenvalue that is not `other`
        pairs = [(as_rational(a - other), as_rational(c)), (as_rational(b), as_rational(d - other))]
        vector = max(pairs, key=lambda pair: abs(pair[0]) + abs(pair[1]))
        largest = max(map(abs, vector))
        columns.append([entry / largest for entry in vector])
    return [[columns[0][row], columns[1][row]] for row in (0, 1)]
