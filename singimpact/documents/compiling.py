"""LaTeX into PDF by latexmk, where it is installed."""

import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from singimpact.inputs import InputError

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
