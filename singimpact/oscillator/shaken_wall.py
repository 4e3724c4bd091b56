"""A wall that moves: the model in the wall's frame, y = x - w(t), and the way back.

    y'' + f(y + w, y' + w') = g(t) - w'',   y >= 0,   y' -> rho(y')

With f = k x + d x' + m the terms of w go to g: y'' + f(y, y') = g - w'' - k w - d w'.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import (
    Expression,
    Name,
    add,
    evaluate,
    multiply,
    names_in,
    number,
    substitute,
    subtract as minus,
)
from singimpact.algebra.numbers import float_array, tree_of
from singimpact.algebra.rings import DOUBLES
from singimpact.inputs import unknown
from singimpact.oscillator.linear import form_of
from singimpact.oscillator.model import STATE, Oscillator, require_smooth_text


class Place(NamedTuple):
    """A place and a velocity."""

    x: Any
    xdot: Any


@dataclass(frozen=True)
class ShakenWall:
    """A model whose wall moves.

    Parameters
    ----------
    oscillator : the model in the frame of the wall, clearance 0: its x is the distance y from the wall, and its
        velocities are relative to the wall.
    wall : w(t), the place of the wall.
    """

    oscillator: Any
    wall: Expression

    def back(self, t: Any, x: Any = 0, xdot: Any = 0) -> Place:
        """Place and velocity in the frame at rest, of a distance and a velocity relative to the wall.

        Parameters
        ----------
        t, x, xdot : arrays that broadcast; impacts of an orbit are `back(orbit.tau, 0, orbit.v)`.

        Examples
        --------
        >>> table = shaken_wall("0", "-1", "2*sin(3*t)", "1/2")
        >>> table.back(0.0, 1.0, 0.5)
        Place(x=np.float64(1.0), xdot=np.float64(6.5))
        """
        height, speed = self._moving(t)
        return Place((float_array("x", x) + height)[()], (float_array("xdot", xdot) + speed)[()])

    def relative(self, t: Any, x: Any, xdot: Any) -> Place:
        """Distance and velocity relative to the wall, as `oscillator.launch` takes them; the inverse of `back`."""
        place, speed = self._moving(t)
        return Place((float_array("x", x) - place)[()], (float_array("xdot", xdot) - speed)[()])

    def sample(self, orbit: Any, t: Any) -> Place:
        """x and x' of an orbit of `oscillator` at times, in the frame at rest."""
        return self.back(t, *orbit.sample(t))

    def _moving(self, t: Any) -> tuple[Any, Any]:
        """w and w' at times."""
        times = float_array("t", t)
        trees = self.wall, derivative(self.wall, "t")
        return tuple(np.asarray(evaluate(tree, {"t": times}, DOUBLES)) + 0 * times for tree in trees)


def shaken_wall(
    f: Any,
    g: Any,
    wall: Any,
    restitution: Any,
    parameters: Mapping[str, Any] | None = None,
    period: Any = None,
    *,
    kind: type[Oscillator] = Oscillator,
) -> ShakenWall:
    """The model x'' + f(x, x') = g(t), x >= wall(t), in the frame of its wall.

    Parameters
    ----------
    f, g, restitution, parameters, period : as for `Oscillator`, f and g in the frame at rest. The
        restitution is that of velocities relative to the wall.
    wall : expression in t and the parameters, the place of the wall. kind : the class of the model.

    Notes
    -----
    In y = x - w(t) the equation is y'' + f(y + w, y' + w', t) + w'' = g. Where f is linear the terms in w are part of
    the forcing; otherwise t occurs in the f of the model.

    Examples
    --------
    >>> print(shaken_wall("0", "-9.81", "sin(7*t)/5", "1/2").oscillator.forcing())
    9.8*sin(7*t) - 9.81
    """
    names = tuple(parameters or {})
    trees = {
        name: tree_of(value, (*letters, *names), name)
        for name, value, letters in (("f", f, (*STATE, "t")), ("g", g, ("t",)), ("wall", wall, ("t",)))
    }
    wall_tree = trees["wall"]
    require_smooth_text(wall_tree, "wall")
    moving = "t" in names_in(wall_tree)
    form = form_of(trees["f"], number(0))
    speed = derivative(wall_tree, "t")
    force = substitute(trees["f"], {"x": add(Name("x"), wall_tree), "xdot": add(Name("xdot"), speed)})
    forcing = minus(trees["g"], derivative(speed, "t")) if moving else trees["g"]
    if moving and form is not None:
        terms = derivative(speed, "t"), multiply(form.stiffness, wall_tree), multiply(form.damping, speed)
        force, forcing = trees["f"], minus(trees["g"], add(*terms))
    law = tree_of(restitution, ("v", *names), "restitution") if isinstance(restitution, str) else number(1)
    symbols, used = set().union(*map(names_in, trees.values()), names_in(law)), names_in(force) | names_in(forcing)
    for name in names:
        if name not in symbols:
            raise unknown("parameter", name, sorted(symbols - {*STATE, "t", "v"}))
    used_parameters = {name: value for name, value in (parameters or {}).items() if name in used | names_in(law)}
    model = kind(force, forcing, 0, restitution, used_parameters, period)
    return ShakenWall(
        model, substitute(wall_tree, {name: tree_of(value) for name, value in (parameters or {}).items()})
    )
