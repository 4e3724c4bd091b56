"""Impacts of models with steep layers in balls, with their derivatives as differences of such balls."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from singimpact.algebra.precision import balls_at
from singimpact.bench.stress.judging import STEP
from singimpact.bench.stress.launches import SteepLaunch
from singimpact.bench.truth import enclosed_flight
from singimpact.bench.truth.enclosed_flight import EnclosureSettings
from singimpact.flights.inverse_map import backwards

# differences over 10^-STEP, and differences of these, keep 10 digits
EXACT = EnclosureSettings(accuracy=1e-60, bits=240)
Pair = tuple[Any, Any]


def landed(launch: SteepLaunch, tau: Any, v: Any, sign: int) -> tuple[Any, Any, tuple[Pair, Pair]] | None:
    """Time and velocity of the next impact and their derivatives by (tau, v); None where there is none.

    Parameters
    ----------
    tau, v : numbers or balls, of which the midpoints are flown. sign : -1 for the flight backwards.
    """
    import flint

    start = [flint.arb(flint.arb(number).mid()) for number in (tau, v)]
    time, velocity = _flown(launch, *map(_key, start), sign)
    if time is None:
        return None
    small, rows = flint.arb(10) ** -STEP, []
    for moved in (0, 1):
        size = max(abs(float(start[moved])), 1.0) if moved == 0 else float(start[1])
        change = flint.arb((small * size).mid())
        there = [number + change if index == moved else number for index, number in enumerate(start)]
        late, fast = _flown(launch, *(_key(flint.arb(number.mid())) for number in there), sign)
        if late is None:
            return None
        rows.append(((late - time) / change, (fast - velocity) / change))
    (time_by_tau, velocity_by_tau), (time_by_v, velocity_by_v) = rows
    return time, velocity, ((time_by_tau, time_by_v), (velocity_by_tau, velocity_by_v))


def _key(exact: Any) -> Pair:
    """Mantissa and exponent of an exact ball."""
    mantissa, exponent = exact.man_exp()
    return int(mantissa), int(exponent)


@lru_cache(maxsize=4096)  # the functions of a place fly the same states
def _flown(launch: SteepLaunch, tau: Pair, v: Pair, sign: int) -> Pair:
    import flint

    model = launch.model if sign > 0 else backwards(launch.model)
    state = [flint.arb(mantissa) * flint.arb(2) ** exponent for mantissa, exponent in (tau, v)]
    with balls_at(launch.bits):
        found = enclosed_flight.first_hit(model, state[0], state[1], launch.horizon, EXACT)
    return found.flight_time, found.velocity
