"""Large arrays in blocks: the same results as in one piece, in arrays of the caller's own, with room to spare."""

from __future__ import annotations

import numpy as np
import pytest

from singimpact.flights import blocks
from singimpact.impact_oscillator import ImpactOscillator, linear
from singimpact.inputs import InputError

LINEAR = linear("2.8", 0, "0.8")
DUFFING = ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", 0.3, "0.6")


@pytest.fixture
def small_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(blocks, "BLOCKS", blocks.BlockSettings(states=64, whole=100))


def states(count: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(5)
    v = rng.uniform(0, 1, count)
    v[::50] = 0  # some at rest
    return rng.uniform(-50, 50, count), v


def same(found: np.ndarray, expected: np.ndarray) -> None:
    """Up to the roundings in which interpreted and compiled flights differ: compiled code may arrive in between."""
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("osc", [LINEAR, DUFFING], ids=["linear", "Duffing"])
def test_the_same_numbers_as_in_one_piece(osc: ImpactOscillator, monkeypatch: pytest.MonkeyPatch) -> None:
    tau, v = states(400)
    calls = [lambda: osc.impact_map(tau, v), lambda: osc.first_hit(tau, v), lambda: osc.inverse_map(tau, v)]
    whole = [call().values() for call in calls]
    records = [vars(osc.derivative(tau, v)), vars(osc.iterate(tau, v, 3))]
    monkeypatch.setattr(blocks, "BLOCKS", blocks.BlockSettings(states=64, whole=100))
    for before, call in zip(whole, calls, strict=True):
        after = call().values()
        for name, values in before.items():
            if name not in ("notes", "certified", "wall"):
                same(after[name], values)
        assert after["notes"] == before["notes"]
    for before, after in zip(records, (osc.derivative(tau, v), osc.iterate(tau, v, 3)), strict=True):
        for name, values in before.items():
            if name != "wall":  # None where there is one
                same(vars(after)[name], values)


@pytest.mark.usefixtures("small_blocks")
def test_shapes_broadcast() -> None:
    tau, v = states(30)
    grid = LINEAR.impact_map(tau[:, None], v)
    assert grid.tau.shape == grid.depth.shape == (30, 30)
    alone = LINEAR.impact_map(np.full(30, tau[3]), v)
    np.testing.assert_allclose(grid.v[3], alone.v, rtol=1e-13, atol=1e-13)  # 30 states fly one by one, 900 abreast
    line = LINEAR.impact_map("0.3", np.repeat(v, 10))
    assert line.status.shape == (300,)
    with pytest.raises(InputError, match="broadcast"):
        LINEAR.impact_map(np.zeros(1000), np.ones(2000))


@pytest.mark.slow
@pytest.mark.usefixtures("small_blocks")
def test_depth_of_the_few_that_have_one() -> None:
    # every hundredth flight touches with no velocity: a swan seen from its own launch
    swan = linear(2, -1, "1/2")
    tau, v = np.full(300, 0.3), np.full(300, 0.5)
    grazing = swan.impact_map("pi/2", 0)
    assert grazing.status == 1
    tau[::100], v[::100] = np.pi / 2, 0
    found = swan.impact_map(tau, v)
    touched = found.status == 1
    assert touched.tolist() == [index % 100 == 0 for index in range(300)]
    assert np.isnan(found.depth[~touched]).all()
    assert np.isnan(found.bound[~touched]).all()


@pytest.mark.usefixtures("small_blocks")
def test_memory_maps_take_the_results(tmp_path) -> None:
    tau, v = states(300)
    kept = np.lib.format.open_memmap(tmp_path / "tau.npy", "w+", "f8", (300,))
    speeds = np.zeros((300, 2))[:, 0]  # not contiguous
    found = LINEAR.impact_map(tau, v, out={"tau": kept, "v": speeds})
    assert found.tau is kept
    np.testing.assert_array_equal(np.load(tmp_path / "tau.npy"), LINEAR.impact_map(tau, v).tau)
    np.testing.assert_array_equal(speeds, LINEAR.impact_map(tau, v).v)
    assert found.status.shape == (300,)
    with pytest.raises(AttributeError, match="condition was not kept"):
        found.condition  # noqa: B018


@pytest.mark.parametrize(
    ("out", "words"),
    [
        ({"speed": np.zeros(3)}, "'speed': give arrays for"),
        ({"tau": np.zeros(4)}, r"out\['tau'\] has shape \(4,\)"),
        ({"tau": np.zeros(3, np.float32)}, "float32"),
        ({"tau": [0.0] * 3}, "out.'tau'. has shape None and type list"),
    ],
)
def test_arrays_that_do_not_fit(out: dict, words: str) -> None:
    with pytest.raises(InputError, match=words):
        LINEAR.impact_map([0.1, 0.2, 0.3], 1.0, out=out)


def test_digits_take_no_arrays_of_doubles() -> None:
    with pytest.raises(InputError, match="out= takes doubles"):
        LINEAR.impact_map(0.1, 1.0, digits=20, out={"tau": np.zeros(())})
