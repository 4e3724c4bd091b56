"""The index of the claims: what each is called, where it is written and what it rests on, without building any.

The words of the claims are data, one TOML file beside each file of `sections` and `beyond`, which has the statements in
the form that verifiers take.  A list, the graph and the key of a kept verdict need the words alone.
"""

import json
import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from html import escape
from pathlib import Path
from typing import Any

from singimpact.inputs import InputError, unknown
from singimpact.paper.claims import beyond, sections
from singimpact.paper.claims.claim import Claim, Encoding, Statement, Trials

FOLDER = Path(__file__).parent


@dataclass(frozen=True)
class Entry:
    """The words of a claim.

    Attributes
    ----------
    id, section, title, rests_on : as in `Claim`. file : of `sections` or `beyond`, that the claim is written in.
    printed, corrected : LaTeX of the statements; no correction where nothing is wrong, or where its LaTeX is derived.
    """

    id: str
    file: str
    title: str
    printed: str
    section: str = "beyond"
    corrected: str | None = None
    rests_on: tuple[str, ...] = ()


def _read(folder: str, files: Iterable[str]) -> dict[str, Entry]:
    entries = {}
    for file in files:
        words = tomllib.loads((FOLDER / folder / f"{file}.toml").read_text(encoding="utf-8"))
        for name, fields in words.items():
            rests_on = tuple(fields.pop("rests_on", ()))
            entries[name] = Entry(name, file, rests_on=rests_on, **fields)
    return entries


INDEX = _read("sections", sections.FILES)  # the claims of the paper
BEYOND = _read("beyond", beyond.FILES)  # the claims that the paper does not have


def entry_of(name: str) -> Entry:
    """The entry of a claim, of the paper or beyond it.

    Raises
    ------
    InputError : an unknown id; the nearest known ones are named.
    """
    if name not in INDEX and name not in BEYOND:
        number = re.fullmatch(r"(?:eq(?:uation)?\.?)? *\(?(\d{1,3})\)?", str(name))
        if number:
            about = [claim["id"] for claim in places_in_paper() if int(number[1]) in claim["equations"]]
            held = ", ".join(about) or "none; si.claims lists all"
            raise InputError(f"claims have ids, not numbers: about equation ({number[1]}) of the paper there is {held}")
        raise unknown("claim", name, [*INDEX, *BEYOND])
    return INDEX[name] if name in INDEX else BEYOND[name]


@cache
def places_in_paper() -> list[dict[str, Any]]:
    """Where each claim stands in the paper: its id, page, line, numbers of equations and statement."""
    places: list[dict[str, Any]] = json.loads(Path(__file__).with_name("places.json").read_text(encoding="utf-8"))
    return places


@cache
def claims_in(file: str) -> dict[str, Claim]:
    """id -> claim, of one file of `sections` or `beyond`.

    Raises
    ------
    RuntimeError : the file and its words are not about the same claims.
    """
    entries = {name: entry for name, entry in (INDEX | BEYOND).items() if entry.file == file}
    if file in sections.SECTIONS:
        encodings, trials = sections.SECTIONS[file]("CLAIMS"), sections.SECTIONS[file]("TRIALS")
    else:
        encodings, trials = beyond.BEYOND[file]("CLAIMS"), {}
    if encodings.keys() != entries.keys():
        different = ", ".join(sorted(encodings.keys() ^ entries.keys()))
        raise RuntimeError(f"{file}.toml and {file}.py do not agree: only one of them has {different}")
    return {name: _claim(entry, encodings[name], trials.get(name)) for name, entry in entries.items()}


def _claim(entry: Entry, encoding: Encoding, trials: Trials | None) -> Claim:
    corrected = encoding.corrected

    def derived() -> Statement:
        value = corrected() if corrected is not None else None
        return value if isinstance(value, Statement) else Statement(entry.corrected or "", value)

    return Claim(
        id=entry.id,
        section=entry.section,
        title=entry.title,
        printed=Statement(entry.printed, encoding.printed),
        verify=encoding.verify,
        mutants=encoding.mutants,
        corrected=derived if corrected is not None else None,
        rests_on=entry.rests_on,
        trials=trials,
    )


class ClaimTable(Mapping[str, Claim]):
    """id -> claim in the order of the paper; a lookup builds the claims of one file, and finds those beyond it too.

    Examples
    --------
    >>> claim = CLAIMS["e:meq"]
    >>> len(CLAIMS), claim.section, claim.printed.latex[:4]
    (147, '4.1(a)', '2rm=')
    """

    def __getitem__(self, name: str) -> Claim:
        return claims_in(INDEX[name].file if name in INDEX else BEYOND[name].file)[name]

    def __contains__(self, name: object) -> bool:
        return name in INDEX

    def __iter__(self) -> Iterator[str]:
        return iter(INDEX)

    def __len__(self) -> int:
        return len(INDEX)


CLAIMS = ClaimTable()


# The claims as a graph: what each rests on, what rests on it, what falls with it.


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
