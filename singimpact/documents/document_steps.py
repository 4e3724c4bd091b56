"""Derivations: a section is a list of steps; a step is words, perhaps an equation, and the claims that it shows."""

import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from singimpact.inputs import InputError


@dataclass(frozen=True)
class Step:
    """One step of a derivation.

    Parameters
    ----------
    text : words; formulas in them stand between dollar signs, heads such as [[Theorem.]] between double brackets, and
        everything else is plain text.
    equation : LaTeX of the displayed equation, without an environment; several lines, aligned at their ``&``, are a
        tuple; empty when the step is words alone.
    label : the label of the equation, the paper's where it has one, e.g. ``e:meq``; what the golden files know it by.
    claims : ids of the claims whose verdicts stand beside the equation.
    picture : the name, without its ending, of a picture below the step; it is left out where there is no such file.
    """

    text: str
    equation: str | tuple[str, ...] = ""
    label: str = ""
    claims: tuple[str, ...] = ()
    picture: str = ""

    @property
    def formula(self) -> str:
        """The equation as one piece of LaTeX, its lines in an ``aligned``."""
        if isinstance(self.equation, str):
            return self.equation
        return "\\begin{aligned}\n" + " \\\\\n".join(self.equation) + "\n\\end{aligned}"


@dataclass(frozen=True)
class Section:
    """A part of the derivation, written as one file.

    Examples
    --------
    >>> section = Section("demo", "A demonstration", (Step("Clearly", "1 + 1 = 2", "e:two", ("e:two",)),))
    >>> claims_of([section])
    ('e:two',)
    """

    name: str
    title: str
    steps: tuple[Step, ...]


@dataclass(frozen=True)
class Mark:
    """The mark beside an equation for one claim.

    Attributes
    ----------
    verdict : its kind. effective : the weakest verdict along all that it rests on, in words; of what holds instead,
        where it is corrected. printed : the paper's formula in LaTeX, where it is corrected. place : of the equation,
        such as ``(18) in the paper``.
    """

    verdict: str
    effective: str
    printed: str = ""
    place: str = ""

    @property
    def text(self) -> str:
        """The effective verdict; ``corrected, proved`` where what holds instead is proved; the number in the paper."""
        return ", ".join(filter(None, (self.printed and self.verdict, self.effective, self.place)))


def claims_of(sections: Iterable[Section]) -> tuple[str, ...]:
    """The claims that sections show, each once, in order."""
    return tuple(dict.fromkeys(claim for section in sections for step in section.steps for claim in step.claims))


def equations_of(sections: Iterable[Section]) -> dict[str, str]:
    """Label -> LaTeX of every displayed equation, in order.

    Examples
    --------
    >>> equations_of([Section("demo", "", (Step("", "1 + 1 = 2", "e:two"),))])
    {'e:two': '1 + 1 = 2'}
    """
    return {step.label: step.formula for section in sections for step in section.steps if step.equation}


SECONDS = 300.0  # for a document: a section of twenty pages takes 3 s; the rest is a first run that builds fonts


class CompileError(RuntimeError):
    """LaTeX refused a document; the message has its first complaint."""


@dataclass(frozen=True)
class Compiled:
    """A PDF and what LaTeX said of it."""

    pdf: bytes
    log: str

    @property
    def overfull(self) -> list[float]:
        """By how many points lines stick out of the page, in order."""
        return [float(points) for points in re.findall(r"Overfull \\hbox \(([\d.]+)pt too wide\)", self.log)]


def require_latex() -> None:
    """Refuse PDF where there is no LaTeX, before anything is derived for it.

    Raises
    ------
    InputError : latexmk is not installed.
    """
    if shutil.which("latexmk") is None:
        raise InputError("format = 'pdf' needs the program latexmk, which is not found: give latex, or install it")


def compiled(source: str, beside: Mapping[str, str | bytes] | None = None) -> Compiled:
    """The PDF of a LaTeX document.

    Parameters
    ----------
    source : the document. beside : file name -> content of what it takes in, texts and pictures.

    Raises
    ------
    InputError : latexmk is not installed.
    CompileError : LaTeX stopped.
    """
    require_latex()
    with tempfile.TemporaryDirectory() as folder:
        for name, text in {**(beside or {}), "document.tex": source}.items():
            (Path(folder) / name).write_bytes(text.encode() if isinstance(text, str) else text)
        _run(folder)
        log = (Path(folder) / "document.log").read_text(encoding="utf-8", errors="replace")
        return Compiled((Path(folder) / "document.pdf").read_bytes(), log)


def _run(folder: str) -> None:
    # -no-shell-escape: whatever stands in a document, and in a site's configuration, LaTeX runs no other program
    command = [
        "latexmk",
        "-pdf",
        "-latexoption=-no-shell-escape",
        "-interaction=nonstopmode",
        "-halt-on-error",
        "-file-line-error",
        "document.tex",
    ]
    # a fixed date makes the same source give the same PDF
    environment = os.environ | {"SOURCE_DATE_EPOCH": "0", "FORCE_SOURCE_DATE": "1", "max_print_line": "1000"}
    try:
        done = subprocess.run(
            command,
            cwd=folder,
            capture_output=True,
            text=True,
            errors="replace",
            stdin=subprocess.DEVNULL,
            env=environment,
            timeout=SECONDS,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise CompileError(f"latexmk did not end within {SECONDS:.0f} s") from None
    if done.returncode:
        error = re.search(r"^\S*document\.tex:\d+: .*$", done.stdout, re.MULTILINE)
        raise CompileError(error.group() if error else f"latexmk ended with exit code {done.returncode}")
