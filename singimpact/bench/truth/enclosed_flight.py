"""First hits of x'' + f(x, x') = g(t) enclosed in balls, for any analytic f and g of the package's grammar.

A step starts from one exact point; how far the true state lies from it is carried as two bounds p >= |x - P|,
q >= |x' - P'|. With M >= |f(P, P') - g + P''| on |s| <= R, A >= |df/dx| and b <= df/dx' near the step,

    p' = q,        q' = A p - b q + M (s/R)^(n-1),

bounds both (the right side grows with the other unknown), and friction makes q shrink.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, NamedTuple

from flint import acb, arb, arb_mat, arb_poly, arb_series

from singimpact.algebra.derivatives import derivative
from singimpact.algebra.precision import balls_at, series_of_any_length
from singimpact.bench.truth.programs import Program
from singimpact.oscillator.model import Oscillator

# The first root of a polynomial that is known up to a bound, on pieces where its sign or its slope is certain.


class Refused(ArithmeticError):
    """A flight that balls of the precision at hand do not decide."""


def first_root(polynomial: Any, bounds: tuple[Any, Any], length: Any, bits: int) -> Any:
    """The first root on (0, length] of a function that is positive at 0, as a ball.

    Parameters
    ----------
    polynomial : within `bounds` of the function and of its slope.
    bits : a piece shorter than length 2^(-2 bits/3) that is not decided is a graze.

    Returns
    -------
    ball : that holds exactly one root, the first; None when there is none; "end" when the sign at `length` is open.

    Notes
    -----
    Existence is a change of sign where the slope is negative. Newton's method only narrows what is already shown.
    """
    derivative, error, slope_error = polynomial.derivative(), arb(0, bounds[0]), arb(0, bounds[1])

    def value(s: Any) -> Any:
        return polynomial(s) + error

    def slope(s: Any) -> Any:
        return derivative(s) + slope_error

    stack, least = [(arb(0), length)], length * arb(2) ** (-2 * bits // 3)
    while stack:
        begin, end = stack.pop()
        piece = begin.union(end)
        middle, steepness = arb((begin + (end - begin) * 0.4817).mid()), slope(piece)
        rises = steepness > 0 and value(begin) > 0
        if rises or value(middle) + steepness * (piece - middle) > 0:
            continue
        if steepness < 0:
            last = value(end)
            if last > 0:
                continue
            if last < 0 and value(begin) > 0:
                return _narrowed(piece, value, slope)
            if not stack:
                return "end"
            # the root lies where two pieces meet: they are made to meet elsewhere
            _, after = stack.pop()
            end = arb((end + (after - end) * 0.3).mid())
            stack += [(end, after), (begin, end)]
            if after - begin < least:
                raise Refused(f"x - c and x' both vanish near {float(begin.mid()):.6g}, as far as the digits tell")
            continue
        if end - begin < least:
            raise Refused(f"x - c and x' both vanish near {float(begin.mid()):.6g}, as far as the digits tell")
        stack += [(middle, end), (begin, middle)]
    return None


def _narrowed(piece: Any, value: Any, slope: Any) -> Any:
    """A smaller ball with the one root of a piece."""
    for _ in range(100):
        middle = arb(piece.mid())
        smaller = piece.intersection(middle - value(middle) / slope(piece))
        if smaller.rad() * 1.5 > piece.rad():
            return smaller
        piece = smaller
    return piece


@dataclass(frozen=True)
class EnclosureSettings:
    """Precision, degree and limits of the enclosures of flights.

    Parameters
    ----------
    accuracy : relative radius of the flight time and of the velocity that is reached.
    bits, most_bits : to begin with, and where a flight is refused.
    guard : bits of the working precision beyond those of a step.
    degree : of the Taylor polynomials, a bit; 0.55 was the fastest of 0.33 to 0.7.
    most_steps : of a flight.
    """

    accuracy: float = 1e-25
    bits: int = 112
    most_bits: int = 700
    guard: int = 40
    degree: float = 0.55
    most_steps: int = 4000


ENCLOSURE = EnclosureSettings()


class Enclosed(NamedTuple):
    """Balls that hold the time and the velocity of the first hit; None for both when there is none."""

    flight_time: Any
    velocity: Any
    steps: int
    bits: int


class Step(NamedTuple):
    """Taylor coefficients of x, its length, and bounds of |x - P| and |x' - P'| on all of it and at its end."""

    coefficients: list[Any]
    length: Any
    along: tuple[Any, Any]
    at_end: tuple[Any, Any]


class Equation(NamedTuple):
    """Programs of (f, df/dx, df/dx') and of g, and the clearance."""

    force: Program
    forcing: Program
    clearance: Any


def first_hit(osc: Oscillator, tau: Any, v: Any, horizon: float, settings: EnclosureSettings = ENCLOSURE) -> Enclosed:
    """The first hit of the flight from (tau, v), v > 0, to a relative radius of `settings.accuracy`.

    Parameters
    ----------
    tau, v : doubles or exact balls.

    Raises
    ------
    Refused : `most_bits` do not tell a graze from a miss, or a step would meet a point where f or g is not analytic.

    Examples
    --------
    >>> hit = first_hit(Oscillator("x + tanh(50*xdot)/10", "cos(t)", 0, "1/2"), 0.25, 1.0, 30.0)
    >>> hit.flight_time.str(20, radius=False)
    '2.9615580194225837697'
    """
    bits = settings.bits
    while True:
        try:
            with _precision(bits + ENCLOSURE.guard):
                hit = _flown(_equation(osc), (tau, v), horizon, bits)
                if hit.flight_time is None:
                    return hit
                worst = max(ball.rad() / abs(ball.mid()) for ball in hit[:2])
                if worst < settings.accuracy:
                    return hit
                why, more = f"relative radius {float(worst):.1e}", 12 + _bits_over(worst, settings)
        except Refused as reason:
            why, more = str(reason), bits // 2
        if bits + more > settings.most_bits:
            raise Refused(f"{why} at {bits} bits")
        bits += more


@contextmanager
def _precision(bits: int) -> Iterator[None]:
    """flint at `bits`, with series of any length."""
    with series_of_any_length(), balls_at(bits):
        yield


def _bits_over(worst: Any, settings: EnclosureSettings) -> int:
    from math import isfinite, log2

    ratio = float(worst) / settings.accuracy
    return int(log2(min(max(ratio, 1.0), 1e300))) if isfinite(ratio) else settings.bits


def _equation(osc: Oscillator) -> Equation:
    f = osc.force()
    force = Program.of([f, derivative(f, "x"), derivative(f, "xdot")])
    (clearance,) = Program.of([osc.clearance]).run({})
    return Equation(force, Program.of([osc.forcing()]), clearance)


def _flown(equation: Equation, state: tuple[Any, Any], horizon: float, bits: int) -> Enclosed:
    """One flight at a precision."""
    launch, speed, clearance = arb(state[0]), arb(state[1]), equation.clearance
    x, p = _centre(clearance, arb(0))
    u, q, s, radius = speed, arb(0), arb(0), arb(8)
    for count in range(1, ENCLOSURE.most_steps + 1):
        coefficients = taylor(equation, launch + s, x, u, int(ENCLOSURE.degree * bits))
        bound, radius = _widest_disc(equation, launch + s, coefficients, radius, bits, float(speed.mid()))
        length = bound[1]
        above = arb_poly([coefficients[0] - clearance, *coefficients[1:]])
        while True:
            step = _bounded(equation, launch + s, coefficients, (p, q), (bound[0], radius), length, bits)
            if count == 1:
                # (x - c)/s has no root on the step; s <= length times the bound of x' bounds x
                over = arb_poly(coefficients[1:])(arb(0).union(step.length)) + arb(0, step.along[1])
                if over > 0:
                    break
                length = _plain(step.length / 2)
                continue
            root = first_root(above, step.along, step.length, bits)
            if root is None:
                break
            if root != "end":
                slope = above.derivative()(root) + arb(0, step.along[1])
                time = s + root
                return Enclosed(time, slope, count, bits) if not time > horizon else Enclosed(None, None, count, bits)
            length = _plain(step.length * 0.93)
        s = s + step.length
        if s > horizon:
            return Enclosed(None, None, count, bits)
        x, p = _centre(arb_poly(coefficients)(step.length), step.at_end[0])
        u, q = _centre(arb_poly(coefficients).derivative()(step.length), step.at_end[1])
        if not x - p > clearance:
            raise Refused("x - c is not shown positive at the end of a step")
        radius = radius * 2
    raise Refused(f"{ENCLOSURE.most_steps} steps")


def _centre(ball: Any, bound: Any) -> tuple[Any, Any]:
    """The midpoint of a ball, and the bound with the ball's radius."""
    return arb(ball.mid()), _upper(bound + ball.rad())


def _upper(ball: Any) -> Any:
    """An exact upper bound of |ball|."""
    return arb(abs(ball).upper())


def _plain(ball: Any) -> Any:
    return arb(float(ball.mid()))


def taylor(equation: Equation, t: Any, x: Any, u: Any, degree: int) -> list[Any]:
    """Taylor coefficients 0..degree of the solution from (t, x, u), by Newton's method: m terms give 2 m + 1.

    The residual of the polynomial is known from one evaluation over series; the linear equation of the correction,
    e'' + (df/dx') e' + (df/dx) e = residual, is solved for the new terms one by one.
    """
    (driven,) = equation.forcing.run({"t": arb_series([t, 1], prec=degree)})
    g, X = _listed(driven, degree), [x, u]
    while len(X) <= degree:
        m, count = len(X) - 1, min(2 * len(X) - 2, degree - 1)  # X_0..X_m are known; count: residuals that are right
        slopes = [(k + 1) * X[k + 1] for k in range(m)]
        places = {"x": X, "xdot": slopes, "t": [t, 1]}
        values = {name: arb_series(series_, prec=count) for name, series_ in places.items()}
        f, by_x, by_u = (_listed(series_, count) for series_ in equation.force.run(values))
        damped = not all(series_.is_zero() for series_ in by_u[1:])  # a ball round 0 is not 0
        for k in range(m - 1, count):
            rest = g[k] - f[k] - sum(map(arb.__mul__, by_x, X[k:m:-1]), arb(0))
            if damped:
                rest -= sum(map(arb.__mul__, by_u, slopes[k : m - 1 : -1] if m else slopes[k::-1]), arb(0))
            elif k >= m:
                rest -= by_u[0] * slopes[k]
            X.append(rest / ((k + 1) * (k + 2)))
            slopes.append((k + 2) * X[-1])
    return X


def _listed(series: Any, count: int) -> list[Any]:
    """The first coefficients of a series, or of a constant."""
    if not isinstance(series, arb_series):
        return [arb(series)] + [arb(0)] * (count - 1)
    found = series.coeffs()[:count]
    return [*found, *[arb(0)] * (count - len(found))]


def _widest_disc(
    equation: Equation, t: Any, X: list[Any], radius: Any, bits: int, size: float
) -> tuple[tuple[Any, Any], Any]:
    """(M, step length) on the disc that allows the longest step, and its radius."""
    degree, best, R = len(X) - 1, None, float(radius.mid())
    target = 2.0**-bits * min(size, 1.0) * degree
    with balls_at(64):
        sums = _sums(X)
        for _ in range(120):
            M = _defect(equation, t, X, sums, arb(R))
            if M is not None:
                ratio = (arb(target) / (M * R + arb(2) ** -900)) ** (arb(1) / degree)
                length = R * min(float(ratio.mid()), 0.9)
                if best is not None and length < best[0] * 1.01:
                    break
                best = (length, M, R)
            R *= 0.85 if best is not None else 0.7
    if best is None:
        raise Refused("f or g is not analytic on any disc that was tried")
    return (best[1], arb(best[0])), arb(best[2])


def _sums(X: list[Any]) -> tuple[Any, Any, Any]:
    """Polynomials that bound |P - P(0)|, |P' - P'(0)| and |P''| on a disc, by its radius."""
    first = arb_poly([0, *[_upper(part) for part in X[1:]]])
    second = first.derivative()
    return first, second - arb_poly([second[0]]), second.derivative()


def _defect(equation: Equation, t: Any, X: list[Any], sums: tuple[Any, Any, Any], R: Any) -> Any:
    """A bound of |P'' + f(P, P') - g| on the disc, or None where f or g is not shown analytic there."""

    def box(centre: Any, width: Any) -> Any:
        return acb(centre + arb(0, _upper(width)), arb(0, _upper(width)))

    values = {"x": box(X[0], sums[0](R)), "xdot": box(X[1], sums[1](R)), "t": box(t, R)}
    inside = equation.force.run(values)[0] - equation.forcing.run(values)[0]
    return _upper(sums[2](R)) + _upper(inside) if inside.is_finite() else None


def _bounded(
    equation: Equation, t: Any, X: list[Any], start: tuple[Any, Any], disc: tuple[Any, Any], length: Any, bits: int
) -> Step:
    """The step of at most a length on which the bounds p and q are shown to hold."""
    (M, R), slack, degree = disc, arb(2) ** (-bits // 2), len(X) - 1
    with balls_at(64):
        sums = _sums(X)
        for _ in range(60):
            values = {
                name: centre + arb(0, _upper(total_(length) + slack))
                for name, centre, total_ in zip(("x", "xdot"), X, sums, strict=False)
            }
            _, by_x, by_u = equation.force.run(values | {"t": t + arb(0, _upper(length))})
            if by_x.is_finite() and by_u.is_finite():
                grown = (arb_mat([[0, 1], [_upper(by_x), -arb(arb(by_u).lower())]]) * length).exp()
                cut = M * R * (length / R) ** degree / degree
                most = arb(1).max(grown[1, 1])
                p = _upper(grown[0, 0] * start[0] + grown[0, 1] * (start[1] + cut))
                q = _upper(grown[1, 0] * start[0] + grown[1, 1] * start[1] + most * cut)
                along = _upper(grown[1, 0] * start[0] + most * (start[1] + cut))
                if p < slack and along < slack:
                    return Step(X, length, (p, along), (p, q))
                if start[0] + start[1] > slack / 4:
                    raise Refused("the bounds grew beyond half of the digits")
            length = _plain(length / 2)
    raise Refused("no step on which the bounds hold")
