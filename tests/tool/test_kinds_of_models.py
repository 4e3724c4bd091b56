"""Models of the field in every combination: each study answers, or refuses in a sentence; none fails otherwise."""

from math import inf

import numpy as np
import pytest

import singimpact as si
from singimpact.inputs import InputError

FORCES = {
    "forced": ("x + 0.1*xdot", "cos(2*t)"),
    "t in f": ("(1 + cos(2*t)/5)*x + 0.1*xdot", "cos(2*t)"),
    "no clock": ("-(1 - x**2)*xdot + x", "0"),
    "no period": ("x + 0.1*xdot", "cos(2*t) + cos(sqrt(2)*t)/2"),
}
WALLS = {
    "one wall": {"restitution": "0.7"},
    "two walls": {"restitution": "0.7", "upper": "0.5", "upper_restitution": "-0.5*v/(1 + v**2/10)"},
    "plastic": {"restitution": 0},
}
CALLS = {
    "first_hit": lambda osc: osc.first_hit([0.1, 0.5], [0.5, 1.0]),
    "digits": lambda osc: osc.first_hit(0.1, 0.5, digits=20).certified,
    "launch": lambda osc: osc.launch(x=0.1, xdot=0.2, t=0.3),
    "inverse_map": lambda osc: osc.inverse_map(1.0, 0.5),
    "derivative": lambda osc: osc.derivative(0.1, 0.5),
    "iterate": lambda osc: osc.iterate(np.linspace(0, 3, 70), 0.5, 10),
    "orbit": lambda osc: osc.orbit(0.1, 0.5, 20).sample([1.0, 2.0]),
    "chatter_limit": lambda osc: osc.chatter_limit(0.1, 1e-3),
    "release": lambda osc: osc.release(2.0),
    "release_map": lambda osc: osc.release_map(),
    "periodic": lambda osc: osc.periodic(1, 1),
    "resting": lambda osc: osc.periodic(inf, 1),
    "word": lambda osc: osc.periodic("lu", 1),
    "lyapunov": lambda osc: si.lyapunov(osc, 0.1, 0.5, impacts=100),
    "basins": lambda osc: si.basins(osc, size=4, impacts=500),
    "bifurcation": lambda osc: si.bifurcation(osc, "clearance", (-0.35, -0.3), 2, impacts=50, kept=10, settle=500),
    "tangency_points": si.tangency_points,
    "classify": si.classify,
    "transitions": lambda osc: si.transitions(osc, "clearance", (-0.35, -0.3)),
    "threshold": lambda osc: si.threshold(osc, 2.0),
    "grown_gamma": si.grown_gamma,
    "certified_gamma": lambda osc: osc.certified_gamma(),
    "border_orbits": lambda osc: si.border_orbits(osc, "clearance", (-0.35, -0.3)),
    "surface": lambda osc: si.ImpactSurface(osc, tau=(0, 1), t=(0, 1), resolution=0.1).outline,
    "series": lambda osc: si.theory.gamma(3, model=osc),
    "explore": lambda osc: si.explore(osc, points=2),
}


def model(force, walls):
    return si.ImpactOscillator(*FORCES[force], "-0.3", **WALLS[walls])


@pytest.mark.parametrize("walls", WALLS)
@pytest.mark.parametrize("force", FORCES)
def test_every_study_answers_or_refuses_in_a_sentence(force, walls):
    answered, told = set(), []
    for name, call in CALLS.items():
        try:
            call(model(force, walls))
            answered.add(name)
        except InputError as refusal:
            told.append(str(refusal))
    assert all(len(text.splitlines()) == 1 for text in told)
    assert "unresolved" not in {found.kind for found in si.basins(model(force, walls), size=4).attractors}
    assert answered >= {"first_hit", "digits", "launch", "derivative", "iterate", "orbit", "lyapunov", "basins"}
