"""A periodic orbit, by Krawczyk's operator.

It is a zero of F_i = G(state i) - state i+1, G the map from impact to impact.  With Y about the inverse of D F, the
zero exists and is alone in a box X round a point p if p - Y F(p) + (1 - Y D F(X)) (X - p) lies inside X.

A number of the model may be one more unknown.  Then one unknown is held: at any value within `half` of its centre,
where F(p) gains D F(X) e times that, e the held unknown, and there is one zero for each of its values.

The last flight of an orbit that touches the wall in its first state, with v = 0, has x - c and x' after the time that
leads there in place of G.
"""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from flint import arb, arb_mat

from .formulas import Dual, Formula, Refused, Wrong, ball, need, require_period
from .motion import Flight, Model, compared, ends, first_root, landed, next_state, size, tiny, within


class Orbits(NamedTuple):
    """F: a model, k periods, bits, the place of the held unknown, and whether the orbit touches the wall.

    `walls` : of the impacts, of a model with two.
    """

    model: Model
    span: Any
    bits: int
    held: int | None = None
    touches: bool = False
    walls: tuple[str | None, ...] = (None,)

    def linearised(self, point: list[Any], radii: list[Any]) -> tuple[list[Any], Any, list[Any]]:
        """D G of the flights over a box, D F, and F at its centre."""
        bits, n = self.bits, len(point) // 2
        box = [x + within(r) for x, r in zip(point, radii, strict=True)]
        models = [self.model.at(*states[2 * n :] or [None]) for states in (box, point)]
        missed: list[Any] = []
        D, slopes = arb_mat(2 * n, len(point)), []
        for i in range(n):
            (tau, v), (at, speed), after = box[2 * i : 2 * i + 2], point[2 * i : 2 * i + 2], 2 * ((i + 1) % n)
            here, there = (self.walls[k % n % len(self.walls)] for k in (i, i + 1))
            wide, exact = (model.from_wall(here) for model in models)
            rows: Any = None
            span = self.span if i == n - 1 else 0
            if span and self.touches:
                (height, fall), *columns = touching(wide, (tau, v), span + (box[0] - tau if i else 0), bits, 3)
                rows = list(zip(*by_launch(wide, tau, v, columns), strict=True))
                for a, rate in enumerate((fall, wide.push(box[0] + span, fall, wide.c() + height))):
                    D[2 * i + a, 0] += rate
                missed += touching(exact, (at, speed), span + (point[0] - at if i else 0), bits, 0)[0]
            else:
                for a in (0, 1):
                    D[2 * i + a, after + a] -= 1
                image = next_state(exact, at, speed, bits, here != there)
                missed += [image[0] - point[after] - span, image[1] - point[after + 1]]
            rows = rows or impact(wide, tau, v, bits)
            slopes.append(arb_mat([row[:2] for row in rows]))
            for a in (0, 1):
                for column, entry in zip((2 * i, 2 * i + 1, 2 * n), rows[a], strict=False):
                    D[2 * i + a, column] += entry
        return slopes, D, missed

    def krawczyk(self, point: list[Any], radii: list[Any], half: Any = None) -> tuple[list[Any], list[Any]]:
        """D G over a box, and what Krawczyk's operator makes of the box less its centre."""
        slopes, D, missed = self.linearised(point, radii)
        free = [k for k in range(len(point)) if k != self.held]
        square, moved = arb_mat([[row[k] for k in free] for row in D.table()]), [[component] for component in missed]
        if half is not None:
            moved = [
                [component + row[self.held] * within(half)] for component, row in zip(missed, D.table(), strict=True)
            ]
        Y = middles(middles(square).inv())
        one = arb_mat([[int(i == j) for j in free] for i in free])
        spread_out = (one - Y * square) * arb_mat([[within(radii[k])] for k in free])
        image = (spread_out - Y * arb_mat(moved)).entries()
        if self.held is not None:
            image.insert(self.held, arb(0) if half is None else within(half))
        return slopes, image

    def alone(self, point: list[Any], boxes: list[list[Any]]) -> list[Any]:
        """D G over the last of some boxes round a point, in each of which one zero is shown."""
        for radii in boxes:
            slopes, image = self.krawczyk(point, radii)
            for k, (part, radius) in enumerate(zip(image, radii, strict=True)):
                # more bits help a narrow box alone, and only if there may be a zero in it
                error = Wrong if radii is not boxes[-1] or abs(part) > radius else Refused
                why = f"Krawczyk's operator maps a side of {float(radius):.3g} to {float(size(part)):.3g}"
                need("Krawczyk", k == self.held or abs(part) < radius, why, error)
        return slopes


def walls_of(content: dict[str, Any]) -> tuple[str | None, ...]:
    """The walls of the states that are written; none of a model with one."""
    return tuple(state.get("wall") for state in content["states"])


def middles(matrix: Any) -> Any:
    return arb_mat([[arb(part.mid()) for part in row] for row in matrix.table()])


def return_map(slopes: list[Any]) -> Any:
    """The derivative of the return map."""
    total = arb_mat([[1, 0], [0, 1]])
    for slope in slopes:
        total = slope * total
    return total


def require_shortest(point: list[Any], radii: list[Any], span: Any, periods: int) -> None:
    """Refuse a shorter orbit that is written several times: its states would be repeated after a part of the span."""
    n = len(point) // 2
    for times in (m for m in range(2, n + 1) if n % m == 0 == periods % m):
        shift = 2 * n // times
        off = [point[shift] - point[0] - span / times, point[shift + 1] - point[1]]
        wide = [radii[shift] + radii[0], radii[shift + 1] + radii[1]]
        apart = any(abs(x) > radius for x, radius in zip(off, wide, strict=True))
        need("shortest", apart, f"a shorter orbit, {times} times, is not shown to be another one")


def periodic_orbit(model: Model, content: dict[str, Any], bits: int) -> None:
    """Check that one orbit has its states in the balls that are written, that no other is near, and its multipliers."""
    states, k = content["states"], int(content["periods"])
    require_period(model.g, content["period"])
    require_period(model.f, content["period"])
    numbers = [state[name] for state in states for name in ("tau", "v")]
    point, radii = ([ball(Fraction(number[field])) for number in numbers] for field in ("value", "radius"))
    orbits = Orbits(model, Formula(content["period"], model.g.parameters)() * k, bits, walls=walls_of(content))
    near = ball(Fraction(content["unique_within"]))
    require_shortest(point, radii, orbits.span, k)
    total = return_map(orbits.alone(point, [[near] * len(point), radii]))
    if content["multipliers"]:  # two, or none is said of them
        wanted = [number[field] for number in content["multipliers"] for field in ("real", "imaginary")]
        for multiplier, written in zip(eigenvalues(total), wanted, strict=True):
            compared({"a multiplier": (multiplier, written)})


def eigenvalues(matrix: Any) -> list[Any]:
    """Real and imaginary part of the larger eigenvalue, and of the other."""
    half, determinant = (matrix[0, 0] + matrix[1, 1]) / 2, matrix.det()
    under = half * half - determinant
    if under > 0:
        far = half + under.sqrt() if half > 0 else half - under.sqrt()
        return [far, arb(0), determinant / far, arb(0)]
    if under < 0:
        return [half, (-under).sqrt(), half, -(-under).sqrt()]
    raise Refused("the multipliers are not told apart")


# The derivative of the impact map over a ball of states, and of a motion that touches the wall.
#
# A ball of launches round a centre is flown with the centre: at the end of a step the distance of x from that of the
# centre is at most the distance of the launches times a bound of the derivatives by them, by the mean value theorem.


class Beside(Flight):
    """The motion of a ball of launches, with that of a centre, which is flown at the same times after the launch."""

    def __init__(self, model: Model, launch: tuple[Any, Any], bits: int, columns: int, centre: tuple[Any, Any]) -> None:
        super().__init__(model, *launch, bits, columns)
        self.centre, self.v, self.push = Flight(model, *centre, bits), launch[1], model.push(*launch)
        self.off = [ball_ - point for ball_, point in zip(launch, centre, strict=True)]

    def step(self) -> Any:
        """The polynomials of both on the next step, and its length."""
        return min(super().step(), self.centre.step(), key=float)

    def move(self, s: Any) -> None:
        """To a time of the step, x and x' narrowed by the mean value theorem."""
        super().move(s)
        self.centre.move(s)
        x, speed = self.x, self.speed
        bend = self.model.push(self.tau + self.passed, speed[0], x[0])
        narrowed = []
        for component, rate, own in ((x, speed[0], self.centre.x[0]), (speed, bend, self.centre.speed[0])):
            # a later launch is, at its own time, later along the motion, and less by v and by x'' at the start
            by_tau = rate - self.v * component[1] - self.push * component[2]
            narrowed.append(component[0].intersection(own + by_tau * self.off[0] + component[2] * self.off[1]))
        x[0], speed[0] = narrowed


def by_launch(model: Model, tau: Any, v: Any, columns: Sequence[tuple[Any, Any]]) -> list[tuple[Any, Any]]:
    """The derivatives of x and x' by tau, v and a number, from those by x, x' at the launch and the number."""
    (p, p_dot), (q, q_dot), *rest = columns
    start = model.push(tau, v)
    # a later launch is, at its time, a launch with x less by v and x' less by x''
    return [(-v * p - start * q, -v * p_dot - start * q_dot), (q, q_dot), *rest]


def impact(model: Model, tau: Any, v: Any, bits: int, centre: tuple[Any, Any] | None = None) -> list[list[Any]]:
    """The derivative of the impact map over a ball of states: rows of the next tau and v, columns of tau, v, number."""
    carried = 3 if model.over else 2
    motion = Flight(model, tau, v, bits, carried) if centre is None else Beside(model, (tau, v), bits, carried, centre)
    time, speed, columns = motion.first_hit()
    there, side = landed(model, motion)
    rebound = there.rebound(Dual(speed * side, [side, 0]), **there.moved(0, 1))
    end = model.push(tau + time, speed, model.c() + model.gap if motion.across else None)
    late = [-x / speed for x, _ in by_launch(model, tau, v, columns)]
    faster = [w + end * shift for (_, w), shift in zip(by_launch(model, tau, v, columns), late, strict=True)]
    after = [rebound.slopes[0] * shift for shift in faster]
    return [late, [*after[:2], *(shift + rebound.slopes[1] for shift in after[2:])]]


def touching(model: Model, launch: tuple[Any, Any], time: Any, bits: int, columns: int) -> list[tuple[Any, Any]]:
    """x - c, x' and the derivatives of x, x' at a time before which x > c is shown, if x - c = x' = 0 then.

    Up to a last piece x > c; on it x'' > 0.
    """
    motion = Flight(model, *launch, bits, columns)
    while True:
        h, left = motion.step(), time - motion.passed
        if not left.upper() <= h:
            h = arb(min(h, left * arb(0.8), key=float).mid())
            U, h = motion.root(h)
            need("before", U is None, "the motion meets the wall before it touches it", Refused)
            motion.advance(h)
            continue
        for k in range(1, 30):
            last = arb((left * (1 - arb(2) ** -k)).mid())
            x, speed = ends(motion.X, motion.K, last.union(left))
            if model.push(launch[0] + motion.passed + last.union(left), speed[0], x[0]) > 0:
                root = first_root(motion.y, motion.slope, last, tiny(last, bits)) if last > 0 else None
                need("just before", root is None, "the motion meets the wall before it touches it", Refused)
                x, speed = ends(motion.X, motion.K, left)
                return [(x[0] - motion.c, speed[0]), *zip(x[1:], speed[1:], strict=True)]
        raise Refused("that the mass is driven off the wall where it touches it is not shown")
