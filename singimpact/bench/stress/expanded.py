"""Series at doubles against 60 digits; chatter limits, thresholds and grown curves against `digits=`.

Series: v_c on arrays, emitted source, gamma, the completion.  The `digits=` are of ball arithmetic.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from functools import cache, partial
from typing import Any

import mpmath
import numpy as np

from singimpact import theory
from singimpact.algebra.rings import EXACT
from singimpact.bench.measuring import condition
from singimpact.bench.stress.judging import DIGITS, Judge, Launch, Trial, moved, number, powers
from singimpact.codegen.over_lists import plain
from singimpact.contact.contact import Contact
from singimpact.dynamics.invariant_arcs import grown_gamma, stable_manifold
from singimpact.dynamics.threshold import threshold
from singimpact.impact_oscillator import ImpactOscillator, linear
from singimpact.status import Status
from singimpact.surface.curve import Window
from singimpact.theory import sheet, sheet_functions

ORDER = 6
JETS = {"a_d2": 2 / 3, "f_01": 0.125, "f_10": 1.0, "f_30": 1.5}


@cache
def model(bend: Fraction = Fraction(1, 3), r: Any = "1/2") -> ImpactOscillator:
    """A tangency at 0 with a' = 3 bend, in rational numbers."""
    return ImpactOscillator("x + xdot/8 + x**3/4", "e*t*3 + t**2/3", 0, r, {"e": bend})


def _zero(impact: bool, points: int) -> Iterator[tuple[Fraction, float, float]]:
    """Next to where v (or x' at the landing) vanishes: from the root of the cut series in t at sigma = -1/8."""
    terms, sigma = _terms(Fraction(1, 3), impact), mpmath.mpf(-0.125)
    with mpmath.workdps(DIGITS):
        t = mpmath.findroot(lambda t: _value(terms, sigma, t) / t, 0.19 if impact else 0.37)
        root = float(t)
    for off in powers(points, 14):
        for side in (1, -1):
            yield Fraction(1, 3), -0.125, root * (1 + side * off)


PLACES: dict[str, tuple[bool, Callable[[int], Iterator[tuple[Fraction, float, float]]]]] = {
    "v -> 0": (False, partial(_zero, False)),
    "t -> 0": (
        False,
        lambda points: ((Fraction(1, 3), -0.2, side * t) for t in powers(points, 15) for side in (1, -1)),
    ),
    "a -> 0": (False, lambda points: ((Fraction(1, 3), -off, off * 0.7) for off in powers(points, 12))),
    "a' -> 0": (
        False,
        lambda points: (
            (side * Fraction(bend), -0.1 * side, 0.17 * side) for bend in powers(points, 12) for side in (1, -1)
        ),
    ),
    "next to P": (True, partial(_zero, True)),
    "next to Z": (False, partial(_zero, False)),
}


@cache
def _terms(bend: Fraction, impact: bool) -> Mapping[tuple[int, ...], Fraction]:
    made = sheet(Contact.of(model(bend), Fraction(0), 1, ORDER, EXACT), ORDER)
    return (made.xdot if impact else made.v).terms


def _value(terms: Mapping[tuple[int, ...], Fraction], sigma: Any, t: Any) -> Any:
    return sum(number(value) * sigma**i * t**k for (i, k), value in terms.items())


def _on_arrays(compensated: bool, place: str, points: int) -> Iterator[Trial]:
    impact, states = PLACES[place]
    for bend, sigma, t in states(points):
        function = theory.v_c_on_arrays(ORDER, "tangency", model(bend), "0", impact=impact, compensated=compensated)
        values, rounding = moved(lambda s, u, at=bend: [_value(_terms(at, impact), s, u)], [sigma, t])
        name = f"a' = {float(3 * bend):.3g}, sigma = {sigma!r}, t = {t!r}, {'landing' if impact else 'launch'}"
        yield Trial(name, [float(function(sigma, t))], values, rounding)


def _emitted_numpy(name_: str, points: int) -> Iterator[Trial]:
    """The emitted code on doubles against the same code on numbers of 60 digits; the jets are inputs too."""
    impact, states = PLACES[name_]
    function = plain("\n\n".join(sheet_functions(ORDER)), {"Any": Any})["xdot_c_tangency" if impact else "v_c_tangency"]
    names = function.__code__.co_varnames[2 : function.__code__.co_argcount]
    for bend, sigma, t in states(points):
        arguments = [{**JETS, "a_d1": float(3 * bend)}.get(name, 0.0) for name in names]
        values, rounding = moved(lambda *all_of: [function(*all_of)], [sigma, t, *arguments])
        yield Trial(
            f"a' = {float(3 * bend):.3g}, sigma = {sigma!r}, t = {t!r}",
            [function(sigma, t, *arguments)],
            values,
            rounding,
        )


def _series(made: Any, name: str, states: list[float]) -> Iterator[Trial]:
    """A series at doubles against its certified coefficients summed in 60 digits."""
    coefficients = {n: part.value for n, part in made.certified(DIGITS).items()}
    for at in states:
        values, rounding = moved(lambda value: [sum(number(c) * value**n for n, c in coefficients.items())], [at])
        yield Trial(f"{name}, {made.variable} = {at!r}", [float(made(at))], values, rounding)


def _rates(towards: int, points: int) -> list[str]:
    return [f"{off:.20f}" if not towards else f"{1 - Fraction(repr(off))}" for off in powers(min(points, 5), 6)]


def _gamma(name: str, points: int) -> Iterator[Trial]:
    if name == "a -> 0":
        yield from _series(theory.gamma(ORDER, model=model(), tau="0"), "r = 1/2", [-s for s in powers(points, 12)])
        return
    if name == "a' -> 0":
        for bend in powers(min(points, 5), 6):
            series = theory.gamma(ORDER, model=model(Fraction(repr(bend))), tau="0")
            yield from _series(series, f"a' = {3 * bend:.3g}", [-bend / 10])
        return
    for r in _rates(name == "r -> 1", points):
        yield from _series(theory.gamma(ORDER, model=model(r=r), tau="0"), f"r = {r}", [-0.1, -1e-3])


def _completion(name: str, points: int) -> Iterator[Trial]:
    osc, near = linear("2.8", "0.3", "0.5"), 0.45229894  # the zero of a
    if name == "v -> 0":
        series = theory.chatter_limit(ORDER, model=osc, tau="0.9")
        yield from _series(series, "tau = 0.9", powers(points, 14))
    elif name == "a -> 0":
        for off in powers(min(points, 6), 5):
            tau = repr(near + off)
            yield from _series(theory.chatter_limit(ORDER, model=osc, tau=tau), f"tau = {tau}", [off**2 / 100])
    else:
        for r in _rates(name == "r -> 1", points):
            series = theory.chatter_limit(ORDER, model=linear("2.8", 0, r), tau="0.9")
            yield from _series(series, f"r = {r}", [1e-3 * (1 - float(Fraction(r))), 1e-9])


# Chatter limits, thresholds and grown curves.

FEW = 5  # each reference value takes 0.1 s or more
START = Launch("linear", tau=0.9, v=0.005)
GAMMA, END = Launch("linear", tau=0.9, restitution=0.5), 1.5 * np.pi / 2.8
NEAR: dict[str, tuple[float, Callable[[Launch, float], Launch]]] = {
    "v -> 0": (14, lambda at, off: replace(at, v=off)),
    "omega -> 1": (12, lambda at, off: replace(at, omega=1 + off, tau=2.5)),
    "r -> 0": (12, lambda at, off: replace(at, restitution=off)),
    "r -> 1": (2, lambda at, off: replace(at, restitution=1 - off, v=0.01 * off)),
    "a -> 0": (4, lambda at, off: replace(at, tau=0.5609986881410345 + off, v=off**2 / 20)),
    "a' -> 0": (4, lambda at, off: replace(at, clearance=1 - off, tau=1.2 * off**0.5, v=off**1.5 / 50)),
    "huge tau": (12, lambda at, off: replace(at, tau=0.9 + 1 / off, v=1e-6)),
}


def _chatter_limit(name: str, points: int) -> Iterator[Trial]:
    """tau_inf; the state and every phase until then are rounded relative to tau_inf itself."""
    last, near = NEAR[name]
    for off in powers(min(points, FEW), last):
        at = near(START, off)
        osc = at.model
        flown, true = osc.chatter_limit(at.tau, at.v), osc.chatter_limit(at.tau, at.v, digits=DIGITS)
        status = int(flown.status), int(true.status)
        if status[0] != status[1] or true.status != Status.complete:
            yield Trial(str(at), status=status)
            continue
        limit = partial(lambda osc, tau, v: float(osc.chatter_limit(tau, v).tau), osc)
        kappa = condition(limit, at.tau, at.v, 1e-4)
        yield Trial(str(at), [float(flown.tau)], [true.tau], [(kappa - 1) * abs(true.tau)], status)


ALONG_GAMMA: dict[str, tuple[float, Callable[[Launch, float], Launch]]] = {
    "omega -> 1": NEAR["omega -> 1"],
    "r -> 0": (3, lambda at, off: replace(at, restitution=off)),
    "r -> 1": (1.2, lambda at, off: replace(at, restitution=1 - off, tau=1.6)),
    "a -> 0": (4, lambda at, off: replace(at, tau=END - off)),
}


def _threshold(place: str, points: int) -> Iterator[Trial]:
    last, near = ALONG_GAMMA[place]
    for off in powers(min(points, 3), last):
        slow = near(GAMMA, off)
        osc = slow.model
        found, true = threshold(osc, slow.tau), threshold(osc, slow.tau, digits=20)
        status = int(found.status), int(true.status)
        speed = partial(lambda osc, tau, _: float(threshold(osc, tau).v), osc)
        kappa = condition(speed, slow.tau, 1.0, 1e-7)
        yield Trial(str(slow), [float(found.v)], [true.v], [(kappa - 1) * true.v], status)


RATES = {"r -> 0": 1e-3, "r -> 1": 0.9}  # of curves, which cost many flights


def _gamma_grown(name: str, points: int) -> Iterator[Trial]:
    """Vertices beside the threshold over the same phase."""
    rate = RATES.get(name, 0.5)
    osc = linear("2.8", 0, rate)
    points_of = np.vstack([curve.points for curve in grown_gamma(osc, Window((0.6, 2.0), (0.0, 1.0)))])
    far = END - points_of[:, 0]
    for off in powers(min(points, 2), 3 if name == "a -> 0" else 1, 0.3):
        tau, v = points_of[int(np.argmin(np.abs(far - off) + (far < off / 2)))].tolist()
        true = threshold(osc, tau, digits=20)
        kappa = condition(lambda at, _: float(threshold(osc, at).v), tau, 1.0, 1e-7)
        yield Trial(f"r = {rate}, tau = {tau!r}", [v], [true.v], [(kappa - 1) * true.v])


def _stable_manifold(name: str, points: int) -> Iterator[Trial]:
    """Chatter from a vertex ends at the foot, within the error that the condition number allows."""
    rate, foot = RATES.get(name, 0.5), END - 1e-3 if name == "a -> 0" else 1.0
    osc = linear("2.8", 0, rate)
    vertices = np.vstack([curve.points for curve in stable_manifold(osc, Window((0.2, 1.5), (0.0, 1.0)), foot)])
    for index in np.linspace(2, len(vertices) - 2, min(points, 6)).astype(int).tolist():
        tau, v = vertices[index].tolist()
        if not v > 0:
            continue
        end = osc.chatter_limit(tau, v, digits=DIGITS)
        if end.status != Status.complete:
            continue
        kappa = condition(lambda at, speed: float(osc.chatter_limit(at, speed).tau), tau, v)
        yield Trial(f"r = {rate}, tau = {tau!r}, v = {v!r}", [float(end.tau)], [foot], [kappa - 1])


JUDGES: dict[str, Judge] = {
    "chatter_limit": _chatter_limit,
    "threshold": _threshold,
    "gamma grown": _gamma_grown,
    "stable manifold": _stable_manifold,
    "v_c_on_arrays": partial(_on_arrays, False),
    "v_c_on_arrays, compensated": partial(_on_arrays, True),
    "emitted numpy": _emitted_numpy,
    "gamma, a series": _gamma,
    "chatter_limit, a series": _completion,
}
