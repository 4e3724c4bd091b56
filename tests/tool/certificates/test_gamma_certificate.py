"""Certificates of gamma: accepted as they were made; wrong series, restitutions, bounds and functions are refused."""

from __future__ import annotations

import json
from pathlib import Path

import flint
import mpmath
import numpy as np
import pytest
from second_program import changed, copied, dropped, is_read_back, no_number_may_change, refuses, renewed

import singimpact as si
from singimpact.certificates import TERMS, Flights, Gravity, Growing, Model, checker
from singimpact.certificates.checker import invariant_arc

EXAMPLES = Path(__file__).parent / "examples"
TANGENCY = si.linear(2, "0.3", "0.5")
CASES = {
    "tangency": (TANGENCY, {"reach": "1/4"}),
    "swan": (si.linear(2, 1, "0.5"), {"tau": 2, "reach": "1/4"}),
    "damped": (si.ImpactOscillator("4*x + 0.3*xdot", "cos(2*t) + sin(5*t + 1)/2", "0.1", "0.7"), {"reach": "1/5"}),
    "interval": (TANGENCY, {"reach": "1/8", "restitution": ("0.48", "0.52")}),
    "Duffing": (si.ImpactOscillator("x + x**3/5 + xdot/10", "cos(2*t)", "0.3", "0.5"), {"tau": 2, "reach": "1/8"}),
    "pendulum": (si.ImpactOscillator("sin(x) + exp(-x)*xdot/10", "cos(2*t)", "0.1", "0.5"), {"tau": 2, "reach": "1/8"}),
}


class Made(dict):
    """The certificates, each made when it is asked for."""

    def __missing__(self, name):
        osc, options = CASES[name]
        self[name] = si.certify(osc.certified_gamma(**options))
        return self[name]


@pytest.fixture(scope="module")
def made():
    return Made()


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(each, marks=pytest.mark.slow) if each in ("pendulum", "Duffing", "swan", "interval") else each
        for each in CASES
    ],
)
def test_it_is_accepted_from_its_file(name, made, tmp_path):
    is_read_back(made[name], tmp_path / "gamma.json")
    assert "certificate of gamma before tau_* = " in repr(made[name])


def test_any_changed_number_changes_the_digest(made):
    no_number_may_change(made["tangency"], 30)


def boxed(content, **changes):
    """With the first box changed."""
    found = copied(content)
    found["boxes"][0].update(changes)
    return found


def nudged(content, n, by):
    """With L_n off by so much."""
    found = copied(content)
    part = found["boxes"][0]["series"][n]
    part["value"] = str(float(part["value"]) + by)
    return found


@pytest.mark.parametrize("name", ["tangency", pytest.param("swan", marks=pytest.mark.slow)])
def test_false_statements_are_refused(name, made):
    content, true = made[name].content, made[name].content["boxes"][0]
    refuses(nudged(content, 2, 1e-6), "L_2 is")
    refuses(nudged(content, 5, 1e-9), "L_5 is")
    wrong = copied(content)
    wrong["model"]["restitution"] = "0.5000005"
    refuses(wrong, "boxes of lambda do not contain")
    refuses(boxed(content, M="0"), "is not above 0")
    refuses(boxed(content, eta="1e-9"), "narrower")
    refuses(boxed(content, M=str(float(true["M"]) * 40)), "lemma 3")
    for bound, why in (("R", "residual"), ("Kl", "Kl is not")):
        refuses(boxed(content, **{bound: str(0.8 * float(true[bound]))}), why)
    refuses(boxed(content, Kl=str(0.1 * float(true["Kl"]))), "lemma 5")
    refuses(boxed(content, grow=str(1.1 * float(true["grow"]))), "grow as fast")
    refuses(boxed(content, tree="l" + true["tree"][1:-1]), "cover|fit")
    refuses(boxed(content, tree="."), "lemma 1")
    refuses(boxed(content, tree=true["tree"].replace(".", "x")), "is not understood")
    refuses(boxed(content, series=true["series"][:-1]), "another length")
    refuses({**copied(content), "tau": {"value": "2.5", "radius": "1e-9"}}, "zero of a_c")
    refuses({**copied(content), "threshold": {**content["threshold"], "radius": "1e-12"}}, "threshold is")
    refuses({**copied(content), "reach": "9/10"})
    refuses({**copied(content), "order": "3"})


def test_another_order_or_model_is_refused(made):
    wrong = copied(made["swan"].content)
    wrong["model"]["clearance"] = "0.9999"
    refuses(wrong, "does not vanish")
    wrong["model"].update(f="x*x", clearance="1")
    refuses(wrong, "not linear")


@pytest.mark.slow
def test_of_a_nonlinear_model_more_is_refused(made):
    """Faster launches, what comes after tau, another model of the same contact point, and a linear proof of it."""
    content, true = made["Duffing"].content, made["Duffing"].content["boxes"][0]
    for bound, why in (("R", "residual"), ("Kl", "Kl is not")):
        refuses(boxed(content, **{bound: str(0.8 * float(true[bound]))}), why)
    refuses(nudged(content, 5, 1e-9), "L_5 is")
    refuses({**copied(content), "fastest": "700"}, "launch speeds")
    refuses({**copied(content), "after": {"near": "1/16", "time": "1/10"}}, "unknown field")
    wrong = copied(content)
    wrong["model"]["f"] = "x + x**3/5 + xdot/10 + xdot**2/1000"
    refuses(wrong, "L_")
    linear = copied(content)
    del linear["fastest"]
    refuses(linear, "not linear")


@pytest.mark.slow
@pytest.mark.parametrize("where", ["balls", "models", "cut"])
def test_a_checker_with_wrong_functions_of_a_nonlinear_model_refuses(where, made, monkeypatch):
    kind = Flights
    if where == "balls":
        true = kind.speeds
        monkeypatch.setattr(kind, "speeds", lambda self, S, x: [true(self, S, x)[k] for k in (1, 0, 3, 2, 5, 4)])
    elif where == "models":
        twice = kind.folded
        monkeypatch.setattr(kind, "folded", lambda self, ring, S, x: twice(self, ring, S, x)[::-1])
    else:
        monkeypatch.setattr(kind, "tail", lambda *_: flint.arb(1))
    with pytest.raises(checker.Refused):
        checker.check(made["Duffing"].content)


def test_a_growing_series_is_that_of_flint():
    """Each function of a series, made one coefficient after the other, against flint's own."""
    parts = [flint.arb(part) for part in ("0.3", "0.7", "-0.2", "0.5", "0.1", "-0.4")]
    u = Growing(lambda _, n: flint.arb_poly([parts[n]]))
    whole = flint.arb_series(parts, prec=6)
    for found, true in (
        (u.exp(), whole.exp()), (u.sin(), whole.sin()), (u.cos(), whole.cos()), (u.log(), whole.log()),
        (u.atan(), whole.atan()), (u.sqrt(), whole.sqrt()), (flint.arb(2) / u, flint.arb_series([2], prec=6) / whole),
        (u * u + 1, whole * whole + 1), (u * flint.arb(3) + u, 4 * whole),
    ):  # fmt: skip
        assert all(found.at(n)[0].overlaps(true[n]) for n in range(6))


@pytest.mark.parametrize(
    "name", ["gamma", *(pytest.param(f"gamma_{each}", marks=pytest.mark.slow) for each in ("of_interval", "duffing"))]
)
def test_the_series_annuls_the_residual(name, monkeypatch):
    """Below S^N, for all lambda of a box; a series with a wrong factor does not."""
    residuals, true = [], invariant_arc.Folded.residual

    def seen(ring, o, L, ratio):
        found = true(ring, o, L, ratio)
        residuals.append((found.over(), len(L)))
        return found

    def annulled(content):
        residuals.clear()
        checker.check(content)
        return [all(found[i].contains(0) for i in range(N)) for found, N in residuals]

    content = json.loads((EXAMPLES / f"{name}.json").read_text(encoding="utf-8"))
    monkeypatch.setattr(invariant_arc.Folded, "residual", seen)
    assert all(annulled(content))
    parts = invariant_arc.parts_of
    monkeypatch.setattr(invariant_arc, "parts_of", lambda j: (*parts(j)[:2], [0, *parts(j)[2][:-1]]))
    monkeypatch.setattr(invariant_arc.Box, "require_series", lambda *_: None)
    dropped(monkeypatch, "residual", "Kl", "wide", "compared")
    assert not all(annulled(content))


@pytest.mark.slow
def test_what_comes_after_is_checked(made):
    content = made["tangency"].content
    refuses({**copied(content), "after": {**content["after"], "time": "1.27"}}, "a_c > 0 for so long")
    refuses({**copied(content), "after": {**content["after"], "time": "1.6"}}, "longer than")
    content = made["swan"].content
    for name, value, why in (("speed", "0.01", "lands in time"), ("end", "0.4", "completes in time"),
                             ("end", "0.9", None), ("launch", "0.3", "beyond the reach")):  # fmt: skip
        refuses({**copied(content), "after": {**content["after"], name: value}}, why)
    checker.check(renewed({**copied(content), "after": {}}))  # nothing is said of it then


def test_boxes_of_lambda_must_touch_and_cover(made):
    content = made["interval"].content
    assert len(content["boxes"]) > 1
    refuses({**copied(content), "boxes": content["boxes"][1:]}, "do not contain")
    gap = copied(content)
    low, high = gap["boxes"][0]["lambda"]
    gap["boxes"][0]["lambda"] = [low, changed({"x": high}, ("x",))["x"]]
    refuses(gap, "touch")
    refuses({**copied(content), "restitution": "model"}, "has no 'threshold'")
    refuses({**copied(content), "restitution": ["0.48", "0.6"]}, "do not contain")


@pytest.mark.parametrize("where", ["balls", "models", "cut"])
def test_a_checker_with_wrong_functions_refuses(where, made, monkeypatch):
    """W and U exchanged, in balls or in Taylor models; a tail that is left out makes it accept, as it must."""
    true = Gravity.speeds
    if where == "balls":
        monkeypatch.setattr(Gravity, "speeds", lambda self, S, x: [true(self, S, x)[k] for k in
                                                                           (1, 0, 3, 2, 5, 4)])  # fmt: skip
    elif where == "models":
        twice = Gravity.folded
        monkeypatch.setattr(Gravity, "folded", lambda self, ring, S, x: twice(self, ring, S, x)[::-1])
    else:
        monkeypatch.setattr(Gravity, "tail", lambda self, power: flint.arb(1))  # noqa: ARG005
    with pytest.raises(checker.Refused):
        checker.check(made["tangency"].content)


def test_from_the_command_line(singimpact, tmp_path):
    model = tmp_path / "model.toml"
    model.write_text(TANGENCY.to_toml())
    file = tmp_path / "gamma.json"
    done = singimpact("certify", "gamma", model, "--reach", "1/4", "-o", file)
    assert "proved for r = 1/2" in done.stderr
    assert json.loads(file.read_text())["statement"] == "invariant arc"
    assert "certificate of gamma" in singimpact("certify", file).stdout


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (("gamma", "a.toml", "b.toml"), "one model"),
        (("gamma", "--omega", "2", "--clearance", "0.3", "--restitution", "0.5", "--chatter"), "one model"),
        (("gamma", "a.toml", "--model", "b.toml"), "two models"),
        (("--reach", "1/4"), "certify gamma"),
    ],
)
def test_bad_command_lines(words, why):
    from click.testing import CliRunner

    from singimpact.cli.branch_commands import certify_command

    done = CliRunner().invoke(certify_command, list(words))
    assert isinstance(done.exception, si.InputError)
    assert why in str(done.exception)


def test_gamma_that_ends_at_time_zero_is_accepted():
    """tau_* = 0 is exact: its ball has a radius all the same."""
    model = si.ImpactOscillator("x", "sin(2*t)", 0, "1/2")
    text = si.certify(model.certified_gamma("-0.1", reach="1/4")).text
    checker.check(json.loads(text))


# ---- lemmas 4 and 5, which the first program does not have

GRAVITIES = [
    ("x", "cos(2*t)", "0.3", 2.5085408172000436, lambda t: mpmath.cos(2 * t)),
    ("x", "cos(2*t) + cos(6*t)/4", "0.2", 2.5871971975887016, lambda t: mpmath.cos(2 * t) + mpmath.cos(6 * t) / 4),
    ("x", "cos(2*t) - cos(10*t)/3", "0.1", 2.560354491995202, lambda t: mpmath.cos(2 * t) - mpmath.cos(10 * t) / 3),
    ("x + xdot/5", "sin(t) + sin(9*t)/3", "0", 0.0, lambda t: mpmath.sin(t) + mpmath.sin(9 * t) / 3),
    (  # A = sin(t) (1.002 - cos(t + 0.2)) is small at t = -0.2
        "x",
        "1.002*sin(t) - sin(2*t + 0.2)/2 + sin(0.2)/2",
        "0",
        0.0,
        lambda t: mpmath.sin(t) * (mpmath.mpf("1.002") - mpmath.cos(t + mpmath.mpf("0.2"))),
    ),
]


def gravity(f, g, c, tau, reach):
    model = Model({"f": f, "g": g, "clearance": c, "restitution": "0.5"})
    return Gravity(model, flint.arb(tau), 1, flint.arb(reach))


@pytest.fixture
def precise():
    before = flint.ctx.prec, flint.ctx.cap
    flint.ctx.prec, flint.ctx.cap = 128, TERMS
    yield
    flint.ctx.prec, flint.ctx.cap = before


@pytest.mark.usefixtures("precise")
@pytest.mark.parametrize("place", range(len(GRAVITIES)))
def test_the_gravity_is_called_log_concave_where_it_is(place):
    """Beside (ln |A|)'' of the closed form, by differences in 40 digits."""
    f, g, c, tau, forcing = GRAVITIES[place]
    half = mpmath.mpf("0.1") if "xdot" in f else 0
    verdicts = set()
    with mpmath.workdps(40):
        w = mpmath.sqrt(1 - half**2)

        def pull(distance):
            t = mpmath.atan(-w * distance) / w
            pressed = forcing(tau + t) - mpmath.mpf(c)
            return mpmath.log(-mpmath.exp(half * t) * mpmath.cos(w * t) ** 3 * pressed)

        for reach in (0.05, 0.125, 0.25, 0.4):
            bends = [mpmath.diff(pull, mpmath.mpf(reach) * n / 60, 2) for n in range(1, 61)]
            verdict = gravity(f, g, c, tau, reach).log_concave()
            verdicts.add((verdict, max(bends) < 0))
            assert max(bends) < 0 or not verdict
    assert verdicts >= {(True, True), (False, False)} if place == len(GRAVITIES) - 1 else (True, True) in verdicts


@pytest.mark.usefixtures("precise")
@pytest.mark.parametrize("r", ["0.2", "0.5", "0.9"])
def test_orbits_keep_their_order_where_the_gravity_is_log_concave(r):
    """Faster launches at one time stay ahead at each impact before tau, and their flights are longer, in s = tan."""
    f, g, c, end, _ = GRAVITIES[0]
    assert gravity(f, g, c, end, 0.5).log_concave()
    osc = si.ImpactOscillator(f, g, c, r)
    launches = np.geomspace(1e-3, 0.3, 40)
    tau, v = np.full(40, end - np.arctan(0.5)), launches
    length, compared = np.zeros(40), 0
    for _ in range(6):
        step = osc.impact_map(tau, v)
        before = np.asarray(step.tau) < end
        s = np.tan(np.where(before, step.tau, end) - end)
        length = s - np.tan(tau - end)
        ahead = np.flatnonzero(before)
        assert np.all(np.diff(ahead) == 1)  # who passes is faster than who does not
        assert np.all(np.diff(s[ahead]) > 0)
        assert np.all(np.diff(length[ahead]) > 0)
        compared += ahead.size
        tau, v = np.where(before, step.tau, np.nan)[ahead], np.asarray(step.v)[ahead]
    assert compared > 60
