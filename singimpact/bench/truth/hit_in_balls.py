"""First hits in balls, by two programs that share no code with flights in doubles, nor with one another.

`second_program` is the one that checks certificates, which reads a model as text: it judges `digits=`, and in
self-tests the errors that flights in doubles estimate. Next to steep layers it is slow, and leaves many undecided.
`enclosed` is what `digits=` uses: it judges doubles and fixed steps, and is itself judged by the second program.
"""

from fractions import Fraction
from typing import Any, NamedTuple

from flint import arb

from singimpact.algebra import balls_at, number, series_of_any_length
from singimpact.certificates import Flight, Model, answered
from singimpact.certificates.checker.formulas import Clock, Refused
from singimpact.flights import Launch, NoHit, certified_hit
from singimpact.oscillator.model import Oscillator

ACCURACY = 1e-20  # relative radius of the flight time and of the velocity
BITS = (80, 160)  # of the second program: the first is enough for most flights
GUARD = 32  # bits of the working precision beside those of a step, as the second program has for certificates
SECONDS = 0.3  # of CPU for a flight: smooth models take a tenth of that, steep layers ten times as much


class InBalls(NamedTuple):
    """Balls of the time and the velocity of the first hit, > 0 at an upper wall, and their derivatives by tau, v."""

    flight_time: Any
    velocity: Any
    by_state: tuple[tuple[Any, Any], tuple[Any, Any]]

    def moved(self, sizes: tuple[float, float]) -> list[Any]:
        """The change of time and velocity for a change of the state by its size."""
        return [sum(abs(part) * size for part, size in zip(row, sizes, strict=True)) for row in self.by_state]


class _UpTo(Flight):
    """A flight of the second program that ends at a horizon."""

    horizon: float

    def advance(self, s: Any) -> None:
        self.move(s)
        if self.passed > self.horizon:
            raise NoHit


def second_program(
    osc: Oscillator, tau: float, v: float, horizon: float, seconds: float = SECONDS
) -> tuple[Any, Any] | None:
    """Balls of the time and the velocity of the first hit; None where none comes before the horizon.

    Raises
    ------
    Refused : that is not decided within so many seconds of CPU, or the model has a part that certificates do not have.

    Examples
    --------
    >>> time, velocity = second_program(Oscillator("x + x**3/5", "cos(t)", 0, "1/2"), 0.25, 1.0, 30.0)
    >>> time.str(20, radius=False)
    '2.7033129175185856982'
    """
    Clock.start(seconds)
    try:
        for bits in BITS:
            # `answered` makes a refusal of whatever the second program does not take: a root, a law of another kind
            with answered(), series_of_any_length(), balls_at(bits + GUARD):
                motion = _UpTo(Model(osc.to_dict()), arb(tau), arb(v), bits)
                motion.horizon = horizon
                try:
                    time, velocity, _ = motion.first_hit()
                except NoHit:
                    return None
                if time > horizon:
                    return None
                if all(ball.rad() < ACCURACY * abs(ball.mid()) for ball in (time, velocity)):
                    return time, velocity
    finally:
        Clock.stop()
    raise Refused(f"the radius of the hit is larger than {ACCURACY:g} at {BITS[-1]} bits")


def enclosed(osc: Oscillator, tau: Fraction, v: Fraction, horizon: float, digits: int) -> InBalls | None:
    """The first hit as `digits=` encloses it, with derivatives by the launch; None where none comes by the horizon.

    Examples
    --------
    >>> hit = enclosed(Oscillator("0", "-2", 0, "1/2"), Fraction(0), Fraction(3), 30.0, 20)
    >>> [float(ball) for ball in (hit.flight_time, hit.velocity, *hit.by_state[0], *hit.by_state[1])]
    [3.0, -3.0, 0.0, 1.0, 0.0, -1.0]
    """
    # with restitution 1 the next velocity is the size of the velocity at the hit
    laws = {"restitution": 1} | ({} if osc.upper is None else {"upper_restitution": 1})
    elastic, launch = osc.replace(**laws), Launch(number(tau), number(v))
    try:
        hit = certified_hit(elastic, launch, digits, Fraction(horizon), derivative=True)
    except NoHit:
        return None
    (by_tau, by_v), (faster_by_tau, faster_by_v) = hit.derivative
    side = 1 if hit.velocity > 0 else -1
    return InBalls(hit.flight_time, hit.velocity, ((by_tau - 1, by_v), (side * faster_by_tau, side * faster_by_v)))
