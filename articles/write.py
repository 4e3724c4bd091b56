"""An article with its figures: `python articles/write.py border_orbits -o FOLDER`, then latexmk -pdf there.

Each has three files here: NAME.py computes its numbers, NAME_pictures.py draws, and NAME.tex.j2 is its text. Theorems,
proofs and their formulas are those of `singimpact derive`, by label; no number that is measured stands in a template.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

from jinja2 import FileSystemLoader

from singimpact import __version__
from singimpact.documents.document_steps import Step
from singimpact.documents.rendering import environment, latex_words
from singimpact.paper.sections.stored_sections import kept_sections, marks_of
from singimpact.store import folder, written

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))  # whoever runs this file, or a test of it, finds the parts
NAMES = tuple(sorted(path.name.removesuffix(".tex.j2") for path in HERE.glob("*.tex.j2") if path.name[0] != "_"))


class Derived:
    """The steps of the derivations of a section by the labels of their equations, as LaTeX."""

    def __init__(self, section: str) -> None:
        shown = kept_sections([section])
        self.steps: list[Step] = [step for each in shown for step in each.steps]
        self.marks = marks_of(shown)

    def equation(self, label: str) -> str:
        """The equation of a label, numbered, with the verdicts of its claims in words."""
        (step,) = [step for step in self.steps if step.label == label]
        return f"\\begin{{equation}}\\label{{{label}}}\n{step.formula}\n\\end{{equation}}"

    def words(self, label: str) -> str:
        """The words before the equation of a label."""
        (step,) = [step for step in self.steps if step.label == label]
        return self._set(step)

    def after(self, label: str) -> str:
        """The words after the equation of a label, where no equation follows them."""
        place = [step.label for step in self.steps].index(label) + 1
        return self._set(self.steps[place])

    def verdict(self, claim: str) -> str:
        """What a claim was found to be."""
        return str(self.marks[claim].verdict)

    @staticmethod
    def _set(step: Step) -> str:
        text = latex_words(step.text.strip())
        return text.replace("[[", "\\textbf{").replace("]]", "}")


def filled(name: str, numbers: Mapping[str, Any]) -> str:
    """The text of an article; a name that is missing is an error."""
    own = environment().overlay(loader=FileSystemLoader(HERE))
    template = own.get_template(f"{name}.tex.j2")
    return template.render(derived=Derived("beyond"), version=__version__, **numbers)


def article(name: str, into: Path, quick: bool = False) -> Path:
    """Compute the numbers and figures of an article and write it.

    Parameters
    ----------
    quick : with fewer points and digits: what a test builds.
    """
    text = filled(name, import_module(name).numbers(quick))
    folder(into)
    for figure, picture in import_module(f"{name}_pictures").pictures(quick).items():
        picture.savefig(into / f"{figure}.pdf", bbox_inches="tight")
    path = into / f"{name}.tex"
    with written(path) as draft:
        draft.write_text(text, encoding="utf-8")
    return path


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name", choices=NAMES)
    parser.add_argument("-o", "--output", type=Path, default=Path("article"))
    parser.add_argument("--quick", action="store_true", help="fewer points and digits")
    given = parser.parse_args()
    print(article(given.name, given.output, given.quick))
