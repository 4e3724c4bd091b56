"""What a user holds: `ImpactOscillator`, the model with methods, each one call into the room that does the work."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from singimpact.algebra.numbers import as_float, as_fraction, compare, constant, float_array
from singimpact.inputs import InputError, refuse, unknown, whole
from singimpact.oscillator.model import Oscillator

if TYPE_CHECKING:
    from pathlib import Path as FilePath

    from singimpact.branches.branch import Branch
    from singimpact.branches.event_curve import EventCurve
    from singimpact.branches.events import Event
    from singimpact.branches.orbits import PeriodicOrbit, PeriodicOrbits
    from singimpact.contact.points import TangencyPoints
    from singimpact.contact.swans import SwanPoint
    from singimpact.dynamics.basins import Basins
    from singimpact.dynamics.bifurcation import Bifurcation
    from singimpact.dynamics.chatter import ChatterLimit
    from singimpact.dynamics.lyapunov import Lyapunov
    from singimpact.dynamics.orbit import Orbit
    from singimpact.dynamics.threshold import Threshold
    from singimpact.flights.off_wall import Launched
    from singimpact.flights.orbits import Ends as Iterates
    from singimpact.flights.path import Path
    from singimpact.flights.results import Derivative, Flight, Step
    from singimpact.oscillator.shaken_wall import ShakenWall
    from singimpact.surface.classification import Classification
    from singimpact.surface.curve import Curve


class ImpactOscillator(Oscillator):
    """x'' + f(x, x') = g(t), x >= clearance, v -> -restitution v; parameters as in `Oscillator`.

    Examples
    --------
    >>> osc = ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(omega*t)", 0.3, 0.6, {"omega": 1.7})
    >>> step = osc.impact_map(1.5, 1e-3)
    >>> print(f"{step.v:.12f}", step.status)
    0.000600256662 0
    """

    __slots__ = ()

    def first_hit(
        self, tau: Any, v: Any, *, digits: int | None = None, tolerance: Any = None, horizon: Any = None,
        steps: int | None = None, out: Mapping[str, Any] | None = None,
    ) -> Flight:  # fmt: skip
        """The first hit F of flights from (tau, v): see `singimpact.flights.impact_map.first_hit`.

        Examples
        --------
        >>> import mpmath
        >>> hit = linear(2, "0.3", "0.5").first_hit("1.2", "1e-100", digits=30)
        >>> print(mpmath.nstr(hit.flight_time, 30))
        1.92790834380226439414926125583e-100
        """
        from singimpact.flights.impact_map import first_hit

        return first_hit(self, tau, v, digits=digits, tolerance=tolerance, horizon=horizon, steps=steps, out=out)

    def impact_map(
        self, tau: Any, v: Any, *, digits: int | None = None, tolerance: Any = None, horizon: Any = None,
        steps: int | None = None, out: Mapping[str, Any] | None = None,
    ) -> Step:  # fmt: skip
        """The impact map G(tau, v): see `singimpact.flights.impact_map.impact_map`.

        Examples
        --------
        >>> step = linear(2, "0.3", "0.5").impact_map([0, 2.9], [1, 0.5])
        >>> step.tau.round(12).tolist()
        [2.333796858489, 5.260348355721]
        """
        from singimpact.flights.impact_map import impact_map

        return impact_map(self, tau, v, digits=digits, tolerance=tolerance, horizon=horizon, steps=steps, out=out)

    def flight(self, tau: Any, v: Any, t: Any) -> Path:
        """x and x' at times t along one flight: see `singimpact.flights.path.path`."""
        from singimpact.flights.path import path

        return path(self, tau, v, t)

    def acceleration(self, tau: Any, order: int = 0) -> Any:
        """a_c(tau) = g(tau) - f(c, 0), or its derivative of an order.

        Examples
        --------
        >>> linear(2, 0, 1).acceleration([0, 1e3], order=1).tolist()
        [0.0, -1.860079008832274]
        """
        from singimpact.oscillator.acceleration import acceleration

        if isinstance(order, bool) or not isinstance(order, int) or not 0 <= order <= 60:
            raise refuse("order", order, "a whole number from 0 to 60")
        times = float_array("tau", tau)
        return acceleration(self, np.atleast_1d(times).ravel(), order).reshape(times.shape)[()]

    def iterate(self, tau: Any, v: Any, impacts: int = 100, *, keep: bool = False) -> Iterates:
        """G again and again for arrays of states.

        Parameters
        ----------
        tau, v : states that broadcast. impacts : flown from each. keep : all states, with a first axis of impacts + 1.

        Returns
        -------
        tau, v, status : the last states (an orbit that meets no further impact stays where it is), and 0 or the status
            of the flight that ended an orbit before.

        Examples
        --------
        >>> ends = linear("2.8", 0, "0.8").iterate([0.1, 0.2], 0.5, 1000)
        >>> ends.tau.shape, ends.status.tolist()
        ((2,), [0, 0])
        """
        from singimpact.flights.orbits import iterates

        return iterates(self, tau, v, whole("impacts", impacts, 0, 10**7), keep)

    def derivative(self, tau: Any, v: Any, *, horizon: Any = None) -> Derivative:
        """D G at states, from the variational equation: see `singimpact.flights.impact_map.derivative`."""
        from singimpact.flights.derivative import derivative

        return derivative(self, tau, v, horizon=horizon)

    def inverse_map(self, tau: Any, v: Any, *, digits: int | None = None, horizon: Any = None) -> Step:
        """G^{-1}: see `singimpact.flights.inverse.inverse_map`.

        Examples
        --------
        >>> osc = linear(2, "0.3", "0.5")
        >>> step = osc.impact_map(0, 1)
        >>> before = osc.inverse_map(step.tau, step.v)
        >>> abs(before.tau) < 1e-15, round(float(before.v), 14)
        (np.True_, 1.0)
        """
        from singimpact.flights.inverse_map import inverse_map

        return inverse_map(self, tau, v, digits=digits, horizon=horizon)

    def chatter_limit(self, tau: Any, v: Any, *, digits: int | None = None, impacts: int = 1_000_000) -> ChatterLimit:
        """Where infinitely many impacts accumulate: see `singimpact.dynamics.chatter.chatter_limit`."""
        from singimpact.dynamics.chatter import chatter_limit

        return chatter_limit(self, tau, v, digits=digits, impacts=impacts)

    def periodic(self, n: Any, k: int, start: Any = None, *, digits: int | None = None) -> PeriodicOrbits:
        """Orbits of n impacts in k periods: see `singimpact.branches.periodic.periodic`.

        Examples
        --------
        >>> found = linear(4, 0, "0.5").periodic(1, 2)
        >>> found.complete, f"{found[0].v[0]:.12f}"
        (True, '0.533333333333')
        """
        from singimpact.branches.periodic import periodic

        return periodic(self, n, k, start, digits=digits)

    def orbit(
        self, tau: Any = None, v: Any = None, impacts: int = 200, *, horizon: Any = None, x: Any = None,
        xdot: Any = None, t: Any = None,
    ) -> Orbit:  # fmt: skip
        """Impacts, chatter and rest in order, from (tau, v) or off the wall: see `singimpact.dynamics.orbit.orbit`."""
        from singimpact.dynamics.orbit import dropped_orbit, orbit

        if x is xdot is t is None:
            return orbit(self, tau, v, impacts, horizon=horizon)
        if tau is not None or v is not None or x is None or xdot is None or t is None:
            raise InputError(
                "an orbit starts from tau and v, or off the wall from x=, xdot= and t=: give either, whole"
            )
        return dropped_orbit(self, (x, xdot, t), impacts, horizon=horizon)

    def launch(self, x: Any, xdot: Any, t: Any, *, horizon: Any = None) -> Launched:
        """The first impact of flights that start off the wall: see `singimpact.flights.off_wall.launch`.

        Examples
        --------
        >>> first = ImpactOscillator("0", "-9.81", "0.1", "0.9").launch(x=1, xdot=0, t=0)
        >>> float(first.tau), float(first.v)
        (0.4283529368781193, 3.7819280796969155)
        """
        from singimpact.flights.off_wall import launch

        return launch(self, x, xdot, t, horizon=horizon)

    def to_toml(self) -> str:
        """The model as the text of a model file.

        Examples
        --------
        >>> print(linear(2, "0.3", "0.5").to_toml(), end="")
        f = "x"
        g = "cos(omega*t)"
        clearance = "0.3"
        restitution = "0.5"
        <BLANKLINE>
        [parameters]
        omega = "2"
        """
        from singimpact.oscillator.files import to_toml

        return to_toml(self.to_dict())


def linear(
    omega: Any,
    clearance: Any,
    restitution: Any,
    damping: Any = 0,
    stiffness: Any = 1,
    amplitude: Any = 1,
    phase: Any = 0,
) -> ImpactOscillator:
    """x'' + damping x' + stiffness x = amplitude cos(omega t + phase); terms at their defaults are left out.

    Parameters
    ----------
    omega, clearance, restitution, damping, stiffness, amplitude, phase : numbers; omega > 0.

    Examples
    --------
    >>> linear("2.8", 0, "0.8", damping="0.1")
    ImpactOscillator(f='x + damping*xdot', g='cos(omega*t)', clearance='0', restitution='0.8', parameters={'damping': '0.1', 'omega': '2.8'})
    """  # noqa: E501
    if compare(constant("omega", omega), 0) <= 0:
        raise refuse("omega", omega, "a number > 0")
    given = {"damping": (damping, 0), "stiffness": (stiffness, 1), "amplitude": (amplitude, 1), "phase": (phase, 0)}
    changed = {name: value for name, (value, usual) in given.items() if compare(constant(name, value), usual)}
    force = ("stiffness*x" if "stiffness" in changed else "x") + (" + damping*xdot" if "damping" in changed else "")
    wave = "cos(omega*t + phase)" if "phase" in changed else "cos(omega*t)"
    forcing = f"amplitude*{wave}" if "amplitude" in changed else wave
    return ImpactOscillator(force, forcing, clearance, restitution, {"omega": omega, **changed})


def universal(kappa: Any, restitution: Any) -> ImpactOscillator:
    """x'' = 12 kappa (t^2 - 1), c = 0: the unfolded swan, positive for kappa > 0, negative for kappa < 0.

    Examples
    --------
    >>> step = universal(-1, "0.5").impact_map(-1, 0)
    >>> float(step.tau), float(step.v)
    (3.0, 32.0)
    """
    if not compare(constant("kappa", kappa), 0):
        raise refuse("kappa", kappa, "a number other than 0")
    return ImpactOscillator("0", "12*kappa*(t**2 - 1)", 0, restitution, {"kappa": kappa})


def shaken_wall(
    f: Any, g: Any, wall: Any, restitution: Any, parameters: Mapping[str, Any] | None = None, period: Any = None
) -> ShakenWall:
    """x'' + f(x, x') = g(t), x >= wall(t), in the wall's frame: see `singimpact.oscillator.shaken_wall.shaken_wall`.

    Examples
    --------
    >>> table = shaken_wall("0", "-9.81", "sin(7*t)/5", "1/2")  # a ball on a shaken table
    >>> step = table.oscillator.impact_map(0.1, 1.0)
    >>> [round(float(part), 9) for part in table.back(step.tau, 0, step.v)]
    [-0.195800568, 1.20422441]
    """
    from singimpact.oscillator.shaken_wall import shaken_wall

    return shaken_wall(f, g, wall, restitution, parameters, period, kind=ImpactOscillator)


def read_model(path: str | FilePath) -> ImpactOscillator:
    """The model in a TOML file with f, g, clearance, restitution and perhaps parameters and period."""
    from singimpact.oscillator.files import read_fields

    return ImpactOscillator(**read_fields(path))


def tangency_points(oscillator: Oscillator, digits: int = 30) -> TangencyPoints:
    """The zeros of a_c over one period, or all real ones when g is a polynomial: see `singimpact.contact.points`.

    Examples
    --------
    >>> points = tangency_points(linear(2, "0.3", "0.5"))
    >>> points.kind, points.tau.round(6).tolist()
    (('foliation', 'gamma'), [0.633052, 2.508541])
    >>> print(tangency_points(linear(2, "0.3", "0.5"), digits=60).certified()[1])
    2.50854081720004368283298401807339174662515706538471755942770
    """
    from singimpact.contact.points import tangency_points as found

    return found(oscillator, digits)


def swan_points(
    f: Any, g: Any, parameters: Mapping[str, Any] | None = None, over: str = "clearance", between: Any = None
) -> tuple[SwanPoint, ...]:
    """The swan points of x'' + f(x, x') = g(t) as the clearance varies, in the order of tau_*.

    Parameters
    ----------
    f, g, parameters : as for `ImpactOscillator`. over : "clearance".
    between : (low, high), clearances to look between; None for all, where f(x, 0) is a polynomial.

    Returns
    -------
    tuple of SwanPoint : each with `.tau`, `.clearance` (c_0), `.kind` ("positive" | "negative"), `.certified(digits)`
        and `.oscillator(restitution)`, the model exactly at c_0.

    Examples
    --------
    >>> [(swan.kind, swan.clearance) for swan in swan_points("x", "cos(2*t)")]
    [('negative', 1.0), ('positive', -1.0)]
    >>> print(swan_points("x + 3*x**3/10", "cos(2*t)")[0].oscillator("0.5").clearance)
    root(u + 0.3*u**3 - 1, 0.829051, 0.829052)
    """
    from singimpact.contact.swans import swan_points_over_clearance

    if over != "clearance":
        raise refuse("over", over, "'clearance'")
    model = ImpactOscillator(f, g, 0, 1, parameters)
    return swan_points_over_clearance(model, None if between is None else clearances(between))


def _bound(end: Any) -> Fraction:
    tree = constant("between", end)
    exact = as_fraction(tree)
    return Fraction(as_float(tree)) if exact is None else exact


def clearances(between: Any) -> tuple[Fraction, Fraction]:
    """Two clearances, the lower first, as exact fractions.

    Examples
    --------
    >>> clearances(("-1/3", "0.5"))
    (Fraction(-1, 3), Fraction(1, 2))
    """
    try:
        low, high = (_bound(end) for end in between)
    except (TypeError, ValueError) as error:
        raise error if isinstance(error, InputError) else refuse("between", between, "two numbers low < high") from None
    if not low < high:
        raise refuse("between", between, "two numbers low < high")
    return low, high


def threshold(osc: Oscillator, tau: Any, *, digits: int | None = None, impacts: int = 640_000) -> Threshold:
    """The v on gamma over tau: see `singimpact.dynamics.threshold.threshold`.

    Examples
    --------
    >>> print(f"{threshold(linear('2.8', 0, '0.5'), 'pi/2.8').v:.12f}")
    0.100869991269
    """
    from singimpact.dynamics.threshold import threshold

    return threshold(osc, tau, digits=digits, impacts=impacts)


def lyapunov(osc: Oscillator, tau: Any, v: Any, impacts: int = 10_000, *, transient: int = 0) -> Lyapunov:
    """Both Lyapunov exponents of an orbit, with standard errors: see `singimpact.dynamics.lyapunov.lyapunov`.

    Examples
    --------
    >>> lyapunov(linear("0.9", "0.2", "0.4"), "0.3", "0.4")
    Lyapunov(superstable: the orbit comes to rest, 10 impacts)
    """
    from singimpact.dynamics.lyapunov import lyapunov

    _require_model(osc)
    return lyapunov(osc, tau, v, impacts, transient=transient)


def branch(
    orbit: PeriodicOrbit, over: str = "clearance", between: Any = None, *, points: int = 2000, step: float | None = None
) -> Branch:
    """A periodic orbit followed as a number of its model moves: see `singimpact.branches.branch.branch`.

    Examples
    --------
    >>> osc = linear("0.8", -1, "0.8", damping="0.1", amplitude="-0.45")
    >>> found = branch(osc.periodic(1, 1)[0], over="amplitude", between=(-0.5, -0.3))
    >>> print(found.events[-1])
    <graze of impact 1 at amplitude = -0.368781778292>
    """
    from singimpact.branches.branch import branch

    return branch(orbit, over, between, points=points, step=step)


def event_curve(
    event: Event, over: Any = ("clearance", "restitution"), between: Any = None, *, points: int = 1000,
    step: float | None = None,
) -> EventCurve:  # fmt: skip
    """The curve of an event of a branch in two numbers: see `singimpact.branches.event_curve.event_curve`."""
    from singimpact.branches.event_curve import event_curve

    return event_curve(event, over, between, points=points, step=step)


def basins(osc: Oscillator, window: Any = None, size: int = 600, *, executor: Any = None, output: Any = None) -> Basins:
    """What the orbits of a grid of launches do for ever: n impacts in k periods, chatter, rest, chaos.

    Parameters
    ----------
    osc : a model with a period. window : ((tau_low, tau_high), (v_low, v_high)); one period and (0, 2) without it.
    size : states a side, from 2 to 10000. executor, output : as for `sweep`, where some rows of the grid are a case;
        without an executor threads, as many as there are cores.

    Returns
    -------
    Basins : `.codes`, shape (size, size), numbers of the classes in `.attractors`; `.classes` has their names and
        shares, `.first_chatter_completes` is an array of bool. `si.plot` draws it, `.to_csv(file)` writes it.

    Raises
    ------
    InputError : a model without a period, or a window or a size that is none.

    Examples
    --------
    >>> basins(linear(2, "0.7", "0.5"), ((0, 3), (0, 1)), 8)
    Basins(8 x 8 states: (inf, 1) chatter for ever 100 %)
    """
    from singimpact.dynamics.basins import basins

    whole("size", size, 2, 10_000)
    tau, v = (None, (0, 2)) if window is None else _two_ends(window, "((tau_low, tau_high), (v_low, v_high))")
    return basins(osc, tau, v, size, executor, output)


def bifurcation(
    osc: Oscillator, over: str, between: Any, points: int = 300, *, start: Any = (0, "0.1"), impacts: int = 200,
    kept: int = 60, direction: str | None = None, **sweeping: Any,
) -> Bifurcation:  # fmt: skip
    """Where orbits settle as a number of the model moves: the last events of one orbit for each value.

    Parameters
    ----------
    osc : a model with a period. over : "clearance", "restitution", a parameter, "amplitude", "damping", "stiffness" or
        "phase" (the model need not name them). between : its ends. points : values, evenly spaced.
    start : the first state (tau, v) of each orbit. impacts : flown for each value.
    kept : events of the end of an orbit that are returned. sweeping : `executor` and `output` of `sweep`.
    direction : "up", "down", "both": each orbit starts from the last state of the one before, so hysteresis shows.

    Returns
    -------
    Bifurcation : `.values`, shape (points,), and `.events`, shape (points, kept, 3): phase, v and 1 where chatter has
        ended; nan where an orbit had fewer. `si.plot` draws it, `.to_csv(file)` writes it.

    Raises
    ------
    InputError : a model without a period, a number it does not have, ends that are none.

    Examples
    --------
    >>> found = bifurcation(linear(2, 0, "0.5"), "clearance", ("0.2", "0.3"), 2, impacts=60, kept=4)
    >>> found
    Bifurcation(over clearance: 2 values from 0.2 to 0.3, 4 events of each)
    >>> found.events[0, :, 1].round(6).tolist()
    [1.066667, 1.066667, 1.066667, 1.066667]
    """
    from singimpact.dynamics.bifurcation import bifurcation

    for name in sweeping:
        if name not in ("executor", "output"):
            raise unknown(
                "argument of bifurcation", name, ["executor", "output", "start", "impacts", "kept", "direction"]
            )
    return bifurcation(osc, over, between, points, start, impacts, kept, direction, **sweeping)


def classify(osc: Oscillator, window: Any = None, between: Any = None) -> Classification:
    """The singular points of p and phi on V_c': tangencies, swans, cusps, and the fold lines between them.

    Parameters
    ----------
    osc : the model. window : ((tau_low, tau_high), (t_low, t_high)); without it one period of tau and as much on both
        sides of t = 0, or what holds all zeros of a_c when g is a polynomial.
    between : two clearances to look for swans between; all where they can be isolated, when it is not given.

    Returns
    -------
    Classification : `.points`, `.folds`, `.swans`, and `.notes` on what was not decided.

    Examples
    --------
    >>> classify(universal(-1, "0.5"))
    Classification(cusp 4, tangency 2; fold lines 4; swans over the clearance 0)
    """
    from singimpact.surface.classification import classify

    tau, t = (None, None) if window is None else _two_ends(window, "((tau_low, tau_high), (t_low, t_high))")
    return classify(osc, tau, t, None if between is None else clearances(between))


def grown_gamma(osc: Oscillator, window: Any = None, tau: Any = None) -> list[Curve]:
    """gamma from its series at a tangency or swan point to the edge of a window of the plane of states.

    Parameters
    ----------
    osc : the model. window : ((tau_low, tau_high), (v_low, v_high)); without it a period on both sides of tau = 0 (the
        zeros of a_c with room about them, when g is a polynomial) and (0, 2).
    tau : the point; without one the first that has an invariant curve.

    Returns
    -------
    list of Curve : in (tau, v), in order of hit history, the first from (tau_*, 0) on. `si.plot` draws it.

    Raises
    ------
    InputError : no such point, or a window that is none.

    Examples
    --------
    >>> curve = grown_gamma(universal(1, "0.5"), ((-2, 1), (0, 20)), 1)[0]
    >>> curve.points[0].tolist(), curve.points[-1].round(3).tolist()
    ([1.0, 0.0], [-1.385, 0.0])
    """
    from singimpact.dynamics.invariant_arcs import grown_gamma
    from singimpact.surface.classification import default_window
    from singimpact.surface.curve import STATES, Window

    _require_model(osc)
    if not isinstance(window, Window):
        low, high = default_window(osc)[0]
        usual = ((low - high if osc.period is not None else low, high), (0, 2))
        named = "((tau_low, tau_high), (v_low, v_high))"
        tau_ends, v_ends = usual if window is None else _two_ends(window, named)
        window = Window.read(tau_ends, v_ends, axes=STATES)
    return grown_gamma(osc, window, tau)


def _require_model(osc: Any) -> None:
    if not isinstance(osc, Oscillator):
        raise refuse("osc", osc, "an ImpactOscillator")


def _two_ends(window: Any, accepted: str) -> tuple[Any, Any]:
    """The ranges of both axes."""
    ranges = (window.x, window.y) if hasattr(window, "x") and hasattr(window, "y") else window
    if not isinstance(ranges, tuple | list) or len(ranges) != 2:
        raise refuse("window", window, accepted)
    return ranges[0], ranges[1]


def sweep(function: Any, cases: Any, executor: Any = None, output: str | FilePath | None = None) -> Any:
    """function(case) for every case, on an executor, kept in a file: see `singimpact.cases.sweep`.

    Examples
    --------
    >>> import math
    >>> sweep(math.sqrt, [1.0, 4.0]).tolist()
    [1.0, 2.0]
    """
    from singimpact.cases import sweep

    return sweep(function, cases, executor, output)
