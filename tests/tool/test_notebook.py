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
