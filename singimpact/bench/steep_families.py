"""Families of models with steep layers, each written twice: as text for the package, and as a plain function.

A family's plain function gives x'' from t, x, x' and the numbers of `NAMES`, in that order; a test compares it with the
text. Its layers say where the acceleration varies on a length of about 1/K; `truth.graded_steps` grades its steps by
them. The smooth families measure cost; they have no layer.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import atan, cos, exp, log1p, pi, sin, sqrt, tanh

from singimpact.bench.truth.graded_steps import BEYOND, PHASE, POSITION, VELOCITY, Acceleration

Numbers = Mapping[str, float]
Layer = tuple[float, float, float, float, float]  # kind, centre, width, stiffness, spacing
# a, b: positions of layers; w: velocity of a layer; h, s: height and width of the peak of Stribeck's friction
NAMES = ("mu", "K", "a", "b", "w", "h", "s", "A", "omega", "damping")
MU, K, A_X, B_X, W, H, S, A, OMEGA, DAMPING = range(len(NAMES))


@dataclass(frozen=True)
class Family:
    """Models that share one text.

    Parameters
    ----------
    force, forcing : f(x, xdot) and g(t) as the package reads them.
    acceleration : g - f as a plain function.
    layers : rows of `Motion.layers` from the numbers of a model.
    strength : range of mu, log-uniform.
    steepest : largest K; the smallest is 1.
    """

    name: str
    force: str
    forcing: str
    acceleration: Acceleration
    layers: Callable[[Numbers], list[Layer]]
    strength: tuple[float, float]
    steepest: float = 1e4

    @property
    def steep(self) -> bool:
        """Whether the family has layers; the others measure cost."""
        return "K" in self.parameters

    @property
    def parameters(self) -> tuple[str, ...]:
        """The names of `NAMES` that occur in the text."""
        found = set(re.findall(r"[A-Za-z]\w*", f"{self.force} {self.forcing}"))
        return tuple(name for name in NAMES if name in found)


def friction(n: Numbers) -> list[Layer]:
    """A layer at x' = 0."""
    return [(VELOCITY, 0.0, 1 / n["K"], n["mu"] * n["K"] * (1 + n["h"]), 0.0)]


def stop(n: Numbers) -> list[Layer]:
    """A layer at x = a."""
    return [(POSITION, n["a"], 1 / n["K"], n["mu"] * n["K"], 0.0)]


def two_stops(n: Numbers) -> list[Layer]:
    """Layers at x = a and x = b."""
    return [*stop(n), (POSITION, n["b"], 1 / n["K"], n["mu"] * n["K"], 0.0)]


def beyond(n: Numbers) -> list[Layer]:
    """A layer at x = a that does not end."""
    return [(BEYOND, n["a"], 1 / n["K"], 0.0, 0.0)]


def pulse(n: Numbers) -> list[Layer]:
    """Layers at omega t = 0 mod 2 pi."""
    return [(PHASE, 0.0, 1 / (n["K"] * n["omega"]), 0.0, 2 * pi / n["omega"])]


def switch(n: Numbers) -> list[Layer]:
    """Layers at omega t = pi/2 mod pi."""
    return [(PHASE, pi / 2 / n["omega"], 1 / (n["K"] * n["omega"]), 0.0, pi / n["omega"])]


def velocity_bump(n: Numbers) -> list[Layer]:
    """A layer at x' = w."""
    return [(VELOCITY, n["w"], 1 / n["K"], n["mu"] * n["K"] * n["w"], 0.0)]


def none(_: Numbers) -> list[Layer]:
    """No layers: a smooth family."""
    return []


def wave(t: float, p: Sequence[float]) -> float:
    """A cos(omega t)."""
    return p[A] * cos(p[OMEGA] * t)


def square_wave(t: float, p: Sequence[float]) -> float:
    """A wave that switches steeply."""
    return p[A] * tanh(p[K] * cos(p[OMEGA] * t))


def pulsed(t: float, p: Sequence[float]) -> float:
    """A wave with a pulse, by half the angle: cos - 1 loses digits at the pulse."""
    return p[A] * cos(p[OMEGA] * t) + p[MU] * exp(-2 * (p[K] * sin(p[OMEGA] * t / 2)) ** 2)


def step_at(x: float, place: float, p: Sequence[float]) -> float:
    """From 0 to 2 across a place."""
    return 1 + tanh(p[K] * (x - place))


def bump_at(x: float, place: float, p: Sequence[float]) -> float:
    """1 at a place, and 0 beside it."""
    return exp(-((p[K] * (x - place)) ** 2))


def stribeck(u: float, p: Sequence[float]) -> float:
    """Friction that is larger at small velocities."""
    return p[MU] * tanh(p[K] * u) * (1 + p[H] * exp(-((u / p[S]) ** 2)))


def logistic(x: float, p: Sequence[float]) -> float:
    """From 0 to 1 across a, as half of 1 + tanh of half the argument."""
    return 0.5 * (1 + tanh(0.5 * p[K] * (x - p[A_X])))


def softplus(x: float, p: Sequence[float]) -> float:
    """log(1 + exp(K (x - a)))/K without an overflow."""
    y = p[K] * (x - p[A_X])
    return (max(y, 0.0) + log1p(exp(-abs(y)))) / p[K]


def rational(y: float, p: Sequence[float]) -> float:
    """1/(1 + K^2 y^2)."""
    return 1 / (1 + (p[K] * y) ** 2)


STEEP = (
    Family(
        "friction",
        "x + mu*tanh(K*xdot)",
        "A*cos(omega*t)",
        lambda t, x, u, p: wave(t, p) - x - p[MU] * tanh(p[K] * u),
        friction,
        (0.05, 0.5),
    ),
    Family(
        "stop",
        "x + mu*(1 + tanh(K*(x - a)))",
        "A*cos(omega*t)",
        lambda t, x, _u, p: wave(t, p) - x - p[MU] * step_at(x, p[A_X], p),
        stop,
        (0.3, 10),
    ),
    Family(
        "bump",
        "x + mu*exp(-K**2*(x - a)**2)",
        "A*cos(omega*t)",
        lambda t, x, _u, p: wave(t, p) - x - p[MU] * bump_at(x, p[A_X], p),
        stop,
        (0.3, 10),
    ),
    Family(
        "pulse",
        "x + damping*xdot",
        "A*cos(omega*t) + mu*exp(K**2*(cos(omega*t) - 1))",
        lambda t, x, u, p: pulsed(t, p) - x - p[DAMPING] * u,
        pulse,
        (1, 20),
    ),
    Family(
        "square wave",
        "x + damping*xdot",
        "A*tanh(K*cos(omega*t))",
        lambda t, x, u, p: square_wave(t, p) - x - p[DAMPING] * u,
        switch,
        (1, 1),
    ),
    # exp(K (a - x)) and exp(K (x - a)) overflow in the text itself where K |x - a| > 709, and |x - a| reaches 7
    Family(
        "logistic",
        "x + mu/(1 + exp(-K*(x - a)))",
        "A*cos(omega*t)",
        lambda t, x, _u, p: wave(t, p) - x - p[MU] * logistic(x, p),
        stop,
        (0.3, 10),
        100,
    ),
    Family(
        "softplus",
        "x + mu*log(1 + exp(K*(x - a)))/K",
        "A*cos(omega*t)",
        lambda t, x, _u, p: wave(t, p) - x - p[MU] * softplus(x, p),
        stop,
        (0.3, 10),
        100,
    ),
    Family(
        "atan friction",
        "x + mu*atan(K*xdot)",
        "A*cos(omega*t)",
        lambda t, x, u, p: wave(t, p) - x - p[MU] * atan(p[K] * u),
        friction,
        (0.05, 0.5),
    ),
    Family(
        "rounded corner",
        "x + mu*sqrt((x - a)**2 + 1/K**2)",
        "A*cos(omega*t)",
        lambda t, x, _u, p: wave(t, p) - x - p[MU] * sqrt((x - p[A_X]) ** 2 + 1 / (p[K] * p[K])),
        stop,
        (0.3, 5),
    ),
    Family(
        "rational bump",
        "x + mu/(1 + K**2*(x - a)**2)",
        "A*cos(omega*t)",
        lambda t, x, _u, p: wave(t, p) - x - p[MU] * rational(x - p[A_X], p),
        stop,
        (0.3, 10),
    ),
    Family(
        "rational pulse",
        "x",
        "A*cos(omega*t) + mu/(1 + K**2*sin(omega*t/2)**2)",
        lambda t, x, _u, p: wave(t, p) + p[MU] * rational(sin(p[OMEGA] * t / 2), p) - x,
        pulse,
        (0.3, 5),
    ),
    Family(
        "Stribeck",
        "x + mu*tanh(K*xdot)*(1 + h*exp(-(xdot/s)**2))",
        "A*cos(omega*t)",
        lambda t, x, u, p: wave(t, p) - x - stribeck(u, p),
        friction,
        (0.05, 0.5),
    ),
    Family(
        "three layers",
        "x + mu*tanh(K*xdot) + 2*mu*(1 + tanh(K*(x - a)))",
        "A*cos(omega*t) + mu*exp(K**2*(cos(omega*t) - 1))",
        lambda t, x, u, p: pulsed(t, p) - x - p[MU] * (tanh(p[K] * u) + 2 * step_at(x, p[A_X], p)),
        lambda n: friction(n) + stop(n) + pulse(n),
        (0.05, 0.5),
    ),
    # beyond a the force grows e-fold in 1/K: at K = 300 the turning point is already (log K v^2/mu)/K = 0.03 past a
    Family(
        "exponential",
        "x + mu*exp(K*(x - a))",
        "A*cos(omega*t)",
        lambda t, x, _u, p: wave(t, p) - x - p[MU] * exp(p[K] * (x - p[A_X])),
        beyond,
        (0.05, 2),
        300,
    ),
    Family(
        "friction, square wave",
        "x + mu*tanh(K*xdot)",
        "A*tanh(K*cos(omega*t))",
        lambda t, x, u, p: square_wave(t, p) - x - p[MU] * tanh(p[K] * u),
        lambda n: friction(n) + switch(n),
        (0.05, 0.5),
    ),
    Family(
        "two stops",
        "x + mu*(tanh(K*(x - a)) + tanh(K*(x - b)))",
        "A*cos(omega*t)",
        lambda t, x, _u, p: wave(t, p) - x - p[MU] * (tanh(p[K] * (x - p[A_X])) + tanh(p[K] * (x - p[B_X]))),
        two_stops,
        (0.1, 3),
    ),
    Family(
        "velocity bump",
        "x + mu*xdot*exp(-K**2*(xdot - w)**2)",
        "A*cos(omega*t)",
        lambda t, x, u, p: wave(t, p) - x - p[MU] * u * bump_at(u, p[W], p),
        velocity_bump,
        (0.1, 3),
    ),
    Family(
        "damped beyond",
        "x + mu*xdot*(1 + tanh(K*(x - a)))",
        "A*cos(omega*t)",
        lambda t, x, u, p: wave(t, p) - x - p[MU] * u * step_at(x, p[A_X], p),
        stop,
        (0.05, 1),
    ),
    Family(
        "cubic, friction, bump",
        "x + x**3 + mu*tanh(K*xdot) + 5*mu*exp(-K**2*(x - a)**2)",
        "A*cos(omega*t)",
        lambda t, x, u, p: wave(t, p) - x - x * x * x - p[MU] * (tanh(p[K] * u) + 5 * bump_at(x, p[A_X], p)),
        lambda n: friction(n) + stop(n),
        (0.05, 0.5),
    ),
    Family(
        "pendulum, stop",
        "x/2 + sin(x) + mu*(1 + tanh(K*(x - a)))",
        "A*cos(omega*t)",
        lambda t, x, _u, p: wave(t, p) - x / 2 - sin(x) - p[MU] * step_at(x, p[A_X], p),
        stop,
        (0.3, 10),
    ),
)
SMOOTH = (
    Family(
        "Duffing",
        "x + damping*xdot + mu*x**3",
        "A*cos(omega*t)",
        lambda t, x, u, p: wave(t, p) - x - p[DAMPING] * u - p[MU] * x * x * x,
        none,
        (0.1, 2),
    ),
    Family(
        "van der Pol",
        "x - mu*(1 - x**2)*xdot",
        "A*cos(omega*t)",
        lambda t, x, u, p: wave(t, p) - x + p[MU] * (1 - x * x) * u,
        none,
        (0.05, 3),
    ),
    Family(
        "pendulum",
        "damping*xdot + sin(x)",
        "A*cos(omega*t)",
        lambda t, x, u, p: wave(t, p) - p[DAMPING] * u - sin(x),
        none,
        (1, 1),
    ),
    Family(
        "exp(x) - 1",
        "damping*xdot + exp(x) - 1",
        "A*cos(omega*t)",
        lambda t, x, u, p: wave(t, p) - p[DAMPING] * u - exp(x) + 1,
        none,
        (1, 1),
    ),
    Family(
        "x/(1 + x^2)",
        "x/4 + mu*x/(1 + x**2)",
        "A*cos(omega*t)",
        lambda t, x, _u, p: wave(t, p) - x / 4 - p[MU] * x / (1 + x * x),
        none,
        (0.3, 3),
    ),
    Family(
        "x sqrt(1 + x^2)",
        "damping*xdot + x*sqrt(1 + x**2)",
        "A*cos(omega*t)",
        lambda t, x, u, p: wave(t, p) - p[DAMPING] * u - x * sqrt(1 + x * x),
        none,
        (1, 1),
    ),
    Family(
        "log(2 + x^2)",
        "x/4 + mu*log(2 + x**2)",
        "A*cos(omega*t)",
        lambda t, x, _u, p: wave(t, p) - x / 4 - p[MU] * log1p(1 + x * x),
        none,
        (0.3, 3),
    ),
)
PARAMETRIC = (
    Family(
        "Mathieu, Duffing",
        "(1 + A*cos(2*omega*t)/2)*x + damping*xdot + mu*x**3",
        "A*cos(omega*t)",
        lambda t, x, u, p: wave(t, p) - (1 + p[A] * cos(2 * p[OMEGA] * t) / 2) * x - p[DAMPING] * u - p[MU] * x * x * x,
        none,
        (0.1, 2),
    ),
    Family(
        "stiffness pulse",
        "x*(1 + mu*exp(K**2*(cos(omega*t) - 1)))",
        "A*cos(omega*t)",
        lambda t, x, _u, p: wave(t, p) - x * (1 + p[MU] * exp(-2 * (p[K] * sin(p[OMEGA] * t / 2)) ** 2)),
        pulse,
        (1, 20),
    ),
    Family(
        "swinging stop",
        "x + mu*(1 + tanh(K*(x - a)))*(1 + cos(omega*t)/2)",
        "A*sin(omega*t)",
        lambda t, x, _u, p: p[A] * sin(p[OMEGA] * t) - x - p[MU] * step_at(x, p[A_X], p) * (1 + cos(p[OMEGA] * t) / 2),
        stop,
        (0.3, 10),
    ),
    Family(
        "no clock, friction",
        "x - mu*(1 - x**2)*xdot + A*tanh(K*xdot)/10",
        "0",
        lambda _t, x, u, p: p[MU] * (1 - x * x) * u - x - p[A] * tanh(p[K] * u) / 10,
        lambda n: [(VELOCITY, 0.0, 1 / n["K"], n["A"] * n["K"] / 10, 0.0)],
        (0.05, 3),
    ),
)
"""Models in whose f t occurs, and one without t at all."""
FAMILIES = STEEP + SMOOTH + PARAMETRIC
