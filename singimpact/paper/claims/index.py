"""The index of the claims: what each is called, where it is written and what it rests on, without building any.

`index.json` is generated from the sections by `python derivations/freeze.py`; a section that is loaded must agree with
it.  A list, the graph and the key of a kept verdict need the index alone.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path

from singimpact.paper.claims.claim import Claim
from singimpact.paper.claims.sections import SECTIONS

PLACE = Path(__file__).with_name("index.json")


@dataclass(frozen=True)
class Entry:
    """One line of the index.

    Attributes
    ----------
    id, section, title, rests_on : as in `Claim`. file : the file of `sections` that the claim is written in.
    """

    id: str
    section: str
    title: str
    file: str
    rests_on: tuple[str, ...] = ()


def _read() -> dict[str, Entry]:
    lines = json.loads(PLACE.read_text(encoding="utf-8")) if PLACE.exists() else []
    return {line["id"]: Entry(**(line | {"rests_on": tuple(line["rests_on"])})) for line in lines}


INDEX: dict[str, Entry] = _read()


def entries_of(file: str) -> tuple[Entry, ...]:
    """The entries of one file of `sections`, from the claims that it makes."""
    return tuple(Entry(claim.id, claim.section, claim.title, file, claim.rests_on) for claim in SECTIONS[file]())


def written_index() -> str:
    """The text of `index.json`: one line a claim, in the order of the paper."""
    lines = [json.dumps(asdict(entry)) for file in SECTIONS for entry in entries_of(file)]
    return "[\n" + ",\n".join(lines) + "\n]\n"


@cache
def claims_in(file: str) -> dict[str, Claim]:
    """id -> claim, of one file of `sections`.

    Raises
    ------
    RuntimeError : the index does not agree with the file.
    """
    if entries_of(file) != tuple(entry for entry in INDEX.values() if entry.file == file):
        raise RuntimeError(f"{PLACE.name} does not agree with sections/{file}.py: run python derivations/freeze.py")
    return {claim.id: claim for claim in SECTIONS[file]()}


def reread() -> None:
    """Take `index.json` as it is now, after it was written anew."""
    INDEX.clear()
    INDEX.update(_read())
    claims_in.cache_clear()


class ClaimTable(Mapping[str, Claim]):
    """id -> claim in the order of the paper; a lookup builds the claims of one file.

    Examples
    --------
    >>> claim = CLAIMS["e:meq"]
    >>> len(CLAIMS), claim.section, claim.printed.latex[:4]
    (131, '4.1(a)', '2rm=')
    """

    def __getitem__(self, name: str) -> Claim:
        return claims_in(INDEX[name].file)[name]

    def __contains__(self, name: object) -> bool:
        return name in INDEX

    def __iter__(self) -> Iterator[str]:
        return iter(INDEX)

    def __len__(self) -> int:
        return len(INDEX)


CLAIMS = ClaimTable()
