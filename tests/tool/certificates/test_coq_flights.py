"""Coq proves first impacts and periodic orbits of linear models from their equation of motion, and no forged ones."""

from __future__ import annotations

import re
import shutil
import subprocess
from fractions import Fraction

import numpy as np
import pytest

import singimpact as si
from singimpact.documents import coq_flight
from singimpact.inputs import InputError

pytestmark = pytest.mark.slow
needs_coq = pytest.mark.skipif(shutil.which("coqc") is None, reason="needs coqc and coq-interval")
WAVES = si.ImpactOscillator("x + xdot/5", "cos(2*t) + sin(3*t + pi/3)/5 - 1/10", "0.3", "0.6")


def text_of(result):
    certificate = si.certify(result)
    return coq_flight(certificate.content, repr(certificate)[1:-1])


def proved(text, folder):
    (folder / "flight.v").write_text(text, encoding="utf-8")
    return not subprocess.run(["coqc", "flight.v"], cwd=folder, capture_output=True, check=False).returncode


def drawn(seed):
    """A linear model with its first impact from a state: damping, several waves, a wall on both sides of the rest."""
    rng = np.random.default_rng(seed)
    d, k, a, c = (Fraction(int(n), 40) for n in rng.integers([0, 10, 20, -20], [20, 120, 140, 20]))
    e, q = (Fraction(int(n), 10) for n in rng.integers([0, -9], [60, 9]))
    g = f"cos({a}*t + {e}) + {q}*sin({2 * a}*t)"
    osc = si.ImpactOscillator(f"{k}*x + {d}*xdot", g, str(c), str(Fraction(int(rng.integers(1, 20)), 20)))
    return osc.impact_map(
        str(Fraction(int(rng.integers(0, 60)), 10)), str(Fraction(int(rng.integers(2, 20)), 10)), digits=20
    )


@needs_coq
@pytest.mark.parametrize("seed", range(4))
def test_first_impacts_of_drawn_models_are_proved(seed, tmp_path):
    assert proved(text_of(drawn(seed)), tmp_path)


ORBITS = {
    "stable": (si.linear(4, 0, "0.5"), 2, 20),
    "saddle": (si.linear("2.8", 0, "0.8"), 1, 30),
    "damped": (si.ImpactOscillator("x + xdot/5", "cos(4.4*t + pi/3)/2 - 1/10", "0.1", "0.6"), 1, 15),
}


@needs_coq
@pytest.mark.parametrize("name", ORBITS)
def test_periodic_orbits_are_proved(name, tmp_path):
    osc, periods, digits = ORBITS[name]
    text = text_of(osc.periodic(1, periods)[0].certified(digits))
    assert proved(text, tmp_path)
    r = re.search(r"Definition r : R := (.*)\.\n", text)[1]
    assert not proved(text.replace(f"Definition r : R := {r}.", f"Definition r : R := ({r} + 1/1000)."), tmp_path)


@needs_coq
@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("r", "({} - 1/10^9)"),
        ("c", "({} + 1/10^9)"),
        ("k", "({} + 1/10^9)"),
        ("d", "({} + 1/10^9)"),
    ],
)
def test_the_impact_of_another_model_is_not_proved(name, change, tmp_path):
    text = text_of(WAVES.impact_map("0.4", "0.5", digits=20))
    if name == "r":
        assert proved(text, tmp_path)
    stated = f"Definition {name} : R := (.*)\\.\n"
    forged = re.sub(stated, lambda found: f"Definition {name} : R := {change.format(found[1])}.\n", text)
    assert forged != text
    assert not proved(forged, tmp_path)


@needs_coq
def test_a_later_hit_is_not_the_first_one(tmp_path):
    """The motion meets the wall again after it went below it: no rise, stay and fall leads there."""
    text = text_of(si.linear("2.8", 0, "0.8").impact_map("0.9", "0.3", digits=20))
    low, high = re.search(r"exists T, (\(.*?\)) < T < (\(.*?\))", text).groups()
    forged = text.replace(low, f"({low} + 2)").replace(high, f"({high} + 2)")
    assert not proved(forged, tmp_path)
    assert not proved(text.replace(low, f"({low} + 1/10^15)").replace(high, f"({high} + 1/10^15)"), tmp_path)


def test_the_theorem_says_what_the_certificate_says():
    certificate = si.certify(WAVES.impact_map("0.4", "0.5", digits=20))
    text = coq_flight(certificate.content, repr(certificate)[1:-1])
    theorem = re.sub(r"\s+", " ", re.search(r"Theorem first_impact :(.*?)\nProof", text, re.DOTALL)[1])
    numbers = [
        Fraction(part) for part in re.findall(r"\((\d+/\d+)\) <|<=? \((\d+/\d+)\)", theorem) for part in part if part
    ]
    low, high, slow, fast = numbers[0], numbers[1], *numbers[-2:]
    time, v = (certificate.content[name] for name in ("flight_time", "v"))
    for ends, ball in (((low, high), time), ((slow, fast), v)):
        assert all(abs(end - Fraction(ball["value"])) <= Fraction(ball["radius"]) for end in ends)
    assert "first impact from (0.4, 0.5)" in text.splitlines()[0]


@pytest.mark.parametrize(
    ("result", "why"),
    [
        (
            lambda: si.ImpactOscillator("x + x**3", "cos(2*t)", 0, "0.8").impact_map("0.9", "0.3", digits=15),
            "a linear model",
        ),
        (
            lambda: si.ImpactOscillator("x + 3*xdot", "cos(2*t)", 0, "0.8").impact_map("0.9", "0.3", digits=15),
            "damping",
        ),
        (lambda: si.linear("2.8", 0, "0.8").impact_map("2.5", "0", digits=15), "v > 0"),
        (lambda: si.linear("2.8", 0, "0.8").periodic(2, 2)[0], "orbits of one impact"),
        (
            lambda: si.linear("2.8", 0, "0.8").chatter_limit("0.9", "0.005", digits=15),
            "first impacts and periodic orbits",
        ),
        (
            lambda: si.ImpactOscillator("x", "cos(sqrt(2)*t)", 0, "0.8").impact_map("0.9", "0.3", digits=15),
            "rationals, pi",
        ),
    ],
)
def test_what_has_no_file_is_said_in_a_sentence(result, why):
    with pytest.raises(InputError, match=why):
        text_of(result())


@needs_coq
def test_from_the_command_line(singimpact, tmp_path):
    model = ["--omega", "2.8", "--clearance", "0", "--restitution", "0.8"]
    singimpact("certify", *model, "--tau", "0.9", "--v", "0.3", "--format", "coq", "-o", str(tmp_path / "hit.v"))
    assert proved((tmp_path / "hit.v").read_text(encoding="utf-8"), tmp_path)
    assert "Theorem first_impact" in singimpact("certify", *model, "--tau", "1", "--v", "1", "--format", "coq").output


def test_a_proof_of_gamma_has_no_coq_file(singimpact):
    done = singimpact("certify", "gamma", "--omega", "2", "--restitution", "0.5", "--format", "coq")
    assert "certify gamma takes one model: --format coq is not accepted" in done.stderr
    assert done.exit_code == 2
