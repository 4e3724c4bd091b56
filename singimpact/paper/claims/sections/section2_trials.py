"""Sections 2 and 3: what is printed and what is corrected there, tried on two models."""

from typing import Any

import numpy as np

from singimpact.impact_oscillator import ImpactOscillator
from singimpact.paper.claims.claim import Trial, Trials, compared
from singimpact.paper.trials import arcs, surfaces
from singimpact.paper.trials.true_sheet import Place, damped, number, regular, tangencies
from singimpact.status import Status


def slope_at_rest(place: Place) -> float:
    """dv_c/dt at t = 0 on true flights."""
    return place.leading(lambda h: place.launch(0.0, h) / h)


def second_component(printed: Any, corrected: Any) -> list[Trial]:
    """x-dot of a first hit on a true flight, against x-dot at the time that each statement takes."""
    found = []
    for place in regular():
        hit = place.model.first_hit(place.tau, 0.3)
        t = float(hit.flight_time)
        at = [float(place.model.flight(place.tau, 0.3, number(time, {"t": t})).xdot) for time in (printed, corrected)]
        truth = float(surfaces.flow(place.model)(place.tau, surfaces.clearance(place.model), 0.3, t)[1])
        found.append(compared(place.name, "second component of phi", truth, *at))
    return found


def _horizon(_printed: Any, _corrected: Any) -> list[Trial]:
    """At a regular point of Pi_0 x-dot is 0; it is singular for p only if dv_c/dt is 0 too."""
    return [
        compared(place.name, "dv_c/dt at (tau, 0; 0), a != 0", slope_at_rest(place), 0.0, -place.jets()["a"] / 2)
        for place in regular()
    ]


def _phi_singular(_printed: Any, _corrected: Any) -> list[Trial]:
    """det D phi = d(x-dot)/dt - d(x-dot)/dsigma as t -> 0 at a tangency point, from differences on true flights."""
    found = []
    for place in tangencies():
        value = place.leading(lambda h, place=place: _determinant(place, h))
        zero = abs(value) < 1e-3
        found.append(Trial(place.name, "det D phi at the tangency point", f"{value:.1e}", "not 0", "0", not zero, zero))
    return found


def _determinant(place: Place, t: float) -> float:
    step = t / 4
    by_t = place.impact(0.0, t + step) - place.impact(0.0, t - step)
    return (by_t - place.impact(step, t) + place.impact(-step, t)) / (2 * step)


def _cusps(_printed: Any, corrected: tuple[Any, ...]) -> list[Trial]:
    """Flights from rest with a = 0, a' != 0 that touch c at rest, and beside each one that crosses c there."""
    s = surfaces.PATH
    rows = []
    for touching, crossing in ((s**3 * (1 - s) ** 2, s**3 * (1 - s)), (s**3 * (2 - s) ** 2, s**3 * (2 - s) * (1 + s))):
        at_rest, passing = surfaces.touching_flight(touching), surfaces.touching_flight(crossing)
        ready = at_rest.acceleration == 0 and at_rest.slope != 0 and at_rest.velocity == 0
        holds = len(corrected) == 2 and passing.velocity != 0 and passing.mixed != 0
        text = f"{at_rest.mixed} where x-dot = 0, {passing.mixed} where x-dot = {passing.velocity} on {crossing}"
        rows.append(
            Trial(
                f"x = {touching}",
                "v_(sigma t), not 0 at a cusp",
                text,
                "not 0 at all",
                "not 0 where x-dot is not",
                not (ready and at_rest.mixed == 0),
                holds,
            )
        )
    return rows


def _lift_off(printed: Any, corrected: Any) -> list[Trial]:
    """Whether the mass leaves the obstacle, against whether the free flight is above each level."""
    rows = []
    for point in regular():
        clearance = surfaces.clearance(point.model)
        height = float(point.model.flight(point.tau, 0.0, 0.01).x)
        flies = point.model.first_hit(point.tau, 0.0).status != Status.sticks
        says = {level: height > number(level, {"c": clearance}) for level in (printed, corrected)}
        rows.append(
            Trial(
                point.name,
                f"it lifts off, x_c(0.01) = {height:.9f}, c = {clearance:g}",
                str(flies),
                str(says[printed]),
                str(says[corrected]),
                says[printed] == flies,
                says[corrected] == flies,
            )
        )
    return rows


def rest_at_tangency(_printed: Any, _corrected: Any) -> list[Trial]:
    """From (tau_*, 0): the first hit where a' > 0, and the status on the same model with g reversed, a' < 0."""
    rows = []
    for name, (f, g) in arcs.LIFT_OFF.items():
        time = float(ImpactOscillator(f, g, 0, "0.5").impact_map(0.0, 0.0).flight_time)
        pressed = ImpactOscillator(f, f"-{g}", 0, "0.5").impact_map(0.0, 0.0).status == Status.sticks
        text = f"{time:.8g} where a' > 0; {'rests' if pressed else 'flies'} where a' < 0"
        rows.append(
            Trial(
                name,
                "first flight from (tau_*, 0)",
                text,
                "rests",
                "flies where a' > 0",
                not time > 0.1,
                time > 0.1 and pressed,
            )
        )
    return rows


def _sets(_printed: Any, _corrected: Any) -> list[Trial]:
    """phi takes (tau, 0; 0) of Z to (tau, 0), which is in P only if a flight from there touches c at rest.

    Damped models: without damping a linear one at omega = 2 repeats, and touches c at rest again after 2 pi.
    """
    rows = []
    worst = surfaces.horizon_images().worst
    for point in damped():
        times = np.concatenate([np.linspace(-12, -0.1, 2400)[::-1], np.linspace(0.1, 12, 2400)])
        flown = point.model.flight(point.tau, 0.0, times)
        nearest = float(np.min(np.hypot(flown.x - surfaces.clearance(point.model), flown.xdot)))
        rows.append(
            Trial(
                point.name,
                "distance from (c, 0) of the flight from (tau, 0), |t| > 0.1",
                f"{nearest:.3g}",
                "0",
                "not 0",
                nearest < 1e-2,
                nearest > 1e-2 and worst < 1e-9,
            )
        )
    return rows


def _semiconjugacy(_printed: Any, _corrected: Any) -> list[Trial]:
    """G(p(z)) against R(phi(z)) at the first hit and at the next crossing of the free flight."""
    rows = []
    for point in regular():
        t = float(point.model.impact_map(point.tau, 0.5).flight_time)
        times = np.linspace(t + 0.05, t + 9, 900)
        above = np.sign(point.model.flight(point.tau, 0.5, times).x - surfaces.clearance(point.model))
        later = float(times[np.flatnonzero(above[1:] != above[:-1])[0]])
        step = point.model.impact_map(point.tau, 0.5)
        rows.append(
            compared(
                point.name,
                "tau of G(p(z)), z the next crossing",
                float(step.tau),
                point.tau + later,
                point.tau + _first_return(point, t),
            )
        )
    return rows


def _first_return(place: Place, t: float) -> float:
    """The zero of y near the first hit on DOP853."""
    from singimpact.paper.trials.true_orbits import return_time, scipy_flow

    return float(return_time(scipy_flow(place.model, place.tau), 0.0, 0.5, t)[0])


def _slope(printed: Any, corrected: Any) -> list[Trial]:
    return [
        compared(place.name, "dv_c/dt", slope_at_rest(place), *(number(x, place.jets()) for x in (printed, corrected)))
        for place in regular()
    ]


TRIALS: dict[str, Trials] = {
    "s2-horizon": _horizon,
    "p:phising-set": _phi_singular,
    "p:phising-cusp": _cusps,
    "s2-lift-off-sign": _lift_off,
    "s2-first-hit-rest": rest_at_tangency,
    "s2-corr-sets": _sets,
    "s2-G-semiconj": _semiconjugacy,
    "s3-dvdt": _slope,
}
