"""Families of models with steep layers, whose texts the package reads in its way and the truth as Python does.

The texts are in `data/steep_families.toml`. A family's plain function gives x'' from t, x, x' and the numbers of
`NAMES`, in that order; a test compares it with what the package evaluates. Its layers say where the acceleration varies
on a length of about 1/K; `truth.graded_steps` grades its steps by them. The smooth families measure cost; they have no
layer.
"""

import re
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import pi
from pathlib import Path

from singimpact.bench.truth.graded_steps import BEYOND, PHASE, POSITION, VELOCITY, Acceleration
from singimpact.bench.truth.plain_steps import python_function

Numbers = Mapping[str, float]
Layer = tuple[float, float, float, float, float]  # kind, centre, width, stiffness, spacing
# a, b: positions of layers; w: velocity of a layer; h, s: height and width of the peak of Stribeck's friction
NAMES = ("mu", "K", "a", "b", "w", "h", "s", "A", "omega", "damping")


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
        return tuple(name for name in NAMES if name in words(f"{self.force} {self.forcing}"))

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


# terms that lose digits or overflow in doubles, and the same numbers without that
ACCURATE = {
    "K**2*(cos(omega*t) - 1)": "-2*(K*sin(omega*t/2))**2",
    "log(1 + exp(K*(x - a)))": "(max(K*(x - a), 0.0) + log1p(exp(-abs(K*(x - a)))))",
}


def acceleration(force: str, forcing: str) -> Acceleration:
    """g - f as a plain Python function of t, x, x' and the numbers of `NAMES`, from the texts as Python reads them.

    Examples
    --------
    >>> acceleration("x + mu*xdot", "A*cos(omega*t)")(0.0, 1.0, 2.0, [0.5, 0, 0, 0, 0, 0, 0, 4.0, 1.0, 0])
    2.0
    """
    text = f"{forcing} - ({force})"
    for term, accurate in ACCURATE.items():
        text = text.replace(term, accurate)
    numbers = "".join(f"    {name} = p[{at}]\n" for at, name in enumerate(NAMES) if name in words(text))
    return python_function("acceleration", f"def acceleration(t, x, xdot, p):\n{numbers}    return {text}\n")


def words(text: str) -> set[str]:
    """The names that occur in a text."""
    return set(re.findall(r"[A-Za-z]\w*", text))


def _families(kind: str) -> tuple[Family, ...]:
    return tuple(
        Family(
            **fields | {"strength": tuple(fields["strength"]), "layers": tuple(fields.get("layers", ()))},
            acceleration=acceleration(fields["force"], fields["forcing"]),
        )
        for fields in TEXTS[kind]
    )


TEXTS = tomllib.loads((Path(__file__).parent / "data" / "steep_families.toml").read_text(encoding="utf-8"))
# the last ones have t in f, or no t at all
STEEP, SMOOTH, PARAMETRIC = map(_families, ("steep", "smooth", "parametric"))
FAMILIES = STEEP + SMOOTH + PARAMETRIC
