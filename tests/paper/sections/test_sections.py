"""A small section through every format: words escaped, equations broken, verdicts beside them, the same bytes twice."""

import json
import os
import shutil
import subprocess
import sys

import pytest
from fakes import claims_room
from hypothesis import given, strategies as st

from singimpact.documents import (
    PAGE,
    CompileError,
    Mark,
    Section,
    Step,
    as_data,
    as_latex,
    as_markdown,
    compiled,
    latex_text,
    lines_of,
    width,
)
from singimpact.paper import NOTATION
from singimpact.paper.sections.derivation_sections import SECTIONS, sections

LONG = "v = " + " + ".join(
    rf"\frac{{{k} a_{{{k}}}}}{{{k + 1}}} \sigma^{{{k}}} \left(1 - \lambda_{{{k}}}\right)" for k in range(1, 30)
)
DEMO = Section(
    "demo",
    "Energy of $x'' + x = 0$ & 100% of it",
    (
        Step("Multiply by $x'$ and take the first integral; #1 of {two} steps_."),
        Step("It is constant:", r"E = \tfrac12 x'^2 + \tfrac12 x^2", "e:meq", ("e:meq", "p:odd")),
        Step("A long sum:", LONG, "", ("e:qdef",)),
    ),
)
PRINTED = r"a = -\frac{b}{2}"
MARKS = {
    "e:meq": Mark("proved", "proved", place="(29) in the paper"),
    "p:odd": Mark("corrected", "proved", PRINTED),
    "e:qdef": Mark("proved", "supported", place="(23) in the paper"),
}


@pytest.fixture
def demo(monkeypatch):
    monkeypatch.setitem(sys.modules, "singimpact.paper.claims", claims_room())
    monkeypatch.setitem(SECTIONS, "demo", lambda: DEMO)


def test_latex_has_words_labels_and_verdicts():
    text = as_latex([DEMO], MARKS)
    assert r"\section*{Energy of $x'' + x = 0$ \& 100\% of it}" in text
    assert r"\#1 of \{two\} steps\_." in text
    assert r"\tag*{\beside{e:meq}{proved, (29) in the paper}}\label{e:meq}" in text
    assert r"\found{p:odd}{corrected, proved}\printed{a = -\frac{b}{2}}" in text
    assert r"\found{e:meq}" not in text


def test_a_long_verdict_stands_in_lines():
    marks = MARKS | {"e:meq": Mark("corrected", "proved modulo the stable manifold theorem", PRINTED)}
    assert r"{\shortstack[r]{corrected, proved modulo the\\stable manifold theorem}}" in as_latex([DEMO], marks)


def test_a_claim_without_a_verdict_is_an_error():
    with pytest.raises(KeyError):
        as_latex([DEMO], {})


def test_markdown_and_data():
    assert "$$\n" + LONG + "\n$$" in as_markdown(DEMO, MARKS)
    assert as_data(DEMO, MARKS)["steps"][1]["claims"] == {
        "e:meq": {"verdict": "proved", "effective": "proved", "printed": "", "place": "(29) in the paper"},
        "p:odd": {"verdict": "corrected", "effective": "proved", "printed": PRINTED, "place": ""},
    }


def test_broken_formula_is_the_same_formula():
    assert "".join("".join(lines_of(LONG)).split()) == "".join(LONG.split())


def test_lines_fit():
    assert max(width(line) for line in lines_of(LONG)) <= PAGE.line


@pytest.mark.parametrize("formula", ["a = -b", r"\left(" + "a + " * 60 + r"b\right)", r"\frac{a + b}{c}"])
def test_no_break_where_none_may_be(formula):
    assert lines_of(formula, limit=1 if len(formula) < 20 else PAGE.line) == [formula]


@given(st.text(max_size=40))
def test_escaped_text_has_no_sign_with_a_meaning(text):
    bare = latex_text(text)
    for command in (
        r"\textbackslash{}",
        r"\textasciicircum{}",
        r"\textasciitilde{}",
        r"\textless{}",
        r"\textgreater{}",
        r"\textbar{}",
    ):
        bare = bare.replace(command, "")
    for sign in "{}$&#%_":
        bare = bare.replace("\\" + sign, "")
    assert not set(bare) & set("\\{}$&#%_^~<>")


@pytest.mark.slow  # test_derivations compares a whole section in three formats
def test_same_bytes_under_two_hash_seeds(clone):
    program = "from test_sections import *; import sys; sys.stdout.write(as_latex([DEMO], MARKS))"
    folders = (clone, clone / "tests", clone / "tests/paper/sections")
    texts = [
        subprocess.run(
            [sys.executable, "-c", program],
            env=os.environ | {"PYTHONHASHSEED": seed, "PYTHONPATH": ":".join(map(str, folders))},
            capture_output=True,
            check=True,
        ).stdout
        for seed in ("0", "12345")
    ]
    assert texts[0] == texts[1] == as_latex([DEMO], MARKS).encode()


@pytest.mark.slow
def test_pdf_compiles_with_nothing_sticking_out():
    assert shutil.which("latexmk"), "CI installs latexmk"
    done = compiled(as_latex([DEMO], MARKS))
    assert done.pdf.startswith(b"%PDF")
    assert max(done.overfull, default=0) <= 20


@pytest.mark.slow
def test_latex_that_fails_says_where():
    with pytest.raises(CompileError, match=r"document\.tex:2: Undefined control sequence"):
        compiled("\\documentclass{article}\\begin{document}\n\\nothing\n\\end{document}")


@pytest.mark.usefixtures("demo")
def test_command_prints_or_writes(singimpact, tmp_path):
    assert singimpact("derive", "demo").stdout == as_latex([DEMO, NOTATION], MARKS)
    names = [section["name"] for section in json.loads(singimpact("derive", "--json", "demo").stdout)["sections"]]
    assert names == ["demo", "notation"]
    assert singimpact("derive", "demo", "--format", "markdown", "-o", tmp_path / "new").exit_code == 0
    assert (tmp_path / "new" / "demo.md").read_text() == as_markdown(DEMO, MARKS)
    assert singimpact("derive", "demo", "-o", tmp_path / "tex").exit_code == 0
    assert {path.name for path in (tmp_path / "tex").iterdir()} == {"notation.tex", "demo.tex", "derivations.tex"}
    assert r"\input{demo}" in (tmp_path / "tex" / "derivations.tex").read_text()


@pytest.mark.usefixtures("demo")
def test_pdf_needs_a_folder_and_latexmk(singimpact, tmp_path, monkeypatch):
    assert "give a folder with -o" in singimpact("derive", "demo", "--format", "pdf").stderr
    monkeypatch.setenv("PATH", str(tmp_path))
    result = singimpact("derive", "demo", "--format", "pdf", "-o", tmp_path)
    assert result.exit_code == 2
    assert "needs the program latexmk" in result.stderr


@pytest.mark.parametrize("name", ["4", "section4", "tangency"])
def test_one_section_has_three_names(name):
    assert [section.name for section in sections([name])] == ["section4", "notation"]


def test_the_notation_alone(singimpact):
    assert singimpact("derive", "notation").stdout == as_latex([NOTATION], {})


@pytest.mark.parametrize(("name", "nearest"), [("tangncy", "tangency"), ("section9", "section")])
def test_unknown_section(singimpact, name, nearest):
    result = singimpact("derive", name)
    assert result.exit_code == 2
    assert f"unknown section '{name}': the nearest known are {nearest}" in result.stderr
    assert len(result.stderr.splitlines()) == 1
