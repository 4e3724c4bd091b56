"""Studies of a model as a whole: swans, singular points, gamma and basins; the numbers of the theory at one r.

Each function calls one function of a sub-package, and reads windows and intervals as a user writes them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import wraps
from inspect import signature
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

import singimpact as si
from singimpact import contact, dynamics, surface
from singimpact.algebra.numbers import as_float, as_fraction, constant
from singimpact.impact_oscillator import ImpactOscillator, universal
from singimpact.inputs import InputError, checked_keywords, need, refuse, require, require_known, takes_two_walls, whole
from singimpact.oscillator.model import Oscillator, require_model
from singimpact.result import Result

if TYPE_CHECKING:
    from singimpact.algebra.certified import Certified
    from singimpact.branches.family_orbits import FamilyOrbits
    from singimpact.contact.swans import SwanPoints
    from singimpact.dynamics.basins_of_attraction import Basins
    from singimpact.dynamics.basins_over import BasinsOver
    from singimpact.dynamics.families import OscillatorFamily
    from singimpact.surface.classification import Classification
    from singimpact.surface.curve import Curve

P = ParamSpec("P")
T = TypeVar("T")


@checked_keywords
def swan_points(
    f: Any, g: Any, parameters: Mapping[str, Any] | None = None, over: str = "clearance", between: Any = None
) -> SwanPoints:
    """The swan points of x'' + f(x, x') = g(t) as the clearance varies, in the order of tau_*.

    Parameters
    ----------
    f, g, parameters : as for `ImpactOscillator`. over : "clearance".
    between : (low, high), the interval of clearances; None for all, if f(x, 0) is a polynomial.

    Returns
    -------
    SwanPoints : a tuple; `.complete` says whether a second search, in boxes, proves that there are no others. Each has
        `.tau`, `.clearance` (c_0), `.kind` ("positive" | "negative"), `.certified(digits)` and
        `.oscillator(restitution)`, the model exactly at c_0.

    Notes
    -----
    A wall above, x <= u, has swans at the same places u = c_0 and times, of the other kind.

    Examples
    --------
    >>> [(swan.kind, swan.clearance) for swan in swan_points("x", "cos(2*t)")]
    [('negative', 1.0), ('positive', -1.0)]
    >>> swan_points("x", "cos(2*t)").complete
    True
    >>> print(swan_points("x + 3*x**3/10", "cos(2*t)")[0].oscillator("0.5").clearance)
    root(u + 0.3*u**3 - 1, 0.829051, 0.829052)
    """
    require(over == "clearance", "over", over, "'clearance'")
    model = ImpactOscillator(f, g, 0, 1, parameters)
    return contact.swan_points_over_clearance(model, None if between is None else interval(between))


def _bound(end: Any) -> Fraction:
    tree = constant("between", end)
    exact = as_fraction(tree)
    return Fraction(as_float(tree)) if exact is None else exact


def interval(between: Any) -> tuple[Fraction, Fraction]:
    """Two numbers, the lower first, as exact fractions.

    Examples
    --------
    >>> interval(("-1/3", "0.5"))
    (Fraction(-1, 3), Fraction(1, 2))
    """
    try:
        low, high = (_bound(end) for end in between)
    except (TypeError, ValueError) as error:
        raise error if isinstance(error, InputError) else refuse("between", between, "two numbers low < high") from None
    require(low < high, "between", between, "two numbers low < high")
    return low, high


# Name -> the claim that has it, and what it is like as r -> 0 and as r -> 1; j is the contact order.
UNIVERSAL = {
    "lambda": ("b:order-ray", "(r/(j+1))^(1/(j+1))", "1 - 3(1-r)/(2j+3)"),
    "mu": ("b:order-saddle", "(j+1)^2/lambda", "1 + (1-r)"),
    "X": ("b:foot-monotone", "3", "2.9410294 (1-r)^(-3/7)"),
    "kappa_*": ("b:three-one", "-56/57^(3/2) - 225 sqrt(19 r)/13718", "-2/3^(3/2) + 0.2844281 (1-r)^(6/7)"),
}


@dataclass(frozen=True)
class Constant(Result):
    """A number of the theory at one r, certified. source : its claim. at_zero, at_one : its laws as r -> 0, r -> 1."""

    name: str
    order: int
    value: Certified
    source: str
    at_zero: str
    at_one: str


@checked_keywords
def constants(r: object, digits: int = 30) -> tuple[Constant, ...]:
    """The numbers of the theory that depend on the restitution alone, in balls.

    lambda and mu, along and across gamma, at the contact orders 1 to 3; X, where the orbit released at A of an unfolded
    negative swan comes to rest; kappa_*, q/|p|^(3/2) of the border orbit at a contact of order three.

    Parameters
    ----------
    r : a rational number with 1/100 <= r <= 99/100. digits : decimal digits, 16 or more.

    Returns
    -------
    tuple of Constant : each has `.name`, `.order`, the contact order, `.value`, a `Certified`, `.source`, its claim,
        and `.at_zero` and `.at_one`, the laws that it follows as r -> 0 and as r -> 1.

    Examples
    --------
    >>> [f"{constant.name} {constant.value}"[:16] for constant in constants("1/2", 16) if constant.order == 3]
    ['lambda 0.7943381', 'mu 1.98559656969', 'kappa_* -0.24734']
    """
    from singimpact.theory.fixed_points import multipliers

    rate, precision = as_fraction(constant("r", r)), max(whole("digits", digits, 1, 1000), 16)
    require(rate is not None and Fraction(1, 100) <= rate <= Fraction(99, 100), "r", r, "a rational from 0.01 to 0.99")
    values = []
    for order in (1, 2, 3):
        along = multipliers(order, rate, precision)
        values += [("lambda", order, along.lambda_), ("mu", order, along.mu)]
    values.append(("X", 2, universal(-1, rate).chatter_limit(-1, 0, digits=precision).certified))
    cubic = Oscillator("0", "t**3 - t + q", 0, rate, {"q": "-1/4"})
    (border,) = si.border_orbits(cubic, "q", ("-0.3849", "-0.13"), digits=precision, points=9)
    values.append(("kappa_*", 3, border.certified))
    for name, _, value in values:
        need(value is not None, ArithmeticError(f"{name} at r = {rate} is not certified to {precision} digits"))
    return tuple(Constant(name, order, value, *UNIVERSAL[name]) for name, order, value in values)


@checked_keywords
@takes_two_walls
def basins(
    osc: Oscillator,
    window: Any = None,
    size: int = 600,
    *,
    impacts: int = 20_000,
    executor: Any = None,
    output: Any = None,
    wall: Any = None,
    **moving: Any,
) -> Basins | BasinsOver:
    """Basins of attraction: the attractor of each state of a grid: an orbit or cycle, repeated chatter, rest, chaos.

    Parameters
    ----------
    osc : a model with a period, without t, or with sums of waves in t.
    window : ((tau_low, tau_high), (v_low, v_high)); one period and (0, 2) without it, or a turn of the fastest wave.
        Of a model without t the starts are off the wall: ((x_low, x_high), (xdot_low, xdot_high)); without it x from c
        to c + 2 max(1, |c|), and (-2, 2).
    size : states on a side, from 2 to 10000. impacts : at most, of an orbit that does not settle; its class then says
        so. executor, output : as for `sweep`; a case is some rows of the grid.
        The default executor is one thread for each core. wall : of the states of a model with two walls: "lower" (also
        without it) or "upper".
    moving : `over`, a number of the model as `bifurcation` takes it, and `between`, its ends: the shares of the basins
        over it. `values` of the number (50), and at each `states` (400), drawn evenly from the window by `seed` (0), at
        the same places of it. `jump` (0.25) : attractors of two neighbouring values are one where they are of one class
        and their states are nearer, in periods and in highest velocities. A case is a value; `size` has no meaning.

    Returns
    -------
    BasinsOver : with `over`; `.values`, shape (m,), `.attractors`, `.share` and `.error`, shape (m, attractors),
        standard errors of binomial counts, `.undecided`, shape (m,). `si.plot` draws it, `.to_csv(file)` writes it.
    Basins : else; `.codes`, shape (size, size), numbers of the classes in `.attractors`; `.classes` has their names and
        shares, `.first_chatter_completes` is an array of bool. `si.plot` draws it, `.to_csv(file)` writes it;
        `.uncertainty()` and `.entropy()` measure the boundaries. Between two walls an orbit has their word, such as
        (lu, 1), and its v is < 0 at the upper one.

    Raises
    ------
    InputError : another model or number, or a window or a size that is not valid.

    Notes
    -----
    Attractors are followed as by G. Datseris, K. Luiz Rossi and A. Wagemakers, Chaos 33 (2023) 073151. Chaotic ones
    have no states to compare: they are one attractor. An attractor whose basin the sample misses at a value has its
    label again afterwards, if it is near.

    Examples
    --------
    >>> from singimpact.impact_oscillator import ImpactOscillator, linear
    >>> found = basins(linear(2, 0, "0.5"), over="clearance", between=("0.2", "0.3"), values=3, states=40)
    >>> found, found.share.tolist()
    (BasinsOver(clearance: 3 values from 0.2 to 0.3, 40 states of each: (1, 1) orbit 100 %), [[1.0], [1.0], [1.0]])
    >>> basins(ImpactOscillator("x - (1 - x**2)*xdot", "0", "-2.1", "0.8"), size=4)
    Basins(4 x 4 states: limit cycle without impact, period 6.66329 100 %)
    >>> basins(linear(2, "0.7", "0.5"), ((0, 3), (0, 1)), 8)
    Basins(8 x 8 states: (inf, 1) chatter for ever 100 %)
    """
    whole("size", size, 2, 10_000)
    starts = isinstance(osc, Oscillator) and osc.autonomous
    names = "((x_low, x_high), (xdot_low, xdot_high))" if starts else "((tau_low, tau_high), (v_low, v_high))"
    tau, v = (None, None) if window is None else _two_ends(window, names)
    if not moving:
        return dynamics.basins(osc, tau, v, size, executor, output, impacts, wall)
    from singimpact.dynamics.basins_over import basins_over

    require_known(
        "argument of basins",
        moving,
        ["over", "between", "values", "states", "seed", "jump", "window", "size", "impacts"],
    )
    moving = {"over": None, "between": None, "executor": executor, "output": output} | moving
    return basins_over(osc, window=(tau, v), impacts=impacts, wall=wall, **moving)


@checked_keywords
@takes_two_walls
def classify(osc: Oscillator, window: Any = None, between: Any = None, *, wall: object = None) -> Classification:
    """The singular points of p and phi on V_c': tangencies, swans, cusps, and the fold lines between them.

    Parameters
    ----------
    osc : the model. window : ((tau_low, tau_high), (t_low, t_high)); without it one period of tau and as much on both
        sides of t = 0, or a window with all zeros of a_c if g is a polynomial.
    between : interval of clearances in which swans are searched; by default all, where they can be isolated.
    wall : of a model with two: "lower" (also without it) or "upper", whose points are those of `osc.mirrored`, with
        clearances that are minus the heights of the wall. Flights that meet the other wall are left out; swans and
        tangencies, which are no flights, are those of one wall.

    Returns
    -------
    Classification : `.points`, `.folds`, `.swans`, and `.notes` on undecided points.

    Examples
    --------
    >>> from singimpact.impact_oscillator import universal
    >>> classify(universal(-1, "0.5"))
    Classification(cusp 4, tangency 2; fold lines 4; swans over the clearance 0)
    """
    tau, t = (None, None) if window is None else _two_ends(window, "((tau_low, tau_high), (t_low, t_high))")
    require_model("osc", osc)
    return surface.classify(osc.seen_from(wall), tau, t, None if between is None else interval(between))


@checked_keywords
@takes_two_walls
def grown_gamma(osc: Oscillator, window: Any = None, tau: Any = None, *, wall: object = None) -> list[Curve]:
    """gamma as curves: from its series at a tangency or swan point to the edge of a window of states.

    Parameters
    ----------
    osc : the model. window : ((tau_low, tau_high), (v_low, v_high)); without it a period on both sides of tau = 0 (the
        zeros of a_c with a margin, if g is a polynomial) and (0, 2).
    tau : the point; without one the first that has an invariant curve.
    wall : of a model with two: "lower" (also without it) or "upper"; curves end where a flight meets the other one.

    Returns
    -------
    list of Curve : in (tau, v), in order of hit history, the first from (tau_*, 0) on. `si.plot` draws it.

    Raises
    ------
    InputError : no such point, or a window that is not valid.

    Examples
    --------
    >>> from singimpact.impact_oscillator import universal
    >>> curve = grown_gamma(universal(1, "0.5"), ((-2, 1), (0, 20)), 1)[0]
    >>> curve.points[0].tolist(), curve.points[-1].round(3).tolist()
    ([1.0, 0.0], [-1.385, 0.0])
    """
    from singimpact.surface.classification import default_window
    from singimpact.surface.curve import STATES, Window

    require_model("osc", osc)
    osc = osc.seen_from(wall)
    if not isinstance(window, Window):
        low, high = default_window(osc)[0]
        usual = ((low - high if osc.period is not None else low, high), (0, 2))
        named = "((tau_low, tau_high), (v_low, v_high))"
        tau_ends, v_ends = usual if window is None else _two_ends(window, named)
        window = Window.read(tau_ends, v_ends, axes=STATES)
    return dynamics.grown_gamma(osc, window, tau)


def _of_models(method: Callable[P, T], of_family: Callable[..., Any] | None = None) -> Callable[P, T]:
    """A method of the model as a function, whose first argument is checked; documented at the method.

    Parameters
    ----------
    of_family : takes its place where the first argument is a family (`osc.over`).
    """
    takes = signature(method)
    first, *others = takes.parameters.values()
    takes = takes.replace(parameters=[first.replace(name="osc"), *others])

    @wraps(method)
    def study(*values: P.args, **named: P.kwargs) -> T:
        bound = takes.bind(*values, **named)
        osc = bound.arguments["osc"]
        if of_family is not None and not isinstance(osc, Oscillator):
            from singimpact.dynamics.families import OscillatorFamily

            if isinstance(osc, OscillatorFamily):
                return of_family(*values, **named)  # type: ignore[no-any-return]
        require_model("osc", osc)
        return method(*bound.args, **bound.kwargs)

    study.__signature__ = takes  # type: ignore[attr-defined]
    return checked_keywords(study)


def _periodic_of_family(osc: OscillatorFamily, *values: Any, **named: Any) -> FamilyOrbits:
    from singimpact.branches.family_orbits import orbits_of_members

    return orbits_of_members(osc, *values, **named)


orbit = _of_models(ImpactOscillator.orbit)
periodic = _of_models(ImpactOscillator.periodic, _periodic_of_family)
chatter_limit = _of_models(ImpactOscillator.chatter_limit)
certified_gamma = _of_models(ImpactOscillator.certified_gamma)


def _two_ends(window: Any, accepted: str) -> tuple[Any, Any]:
    ranges = (window.x, window.y) if hasattr(window, "x") and hasattr(window, "y") else window
    require(isinstance(ranges, tuple | list) and len(ranges) == 2, "window", window, accepted)
    return ranges[0], ranges[1]
