"""Derivations kept in the user's cache folder as their words and equations, under the source that they come from."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from functools import lru_cache
from importlib.metadata import version
from pathlib import Path

from singimpact import cache
from singimpact.documents.steps import Section, Step
from singimpact.store import cache_folder

ABOVE = ("cli/", "bench/", "scenes/", "paper/figures/")  # rooms that no derivation depends on


def kept_sections(names: Sequence[str] = ()) -> list[Section]:
    """What `derivations.sections` gives, from the cache when it was made before: without sympy then.

    Raises
    ------
    InputError : an unknown name.

    Examples
    --------
    >>> kept_sections(["swan"]) == kept_sections(["5"])
    True
    """
    place = cache_folder() / "derivations" / f"{_key(names)}.sections"
    content = cache.recall(place)
    if content is not None:
        found: list[Section] = cache.unpacked(content, (Section, Step))
        return found
    from singimpact.paper.sections.derivations import sections

    made = sections(names)
    cache.keep(place, cache.packed(made))
    return made


def _key(names: Sequence[str]) -> str:
    return hashlib.sha256(json.dumps([_ground(), *names]).encode()).hexdigest()


@lru_cache(maxsize=1)
def _ground() -> str:
    """The versions of the libraries, and the digest of the source."""
    libraries = repr([version(name) for name in ("sympy", "python-flint", "mpmath")])
    return libraries + cache.source_digest(Path(__file__).parents[2], ABOVE)
