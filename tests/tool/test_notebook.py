"""Things show themselves in a notebook, and long work shows a line under its cell."""

import json
import pickle
import re

import numpy as np
import pytest

import singimpact as si
from singimpact import notebook
from singimpact.progress import ProgressLine
from singimpact.status import StatusArray, status_array


def test_a_model_is_its_equation():
    osc = si.ImpactOscillator("x - 0.1*xdot", "cos(omega*t)", "0.3", "-0.8*v + v**3/9", {"omega": "3/2"})
    shown = osc._repr_latex_()
    for part in (r"\ddot x", r"\dot x", r"\omega = \frac{3}{2}", r"x \ge", r"v \mapsto \frac{v^{3}}{9}"):
        assert part in shown
    assert not re.search(r"\+ -|xdot", shown)
    assert si.universal(-1, "1/2")._repr_latex_().startswith(r"$\ddot x = ")


def test_a_series_tells_where_it_is_cut():
    assert si.theory.gamma(order=3)._repr_latex_().endswith(r" + O(\sigma^{4})$")


def test_a_claim_and_its_verdict_are_tables_with_formulas():
    claim = si.claims["e:meq"]
    assert f"${notebook.escape(claim.printed.latex)}$" in claim._repr_html_()
    found = si.verify("e:meq")
    assert found[-1].kind in found[-1]._repr_html_()
    assert found._repr_html_().count("<tr>") == 1 + len(found)


def test_a_scene_is_a_picture():
    scene = si.Scene(si.linear(2, "0.3", "0.5"), ("discontinuities",), (-1, 1), v=(0, 0.3), pixels=200)
    assert scene._repr_png_().startswith(b"\x89PNG")


def results():
    """Results, and whether a picture of them can be drawn."""
    osc = si.linear("2.8", "0.1", "0.8", amplitude=-1)
    orbit, closed = osc.orbit("0.3", "0.4", impacts=9), osc.periodic(1, 1)
    branch = closed[0].branch("clearance", (0, "0.2"))
    drawn = [orbit, orbit.section(), closed[0], osc.basins(size=8), osc.bifurcation("clearance", (0, "0.2"), points=3)]
    drawn += [branch, next(each for each in osc.periodic(3, 3) if not each.stable).manifold(v=1, length=1)]
    words = [
        closed,
        osc.tangency_points(),
        branch.events[0],
        osc.lyapunov(0.3, 0.4, impacts=50),
        osc.chatter_limit(0.3, 0.01),
    ]
    words += [osc.impact_map(0.3, [0.1, 0.2]), osc.classify(), si.linear(2, "0.3", "0.5").threshold("2.4")]
    return [(each, True) for each in drawn] + [(each, False) for each in words]


def test_results_draw_themselves():
    from matplotlib import pyplot

    pyplot.close("all")
    for result, drawn in results():
        html = result._repr_html_()
        name = type(result).__name__
        assert html.count("<img ") == drawn, name
        assert notebook.escape(str(result)) in html, name
        assert "<table>" in html
        assert f".{name})</code>" in html
    assert r"$\ddot x + x = " in results()[0][0]._repr_html_()
    assert pyplot.get_fignums() == []  # or the notebook shows them twice


def test_statuses_say_what_they_mean():
    step = si.linear(2, "0.3", "0.5").impact_map(1.2, [0.0, 0.01, 0.02])
    assert isinstance(step.status, StatusArray)
    shown = step.status._repr_html_()
    for status in set(step.status.tolist()):
        assert si.Status(status).sentence.split(":")[0] in shown
    assert "3 statuses" in shown
    assert step._repr_html_().count("<tr>") == 4


def test_statuses_are_an_array_like_another():
    statuses = status_array([[0, 1], [3, 0]])
    assert statuses.dtype == np.int8
    assert type(statuses == 0) is np.ndarray
    assert (statuses == 0).sum() == 2
    assert isinstance(statuses[0, 1], np.int8)
    assert isinstance(statuses.max(), np.int8)
    assert pickle.loads(pickle.dumps(statuses)).tolist() == statuses.tolist()
    assert isinstance(si.linear(2, "0.3", "0.5").impact_map(1.2, 0.01).status, np.int8)


def test_a_long_table_counts_what_it_leaves_out():
    rows = [(n,) for n in range(notebook.MOST_ROWS + 5)]
    assert "and 5 more" in notebook.table(["n"], rows)
    assert "more" not in notebook.table(["n"], rows, most=len(rows))


def test_long_work_shows_progress_under_its_cell():
    """A real kernel runs a cell; what it displayed on the way comes back as updates of one output."""
    nbformat, nbclient = (
        pytest.importorskip(name, reason="needs the extra check") for name in ("nbformat", "nbclient")
    )
    shown = "with ProgressLine(delay=0) as line:\n    line.show(3, 7, 'a < b')"
    cell = nbformat.v4.new_code_cell(f"from singimpact.progress import ProgressLine\n{shown}")
    seen = []

    class Watched(nbclient.NotebookClient):
        def process_message(self, message, cell, index):
            seen.append((message["msg_type"], json.dumps(message["content"], default=str)))
            return super().process_message(message, cell, index)

    Watched(nbformat.v4.new_notebook(cells=[cell]), timeout=60, kernel_name="python3").execute()
    updates = [content for kind, content in seen if kind == "update_display_data"]
    assert any("3/7 a &lt; b" in content for content in updates)
    assert "3/7" not in updates[-1]  # it goes when the work ends


def test_elsewhere_nothing_is_shown(capsys):
    with ProgressLine(delay=0) as line:
        line.show(1, 2, "x")
    assert capsys.readouterr() == ("", "")
