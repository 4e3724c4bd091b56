"""The articles: no measured number is typed, a missing name is an error, and each builds at its length."""

import re
import runpy
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from jinja2 import UndefinedError

FOLDER = Path(__file__).parents[3] / "articles"
WRITE = runpy.run_path(str(FOLDER / "write.py"))
NAMES = WRITE["NAMES"]


def typed(text):
    """Decimals with three digits or more after the point, outside comments and the bibliography."""
    text = re.sub(r"\\begin\{thebibliography\}.*?\\end\{thebibliography\}", "", text, flags=re.S)
    text = re.sub(r"(?<!\\)%.*", "", re.sub(r"<%.*?%>|<<.*?>>", "", text, flags=re.S))
    return re.findall(r"\d*\.\d{3,}", text)


def test_both_articles_are_here():
    assert NAMES == ("border_orbits", "leak")
    assert all((FOLDER / f"{name}{part}.py").is_file() for name in NAMES for part in ("", "_pictures"))


@pytest.mark.parametrize("name", NAMES)
def test_no_number_of_a_text_is_typed(name):
    text = (FOLDER / f"{name}.tex.j2").read_text(encoding="utf-8")
    assert not typed(text)
    assert typed(text.replace(r"\section", r"It is $-0.2473$. \section", 1)) == ["0.2473"]


def test_comments_and_references_may_have_decimals():
    assert not typed("a % 0.1234\n\\begin{thebibliography}{9} arXiv:1412.0328 \\end{thebibliography} 0.25")
    assert typed("50\\% of 0.1234") == ["0.1234"]


@pytest.mark.parametrize("name", NAMES)
def test_a_name_that_is_missing_is_an_error(name):
    with pytest.raises(UndefinedError, match="is undefined"):
        WRITE["filled"](name, {})


def test_a_label_that_is_missing_is_an_error():
    with pytest.raises(ValueError, match="not enough values"):
        WRITE["Derived"]("beyond").equation("b:none")


def test_the_rate_of_first_rests_is_that_of_the_saddle_beside_an_attractor():
    """A third of the orbits stays for ever; the rate of those that leave is 0.1, cut off at period 80."""
    article = runpy.run_path(str(FOLDER / "leak.py"))
    rng = np.random.default_rng(3)
    first = np.where(rng.random(60_000) < 1 / 3, np.inf, rng.exponential(10, 60_000))
    rate, error, count = article["rate_of"](first, 12, 80)
    assert count == ((first > 12) & (first < 80)).sum()
    assert abs(rate - 0.1) < 4 * error < 0.01
    # rests over the time at risk: what is not to be taken
    late = first[first > 12]
    assert count / (np.minimum(late, 80) - 12).sum() < 0.05
    assert article["bracketed"](0.07692, 0.00021) == "0.0769(2)"
    assert article["bracketed"](0.1, 0.0096) == "0.10(1)"


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("latexmk") is None, reason="needs latexmk")
@pytest.mark.parametrize("name", NAMES)
def test_an_article_builds_at_its_length(name, tmp_path):
    path = WRITE["article"](name, tmp_path, quick=True)
    subprocess.run(
        ["latexmk", "-pdf", "-interaction=nonstopmode", path.name], cwd=tmp_path, capture_output=True, check=True
    )
    log = path.with_suffix(".log").read_text(encoding="utf-8", errors="replace").replace("\n", "")
    pages = int(re.search(r"Output written on .*?\((\d+) pages", log)[1])
    assert 8 <= pages <= 12
    assert "undefined" not in log
    wide = [float(points) for points in re.findall(r"Overfull \\hbox \(([\d.]+)pt too wide", log)]
    assert max(wide, default=0) <= 10
