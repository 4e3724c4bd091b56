"""Sections from templates: the words of a section are a TOML file beside this one, its formulas a mapping of names.

A template has a title and steps in order, with the fields of `Step`. Its texts are Jinja2 with the delimiters that
`documents` uses, so ``<< latex(DG) >>`` stands for the formula `DG`. Lines of a text are joined; an equation of several
lines is aligned at their ``&``; ``take`` puts in the steps that stand under a name among the formulas.
"""

import tomllib
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from singimpact.documents import PAGE, Section, Step, environment, lines_of, width


def section_of(name: str, formulas: Callable[[], Mapping[str, object]] = dict) -> Section:
    """The section of a template, with its formulas put in.

    Parameters
    ----------
    name : of the template, without its ending. formulas : computes what `steps_of` takes.

    Examples
    --------
    >>> section_of("notation").title
    'Notation'
    """
    return Section(name, str(_template(name)["title"]), steps_of(name, formulas()))


def steps_of(name: str, formulas: Mapping[str, Any]) -> tuple[Step, ...]:
    """The steps of a template.

    Parameters
    ----------
    name : of the file, without its ending. formulas : expressions, symbols, and steps to take in, by their names.
    """
    steps: list[Step] = []
    for fields in _template(name)["steps"]:
        if "take" in fields:
            steps += formulas[fields["take"]]
        else:
            steps.append(_step(fields, formulas))
    return tuple(steps)


def template_texts() -> dict[str, str]:
    """Name -> template, of all that stand beside this file."""
    return {path.stem: path.read_text(encoding="utf-8") for path in sorted(Path(__file__).parent.glob("*.toml"))}


def rows(left: str, parts: list[str], remainder: int) -> str:
    """``left = parts[0] + parts[1] + ... + O(remainder)``, one part a line, the signs under the first part.

    Examples
    --------
    >>> print(rows("v", ["a", "-b"], 3))
    v ={}& a
    & - b + O(3)
    """
    first, *rest = parts
    signed = [first, *(f"- {entry[1:]}" if entry.startswith("-") else f"+ {entry}" for entry in rest)]
    signed[-1] += f" + O({remainder})"
    room = PAGE.line - width(left) - PAGE.sign
    lines = [
        rf"& \quad {line}" if at else f"& {line}" for entry in signed for at, line in enumerate(lines_of(entry, room))
    ]
    return "\n".join([f"{left} ={{}}{lines[0]}", *lines[1:]])


@cache
def _template(name: str) -> dict[str, Any]:
    return tomllib.loads(Path(__file__).with_name(f"{name}.toml").read_text(encoding="utf-8"))


def _step(fields: Mapping[str, Any], formulas: Mapping[str, object]) -> Step:
    # a single line may be broken by the document, an aligned one stands as it is written
    lines = _filled(fields.get("equation", ""), formulas).strip().split("\n")
    return Step(
        text=" ".join(_filled(fields["text"], formulas).split()),
        equation=lines[0] if len(lines) == 1 else tuple(lines),
        label=_filled(fields.get("label", ""), formulas),
        claims=tuple(filter(None, (_filled(claim, formulas) for claim in fields.get("claims", ())))),
        picture=fields.get("picture", ""),
    )


def _filled(template: str, formulas: Mapping[str, object]) -> str:
    # most texts have no formula to put in, and compiling a template takes longer than reading it
    if "<<" not in template and "<%" not in template:
        return template
    return str(environment().from_string(template).render({**_layouts(), **formulas}))


@cache
def _layouts() -> dict[str, Callable[..., object]]:
    """The ways to lay out a formula that a template may name; they load sympy, which words alone do without."""
    from singimpact.theory.notation import by_degree, factored, in_powers, joined, latex

    layouts: tuple[Callable[..., object], ...] = (by_degree, factored, in_powers, joined, latex, rows)
    return {layout.__name__: layout for layout in layouts}
