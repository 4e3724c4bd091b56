"""Every result has one way out: what it is as a dictionary, from which JSON, tables, files and frames are made."""

import json
import pickle
from functools import cache

import numpy as np
import pytest

import singimpact as si
from singimpact.inputs import InputError
from singimpact.result import Result, as_json

OSC = si.linear("2.8", "0.1", "0.8")
SWEEP = ("clearance", ("0.1", "0.2"))


def ball():
    return si.ImpactOscillator("0", "-2", 0, "1/2")


@cache
def followed():
    model = si.ImpactOscillator("x + 0.1*xdot", "-A*cos(w*t)", -1, "0.8", {"A": "0.45", "w": "0.8"})
    return si.branch(model.periodic(1, 1)[0], "A", (0.3, 0.5))


CALLS = {
    "first_hit": lambda: OSC.first_hit(0.9, 0.5),
    "impact_map": lambda: OSC.impact_map([0.9, 1, 2], 0.5),
    "impact_map, undecided": lambda: ball().impact_map([0, 1], [0.0, 1.0]),
    "impact_map, digits": lambda: OSC.impact_map(["0.9", "1"], "0.5", digits=20),
    "enclosed_impact": lambda: OSC.enclosed_impact("0.9", "0.5", radii={"tau": "1e-9"}, digits=15),
    "flight": lambda: OSC.flight(0.9, 0.5, [0, 0.1, 0.2]),
    "iterate": lambda: OSC.iterate([0.9, 1, 2], 0.5, impacts=4),
    "iterate, kept": lambda: OSC.iterate([0.9, 1, 2], 0.5, impacts=4, keep=True),
    "derivative": lambda: OSC.derivative([0.9, 1], 0.5),
    "inverse_map": lambda: OSC.inverse_map([0.9], 0.5),
    "chatter_limit": lambda: OSC.chatter_limit([0.9, 0.91], 0.005),
    "chatter_limit, digits": lambda: OSC.chatter_limit("0.9", "0.005", digits=20),
    "orbit": lambda: OSC.orbit(0.9, 0.5, impacts=30),
    "section": lambda: OSC.orbit(0.9, 0.5, impacts=30).section(0),
    "sample": lambda: OSC.orbit(0.9, 0.5, impacts=30).sample([1.0, 2.0]),
    "launch": lambda: OSC.launch(2, [0.1, 0.2], 0),
    "tangency_points": lambda: si.tangency_points(OSC),
    "contact_points": lambda: si.contact_points(OSC, 2, "clearance", (-2, 2)),
    "swan_points": lambda: si.swan_points("x", "cos(2*t)", {}),
    "threshold": lambda: si.threshold(OSC, "pi/2.8"),
    "lyapunov": lambda: si.lyapunov(OSC, 0.9, 0.5, impacts=200),
    "basins": lambda: si.basins(OSC, size=4, impacts=300),
    "bifurcation": lambda: si.bifurcation(OSC, *SWEEP, 3, impacts=60, kept=6),
    "classify": lambda: si.classify(OSC),
    "transitions": lambda: si.transitions(si.linear(2, 0, "1/2"), "clearance", ("0.2", "0.6")),
    "periodic": lambda: OSC.periodic(1, 1),
    "an orbit": lambda: OSC.periodic(1, 1)[0],
    "branch": lambda: followed(),
    "an event": lambda: followed().events[0],
    "event_curve": lambda: si.event_curve(followed().events[0], ("A", "w"), ((0.3, 0.5), (0.75, 0.85)), points=6),
    "manifold": lambda: si.manifold(si.linear("2.8", 0, "0.8").periodic(1, 1)[0], length=1),
    "border_orbits": lambda: si.border_orbits(si.linear("2.8", 0, "1/2"), between=("0.6", "0.61"), points=10),
    "homoclinic_points": lambda: si.homoclinic_points(si.linear("2.8", 0, "0.8").periodic(1, 1)[0], length=3),
    "enclosed event": lambda: followed().events[0].certified(15),
    "enclosed orbit": lambda: OSC.periodic(1, 1)[0].certified(15),
    "fixed_points": lambda: si.fixed_points.tangency("1/2", digits=20),
}


@pytest.fixture(scope="module", params=CALLS)
def result(request):
    return CALLS[request.param]()


def same(one, other):
    return json.dumps(as_json(one), sort_keys=True) == json.dumps(as_json(other), sort_keys=True)


def test_as_dict_is_json_and_survives_a_pickle(result):
    assert isinstance(result, Result)
    values = result.as_dict()
    assert values
    assert all(isinstance(name, str) for name in values)
    json.dumps(as_json(values), allow_nan=False)
    assert same(pickle.loads(pickle.dumps(result)).as_dict(), values)


def test_statuses_are_words(result):
    status = result.as_dict().get("status")
    words = [] if status is None else np.ravel(status).tolist()
    assert set(words) <= {status.name for status in si.Status}


def test_files_and_frames_hold_the_table(result, tmp_path):
    table = result.table()
    rows = len(next(iter(table.values())))
    assert {len(column) for column in table.values()} == {rows}

    result.to_csv(tmp_path / "a.csv")
    lines = (tmp_path / "a.csv").read_text().splitlines()
    assert lines[0].split(",") == list(table)
    assert len(lines) == rows + 1

    result.to_npz(tmp_path / "a.npz")
    with np.load(tmp_path / "a.npz", allow_pickle=False) as stored:
        for name, (_, values) in result.arrays().items():
            assert stored[name].shape == values.shape
            if values.dtype != object:
                np.testing.assert_array_equal(stored[name], values)

    assert f"{type(result).__name__} of {rows}" in result._repr_html_()


def test_frame_of_pandas(result):
    pytest.importorskip("pandas", reason="pandas is not here")
    frame, table = result.to_frame(), result.table()
    assert list(frame.columns) == list(table)
    assert frame.iloc[0].tolist() == [column.tolist()[0] for column in table.values()]


def test_dataset_of_xarray_has_axes_and_units(result):
    pytest.importorskip("xarray", reason="xarray is not here")
    dataset, arrays = result.to_xarray(), result.arrays()
    assert set(dataset.variables) == set(arrays)
    for name, (axes, values) in arrays.items():
        assert dataset[name].dims == axes
        assert dataset[name].shape == values.shape
    assert dataset["tau"].attrs == {"units": "time"} if "tau" in arrays else True


def test_axes_of_basins_and_of_kept_states():
    pytest.importorskip("xarray", reason="xarray is not here")
    basins = si.basins(OSC, size=4, impacts=300)
    dataset = basins.to_xarray()
    assert dataset["class"].dims == ("v", "tau")
    assert dataset["class"].sel(tau=basins.tau[1], v=basins.v[2]).item() == basins.to_frame()["class"][2 * 4 + 1]
    kept = OSC.iterate([0.9, 1, 2], 0.5, impacts=4, keep=True)
    table = kept.table()
    assert kept.to_xarray()["tau"].sizes == {"impact": 5, "row": 3}
    assert table["status"].tolist() == ["hit"] * 15
    np.testing.assert_array_equal(table["tau"].reshape(5, 3), kept.tau)


def test_digits_are_kept_in_text(tmp_path):
    hit = OSC.impact_map("0.9", "0.5", digits=30)
    hit.to_csv(tmp_path / "a.csv")
    cell = (tmp_path / "a.csv").read_text().splitlines()[1].split(",")[0]
    assert abs(float(cell) - float(hit.flight_time)) < 1e-15
    assert len(cell.replace(".", "")) >= 30
    assert as_json(hit.as_dict())["flight_time"] == cell


def test_what_is_not_installed_is_named(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "pandas", None)
    with pytest.raises(InputError, match=r"to_frame\(\) needs pandas: python -m pip install pandas"):
        si.tangency_points(OSC).to_frame()
