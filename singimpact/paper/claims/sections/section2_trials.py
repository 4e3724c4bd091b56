"""Sections 2 and 3: what is printed and what is corrected there, tried on two models."""

from typing import Any

import numpy as np

from singimpact.impact_oscillator import ImpactOscillator
from singimpact.paper.claims.claim import Trial, Trials, at_each, compared
from singimpact.paper.trials import arcs, surfaces
from singimpact.paper.trials.true_orbits import return_time, scipy_flow
from singimpact.paper.trials.true_sheet import Place, damped, number, regular, tangencies
from singimpact.status import Status


def slope_at_rest(point: Place) -> float:
    """dv_c/dt at t = 0 on true flights."""
    return point.leading(lambda h: point.launch(0.0, h) / h)


def second_component(point: Place, printed: object, corrected: object) -> Trial:
    """x-dot of a first hit on a true flight, against x-dot at the time that each statement takes."""
    t = float(point.model.first_hit(point.tau, 0.3).flight_time)
    at = [float(point.model.flight(point.tau, 0.3, number(time, {"t": t})).xdot) for time in (printed, corrected)]
    truth = float(surfaces.flow(point.model)(point.tau, surfaces.clearance(point.model), 0.3, t)[1])
    return compared(point.name, "second component of phi", truth, *at)


def _horizon(point: Place, *_: object) -> Trial:
    """At a regular point of Pi_0 x-dot is 0; it is singular for p only if dv_c/dt is 0 too."""
    return compared(point.name, "dv_c/dt at (tau, 0; 0), a != 0", slope_at_rest(point), 0.0, -point.jets()["a"] / 2)


def _phi_singular(point: Place, *_: object) -> Trial:
    """det D phi = d(x-dot)/dt - d(x-dot)/dsigma as t -> 0 at a tangency point, from differences on true flights."""
    value = point.leading(lambda h: _determinant(point, h))
    zero = abs(value) < 1e-3
    return Trial(point.name, "det D phi at the tangency point", f"{value:.1e}", "not 0", "0", not zero, zero)


def _determinant(point: Place, t: float) -> float:
    step = t / 4
    by_t = point.impact(0.0, t + step) - point.impact(0.0, t - step)
    return (by_t - point.impact(step, t) + point.impact(-step, t)) / (2 * step)


s = surfaces.PATH
# Flights from rest with a = 0, a' != 0 that touch c at rest, and beside each one that crosses c there.
TOUCHING = ((s**3 * (1 - s) ** 2, s**3 * (1 - s)), (s**3 * (2 - s) ** 2, s**3 * (2 - s) * (1 + s)))


def _cusps(flights: tuple[Any, Any], _printed: object, corrected: tuple[Any, ...]) -> Trial:
    touching, crossing = flights
    at_rest, passing = surfaces.touching_flight(touching), surfaces.touching_flight(crossing)
    ready = at_rest.acceleration == 0 and at_rest.slope != 0 and at_rest.velocity == 0
    names = [f"x = {str(path).replace('**', '^').replace('*', ' ')}" for path in flights]
    return Trial(
        names[0],
        "v_(sigma t), not 0 at a cusp",
        f"{at_rest.mixed} where x-dot = 0, {passing.mixed} where x-dot = {passing.velocity} on {names[1]}",
        "not 0 at all",
        "not 0 where x-dot is not",
        not (ready and at_rest.mixed == 0),
        len(corrected) == 2 and passing.velocity != 0 and passing.mixed != 0,
    )


def _lift_off(point: Place, *levels: object) -> Trial:
    """Whether the mass leaves the obstacle, against whether the free flight is above each level."""
    clearance = surfaces.clearance(point.model)
    height = float(point.model.flight(point.tau, 0.0, 0.01).x)
    flies = point.model.first_hit(point.tau, 0.0).status != Status.sticks
    old, new = (height > number(level, {"c": clearance}) for level in levels)
    outcome, *words = ("lifts off" if value else "stays" for value in (flies, old, new))
    name = f"x_c = {height:.9f} at 0.01, c = {clearance:g}: the mass"
    return Trial(point.name, name, outcome, words[0], words[1], old == flies, new == flies)


def rest_at_tangency(model: tuple[str, tuple[str, str]], *_: object) -> Trial:
    """From (tau_*, 0): the first hit where a' > 0, and the status on the same model with g reversed, a' < 0."""
    name, (f, g) = model
    time = float(ImpactOscillator(f, g, 0, "0.5").impact_map(0.0, 0.0).flight_time)
    pressed = ImpactOscillator(f, f"-{g}", 0, "0.5").impact_map(0.0, 0.0).status == Status.sticks
    text = f"{time:.8g} where a' > 0; {'rests' if pressed else 'flies'} where a' < 0"
    flies = time > 0.1
    return Trial(
        name, "first flight from (tau_*, 0)", text, "rests", "flies where a' > 0", not flies, flies and pressed
    )


def _sets(point: Place, *_: object) -> Trial:
    """phi takes (tau, 0; 0) of Z to (tau, 0), which is in P only if a flight from there touches c at rest.

    Damped models: without damping a linear one at omega = 2 repeats, and touches c at rest again after 2 pi.
    """
    times = np.concatenate([np.linspace(-12, -0.1, 2400)[::-1], np.linspace(0.1, 12, 2400)])
    flown = point.model.flight(point.tau, 0.0, times)
    nearest = float(np.min(np.hypot(flown.x - surfaces.clearance(point.model), flown.xdot)))
    name = "distance from (c, 0) of the flight from (tau, 0), |t| > 0.1"
    holds = nearest > 1e-2 and surfaces.horizon_images()[1]
    return Trial(point.name, name, f"{nearest:.3g}", "0", "not 0", nearest < 1e-2, holds)


def _semiconjugacy(point: Place, *_: object) -> Trial:
    """G(p(z)) against R(phi(z)) at the first hit, the zero of y near it on DOP853, and at the next crossing."""
    step = point.model.impact_map(point.tau, 0.5)
    t = float(step.flight_time)
    times = np.linspace(t + 0.05, t + 9, 900)
    above = np.sign(point.model.flight(point.tau, 0.5, times).x - surfaces.clearance(point.model))
    later = float(times[np.flatnonzero(above[1:] != above[:-1])[0]])
    first = float(return_time(scipy_flow(point.model, point.tau), 0.0, 0.5, t)[0])
    name = "tau of G(p(z)), z the next crossing"
    return compared(point.name, name, float(step.tau), point.tau + later, point.tau + first)


def _slope(point: Place, *slopes: object) -> Trial:
    return compared(point.name, "dv_c/dt", slope_at_rest(point), *(number(slope, point.jets()) for slope in slopes))


TRIALS: dict[str, Trials] = {
    "s2-horizon": at_each(regular, _horizon),
    "p:phising-set": at_each(tangencies, _phi_singular),
    "p:phising-cusp": at_each(lambda: TOUCHING, _cusps),
    "s2-lift-off-sign": at_each(regular, _lift_off),
    "s2-first-hit-rest": at_each(arcs.LIFT_OFF.items, rest_at_tangency),
    "s2-corr-sets": at_each(damped, _sets),
    "s2-G-semiconj": at_each(regular, _semiconjugacy),
    "s3-dvdt": at_each(regular, _slope),
}
