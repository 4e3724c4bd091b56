"""`bench emitted`: v_c at a tangency as emitted numpy source, order by order, on 1000 points, beside sympy's lambdify.

All evaluate the same cut series, whose exact value at each point is a rational number: what is judged is rounding.
"""

from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from functools import partial
from itertools import product
from typing import Any

import numpy as np

from singimpact.algebra.rings import EXACT
from singimpact.bench.measuring import Case, Effort, Method, with_peers
from singimpact.codegen.over_lists import plain
from singimpact.contact.contact import Contact
from singimpact.impact_oscillator import ImpactOscillator
from singimpact.theory.formulas import v_c_on_arrays
from singimpact.theory.frozen import sheet_functions
from singimpact.theory.impact_sheet import sheet

# A polynomial in (sigma, t) evaluated by sympy's own means: `lambdify` for numpy, and `subs` point by point.


def expression(terms: Mapping[tuple[int, ...], Any]) -> tuple[Any, Any, Any]:
    """sigma, t and the expanded sum, as sympy keeps it."""
    import sympy

    sigma, t = sympy.symbols("sigma t")
    rational = {key: sympy.Rational(c.numerator, c.denominator) for key, c in terms.items()}
    return sigma, t, sympy.expand(sympy.Add(*(c * sigma**i * t**k for (i, k), c in rational.items())))


def function(terms: Mapping[tuple[int, ...], Any], shared: bool) -> Callable[[Any, Any], Any]:
    """By `lambdify`, with or without common subexpressions taken out."""
    import sympy

    sigma, t, total = expression(terms)
    found: Callable[[Any, Any], Any] = sympy.lambdify((sigma, t), total, "numpy", cse=shared)
    return found


def substituting(terms: Mapping[tuple[int, ...], Any]) -> Callable[[Any, Any], list[float]]:
    """By `subs` at each point."""
    sigma, t, total = expression(terms)
    return lambda at, times: [float(total.subs({sigma: s, t: u})) for s, u in zip(at, times, strict=True)]


POINTS, JUDGED = 1000, 50
ORDERS = (3, 4, 6, 8)  # at a swan v_c begins with the third
MODEL = ImpactOscillator("x + xdot/10 + 3*x**3/10", "3081/10000 + t + t**2/3", "0.3", "117/275")
VALUES = {"a_d1": 1.0, "a_d2": 2 / 3, "f_01": 0.1, "f_10": 1.081, "f_20": 0.54, "f_30": 1.8}


def cases(effort: Effort) -> Iterator[Case]:
    """A case an order, on random points and on points next to the curve where v_c vanishes and its terms cancel."""
    for order, near in product(ORDERS[1:3] if effort.quick else ORDERS, (False, True)):
        sigma, t = _points(near)
        terms = sheet(Contact.of(MODEL, Fraction(0), 1, order, EXACT), order).v.terms
        exact = [_value(terms, s, u) for s, u in zip(sigma[:JUDGED].tolist(), t[:JUDGED].tolist(), strict=True)]
        setting = f"order {order}"
        own = [
            Method("kernel, emitted numpy", setting, _emitted(order, sigma, t), order, problems=POINTS),
            Method("singimpact, v_c_on_arrays", setting, _horner(order, sigma, t, False), order, problems=POINTS),
            Method("singimpact, compensated", setting, _horner(order, sigma, t, True), order, problems=POINTS),
        ]
        methods, skipped = with_peers(own, partial(_peers, terms, order, sigma, t))
        truth = [f"{value.numerator}/{value.denominator}" for value, _ in exact]
        name = "v_c at a tangency" + (", next to its zeros" if near else "")
        yield Case(name, methods, truth, [kappa for _, kappa in exact], skipped)


def _points(near: bool) -> tuple[Any, Any]:
    """Random launches before the tangency, and flight times: any, or next to -3 sigma, where v_c begins to vanish."""
    rng = np.random.default_rng(1)
    sigma, t = -rng.uniform(0.01, 0.3, POINTS), rng.uniform(0.01, 0.3, POINTS)
    return sigma, -3 * sigma * (1 + 10 ** rng.uniform(-6, -2, POINTS)) if near else t


def _value(terms: Any, sigma: float, t: float) -> tuple[Fraction, float]:
    """The cut series at a point, exactly, and its condition."""
    s, u = Fraction(sigma), Fraction(t)
    parts = [((i, k), c * s**i * u**k) for (i, k), c in terms.items()]
    total = sum((part for _, part in parts), Fraction(0))
    moved = [abs(sum((key[n] * part for key, part in parts), Fraction(0))) for n in (0, 1)]
    return total, 1 + float(sum(moved) / abs(total))


def _emitted(order: int, sigma: Any, t: Any) -> Callable[[], Any]:
    (text,) = [text for text in sheet_functions(order) if "def v_c_tangency(" in text]
    function = plain(text, {"Any": Any})["v_c_tangency"]
    names = text[text.index("(") + 1 : text.index(")")].replace(": Any", "").split(", ")[2:]
    given = [VALUES.get(name, 0.0) for name in names]
    return lambda: function(sigma, t, *given)


def _horner(order: int, sigma: Any, t: Any, compensated: bool) -> Callable[[], Any]:
    function = v_c_on_arrays(order, "tangency", MODEL, "0", compensated=compensated)
    return lambda: function(sigma, t)


def _peers(terms: Any, order: int, sigma: Any, t: Any) -> list[Method]:
    few = slice(0, 20)  # a call of subs takes milliseconds
    made = [(f"sympy lambdify{', cse' if shared else ''}", function(terms, shared)) for shared in (False, True)]
    methods = [Method(name, f"order {order}", partial(function, sigma, t), order) for name, function in made]
    by_point = substituting(terms)
    return [*methods, Method("sympy subs", f"order {order}", partial(by_point, sigma[few], t[few]), order)]
