"""What a derivation is: a section is steps in order; a step is words, perhaps an equation, and the claims it shows."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Step:
    """One step of a derivation.

    Parameters
    ----------
    text : words; formulas in them stand between dollar signs, everything else is plain text.
    equation : LaTeX of the displayed equation, without an environment; empty when the step is words alone.
    label : the paper's label of the equation, e.g. ``e:meq``; empty when the paper gives it none.
    claims : ids of the claims whose verdicts stand beside the equation.
    """

    text: str
    equation: str = ""
    label: str = ""
    claims: tuple[str, ...] = ()


@dataclass(frozen=True)
class Section:
    """A part of the derivation, written as one document.

    Examples
    --------
    >>> section = Section("demo", "A demonstration", (Step("Clearly", "1 + 1 = 2", "e:two", ("e:two",)),))
    >>> claims_of([section])
    ('e:two',)
    """

    name: str
    title: str
    steps: tuple[Step, ...]


def claims_of(sections: Iterable[Section]) -> tuple[str, ...]:
    """The claims that sections show, each once, in order."""
    return tuple(dict.fromkeys(claim for section in sections for step in section.steps for claim in step.claims))
