"""Basins of models without t: which attractor a start reaches, against an integrator with events."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import singimpact as si
from singimpact.inputs import InputError

VAN_DER_POL = si.ImpactOscillator("x - (1 - x**2)*xdot", "0", "-1.5", "0.8")
TWO_WELLS = si.ImpactOscillator("x**3 - x + xdot/10", "0", "-1/2", "0.8")


def van_der_pol(x, u):
    return (1 - x**2) * u - x


def two_wells(x, u):
    return x - x**3 - u / 10


def followed(push, x, u, wall, r, until):
    """Times and velocities after the impacts of a start, and its last state, by scipy."""
    t, hits = 0.0, []

    def meets(_t, y):
        return y[0] - wall

    meets.terminal, meets.direction = True, -1
    while t < until:
        way = solve_ivp(
            lambda _t, y: [y[1], push(*y)],
            (t, until),
            [x, u],
            "DOP853",
            events=meets,
            rtol=1e-10,
            atol=1e-12,
            max_step=0.1,
        )
        t, (x, u) = way.t[-1], way.y[:, -1]
        if way.status != 1:
            break
        x, u = wall + 1e-13, -r * u
        hits.append((t, u))
        if u < 1e-5:
            break
    return np.array(hits).reshape(-1, 2), (x, u)


def index_of(found, x, u):
    """The attractor of the start of the grid that is nearest to a state, and that start."""
    j, i = np.abs(found.x - x).argmin(), np.abs(found.xdot - u).argmin()
    return found.attractors[found.codes[i, j]], float(found.x[j]), float(found.xdot[i])


@pytest.mark.parametrize("wall", ["-2.1", "-1.9", "-1.5", "-0.4", "0.3"])
def test_van_der_pol_with_a_wall_reaches_what_an_integrator_reaches(wall):
    model = VAN_DER_POL.replace(clearance=wall)
    found = si.basins(model, ((wall, "2.5"), (-3, 3)), 12)
    for aim in ((-0.2, 0.1), (1.0, -2.0), (2.0, 2.5)):
        attractor, x, u = index_of(found, *aim)
        hits, _ = followed(van_der_pol, x, u, float(wall), 0.8, 120)
        assert attractor.kind == "orbit"
        late = hits[hits[:, 0] > 60]
        assert attractor.n == (1 if late.size else 0)
        if late.size:
            assert np.diff(late[:, 0]) == pytest.approx(attractor.period, abs=1e-6)
            assert late[-1, 1] == pytest.approx(attractor.v[0], abs=1e-6)
        else:
            assert attractor.period == pytest.approx(6.6632868593, abs=1e-8)  # of the oscillator at mu = 1
            assert attractor.x == pytest.approx(-2.00861986087484, abs=1e-8)


def test_rests_on_and_off_the_wall():
    found = si.basins(TWO_WELLS, ((-0.5, 2), (-1.5, 1.5)), 12)
    assert {each.kind for each in found.attractors} == {"rest", "equilibrium"}
    assert {name for _, name, _ in found.classes} == {"rest for ever", "rest off the wall at x = 1"}
    for aim in ((-0.4, 0.0), (0.1, -0.5), (1.5, 1.0), (0.5, 0.2), (0.0, -1.4), (1.9, -1.2)):
        attractor, x, u = index_of(found, *aim)
        _, (end, speed) = followed(two_wells, x, u, -0.5, 0.8, 300)
        assert (attractor.kind, abs(speed) < 1e-4) == ("equilibrium" if end > 0.5 else "rest", True)
        assert end == pytest.approx(1 if attractor.kind == "equilibrium" else -0.5, abs=1e-4)


@pytest.mark.parametrize("seed", range(4))
def test_drawn_models_reach_what_an_integrator_reaches(seed):
    rng = np.random.default_rng(seed)
    a, b, d = np.round(rng.uniform(0.2, 1.5, 3), 2).tolist()
    wall = -float(np.round(rng.uniform(0.2, 3), 2))
    model = si.ImpactOscillator(f"{a}*x + {b}*x**3 - {d}*(1 - x**2)*xdot", "0", str(wall), "0.7")
    found = si.basins(model, size=8)
    for i, j in ((0, 0), (3, 6), (7, 7)):
        attractor = found.attractors[found.codes[i, j]]
        hits, _ = followed(
            lambda x, u: d * (1 - x**2) * u - a * x - b * x**3, found.x[j], found.xdot[i], wall, 0.7, 200
        )
        late = hits[hits[:, 0] > 160, 0]
        assert (attractor.kind, attractor.n > 0) == ("orbit", bool(late.size))
        if late.size:
            assert np.diff(late)[-attractor.n :].sum() == pytest.approx(attractor.period, abs=1e-6)


def test_beside_the_graze_of_the_cycle_the_wall_decides():
    """Van der Pol's cycle reaches down to x = -2.00861986087484."""
    for wall, n in (("-2.008619861", 0), ("-2.0086198605", 1)):
        (attractor,) = si.basins(VAN_DER_POL.replace(clearance=wall), ((-1, 1), (-1, 1)), 4).attractors
        assert (attractor.kind, attractor.n) == ("orbit", n)


def test_where_every_orbit_closes_nothing_attracts():
    found = si.basins(si.ImpactOscillator("x", "0", -1, 1), size=6)
    assert [each.kind for each in found.attractors] == ["continuum"]
    assert "nothing attracts" in found.classes[0][1]
    assert [each.kind for each in si.basins(si.ImpactOscillator("x", "0", -1, "0.9"), size=6).attractors] != ["orbit"]


def test_two_attractors_have_two_names():
    wells = si.ImpactOscillator("x**3 - x + xdot/10", "0", "-2", "0.8")
    names = [name for _, name, _ in si.basins(wells, size=8).classes]
    assert sorted(names) == ["rest off the wall at x = -1", "rest off the wall at x = 1"]


def test_pools_and_stored_cases_give_the_same_classes(tmp_path):
    window = ((-1.5, 2), (-2, 2))
    found = si.basins(VAN_DER_POL, window, 40)
    with ThreadPoolExecutor(1) as pool:
        assert np.array_equal(si.basins(VAN_DER_POL, window, 40, executor=pool).codes, found.codes)
    stored = [si.basins(VAN_DER_POL, window, 40, output=tmp_path / "basins.zarr") for _ in range(2)]
    assert all(np.array_equal(each.codes, found.codes) for each in stored)


def test_tables_and_pictures_have_the_axes_of_the_starts(tmp_path):
    found = si.basins(VAN_DER_POL, size=6)
    found.to_csv(tmp_path / "basins.csv")
    assert (tmp_path / "basins.csv").read_text().startswith("x,xdot,class")
    axes = si.plot(found)
    assert axes.get_xlabel() == "$x$ at the start"
    assert "limit cycle of 1 impact, period 4.81894" in axes.get_legend().get_texts()[0].get_text()
    assert repr(found).startswith("Basins(6 x 6 states: limit cycle of 1 impact")


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        (lambda: si.basins(VAN_DER_POL, ((-2, 1), (0, 1))), r"window of x = .* x >= -1.5"),
        (lambda: si.basins(VAN_DER_POL, 3), r"\(\(x_low, x_high\), \(xdot_low, xdot_high\)\)"),
        (lambda: si.basins(VAN_DER_POL, ((-1, 1), (1, 0))), "window of xdot"),
    ],
)
def test_windows_behind_the_wall_are_refused(ask, words):
    with pytest.raises(InputError, match=words):
        ask()


@pytest.mark.parametrize("direction", [None, "both"])
def test_a_diagram_across_the_graze_of_the_cycle_names_both_sides(direction):
    diagram = si.bifurcation(VAN_DER_POL, "clearance", (-2.3, -1.7), 7, impacts=60, kept=4, direction=direction)
    assert diagram.settled.all()
    for value, events, attractor in zip(diagram.values, diagram.events, diagram.attractors, strict=True):
        impacts = value > -2.00861986087484  # the least x of van der Pol's cycle
        assert (attractor.kind, attractor.n) == ("orbit", int(impacts))
        assert np.isfinite(events[:, 1]).all() == np.isfinite(events[:, 1]).any() == impacts
        if impacts:
            (cycle,) = VAN_DER_POL.replace(clearance=float(value)).periodic(1)
            assert events[:, 0] == pytest.approx(cycle.period, abs=1e-5)
            assert attractor.period == pytest.approx(cycle.period, abs=1e-5)


@pytest.mark.parametrize(
    ("model", "over", "between"),
    [
        (TWO_WELLS, "clearance", (-2, 0.9)),
        (VAN_DER_POL, "clearance", (-1.5, 1.5)),
        (si.linear("2.8", "0.1", "0.8", amplitude=-1), "clearance", (0.1, 0.1001)),
        (si.linear(2, "0.7", "0.5"), "clearance", (0.7, 1.2)),
        (si.linear("2.8", 0, "0.8"), "clearance", (0, 0.001)),
    ],
)
def test_diagrams_and_basins_use_the_same_names(model, over, between):
    diagram = si.bifurcation(model, over, between, 2, impacts=60, kept=4, settle=3000)
    for value, attractor in zip(diagram.values.tolist(), diagram.attractors, strict=True):
        names = {each.name for each in si.basins(model.replace(**{over: value}), size=4, impacts=3000).attractors}
        assert attractor.name in names
    assert diagram.as_dict()["class"].tolist() == [attractor.name for attractor in diagram.attractors]


def test_threads_beside_each_other_find_the_same_classes():
    """Both fly the same compiled model."""
    walls, window = ("-2.1", "-1.9", "0.3", "-2.1"), ((0.3, 2), (-2, 2))
    models = [VAN_DER_POL.replace(clearance=wall) for wall in walls]
    alone = [si.basins(model, window, 16).codes for model in models]
    with ThreadPoolExecutor(4) as pool:
        beside = list(pool.map(lambda model: si.basins(model, window, 16).codes, models))
    assert all(np.array_equal(one, other) for one, other in zip(alone, beside, strict=True))
