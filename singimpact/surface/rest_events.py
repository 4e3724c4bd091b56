"""Tacnodes, triple points and periodic grazes of a family: those that are found, and why one may be missing."""

from __future__ import annotations

from collections.abc import Collection

from singimpact.algebra.expressions import multiply, number, subtract
from singimpact.algebra.numbers import sign_of
from singimpact.surface.followed_rests import GRID_OF, FollowedRests
from singimpact.surface.swan_families import Family
from singimpact.surface.two_rests import GRID, LinearRests, Rests, linear_rests

MORE = ("tacnode", "triple point", "periodic graze")


def gaps_of(times: tuple[float, float]) -> tuple[float, float]:
    """The least and the longest time between two rests that a window of flight times holds, of either sign."""
    low, high = times
    inside = low <= 0 <= high
    return 0.0 if inside else min(abs(low), abs(high)), max(abs(low), abs(high))


def met_rests(
    family: Family, ends: tuple[float, float], times: tuple[float, float], wanted: Collection[str]
) -> list[Rests]:
    """Tacnodes, triple points and periodic grazes with the time from the first rest to the last in a window.

    Parameters
    ----------
    ends : of the number. times : of flights. wanted : kinds.
    """
    if family.model.period is None or not set(MORE) & set(wanted):
        return []
    gaps, linear = gaps_of(times), linear_rests(family)
    if linear is None:
        return FollowedRests(family, ends, gaps).met(wanted)
    events = linear.grazes() if "periodic graze" in wanted and gaps[1] >= linear.turn * (1 - GRID.whole) else []
    events += linear.tacnodes(gaps[1]) if "tacnode" in wanted else []
    return events + (linear.triples(gaps[1]) if "triple point" in wanted and not no_triples(linear) else [])


def no_triples(rests: LinearRests) -> bool:
    """Whether no flight of a model is at rest three times, but those that are once a period [b:events-two].

    x'' + w^2 x = h cos(2 w t + phase) + constant is the only one of which that is proved.
    """
    form = rests.form
    rates = {str(wave.rate) for wave in form.harmonics}
    if sign_of(form.damping) != 0 or len(rates) != 1 or not rests.square > 0:
        return False
    rate = form.harmonics[0].rate
    return sign_of(subtract(multiply(rate, rate), multiply(number(4), form.stiffness))) == 0


def doubts_of_rests(family: Family, times: tuple[float, float], wanted: Collection[str]) -> tuple[str, ...]:
    """Why a tacnode, a triple point or a periodic graze may be missing; nothing where it is proved that none is."""
    kinds = [kind for kind in MORE if kind in wanted]
    if not kinds:
        return ()
    if family.model.period is None:
        return (f"{_listed(kinds)} are looked for in models with a period alone",)
    linear = linear_rests(family)
    if linear is None:
        grid = f"{GRID_OF.columns} times of rest a period and {GRID_OF.rows} steps of {family.over}"
        return (f"{_listed(kinds)} are met on a grid of {grid}",)
    if "periodic graze" in kinds:
        linear.grazes()
    if "tacnode" in kinds:
        linear.tacnodes(gaps_of(times)[1])
    doubts = tuple(dict.fromkeys(linear.undecided))
    if "triple point" in kinds and not no_triples(linear):
        doubts += (f"triple points are met on a grid of step {GRID.step} in the times of rest",)
    return doubts


def _listed(kinds: list[str]) -> str:
    return " and ".join(part for part in (", ".join(f"{kind}s" for kind in kinds[:-1]), f"{kinds[-1]}s") if part)
