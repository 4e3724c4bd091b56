"""Run claims: choose them with what they rest on, and decide or recall each after what it rests on."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

from singimpact.paper.claims.claim import Claim, Verdict
from singimpact.paper.claims.index import CLAIMS, INDEX, Entry, entry_of
from singimpact.paper.claims.memory import keep, key_of, recall


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
    kept: bool = False,
) -> list[Verdict]:
    """Decide claims in the order given.

    Parameters
    ----------
    claims : entries as `select` returns them, whose claims are built when they are decided; or claims themselves.
    on_start, on_end : called with the entry or claim, or with its verdict; its index; the number of claims.
    kept : use verdicts kept from earlier runs while nothing they depend on has changed, and keep new ones.  A claim
        that is given itself is always decided.
    """
    chosen = list(claims)
    done: dict[str, Verdict] = {}
    keys: dict[str, str] = {}
    for index, claim in enumerate(chosen):
        if on_start is not None:
            on_start(claim, index, len(chosen))
        if isinstance(claim, Claim):
            done[claim.id] = _decided(claim, done)
        elif kept:
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
