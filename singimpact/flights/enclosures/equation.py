"""A model as programs over balls: f, g and their derivatives, with numbers of the model that may be balls.

    z'' + f(c + z, z') = g(t),   z = x - c.

The clearance is inside f, so that z starts from 0 exactly and no digits cancel next to the wall.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

from singimpact.algebra.analytic import Place, Program, Recorder
from singimpact.algebra.expressions import Name, add, names_in, substitute
from singimpact.algebra.precision import bits_of_balls
from singimpact.handed_on import flint
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.moving_number import CLEARANCE, RESTITUTION
from singimpact.oscillator.rebound import rho_of


class Refused(ArithmeticError):
    """A flight that balls of the precision at hand do not decide, with the reason."""


class NoHit(Refused):
    """Proved: no hit comes before a time."""


class NotAnalytic(Refused):
    """f or g is not analytic where the flight goes; more digits change nothing."""


class TooLong(Refused):
    """The steps allowed do not reach a hit; more digits change nothing."""


@dataclass(frozen=True)
class Programs:
    """Programs of a model, with the names that are balls.

    Parameters
    ----------
    linear : whether f is shown linear in x and x', and free of t: its slopes have none of them among their letters.
    parametric : whether t occurs in f.
    force : f, f_x, f_v. slopes : f_x, f_v, then f by each name. disc : f, f_x, f_v, then f by t and each name.
    box : f_x, f_v, f_xx, f_xv, f_vv, then the mixed derivatives f_px, f_pv of t and each name.
    drive : g. forcing : g, g', then g by each name. rho : the rebound, its slope, then its derivative by each name.
    """

    names: tuple[str, ...]
    linear: bool
    parametric: bool
    force: Program
    disc: Program
    box: Program
    drive: Program
    forcing: Program
    rho: Program


class Recorded(NamedTuple):
    """f, g and the rebound as places of three recorders."""

    force: Recorder
    f: Place
    forcing: Recorder
    g: Place
    law: Recorder
    rho: Place


def recorded(osc: Oscillator, names: tuple[str, ...]) -> Recorded:
    """f(c + z, z'), g and the rebound of a model; `names` of its numbers stay letters."""
    clearance = Name(CLEARANCE) if CLEARANCE in names else osc.clearance
    force, forcing, law = Recorder(), Recorder(), Recorder()
    f = force.record(substitute(osc.force(names), {"x": add(Name("x"), clearance)}))
    g = forcing.record(osc.forcing(names))
    fixed_number = RESTITUTION in names and not names_in(osc.restitution)
    rho = law.record(rho_of(Name(RESTITUTION)) if fixed_number else osc.rho(names))
    return Recorded(force, f, forcing, g, law, rho)


@lru_cache(maxsize=128)
def programs_of(osc: Oscillator, names: tuple[str, ...]) -> Programs:
    """The programs of a model; `names` of its numbers stay letters (parameters, "clearance", "restitution")."""
    force, f, forcing, g, law, rho = recorded(osc, names)
    by_x, by_v = force.derivative(f, "x"), force.derivative(f, "xdot")
    by_names = [force.derivative(f, name) for name in ("t", *names)]
    second = [force.derivative(by_x, "x"), force.derivative(by_x, "xdot"), force.derivative(by_v, "xdot")]
    mixed = [force.derivative(slope, name) for slope in by_names for name in ("x", "xdot")]
    slopes = force.program([by_x, by_v])
    return Programs(
        names,
        not osc.parametric and not any(("name", (name,)) in slopes.operations for name in ("x", "xdot")),
        osc.parametric,
        force.program([f, by_x, by_v]),
        force.program([f, by_x, by_v, *by_names]),
        force.program([by_x, by_v, *second, *mixed]),
        forcing.program([g]),
        forcing.program([g, forcing.derivative(g, "t"), *(forcing.derivative(g, name) for name in names)]),
        law.program([rho, law.derivative(rho, "v"), *(law.derivative(rho, name) for name in names)]),
    )


@lru_cache(maxsize=32)
def equation_of(osc: Oscillator) -> "Equation":
    """The equation of a model none of whose numbers is a ball; kept, with what is prepared for each precision."""
    return Equation(programs_of(osc, ()), {})


class Equation:
    """The programs with the numbers of the model put in, prepared once for each precision."""

    def __init__(self, programs: Programs, numbers: Mapping[str, Any]) -> None:
        self.names, self.programs, self.numbers = programs.names, programs, dict(numbers)
        self.linear = programs.linear
        self._ready: dict[tuple[str, int], Any] = {}

    def run(self, kind: str, **values: Any) -> list[Any]:
        """The results of a program; constants are made at the working precision, anew for each."""
        key = kind, bits_of_balls()
        if key not in self._ready:
            self._ready[key] = getattr(self.programs, kind).prepared(self.numbers)
        return self._ready[key](values)  # type: ignore[no-any-return]

    def acceleration(self, t: Any, z: Any, v: Any) -> Any:
        """x'' at a time, at x - c = z and x' = v."""
        return self.run("drive", t=t)[0] - self.run("force", x=z, xdot=v, t=t)[0]

    def by_time(self, t: Any, v: Any) -> Any:
        """x'' by t, at x = c and x' = v."""
        slope = self.run("forcing", t=t)[1]
        return slope - self.run("disc", x=v * 0, xdot=v, t=t)[3] if self.programs.parametric else slope

    def at_wall(self) -> list[Any]:
        """f, f_x and f_v at rest on the wall, where f is free of t; they are all of it where f is linear."""
        key = "wall", bits_of_balls()
        if key not in self._ready:
            self._ready[key] = self.run("force", x=flint.arb(0), xdot=flint.arb(0))
        return self._ready[key]  # type: ignore[no-any-return]
