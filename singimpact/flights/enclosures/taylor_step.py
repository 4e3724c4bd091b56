"""One step of a flight in balls: Taylor coefficients by Newton's method, and a bound of what they cut off.

P is the Taylor polynomial of z, of degree n, and F(s) = P'' + f(P, P') - g(t + s) its defect. F has a zero of order
n - 1 at 0. If f and g are analytic on the image of the disc |s| <= R and |F| <= M there, Schwarz's lemma gives
|F(s)| <= M (|s|/R)^(n-1). With |f_x| <= A and |f_v| <= B next to the step, Gronwall's lemma gives

    |z' - P'| <= K s^n,   |z - P| <= K s^(n+1)/(n+1),   K = M R^(1-n) e^(B h + A h^2/2)/n,   0 <= s <= h,

as soon as K h^n (1 + h) stays below the slack by which the box of A and B exceeds P. A column, the derivative psi of z
by a number it starts from, obeys the same bound with K_psi = (M_psi R^(1-n) + S) e^(B h + A h^2/2)/n. Its term S,
K (1 + h) h times second derivatives of f, is there since f_x and f_v are taken along P and not along z.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import ceil, log2
from typing import Any, NamedTuple

from singimpact.algebra.precision import balls_at
from singimpact.flights.enclosures.equation import Equation, NotAnalytic, Refused
from singimpact.flights.enclosures.tube import ball, upper
from singimpact.handed_on import flint
from singimpact.inputs import need


@dataclass(frozen=True)
class StepSettings:
    """Settings of the choice of a step.

    Parameters
    ----------
    degree : of the polynomial, a bit; 0.42 takes 1.2 times the time and 0.7 1.4 times.
    least_degree : whatever the bits. short_degree : of a step much shorter than `usual`, the part of a disc that is
        reached where f and g vary over lengths of 1; where they vary faster, such a step comes out too short.
    disc_bits : of the bounds; they are rounded outwards, and their digits do not matter.
    widest : radius of a disc at most, and at first where the last coefficients vanish.
    first : radius of the first disc, over the radius of convergence that the last coefficients suggest.
    shrink, grow : factor of the next disc, and of the first one over that of the last step.
    discs, boxes : tried at most.
    part : of the disc's radius that a step takes at most.
    """

    degree: float = 0.55
    least_degree: int = 12
    short_degree: int = 5
    usual: float = 0.4
    disc_bits: int = 64
    widest: float = 8.0
    first: float = 1.3
    shrink: float = 0.85
    grow: float = 1.4
    discs: int = 80
    boxes: int = 40
    part: float = 0.9


STEP = StepSettings()


class Column(NamedTuple):
    """A derivative of z: its start (psi, psi') and what drives it: -1 nothing, 0 the time, k the k-th name."""

    start: tuple[Any, Any]
    drive: int


@dataclass(frozen=True)
class Step:
    """Coefficients and bound of z and of its columns, valid up to a length."""

    coefficients: list[Any]
    bound: Any
    columns: list[list[Any]]
    column_bounds: list[Any]
    length: Any
    radius: Any


def degree_at(bits: int, expected: float = 0.0) -> int:
    """The degree of a step at a precision, lower where the step need not be longer than expected."""
    degree = max(STEP.least_degree, int(STEP.degree * bits))
    if not 0 < expected < STEP.usual / 4:
        return degree
    return min(degree, max(STEP.short_degree, ceil(bits / log2(STEP.usual / expected)) + 2))


def step(
    equation: Equation,
    state: tuple[Any, Any, Any],
    columns: Sequence[Column],
    bits: int,
    most: Any = None,
    removed: int = 1,
    expected: float = 0.0,
    last: Step | None = None,
) -> Step:
    """A step from (t, z, z'), each a ball.

    Parameters
    ----------
    columns : derivatives that are carried along. bits : the error is about 2^-bits of the step. most : its longest
        length. removed : how many of the first coefficients are 0 exactly; 1 unless the mass starts from rest.
    last : the step before, whose disc is near the right one.
    expected : the length that is needed, 0 where it is not known: a short one takes a lower degree.

    Raises
    ------
    Refused, NotAnalytic
    """
    try:
        return _made(equation, state, columns, bits, most, removed, degree_at(bits, expected), last)
    except (NotAnalytic, ValueError, ZeroDivisionError) as reason:  # flint raises where a series has no inverse
        if any(component.rad() > 2.0 ** (-bits / 4) for component in state):
            raise Refused("the ball of a state grew too wide on the way") from None
        raise NotAnalytic(str(reason)) from None


def _made(
    equation: Equation,
    state: tuple[Any, Any, Any],
    columns: Sequence[Column],
    bits: int,
    most: Any,
    removed: int,
    degree: int,
    last: Step | None,
) -> Step:
    """The step of a degree."""
    X = coefficients(equation, state, degree, removed)
    need(X[-1].is_finite(), NotAnalytic("f or g has no power series where the flight goes"))
    psi = [column(equation, state[0], X, start, degree) for start in columns]
    with balls_at(STEP.disc_bits):
        sums = [sums_of(polynomial) for polynomial in (X, *psi)]
        drives = [start.drive for start in columns]

        def defects(R: Any) -> list[Any] | None:
            return _defects(equation, state[0], X, psi, drives, sums, R)

        length, R, bounds = widest_disc(X, defects, bits, None if last is None else last.radius)
        if most is not None and length > most:
            length = most
        return _bounded(equation, state[0], (X, psi), drives, sums, (length, R, bounds), bits)


def coefficients(equation: Equation, state: tuple[Any, Any, Any], degree: int, removed: int = 1) -> list[Any]:
    """Taylor coefficients 0 to `degree` of z, by Newton's method: m of them give 2 m + 1.

    The residual of a polynomial comes from one evaluation over series; the linear equation of the correction is solved
    for the new coefficients one by one.
    """
    t, z, v = state
    g = drive(equation, t, degree)
    if equation.linear:
        return linear_coefficients(g[: degree - 1], equation.at_wall(), (z, v), removed)
    X, V = [z, v], [v]
    while len(X) <= degree:
        m = len(X) - 1
        # Newton's method on series doubles the number of right coefficients (Brent and Kung 1978)
        count = min(2 * m, degree - 1)
        f, by_x, by_v = (
            listed(series, count)
            for series in equation.run(
                "force",
                x=flint.arb_series(X, prec=count),
                xdot=flint.arb_series(V, prec=count),
                t=flint.arb_series([t, 1], prec=count),
            )
        )
        constant = all(coefficient.is_zero() for coefficient in by_v[1:])
        for k in range(m - 1, count):
            rest = g[k] - f[k] - sum(map(flint.arb.__mul__, by_x, X[k:m:-1]), flint.arb(0))
            if not constant:
                rest -= sum(map(flint.arb.__mul__, by_v, V[k : m - 1 : -1] if m else V[k::-1]), flint.arb(0))
            elif k >= m:
                rest -= by_v[0] * V[k]
            # the first ones of a mass at rest vanish exactly, where balls only contain 0
            X.append(flint.arb(0) if k + 2 < removed else rest / ((k + 1) * (k + 2)))
            V.append((k + 2) * X[-1])
    return X


def drive(equation: Equation, t: Any, count: int) -> list[Any]:
    """Taylor coefficients of g at a time."""
    return listed(equation.run("drive", t=flint.arb_series([t, 1], prec=count))[0], count)


def linear_coefficients(g: list[Any], force: list[Any], start: tuple[Any, Any], removed: int = 1) -> list[Any]:
    """Taylor coefficients of z where f is linear, two more than those of g.

    Parameters
    ----------
    force : f, f_x and f_v at rest on the wall. start : z and z'. removed : as for `coefficients`.
    """
    at_wall, k, d = force
    X, damped = list(start), not d.is_zero()
    for m, push in enumerate([g[0] - at_wall, *g[1:]]):
        rest = push - k * X[m]
        if damped:
            rest -= d * ((m + 1) * X[m + 1])
        X.append(flint.arb(0) if m + 2 < removed else rest / ((m + 1) * (m + 2)))
    return X


def column(equation: Equation, t: Any, X: list[Any], launch: Column, degree: int) -> list[Any]:
    """Taylor coefficients of a column along the polynomial with coefficients X."""
    V = [(k + 1) * coefficient for k, coefficient in enumerate(X[1:])]
    count = degree - 1
    clock = flint.arb_series([t, 1], prec=count)
    _, by_x, by_v, *pulls = (
        listed(series, count)
        for series in equation.run(
            "disc", x=flint.arb_series(X, prec=count), xdot=flint.arb_series(V, prec=count), t=clock
        )
    )
    driven = [flint.arb(0)] * count
    if launch.drive >= 0:
        driven = listed(equation.run("forcing", t=clock)[1 + launch.drive], count)
        driven = [a - b for a, b in zip(driven, pulls[launch.drive], strict=True)]
    return response(by_x, by_v, driven, launch.start)


def response(by_x: list[Any], by_v: list[Any], driven: list[Any], start: tuple[Any, Any]) -> list[Any]:
    """Taylor coefficients of the psi with psi'' + by_x psi + by_v psi' = driven, all lists, from (psi, psi')."""
    constant = all(coefficient.is_zero() for coefficient in by_v[1:])
    P, Q = [flint.arb(start[0]), flint.arb(start[1])], [flint.arb(start[1])]
    for k in range(len(driven)):
        rest = driven[k] - sum(map(flint.arb.__mul__, by_x, P[k::-1]), flint.arb(0))
        rest -= by_v[0] * Q[k] if constant else sum(map(flint.arb.__mul__, by_v, Q[::-1]), flint.arb(0))
        P.append(rest / ((k + 1) * (k + 2)))
        Q.append(rest / (k + 1))
    return P


def listed(series: Any, count: int) -> list[Any]:
    """The first coefficients of a series, or of a constant."""
    if not isinstance(series, flint.arb_series):
        return [flint.arb(series)] + [flint.arb(0)] * (count - 1)
    values = series.coeffs()
    return values[:count] if len(values) >= count else [*values, *[flint.arb(0)] * (count - len(values))]


def sums_of(X: list[Any]) -> tuple[Any, Any, Any]:
    """Polynomials in R that bound |P - P(0)|, |P' - P'(0)| and |P''| on the disc |s| <= R."""
    first = flint.arb_poly([0, *(upper(part) for part in X[1:])])
    second = first.derivative()
    return first, second - flint.arb_poly([second[0]]), second.derivative()


def widest_disc(
    X: list[Any], defects: Callable[[Any], list[Any] | None], bits: int, last: Any = None
) -> tuple[Any, Any, list[Any]]:
    """Length, R and the defects on that disc, where the step allowed is the longest.

    Parameters
    ----------
    X : coefficients of z. defects : of z first, on a disc; None where it is refused. last : R of the step before.
    """
    n = len(X) - 1
    size = upper(X[1]) + upper(X[2]) / 8 + upper(X[3]) / 64
    rates = [_root(upper(X[k]) / size, k) for k in (n - 2, n - 1, n)] if size > 0 else []
    # the coefficients decay like R^-k: the largest of the last three roots gives a first guess of the radius
    R = min(STEP.first / max(rates), STEP.widest) if max(rates, default=0) > 0 else STEP.widest
    if last is not None:
        R = min(R, STEP.grow * float(last))
    best: tuple[float, float, list[Any]] | None = None
    for _ in range(STEP.discs):
        bounds = defects(flint.arb(R))
        if bounds is not None:
            # Cauchy's bound of the cut-off at length h is about D R (h/R)^n/n: h where it is 2^-bits of the size
            ratio = size * n / (bounds[0] * R + size * flint.arb(2) ** -900)
            length = R * min(2.0 ** (-bits / n) * _root(ratio, n), STEP.part)
            if best is not None and length < best[0] * 1.01:
                break
            best = length, R, bounds
        R *= STEP.shrink
    if best is None or not best[0] > 0:
        raise NotAnalytic("f or g is analytic on no disc round the flight that was tried")
    return flint.arb(best[0]), flint.arb(best[1]), best[2]


def _root(value: Any, order: int) -> float:
    """About the k-th root of a ball, which itself may be out of the range of doubles."""
    return float((value.log() / order).exp()) if value > 0 else 0.0


def around(value: Any, width: Any) -> Any:
    """A complex ball that holds all numbers within a distance of a real ball."""
    return flint.acb(value + ball(width), ball(width))


def _defects(
    equation: Equation, t: Any, X: list[Any], psi: list[list[Any]], drives: list[int], sums: list[Any], R: Any
) -> list[Any] | None:
    """Bounds of the defects of z and of the columns on a disc; None where f or g is not shown analytic on its image."""

    def at(P: list[Any], totals: tuple[Any, Any, Any], order: int) -> Any:
        return around(P[order], totals[order](R))

    clock = around(t, R)
    f, by_x, by_v, *pulls = equation.run("disc", x=at(X, sums[0], 0), xdot=at(X, sums[0], 1), t=clock)
    g, *forced = equation.run("forcing", t=clock)
    inside = [f - g]
    for P, totals, drive in zip(psi, sums[1:], drives, strict=True):
        value = by_x * at(P, totals, 0) + by_v * at(P, totals, 1)
        if drive >= 0:
            value += pulls[drive] - forced[drive]
        inside.append(value)
    if not all(flint.acb(value).is_finite() for value in inside):
        return None
    return [upper(totals[2](R)) + upper(value) for totals, value in zip(sums, inside, strict=True)]


def _bounded(
    equation: Equation,
    t: Any,
    series: tuple[list[Any], list[list[Any]]],
    drives: list[int],
    sums: list[Any],
    disc: tuple[Any, Any, list[Any]],
    bits: int,
) -> Step:
    """The step on which the bounds are shown to hold, shortened until they do."""
    (X, psi), (length, R, defects), n = series, disc, len(series[0]) - 1
    slack = flint.arb(2) ** (-bits // 2)
    power = R ** (1 - n)
    for _ in range(STEP.boxes):
        names = {name: X[order] + ball(sums[0][order](length) + slack) for order, name in enumerate(("x", "xdot"))}
        by_x, by_v, *others = equation.run("box", **names, t=t + ball(length))
        A, B = upper(flint.arb(by_x)), upper(flint.arb(by_v))
        if A.is_finite() and B.is_finite():
            grown = (B * length + A * length**2 / 2).exp() / n
            bound = upper(defects[0] * power * grown)
            if bound * length**n * (1 + length) < slack:
                # |f_xx| + 2 |f_xv| + |f_vv|, and |f_px| + |f_pv| of t and each name
                sizes = [upper(flint.arb(other)) for other in others]
                second = sizes[0] + 2 * sizes[1] + sizes[2]
                mixed = [sizes[k] + sizes[k + 1] for k in range(3, len(sizes), 2)]
                bends = [
                    _bend(P, totals, second, mixed, drive, bound, length)
                    for P, totals, drive in zip(psi, sums[1:], drives, strict=True)
                ]
                if all(bend.is_finite() for bend in bends):
                    bounds = [upper((M * power + bend) * grown) for M, bend in zip(defects[1:], bends, strict=True)]
                    return Step(X, bound, psi, bounds, length, R)
        length = flint.arb(float(length) / 2)
    raise Refused("no step on which the bounds hold")


def _bend(
    P: list[Any], sums: tuple[Any, Any, Any], second: Any, mixed: list[Any], drive: int, bound: Any, length: Any
) -> Any:
    """The rest that f_x, f_v and f_p along P leave in the equation of a column, over s^(n-1)."""
    along = upper(P[0]) + sums[0](length) + upper(P[1]) + sums[1](length)
    total = second * along + (mixed[drive] if drive >= 0 else 0)
    return upper(total * bound * (1 + length) * length)
