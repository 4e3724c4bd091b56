"""Section 6: stable manifolds of an unfolded swan, on true orbits of its universal model."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

from singimpact.paper.claims.claim import Check, Statement
from singimpact.paper.claims.sections.section6 import claim_6
from singimpact.paper.claims.verifiers import every
from singimpact.paper.trials import universal_orbits

TRIALS: dict[str, Any] = {}
RATES = ("1/10", "1/2", "9/10")


def _separated(stated: tuple[bool, bool]) -> Check:
    """Whether chatter is complete before B, and so on AB, below gamma, and above it; otherwise orbits leave S'."""
    parts = []
    for rate in RATES:
        lines = universal_orbits.fates(rate)
        changes = {line: sum(one != other for one, other in pairwise(feet)) for line, feet in lines.items()}
        below = [feet[0] for line, feet in lines.items() if changes[line]]
        above = [feet[-1] for line, feet in lines.items() if changes[line]]
        parts.append(
            (
                f"r = {rate}: over {len(lines)} lines in S' the end changes {list(changes.values())} times as v rises, "
                "from chatter that is complete on AB to orbits that pass B",
                set(changes.values()) == {0, 1} or set(changes.values()) == {1},
            )
        )
        as_stated = bool(below) and set(below) == {stated[0]} and set(above) == {stated[1]}
        parts.append((f"below it is complete: {set(below)}; above: {set(above)}", as_stated))
        passing = [feet for line, feet in lines.items() if not changes[line]]
        parts.append(("a line without a change is left of gamma: all of it leaves", not any(map(any, passing))))
    return every(parts, kind="supported")


def _crossed(stated: int) -> Check:
    """The sign of the derivative, along R(D''C'') from C'' to B, of the phase at which chatter ends."""
    feet = {rate: universal_orbits.feet_on_the_landing_arc(rate) for rate in RATES}
    text = "; ".join(f"{min(rates):.4f} to {max(rates):.4f} for r = {rate}" for rate, rates in feet.items())
    return every(
        [
            (
                f"per length of the arc the end of chatter changes by {text}: no stable manifold touches it",
                all(rate * stated > 0 for rates in feet.values() for rate in rates),
            ),
        ],
        kind="supported",
    )


def _beyond(stated: tuple[int, int]) -> Check:
    """The sign of the excess of feet over X at discontinuities, and crossings gained by each that comes into reach."""
    counts = universal_orbits.beyond()
    sign, gain = stated
    return every(
        [
            (
                f"next to delta and its first inverse images, on both sides, orbits rest at {max(map(max, counts.tears)):.2g} "
                "from X at most: W^s(Y), Y > X, meets none of them",
                all(side * sign > 0 for sides in counts.tears for side in sides),
            ),
            (
                f"W^s(Y) for Y - X = {counts.excess} crosses the line sigma = -1.02 {counts.crossings} times: once up and "
                "down between two more of them each time",
                counts.crossings == tuple(gain * count for count in range(len(counts.crossings))),
            ),
        ],
        kind="supported",
    )


CLAIMS = (
    claim_6(
        "s6p-separates",
        "gamma separates S': below it chatter is complete on AB, above it orbits leave S'",
        Statement(
            r"S'\setminus\gamma:\ \text{below: chatter to }AB;\ \text{above: leaves }S'",
            (True, False),
        ),
        _separated,
        ((False, True), (True, True)),
        ("s6p-gamma", "s6p-regions", "t:t2-sides"),
    ),
    claim_6(
        "s6n-transverse",
        "stable manifolds of points to the right of B are transverse to R(D''C'')",
        Statement(r"W^s_\tau\pitchfork R(D''C''),\quad\tau>\tau_2", -1),
        _crossed,
        (1, 0),
        ("s6n-maps", "t:foliate"),
    ),
    claim_6(
        "s6n-Y",
        "W^s(Y), Y to the right of X, meets no inverse image of delta, and gains two crossings for each as Y comes to X",
        Statement(
            r"W^s(Y)\cap G^{-n}(\delta)=\emptyset,\quad\#\bigl(W^s(Y)\cap\{\sigma=-1.02\}\bigr)\in2\mathbb N\ "
            r"\text{grows as}\ Y\to X",
            (-1, 2),
        ),
        _beyond,
        ((1, 2), (-1, 1), (-1, 3)),
        ("s6n-loops", "s6n-accumulate"),
    ),
)
