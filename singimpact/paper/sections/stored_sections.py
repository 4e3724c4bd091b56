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
    place = cache_folder() / "derivations" / f"{cache.key_of(names, LIBRARIES, ABOVE)}.sections"
    content = cache.recall(place)
    if content is not None:
        found: list[Section] = cache.unpacked(content, (Section, Step))
        return found
    from singimpact.paper.sections.derivation_sections import sections

    made = sections(names)
    cache.keep(place, cache.packed(made))
    return made


def kept_legend() -> tuple[str, ...]:
    """The result of `legend.legend`, from the cache if it was computed before."""
    place = cache_folder() / "derivations" / f"{cache.key_of(['legend'], LIBRARIES, ABOVE)}.legend"
    content = cache.recall(place)
    if content is not None:
        found: tuple[str, ...] = cache.unpacked(content, ())
        return found
    from singimpact.paper.sections.legend import legend

    made = legend()
    cache.keep(place, cache.packed(made))
    return made
