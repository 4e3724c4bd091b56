"""Derivations: a section is a list of steps; a step is words, perhaps an equation, and the claims that it shows."""

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Step:
    """One step of a derivation.

    Parameters
    ----------
    text : words; formulas in them stand between dollar signs, everything else is plain text.
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
        where it is corrected. printed : the paper's formula in LaTeX, where it is corrected.
    """

    verdict: str
    effective: str
    printed: str = ""

    @property
    def text(self) -> str:
        """The effective verdict; ``corrected, proved`` where what holds instead is proved."""
        return f"{self.verdict}, {self.effective}" if self.printed else self.effective


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
