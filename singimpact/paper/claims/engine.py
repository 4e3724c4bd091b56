"""Run claims: choose them with what they rest on, and decide or recall each after what it rests on.

Verdicts are kept in the user's cache folder, one sealed file a claim, under the claim's canonical key.  The key is what
a verdict depends on, so that a kept verdict serves while nothing changed: a digest of the package's source outside
`claims/sections` and `claims/beyond`, of the versions of Python and the libraries, of the claim's line in the index, of
the source of its file there with the files of `sections` that this one imports, and of the keys of what the claim rests
on.  An edited verifier runs again with its file and their dependants; an edit below the claims runs all again.  No
claim is built for its key.
"""

import hashlib
import json
import re
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict
from functools import lru_cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from singimpact import cache
from singimpact.cache import source_digest
from singimpact.certificates.claims_proofs import Refused
from singimpact.paper.claims.claim import KINDS, Claim, Trial, Verdict, statement_shown_by
from singimpact.paper.claims.index import CLAIMS, INDEX, Entry, entry_of
from singimpact.progress import ProgressLine
from singimpact.store import cache_folder

# The key of a claim, and its kept verdict.

LIBRARIES = ("sympy", "numpy", "scipy", "python-flint", "mpmath", "numba")
SECTIONS, BEYOND = (Path(__file__).with_name(name) for name in ("sections", "beyond"))
IMPORTED = re.compile(
    r"^\s*from singimpact\.paper\.claims\.sections(?:\.(\w+) import|\s+import ([\w, ]+))", re.MULTILINE
)
ABOVE = (  # folders that no verdict depends on, and the sections, which each claim adds for itself
    "paper/claims/sections/",
    "paper/claims/beyond/",
    "paper/sections/",
    "paper/figures/",
    "cli/",
    "documents/",
    "scenes/",
    "bench/",
)


@lru_cache(maxsize=1)
def ground() -> str:
    """The digest of everything below the sections: the package's source, Python and the libraries."""
    source = source_digest(Path(__file__).parents[2], ABOVE)
    libraries = repr((sys.version_info[:2], [version(name) for name in LIBRARIES]))
    return hashlib.sha256((libraries + source).encode()).hexdigest()


def source_of(file: str) -> str:
    """The source of one file of `sections` or `beyond`."""
    place = SECTIONS / f"{file}.py"
    return (place if place.exists() else BEYOND / f"{file}.py").read_text(encoding="utf-8")


def imported_by(file: str) -> list[str]:
    """A file of `sections` and those that it imports from there, directly or not, in alphabetical order.

    Examples
    --------
    >>> imported_by("section4a_blowup")
    ['section2_trials', 'section4_trials', 'section4a_blowup']
    """
    modules: set[str] = set()
    todo = [file]
    while todo:
        name = todo.pop()
        if name not in modules:
            modules.add(name)
            named = [name_ for pair in IMPORTED.findall(source_of(name)) for name_ in "".join(pair).split(",")]
            todo += [name_.split()[0] for name_ in named]  # "file as other" is the file
    return sorted(modules)


@lru_cache(maxsize=64)
def file_digest(file: str) -> str:
    """The digest of a file of `sections` with what it imports from there."""
    return hashlib.sha256("\0".join(source_of(name) for name in imported_by(file)).encode()).hexdigest()


def key_of(entry: Entry, below: Mapping[str, str]) -> str:
    """The key of a claim, given the keys of the claims it rests on.

    Examples
    --------
    >>> from singimpact.paper.claims.index import INDEX
    >>> len(key_of(INDEX["e:yeq"], {}))
    64
    """
    parts = [ground(), asdict(entry), file_digest(entry.file), [below.get(name, "") for name in entry.rests_on]]
    return hashlib.sha256(json.dumps(parts).encode()).hexdigest()


def _place(name: str) -> Path:
    return cache_folder() / "verdicts" / f"{name.replace(':', '_')}.verdict"


def recall(name: str, key: str) -> Verdict | None:
    """The kept verdict of a claim, or None when there is none for this key or the file is damaged."""
    content = cache.recall(_place(name))
    if content is None:
        return None
    try:
        digests, verdict = cache.unpacked(content, (Verdict, Trial))
        return _checked(verdict) if digests == key else None
    except (ValueError, KeyError, TypeError, Refused) as error:
        cache.damaged(_place(name), str(error))
        return None


def _checked(verdict: Any) -> Verdict:
    if not isinstance(verdict, Verdict) or verdict.kind not in KINDS:
        raise ValueError("not a verdict")
    for certificate in verdict.certificates:
        statement_shown_by(json.dumps(certificate))
    return verdict


def keep(verdict: Verdict, key: str) -> None:
    """Keep a verdict that was reached; one that ended in an error is tried again next time.

    A cache that cannot be written is no reason to fail: the verdict stands, it is only not kept.
    """
    if verdict.kind != "error":
        cache.keep(_place(verdict.id), cache.packed((key, verdict)))


# The run: claims are chosen, and each is decided or recalled after what it rests on.


def select(ids: Sequence[str] | None = None) -> list[Entry]:
    """The index entries of the claims named and of what they rest on, each after what it rests on.

    Parameters
    ----------
    ids : of the paper's claims and of those beyond it; None for all of the paper's.

    Raises
    ------
    InputError : an unknown id; the nearest known ones are named.

    Examples
    --------
    >>> [entry.id for entry in select(["s3-dvdt"])]
    ['e:yeq', 'e:acc', 's3-dvdt']
    """
    wanted = list(INDEX) if not ids else list(dict.fromkeys(ids))
    for name in wanted:
        entry_of(name)
    chosen: dict[str, Entry] = {}

    def visit(name: str) -> None:
        if name not in chosen:
            for other in entry_of(name).rests_on:
                visit(other)
            chosen[name] = entry_of(name)

    for name in wanted:
        visit(name)
    return list(chosen.values())


def run(
    claims: Iterable[Entry | Claim],
    on_start: Callable[[Entry | Claim, int, int], None] | None = None,
    on_end: Callable[[Verdict, int, int], None] | None = None,
    *,
    cached: bool = False,
) -> list[Verdict]:
    """Decide claims in the order given.

    Parameters
    ----------
    claims : entries as `select` returns them, whose claims are built when they are decided; or claims themselves.
    on_start, on_end : called with the entry or claim, or with its verdict; its index; the number of claims. Without
        `on_start` long work shows a line of progress.
    cached : use verdicts cached from earlier runs while nothing they depend on has changed, and keep new ones.  A claim
        that is given itself is always decided.
    """
    chosen = list(claims)
    done: dict[str, Verdict] = {}
    keys: dict[str, str] = {}
    with ProgressLine() as line:
        for index, claim in enumerate(chosen):
            if on_start is not None:
                on_start(claim, index, len(chosen))
            else:
                line.show(index, len(chosen), f"{claim.id}  {claim.title}")
            if isinstance(claim, Claim):
                done[claim.id] = _decided(claim, done)
            elif cached:
                done[claim.id] = _recalled(claim, done, keys)
            else:
                done[claim.id] = _decided(CLAIMS[claim.id], done)
            if on_end is not None:
                on_end(done[claim.id], index, len(chosen))
    return list(done.values())


def _recalled(entry: Entry, done: Mapping[str, Verdict], keys: dict[str, str]) -> Verdict:
    """The kept verdict of a claim, or a new one, which is kept."""
    keys[entry.id] = key_of(entry, keys)
    verdict = recall(entry.id, keys[entry.id])
    if verdict is None:
        verdict = _decided(CLAIMS[entry.id], done)
        keep(verdict, keys[entry.id])
    return verdict


def _decided(claim: Claim, done: Mapping[str, Verdict]) -> Verdict:
    from singimpact.paper.claims.deciding import decide  # loads sympy, which kept verdicts do without

    return decide(claim, done)
