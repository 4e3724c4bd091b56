"""Series at doubles: v_c on arrays, emitted source, gamma, the completion, against the same series in 60 digits."""

from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from functools import cache, partial
from typing import Any

from singimpact import theory
from singimpact.algebra.rings import EXACT
from singimpact.bench.stress.judging import DIGITS, Function, Trial, moved, number, powers
from singimpact.codegen.over_lists import plain
from singimpact.contact.contact import Contact
from singimpact.impact_oscillator import ImpactOscillator, linear
from singimpact.theory.frozen import sheet_functions
from singimpact.theory.impact_sheet import sheet

ORDER = 6
JETS = {"a_d2": 2 / 3, "f_01": 0.125, "f_10": 1.0, "f_30": 1.5}


@cache
def model(bend: Fraction = Fraction(1, 3), r: Any = "1/2") -> ImpactOscillator:
    """A tangency at 0 with a' = 3 bend, in rational numbers."""
    return ImpactOscillator("x + xdot/8 + x**3/4", "e*t*3 + t**2/3", 0, r, {"e": bend})


def _near_tangency(points: int) -> Iterator[tuple[Fraction, float, float]]:
    for off in powers(points, 12):
        yield Fraction(1, 3), -off, off * 0.7


def _short(points: int) -> Iterator[tuple[Fraction, float, float]]:
    for t in powers(points, 15):
        for side in (1, -1):
            yield Fraction(1, 3), -0.2, side * t


def _weak(points: int) -> Iterator[tuple[Fraction, float, float]]:
    for bend in powers(points, 12):
        yield Fraction(bend), -0.1, 0.17
        yield -Fraction(bend), 0.1, -0.17


def _zero(impact: bool, points: int) -> Iterator[tuple[Fraction, float, float]]:
    """Next to where v (or x' at the landing) vanishes: from the root of the cut series in t at sigma = -1/8."""
    import mpmath

    terms, sigma = _terms(Fraction(1, 3), impact), mpmath.mpf(-0.125)
    with mpmath.workdps(DIGITS):
        t = mpmath.findroot(lambda t: _value(terms, sigma, t) / t, 0.19 if impact else 0.37)
        root = float(t)
    for off in powers(points, 14):
        for side in (1, -1):
            yield Fraction(1, 3), -0.125, root * (1 + side * off)


PLACES: dict[str, tuple[bool, Callable[[int], Iterator[tuple[Fraction, float, float]]]]] = {
    "v -> 0": (False, partial(_zero, False)),
    "t -> 0": (False, _short),
    "a -> 0": (False, _near_tangency),
    "a' -> 0": (False, _weak),
    "next to P": (True, partial(_zero, True)),
    "next to Z": (False, partial(_zero, False)),
}


@cache
def _terms(bend: Fraction, impact: bool) -> Mapping[tuple[int, ...], Fraction]:
    made = sheet(Contact.of(model(bend), Fraction(0), 1, ORDER, EXACT), ORDER)
    return (made.xdot if impact else made.v).terms


def _value(terms: Mapping[tuple[int, ...], Fraction], sigma: Any, t: Any) -> Any:
    return sum(number(value) * sigma**i * t**k for (i, k), value in terms.items())


def _on_arrays(place: str, compensated: bool, points: int) -> Iterator[Trial]:
    impact, states = PLACES[place]
    for bend, sigma, t in states(points):
        function = theory.v_c_on_arrays(ORDER, "tangency", model(bend), "0", impact=impact, compensated=compensated)
        values, rounding = moved(lambda s, u, at=bend: [_value(_terms(at, impact), s, u)], [sigma, t])
        name = f"a' = {float(3 * bend):.3g}, sigma = {sigma!r}, t = {t!r}, {'landing' if impact else 'launch'}"
        yield Trial(name, [float(function(sigma, t))], values, rounding)


@cache
def _emitted() -> dict[str, Any]:
    return plain("\n\n".join(sheet_functions(ORDER)), {"Any": Any})


def _emitted_numpy(name_: str, points: int) -> Iterator[Trial]:
    """The emitted code on doubles against the same code on numbers of 60 digits; the jets are inputs too."""
    impact, states = PLACES[name_]
    function = _emitted()["xdot_c_tangency" if impact else "v_c_tangency"]
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


def _cut(series: Any) -> Callable[[Any], list[Any]]:
    known = {n: part.value for n, part in series.certified(DIGITS).items()}
    return lambda value: [sum(number(c) * value**n for n, c in known.items())]


def _series(made: Any, name: str, states: list[float]) -> Iterator[Trial]:
    """A series at doubles against its certified coefficients summed in 60 digits."""
    true = _cut(made)
    for at in states:
        values, rounding = moved(true, [at])
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


def _function(name: str, judge: Callable[..., Iterator[Trial]], places: Any, route: str, left_out: str) -> Function:
    return Function(name, {place: partial(judge, place) for place in places}, route, left_out)


SAME = "the cut series in 60 digits, exact coefficients"
WITHOUT = "a function of sigma, t and jets: no omega, no r; v at the place is what vanishes there; it is near 0 only"
FUNCTIONS = (
    *(
        Function(
            f"v_c_on_arrays{', compensated' if twice else ''}",
            {place: partial(_on_arrays, place, twice) for place in PLACES},
            SAME,
            WITHOUT,
        )
        for twice in (False, True)
    ),
    _function("emitted numpy", _emitted_numpy, PLACES, "the same text on 60 digits", WITHOUT),
    _function(
        "gamma, a series",
        _gamma,
        ("r -> 0", "r -> 1", "a -> 0", "a' -> 0"),
        "digits=60",
        "a function of sigma and jets near the tangency",
    ),
    _function(
        "chatter_limit, a series",
        _completion,
        ("v -> 0", "r -> 0", "r -> 1", "a -> 0"),
        "digits=60",
        "a function of v at a regular point",
    ),
)
