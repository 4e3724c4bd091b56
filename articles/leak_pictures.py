"""Pictures of the article on chatter as a leak."""

from __future__ import annotations

import leak
import numpy as np
from matplotlib.figure import Figure

import singimpact as si
from singimpact.scenes.style import BLUE, GREEN, GREY, PURPLE, VERMILLION


def pictures(quick: bool) -> dict[str, Figure]:
    """The pictures by their names."""
    return {
        "hole": hole(60 if quick else 240),
        "survival": survival(quick),
        "uncertain": pairs_apart(quick),
        "closing": closing_areas(quick),
        "staircase": staircase(quick),
    }


def hole(points: int) -> Figure:
    """The plane of launches of the ball, by the time of the first rest, with gamma; and a chatter that completes."""
    figure = Figure(figsize=(7.2, 2.9), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(1.5, 1))
    osc = leak.ball("1.9", "1/2")
    tau = np.linspace(0, leak.TURN, points)
    v = np.linspace(0.005, 3, (2 * points) // 3)
    orbits = si.ensemble(osc, *np.meshgrid(tau, v), until=(leak.PERIODS + 1) * leak.TURN)
    lasts = np.clip((orbits.first_rest - orbits.start) / leak.TURN, 0.3, 60)
    drawn = left.pcolormesh(tau, v, np.log10(lasts), cmap="viridis", rasterized=True)
    bar = figure.colorbar(drawn, ax=left, ticks=[0, np.log10(3), 1, np.log10(30)], pad=0.02)
    bar.ax.set_yticklabels(["1", "3", "10", "30"])
    bar.set_label("periods to the first rest")
    release, fall = np.arcsin(1 / 1.9), np.pi - np.arcsin(1 / 1.9)
    along = np.linspace(fall + 0.02, leak.TURN + release - 0.02, 30 if points < 100 else 90)
    edge = np.array([float(si.threshold(osc, float(each)).v) for each in along])
    for shift in (0, -leak.TURN):
        shown = (along + shift >= 0) & (along + shift <= leak.TURN)
        left.plot(along[shown] + shift, edge[shown], color="white", lw=1.2)
    left.set(xlabel="phase $\\tau$", ylabel="velocity $v$", xlim=(0, leak.TURN), ylim=(0, 3))
    for start, colour, words in ((0.9, BLUE, "below $\\gamma$"), (1.02, VERMILLION, "above $\\gamma$")):
        at = fall + 1.6
        speed = start * float(si.threshold(osc, at).v)
        run = osc.orbit(at, speed, 80)
        times = np.linspace(at, leak.TURN + release + 1.2, 1200)
        right.plot(times, run.sample(times).x, color=colour, lw=1, label=words)
    right.axvline(leak.TURN + release, color=GREY, lw=0.8, ls="--")
    right.set(xlabel="$t$", ylabel="$x$")
    right.set_ylim(-0.02, None)
    right.legend(fontsize=7, loc="upper center", bbox_to_anchor=(0.62, 1))
    return figure


def survival(quick: bool) -> Figure:
    """The share not at rest over periods: of balls that leak, and of balls with another attractor."""
    figure = Figure(figsize=(7.2, 2.8), layout="constrained")
    left, right = figure.subplots(1, 2, sharey=True)
    groups = (
        (left, [("1.9", "0.5"), ("2.0", "0.5"), ("1.8", "0.5")]),
        (right, [("2.4", "0.5"), ("1.8", "0.4"), ("2.0", "0.6")]),
    )
    for axes, models in groups:
        for (amplitude, r), colour in zip(models, (BLUE, VERMILLION, GREEN), strict=True):
            first = np.sort((leak.flown(amplitude, r, quick).first_rest) / leak.TURN)
            n = np.linspace(0, leak.PERIODS, 400)
            share = 1 - np.searchsorted(first, n + 0.5) / first.size
            axes.semilogy(
                n, np.where(share > 0, share, np.nan), color=colour, lw=1.2, label=f"$G = {amplitude}$, $r = {r}$"
            )
            row = leak.rates(quick)[amplitude, r]
            begin, rate = row["begin"], row["rate"]
            if np.isfinite(rate) and axes is left:
                at = share[np.searchsorted(n, begin)]
                line = n[n >= begin]
                whole = 1 - np.exp(-rate * (leak.PERIODS - begin))
                last = share[-1]
                law = last + (at - last) * (np.exp(-rate * (line - begin)) - 1 + whole) / whole
                axes.semilogy(line, np.where(law > 0, law, np.nan), "--", color="black", lw=0.7)
        axes.set(xlabel="periods $n$", ylim=(1e-4, 1.2))
        axes.legend(fontsize=7, loc="lower left")
    left.set_ylabel("share not at rest")
    return figure


def pairs_apart(quick: bool) -> Figure:
    """The share of pairs that rest apart over their distance, with the law of an even saddle."""
    figure = Figure(figsize=(5.2, 2.9), layout="constrained")
    axes = figure.subplots()
    for index, (colour, mark) in enumerate(zip((BLUE, GREEN, PURPLE, VERMILLION), "osD^", strict=True)):
        row = leak.uncertainty(index, quick)
        share = np.where(row["shares"] > 0, row["shares"], np.nan)
        axes.loglog(leak.APART, share, mark, color=colour, ms=4, label=row["words"])
        axes.loglog(leak.APART, share[0] * (leak.APART / leak.APART[0]) ** row["law"], "--", color=colour, lw=0.8)
    axes.set(xlabel="relative distance $\\varepsilon$", ylabel="share of pairs that rest apart")
    axes.legend(fontsize=6.5, loc="lower right")
    return figure


def closing_areas(quick: bool) -> Figure:
    """The hole of the universal swan, and scaled areas of the linear oscillator over the size of its arc."""
    figure = Figure(figsize=(7.2, 2.7), layout="constrained")
    left, right = figure.subplots(1, 2)
    grid = 80 if quick else 200
    centres = (np.arange(grid) + 0.5) / grid
    for r, colour in (("0.4", GREEN), ("0.5", BLUE), ("0.7", VERMILLION)):
        t, u = np.meshgrid(-1.6 + 2.6 * centres, leak.HEIGHTS[r] * centres)
        landed = si.ensemble(si.ImpactOscillator("0", "t**2 - 1", 0, r), t, float(r) * u, until=1.5)
        inside = (landed.first_rest < 1.01) & leak.free_of_the_universal(t, u)
        left.contour(t, u, inside.astype(float), levels=[0.5], colors=[colour], linewidths=1.1)
        left.plot([], [], color=colour, label=f"$r = {r}$")
    left.set(xlabel="landing time $T$", ylabel="landing speed $U$", xlim=(-1.6, 0.4), ylim=(0, 1.1))
    left.legend(fontsize=7)
    for r, colour in (("0.5", BLUE), ("0.7", VERMILLION)):
        values = [leak.scaled_area(size, r, leak.SIZE[quick].grid) for size in leak.SIZES]
        limit = leak.universal_area(r, leak.SIZE[quick].grid)
        right.semilogx(leak.SIZES, np.array(values) / limit, "o", color=colour, ms=4, label=f"$r = {r}$")
    right.axhline(1, color=GREY, lw=0.8)
    right.set(xlabel="half length $\\omega s$ of the arc, in phase", ylabel="area over $b^2A(r)\\,s^7$")
    right.set_xticks(leak.SIZES, [str(size) for size in leak.SIZES])
    right.minorticks_off()
    right.legend(fontsize=7)
    return figure


def staircase(quick: bool) -> Figure:
    """Periods of the released orbit until it is released again, over the amplitude; and the share not yet at rest."""
    figure = Figure(figsize=(7.2, 2.9), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(1.7, 1))
    scan = leak.released(quick)
    rests = np.isfinite(scan.lasts)
    left.semilogy(scan.amplitude[rests], np.ceil(scan.lasts[rests]), ".", color=GREY, ms=1.2, label="seen")
    for place, one in enumerate(leak.windows(quick)):
        words = "proved" if not place else None
        ends = float(one.low), float(one.high)
        left.plot(ends, [one.periods] * 2, color=VERMILLION, lw=3, solid_capstyle="butt", label=words)
    left.plot(scan.amplitude[~rests], np.full((~rests).sum(), 3000), "|", color=BLUE, ms=5, label="not in 2000 periods")
    left.set(xlabel="$G$", ylabel="periods to the next release", ylim=(1.5, 5000))
    left.set_yticks([2, 5, 10, 100, 1000], ["2", "5", "10", "100", "1000"])
    left.minorticks_off()
    left.legend(fontsize=7, loc="upper center", markerscale=2)
    n = np.geomspace(2, 1500, 200)
    everyone = [np.mean(scan.lasts > each) for each in n]
    leaves = np.array([np.mean((scan.lasts > each) & rests) for each in n])
    right.loglog(n, everyone, color=BLUE, label="all")
    right.loglog(n, np.where(leaves > 0, leaves, np.nan), color=VERMILLION, label="those that rest in the end")
    right.set(xlabel="periods $n$", ylabel="share of $G$ not at rest")
    right.legend(fontsize=7, loc="lower left")
    return figure
