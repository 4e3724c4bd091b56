"""`ImpactOscillator`: the model with methods, each a call of one function of a sub-package."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import inf
from typing import TYPE_CHECKING, Any

import numpy as np

from singimpact.algebra.numbers import compare, constant
from singimpact.handed_on import Study
from singimpact.inputs import (
    InputError,
    checked_keywords,
    checked_methods,
    refuse,
    require,
    takes_two_walls,
    whole,
    with_walls,
)
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.moving_number import UPPER

if TYPE_CHECKING:
    from pathlib import Path as FilePath

    from singimpact.branches.orbits import PeriodicOrbits
    from singimpact.dynamics.chatter import ChatterLimit
    from singimpact.dynamics.families import OscillatorFamily
    from singimpact.dynamics.gamma_proof.proof import CertifiedGamma
    from singimpact.dynamics.orbit import Orbit
    from singimpact.flights.enclosed_impact import EnclosedImpact
    from singimpact.flights.flight_path import Path
    from singimpact.flights.off_wall import Launched
    from singimpact.flights.orbits import Ends as Iterates
    from singimpact.flights.results import Derivative, Flight, Step
    from singimpact.oscillator.shaken_wall import ShakenWall


def _at_walls(method: Callable[..., Any], osc: Oscillator, wall: Any, states: tuple[Any, ...], options: Any) -> Any:
    from singimpact.flights.walls import shared_out

    return shared_out(method, osc, wall, states, options)


@checked_methods
class ImpactOscillator(Oscillator):
    """x'' + f(x, x', t) = g(t), x >= clearance, v -> -restitution v; parameters as in `Oscillator`.

    Examples
    --------
    >>> osc = ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(omega*t)", 0.3, 0.6, {"omega": 1.7})
    >>> step = osc.impact_map(1.5, 1e-3)
    >>> print(f"{step.v:.12f}", step.status)
    0.000600256662 0
    """

    __slots__ = ()

    # studies of the model as a whole, each documented as a function of `singimpact`
    basins, bifurcation, lyapunov, threshold = Study(), Study(), Study(), Study()
    tangency_points, classify, grown_gamma, release_map = Study(), Study(), Study(), Study()
    border_orbits, resting_windows, certified_diagram, transitions = Study(), Study(), Study(), Study()
    contact_points, explore, selftest = Study(), Study(), Study()
    ensemble, regions, fit, sensitivity = Study(), Study(), Study(), Study()

    @with_walls(_at_walls)
    def first_hit(
        self,
        tau: Any,
        v: Any,
        *,
        digits: int | None = None,
        tolerance: Any = None,
        horizon: Any = None,
        steps: int | None = None,
        out: Mapping[str, Any] | None = None,
        threads: int | None = None,
    ) -> Flight:
        """The first hit F of the wall for flights from (tau, v).

        Parameters
        ----------
        tau : launch times. v : launch velocities >= 0; they broadcast. A float is its binary value, the text "0.3" is
            exactly 3/10.
        digits : decimal digits of the result, which then holds mpmath numbers. horizon : flight time at which the
            search ends; without it 1000 periods of the forcing, or more where the motion is slow beside it.
        tolerance : relative error of a step of a nonlinear flight. steps : Taylor steps at most. out : arrays
            to write the results to, by field. threads : that share out an array, two without it.
        wall : of the states of a model with two walls: "lower" (also without it), "upper", or an array of them.

        Returns
        -------
        Flight : `.flight_time`, `.velocity` (x' at the hit, <= 0), `.status`, `.error`, `.condition`, of their shape.

        Examples
        --------
        >>> import mpmath
        >>> hit = linear(2, "0.3", "0.5").first_hit("1.2", "1e-100", digits=30)
        >>> print(mpmath.nstr(hit.flight_time, 30))
        1.92790834380226439414926125583e-100
        """
        from singimpact.flights.impact_map import first_hit

        if threads is None:
            return first_hit(self, tau, v, digits=digits, tolerance=tolerance, horizon=horizon, steps=steps, out=out)
        from singimpact.flights.interruptible import on_threads

        with on_threads(threads):
            return first_hit(self, tau, v, digits=digits, tolerance=tolerance, horizon=horizon, steps=steps, out=out)

    @with_walls(_at_walls)
    def impact_map(
        self,
        tau: Any,
        v: Any,
        *,
        digits: int | None = None,
        tolerance: Any = None,
        horizon: Any = None,
        steps: int | None = None,
        out: Mapping[str, Any] | None = None,
        threads: int | None = None,
    ) -> Step:
        """The impact map G: the next impact of flights from (tau, v), and the velocity after it.

        Parameters
        ----------
        tau, v, digits, tolerance, horizon, steps, out, threads, wall : as for `first_hit`.

        Returns
        -------
        Step : `.tau` and `.v` of the next impact, and the fields of `first_hit`. Without an impact tau is inf or nan
            and v is nan; `.status` gives the reason. With two walls `.wall` is that of the next state, 0 or 1.

        Examples
        --------
        >>> step = linear(2, "0.3", "0.5").impact_map([0, 2.9], [1, 0.5])
        >>> step.tau.round(12).tolist()
        [2.333796858489, 5.260348355721]
        """
        from singimpact.flights.impact_map import impact_map

        if threads is None:
            return impact_map(self, tau, v, digits=digits, tolerance=tolerance, horizon=horizon, steps=steps, out=out)
        from singimpact.flights.interruptible import on_threads

        with on_threads(threads):
            return impact_map(self, tau, v, digits=digits, tolerance=tolerance, horizon=horizon, steps=steps, out=out)

    def enclosed_impact(
        self, tau: Any, v: Any, *, radii: Mapping[str, Any] | None = None, digits: int = 30, horizon: Any = None
    ) -> EnclosedImpact:
        """The next impact of all states, and of all numbers of the model, within `radii` of given ones: proved.

        Parameters
        ----------
        tau, v : the centre of the box, v > 0. radii : name -> radius of "tau", "v", "clearance", "restitution" or a
            parameter. digits : of a point, or of the centre. horizon : as for `first_hit`.

        Returns
        -------
        EnclosedImpact : `.flight_time`, `.velocity`, `.tau`, `.v` and `.derivative` (D G, then columns by the numbers
            of the model), each with `.value` and `.radius`; `.status` and `.note`.

        Examples
        --------
        >>> duffing = ImpactOscillator("x + x**3", "cos(1.7*t)", "0.3", "0.6")
        >>> duffing.enclosed_impact("1.4", "0.6", radii={"tau": "1e-9", "v": "1e-9"}, digits=15).v
        Certified(0.361541072319587 +- 6.7e-10)
        """
        from singimpact.flights.enclosed_impact import enclosed_impact

        return enclosed_impact(self, tau, v, radii=radii, digits=digits, horizon=horizon)

    def flight(self, tau: Any, v: Any, t: Any) -> Path:
        """x and x' along one flight, continued behind the wall.

        Parameters
        ----------
        tau, v : one launch. t : times after it (negative: before), any shape.

        Examples
        --------
        >>> linear(2, "0.3", "0.5").flight(0, 1, [0, 1]).x.round(6).tolist()
        [0.3, 1.322378]
        """
        from singimpact.flights.flight_path import path

        return path(self, tau, v, t)

    @takes_two_walls
    def acceleration(self, tau: Any, order: int = 0, wall: Any = None) -> Any:
        """a_c(tau) = g(tau) - f(c, 0, tau), or its derivative of an order.

        Parameters
        ----------
        tau : times. order : from 0 to 60. wall : of a model with two; at the upper one a_c > 0 is away from it too.

        Examples
        --------
        >>> linear(2, 0, 1).acceleration([0, 1e3], order=1).tolist()
        [0.0, -1.860079008832274]
        """
        from singimpact.flights.states import States
        from singimpact.flights.walls import wall_codes
        from singimpact.oscillator.wall_acceleration import acceleration, acceleration_at, at_exactly

        above = wall_codes(self, wall)
        if above.any():
            return np.where(above, self.mirrored.acceleration(tau, order), self.acceleration(tau, order))[()]
        if type(tau) is float and type(order) is int and order == 0 and abs(tau) < inf:
            return np.float64(acceleration_at(self, tau))
        if isinstance(order, bool) or not isinstance(order, int) or not 0 <= order <= 60:
            raise refuse("order", order, "a whole number from 0 to 60")
        states = States.read(tau, 0.0).in_period(self)
        values = acceleration(self, states.tau, order)
        if self.period is None:  # nothing takes in what a double loses of a late time
            for index in np.flatnonzero(states.below_doubles()).tolist():
                values[index] = at_exactly(self, states.exact_tau(index), order)
        return values.reshape(states.shape)[()]

    @takes_two_walls
    def iterate(
        self, tau: Any, v: Any, impacts: int = 100, *, keep: bool = False, threads: int | None = None, wall: Any = None
    ) -> Iterates:
        """Many impacts of each of many states: iterates of the impact map G.

        Parameters
        ----------
        tau, v : states that broadcast. impacts : for each state. keep : return all states, with a first axis of
            length impacts + 1. threads, wall : as for `first_hit`.

        Returns
        -------
        tau, v, status : the last states, and 0; or, of an orbit that ended early, its last impact and the status of
            the flight after it; with restitution 0 `sticks` where the mass rests. wall : of the states, of a model with
            two walls.

        Examples
        --------
        >>> ends = linear("2.8", 0, "0.8").iterate([0.1, 0.2], 0.5, 1000)
        >>> ends.tau.shape, ends.status.tolist()
        ((2,), [0, 0])
        """
        from singimpact.flights.interruptible import on_threads
        from singimpact.flights.orbits import iterates

        with on_threads(threads):
            return iterates(self, tau, v, whole("impacts", impacts, 0, 10**7), keep, wall)

    @takes_two_walls
    def derivative(self, tau: Any, v: Any, *, horizon: Any = None, wall: Any = None) -> Derivative:
        """D G, the derivative of the impact map, from the variational equation.

        Parameters
        ----------
        tau, v : states, v >= 0; they broadcast. horizon, wall : as for `first_hit`.

        Returns
        -------
        Derivative : `.matrix`, shape (..., 2, 2), rows tau' and v', columns tau and v; nan without one; `.status`.

        Examples
        --------
        >>> universal(-1, "0.5").derivative(-1, 1).matrix.shape
        (2, 2)
        """
        from singimpact.flights.derivative import derivative

        return derivative(self, tau, v, horizon=horizon, wall=wall)

    @takes_two_walls
    def inverse_map(
        self, tau: Any, v: Any, *, digits: int | None = None, horizon: Any = None, wall: Any = None
    ) -> Step:
        """The inverse G^{-1}: the state whose next impact leaves (tau, v).

        Parameters
        ----------
        tau, v : states just after an impact. digits, horizon, wall : as for `first_hit`; `.wall` is that of the state
            before.

        Examples
        --------
        >>> osc = linear(2, "0.3", "0.5")
        >>> step = osc.impact_map(0, 1)
        >>> before = osc.inverse_map(step.tau, step.v)
        >>> bool(abs(before.tau) < 1e-15), round(float(before.v), 14)
        (True, 1.0)
        """
        from singimpact.flights.inverse_map import inverse_map

        return inverse_map(self, tau, v, digits=digits, horizon=horizon, wall=wall)

    @takes_two_walls
    def chatter_limit(
        self, tau: Any, v: Any, *, digits: int | None = None, impacts: int = 1_000_000, wall: Any = None
    ) -> ChatterLimit:
        """The time at which infinitely many impacts accumulate; with restitution 0 that of the first impact.

        Parameters
        ----------
        tau, v : states, v >= 0; they broadcast. digits : decimal digits of the time, certified where
            the restitution is a number.
        impacts : at most; the status is then `unresolved`. wall : as for `first_hit`.

        Returns
        -------
        ChatterLimit : `.tau`, `.error`, `.impacts` flown, and `.status`, `complete` or `lifts_off` among others.

        Examples
        --------
        >>> linear("2.8", 0, "0.8").chatter_limit("0.9", "0.005").tau.round(12)
        np.float64(0.959359234422)
        """
        from singimpact.dynamics.chatter import chatter_limit

        return chatter_limit(self, tau, v, digits=digits, impacts=impacts, wall=wall)

    def certified_gamma(
        self, tau: Any = None, *, reach: Any = None, restitution: tuple[Any, Any] | None = None
    ) -> CertifiedGamma:
        """gamma before the next zero of a_c, proved: it exists, is unique, and decides the fate of every launch.

        Parameters
        ----------
        tau : a phase with a_c(tau) < 0; None for the first of a period. reach : launches with
            tan(omega_d (tau_* - tau))/omega_d, for a nonlinear model tau_* - tau, up to this rational number; None for
            as far as the proof gets. restitution : (low, high) for a proof for all r of an interval.

        Returns
        -------
        CertifiedGamma : `.reach`, `.series`, `.threshold(tau)`, `.notes`; `si.certify` makes it a file.

        Raises
        ------
        InputError : f or g is not analytic, r is no number, no gamma lies ahead, or no reach is proved; the reason.

        Examples
        --------
        >>> linear(2, "0.3", "0.5").certified_gamma(reach="1/4").threshold("2.4")
        Certified(0.0034539185342858600992 +- 3.7e-9)
        """
        from singimpact.dynamics.gamma_proof.proof import certified_gamma

        return certified_gamma(self, tau, reach=reach, restitution=restitution)

    @takes_two_walls
    def periodic(
        self, n: Any, k: int | None = None, start: Any = None, *, v: Any = None, digits: int | None = None
    ) -> PeriodicOrbits:
        """The periodic orbits of n impacts in k periods of the forcing.

        Parameters
        ----------
        n : impacts; `math.inf` for orbits that chatter to rest, 0 for orbits without impact; with two walls a word such
            as "lu". k : periods.
        start : states to start from, (tau, v) or n of them, or an orbit. digits : decimal digits of the orbits.
        v : (low, high), the velocities for which `.complete` is to be proved; of linear models none are needed.

        Returns
        -------
        list of PeriodicOrbit : with `.complete`, True if it is shown that there are no others, and `.notes`, why not.
            Of a family, `osc.over(...).periodic(n, k)`, the orbits of all models in one list of arrays.

        Examples
        --------
        >>> found = linear(4, 0, "0.5").periodic(1, 2)
        >>> found.complete, f"{found[0].v[0]:.12f}"
        (True, '0.533333333333')
        """
        from singimpact.branches.periodic import periodic

        return periodic(self, n, k, start, v=v, digits=digits)

    @takes_two_walls
    def orbit(
        self,
        tau: Any = None,
        v: Any = None,
        impacts: int = 200,
        *,
        horizon: Any = None,
        x: Any = None,
        xdot: Any = None,
        t: Any = None,
        wall: Any = None,
    ) -> Orbit:
        """The orbit of one state: impacts, complete chatter, rest and lift-off in order.

        Parameters
        ----------
        tau, v : the state just after an impact; or x, xdot, t : a start off the wall.
        impacts : flights at most; a complete chatter counts as one. horizon, wall : as for `first_hit`.

        Returns
        -------
        Orbit : `.tau`, `.v`, `.kind` of events, `.wall` where there are two, `.phases` between them; `.sample(t)`,
            `.section()`, `.to_csv(file)`.

        Examples
        --------
        >>> linear("2.8", 0, "0.8").orbit("0.9", "0.005").kind[:3].tolist()
        ['start', 'impact', 'impact']
        """
        from singimpact.dynamics.orbit import dropped_orbit, orbit

        if x is xdot is t is None and tau is not None:
            return orbit(self, tau, v, impacts, horizon=horizon, wall=wall)
        if wall is not None or tau is not None or v is not None or x is None or xdot is None or t is None:
            raise InputError(
                "an orbit starts from tau and v, or off the wall from x=, xdot= and t=: give all of one kind"
            )
        return dropped_orbit(self, (x, xdot, t), impacts, horizon=horizon)

    @takes_two_walls
    def release(self, tau: float, wall: Any = None) -> float:
        """The lift-off time of a mass at rest at tau: tau if a_c(tau) > 0, else the next rise of a_c through 0.

        Parameters
        ----------
        tau : a time. wall : on which the mass rests, of a model with two: "lower" (also without it) or "upper".

        Examples
        --------
        >>> print(f"{linear(2, '0.3', '0.5').release(1.2):.12f}")
        2.508540817200
        """
        from singimpact.dynamics.lift_off import release
        from singimpact.flights.states import States
        from singimpact.flights.walls import wall_codes

        if wall_codes(self, wall).any():
            return self.mirrored.release(tau)
        states = States.read(tau, 0.0).in_period(self)
        require(not states.shape, "tau", tau, "one number")
        start = float(states.tau[0])
        return (start if self.acceleration(tau) > 0 else release(self, start)) + float(np.ravel(states.turns)[0])

    @takes_two_walls
    def launch(self, x: Any, xdot: Any, t: Any, *, horizon: Any = None) -> Launched:
        """The first impact of flights that start off the wall.

        Parameters
        ----------
        x, xdot, t : displacements x >= c, velocities of either sign, times; they broadcast.

        Returns
        -------
        Launched : the state `.tau`, `.v` after the impact, `.flight_time`, `.velocity` before it, `.status`.

        Examples
        --------
        >>> first = ImpactOscillator("0", "-9.81", "0.1", "0.9").launch(x=1, xdot=0, t=0)
        >>> float(first.tau), float(first.v)
        (0.4283529368781193, 3.7819280796969155)
        """
        from singimpact.flights.off_wall import launch

        return launch(self, x, xdot, t, horizon=horizon)

    @takes_two_walls
    def over(self, **numbers: Any) -> OscillatorFamily:
        """Models that differ from this in numbers: a family, flown in compiled loops.

        Parameters
        ----------
        numbers : arrays, or numbers, that broadcast: clearance, restitution, parameters, of two walls `upper` and
            `upper_restitution`, and what `bifurcation` puts in (amplitude, damping, stiffness, phase).

        Returns
        -------
        OscillatorFamily : `.impact_map`, `.iterate`, `.lyapunov`; `many[i]` is one of the models.

        Examples
        --------
        >>> linear(2, 0, "1/2").over(omega=[2, 3], clearance=[[0], [0.1]]).shape
        (2, 2)
        """
        from singimpact.dynamics.families import OscillatorFamily

        return OscillatorFamily(self, numbers)

    @takes_two_walls
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
        from singimpact.oscillator.model import to_toml

        return to_toml(self.to_dict())


@checked_keywords
def linear(
    omega: Any,
    clearance: Any,
    restitution: Any,
    damping: Any = 0,
    stiffness: Any = 1,
    amplitude: Any = 1,
    phase: Any = 0,
    upper: Any = None,
) -> ImpactOscillator:
    """x'' + damping x' + stiffness x = amplitude cos(omega t + phase); terms with default values are left out.

    Parameters
    ----------
    omega, clearance, restitution, damping, stiffness, amplitude, phase : numbers; omega > 0.
    upper : place of a second wall, whose restitution is that of the first; or (upper, upper_restitution).

    Examples
    --------
    >>> linear("2.8", 0, "0.8", damping="0.1")
    ImpactOscillator(f='x + damping*xdot', g='cos(omega*t)', clearance='0', restitution='0.8', parameters={'damping': '0.1', 'omega': '2.8'})
    """  # noqa: E501
    require(compare(constant("omega", omega), 0) > 0, "omega", omega, "a number > 0")
    numbers = {"damping": (damping, 0), "stiffness": (stiffness, 1), "amplitude": (amplitude, 1), "phase": (phase, 0)}
    changed = {name: value for name, (value, usual) in numbers.items() if compare(constant(name, value), usual)}
    force = ("stiffness*x" if "stiffness" in changed else "x") + (" + damping*xdot" if "damping" in changed else "")
    wave = "cos(omega*t + phase)" if "phase" in changed else "cos(omega*t)"
    forcing = f"amplitude*{wave}" if "amplitude" in changed else wave
    above = dict(zip(UPPER, upper if isinstance(upper, tuple) and len(upper) == 2 else (upper,), strict=False))
    return ImpactOscillator(force, forcing, clearance, restitution, {"omega": omega, **changed}, **above)


@checked_keywords
def universal(kappa: Any, restitution: Any) -> ImpactOscillator:
    """x'' = 12 kappa (t^2 - 1), c = 0: the unfolded swan, positive for kappa > 0, negative for kappa < 0.

    Examples
    --------
    >>> step = universal(-1, "0.5").impact_map(-1, 0)
    >>> float(step.tau), float(step.v)
    (3.0, 32.0)
    """
    require(compare(constant("kappa", kappa), 0), "kappa", kappa, "a number other than 0")
    return ImpactOscillator("0", "12*kappa*(t**2 - 1)", 0, restitution, {"kappa": kappa})


@checked_keywords
def shaken_wall(
    f: Any, g: Any, wall: Any, restitution: Any, parameters: Mapping[str, Any] | None = None, period: Any = None
) -> ShakenWall:
    """x'' + f(x, x') = g(t) above a wall that moves, in the frame of the wall.

    Parameters
    ----------
    f, g, restitution, parameters, period : as for `ImpactOscillator`. wall : position of the wall, an expression in t.

    Returns
    -------
    ShakenWall : `.oscillator`, the model of x - wall(t) >= 0, and `.back(t, x, xdot)`, the motion in the frame at
        rest.

    Examples
    --------
    >>> table = shaken_wall("0", "-9.81", "sin(7*t)/5", "1/2")  # a ball on a shaken table
    >>> step = table.oscillator.impact_map(0.1, 1.0)
    >>> [round(float(part), 9) for part in table.back(step.tau, 0, step.v)]
    [-0.195800568, 1.20422441]
    """
    from singimpact.oscillator.shaken_wall import shaken_wall

    return shaken_wall(f, g, wall, restitution, parameters, period, kind=ImpactOscillator)


@checked_keywords
def read_model(path: str | FilePath) -> ImpactOscillator:
    """The model in a TOML file with f, g, clearance, restitution and perhaps parameters and period.

    Parameters
    ----------
    path : the file, as `to_toml` writes it.

    Raises
    ------
    InputError : a file that cannot be read, or a field that is none of these.
    """
    from singimpact.oscillator.model import read_fields

    return ImpactOscillator(**read_fields(path))
