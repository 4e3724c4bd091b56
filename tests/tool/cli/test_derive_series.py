"""`singimpact derive --order`: series as text that runs by itself."""

import json
import runpy
import shutil

import mpmath
import numpy as np
import pytest
import sympy
from click.testing import CliRunner

import singimpact as si
from singimpact.cli.claim_commands import derive_command
from singimpact.inputs import InputError


def told(*arguments):
    return CliRunner().invoke(derive_command, list(arguments), catch_exceptions=False).output


@pytest.fixture
def model_file(tmp_path):
    path = tmp_path / "model.toml"
    path.write_text(si.linear(2, "0.3", "0.5").to_toml())
    return str(path)


@pytest.fixture
def damped_file(tmp_path):
    path = tmp_path / "damped.toml"
    path.write_text(
        'f = "x + d*xdot"\ng = "cos(2*t)"\nclearance = "0.3"\nrestitution = "0.5"\nparameters = {d = "0.1"}\n'
    )
    return str(path)


SERIES = ["v_c_generic", "fibre", "chatter_limit", "v_c_tangency", "gamma_tangency", "motion_tangency",
          "outline_tangency", "v_c_swan", "gamma_swan", "motion_swan"]  # fmt: skip


def test_sympy_for_symbols():
    text = told("--format", "sympy", "--order", "3")
    lines = [line for line in text.splitlines() if " = " in line and " = Symbol(" not in line]
    assert [line.split(" = ")[0] for line in lines] == SERIES
    assert "gamma_tangency = -a_d1*sigma**2*(lambda_ - 1)*(lambda_ + 2)/6" in " ".join(lines).replace(
        " + sigma**3", " "
    )


def test_json_for_symbols_and_for_a_model(model_file):
    found = json.loads(told("--format", "json", "--order", "3"))
    assert [each["name"] for each in found["series"]] == SERIES
    of_model = json.loads(told("--format", "json", "--order", "4", "--model", model_file))
    assert [each["name"] for each in of_model["series"]] == [name for name in SERIES if name.endswith("tangency")]
    regular = json.loads(told("--format", "json", "--order", "4", "--model", model_file, "--tau", "6/5"))
    assert [each["name"] for each in regular["series"]] == SERIES[:3]


@pytest.mark.parametrize("form", ["latex", "markdown"])
def test_written_formats(form, model_file):
    text = told("--format", form, "--order", "4", "--model", model_file)
    assert "0.2872545556991" in text
    assert r"\bar\sigma" in told("--format", form, "--order", "3")


def test_latex_compiles(tmp_path, model_file):
    if shutil.which("latexmk") is None:
        pytest.skip("latexmk is not found: CI has it")
    told("--format", "pdf", "--order", "4", "-o", str(tmp_path / "symbols"))
    told("--format", "pdf", "--order", "8", "--model", model_file, "-o", str(tmp_path / "model"))
    assert (tmp_path / "symbols" / "derivations.pdf").stat().st_size > 20_000
    assert (tmp_path / "model" / "derivations.pdf").stat().st_size > 20_000


def test_letters_of_a_model(damped_file):
    text = told("--format", "sympy", "--order", "3", "--model", damped_file, "--keep", "d")
    assert "v_c_tangency = -a_d1*sigma*t/2" in text
    assert "*d/" in text


def test_numpy_text_runs_by_itself(model_file):
    scope = {}
    exec(told("--format", "numpy", "--order", "4", "--model", model_file), scope)
    sigma = np.array([-0.1, -0.01])
    series = si.theory.gamma(order=4, model=si.linear(2, "0.3", "0.5"))
    assert scope["gamma_tangency"](sigma) == pytest.approx([float(series(s)) for s in sigma], rel=1e-14)
    assert scope["v_c_tangency"](-0.1, 0.05) > 0


def test_numpy_text_says_its_point_and_where_it_is_accurate(model_file):
    osc = si.linear(2, "0.3", "0.5")
    text = told("--format", "numpy", "--order", "6", "--model", model_file)
    scope = {}
    exec(text, scope)
    point, valid = scope["TAU_STAR"]["tangency"], scope["VALID_WITHIN"]
    assert "tau_* = 2.50854081720004368283298401807, a tangency point with a' > 0" in scope["__doc__"]
    assert point == si.tangency_points(osc).tau[1]
    assert set(valid) == {name for name in SERIES if name.endswith("tangency")}
    true = {
        "gamma_tangency": si.theory.gamma(24, model=osc),
        "motion_tangency": si.theory.dynamics_on_gamma(24, model=osc),
    }
    for name, series in true.items():
        near, far = -valid[name], -8 * valid[name]
        assert abs(scope[name](near) / float(series(near)) - 1) < 1e-12
        assert abs(scope[name](far) / float(series(far)) - 1) > 1e-12  # the radius is not much too small
    radius = valid["v_c_tangency"]
    sigma, t = -radius, radius / 2
    flight = osc.first_hit(point - radius, scope["v_c_tangency"](sigma, t))
    assert flight.flight_time == pytest.approx(t, rel=1e-9)
    longer = si.theory.v_c(20, "tangency", osc)
    exact = float(longer.subs({"sigma": sigma, "t": t}))
    assert abs(scope["v_c_tangency"](sigma, t) - exact) < 1e-12 * 3 * abs(exact)


def test_json_says_its_point_and_a_regular_point_is_written_as_given(model_file):
    found = json.loads(told("--format", "json", "--order", "4", "--model", model_file))
    assert found["tau_star"] == {"tangency": "2.50854081720004368283298401807"}
    assert all(0 < each["valid_within"] < 0.1 for each in found["series"])
    text = told("--format", "numpy", "--order", "4", "--model", model_file, "--tau", "6/5")
    assert "tau_* = 1.2 = 1.2000" in text
    assert "a regular point" in text
    symbols = json.loads(told("--format", "json", "--order", "3"))
    assert symbols["tau_star"] == {}
    assert {each["valid_within"] for each in symbols["series"]} == {None}


def test_numpy_for_symbols_and_a_file(tmp_path):
    text = told("--format", "numpy", "--order", "4")
    assert "def v_c_swan(sigma: Any, t: Any, a_d2" in text
    assert "def gamma_swan(sigma: Any, lambda_: Any" in text
    exec(text, {})
    told("--format", "sympy", "--order", "3", "-o", str(tmp_path / "out"))
    assert "\nv_c_generic = " in (tmp_path / "out" / "series_sympy.py").read_text()


@pytest.mark.parametrize("of_model", [False, True])
def test_files_in_python_are_imported(of_model, tmp_path, model_file, monkeypatch):
    given = ["--order", "4", *(["--model", model_file] if of_model else [])]
    monkeypatch.syspath_prepend(tmp_path)
    for form in ("sympy", "numpy"):
        told("--format", form, *given, "-o", str(tmp_path))
        place = tmp_path / f"series_{form}.py"
        scope = runpy.run_path(str(place))
        assert set(scope) >= {name for name in SERIES if name.endswith("tangency")}
    # every number is exact: no double is among those of the series with symbols
    if not of_model:
        scope = runpy.run_path(str(tmp_path / "series_sympy.py"))
        sigma, r = sympy.Symbol("sigma"), sympy.Symbol("lambda")
        gamma = scope["gamma_tangency"]
        assert not any(scope[name].has(sympy.Float) for name in SERIES)
        expected = -sympy.Symbol("a_d1") * (r - 1) * (r + 2) / 6
        assert sympy.expand(gamma.coeff(sigma, 2) - expected) == 0


def test_files_keep_thirty_digits(tmp_path, model_file):
    """x'' + x = cos 2t, c = 0.3, r = 1/2: lambda^2 (lambda + 2) = r (1 + 2 lambda), gamma = a' (1 - l)(l + 2)/6 s^2."""
    for form in ("sympy", "numpy"):
        told("--format", form, "--order", "4", "--model", model_file, "-o", str(tmp_path))
    numbers = runpy.run_path(str(tmp_path / "series_numpy.py"))
    symbols = runpy.run_path(str(tmp_path / "series_sympy.py"))
    with mpmath.workdps(40):
        r = mpmath.findroot(lambda r: r**2 * (r + 2) - (1 + 2 * r) / 2, 0.66)
        slope = 2 * mpmath.sqrt(1 - mpmath.mpf("0.3") ** 2)  # a' = -2 sin 2 tau_*, cos 2 tau_* = 0.3
        small = mpmath.mpf(10) ** -15
        for truth, name, power in ((r, "motion_tangency", 1), (slope * (1 - r) * (r + 2) / 6, "gamma_tangency", 2)):
            near, far = (numbers[name](each) / each**power for each in (small, -small))
            # the mean has no term of odd order: what is left of the series is 1e-30
            assert abs((near + far) / 2 / truth - 1) < 1e-28
            coefficient = symbols[name].coeff(sympy.Symbol("sigma"), power)
            assert abs(mpmath.mpf(str(coefficient)) / truth - 1) < 1e-28
        both = numbers["v_c_tangency"](small, -2 * small), numbers["v_c_tangency"](-small, 2 * small)
        # v_c = -a' (sigma/2 + t/6) t + O(3), odd orders cancel in the mean
        assert abs((both[0] + both[1]) / 2 / (slope * small**2 / 3) - 1) < 1e-28


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["section4", "--order", "3"], "is a section of the derivations"),
        (["--format", "sympy", "--order", "0"], "order = 0 is not accepted"),
        (["--tau", "1"], "belong to --model"),
        (["--order", "4", "--keep", "d"], "belong to a model"),
    ],
)
def test_refusals(arguments, sentence):
    with pytest.raises(InputError, match=sentence):
        told(*arguments)


def test_one_series_alone(singimpact):
    alone = singimpact("derive", "--only", "gamma_swan", "--order", "3")
    assert alone.stdout.count("\n") == 1
    assert alone.stdout.startswith("v = ")
    assert alone.stdout.rstrip() in singimpact("derive", "--order", "3").stdout.replace("\n&\\quad{}", " ")
    both = singimpact("derive", "--only", "gamma", "--order", "3").stdout.splitlines()
    assert both[0] == "% Velocity on the invariant curve at a tangency point"
    assert both[3] == alone.stdout.rstrip()
    refused = singimpact("derive", "--only", "gama")
    assert refused.exit_code == 2
    assert "unknown series 'gama'" in refused.stderr


def test_series_of_a_model_name_it_and_the_point_of_expansion(singimpact, tmp_path):
    file = tmp_path / "model.toml"
    file.write_text('f = "x"\ng = "cos(2*t)"\nclearance = 0.3\nrestitution = 0.5\n')
    at = singimpact("derive", "--model", file, "--order", "3", "--format", "json").stdout
    star = json.loads(at)["tau_star"]["tangency"]
    assert abs(np.cos(2 * float(star)) - 0.3) < 1e-12
    told = singimpact("derive", "--model", file, "--order", "3", "--format", "markdown").stdout
    assert r"\cos{\left(2 t \right)}" in told.partition("Launch velocity")[0]
    assert f"Expanded at $\\tau_* = {star}$, a tangency point with $a' > 0$." in told.partition("Launch velocity")[0]
    assert told.index("# Series for a model") < told.index("# Notation")
    words, formula = singimpact("derive", "--model", file, "--only", "gamma").stdout.splitlines()
    assert words == f"% Velocity on the invariant curve at a tangency point, tau_* = {star}"
    assert formula.startswith("v = ")
