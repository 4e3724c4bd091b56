"""Families of models with steep layers, each written twice: as text for the package, and as a plain function.

The texts are in `data/steep_families.toml`. A family's plain function gives x'' from t, x, x' and the numbers of
`NAMES`, in that order; a test compares it with the text. Its layers say where the acceleration varies on a length of
about 1/K; `truth.graded_steps` grades its steps by them. The smooth families measure cost; they have no layer.
"""

import re
import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import atan, cos, exp, log1p, pi, sin, sqrt, tanh
from pathlib import Path

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
    layers : names of `LAYERS`.
    strength : range of mu, log-uniform.
    steepest : largest K; the smallest is 1.
    """

    name: str
    force: str
    forcing: str
    acceleration: Acceleration
    strength: tuple[float, float]
    layers: tuple[str, ...] = ()
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

    def layers_of(self, n: Numbers) -> list[Layer]:
        """Rows of `Motion.layers` from the numbers of a model."""
        return [LAYERS[name](n) for name in self.layers]


# where the acceleration varies steeply: at x' = 0, x = a and b, beyond a without end, at omega t = 0 mod 2 pi and
# pi/2 mod pi, at x' = w, and at x' = 0 of a friction of size A/10
LAYERS: dict[str, Callable[[Numbers], Layer]] = {
    "friction": lambda n: (VELOCITY, 0.0, 1 / n["K"], n["mu"] * n["K"] * (1 + n["h"]), 0.0),
    "stop": lambda n: (POSITION, n["a"], 1 / n["K"], n["mu"] * n["K"], 0.0),
    "second stop": lambda n: (POSITION, n["b"], 1 / n["K"], n["mu"] * n["K"], 0.0),
    "beyond": lambda n: (BEYOND, n["a"], 1 / n["K"], 0.0, 0.0),
    "pulse": lambda n: (PHASE, 0.0, 1 / (n["K"] * n["omega"]), 0.0, 2 * pi / n["omega"]),
    "switch": lambda n: (PHASE, pi / 2 / n["omega"], 1 / (n["K"] * n["omega"]), 0.0, pi / n["omega"]),
    "velocity bump": lambda n: (VELOCITY, n["w"], 1 / n["K"], n["mu"] * n["K"] * n["w"], 0.0),
    "drag": lambda n: (VELOCITY, 0.0, 1 / n["K"], n["A"] * n["K"] / 10, 0.0),
}


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


ACCELERATIONS: dict[str, Acceleration] = {
    "friction": lambda t, x, u, p: wave(t, p) - x - p[MU] * tanh(p[K] * u),
    "stop": lambda t, x, _u, p: wave(t, p) - x - p[MU] * step_at(x, p[A_X], p),
    "bump": lambda t, x, _u, p: wave(t, p) - x - p[MU] * bump_at(x, p[A_X], p),
    "pulse": lambda t, x, u, p: pulsed(t, p) - x - p[DAMPING] * u,
    "square wave": lambda t, x, u, p: square_wave(t, p) - x - p[DAMPING] * u,
    "logistic": lambda t, x, _u, p: wave(t, p) - x - p[MU] * logistic(x, p),
    "softplus": lambda t, x, _u, p: wave(t, p) - x - p[MU] * softplus(x, p),
    "atan friction": lambda t, x, u, p: wave(t, p) - x - p[MU] * atan(p[K] * u),
    "rounded corner": lambda t, x, _u, p: wave(t, p) - x - p[MU] * sqrt((x - p[A_X]) ** 2 + 1 / (p[K] * p[K])),
    "rational bump": lambda t, x, _u, p: wave(t, p) - x - p[MU] * rational(x - p[A_X], p),
    "rational pulse": lambda t, x, _u, p: wave(t, p) + p[MU] * rational(sin(p[OMEGA] * t / 2), p) - x,
    "Stribeck": lambda t, x, u, p: wave(t, p) - x - stribeck(u, p),
    "three layers": lambda t, x, u, p: pulsed(t, p) - x - p[MU] * (tanh(p[K] * u) + 2 * step_at(x, p[A_X], p)),
    "exponential": lambda t, x, _u, p: wave(t, p) - x - p[MU] * exp(p[K] * (x - p[A_X])),
    "friction, square wave": lambda t, x, u, p: square_wave(t, p) - x - p[MU] * tanh(p[K] * u),
    "two stops": lambda t, x, _u, p: wave(t, p) - x - p[MU] * (tanh(p[K] * (x - p[A_X])) + tanh(p[K] * (x - p[B_X]))),
    "velocity bump": lambda t, x, u, p: wave(t, p) - x - p[MU] * u * bump_at(u, p[W], p),
    "damped beyond": lambda t, x, u, p: wave(t, p) - x - p[MU] * u * step_at(x, p[A_X], p),
    "cubic, friction, bump": lambda t, x, u, p: (
        wave(t, p) - x - x * x * x - p[MU] * (tanh(p[K] * u) + 5 * bump_at(x, p[A_X], p))
    ),
    "pendulum, stop": lambda t, x, _u, p: wave(t, p) - x / 2 - sin(x) - p[MU] * step_at(x, p[A_X], p),
    "Duffing": lambda t, x, u, p: wave(t, p) - x - p[DAMPING] * u - p[MU] * x * x * x,
    "van der Pol": lambda t, x, u, p: wave(t, p) - x + p[MU] * (1 - x * x) * u,
    "pendulum": lambda t, x, u, p: wave(t, p) - p[DAMPING] * u - sin(x),
    "exp(x) - 1": lambda t, x, u, p: wave(t, p) - p[DAMPING] * u - exp(x) + 1,
    "x/(1 + x^2)": lambda t, x, _u, p: wave(t, p) - x / 4 - p[MU] * x / (1 + x * x),
    "x sqrt(1 + x^2)": lambda t, x, u, p: wave(t, p) - p[DAMPING] * u - x * sqrt(1 + x * x),
    "log(2 + x^2)": lambda t, x, _u, p: wave(t, p) - x / 4 - p[MU] * log1p(1 + x * x),
    "Mathieu, Duffing": lambda t, x, u, p: (
        wave(t, p) - (1 + p[A] * cos(2 * p[OMEGA] * t) / 2) * x - p[DAMPING] * u - p[MU] * x * x * x
    ),
    "stiffness pulse": lambda t, x, _u, p: wave(t, p) - x * (1 + p[MU] * exp(-2 * (p[K] * sin(p[OMEGA] * t / 2)) ** 2)),
    "swinging stop": lambda t, x, _u, p: (
        p[A] * sin(p[OMEGA] * t) - x - p[MU] * step_at(x, p[A_X], p) * (1 + cos(p[OMEGA] * t) / 2)
    ),
    "no clock, friction": lambda _t, x, u, p: p[MU] * (1 - x * x) * u - x - p[A] * tanh(p[K] * u) / 10,
}


def _families(kind: str) -> tuple[Family, ...]:
    return tuple(
        Family(
            **fields | {"strength": tuple(fields["strength"]), "layers": tuple(fields.get("layers", ()))},
            acceleration=ACCELERATIONS[fields["name"]],
        )
        for fields in TEXTS[kind]
    )


TEXTS = tomllib.loads((Path(__file__).parent / "data" / "steep_families.toml").read_text(encoding="utf-8"))
# the last ones have t in f, or no t at all
STEEP, SMOOTH, PARAMETRIC = map(_families, ("steep", "smooth", "parametric"))
FAMILIES = STEEP + SMOOTH + PARAMETRIC
