"""Check that gamma exists before a contact point, is the only invariant arc there, and decides every launch's fate.

Launches (S, l), 0 < S <= s0: see `gravity`, and `nonlinear` for a certificate that names the fastest launch.
L(S) = lambda + L_1 S + ... annuls E(S) = l^(j+1) (1-L(lS)) W(lS, L(lS)) - r (1-l) U(S, l), l = L(S), below order N, so
E <= R S^N.  With q = (1-l)/(1-L(S)), K = (1-L(lS))/(1-L(S)) and m = 1-(1-l) K three things are shown for all lambda of
a box.

1. l^(j+1) K W(lS, m)/U(S, l) increases in l: its logarithmic derivative times l is positive.  So q decreases where
   l > L + k S^N and increases where l < L - k S^N, k = R/(slope U) with bounds on the strip |l - L| <= eta.
2. Kl >= k max(G)/G, G = (1-L(S))/(1-lambda), and the strip is wider than Kl S^N.  Orbits that start with
   |l - L| > Kl S^N have |1-q| > Kl S^N/((1-lambda) max(G)); this gives what 1 asks, and stays true as |1-q| increases
   and S decreases.
3. The relation of two flights, F(S, y, y1) = 0, y = l - L(S), maps the cones |dS| <= M |dy| of the strip into
   themselves and expands them.

From these: below, chatter completes before tau; above, finitely many impacts come before tau; between them lies one
Lipschitz graph.  Every r of an interval has its lambda in one of the boxes, as r(lambda) is continuous.

For linear models the same is shown once more, by lemmas that the first program does not have, where the first of them
holds.

4. ln |A| is concave before tau.  A flight of length t lands at the distance e with the speed V, the mean over it of
   (t-w) A(e+w), and one of length t1 is launched there with L, that of (t1-w) A(e-w).  V_t and L_t1 are positive, and
   V_e/V, L_e/L are means of (ln A)' beyond e and before it.  So t1 rises as e falls and as t rises: orbits keep their
   order.  At each S the launches whose chatter completes before tau are the slow ones, those that pass tau the fast
   ones, two open sets.  Two orbits between them would tend to tau, while their distance does not fall: there is one.
5. The flights from L(S) +- Kl S^N land on the sides of the same curves on which they start, and their lengths rise with
   S.  By the order all launches beyond them do so: the one between lies between the two curves.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from operator import add, mul
from typing import Any

from flint import arb, arb_poly

from .formulas import Clock, Refused, Wrong, ball, need
from .gravity import Gravity, contact, require_after
from .motion import Model, compared, lies_within, size, within
from .nonlinear import Flights

NOT_SHOWN = arb(-1)  # no bound above 0
SHARE = 4  # a box of this part of S and l is halved no further than 2^-40


class Folded:
    """Polynomials in d, |d| <= h, whose coefficients are polynomials in S; what exceeds d^m or S^D becomes a ball."""

    def __init__(self, D: int, s0: Any, h: Any, m: int) -> None:
        self.D, self.s0, self.m = D, s0, m
        self.d = [within(h**k) if k else arb(1) for k in range(2 * m + 1)]

    def __call__(self, *parts: Any) -> Part:
        """The element with these coefficients of powers of d."""
        return Part(
            self,
            [part if isinstance(part, arb_poly) else arb_poly([part]) for part in parts]
            + [arb_poly([0])] * (self.m + 1 - len(parts)),
        )

    def folded(self, p: Any) -> Any:
        c = p.coeffs()
        if len(c) <= self.D + 1:
            return p
        last = c[self.D]
        for i in range(self.D + 1, len(c)):
            last = last + c[i] * arb(0).union(self.s0 ** (i - self.D))
        return arb_poly([*c[: self.D], last])

    def residual(self, o: Gravity | Flights, L: list[Part], r: Part) -> Any:
        L, S, r = [Part(self, part.parts) for part in L], self(arb_poly([0, 1])), Part(self, r.parts)
        here = composed(L, S)
        S1 = S * here
        there = composed(L, S1)
        launch = (there * -1 + 1) * o.folded(self, S1, there)[0] * here ** (o.j + 1)
        return launch + r * ((here * -1 + 1) * o.folded(self, S, here)[1]) * -1


class Part:
    """An element of these polynomials."""

    def __init__(self, ring: Folded, parts: list[Any]) -> None:
        self.ring, self.parts = ring, parts

    def __add__(self, other: Any) -> Part:
        parts = other.parts if isinstance(other, Part) else [arb_poly([other])]
        return Part(self.ring, [*map(add, self.parts, parts), *self.parts[len(parts) :]])

    def __mul__(self, other: Any) -> Part:
        if not isinstance(other, Part):
            return Part(self.ring, [polynomial * other for polynomial in self.parts])
        ring = self.ring
        parts = [arb_poly([0]) for _ in range(2 * ring.m + 1)]
        for a, left in enumerate(self.parts):
            for b, right in enumerate(other.parts):
                parts[a + b] = parts[a + b] + left * right
        for k in range(ring.m + 1, 2 * ring.m + 1):
            parts[ring.m] = parts[ring.m] + parts[k] * ring.d[k - ring.m]
        return Part(ring, [ring.folded(polynomial) for polynomial in parts[: ring.m + 1]])

    __radd__, __rmul__ = __add__, __mul__

    def __pow__(self, exponent: int) -> Any:
        return self * self ** (exponent - 1) if exponent else 1

    def over(self) -> Any:
        """The polynomial in S for all d."""
        return sum((part * self.ring.d[k] for k, part in enumerate(self.parts)), arb_poly([0]))

    def inverse(self) -> Any:
        """1/p for p without S: p = p_0 (1 + e), 1/(1 + e) = 1 - e + e^2 - e^3/(1 + e)."""
        first = 1 / self.parts[0][0]
        e = Part(self.ring, [arb_poly([0]), *(part * first for part in self.parts[1:])])
        return (e * -1 + e * e + e * e * e * (-1 / (1 + e.over()[0])) + 1) * first


def composed(L: list[Part], q: Part) -> Part:
    found = L[-1]
    for part in reversed(L[:-1]):
        found = found * q + part
    return found


def parts_of(j: int) -> tuple[list[int], list[int], list[int]]:
    """The coefficients of P_j, Q_j and Q_j'."""
    return [j + 1 - i for i in range(j + 1)], [i + 1 for i in range(j + 1)], [(i + 1) * i for i in range(1, j + 1)]


def restitution(j: int, x: Any) -> Any:
    """r = lambda^(j+1) P_j/Q_j."""
    P, Q, _ = parts_of(j)
    return x ** (j + 1) * arb_poly(P)(x) / arb_poly(Q)(x)


class Box:
    """The series for all lambda of a box."""

    def __init__(self, o: Gravity | Flights, content: dict[str, Any], r: Any, ordered: bool = False) -> None:
        self.o, self.content, self.ordered, j = o, content, ordered, o.j
        self.N, D, self.pieces = (int(content[name]) for name in ("N", "D", "pieces"))
        low, high = (ball(Fraction(end)) for end in content["lambda"])
        need("orders", self.N < D <= o.K - j, "N < D is asked of a box, and D within the series of the flights")
        self.high, self.eta, self.slope = high, *(ball(Fraction(content[name])) for name in ("eta", "M"))
        centre = arb(((low + high) / 2).mid())
        h, m = size((low - centre).union(high - centre)), 0 if r is not None else 2
        rings = [Folded(n + 1, o.s0, h, m) for n in range(self.N)] + [Folded(D, o.s0, h, m)]
        make = rings[0]
        lam = make(centre, arb(1)) if m else make(low.union(high))
        powers = [make(arb(1))]
        for _ in range(j + self.N + 1):
            powers.append(powers[-1] * lam)
        P, Q, dQ = (sum(map(mul, powers, parts), make(arb(0))) for parts in parts_of(j))
        ratio = make(r) if r is not None else powers[j + 1] * P * Q.inverse()
        lead, gap = o.lead, lam * -1 + 1
        L = [lam]
        for n in range(1, self.N):
            factor = powers[j] * gap * P * (j + 1) + powers[j + 1 + n] * Q * -1 + ratio * (gap * dQ + Q * -1) * -1
            left = make(*(polynomial[n] for polynomial in rings[n].residual(o, L, ratio).parts))
            L.append(left * (factor * lead).inverse() * -1)
        self.take(rings[-1], L, ratio, gap.inverse())
        self.r = r if r is not None else ratio.over()[0]
        self.require_series(content["series"])

    def take(self, ring: Folded, L: list[Part], ratio: Part, inverse: Part) -> None:
        """L, (1 - L)/(1 - lambda) and the residual over the box, whose coefficients below N are 0: L is made so."""
        found = ring.residual(self.o, L, ratio).over()
        self.E = [found[i] for i in range(self.N, ring.D + 1)]
        self.L: Any = arb_poly([part.over()[0] for part in L])
        self.gap = arb_poly([1, *(-(part * inverse).over()[0] for part in L[1:])])

    def require_series(self, series: list[dict[str, str]]) -> None:
        """Refuse a series that is not the one of the box."""
        need("series", len(series) == self.N, "the series has another length")
        for n, coefficient in enumerate(series[: self.N]):
            need("L", lies_within(self.L[n], coefficient), f"L_{n} is {self.L[n].str(20)}")

    def steps(self) -> list[tuple[Any, Any]]:
        """Pieces of [0, s0]."""
        return list(pairwise(self.o.s0 * i / self.pieces for i in range(self.pieces + 1)))

    def drift(self, S: Any, x: Any) -> Any:
        """Lemma 1 on a box of S and l = x."""
        o, slopes = self.o, self.gap.derivative()
        S1, gap = x * S, self.gap(S)
        K, Kx = self.gap(S1) / gap, S * slopes(S1) / gap
        m = 1 - (1 - x) * K
        if not (K > 0 and -1 < m < 1.01):
            return NOT_SHOWN
        m = arb(m.lower()).union(arb(m.upper()).min(arb(1)))
        here, below = o.speeds(S, x), m.union(arb(0))
        _, U, _, _, _, Ux = here
        W, _, WS, _, Wx, _ = o.speeds(S1, m)
        if not (U > 0 and W > 0 and o.fall(here, x) > 0 and (m > 0 or o.fall(o.speeds(S1, below), below) > 0)):
            return NOT_SHOWN
        return (o.j + 1) + x * (Kx / K + (S * WS + (K - (1 - x) * Kx) * Wx) / W - Ux / U)

    def least_drift(self) -> Any:
        """Lemma 1 on the boxes that the certificate names."""
        least, half, todo = arb(9), arb(1) / 2, [(0, 0, 0, 0)]
        for letter in self.content["tree"]:
            if not todo:
                raise Wrong("the boxes of lemma 1 do not fit together")
            Clock.look()
            a, n, e, k = todo.pop()
            if n + k > 10 * SHARE:
                raise Wrong("a box of lemma 1 is too small")
            if letter == "S":
                todo += [(2 * a + 1, n + 1, e, k), (2 * a, n + 1, e, k)]
            elif letter == "l":
                todo += [(a, n, 2 * e + 1, k + 1), (a, n, 2 * e, k + 1)]
            else:
                S = (a * half**n).union((a + 1) * half**n) * self.o.s0
                drift = self.drift(S, (e * half**k).union((e + 1) * half**k))
                need("lemma 1", drift > 0, "lemma 1 is not shown on a box", Refused)
                least = least.min(arb(drift.lower()))
        need("covered", not todo, "the boxes of lemma 1 do not cover the square")
        return least

    def cones(self, a: Any, b: Any, R: Any, Kl: Any) -> tuple[Any, Any, Any, Any]:
        """Lemmas 3 and 5 on a piece: bounds of (H + r)/l, of U times 1 - l, of G, and of the growth."""
        Clock.look()
        o, j, eta, M, L = self.o, self.o.j, self.eta, self.slope, self.L
        S = (a - 2 * M * eta).max(arb(0)).union((b + 2 * M * eta).min(o.s0))
        y, dL = within(eta), self.L.derivative()
        x = L(S) + y
        S1 = x * S
        x1 = L(S1) + y
        G = self.gap(S)
        K = self.gap(S1) / G
        m = 1 - (1 - x) * K
        inside = 0 < x < 1 and 0 < x1 < 1 and -1 < m < 1
        there = o.speeds(S1, x1)
        W1, _, WS1, _, _, _ = there
        fall = o.fall(there, x1)
        _, U, _, US, _, Ux = o.speeds(S, x)
        rate = x**j * K * o.speeds(S1, m)[0] / U
        along = (1 - x1) * WS1 - fall * dL(S1)
        by_y1 = -(x ** (j + 1)) * fall
        by_l = (j + 1) * x**j * (1 - x1) * W1 + x ** (j + 1) * S * along - self.r * ((1 - x) * Ux - U)
        by_S = x ** (j + 2) * along - self.r * (1 - x) * US + by_l * dL(S)
        d, g, e = -by_l / by_y1, -by_S / by_y1, x + S * dL(S)
        barriers = Kl * -by_y1 * (d - x**self.N) > R and 1 - e > Kl * (self.N + 1) * S**self.N
        need(
            "Kl", barriers or not self.ordered, "lemma 5 is not shown: the curves beside gamma are no barriers", Refused
        )
        up = d - abs(g) * M
        # the cones are expanded nowhere on l = 0, by 1/0, and l = 1, by r - S L' where L first comes to 1 - eta
        expanded = inside and U > 0 and fall > 0 and up > 1 and M * up > abs(e) * M + S and e * d - g * S > 0
        need("cones", expanded, "lemma 3 is not shown: the cones are not expanded into themselves", Refused)
        return rate, (1 - x) * U, G, up

    def require(self) -> None:
        """Refuse the box unless the three lemmas hold with its numbers."""
        R, Kl, grow = (ball(Fraction(self.content[name])) for name in ("R", "Kl", "grow"))
        for a, b in self.steps():
            E, S = arb(0), a.union(b)
            for coefficient in reversed(self.E):
                E = E * S + coefficient
            error = Refused if abs(E).overlaps(R) else Wrong
            need("residual", abs(E) <= R, f"the residual is not shown to be below {R.str(8)}", error)
        least = self.least_drift()
        bounds = [self.cones(a, b, R, Kl) for a, b in self.steps()]
        high = -lowest(-bound[2] for bound in bounds)
        push = lowest(lowest([rate]) * lowest([U]) * lowest([G]) for rate, U, G, _ in bounds)
        bounded = push > 0 and R * high / (least * push) <= Kl
        need("Kl", bounded, "Kl is not shown to bound the distance from the series")
        need("wide", Kl * self.o.s0**self.N < self.eta, "the strip is narrower than the bound")
        grown = lowest(bound[3] for bound in bounds) >= grow
        need("grow", grown, "that distances grow as fast as is written is not shown")

    def threshold(self, S: Any) -> Any:
        """The speed on gamma at S, as of y'."""
        x = self.L(S) + within(ball(Fraction(self.content["Kl"])) * S**self.N)
        return S ** (self.o.j + 1) * (1 - x) * self.o.speeds(S, x)[0]


def lowest(parts: Any) -> Any:
    found = arb(10) ** 9
    for part in parts:
        found = found.min(arb(part.lower()))
    return found


def invariant_arc(model: Model, content: dict[str, Any], bits: int) -> None:  # noqa: ARG001
    """Check that gamma is as the certificate says, for the r of the model or for all r of an interval."""
    j, reach = int(content["order"]), ball(Fraction(content["reach"]))
    tau = contact(model, content["tau"], j)
    o = Flights(model, tau, j, reach) if "fastest" in content else Gravity(model, tau, j, reach)
    if isinstance(o, Flights):
        fastest = ball(Fraction(content["fastest"]))
        need("slow", o.launched < fastest, "the launch speeds do not go beyond those of the flights that are enclosed")
        need("fastest", fastest <= o.fastest, "the launch speeds go beyond what is shown")
    cuts = [[Fraction(end) for end in box["lambda"]] for box in content["boxes"]]
    single = content["restitution"] == "model"
    r = model.ratio() if single else None
    ends: list[Any] = [r, r] if single else [ball(Fraction(end)) for end in content["restitution"]]
    if not all(0 < end < 1 for end in ends) or (single and len(cuts) != 1):
        raise Wrong("r must lie in (0, 1), and a model has one box")
    need("touch", all(one[1] == other[0] for one, other in pairwise(cuts)), "the boxes of lambda do not touch")
    all_in = restitution(j, ball(cuts[0][0])) <= ends[0] and ends[-1] <= restitution(j, ball(cuts[-1][1]))
    need("lambda", all_in, "the boxes of lambda do not contain the lambda of every r")
    ordered = isinstance(o, Gravity) and o.log_concave()
    boxes = [Box(o, numbers, r, ordered) for numbers in content["boxes"]]
    for box in boxes:
        box.require()
    if single:
        compared({"threshold": (boxes[0].threshold(reach) * o.factor(reach), content["threshold"])})
    if isinstance(o, Gravity):  # of others nothing may be said of the time after tau: see `schema`
        require_after(o, content, size(ends[-1]))
