"""classify: a table for people, JSON for programs, a line for a mistake."""

import json

import pytest

LINEAR = ["--omega", "2", "--clearance", "0.3", "--restitution", "1/2"]


def test_tables(singimpact):
    done = singimpact("classify", *LINEAR, "--window-tau", "0", "pi", "--window-t", "-1", "1")
    assert done.exit_code == 0
    assert "tangency  p, phi  gamma      2.5085408172" in done.output
    assert "negative" in done.output


def test_transitions_over_the_clearance(singimpact):
    given = ["--window-t", "-2", "2", "--over", "clearance", "--between", "0.9", "1.1"]
    told = json.loads(singimpact("classify", *LINEAR, *given, "--json").output)
    assert [round(each["clearance"], 12) for each in told["swans"]] == [1.0]
    (swan,) = told["transitions"]["found"]
    assert (swan["kind"], told["transitions"]["over"]) == ("swan, negative", "clearance")
    assert abs(swan["value"] - 1) < 1e-10
    assert (swan["event"], swan["rests"], swan["visible"], swan["launch"]) == ("swan", [swan["tau"]], True, None)


def test_orbits_between_transitions(singimpact):
    model = ["--omega", "2.8", "--clearance", "0.9", "--restitution", "1/2", "--window-t", "-1", "1"]
    given = [*model, "--over", "clearance", "--between", "0.8", "1.2", "--orbits", "1"]
    done = singimpact("classify", *given)
    assert "(inf, 1) chatter\nswan, negative at clearance = 1, tau = 0, t = 0\nfrom 1 to 1.2: none of" in done.output
    told = json.loads(singimpact("classify", *given, "--json").output)["transitions"]["intervals"]
    assert [[orbit["kind"] for orbit in each["orbits_in_the_middle"]] for each in told] == [["chatter"], []]


def test_a_window_without_a_curve(singimpact):
    done = singimpact(
        "classify", "--omega", "2", "--clearance", "1.5", "--restitution", "1/2", "--window-t", "-0.1", "0.1"
    )
    assert done.exit_code == 0
    assert "fold lines:\nnone" in done.output


@pytest.mark.parametrize(
    ("given", "told"),
    [
        (["--over", "clearance"], "--between"),
        (["--orbits", "1"], "--over NAME --between"),
        (["--over", "mass", "--between", "0", "1"], "mass"),
        (["--over", "clearance", "--between", "1", "0"], "between"),
        (["--window-tau", "1", "0"], "window of tau"),
        (["--window-t", "1", "word"], "word"),
    ],
)
def test_refusals(singimpact, given, told):
    refused = singimpact("classify", *LINEAR, *given)
    assert (refused.exit_code, refused.stderr.count("\n")) == (2, 1)
    assert told in refused.stderr
