"""Public functions that do what commands do: their results as objects, files and pictures, and what they refuse."""

import csv
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import singimpact as si
from singimpact.inputs import InputError
from singimpact.surface import Window

OSC = si.linear(2, "0.3", "0.5")
UNIVERSAL = si.universal(-1, "0.5")


@pytest.fixture(scope="module")
def basins():
    return si.basins(OSC, ((0, 3), (0, 1)), 6)


@pytest.fixture(scope="module")
def diagram():
    with ThreadPoolExecutor(1) as pool:
        return si.bifurcation(OSC, "clearance", ("0.2", "1.5"), 3, impacts=20, kept=4, executor=pool)


def rows(path):
    with path.open(newline="") as stream:
        return list(csv.DictReader(stream))


def test_basins_are_written_and_drawn(basins, tmp_path):
    basins.to_csv(tmp_path / "basins.csv")
    table = rows(tmp_path / "basins.csv")
    assert len(table) == 36
    names = {code: name for code, name, _ in basins.classes}
    assert [row["class"] for row in table] == [names[code] for code in basins.codes.ravel()]
    assert (float(table[7]["tau"]), float(table[7]["v"])) == (basins.tau[1], basins.v[1])
    assert [int(row["first_chatter_completes"]) for row in table] == basins.first_chatter_completes.ravel().tolist()
    assert si.plot(basins).get_xlabel() == r"launch phase $\tau$"
    assert len(repr(basins)) < 200


def test_basins_are_those_of_the_room_on_every_executor(basins):
    from singimpact.dynamics import basins as of_room

    with ThreadPoolExecutor(2) as pool:
        assert np.array_equal(of_room(OSC, (0, 3), (0, 1), 6, pool).codes, basins.codes)
    whole = si.basins(OSC, size=2)
    assert (whole.tau[0], whole.v[-1]) == (np.pi / 4, 1.5)


def test_a_bifurcation_diagram_is_written_and_drawn(diagram, tmp_path):
    diagram.to_csv(tmp_path / "diagram.csv")
    table = rows(tmp_path / "diagram.csv")
    there = np.isfinite(diagram.events[..., 0])
    assert len(table) == there.sum() < there.size  # the mass does not reach a wall at 1.5
    assert list(table[0]) == ["clearance", "phase", "v", "chatter_ended", "attractor"]
    assert float(table[0]["v"]) == diagram.events[0, 0, 1]
    assert {float(row["clearance"]) for row in table} <= set(diagram.values.tolist())
    assert si.plot(diagram).get_xlabel() == "clearance $c$"
    assert repr(diagram) == "Bifurcation(over clearance: 3 values from 0.2 to 1.5, 4 events of each)"


@pytest.mark.plain_code
def test_results_are_kept_in_a_store(tmp_path):
    pytest.importorskip("zarr", reason="needs zarr, of the extra `cluster`")
    found = [si.basins(OSC, ((0, 3), (0, 1)), 4, output=tmp_path / "basins.zarr") for _ in range(2)]
    assert np.array_equal(found[0].codes, found[1].codes)


def test_classify_and_transitions():
    assert repr(si.classify(UNIVERSAL)).startswith("Classification(cusp 4, tangency 2; fold lines ")
    found = si.classify(UNIVERSAL, ((-2, 2), (-1, 1)))
    assert (found.tau, found.t) == ((-2.0, 2.0), (-1.0, 1.0))
    swans = si.classify(OSC, ((0, 1), (-1, 1)), between=("0.5", "1.5")).swans
    assert [swan.clearance for swan in swans] == [1.0]
    moved = si.transitions(OSC, between=("0.9", "1.1"), t=(-1, 1))
    assert [each.kind for each in moved] == ["swan, negative"]
    assert moved.complete


def test_gamma_is_grown_in_windows_of_both_kinds():
    pair = si.grown_gamma(UNIVERSAL, ((-3, 0), (0, 20)))
    window = si.grown_gamma(UNIVERSAL, Window((-3, 0), (0, 20)))
    assert [each.points.tolist() for each in pair] == [each.points.tolist() for each in window]
    assert len(repr(pair[0])) < 120
    usual = si.grown_gamma(OSC)[0].points
    assert abs(usual[0, 0] - si.tangency_points(OSC).tau[1]) < 1e-9
    axes = si.plot(pair)
    assert axes.get_ylabel() == "velocity $v$"
    assert len(axes.get_legend().get_texts()) == 1


def test_the_surface_is_drawn():
    surface = si.ImpactSurface(UNIVERSAL, (-4, 4), (-6, 6))
    assert repr(surface) == "ImpactSurface(tau from -4 to 4, t from -6 to 6, clearance 0)"
    assert si.plot(surface).get_ylabel() == "flight time $t$"
    with pytest.raises(InputError, match="curves of one plane"):
        si.plot([*surface.zero_set, *si.grown_gamma(UNIVERSAL, ((-3, 0), (0, 20)))])


def test_the_page_is_saved(tmp_path):
    page = si.explore(UNIVERSAL, points=2)
    page.save(tmp_path / "page.html")
    assert (tmp_path / "page.html").read_text() == page.html
    assert "srcdoc" in page._repr_html_()
    assert len(repr(page)) < 100


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: si.basins(UNIVERSAL), "one with a period"),
        (lambda: si.basins(OSC, (0, 1)), r"window of tau = 0 is not accepted: give two numbers"),
        (lambda: si.basins(OSC, 3), r"window = 3 is not accepted: give \(\(tau_low, tau_high\), \(v_low, v_high\)\)"),
        (lambda: si.basins(OSC, size=1), "size = 1 is not accepted: give a whole number from 2 to 10000"),
        (lambda: si.basins("x"), "is not accepted: give an ImpactOscillator"),
        (lambda: si.bifurcation(OSC, "mass", (0, 1)), "unknown number of the model 'mass'"),
        (lambda: si.bifurcation("x", "mass", (0, 1)), "give an ImpactOscillator"),
        (lambda: si.bifurcation(OSC, "clearance", (0, 1), 2, exekutor=1), "nearest known are executor"),
        (lambda: si.classify("x"), "give an ImpactOscillator"),
        (lambda: si.classify(OSC, ((0, 1),)), r"give \(\(tau_low, tau_high\), \(t_low, t_high\)\)"),
        (lambda: si.transitions(OSC), "window of clearance = None is not accepted"),
        (lambda: si.transitions("x", between=(0, 1)), "osc = 'x' is not accepted: give an ImpactOscillator"),
        (lambda: si.grown_gamma("x"), "osc = 'x' is not accepted: give an ImpactOscillator"),
        (lambda: si.explore("x"), "osc = 'x' is not accepted: give an ImpactOscillator"),
        (lambda: si.explore(OSC, points=1), "points = 1 is not accepted: give a whole number from 2 to 1001"),
        (lambda: si.plot(3), "thing to plot = 'int' is not accepted: give an orbit"),
    ],
)
def test_what_cannot_be_used_ends_in_one_sentence(call, message):
    with pytest.raises(InputError, match=message):
        call()
