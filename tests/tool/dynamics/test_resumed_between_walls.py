"""Interrupted studies of models with two walls go on where they were; pools and threads give the same bits."""

from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pkgutil import resolve_name

import numpy as np
import pytest

import singimpact as si

PAIR = si.linear("2.8", "-0.5", "0.8", damping="0.05", amplitude=4, upper="0.5")
DUFFING = si.ImpactOscillator("x + x**3 + 0.1*xdot", "5*cos(1.7*t)", "-0.5", "0.7", upper="0.5")


def interrupted(monkeypatch, path, method, calls):
    """Ctrl-C in one of the first calls of a method."""
    kind, done = resolve_name(path), []
    true = getattr(kind, method)

    def counted(self):
        done.append(self)
        if len(done) == calls:
            raise KeyboardInterrupt
        return true(self)

    monkeypatch.setattr(kind, method, counted)


KINDS = {
    "t in f": si.ImpactOscillator("(1 + 0.3*cos(2*t))*x + 0.1*xdot + 0.2*x**3", "cos(t)", "0.2", "0.8"),
    "no clock": si.ImpactOscillator("x - (1 - x**2)*xdot", "0", "-1.5", "0.8"),
    "no period": si.ImpactOscillator("x + 0.1*xdot", "cos(2*t) + cos(sqrt(2)*t)/2", "0.1", "0.7"),
    "restitution 0": si.linear("2.8", "0.1", 0),
}


def stopped(study, monkeypatch, file, path, calls):
    """A study that is interrupted in one of its first cases, and keeps the others in a file."""
    with ThreadPoolExecutor(1) as pool:
        interrupted(monkeypatch, f"singimpact.dynamics.{path}", "settle", calls)
        with pytest.raises(KeyboardInterrupt):
            study(executor=pool, output=file)
        monkeypatch.undo()


@pytest.mark.parametrize("wall", ["lower", "upper"])
def test_basins_that_were_interrupted_go_on(wall, monkeypatch, tmp_path):
    study = partial(si.basins, PAIR, size=40, wall=wall)
    whole = study()
    stopped(study, monkeypatch, tmp_path / "kept.npz", "settling:_Run", 2)
    with ThreadPoolExecutor(4) as pool:
        for found in (study(executor=pool, output=tmp_path / "kept.npz"), study(output=tmp_path / "kept.npz")):
            assert np.array_equal(found.codes, whole.codes)
            assert [run.tau.tolist() for run in found.attractors] == [run.tau.tolist() for run in whole.attractors]


@pytest.mark.parametrize("kind", KINDS)
def test_studies_of_every_kind_of_model_go_on(kind, monkeypatch, tmp_path):
    study = partial(si.basins, KINDS[kind], size=8 if kind == "no period" else 12, impacts=500)
    whole, path = study(), "synchrony:Responses" if kind == "no period" else "settling:_Run"
    stopped(study, monkeypatch, tmp_path / "kept.npz", path, 1 if kind.startswith("no") else 2)
    found = study(output=tmp_path / "kept.npz")
    assert np.array_equal(found.codes, whole.codes)
    assert [run.name for run in found.attractors] == [run.name for run in whole.attractors]
    over = partial(si.bifurcation, KINDS[kind], "clearance", (0.1, 0.15), 2, impacts=60, kept=20, settle=250)
    again = [over(output=tmp_path / "over.npz") for _ in range(2)]
    for diagram in again:
        assert np.array_equal(over().events, diagram.events, equal_nan=True)


def test_states_of_another_wall_are_not_taken_up(tmp_path):
    si.basins(PAIR, size=4, output=tmp_path / "kept.npz")
    with pytest.raises(si.InputError, match="other cases"):
        si.basins(PAIR, size=4, wall="upper", output=tmp_path / "kept.npz")


@pytest.mark.parametrize("over", ["upper", "upper_restitution"])
def test_diagrams_that_were_interrupted_go_on(over, monkeypatch, tmp_path):
    study = partial(si.bifurcation, PAIR, over, ("0.5", "0.8"), 6)
    whole = study()
    with ThreadPoolExecutor(1) as pool:
        interrupted(monkeypatch, "singimpact.dynamics.orbit:_Run", "orbit", 4)
        with pytest.raises(KeyboardInterrupt):
            study(executor=pool, output=tmp_path / "kept.npz")
        monkeypatch.undo()
        found = study(executor=pool, output=tmp_path / "kept.npz")
    assert np.array_equal(found.events, whole.events, equal_nan=True)
    assert [run.name for run in found.attractors] == [run.name for run in whole.attractors]


def ends(osc, stop, case):
    """The state after 50 impacts between walls of one place and restitution."""
    if stop is not None and case[0] > 0.55 and not stop.exists():
        stop.touch()
        raise KeyboardInterrupt
    moved = osc.replace(upper=case[0], upper_restitution=case[1])
    state = moved.iterate([0.1, 0.2], [0.5, 1.0], 50, wall=["lower", "upper"])
    return np.stack([state.tau, state.v, state.wall])


@pytest.mark.parametrize("osc", [PAIR, DUFFING], ids=["linear", "Duffing"])
def test_sweeps_over_the_upper_wall_go_on(osc, tmp_path):
    cases = [(float(upper), r) for upper in np.linspace(0.4, 0.6, 4) for r in (0.5, 0.9)]
    work = partial(ends, osc, tmp_path / "stopped")
    with ThreadPoolExecutor(1) as pool:
        with pytest.raises(KeyboardInterrupt):
            si.sweep(work, cases, pool, tmp_path / "kept.npz")
        assert len(np.load(tmp_path / "kept.npz")["index"])
        found = si.sweep(work, cases, pool, tmp_path / "kept.npz")
    whole = np.array([ends(osc, None, case) for case in cases])
    assert np.array_equal(found, whole)
    assert len({row.tobytes() for row in whole}) == len(cases)


def test_a_sweep_through_the_lower_wall_names_the_case():
    with pytest.raises(Exception, match=r"upper = -0\.6 is not accepted: give a number above the clearance"):
        si.sweep(partial(ends, PAIR, None), [(0.4, 0.5), (-0.6, 0.5)], ThreadPoolExecutor(1))
    with pytest.raises(si.InputError, match="a number above the clearance"):
        si.bifurcation(PAIR, "upper", ("-0.6", "0.6"), 3)
