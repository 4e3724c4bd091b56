"""Verdicts kept in the user's cache folder, one sealed file a claim, under the claim's canonical key."""

from __future__ import annotations

import json
from functools import lru_cache
from pathlib import Path
from typing import Any

from singimpact import cache
from singimpact.algebra.checking import accepts
from singimpact.paper.claims.claim import KINDS, Trial, Verdict
from singimpact.store import cache_folder


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
    except (ValueError, KeyError, TypeError) as error:
        cache.damaged(_place(name), str(error))
        return None


def _checked(verdict: Any) -> Verdict:
    if not isinstance(verdict, Verdict) or verdict.kind not in KINDS:
        raise ValueError("not a verdict")
    if not all(_accepted(json.dumps(certificate)) for certificate in verdict.certificates):
        raise ValueError("a certificate is not accepted")
    return verdict


@lru_cache(maxsize=4096)
def _accepted(certificate: str) -> bool:
    """Whether the checker accepts a certificate; many claims share those of what they rest on."""
    return accepts(json.loads(certificate))


def keep(verdict: Verdict, key: str) -> None:
    """Keep a verdict that was reached; one that ended in an error is tried again next time.

    A cache that cannot be written is no reason to fail: the verdict stands, it is only not kept.
    """
    if verdict.kind != "error":
        cache.keep(_place(verdict.id), cache.packed((key, verdict)))
