"""Derivations and the legend of the errata, kept in the user's cache folder under the source that they come from."""

from __future__ import annotations

from collections.abc import Sequence

from singimpact import cache
from singimpact.documents.document_steps import Section, Step
from singimpact.store import cache_folder

LIBRARIES = ("sympy", "python-flint", "mpmath")
ABOVE = ("cli/", "bench/", "scenes/", "paper/figures/")  # rooms that no derivation depends on


def kept_sections(names: Sequence[str] = ()) -> list[Section]:
    """The result of `derivations.sections`. It comes from the cache, without sympy, if it was computed before.

    Raises
    ------
    InputError : an unknown name.

    Examples
    --------
    >>> kept_sections(["swan"]) == kept_sections(["5"])
    True
    """
    file = cache_folder() / "derivations" / f"{cache.key_of(names, LIBRARIES, ABOVE)}.sections"
    content = cache.recall(file)
    if content is not None:
        stored: list[Section] = cache.unpacked(content, (Section, Step))
        return stored
    from singimpact.paper.sections.derivation_sections import sections

    derived = sections(names)
    cache.keep(file, cache.packed(derived))
    return derived


def kept_legend() -> tuple[str, ...]:
    """The result of `legend.legend`, from the cache if it was computed before."""
    file = cache_folder() / "derivations" / f"{cache.key_of(['legend'], LIBRARIES, ABOVE)}.legend"
    content = cache.recall(file)
    if content is not None:
        stored: tuple[str, ...] = cache.unpacked(content, ())
        return stored
    from singimpact.paper.sections.legend import legend

    entries = legend()
    cache.keep(file, cache.packed(entries))
    return entries
