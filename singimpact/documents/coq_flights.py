"""First impacts and periodic orbits of linear models as files for Coq: the motion has a closed form there.

The file has the theorems that it rests on (`flights.v` among the templates), that the formula is the motion, and with
coq-interval that it rises, stays above the wall, falls and meets it.  Here is chosen where it rises and where it falls.
"""

import re
from collections.abc import Mapping
from fractions import Fraction
from math import ceil, log10
from pathlib import Path
from typing import Any

import numpy as np

from singimpact.algebra import BITS_A_DIGIT, Expression, as_float, as_fraction, constant, names_in
from singimpact.branches.krawczyk import enclosed_orbit
from singimpact.documents.rendering import environment
from singimpact.flights.flight_path import path
from singimpact.flights.impact_map import impact_map
from singimpact.inputs import InputError, need
from singimpact.oscillator import Oscillator, linear_form

LIBRARY = Path(__file__).parent / "templates" / "flights.v"
SAMPLES = 400  # of the velocity on a flight, among which the end of the rise and the start of the fall are chosen
MORE = 6  # digits of the time by which the file brackets it more closely than the certificate


def coq_flight(content: Mapping[str, Any], sentence: str) -> str:
    """The Coq file of the certificate of a first impact, or of a periodic orbit of one impact.

    Parameters
    ----------
    content : of the certificate. sentence : what it says, for the first line.

    Raises
    ------
    InputError : another statement, or a model without a closed form of this kind.
    """
    orbit, no_file = content["statement"] == "periodic orbit", f"{sentence} has no Coq file"
    need(
        len(content["states"]) == 1 if orbit else content["statement"] == "first impact",
        InputError(f"{no_file}: first impacts and periodic orbits of one impact have one"),
    )
    osc = Oscillator(**{name: text for name, text in content["model"].items() if name != "period"})
    form = linear_form(osc)
    if (
        form is None
        or osc.upper
        or names_in(osc.restitution)
        or as_float(form.damping) ** 2 >= 4 * as_float(form.stiffness)
    ):
        raise InputError(f"{no_file}: a linear model with one wall, a number r and less than critical damping has one")
    state = content["states"][0] if orbit else content
    tau, v = (constant(name, state[name]["value"] if orbit else content["launch"][name]) for name in ("tau", "v"))
    radii = [Fraction(state[name]["radius"]) for name in ("tau", "v")]
    digits, speed = ceil(-log10(min(radii))) + MORE, Fraction(state["v"]["value"])
    start = as_float(tau), as_float(v)
    need(start[1] > 0, InputError(f"{no_file}: launches with v > 0 have one"))
    if orbit:
        closer = enclosed_orbit(osc, [start[0]], [start[1]], int(content["periods"]), digits)
        if isinstance(closer, str):
            raise InputError(f"{no_file}: {closer}")
        ball, length = closer.tau[0], as_float(constant("period", content["period"])) * int(content["periods"])
    else:
        ball = impact_map(osc, tau, v, digits=digits).certified.flight_time
        length = float(ball.value)
    middle, radius = map(Fraction, ball.as_dict().values())
    rise, fall = _phases(osc, *start, length)
    ends = {"end": Fraction(length * (1 + 1e-9)).limit_denominator(10**12), "rise": rise, "fall": fall}
    ends |= {"low": middle - radius, "high": middle + radius, "slow": speed - radii[1], "fast": speed + radii[1]}
    values: dict[str, Any] = {name: f"({exact})" for name, exact in ends.items()}
    values |= {"sentence": sentence, "content": content, "orbit": orbit, "form": form, "osc": osc, "coq": _text}
    values |= {"tau": tau, "v": v, "span": constant("period", content["period"]) if orbit else None}
    values |= {"bits": ceil(BITS_A_DIGIT * digits) + 64, "library": LIBRARY.read_text(encoding="utf-8").rstrip()}
    return str(environment().get_template("flight.v.j2").render(values))


def _phases(osc: Oscillator, tau: float, v: float, length: float) -> list[Fraction]:
    """Up to where the mass surely rises, and from where it surely falls."""
    times = length * np.arange(SAMPLES + 1) / SAMPLES
    speeds = path(osc, tau, v, times).xdot
    rising, falling = np.flatnonzero(speeds < speeds[0] / 2)[0], np.flatnonzero(speeds > speeds[-1] / 2)[-1] + 1
    return [Fraction(float(end)).limit_denominator(10**6) for end in (times[min(rising, falling)], times[falling])]


def _text(tree: Expression) -> str:
    exact, text = as_fraction(tree), str(tree)
    need(
        exact is not None or not re.search(r"\*\*|[a-z]", text.replace("pi", "")),
        InputError(f"{text} is not accepted in a Coq file: give numbers of rationals, pi, +, -, * and /"),
    )
    return f"({text.replace('pi', 'PI') if exact is None else exact})"
