"""`singimpact certify`: a certificate written, checked and refused."""

from __future__ import annotations

import json

import pytest

from singimpact.certificates import KINDS
from singimpact.cli import EVENTS

MODEL = ["--omega", "2.8", "--clearance", "0.1", "--restitution", "0.8"]


def test_a_certificate_is_written_and_checked(singimpact, tmp_path):
    path = tmp_path / "impact.json"
    made = singimpact("certify", *MODEL, "--tau", "0.9", "--v", "0.3", "--digits", "20", "-o", path)
    assert (made.exit_code, made.output) == (0, "")
    content = json.loads(path.read_text())
    assert content["launch"] == {"tau": "0.9", "v": "0.3"}
    checked = singimpact("certify", path)
    assert checked.exit_code == 0
    assert checked.output.strip().endswith("holds")
    path.write_text(path.read_text().replace('"2.8"', '"2.9"'))
    refused = singimpact("certify", path)
    assert refused.exit_code == 2
    assert "the certificate is refused: the digest is not that of the content" in refused.output


@pytest.mark.parametrize(
    ("given", "why"),
    [
        ([*MODEL, "--tau", "0.9"], "give --tau and --v"),
        ([*MODEL, "--tau", "0.9", "--v", "0"], "is not certified"),
        (["absent.json"], "absent.json cannot be read"),
    ],
)
def test_refusals(given, why, singimpact):
    refused = singimpact("certify", *given)
    assert refused.exit_code == 2
    assert why in refused.output


def test_a_periodic_orbit_is_written_and_checked(singimpact, tmp_path):
    path = tmp_path / "orbit.json"
    model = ["--omega", "4", "--clearance", "0", "--restitution", "0.5"]
    made = singimpact("certify", *model, "--orbit", "1", "2", "--digits", "15", "-o", path)
    assert (made.exit_code, made.output) == (0, "")
    assert json.loads(path.read_text())["statement"] == "periodic orbit"
    assert "certificate of the (1, 2) periodic orbit" in singimpact("certify", path).output
    none = singimpact("certify", *model, "--orbit", "2", "1")
    assert none.exit_code == 2
    assert "--orbit 2 1: 0 orbits are found" in none.output


@pytest.mark.slow
def test_a_chatter_limit_and_a_horseshoe(singimpact, tmp_path):
    limit, shoe = str(tmp_path / "limit.json"), str(tmp_path / "horseshoe.json")
    singimpact("certify", *MODEL, "--chatter", "--tau", "0.9", "--v", "0.005", "--digits", "15", "-o", limit)
    assert "certificate of the chatter limit from (0.9, 0.005)" in singimpact("certify", limit).output
    both = singimpact("certify", *MODEL, "--chatter", "--orbit", "1", "1")
    assert "give one of --orbit and --chatter" in both.output
    assert "--tau and --v" in singimpact("certify", *MODEL, "--chatter").output
    singimpact("certify", *MODEL[:3], "0", *MODEL[4:], "--horseshoe", "1", "1", "-o", shoe)
    assert "certificate of a horseshoe: loops of 1 and 17 impacts" in singimpact("certify", shoe).output
    singimpact(
        "certify", *MODEL[:3], "0", *MODEL[4:], "--horseshoe", "1", "1", "--between", "0.8", "0.8004", "-o", shoe
    )
    assert "horseshoes for all restitution in [4/5, 2001/2500]" in singimpact("certify", shoe).output
    assert "0 saddles are found" in singimpact("certify", "--omega", "4", "--clearance", "0", "--restitution", "1/2",
                                               "--horseshoe", "1", "2").output  # fmt: skip


@pytest.mark.slow
def test_a_period_doubling(singimpact, tmp_path):
    path, model = tmp_path / "model.toml", tmp_path / "doubling.json"
    path.write_text(
        'f = "x + 0.05*xdot"\ng = "A*cos(2.8*t)"\nclearance = "0.1"\nrestitution = "0.8"\n[parameters]\nA = "1"\n'
    )
    given = ["--model", str(path), "--orbit", "1", "1", "--digits", "10"]
    made = singimpact("certify", *given, "--doubling", "A", "0.5", "2", "-o", str(model))
    assert (made.exit_code, made.output) == (0, "")
    assert "certificate of a period-doubling: A = 1.502" in singimpact("certify", str(model)).output
    none = singimpact("certify", *given, "--doubling", "A", "0.9", "1.1")
    assert "no period-doubling of visible orbits is found" in none.output
    fold = singimpact("certify", *given, "--event", "fold", "A", "0.9", "1.1")
    assert "--event fold A 0.9 1.1: no fold of visible orbits is found there" in fold.output
    assert "'cusp' is not one of" in singimpact("certify", *given, "--event", "cusp", "A", "0.9", "1.1").output


@pytest.mark.slow
def test_a_border_orbit(singimpact, tmp_path):
    path, model = str(tmp_path / "border.json"), ["--omega", "2.8", "--clearance", "0.6", "--restitution", "1/2"]
    made = singimpact("certify", *model, "--border", "clearance", "0.6", "0.61", "--digits", "16", "-o", path)
    assert (made.exit_code, made.output) == (0, "")
    assert "certificate of a border orbit: clearance = 0.6046031976977" in singimpact("certify", path).output
    none = singimpact("certify", *model, "--border", "clearance", "0.61", "0.62", "--digits", "16")
    assert "--border clearance 0.61 0.62: no border orbit is found there" in none.output


def test_an_event_is_of_an_orbit(singimpact):
    none = singimpact("certify", *MODEL, "--chatter", "--tau", "1", "--v", "1", "--event", "fold", "A", "0", "1")
    assert "--event and --doubling are of an orbit: give --orbit N K" in none.output


def test_the_commands_kinds_are_those_of_the_checker():
    assert EVENTS[: len(KINDS)] == KINDS  # those after them are refused in a sentence
