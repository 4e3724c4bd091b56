"""Decide one claim: its verifier on the printed statement, on the corrected one, and trials of the two on models."""

import json
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from singimpact.algebra.certificates import Certificate, collected
from singimpact.inputs import need
from singimpact.paper.claims.claim import (
    IN_MODEL,
    MODULO,
    PROVED,
    STRENGTH,
    Check,
    Claim,
    Trial,
    Verdict,
    statement_shown_by,
)
from singimpact.paper.routes.equations import derived_from, watched
from singimpact.paper.routes.unfolding import acceleration as model_acceleration, limit_acceleration

SCALING = "s6-scaling"  # the claim that oscillators tend to the universal model
MODEL = {model_acceleration.label, limit_acceleration.label}  # type: ignore[attr-defined]


@dataclass(frozen=True)
class _Found:
    """The outcome of one claim by itself."""

    kind: str
    evidence: str
    witness: Mapping[str, str] | None = None
    corrected: str | None = None
    corrected_kind: str | None = None
    certificates: tuple[Certificate, ...] = ()
    trials: tuple[Trial, ...] = ()
    in_model: bool = False
    modulo: tuple[str, ...] = ()


def decide(claim: Claim, verdicts: Mapping[str, Verdict]) -> Verdict:
    """The verdict on one claim, given the verdicts on what it rests on."""
    started = time.process_time()
    try:
        finding = _found(claim)
    except Exception as error:  # a verifier that raises is a verdict, not a crash of the run
        finding = _Found("error", f"{type(error).__name__}: {' '.join(str(error).split())[:200]}")
    below = [verdicts[name] for name in claim.rests_on if name in verdicts]
    own = effective(finding.corrected_kind or finding.kind, finding.in_model, [verdict.effective for verdict in below])
    return Verdict(
        id=claim.id,
        section=claim.section,
        title=claim.title,
        effective=own,
        effective_modulo=united([finding.modulo, *(verdict.effective_modulo for verdict in below)]),
        printed=claim.printed.latex,
        rests_on=claim.rests_on,
        seconds=time.process_time() - started,
        **vars(finding),
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
    >>> effective("proved", False, ["proved modulo", "proved"]), effective("certified", True, ["proved modulo"])
    ('proved modulo', 'certified')
    """
    own = IN_MODEL if in_model and kind in (PROVED, MODULO) else kind
    return min([own, *below], key=lambda name: STRENGTH[name])


def united(theorems: Iterable[Sequence[str]]) -> tuple[str, ...]:
    """The theorems of several arguments, each once, in the order in which they come.

    Examples
    --------
    >>> united([("Takens' theorem",), (), ("the stable manifold theorem", "Takens' theorem")])
    ("Takens' theorem", 'the stable manifold theorem')
    """
    return tuple(dict.fromkeys(name for names in theorems for name in names))


def _found(claim: Claim) -> _Found:
    check, certificates, in_model = _verified(claim, claim.printed.value)
    if check.holds:
        return _Found(check.kind, check.evidence, certificates=certificates, in_model=in_model, modulo=check.modulo)
    return _corrected(claim, check)


def _verified(claim: Claim, value: Any) -> tuple[Check, tuple[Certificate, ...], bool]:
    """The verdict on a statement, the certificates on which it rests, and whether it is one about the model alone.

    The second program checks each certificate and says what it shows; a refused one ends the verifier in an error.
    Where it used the model it is not when the verifier found the conditions by which the statement persists, and the
    claim rests on the one that oscillators tend to the model.
    """
    with collected() as gathered:
        check, labels = watched(lambda: claim.verify(value))
    certificates = (
        {"kind": proof["kind"], "says": statement_shown_by(json.dumps(proof)), **proof} for proof in gathered
    )
    persists = check.transverse and SCALING in (claim.id, *claim.rests_on)
    return check, tuple(certificates), _reaches(labels, MODEL) and not persists


def _reaches(labels: Iterable[str], goals: set[str]) -> bool:
    """Whether one of some equations is among others, or among those that they were derived from."""
    todo, seen = set(labels), set[str]()
    while todo - seen:
        seen |= todo
        todo = {below for label in todo for below in derived_from(label)}
    return bool(goals & seen)


def _corrected(claim: Claim, failed: Check) -> _Found:
    """The statement that holds instead of a printed one that failed."""
    if claim.corrected is None:
        raise ArithmeticError(f"the printed statement fails and nothing is known to hold instead: {failed.evidence}")
    statement = claim.corrected()
    check, certificates, in_model = _verified(claim, statement.value)
    if not check.holds:
        raise ArithmeticError(f"printed and corrected statement both fail: {failed.evidence}; {check.evidence}")
    need(failed.witness, ArithmeticError("the printed statement fails without a witness"))
    evidence = f"printed: {failed.evidence}; corrected: {check.evidence}"
    shown = (failed.witness, statement.latex, check.kind, certificates, _tried(claim, statement.value))
    return _Found("corrected", evidence, *shown, in_model, check.modulo)


def _tried(claim: Claim, corrected: Any) -> tuple[Trial, ...]:
    """The trials of a correction: two models must contradict the printed statement, and none the corrected one."""
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
