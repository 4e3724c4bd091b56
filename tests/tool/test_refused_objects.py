"""What is held is not changed, and what cannot be used ends in one clear sentence."""

import os
import pickle
import threading

import numpy as np
import pytest

import singimpact as si
from singimpact.dynamics import bifurcation
from singimpact.inputs import InputError
from singimpact.status import Status


@pytest.mark.parametrize("name", ["clearance", "f", "restitution", "parameters", "period", "anything"])
def test_a_model_is_not_changed(name):
    model = si.linear(2, "0.3", "0.5")
    before = repr(model), hash(model)
    with pytest.raises(InputError, match=f"{name} of a model is not changed: osc.replace"):
        setattr(model, name, 0.5)
    with pytest.raises(InputError, match="not removed"):
        delattr(model, name)
    with pytest.raises(TypeError):
        si.ImpactOscillator("x", "cos(w*t)", 0, 1, {"w": 2}).parameters["w"] = 3
    assert (repr(model), hash(model)) == before
    assert pickle.loads(pickle.dumps(model)) == model
    assert str(model.replace(clearance="0.5").clearance) == "0.5"


@pytest.mark.parametrize("rho", ["-tanh(v/2)", "-sin(v/2)", "-atan(v)/2", "-0.5*tan(v)"])
def test_a_restitution_by_a_function_has_a_chatter_limit_and_orbits(rho):
    model = si.ImpactOscillator("x", "cos(2*t)", "0.3", rho)
    found, plain = model.chatter_limit("1.2", "0.01"), si.linear(2, "0.3", "0.5").chatter_limit("1.2", "0.01")
    assert found.status == Status.complete
    assert abs(found.tau - plain.tau) < 1e-4  # rho(v) = -v/2 + O(v^3)
    many = model.chatter_limit("1.2", "0.01", digits=20)
    assert abs(float(many.tau) - found.tau) <= found.error
    assert "complete" in model.orbit("1.2", "0.01", 30).kind


@pytest.mark.parametrize("impacts", [1, 7, 1000, 5000])
def test_no_more_impacts_are_flown_than_were_asked_for(impacts):
    model = si.linear("pi/2.8", "1e5", "0.999999")
    found = model.chatter_limit("0.3", "0.3", impacts=impacts)
    assert found.status == Status.unresolved
    assert found.impacts == impacts


def test_a_window_is_named_by_what_moves():
    with pytest.raises(InputError, match="window of clearance"):
        bifurcation(si.linear(2, 1, "0.5"), "clearance", ("1.1", "0.6"))


@pytest.mark.parametrize(
    ("more", "told"),
    [({"title": "x" * 201}, "title"), ({"title": "a\0b"}, "printable"), ({"title": "\x1b[1m"}, "printable"),
     ({"title": r"$\frac{1}$"}, "typeset"), ({"marks": ((r"$\bad$", 0, 0),)}, "typeset"), ({"layers": None}, "layers"),
     ({"layers": 5}, "layers")],
)  # fmt: skip
def test_a_scene_refuses_what_it_cannot_show(more, told):
    fields = {"osc": si.linear(2, "0.3", "0.5"), "layers": ["gamma"], "tau": (0, 3), "v": (0, 1)} | more
    with pytest.raises(InputError, match=told):
        si.Scene(**fields)


def test_a_scene_takes_titles_with_formulas():
    scene = si.Scene(si.linear(2, "0.3", "0.5"), ["gamma"], (0, 3), v=(0, 1), title=r"$\gamma$ at $c = 0.3$")
    assert scene.title == r"$\gamma$ at $c = 0.3$"


def test_odd_objects_are_refused():
    import sympy

    with pytest.raises(InputError):
        si.linear(2, sympy.Function("q")(1), "0.5")
    with pytest.raises(InputError, match="order = '3' is not accepted"):
        si.theory.dynamics_on_gamma("3", model=si.linear(2, "0.3", "0.5"))


@pytest.mark.parametrize(("name", "json"), [("orbit.jpg", False), ("orbit.csv", False), ("orbit.png", True)])
def test_a_table_is_not_put_under_the_name_of_a_picture(tmp_path, name, json):
    from click.testing import CliRunner

    from singimpact.cli import main

    command = ["orbit", "--omega", "2", "--clearance", "0.3", "--restitution", "0.5", "--tau", "1", "--v", "0.1", "-o",
               str(tmp_path / name), *(["--json"] if json else [])]  # fmt: skip
    found = CliRunner().invoke(main, command)
    assert found.exit_code == 2
    assert "a file name ending in" in found.output + (found.stderr if found.stderr_bytes else "")
    assert not (tmp_path / name).exists()


def test_pdf_is_refused_before_anything_is_derived(monkeypatch, tmp_path, singimpact):
    import shutil

    monkeypatch.setattr(shutil, "which", lambda _: None)
    monkeypatch.setattr("singimpact.paper.sections.stored_sections.kept_sections", None)
    found = singimpact("derive", "--format", "pdf", "-o", tmp_path / "pages")
    assert found.exit_code == 2
    assert not (tmp_path / "pages").exists()


def test_latex_runs_no_other_program(monkeypatch, tmp_path):
    import subprocess

    from singimpact.documents import document_steps

    asked = []

    def run(command, **_):
        asked.extend(command)
        return subprocess.CompletedProcess(command, 1, "", "")

    monkeypatch.setattr(subprocess, "run", run)
    with pytest.raises(document_steps.CompileError):
        document_steps._run(str(tmp_path))
    assert "-latexoption=-no-shell-escape" in asked


def test_a_plot_is_a_figure_that_pyplot_shows():
    import matplotlib.pyplot as plt

    plt.close("all")
    axes = si.plot(si.linear("2.8", 0, "0.8").orbit(0.9, 0.3, impacts=5))
    assert plt.get_fignums() == [axes.figure.number]
    plt.close("all")


@pytest.mark.parametrize("name", ["pi\u0113", "\u03c9", "caf\u00e9", "x\u0661"])
def test_names_of_parameters_have_the_letters_of_f(name):
    """One rule: what f could not name is no parameter."""
    with pytest.raises(InputError, match=r"parameter name = .* is not accepted: give a name of letters a to z"):
        si.ImpactOscillator("x", "cos(2*t)", 0, "0.5", parameters={name: 1})


def test_files_without_an_end_are_refused(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for path, reason in (("/dev/zero", "more than 1000000 bytes"), (tmp_path / "pipe", "has no f")):
        with pytest.raises(InputError, match=reason):
            si.read_model(path)


def test_a_pipe_that_somebody_writes_to_is_a_model_file(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    text = si.linear(2, 0, "0.5").to_toml().encode()
    reading = os.open(tmp_path / "pipe", os.O_RDONLY | os.O_NONBLOCK)  # so that writing does not wait
    writing = os.open(tmp_path / "pipe", os.O_WRONLY)
    os.write(writing, text)
    threading.Timer(0.1, os.close, (writing,)).start()
    assert si.read_model(tmp_path / "pipe") == si.linear(2, 0, "0.5")
    os.close(reading)


@pytest.mark.parametrize("omega", [1e150, 1e300, "1e300", 1e-300])
def test_any_frequency_is_flown(omega):
    """The forcing of a frequency beyond all measure moves nothing, and takes too many steps; a tiny one is constant."""
    step = si.linear(omega, 0, "0.5").impact_map(0.3, 0.25)
    turn = np.pi if float(omega) > 1 else 2 * np.pi - 2 * np.arctan(0.25)
    if step.status == Status.unresolved:
        assert float(omega) > 1
        assert np.isnan(step.v)
    else:
        assert step.flight_time == pytest.approx(turn, rel=1e-13)
        assert step.v == pytest.approx(0.125, rel=1e-13)


def test_states_that_no_memory_holds_are_refused():
    with pytest.raises(InputError, match="10000000000 states, whose results need 340 GB of"):
        si.linear(2, 0, "0.5").impact_map(np.zeros((100_000, 1)), np.ones(100_000))


BIG = np.broadcast_to(0.1, (10**5, 10**5))
COLUMN, ROW = BIG[:, :1], BIG[:1]
"""10^10 numbers, and two arrays that broadcast to as many; neither needs memory."""
ARRAY_CALLS = {
    "impact_map": lambda osc: osc.impact_map(BIG, 0.1),
    "first_hit": lambda osc: osc.first_hit(COLUMN, ROW),
    "derivative": lambda osc: osc.derivative(BIG, 0.1),
    "inverse_map": lambda osc: osc.inverse_map(COLUMN, ROW),
    "iterate": lambda osc: osc.iterate(COLUMN, ROW),
    "iterate, kept": lambda osc: osc.iterate(ROW, 0.1, impacts=10**6, keep=True),
    "chatter_limit": lambda osc: osc.chatter_limit(BIG, 0.001),
    "chatter_limit of two": lambda osc: osc.chatter_limit(COLUMN, ROW),
    "launch": lambda osc: osc.launch(BIG, 0.5, 0.1),
    "launch of two": lambda osc: osc.launch(0.5, COLUMN, ROW),
    "release": lambda osc: osc.release(BIG),
    "acceleration": lambda osc: osc.acceleration(BIG),
    "flight": lambda osc: osc.flight(0.1, 0.2, BIG),
    "sample": lambda osc: osc.orbit(0.1, 0.1, impacts=10).sample(BIG),
    "threshold": lambda osc: si.threshold(osc, BIG),
    "bifurcation": lambda osc: bifurcation(osc, "clearance", ("0.3", "0.4"), 10**10),
}


@pytest.mark.parametrize("name", ARRAY_CALLS)
@pytest.mark.parametrize("osc", [si.linear(2, "0.7", "0.5"), si.ImpactOscillator("x + x**3", "cos(2*t)", "0.3", "0.5")])
def test_more_states_than_memory_holds_are_refused_in_one_line(name, osc):
    with pytest.raises(InputError, match=r"whose results need [\d.e+]+ GB of [\d.e+]+: give fewer"):
        ARRAY_CALLS[name](osc)
