"""Certificate files of models with two walls: the second program knows both, and refuses what is written otherwise."""

import copy

import pytest
from second_program import renewed

import singimpact as si
from singimpact.certificates import Certificate
from singimpact.inputs import InputError

UNEVEN = si.linear("1.7", "-0.3", "0.6", damping="0.1", upper=("0.35", "0.5"))
DAMPED = si.ImpactOscillator("x + xdot/10", "A*cos(1.7*t)", "-0.3", "0.6", {"A": 1}, upper="0.3")


def refused(content):
    """The reason for which a changed file is refused, its digest written anew."""
    with pytest.raises(InputError, match="the certificate is refused") as caught:
        Certificate(renewed(content)).check()
    return str(caught.value)


@pytest.mark.parametrize("wall", ["lower", "upper"])
@pytest.mark.parametrize("state", [("0.3", "1.2"), ("1.9", "0.1"), ("2.5", "0.4")])
def test_first_impacts_from_either_wall_are_accepted(wall, state):
    step = UNEVEN.impact_map(*state, digits=18, wall=wall)
    certificate = si.certify(step)
    certificate.check()
    assert f"at the {wall} wall" in repr(certificate)
    assert certificate.content["launch"]["wall"] == wall
    assert certificate.content["velocity"]["value"].startswith("-") == (step.velocity < 0)


def test_a_launch_from_another_wall_and_a_wall_elsewhere_are_refused():
    content = si.certify(UNEVEN.impact_map("0.3", "1.2", digits=18)).content
    assert content["model"]["upper"] == "0.35"
    model, launch = content["model"], content["launch"]
    one_wall = {key: part for key, part in model.items() if key != "upper"}
    for other in (model | {"upper": "0.351"}, model | {"upper_restitution": "0.51"}, one_wall):
        refused(copy.deepcopy(content) | {"model": other})
    refused(copy.deepcopy(content) | {"launch": launch | {"wall": "upper"}})
    refused(copy.deepcopy(content) | {"model": {**model, "upper": "-1"}})


def test_orbits_and_events_by_word_are_accepted_and_of_another_word_refused():
    (orbit,) = DAMPED.periodic("lul", 1)
    certificate = si.certify(orbit.certified(15))
    certificate.check()
    assert f"the ({orbit.impacts}, 1) periodic orbit" in repr(certificate)
    for i in range(3):
        changed = copy.deepcopy(certificate.content)
        changed["states"][i]["wall"] = {"lower": "upper", "upper": "lower"}[changed["states"][i]["wall"]]
        refused(changed)
    missing = copy.deepcopy(certificate.content)
    del missing["states"][0]["wall"]
    assert "has no 'wall'" in refused(missing)
    events = {event.kind: event for event in si.branch(orbit, "A", (0.6, 1.5)).events}
    doubling = si.certify(events["period-doubling"].certified(12))
    doubling.check()
    away = copy.deepcopy(doubling.content)
    away["parameter"]["value"] = "0.98"
    refused(away)
    with pytest.raises(InputError, match="without a graze"):
        si.certify(events["graze"].certified(12))


def test_what_the_second_program_does_not_check_says_so():
    limit = UNEVEN.chatter_limit("1.9", "0.1", digits=15)
    with pytest.raises(InputError, match="the chatter limit is not certified"):
        si.certify(limit)
