"""Pictures of the article on border orbits at contacts of every order."""

from __future__ import annotations

from math import isclose

import border_orbits
import numpy as np
from matplotlib.figure import Figure

import singimpact as si


def pictures(quick: bool) -> dict[str, Figure]:
    """The pictures by their names."""
    return {
        "orbits": orbits_beside(),
        "plane": si.figure("B11"),
        "slices": slices(2 if quick else 24),
        "limits": limits(3 if quick else 14),
    }


def orbits_beside() -> Figure:
    """Three orbits from t_1: chatter that completes, the border orbit, and one that passes t_3."""
    figure = Figure(figsize=(7.2, 2.5), layout="constrained")
    axes = figure.subplots(1, 3, sharex=True, sharey=True)
    at = float(border_orbits.kappa("0.5", 16).value)
    for each, (q, words) in zip(
        axes, ((at - 0.02, "rests before $t_3$"), (at, "the border orbit"), (at + 0.02, "passes $t_3$")), strict=True
    ):
        osc = si.ImpactOscillator("0", f"t**3 - t + ({q!r})", 0, "1/2")
        zeros = [zero.tau for zero in si.tangency_points(osc)]
        run = osc.orbit(zeros[0], 0, 60)
        times = np.linspace(zeros[0], zeros[2] + 0.25, 900)
        each.plot(times, run.sample(times).x, lw=1)
        each.vlines(zeros, -0.002, 0.002, color="0.4", lw=0.8)
        each.axhline(0, color="0.6", lw=0.6)
        each.set_ylim(-0.003, 0.05)
        each.set_title(words, fontsize=9)
        each.set_xlabel("$t$")
    axes[0].set_ylabel("$x - c$")
    return figure


def slices(points: int) -> Figure:
    """t_1 of the border orbit over a further zero, for orders four and five: t_2 = 0, t_3 = 1."""
    figure = Figure(figsize=(7.2, 2.7), layout="constrained")
    left, right = figure.subplots(1, 2)
    for r in ("0.2", "0.5", "0.8"):
        later = np.linspace(1.15, 6, points)
        left.plot(later, [release_of((0, 1, zero), r) for zero in later], label=f"$r = {r}$")
        right.plot(later, [release_of((0, 1, zero, zero + 0.5), r) for zero in later], label=f"$r = {r}$")
    for axes, order in ((left, "four"), (right, "five: $t_5 = t_4 + 1/2$")):
        axes.set(xlabel="$t_4$", ylabel="$t_1$")
        axes.set_title(f"order {order}", fontsize=9)
        axes.legend(fontsize=7)
    return figure


def release_of(others: tuple[float, ...], r: str) -> float:
    """t_1 of the border orbit from t_1 to t_3."""
    product = "*".join(f"(t - ({float(zero)!r}))" for zero in others)
    osc = si.ImpactOscillator("0", f"{(-1) ** len(others)}*(t - u)*{product}", 0, r, {"u": -1})
    found = si.border_orbits(osc, "u", (-2.0, -0.005), points=60)
    own = [each for each in found if isclose(each.release, float(each.parameter), abs_tol=1e-9)]
    (value,) = [float(each.parameter) for each in own if isclose(each.end, others[1], abs_tol=1e-6)]
    return value


def limits(points: int) -> Figure:
    """kappa_* less its limit, as r tends to 0 and to 1, beside both laws."""
    figure = Figure(figsize=(7.2, 2.7), layout="constrained")
    left, right = figure.subplots(1, 2)
    small = np.geomspace(1e-6, 0.5, points)
    values = [float(border_orbits.kappa(f"{r:.9f}", 16).value) for r in small]
    left.loglog(small, -56 / 57**1.5 - np.array(values), "o", ms=3)
    left.loglog(small, 225 * 19**0.5 / 13718 * np.sqrt(small), lw=0.8, color="0.4")
    left.set(xlabel="$r$", ylabel="$-56/57^{3/2} - \\kappa_*$")
    near = np.geomspace(1e-3, 0.5, points)
    right.loglog(near, [border_orbits.over_law(f"{1 - gap:.9f}") * gap ** (6 / 7) for gap in near], "o", ms=3)
    right.loglog(near, border_orbits.near_one() * near ** (6 / 7), lw=0.8, color="0.4")
    right.set(xlabel="$1 - r$", ylabel="$\\kappa_* + 2/3^{3/2}$")
    return figure
