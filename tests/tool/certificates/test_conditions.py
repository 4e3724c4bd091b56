"""One false certificate for each condition of the second program, which that condition alone refuses."""

from __future__ import annotations

import json
import re
from fractions import Fraction
from pathlib import Path

import flint
import pytest
from second_program import FOLDER, dropped, renewed

from singimpact.certificates import TERMS, Formula, checker
from singimpact.certificates.checker import chatter_limit, motion

EXAMPLES = Path(__file__).parent / "examples"


def changed(content, path, value):
    """In place; a function is applied to what was there."""
    for key in path[:-1]:
        content = content[key]
    content[path[-1]] = value(content[path[-1]]) if callable(value) else value


def forged(example, *changes):
    content = json.loads((EXAMPLES / f"{example}.json").read_text(encoding="utf-8"))
    for path, value in changes:
        changed(content, path, value)
    return renewed(content)


def times(factor):
    return lambda text: repr(float(Fraction(text)) * factor)


def box(name, value):
    return ("boxes", 0, name), value


def after(name, value):
    return ("after", name), value


def number(value, radius):
    return {"value": value, "radius": radius}


def state(tau, v, radius):
    return ("states", 0), {"tau": number(tau, radius), "v": number(v, radius)}


FORGERIES = {
    "unknown": ("fold", (("unique_within",), "10")),
    "above": ("gamma", (("after",), {"near": "-0.01", "time": "-1"})),
    "reversed": ("gamma_of_interval", (("restitution",), lambda ends: ends[::-1])),
    "rough": ("horseshoe", (("entropy",), number("0.9", "0.8"))),
    "launch": ("accumulation", (("launch", "v"), "-0.000001"), (("tau",), number("0.9", "1e-4"))),
    "restitution": ("graze", (("model", "restitution"), "-0.5")),
    "compared": ("impact", (("v", "value"), times(1.001))),
    "period": ("orbit_linear", (("period",), "1.57079632679489661923132169163975144209858469968755291")),
    "Krawczyk": ("orbit", (("states", 0, "v", "value"), "0.66"), (("multipliers",), [])),
    "shortest": ("orbit_linear", (("states",), lambda states: [
        states[0], {**states[0], "tau": {**states[0]["tau"], "value": "4.31968989868596570"}}]),
        (("periods",), "4"), (("multipliers",), [])),
    "over": ("fold", (("model", "clearance"), "0.1 + (A - A)")),
    "complex": ("torus_linear", state("1.1706762644", "0.1822679469", "1e-9")),
    "curve": ("fold", (("parameter", "radius"), "0.003"), state("1.640419733", "0.1827417578", "0.001")),
    "change of sign": ("doubling", (("model", "g"), "(1.50219111778953378 + p**2)*cos(2.8*t)"),
        (("model", "parameters"), {"p": "0"}), (("over",), "p"), (("parameter",), number("0", "1e-5")),
        state("2.185377274", "0.5855502720", "1e-5")),
    "before": ("two_minima", (("model", "parameters", "e"), "-0.001"), (("parameter", "value"), "1.0005999142"),
        (("states", 0, "tau", "value"), "5.64079872159")),
    "just before": ("two_minima", (("parameter", "value"), "1.0005999142"),
        (("states", 0, "tau", "value"), "0.642386585588")),
    "rises": ("border_by_stiffness", (("release",), "2.0789281946880105050879")),
    "back": ("border_by_stiffness", (("parameter",), number("0.853176", "0.005"))),
    "fates": ("border", (("completes",), "below")),
    "loops": ("horseshoe", (("loops",), ["1", "16"]), (("entropy",), number("0.131", "0.001"))),
    "entropy": ("horseshoe", (("entropy", "value"), "0.2")),
    "no more": ("horseshoe", (("entropy", "value"), "0.1")),
    "long": ("horseshoe", (("period",), lambda text: f"-({text})")),
    "apart": ("horseshoe", (("sets",), lambda sets: sets[:1] * 2), (("loops",), ["1", "2"]),
              (("entropy",), number("0.481211825059603447", "1e-15"))),
    "width": ("horseshoe", (("sets", 2, "radii", 0), times(4))),
    "height": ("horseshoe", (("sets", 5, "radii", 1), times(0.25))),
    "follow": ("horseshoes", (("between", 0), "0.79")),
    "whole": ("horseshoes", (("between", 1), "0.801")),
    "zero of a_c": ("gamma", (("tau",), number("2.57104081720004368303428288200507267902139574289322", "0.0625"))),
    "L": ("gamma", (("boxes", 0, "series", 2, "value"), times(1.001))),
    "series": ("gamma", (("boxes", 0, "series"), lambda series: series[:-1])),
    "slow": ("gamma_duffing", (("fastest",), "0.001")),
    "fastest": ("gamma_duffing", (("fastest",), "700")),
    "touch": ("gamma_of_interval", (("boxes", 1, "lambda", 0), times(1.0001))),
    "lambda": ("gamma_of_interval", (("restitution", 1), "0.6")),
    "cones": ("gamma", box("M", times(0.1))),
    "residual": ("gamma", box("R", times(0.8))),
    "Kl": ("gamma", box("Kl", times(0.8))),
    "wide": ("gamma", box("eta", "1e-9")),
    "grow": ("gamma", box("grow", times(1.1))),
    "lemma 1": ("gamma", box("tree", ".")),
    "covered": ("gamma", box("tree", lambda tree: tree[:-1])),
    "reached": ("gamma", after("near", "0.26")),
    "short": ("gamma_stiff", after("time", "3")),
    "a_c > 0 after tau": ("gamma_before_dip", (("after",), {"near": "3/10", "time": "0.4"})),
    "lost": ("gamma", after("time", "1.27")),
    "landed": ("gamma_at_swan", after("speed", "0.01")),
    "completes": ("gamma_at_swan", after("end", "0.4")),
    "|A| increases after tau": ("gamma_at_swan_of_two", (("after",),
        {"launch": "1/8", "speed": "0.002", "first": "0.26", "end": "0.6"})),
    "order": ("gamma_at_swan", (("model", "clearance"), "1 - 1e-27")),
    "ends": ("lift_off", (("ends",), "accumulation")),
    "orders": ("gamma", box("D", "5"), box("R", "0"), box("Kl", "1e-9")),
    # from the lower wall to the upper one, with the same velocity a period later: no orbit of the lower wall alone
    "wall": ("orbit_between_walls", (("period",), "1"), (("multipliers",), []), (("model",), {
        "f": "-log(2)*xdot", "g": "cos(2*pi*t)", "clearance": "0", "restitution": "1/2", "upper": "1"}),
        (("states",), [{"wall": "lower", "tau": number("0.01748691327965217780", "1e-18"),
                        "v": number("0.69314718055994530942", "1e-18")}])),
}  # fmt: skip


def names():
    """All conditions that the second program has."""
    texts = "\n".join(path.read_text(encoding="utf-8") for path in FOLDER.glob("*.py"))
    direct = set(re.findall(r'\bneed\(\s*"([^"]+)"', texts))
    return direct | set(re.findall(r'require_positive\(.*"([^"]+)"\)', texts))


QUICK = {
    "border_by_stiffness",
    "torus_linear",
    "two_minima",
    "gamma",
    "impact",
    "orbit_linear",
    "graze",
    "lift_off",
    "accumulation",
    "impact_between_walls",
    "orbit_between_walls",
}


@pytest.mark.parametrize(
    "name",
    [each if FORGERIES[each][0] in QUICK else pytest.param(each, marks=pytest.mark.slow) for each in FORGERIES],
)
def test_a_condition_alone_refuses_a_forgery(name, monkeypatch):
    content = forged(*FORGERIES[name])
    with pytest.raises(checker.Refused):
        checker.check(content)
    dropped(monkeypatch, name)
    checker.check(content)


# ---- bounds that no condition names, each taken out of the source


def without(module, function, text, instead):
    """A function of a file of the second program with a part of its source replaced."""
    source = Path(module.__file__).read_text(encoding="utf-8")
    assert source.count(text) == 1
    namespace = {"__name__": "weak", "__package__": checker.__name__}
    exec(compile(source.replace(text, instead), "weak", "exec"), namespace)
    return namespace[function]


@pytest.mark.parametrize("power", [50, 60])
def test_the_factor_of_gronwall_bounds_a_step(power):
    """x = sin(t) + d sinh(w t)/w with a small d: the polynomial misses more than the residual has."""
    weak = without(motion, "step", "(B * length + A * length * length / 2).exp()", "1")
    before = flint.ctx.prec, flint.ctx.cap
    flint.ctx.prec, flint.ctx.cap = 1000, TERMS
    try:
        model = motion.Model({"f": "-10000*x", "g": "-10001*sin(t)", "clearance": "0", "restitution": "1"})
        d, w = flint.arb(10) ** -power, flint.arb(100)
        for step, holds in ((motion.step, True), (weak, False)):
            (X,), h, K = step(model, flint.arb(0), [flint.arb(0)], [1 + d], 80)
            missed = abs(h.cos() + d * (w * h).cosh() - flint.arb_poly(motion.derived(X))(h))
            assert bool(missed < K * h ** (len(X) - 1)) is holds
    finally:
        flint.ctx.prec, flint.ctx.cap = before


FALLING = {"f": "0", "g": "-0.4 - 0.6*exp(-60*(t - 20)) + exp(60*(t - 20.65))", "clearance": "0", "restitution": "0.3"}
"""a_c falls from -1 to -0.4 at once, and is positive after 20.65: before that the chatter does not complete."""
RISING = {"f": "x", "g": "cos(2.8*t)", "clearance": "0", "restitution": "0.97"}
PULLED = {
    "f": "4.5 - 7/pi*atan(1000*(xdot + 0.3)) + 10000*(pi/2 - atan(100000*(xdot + 2.2)))",
    "g": "0", "clearance": "0", "restitution": "0.1",
}  # fmt: skip
"""x'' = -1 where the mass rises, -8 where it falls, -30000 where it falls faster than 2.2, so no chatter completes."""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("model", "tau", "v", "text", "instead"),
    [
        (FALLING, "20", "0.1", "least.union(most) if most < window else None", "least.union(most)"),
        (RISING, "0.9 + 100*pi/2.8", "0.001", "q < 2 and r * q < 1", "q < 2"),
        (PULLED, "100", "1", "q < 2 and r * q < 1", "r * q < 1"),
    ],
)
def test_each_bound_of_chatter_refuses_an_accumulation(model, tau, v, text, instead, monkeypatch):
    """Where a bound does not close, what the others give is false; it is accepted without that bound alone."""
    weak = without(chatter_limit, "rest", text, instead)
    before = flint.ctx.prec, flint.ctx.cap
    flint.ctx.prec, flint.ctx.cap = 112, TERMS
    try:
        told, state = motion.Model(model), [Formula(part, {})() for part in (tau, v)]
        a = told.push(state[0], state[1] * 0)
        assert chatter_limit.rest(told, *state, a, told.ratio()) is None
        end = state[0] + weak(told, *state, a, told.ratio())
    finally:
        flint.ctx.prec, flint.ctx.cap = before
    low, high = float(end.lower()), float(end.upper())
    content = renewed({
        "schema": checker.SCHEMA, "statement": "chatter limit", "model": model, "launch": {"tau": tau, "v": v},
        "ends": "accumulation", "tau": number(repr((low + high) / 2), repr((high - low) / 2 + 1e-6)),
    })  # fmt: skip
    with pytest.raises(checker.Refused):
        checker.check(content, seconds=2)
    monkeypatch.setattr(chatter_limit, "rest", weak)
    checker.check(content)


def test_every_condition_has_a_forgery():
    assert names() == FORGERIES.keys()
