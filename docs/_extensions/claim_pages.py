"""The claims as pages: each with its formula and its verdict, and one node a section for what rests on what."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from itertools import accumulate
from typing import Any

WIDTH, ROW, BAR = 250, 46, 210  # of a box and of its bar, in pixels, and from one box to the next
ARCS = 170  # pixels to the right of the boxes


def anchor(name: str) -> str:
    """An identifier of HTML for a claim or a section."""
    return "at-" + re.sub(r"[^\w]+", "-", name).strip("-")


def claims_page(verdicts: Sequence[Any]) -> str:
    """Every claim with what is printed, what holds instead, and its verdict."""
    from singimpact.documents.rendering import markdown_text

    steps = numbered_steps()
    parts = ["# All claims", "A statement of the paper is named by the label of its equation, or by a name of ours. "
             "Where it is corrected, the second formula holds; the verdict is then that of the second formula. "
             "[What rests on what](graph.md) has the sections as a picture. A number such as (4.27) is that of a step "
             "in the derivations, the document that `singimpact derive --format pdf -o FOLDER` writes."]  # fmt: skip
    for section in sorted({verdict.section for verdict in verdicts}):
        parts.append(f"## Section {section}")
        for verdict in (each for each in verdicts if each.section == section):
            title = markdown_text(verdict.title)
            parts += [
                f'<span id="{anchor(verdict.id)}"></span>**`{verdict.id}`** {title} (*{words(verdict)}*)'
                + (f", {steps[verdict.id]}" if verdict.id in steps else ""),
                f"$$\n{one_line(verdict.printed)}\n$$",
            ]
            if verdict.corrected:
                parts += ["To be read", f"$$\n{one_line(verdict.corrected)}\n$$"]
    return "\n\n".join(parts) + "\n"


def numbered_steps() -> dict[str, str]:
    """Claim -> the number of the equation of the derivations that shows it, or of the last one before its words."""
    from singimpact.paper.sections.stored_sections import kept_sections

    found: dict[str, str] = {}
    for section in kept_sections():
        number, count = section.title.split(". ")[0], 0
        for step in section.steps:
            count += bool(step.equation)
            at = f"{number}.{count}" if number.isdigit() else f"{count} beyond the paper"
            for claim in step.claims:
                found.setdefault(claim, f"({at})" if step.equation else f"after ({at})")
    return found


def one_line(formula: str) -> str:
    """A formula without empty lines, which would end it."""
    return " ".join(formula.split())


def words(verdict: Any) -> str:
    """A verdict in words, with that of the corrected statement."""
    from singimpact.paper.claims.claim import told

    corrected = f" ({told(verdict.corrected_kind, verdict.modulo)})" if verdict.corrected_kind else ""
    return f"{verdict.kind}{corrected}" if corrected else told(verdict.kind, verdict.modulo)


def graph_page(verdicts: Sequence[Any]) -> str:
    """One node a section, with arcs to the sections that it rests on; a click opens the claims of a section."""
    from singimpact.paper.claims import INDEX
    from singimpact.paper.claims.index import dependants

    by_section: dict[str, list[Any]] = {}
    for verdict in sorted(verdicts, key=lambda each: each.section):
        by_section.setdefault(verdict.section, []).append(verdict)
    home = {verdict.id: verdict.section for verdict in verdicts}
    arcs = Counter(
        (verdict.section, home[name])
        for verdict in verdicts
        for name in verdict.rests_on
        if home.get(name, verdict.section) != verdict.section
    )
    above = {v.id: [name for name, entry in INDEX.items() if v.id in entry.rests_on] for v in verdicts}
    parts = [
        "# What rests on what",
        "A box is a section of the paper, its bar the verdicts of its claims: green proved, teal proved modulo a "
        "theorem, yellow certified, blue supported, orange corrected, grey cited. An arrow leads from a section to "
        "another that it rests on, and is thicker where more claims do. A click on a box opens the claims.",
        f"```{{raw}} html\n{picture(by_section, arcs)}\n```",
        "The effective verdict of a claim is the weakest along all that it rests on, and the one to quote; *falls* "
        "counts the claims that fall with it. [All claims as one picture](graph.svg), with an arrow a dependency.",
    ]
    for section, kin in by_section.items():
        rows = "".join(
            f"<tr><td>{link(v.id)}</td><td>{escape(v.title)}</td><td>{escape(words(v))}</td>"
            f"<td>{escape(v.effective)}</td><td>{links(v.rests_on)}</td><td>{links(above[v.id])}</td>"
            f"<td>{len(dependants(INDEX, v.id))}</td></tr>"
            for v in kin
        )
        head = "".join(
            f"<th>{name}</th>" for name in ("claim", "says", "verdict", "effective", "rests on", "used by", "falls")
        )
        parts.append(
            f'```{{raw}} html\n<details id="{anchor(section)}" class="section-claims">'
            f"<summary>Section {escape(section)}: {counts(kin)}</summary>\n"
            f'<div class="wide"><table><tr>{head}</tr>{rows}</table></div></details>\n```'
        )
    return "\n\n".join(parts) + "\n"


def link(name: str) -> str:
    """A claim, with a link to its formula."""
    return f'<a href="claims.html#{anchor(name)}"><code>{escape(name)}</code></a>'


def links(names: Iterable[str]) -> str:
    """Claims with their links."""
    return " ".join(map(link, names)) or "nothing"


def counts(kin: Iterable[Any]) -> str:
    """How many claims of each verdict."""
    kinds = Counter(verdict.kind for verdict in kin)
    return f"{kinds.total()} claim{'s' * (kinds.total() > 1)}, " + ", ".join(
        f"{count} {kind}" for kind, count in kinds.most_common()
    )


def picture(by_section: Mapping[str, Sequence[Any]], arcs: Mapping[tuple[str, str], int]) -> str:
    """Boxes one below the other in the order of the paper, and arcs beside them."""
    from singimpact.paper.claims.index import colour_of

    middle = {section: 20 + ROW * row for row, section in enumerate(by_section)}
    lines = []
    for (upper, lower), count in arcs.items():
        y, end = middle[upper], middle[lower]
        reach = WIDTH + 24 + (ARCS - 40) * abs(end - y) / (ROW * max(len(by_section) - 1, 1))
        said = f"section {upper} rests on section {lower}: {count} links"
        lines.append(
            f'<path marker-end="url(#tip)" d="M{WIDTH - 4},{y + 4} C{reach:.0f},{y + 4} '
            f'{reach:.0f},{end - 6} {WIDTH + 4},{end - 6}" '
            f'stroke-width="{0.8 + 0.9 * count**0.5:.1f}"><title>{escape(said)}</title></path>'
        )
    boxes = []
    for section, kin in by_section.items():
        y, colours = middle[section], Counter(colour_of(words(verdict)) for verdict in kin)
        widths = [BAR * count / len(kin) for count in colours.values()]
        starts = [0.0, *accumulate(widths)]
        bar = "".join(
            f'<rect x="{20 + start:.1f}" y="{y + 3}" width="{width:.1f}" height="9" class="verdicts" '
            f'style="fill:{colour}"/>'
            for start, width, colour in zip(starts, widths, colours, strict=False)
        )
        opened = f"document.getElementById('{anchor(section)}').open = true"
        boxes.append(
            f'<a href="#{anchor(section)}" onclick="{opened}"><title>{escape(counts(kin))}</title>'
            f'<rect class="box" x="4" y="{y - 18}" width="{WIDTH - 8}" height="36" rx="4"/>'
            f'<text x="20" y="{y - 4}">Section {escape(section)}: {counts(kin).partition(",")[0]}</text>{bar}</a>'
        )
    high = 20 + ROW * len(by_section)
    return (
        f'<svg class="section-graph" viewBox="0 0 {WIDTH + ARCS} {high}" role="img" '
        f'aria-label="Sections of the paper and what they rest on">'
        f'<marker id="tip" viewBox="0 0 6 6" refX="3" refY="3" markerWidth="7" markerHeight="7" orient="auto" '
        f'markerUnits="userSpaceOnUse"><path class="tip" d="M0,0 6,3 0,6z"/></marker>'
        f'<g fill="none" class="arcs">{"".join(lines)}</g>{"".join(boxes)}</svg>'
    )
