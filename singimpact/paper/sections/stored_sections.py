"""Derivations and the errata's legend, kept in the user's cache folder under their source; marks of what they show."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from singimpact import cache
from singimpact.documents import Mark, Section, Step, claims_of, wrapping
from singimpact.paper.claims.index import places_in_paper
from singimpact.paper.sections.section_templates import template_texts
from singimpact.store import cache_folder

LIBRARIES = ("sympy", "python-flint", "mpmath")
ABOVE = ("cli/", "bench/", "scenes/", "paper/figures/")  # rooms that no derivation depends on


# The letters of the errata, and the models on which statements are tried, so that a trial can be repeated by hand.

LETTERS = (
    "A matter of reading: what is meant is right, what is written says more.",
    "$a,a',a'',\\ldots$ are $a_c(\\tau)=g(\\tau)-f(c,0)$ and its derivatives at $\\tau_*$; $f_{ij}$ the derivatives of "
    "$f$ at $(c,0)$, $i$ times by $x$ and $j$ times by $\\dot x$; $b=\\partial\\ddot x/\\partial v=-f_{01}$; "
    "$\\sigma=\\tau-\\tau_*$; $k=\\frac16a'$ and $\\ell=-\\frac1{24}a''$, but in section 4.1(b) $\\ell$ is the slope "
    "$t/\\sigma$ of a ray, as in the paper.",
    "$\\lambda=m_3-\\frac12$ (at a swan point $1+m_*$) is the factor by which one impact shortens $\\sigma$ along "
    "$\\gamma$, and $\\mu$ the multiplier across; the eigenvalue that the paper calls $\\lambda$ in Theorem 4.1 is "
    "$\\Lambda$ here.",
    "A statement is tried on true motions, which scipy's integrator DOP853, closed forms with many digits or the "
    "impact map compute. Where no other point is named the trial is made at the point that the statement is about.",
)


def legend() -> tuple[str, ...]:
    """Sentences; formulas in them stand between dollar signs."""
    from singimpact.contact.points import tangency_points
    from singimpact.contact.swans import swan_points_over_clearance
    from singimpact.paper.trials import true_orbits, true_sheet

    lines = []
    for name, osc in (true_orbits.MODELS | true_sheet.DAMPED).items():
        points = {point.kind: f"{float(point.tau):.10f}" for point in tangency_points(osc)}
        swan = next(point for point in swan_points_over_clearance(osc) if point.kind == "negative")
        model = wrapping(osc._repr_latex_().strip("$"))
        lines.append(
            f'The model "{name}" is {model}. Regular point $\\tau={true_sheet.REGULAR}$; tangency points with '
            f"$a'>0$ at $\\tau_*={points['gamma']}$ and with $a'<0$ at $\\tau_*={points['foliation']}$; negative swan "
            f"at $c_0={float(swan.clearance):.10g}$, $\\tau_*={float(swan.tau):.10g}$."
        )
    return (*LETTERS, *lines)


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
    # templates are no source to the digest, which reads programs and pages alone
    stored: list[Section] = _kept("sections", [*names, template_texts()], (Section, Step), lambda: _derived(names))
    return stored


def _derived(names: Sequence[str]) -> list[Section]:
    from singimpact.paper.sections.derivation_sections import sections  # loads sympy

    return sections(names)


def kept_legend() -> tuple[str, ...]:
    """The result of `legend`, from the cache if it was computed before."""
    stored: tuple[str, ...] = _kept("legend", ["legend"], (), legend)
    return stored


def _kept(kind: str, parts: Sequence[object], types: tuple[type, ...], derive: Callable[[], Any]) -> Any:
    """A result from the cache, or a new one, which is kept under what it depends on."""
    file = cache_folder() / "derivations" / f"{cache.key_of(parts, LIBRARIES, ABOVE)}.{kind}"
    content = cache.recall(file)
    if content is not None:
        return cache.unpacked(content, types)
    derived = derive()
    cache.keep(file, cache.packed(derived))
    return derived


# The verdicts of what sections show, as marks beside their equations.


def marks_of(shown: Iterable[Section]) -> dict[str, Mark]:
    """Claim id -> its mark, for every claim that sections show; a kept verdict is not computed again."""
    from singimpact.paper.claims import run, select

    ids = claims_of(shown)
    listed = {line["id"]: ", ".join(f"({n})" for n in line["equations"]) for line in places_in_paper()}
    places = {name: f"{numbers} in the paper" for name, numbers in listed.items() if numbers}
    return {
        one.id: Mark(one.kind, one.worth, one.printed if one.corrected else "", places.get(one.id, ""))
        for one in run(select(ids) if ids else (), cached=True)
    }
