"""Run claims: choose them with what they rest on, decide each, and pass verdicts along the dependencies."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from singimpact.algebra.certificates import Certificate, collected
from singimpact.claims.claim import IN_MODEL, STRENGTH, Check, Claim, Trial, Verdict
from singimpact.claims.keys import key_of
from singimpact.claims.memory import keep, recall
from singimpact.claims.sections import CLAIMS
from singimpact.inputs import unknown
from singimpact.theory.equations import derived_from, watched
from singimpact.theory.unfolding import acceleration as model_acceleration


def select(ids: Sequence[str] | None = None) -> list[Claim]:
    """The claims named and what they rest on, each after what it rests on; all of them for None.

    Raises
    ------
    InputError : an unknown id; the nearest known ones are named.

    Examples
    --------
    >>> [claim.id for claim in select(["s3-dvdt"])]
    ['e:yeq', 'e:acc', 's3-dvdt']
    """
    wanted = list(CLAIMS) if not ids else list(dict.fromkeys(ids))
    for name in wanted:
        if name not in CLAIMS:
            raise unknown("claim", name, CLAIMS)
    chosen: dict[str, Claim] = {}

    def visit(name: str) -> None:
        if name not in chosen:
            for other in CLAIMS[name].rests_on:
                visit(other)
            chosen[name] = CLAIMS[name]

    for name in wanted:
        visit(name)
    return list(chosen.values())


def run(
    claims: Iterable[Claim],
    on_start: Callable[[Claim, int, int], None] | None = None,
    on_end: Callable[[Verdict, int, int], None] | None = None,
    *,
    kept: bool = False,
) -> list[Verdict]:
    """Decide claims in the order given.

    Parameters
    ----------
    claims : as `select` returns them.
    on_start, on_end : called with the claim or its verdict, its index and the number of claims.
    kept : use verdicts kept from earlier runs while nothing they depend on has changed, and keep new ones.
    """
    chosen = list(claims)
    done: dict[str, Verdict] = {}
    keys: dict[str, str] = {}
    for index, claim in enumerate(chosen):
        if on_start is not None:
            on_start(claim, index, len(chosen))
        keys[claim.id] = key_of(claim, keys) if kept else ""
        found = recall(claim.id, keys[claim.id]) if kept else None
        done[claim.id] = found or decide(claim, done)
        if kept and found is None:
            keep(done[claim.id], keys[claim.id])
        if on_end is not None:
            on_end(done[claim.id], index, len(chosen))
    return list(done.values())


@dataclass(frozen=True)
class _Found:
    """What came of one claim by itself."""

    kind: str
    evidence: str
    witness: Mapping[str, str] | None = None
    corrected: str | None = None
    corrected_kind: str | None = None
    certificates: tuple[Certificate, ...] = ()
    trials: tuple[Trial, ...] = ()
    in_model: bool = False


def decide(claim: Claim, known: dict[str, Verdict]) -> Verdict:
    """The verdict on one claim, given the verdicts on what it rests on."""
    started = time.process_time()
    try:
        found = _found(claim)
    except Exception as error:  # a verifier that raises is a verdict, not a crash of the run
        found = _Found("error", f"{type(error).__name__}: {' '.join(str(error).split())[:200]}")
    below = [known[name].effective for name in claim.rests_on if name in known]
    return Verdict(
        id=claim.id,
        section=claim.section,
        title=claim.title,
        effective=effective(found.corrected_kind or found.kind, found.in_model, below),
        printed=claim.printed.latex,
        rests_on=claim.rests_on,
        seconds=time.process_time() - started,
        **vars(found),
    )


def effective(kind: str, in_model: bool, below: Sequence[str]) -> str:
    """The verdict that a claim is worth: the weakest of its own and of the effective ones that it rests on.

    Parameters
    ----------
    kind : what its verifier's argument is worth. in_model : whether that argument is about the universal model.
    below : effective verdicts of the claims that it rests on.

    Examples
    --------
    >>> effective("proved", True, ["proved"]), effective("proved", False, ["supported"])
    ('proved in the model', 'supported')
    """
    own = IN_MODEL if in_model and kind == "proved" else kind
    return min([own, *below], key=lambda name: STRENGTH[name])


def _found(claim: Claim) -> _Found:
    check, certificates, in_model = _verified(claim, claim.printed.value)
    if check.holds:
        return _Found(check.kind, check.evidence, certificates=certificates, in_model=in_model)
    return _corrected(claim, check)


def _verified(claim: Claim, value: Any) -> tuple[Check, tuple[Certificate, ...], bool]:
    """What the verifier says of a statement, the certificates on which that rests, and whether it used the model."""
    with collected() as gathered:
        check, labels = watched(lambda: claim.verify(value))
    return check, tuple(gathered), _reaches(labels, model_acceleration.label)  # type: ignore[attr-defined]


def _reaches(labels: Iterable[str], goal: str) -> bool:
    """Whether an equation is among some, or among those that they were derived from."""
    todo, seen = set(labels), set[str]()
    while todo - seen:
        seen |= todo
        todo = {below for label in todo for below in derived_from(label)}
    return goal in seen


def _corrected(claim: Claim, failed: Check) -> _Found:
    """What holds instead of a printed statement that failed."""
    if claim.corrected is None:
        raise ArithmeticError(f"the printed statement fails and nothing is known to hold instead: {failed.evidence}")
    statement = claim.corrected()
    check, certificates, in_model = _verified(claim, statement.value)
    if not check.holds:
        raise ArithmeticError(f"printed and corrected statement both fail: {failed.evidence}; {check.evidence}")
    if not failed.witness:
        raise ArithmeticError("the printed statement fails without a witness")
    evidence = f"printed: {failed.evidence}; corrected: {check.evidence}"
    trials = _tried(claim, statement.value)
    return _Found("corrected", evidence, failed.witness, statement.latex, check.kind, certificates, trials, in_model)


def _tried(claim: Claim, corrected: Any) -> tuple[Trial, ...]:
    """The trials of a correction: two models must tell it from the printed statement, and none may speak against it."""
    trials = tuple(claim.trials(claim.printed.value, corrected)) if claim.trials else ()
    against = [trial.line() for trial in trials if not trial.corrected_holds]
    if against:
        raise ArithmeticError(f"the corrected statement fails on a model: {against[0]}")
    telling = {trial.model for trial in trials if trial.tells}
    if len(telling) < 2:
        raise ArithmeticError(
            f"a correction needs two models that tell it from what is printed, there are {len(telling)}"
        )
    return trials
