"""The sweeps: a planted inaccuracy is seen, every public function has a row, what was mended stays mended."""

from __future__ import annotations

import inspect
import json
from functools import partial

import flint
import pytest

import singimpact as si
from singimpact import impact_oscillator, theory
from singimpact.bench import (
    FUNCTIONS,
    LIMITS,
    PLACES,
    Function,
    Launch,
    SteepLaunch,
    Trial,
    chosen,
    landing,
    moved,
    stressed,
    worst,
)
from singimpact.bench.stress.table import QUICK

pytestmark = pytest.mark.slow  # seconds together: .ci/check runs them

NO_NUMBER = {"to_toml", "linear", "universal", "read_model", "sweep", "release", "over"}  # models, and work for others
NO_NUMBER |= {
    "shaken_wall",
    "basins",
    "ensemble",
    "regions",
    "fit",
    "sensitivity",
    "bifurcation",
    "classify",
    "grown_gamma",
    "release_map",
    "certified_gamma",  # what it proves is checked by a second program
    "transitions",
    "manifold",
    "homoclinic_points",
    "homoclinic_end",
    "border_orbits",
    "constants",  # certified
    "contact_points",  # a witness finds them otherwise in its own tests
    "certified_diagram",
    "resting_windows",  # certified
    "cascade",
    "animate",
    "explore",
    "figure",
    "plot",
    "verify",
    "errata",
    "selftest",
    "enclosed_impact",
    "certify",
    "read_certificate",
}  # made of functions that have rows
OF_SERIES = {"fibre", "dynamics_on_gamma", "v_c", "normal_form", "r_of_lambda", "Sheet"}  # exact; PowerSeries is a row


def public():
    methods = {name for name, _ in inspect.getmembers(impact_oscillator.ImpactOscillator, inspect.isfunction)
               if name in vars(impact_oscillator.ImpactOscillator)}  # fmt: skip
    functions = {name for name in dir(si) if inspect.isfunction(getattr(si, name))}
    series = {name for name, found in vars(theory).items() if callable(found) and not name.startswith("_")}
    return {name for name in methods | functions | series if not name.startswith("_")}


def test_every_public_function_has_a_row():
    rows = {name.split(",")[0] for name in FUNCTIONS}
    assert public() - {"TYPE_CHECKING", "Any"} - NO_NUMBER - OF_SERIES <= rows


def test_every_cell_that_is_left_out_has_a_reason():
    for function in FUNCTIONS.values():
        assert set(function.sweeps) <= set(PLACES)
        assert function.left_out or set(function.sweeps) == set(PLACES), function.name


def planted(off, points):
    for n in range(points):
        x = 2.0**-n
        values, slack = moved(lambda x: [x * x], [x])
        yield Trial(f"x = {x}", [x * x * (1 + off)], values, slack)


@pytest.mark.parametrize(("off", "failed"), [(1e-15, False), (1e-12, True), (float("nan"), True)])
def test_planted_inaccuracy_is_caught(off, failed):
    cell = worst("square", "v -> 0", partial(planted, off), 5)
    assert cell.failed is failed
    assert (cell.units > LIMITS.failure) is failed


def test_wrong_status_fails_and_no_trial_too():
    assert worst("f", "v -> 0", lambda _: iter([Trial("v = 0", status=(5, 2))]), 1).failed
    assert worst("f", "v -> 0", lambda _: iter([]), 1).failed


def test_vertices_keep_their_digits():
    cells = stressed(chosen(["zero_set", "outline"], "t -> 0"), QUICK)
    assert [cell.failed for cell in cells] == [False, False]
    assert all(cell.trials > QUICK for cell in cells)


@pytest.mark.parametrize("name", ["impact_map", "derivative"])
@pytest.mark.parametrize("place", PLACES)
def test_impact_map_and_its_derivative_keep_their_digits(name, place):
    assert [cell for cell in stressed(chosen([name], place), QUICK) if cell.failed] == []


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_function_keeps_its_digits_at_two_of_its_places(name):
    """Two trials each; `singimpact stress` has all of them, and steep layers, which take half a minute."""
    function = FUNCTIONS[name]
    smooth = [place for place in function.sweeps if place != "steep layers"]
    places = list(dict.fromkeys([smooth[0], smooth[-1]]))
    cells = [worst(name, place, function.sweeps[place], 2) for place in places]
    assert [cell for cell in cells if cell.failed] == []
    assert sum(cell.trials for cell in cells) >= 2 * len(places)


def test_derivatives_of_steep_landings_are_those_of_the_linear_oscillator():
    """Differences of balls against the variations of the closed form, on a model that both know."""
    launch = SteepLaunch("linear", 1.7, 0.2, tau=0.4, v=0.8, force="x", forcing="cos(1.7*t)")
    plain = Launch("linear", 1.7, 0.2, tau=0.4, v=0.8)
    with flint.ctx.workprec(launch.bits):
        # 1.7 as a double is not 17/10: the two models differ by a rounding
        steep, closed = landing(launch, 0.4, 0.8), landing(plain, 0.4, 0.8)
        for one, other in zip(sum(steep.by_state, ()), sum(closed.by_state, ()), strict=True):
            assert float(one) == pytest.approx(float(other), rel=1e-13)


def test_command(singimpact, tmp_path):
    told = singimpact("stress", "acceleration", "fixed_points.swan", "--quick", "--json", "-o", tmp_path / "s.json")
    assert told.exit_code == 0, told.output
    cells = json.loads((tmp_path / "s.json").read_text())["cells"]
    assert {cell["function"] for cell in cells} == {"acceleration", "fixed_points.swan"}
    assert all(cell["trials"] and cell["units"] < LIMITS.failure and not cell["failed"] for cell in cells)
    text = singimpact("stress", "acceleration", "--place", "a -> 0", "--quick", "--format", "markdown").stdout
    assert text.startswith("| function | a -> 0 |")


def test_command_fails_where_a_function_does(singimpact, monkeypatch):
    bad = Function("square", {"v -> 0": partial(planted, 1e-9)}, "60 digits", "no other")
    monkeypatch.setitem(FUNCTIONS, "square", bad)
    told = singimpact("stress", "square")
    assert told.exit_code == 1
    assert " !" in told.stdout


@pytest.mark.parametrize(("arguments", "told"), [(("impact_mapp",), "unknown function 'impact_mapp'"),
                                                  (("--place", "v"), "unknown place 'v'")])  # fmt: skip
def test_refused(arguments, told, singimpact):
    result = singimpact("stress", *arguments)
    assert result.exit_code == 2
    assert told in result.stderr
