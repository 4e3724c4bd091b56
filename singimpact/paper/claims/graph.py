"""The claims as a graph: what each rests on, what rests on it, what falls with it."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape

from singimpact.paper.claims.index import Entry


def dependants(claims: Mapping[str, Entry], name: str) -> list[str]:
    """Ids of all claims that rest on one, directly or not, in the order of the paper.

    Examples
    --------
    >>> from singimpact.paper.claims import INDEX
    >>> dependants(INDEX, "s3-DG")
    ['s3-eigenvectors', 's3-slope-r', 't:t1', 't:t1-foliation', 's3-takens', 's3-slope', 't:foliate-smooth']
    """
    reached = {name}
    grown = True
    while grown:
        others = {other for other, claim in claims.items() if reached & set(claim.rests_on)} - reached
        reached |= others
        grown = bool(others)
    return [other for other in claims if other in reached and other != name]


def depth(claims: Mapping[str, Entry], name: str) -> int:
    """The length of the longest chain below a claim."""
    return max((depth(claims, other) + 1 for other in claims[name].rests_on), default=0)


def as_text(claims: Mapping[str, Entry]) -> str:
    """One line a claim: the claim, then what it rests on."""
    width = max(len(name) for name in claims)
    return "\n".join(f"{name:{width}}  {' '.join(claim.rests_on) or '-'}" for name, claim in claims.items())


def as_svg(claims: Mapping[str, Entry], kinds: Mapping[str, str] | None = None) -> str:
    """A picture: columns by depth, an arrow from each claim to what it rests on; colours by verdict where given.

    Parameters
    ----------
    kinds : id -> its effective verdict in words; a colour goes with the longest of the `COLOURS` that begins them.
    """
    columns: dict[int, list[str]] = {}
    for name in claims:
        columns.setdefault(depth(claims, name), []).append(name)
    position = {name: (30 + 210 * x, 30 + 24 * y) for x, names in columns.items() for y, name in enumerate(names)}
    width, height = 210 * len(columns) + 40, 24 * max(len(names) for names in columns.values()) + 50
    lines = [
        f'<path d="M{position[name][0]},{position[name][1] + 8} C{position[name][0] - 60},{position[name][1] + 8} '
        f'{position[other][0] + 215},{position[other][1] + 8} {position[other][0] + 155},{position[other][1] + 8}"/>'
        for name, claim in claims.items()
        for other in claim.rests_on
    ]
    boxes = [_box(claim, *position[name], (kinds or {}).get(name, "")) for name, claim in claims.items()]
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" '
        f'font-size="11"><rect width="100%" height="100%" fill="white"/>'
        f'<g fill="none" stroke="#999999" stroke-width="0.6">{"".join(lines)}</g>{"".join(boxes)}</svg>\n'
    )


COLOURS = {
    "proved": "#d5e8d4",
    "proved modulo": "#d0ece7",
    "proved in the model": "#e6f0d0",
    "certified": "#fff2cc",
    "argued": "#fbe8d0",
    "formal": "#ece4f4",
    "supported": "#dae8fc",
    "cited": "#eeeeee",
    "corrected": "#ffe6cc",
    "error": "#f8cecc",
}


def colour_of(words: str) -> str:
    """The colour of a verdict.

    Examples
    --------
    >>> colour_of("proved modulo Takens' theorem") == COLOURS["proved modulo"], colour_of("open")
    (True, 'white')
    """
    return COLOURS[max(found, key=len)] if (found := [word for word in COLOURS if words.startswith(word)]) else "white"


def _box(claim: Entry, x: int, y: int, kind: str) -> str:
    told = f"{claim.title} [{kind}]" if kind else claim.title
    return (
        f'<g><title>{escape(told)}</title><rect x="{x}" y="{y}" width="155" height="17" rx="3" '
        f'fill="{colour_of(kind)}" stroke="#444444" stroke-width="0.7"/>'
        f'<text x="{x + 6}" y="{y + 12}">{escape(claim.id)}</text></g>'
    )
