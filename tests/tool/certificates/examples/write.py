"""Write a certificate of every kind, and the same statement with more digits, for the forgeries of the tests.

    python tests/tool/certificates/examples/write.py [NAME]...

NAME.json is what the forgeries of the tests are made from; in NAME.true.json its numbers have more digits, by which a
forged number is known to be true or false.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import singimpact as si
from singimpact.certificates import certificate as certificate_

FOLDER = Path(__file__).parent
DUFFING = si.ImpactOscillator("0.1*xdot + x + e*x**3", "cos(1.7*t)", "0.3", "3/5", {"e": "0.3"})
LAW = si.ImpactOscillator("x + atan(x)/3", "exp(-cos(t))", "0.3", "-0.8*v*exp(-v**2/10)")
LINEAR = si.linear("2.8", "0", "0.8")
TWO = si.ImpactOscillator("x", "-cos(2*t)/2 + 3*cos(4*t)/8", "-1/8", "0.5")
"""-a_c = 2 sin(t)^2 - 3 sin(t)^4 decreases soon after the swan."""
STIFF = si.ImpactOscillator("100*x", "sin(t)", 0, "0.5")
DIP = si.ImpactOscillator("x", "0.9998*sin(t) - sin(2*t - 0.2)/2 - sin(0.2)/2", 0, "0.05")
"""a_c = sin(t) (1 - cos(t - 0.2) - 0.0002) is negative for a short time after it has risen through zero."""


def _event(model, over, between, kind, orbit, digits, **options):
    events = si.branch(orbit(model), over, between, **options).events
    return next(each for each in events if each.kind == kind and each.orbit.visible).certified(digits)


def _linear_event(kind, digits):
    model = si.ImpactOscillator("x + 0.05*xdot", "A*cos(2.8*t)", "0.1", "0.8", {"A": "1"})
    return _event(model, "A", (0.01, 3.0), kind, lambda osc: next(o for o in osc.periodic(1, 1) if o.visible), digits)


def _graze(digits):
    model = si.ImpactOscillator("x + 0.1*xdot", "-A*cos(0.8*t)", -1, "0.8", {"A": "0.45"})
    return _event(model, "A", (0.3, 0.5), "graze", lambda osc: osc.periodic(1, 1)[0], digits)


def _two_minima(digits):
    """x = p ((cos t - 4/5)^2 - 1 + e sin t): two minima of nearly the same height, the lower one touches the wall."""
    g = "p*(0.14 + 0.16*sin(t) - 1.5*cos(2*t) - 0.1*sin(2*t) + e*cos(t)/10)"
    model = si.ImpactOscillator("x + 0.1*xdot", g, -1, "0.8", {"p": "0.99", "e": "0.001"})
    return _event(model, "p", (0.9, 1.2), "graze", lambda osc: osc.periodic(0, 1)[0], digits)


def _hidden(digits):
    model = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "A*cos(w*t)", "0.3", "0.6", {"w": "1.7", "A": 1})
    start = (1.95786, 0.662042)
    return _event(model, "A", (0.6, 1.3), "hidden impact", lambda osc: osc.periodic(2, 1, start=start)[0], digits)


def _torus(digits):
    numbers = {"mu": "0.2", "A": "1.5", "w": "2.2"}
    model = si.ImpactOscillator("x - mu*(1 - x**2)*xdot", "A*cos(w*t)", 0, "0.9", numbers)
    start = (2.64089, 2.19428)
    return _event(model, "A", (0.5, 1.6), "torus", lambda osc: osc.periodic(1, 1, start=start)[0], digits, step=0.1)


def _torus_linear(digits):
    """At this number every orbit of one impact has multipliers with the product 1."""
    model = si.ImpactOscillator("x + mu*xdot", "0.05*cos(2.8*t)", "0.1", "0.9", {"mu": "-0.08"})
    return _event(model, "mu", (-0.12, -0.05), "torus", lambda osc: osc.periodic(1, 1)[1], digits)


def _border(digits):
    (found,) = si.border_orbits(si.linear("2.8", 0, "0.5"), between=("0.6", "0.61"), points=5, digits=digits)
    return found


def _border_by_stiffness(digits):
    """a_c does not depend on the number; r is so small that the orbit comes back just before the end."""
    numbers = {"h": "0.02", "k": "0.86"}
    model = si.ImpactOscillator("k*x", "h - (1 - cos(t))*(cos(t) + 1/2)", 0, "0.00001", numbers)
    (found,) = si.border_orbits(model, "k", between=("0.85", "0.9"), points=6, digits=digits)
    return found


EXAMPLES = {
    "impact": (lambda digits: DUFFING.impact_map("1.4", "0.6", digits=digits), 12),
    "impact_by_law": (lambda digits: LAW.impact_map("1.4", "0.6", digits=digits), 12),
    "orbit": (lambda digits: DUFFING.periodic(2, 1, start=(1.957856511, 0.662042377))[0].certified(digits), 14),
    "orbit_linear": (lambda digits: si.linear(4, 0, "0.5").periodic(1, 2)[0].certified(digits), 14),
    "accumulation": (lambda digits: LINEAR.chatter_limit("0.9", "0.005", digits=digits), 12),
    "lift_off": (lambda digits: LINEAR.chatter_limit("1.1", "0.1", digits=digits), 12),
    "gamma": (lambda _: si.linear(2, "0.3", "0.5").certified_gamma(reach="1/4"), 0),
    "gamma_of_interval": (
        lambda _: si.linear(2, "0.3", "0.5").certified_gamma(reach="1/8", restitution=("0.48", "0.52")), 0,
    ),
    "gamma_at_swan": (lambda _: si.linear(2, 1, "0.5").certified_gamma(tau=2, reach="1/4"), 0),
    "gamma_at_swan_of_two": (lambda _: replace(TWO.certified_gamma(tau=3, reach="1/8"), settled=None), 0),
    "gamma_stiff": (lambda _: STIFF.certified_gamma(tau="6.2", reach="1/40"), 0),
    "gamma_before_dip": (lambda _: DIP.certified_gamma(tau="6.25", reach="3/10"), 0),
    "gamma_duffing": (
        lambda _: si.ImpactOscillator("x + x**3/5 + xdot/10", "cos(2*t)", "0.3", "0.5")
        .certified_gamma(tau=2, reach="1/8"), 0,
    ),
    "horseshoe": (lambda _: si.homoclinic_points(LINEAR.periodic(1, 1)[0])[0].horseshoe(), 0),
    "horseshoes": (
        lambda _: si.homoclinic_points(LINEAR.periodic(1, 1)[0])[0].horseshoes("restitution", ("0.8", "0.8004")), 0,
    ),
    "border": (_border, 14),
    "border_by_stiffness": (_border_by_stiffness, 12),
    "fold": (lambda digits: _linear_event("fold", digits), 8),
    "doubling": (lambda digits: _linear_event("period-doubling", digits), 8),
    "torus": (_torus, 6),
    "torus_linear": (_torus_linear, 8),
    "graze": (_graze, 10),
    "two_minima": (_two_minima, 10),
    "hidden": (_hidden, 10),
}  # fmt: skip
"""name -> the result, and its digits; 0 where there is no choice."""


def main(names: list[str]) -> None:
    for name in names or EXAMPLES:
        result, digits = EXAMPLES[name]
        certificate = si.certify(result(digits))
        certificate.check()
        certificate.save(FOLDER / f"{name}.json")
        if digits:
            si.certify(result(digits + 8)).save(FOLDER / f"{name}.true.json")
        elif name.startswith("gamma"):
            certificate_.SERIES_DIGITS += 8
            true = si.certify(result(0))
            if "swan" in name:  # cos(2t) = 1 at pi
                true.content["tau"] = {"value": "3.1415926535897932384626433832795", "radius": "1e-30"}
            true.save(FOLDER / f"{name}.true.json")
            certificate_.SERIES_DIGITS -= 8
        print(name)


if __name__ == "__main__":
    main(sys.argv[1:])
