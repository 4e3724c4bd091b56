"""The index of the claims: what each is called, where it is written and what it rests on, without building any.

`index.json` is generated from the sections by `python derivations/freeze.py`, `beyond.json` from the claims that the
paper does not have; a file that is loaded must agree with it.  A list, the graph and the key of a kept verdict need the
index alone.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path

from singimpact.inputs import unknown
from singimpact.paper.claims import beyond
from singimpact.paper.claims.claim import Claim
from singimpact.paper.claims.sections import SECTIONS

PLACE, BEYOND_PLACE = (Path(__file__).with_name(name) for name in ("index.json", "beyond.json"))
FILES = SECTIONS | beyond.BEYOND


@dataclass(frozen=True)
class Entry:
    """One line of the index.

    Attributes
    ----------
    id, section, title, rests_on : as in `Claim`. file : of `sections` or `beyond`, that the claim is written in.
    """

    id: str
    section: str
    title: str
    file: str
    rests_on: tuple[str, ...] = ()


def _read(place: Path) -> dict[str, Entry]:
    lines = json.loads(place.read_text(encoding="utf-8")) if place.exists() else []
    return {line["id"]: Entry(**(line | {"rests_on": tuple(line["rests_on"])})) for line in lines}


INDEX: dict[str, Entry] = _read(PLACE)
"""The claims of the paper."""
BEYOND: dict[str, Entry] = _read(BEYOND_PLACE)
"""The claims that the paper does not have."""


def entry_of(name: str) -> Entry:
    """The entry of a claim, of the paper or beyond it.

    Raises
    ------
    InputError : an unknown id; the nearest known ones are named.
    """
    if name not in INDEX and name not in BEYOND:
        raise unknown("claim", name, [*INDEX, *BEYOND])
    return INDEX[name] if name in INDEX else BEYOND[name]


def entries_of(file: str) -> tuple[Entry, ...]:
    """The entries of one file of `sections` or `beyond`, from the claims that it makes."""
    return tuple(Entry(claim.id, claim.section, claim.title, file, claim.rests_on) for claim in FILES[file]())


def written_index(files: Iterable[str] = SECTIONS) -> str:
    """The text of `index.json`, or of the index of other files: one line a claim, in the order of the files."""
    lines = [json.dumps(asdict(entry)) for file in files for entry in entries_of(file)]
    return "[\n" + ",\n".join(lines) + "\n]\n"


@cache
def claims_in(file: str) -> dict[str, Claim]:
    """id -> claim, of one file of `sections` or `beyond`.

    Raises
    ------
    RuntimeError : the index does not agree with the file.
    """
    index, file_, folder = (INDEX, PLACE, "sections") if file in SECTIONS else (BEYOND, BEYOND_PLACE, "beyond")
    if entries_of(file) != tuple(entry for entry in index.values() if entry.file == file):
        raise RuntimeError(f"{file_.name} does not agree with {folder}/{file}.py: run python derivations/freeze.py")
    return {claim.id: claim for claim in FILES[file]()}


def reread() -> None:
    """Take `index.json` and `beyond.json` as they are now, after they were written anew."""
    for index, place in ((INDEX, PLACE), (BEYOND, BEYOND_PLACE)):
        index.clear()
        index.update(_read(place))
    claims_in.cache_clear()


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
