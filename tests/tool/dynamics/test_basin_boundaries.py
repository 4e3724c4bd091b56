"""The uncertainty exponent and basin entropies: boundaries whose exponents are known, grids that are summed by hand."""

import numpy as np
import pytest

import singimpact as si
from singimpact.dynamics import entropy_of, uncertainty_of
from singimpact.inputs import InputError

MODEL = si.linear("2.8", "0.1", "0.8", amplitude=-1)


@pytest.fixture(scope="module")
def basins():
    return MODEL.basins(((0, "2*pi/2.8"), (0, "0.8")), 120)


def counted(codes_of, distances, count, rng):
    """Pairs of points of [0, 1], so far apart, with different codes."""
    counts = []
    for distance in distances:
        first = rng.random(count) * (1 - distance)
        counts.append(int((codes_of(first) != codes_of(first + distance)).sum()))
    return uncertainty_of(np.array(distances), np.full(len(distances), count), np.array(counts))


def test_a_smooth_boundary_has_the_exponent_1():
    found = counted(lambda x: x > 0.4, 2.0 ** -np.arange(4, 10), 20_000, np.random.default_rng(0))
    assert abs(found.exponent - 1) < 3 * found.error < 0.2


def gap_of_cantor(x):
    """The parity of the number of thirds after which a point lies in a middle one; its boundary is Cantor's set."""
    level, left = np.zeros(x.shape, int), np.ones(x.shape, bool)
    for n in range(30):
        digit = np.floor(3 * x)
        left &= digit != 1
        level[left] = n + 1
        x = 3 * x - digit
    return level % 2


def test_cantors_set_has_the_exponent_of_its_dimension():
    found = counted(gap_of_cantor, 3.0 ** -np.arange(5, 12), 40_000, np.random.default_rng(1))
    known = 1 - np.log(2) / np.log(3)
    assert abs(found.exponent - known) < 3 * found.error
    assert found.error < 0.05


def test_errors_are_the_spread_of_exponents():
    several = [
        counted(lambda x: x > 0.4, 2.0 ** -np.arange(4, 9), 2000, np.random.default_rng(seed)) for seed in range(40)
    ]
    spread = np.std([found.exponent for found in several], ddof=1)
    assert 0.6 < spread / np.mean([found.error for found in several]) < 1.4


def test_what_is_not_decided_says_so():
    sizes, pairs = np.array([0.01, 0.02, 0.04]), np.full(3, 100)
    for counts in ([0, 0, 0], [3, 6, 12], [100, 100, 100]):
        found = uncertainty_of(sizes, pairs, np.array(counts))
        assert np.isnan(found.exponent)
        assert "give more pairs or other distances" in found.doubt
        assert found.doubt in repr(found)
    assert np.isfinite(uncertainty_of(sizes, np.array([100, 100, 0]), np.array([5, 10, 0])).error) is np.False_


def test_the_entropy_of_grids_that_are_summed_by_hand():
    halves = np.array([[0, 1], [0, 1]])
    assert entropy_of(halves, np.ones(2, bool), 2) == (np.log(2), np.log(2), 1, 1)
    thirds = np.array([[0, 0, 3, 3], [1, 2, 3, 3]])  # 1/2, 1/4, 1/4; and a box of one attractor
    mean = 1.5 * np.log(2)
    assert np.allclose(entropy_of(thirds, np.ones(4, bool), 2), (mean / 2, mean, 2, 1))
    decided = np.array([True, True, True, False])
    assert np.allclose(entropy_of(thirds, decided, 2), (mean, mean, 1, 1))  # boxes of undecided states do not count
    assert np.allclose(entropy_of(np.array([[0, 1], [3, 3]]), decided, 2), (np.log(2), np.log(2), 1, 1))
    alone = entropy_of(np.zeros((5, 5), int), np.ones(1, bool), 2)
    assert (alone.entropy, alone.boxes, alone.mixed) == (0, 4, 0)
    assert np.isnan(alone.boundary)


def test_pairs_of_a_model_agree_with_neighbours_of_its_grid(basins):
    found = basins.uncertainty(pairs=1000)
    assert 0.8 < found.exponent < 1.05
    assert found.error < 0.1
    assert (found.pairs == 1000).all()
    neighbours = 2 * basins.codes.size - sum(basins.codes.shape)
    share = np.interp(np.log(1 / 119), np.log(found.distances), found.uncertain / found.pairs)
    assert 0.6 < len(basins.boundary) / neighbours / share < 1.6
    assert basins.uncertainty(pairs=1000, seed=1).uncertain.tolist() != found.uncertain.tolist()


def test_the_entropy_of_a_model(basins):
    entropy, boundary, boxes, mixed = basins.entropy(10)
    assert (boxes, len(basins.attractors)) == (144, 2)
    assert 0 < entropy < boundary < np.log(2)  # two attractors
    assert np.isclose(entropy * boxes, boundary * mixed)


def test_a_model_without_t_and_the_states_of_an_upper_wall():
    free = si.ImpactOscillator("x - (1 - x**2)*xdot", "0", "-2.1", "0.8").basins(size=4)
    assert free.uncertainty(pairs=5).pairs.tolist() == [5] * 7
    pair = si.ImpactOscillator("x", "cos(2*t)", "-0.6", "0.6", upper="0.6", upper_restitution="0.6")
    assert pair.basins(size=6, wall="upper").uncertainty(pairs=5).pairs.max() <= 5


def test_what_is_refused(basins):
    for given, words in [({"distances": [0.1, 0.2]}, "distances"), ({"distances": [0.1, 0.2, 1.5]}, "distances"),
                         ({"pairs": 0}, "pairs")]:  # fmt: skip
        with pytest.raises(InputError, match=words):
            basins.uncertainty(**given)
    with pytest.raises(InputError, match="box"):
        basins.entropy(0)
