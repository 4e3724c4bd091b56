"""Basins over a number of the model: shares against single orbits, attractors that are followed, files and pictures."""

import json
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import singimpact as si
from singimpact.dynamics import LongRun, matched
from singimpact.inputs import InputError

MODEL = si.linear("2.8", "0.1", "0.8", amplitude=-1)
WINDOW = ((0, "2*pi/2.8"), (0, "0.8"))


@pytest.fixture(scope="module")
def found():
    return MODEL.basins(WINDOW, over="clearance", between=("0.09", "0.15"), values=7, states=120, seed=3)


def test_shares_are_those_of_single_orbits(found):
    """Where two orbits attract, each state of the sample is flown by `orbit`, and its last impacts are counted."""
    across, up = np.random.default_rng(3).random((2, 120))
    period = 2 * np.pi / 2.8
    for row in (0, 3):
        osc = MODEL.replace(clearance=float(found.values[row]))
        for at in range(0, 120, 6):
            orbit = osc.orbit(across[at] * period, 0.8 * up[at], impacts=600)
            run = found.attractors[found.codes[row, at]]
            assert abs(orbit.tau[-1] - orbit.tau[-1 - int(run.n)] - run.k * period) < 1e-6
            assert (
                np.abs(np.subtract.outer(run.v, orbit.v[-int(run.n) :])).min() < 0.15
            )  # `run` is as at its last value


def test_attractors_keep_their_labels_and_shares_their_errors(found):
    assert {run.name for run in found.attractors} == {"(1, 1) orbit", "(3, 3) orbit"}
    assert np.allclose(found.share.sum(axis=1), 1)
    assert found.share[0].min() > 0.2  # both at c = 0.09, one from 0.13 on
    assert (found.share[-2:, [run.n for run in found.attractors].index(1)] == 1).all()
    assert not found.undecided.any()
    n, p = 120, (120 * found.share + 1) / 122
    assert np.allclose(found.error, np.sqrt(p * (1 - p) / (n + 3)))
    assert found.error.min() > 0


def test_errors_are_the_spread_of_samples():
    shares = [
        MODEL.basins(WINDOW, over="clearance", between=("0.1", "0.11"), values=2, states=100, seed=seed)
        for seed in range(24)
    ]
    first = np.array([each.share[0, [run.n for run in each.attractors].index(1)] for each in shares])
    assert 0.6 < first.std(ddof=1) / shares[0].error[0, 0] < 1.5


def test_a_jump_makes_a_new_label(found):
    small = MODEL.basins(WINDOW, over="clearance", between=("0.09", "0.15"), values=7, states=120, seed=3, jump=1e-3)
    assert len(small.attractors) > len(found.attractors)


def orbit_at(n, v, tau=0.1):
    return LongRun("orbit", n, 1, np.full(n, tau), np.full(n, v))


def test_the_nearest_of_one_class_are_one():
    first, second = [orbit_at(1, 1.0), orbit_at(1, 1.2)], [orbit_at(1, 1.23), orbit_at(1, 1.04), orbit_at(2, 1.0)]
    runs, labels = matched([first, second, [orbit_at(1, 1.02)]], [1.0] * 3, 1.0, 0.15)
    assert labels == [[0, 1], [1, 0, 2], [0]]
    assert [run.v[0] for run in runs] == [1.02, 1.23, 1.0]


def test_phases_are_those_of_each_period_and_walls_are_two():
    near = [[orbit_at(1, 1.0, 0.99)], [orbit_at(1, 1.0, 0.01)], [orbit_at(1, -1.0, 0.01)]]
    assert matched(near, [1.0, 1.0, 1.0], 1.0)[1] == [[0], [0], [1]]
    assert matched([[orbit_at(1, 1.0, 0.5)], [orbit_at(1, 1.0, 1.0)]], [1.0, 2.0], 1.0)[1] == [[0], [0]]


def test_a_period_that_moves():
    found = si.basins(si.linear("2", 0, "0.5"), over="omega", between=("1.9", "2.1"), values=4, states=20)
    assert [run.name for run in found.attractors] == ["(1, 1) orbit"]
    assert (found.share == 1).all()


def test_models_without_a_clock_and_with_two_walls():
    free = si.ImpactOscillator("x - (1 - x**2)*xdot", "0", "-2.1", "0.8")
    found = si.basins(free, over="clearance", between=("-2.2", "-2.1"), values=2, states=12)
    assert [run.kind for run in found.attractors] == ["orbit"]
    pair = si.ImpactOscillator("x", "cos(2*t)", "-0.6", "0.6", upper="0.6", upper_restitution="0.6")
    both = si.basins(pair, wall="upper", over="upper", between=("0.6", "0.62"), values=2, states=12)
    assert np.allclose(both.share.sum(axis=1), 1)


def test_a_second_run_goes_on_from_its_file(found, tmp_path):
    given = {"over": "clearance", "between": ("0.09", "0.15"), "values": 7, "states": 120, "seed": 3}
    with ThreadPoolExecutor(1) as pool:
        first = MODEL.basins(WINDOW, **given, executor=pool, output=tmp_path / "kept.npz")
    again = MODEL.basins(WINDOW, **given, output=tmp_path / "kept.npz")
    assert (first.codes == found.codes).all()
    assert (again.codes == found.codes).all()


def test_its_ways_out(found, tmp_path):
    assert repr(found).startswith("BasinsOver(clearance: 7 values from 0.09 to 0.15, 120 states of each: (1, 1) orbit")
    found.to_csv(tmp_path / "shares.csv")
    head, names, *rows = (tmp_path / "shares.csv").read_text().splitlines()
    assert si.ImpactOscillator(**json.loads(head[2:])) == MODEL
    assert names == "values,attractor,share,error,undecided"
    assert len(rows) == 14
    assert found.arrays()["share"][0] == ("values", "attractor")


def test_its_picture(found):
    axes = si.plot(found)
    assert axes.get_xlabel() == "clearance $c$"
    assert [text.get_text() for text in axes.get_legend().get_texts()] == [name for _, name, _ in found.classes]
    (bars,) = [line for line in axes.collections if line.get_gid() == "standard error"] or axes.containers
    assert bars is not None


def test_what_is_refused():
    for given, words in [
        ({"over": "mass", "between": (0, 1)}, "mass"),
        ({"over": "clearance"}, "clearance"),
        ({"between": (0, 1)}, "number of the model"),
        ({"over": "clearance", "between": (0, 1), "points": 3}, "points"),
        ({"over": "clearance", "between": (0, 1), "states": 0}, "states"),
        ({"over": "clearance", "between": (0, 1), "values": 1}, "values"),
    ]:
        with pytest.raises(InputError, match=words):
            MODEL.basins(WINDOW, **given)
