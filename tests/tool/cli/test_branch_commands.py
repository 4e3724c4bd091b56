"""branch, events: the numbers that they print, the files that they write, and what they refuse."""

from __future__ import annotations

import csv
import json

import numpy as np
import pytest

import singimpact as si

COCO = ["--omega", "0.8", "--clearance", "-1", "--restitution", "0.8", "--damping", "0.1", "--amplitude", "-0.45"]
RESONANT = ["--omega", "1", "--clearance", "-1", "--restitution", "0.8", "--damping", "0.1", "--amplitude", "-0.12"]
TORN = ["--omega", "2.8", "--clearance", "0.1", "--restitution", "0.8", "--amplitude", "-1"]
GRAZE = np.hypot(1 - 0.64, 0.08)  # COCO, Recipes 15.2


def test_a_pitchfork_is_listed_and_has_no_certificate(singimpact):
    model = ["--omega", "4.83", "--clearance", "0.36", "--restitution", "0.34", "--orbit", "2", "2"]
    done = singimpact("branch", *model, "--over", "clearance", "--from", "0.35", "--to", "0.4")
    assert done.exit_code == 0
    assert "pitchfork  0.375082663467" in done.output
    refused = singimpact("certify", *model, "--event", "pitchfork", "clearance", "0.35", "0.4")
    assert refused.exit_code != 0
    assert "pitchfork" in refused.output
    assert "no proof covers an event of this kind" in refused.output


def test_branch(singimpact, tmp_path):
    given = ["branch", *COCO, "--over", "amplitude", "--from", "-0.6", "--to", "-0.2"]
    done = singimpact(*given, "--json", "--csv", tmp_path / "b.csv", "-o", tmp_path / "b.png")
    assert done.exit_code == 0
    (told,) = json.loads(done.output)["branches"]
    assert [event["kind"] for event in told["events"]] == ["period-doubling", "graze"]
    assert -told["events"][1]["parameter"] == pytest.approx(GRAZE, rel=1e-12)
    with (tmp_path / "b.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert {row["branch"] for row in rows} == {"1"}
    assert [float(row["amplitude"]) for row in rows] == told["points"]["parameter"]
    assert [row["visible"] == "1" for row in rows] == told["points"]["visible"]
    assert (tmp_path / "b.png").read_bytes()[1:4] == b"PNG"
    plain = singimpact(*given).output
    assert plain.startswith("branch 1: (1, 1) orbits")
    assert "graze            -0.36878177829" in plain


@pytest.mark.slow
def test_orbits_of_one_branch_are_followed_once(singimpact):
    told = json.loads(
        singimpact("branch", *TORN, "--orbit", "3", "3", "--from", "-0.2", "--to", "0.3", "--json").output
    )
    assert len(si.linear("2.8", "0.1", "0.8", amplitude=-1).periodic(3, 3)) == 2
    (branch,) = told["branches"]
    assert branch["notes"] == ["closed: the branch comes back to where it began"]
    given = ["--orbit", "3", "3", "--start", "0.6", "0.48", "--from", "-0.2", "--to", "0.3", "--json"]
    (same,) = json.loads(singimpact("branch", *TORN, *given).output)["branches"]
    assert sorted(event["parameter"] for event in same["events"]) == pytest.approx(
        sorted(event["parameter"] for event in branch["events"]), rel=1e-9
    )


@pytest.mark.slow
def test_events(singimpact, tmp_path):
    given = ["events", *RESONANT, "--over", "amplitude", "omega", "--from", "-0.3", "0.9", "--to", "-0.05", "1.1"]
    done = singimpact(*given, "--json", "--csv", tmp_path / "e.csv", "-o", tmp_path / "e.svg")
    assert done.exit_code == 0
    told = json.loads(done.output)["curves"]
    assert [curve["kind"] for curve in told] == ["fold", "graze", "period-doubling"]
    for curve in told:
        (special,) = curve["special"]
        assert special["kind"] == "resonant graze"
        assert special["parameters"][1] == pytest.approx(np.sqrt(1 - 0.05**2), rel=1e-10)
    with (tmp_path / "e.csv").open(newline="") as stream:
        rows = [row for row in csv.DictReader(stream) if row["kind"] == "graze"]
    A, w = (np.array([float(row[name]) for row in rows]) for name in ("amplitude", "omega"))
    assert pytest.approx(np.hypot(1 - w * w, 0.1 * w), rel=1e-12) == -A
    assert b"<svg" in (tmp_path / "e.svg").read_bytes()
    one = singimpact(*given, "--event", "graze", "--index", "2").output
    assert one.startswith("curve 1: graze of (1, 1) orbits")
    assert "curve 2" not in one


def test_the_graze_of_an_orbit_without_impact(singimpact):
    given = ["events", *COCO[:-1], "-0.35", "--orbit", "0", "1", "--over", "amplitude", "omega"]
    (curve,) = json.loads(singimpact(*given, "--from", "-0.6", "0.6", "--to", "-0.2", "0.95", "--json").output)[
        "curves"
    ]
    A, w = np.array(curve["points"]["parameters"]).T
    assert pytest.approx(np.hypot(1 - w * w, 0.1 * w), rel=1e-12) == -A


@pytest.mark.slow
def test_an_event_of_a_curve_is_known():
    from singimpact.cli import on_curve

    def events(damping):
        osc = si.linear(1, -1, "0.8", damping=damping, amplitude="-0.12")
        return si.branch(osc.periodic(1, 1)[0], "amplitude", (-0.3, -0.05)).events

    curve = si.event_curve(events("0.1")[0], ("amplitude", "omega"), ((-0.3, -0.05), (0.9, 1.1)), points=40)
    assert [on_curve(event, curve) for event in events("0.1")] == [True, False, False]
    assert not any(on_curve(event, curve) for event in events("0.11"))


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (["branch", *COCO, "--over", "speed"], "unknown number of the model 'speed'"),
        (["branch", *COCO, "--from", "1"], "--to is missing: give --from and --to, or neither"),
        (["branch", *COCO, "--from", "1", "--to", "2"], "an interval that holds clearance = -1"),
        (["branch", *COCO, "--from", "a", "--to", "2"], "between"),
        (["branch", *COCO, "--orbit", "4", "1"], "--orbit 4 1: the model has no such orbit"),
        (["branch", *COCO, "--orbit", "1", "0"], "k = 0 is not accepted"),
        (["branch", *COCO, "--start", "here", "1"], "start"),
        (["branch", *COCO, "-o", "a.doc"], ".png, .pdf or .svg"),
        (["branch", *COCO, "--csv", "absent/a.csv"], "cannot be written"),
        (["events", *COCO, "--event", "transcritical"], "'transcritical' is not one of"),
        (["events", *COCO, "--event", "hidden impact"], "no such event: those of the branch are"),
        (["events", *COCO, "--over", "clearance", "clearance"], "two different numbers"),
        (["events", *COCO, "--index", "40"], "no such event"),
    ],
)
def test_refusals(singimpact, given, words):
    done = singimpact(*given)
    assert done.exit_code == 2
    assert words in done.stderr
    assert done.stderr.count("\n") == 1
    assert done.stdout == ""
