"""Pages and pictures that are computed when the documentation is built, so that they cannot be out of date."""

from __future__ import annotations

import contextlib
import logging
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

from sphinx.util.display import status_iterator

Steps = Callable[..., Iterator[Any]]
"""Names one after the other, with a line of progress for each."""


def errata() -> str:
    """The misprints as the engine finds them now."""
    import singimpact as si

    return si.errata().markdown()


def claims() -> str:
    """Every claim with its formula and its verdict."""
    from claim_pages import claims_page

    import singimpact as si

    return claims_page(si.verify())


def graph(place: Path) -> str:
    """The sections of the paper as nodes, and beside the page all claims as one picture."""
    from claim_pages import graph_page

    import singimpact as si
    from singimpact.paper.claims import INDEX
    from singimpact.paper.claims.index import as_svg

    found = si.verify()
    put(place / "graph.svg", as_svg(INDEX, {v.id: v.in_words if v.corrected else v.worth for v in found}))
    return graph_page(found)


def fates() -> str:
    """The theorem on fates near a contact with its proof, as the derivations have it: for a page that takes it in."""
    from singimpact.documents.document_steps import Section
    from singimpact.documents.rendering import as_markdown
    from singimpact.paper.sections.section_templates import steps_of

    return as_markdown(Section("fates", "", steps_of("fates", {})), {}).removeprefix("# \n")


def commands() -> str:
    """What each command says of itself."""
    from click.testing import CliRunner

    from singimpact.cli import main
    from singimpact.cli.group import COMMANDS

    parts = ["# Commands", ""]
    for name, short in COMMANDS.items():
        told = CliRunner().invoke(main, [name, "--help"], terminal_width=100).output
        parts.append(f"## `singimpact {name}`\n\n{short[0].upper()}{short[1:]}.\n\n```text\n{told.rstrip()}\n```\n")
    return "\n".join(parts)


def figures(place: Path, steps: Steps) -> str:
    """The paper's figures with what they show, and the claims that they illustrate; the pictures go beside the page."""
    from singimpact.paper.figures import BEYOND, FIGURES, kept_picture
    from singimpact.paper.figures.figure_rendering import drawn

    parts = ["# The figures", "", "Drawn from computed data by `singimpact figure all -o FOLDER`; those beyond the "
             "paper, B1, B2, ..., by `singimpact figure beyond -o FOLDER`.", ""]  # fmt: skip
    for number in steps((*FIGURES, *BEYOND), "drawing figures... ", "figure {}"):
        shown = kept_picture(number)
        drawn(shown).savefig(place / f"figure{number}.png", dpi=200)
        told = f" Claims: {', '.join(f'`{claim}`' for claim in shown.claims)}." if shown.claims else ""
        parts += [f"## {number}. {shown.title}", "", f"![{shown.title}](figure{number}.png)", "",
                  shown.caption, "", f"Model: `{shown.model}`.{told}", ""]  # fmt: skip
    return "\n".join(parts)


def branches(place: Path) -> None:
    """The pictures of the page on branches that the gallery does not have."""
    from matplotlib.figure import Figure

    import singimpact as si

    def axes(high: float = 4.8) -> Any:
        return Figure(figsize=(7.2, high), layout="constrained").add_subplot()

    def save(shown: Any, name: str) -> None:
        shown.figure.savefig(place / f"{name}.png", dpi=110)

    ellipses = [si.linear("4.3", "0.001", "0.6").periodic(1, k)[0] for k in (1, 2)]
    save(si.plot([si.branch(each, "clearance", (-2, 2), step=0.05) for each in ellipses], axes()), "branch_ellipses")

    g = "-(1 + 10**q)*sqrt((1 - w**2)**2 + (2.6*w)**2)*cos(w*t)"
    overdamped = si.ImpactOscillator("x + 2.6*xdot", g, -1, "0.8", {"w": "1.963", "q": 0})
    found = []
    for k in range(2, 8):
        q = -1.155 - 1.3048 * (k - 2)
        orbit = next(each for each in overdamped.replace(q=q).periodic(1, k) if each.stable)
        found.append(si.branch(orbit, "q", (max(q - 2.2, -9), q + 1.2)))
    adding = axes(5.0)
    adding.set(yscale="log", xlim=(-8.6, 0), ylim=(1e-5, 2))
    si.plot(found, adding).set_xlabel("$q$: the amplitude is $1 + 10^q$ times that of the graze")
    save(adding, "branch_periods")


def named_models(page: Path, place: Path) -> None:
    """The pictures of a page of a named model, by the lines that the page shows."""
    import re

    import matplotlib.pyplot as plt
    import numpy as np

    import singimpact as si

    for text in re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL):
        space: dict[str, Any] = {"si": si}
        name = text.partition("\n")[0].removeprefix("# picture: ")
        exec(compile(text, f"{page.name}: {name}", "exec"), space)
        figure = np.ravel(space["axes"])[0].figure
        figure.savefig(place / f"gallery_{name}.png", dpi=110)
        plt.close(figure)


def manifolds(place: Path) -> None:
    """The pictures of the page on manifolds that the gallery does not have."""
    from matplotlib.figure import Figure

    import singimpact as si

    found = si.homoclinic_points(si.linear("2.8", 0, "0.8").periodic(1, 1)[0])
    certified = si.plot(found[0].certified(), ax=si.plot(list(found.manifolds)))
    certified.figure.savefig(place / "manifold_certified.png", dpi=110)
    si.plot(found[0].horseshoe()).figure.savefig(place / "manifold_horseshoe.png", dpi=110)

    waves = si.ImpactOscillator("x", "-cos(2.8*t) - h*cos(5.6*t)", "0.3", "0.8", {"h": -1})
    changes = si.transitions(waves, "h", ("-1.5", "-1.1"), (-2, 2), orbits=[(1, 1)])
    swan = next(i for i, each in enumerate(changes) if each.kind == "swan, negative")
    sides = Figure(figsize=(11.0, 5.4), layout="constrained").subplots(1, 2, sharey=True)
    si.plot(changes.both_sides(swan, apart="0.05", v=(0, "0.8"), size=160), sides)
    sides[0].figure.savefig(place / "transition_sides.png", dpi=110)


def gamma_proved(place: Path) -> None:
    """The picture of the page on the proof of gamma: orbits that leave it, in S and v/S^2."""
    import numpy as np
    from matplotlib.figure import Figure

    import singimpact as si
    from singimpact.scenes.style import BLACK, BLUE, ORANGE

    osc = si.linear(2, "0.3", "0.5")
    proved = osc.certified_gamma(reach="1/4")
    end = proved.zero.tau
    S = np.linspace(0.01, 0.25, 60)
    on = np.array([float(proved.threshold(end - np.arctan(each)).value) for each in S * (1 - 1e-12)])
    axes = Figure(figsize=(7.2, 4.6), layout="constrained").add_subplot()
    axes.plot(S, on / S**2, color=BLACK, label="gamma, with its proved bound (narrower than the line)")
    for factor, colour, label in ((1 - 2e-3, BLUE, r"below: chatter completes before $\tau_*$"),
                                  (1 + 2e-3, ORANGE, "above: contact is lost")):  # fmt: skip
        orbit = osc.orbit(end - np.arctan(0.25), float(factor * on[-1]), 24)
        ahead = np.tan(end - orbit.tau)
        over = np.flatnonzero((orbit.v <= 0) | (orbit.tau >= end))  # at rest, or after tau_*
        last = int(over[0]) if over.size else len(ahead)
        axes.plot(ahead[:last], orbit.v[:last] / ahead[:last] ** 2, "o--", color=colour, markersize=4, linewidth=0.8,
                  label=f"an orbit {label}")  # fmt: skip
    axes.set(
        xlabel=r"$S = \tan(\tau_* - \tau)$; orbits run to the left", ylabel="$v/S^2$", xlim=(0, 0.26), ylim=(0, 0.7)
    )
    axes.legend(loc="lower right")
    axes.figure.savefig(place / "gamma_proved.png", dpi=110)


def grazing_exponent(place: Path) -> None:
    """The picture of the page on the exponent beyond a graze: the law of the limit, and exponents of the oscillator."""
    import numpy as np
    from matplotlib.figure import Figure

    import singimpact as si
    from singimpact.scenes.style import BLUE, GREY, ORANGE

    damping, omega, r = 3, 8, 0.5
    slow, fast = np.sort(-np.roots([1, damping, 1]))
    period = 2 * np.pi / omega
    lam, c = np.exp(-slow * period), (1 + r) * omega * np.sqrt(2) / (fast - slow)
    e = np.logspace(-7, -2, 300)
    delta = np.linspace(0.01, 0.99, 2000) * (1 - lam)
    kappa, periods, steps = 0.0, 0.0, 100
    for step in range(-50, steps):
        root = c / np.sqrt(e)[:, None] * np.sqrt(delta)
        m = np.ceil(np.log(root) / -np.log(lam))
        if step >= 0:
            kappa = kappa + np.log(root * lam**m / (2 * delta)).mean(axis=1) / steps
            periods = periods + m.mean(axis=1) / steps
        delta = np.maximum(1 - root * lam**m, 1e-16)

    tau = float(np.angle(1 - omega**2 + 1j * damping * omega)) / omega
    parts = np.random.default_rng(0).uniform(0.01, 1, 25)
    of_impacts = np.logspace(-6, -2, 25)
    found = []
    for each in of_impacts:
        osc = si.models.lamba_budd(damping=damping, omega=omega, beyond=float(each)).replace(restitution=r)
        lyapunov = osc.lyapunov(tau, r * omega * np.sqrt(2 * each * (1 - lam) * parts), 2000, transient=100)
        found.append((lyapunov.per_impact[:, 0].mean(), lyapunov.exponents[:, 0].mean()))

    upper, lower = Figure(figsize=(7.2, 6.4), layout="constrained").subplots(2, sharex=True)
    dots = {"color": ORANGE, "marker": "o", "markersize": 4, "linestyle": "none", "label": "50 000 impacts each"}
    upper.plot(e, kappa, color=BLUE, label=r"$\kappa$ of the limit map")
    lower.plot(e, kappa / periods / period, color=BLUE, label="the law of the limit map")
    lower.plot(e, 2 * slow * kappa.mean() / -np.log(e), "--", color=GREY, label=r"$K/|\ln e|$, its first term alone")
    for axes, values, label in zip((upper, lower), np.transpose(found), ("an impact", "a unit of time"), strict=True):
        axes.plot(of_impacts, values, **dots)
        axes.set(xscale="log", ylabel=f"exponent {label}")
        axes.legend(loc="upper left", ncols=2)
    upper.set(ylim=(1.28, 1.68))  # room for the legend
    lower.set(xlabel="$e$, by which the orbit without impact passes the wall", xlim=(1e-7, 1e-2))
    upper.figure.savefig(place / "grazing_exponent.png", dpi=110)


LIVE = ("shaw_holmes", "budd_dux", "duffing_friction", "luck_mehta", "pendulum", "universal_swan")


def live(name: str, place: Path) -> None:
    """The interactive page of a named model."""
    import singimpact as si

    si.models[name]().explore(points=21).save(place / f"{name}.html")


def build(app: Any) -> None:
    """Write the pages into the folder `computed` beside those that are written by hand."""
    from singimpact.store import folder

    def steps(names: Iterable[Any], summary: str, words: str = "{}") -> Iterator[Any]:
        """The names one after the other; each is a line of Sphinx's progress."""
        names = tuple(names)
        return status_iterator(names, summary, "darkgreen", len(names), app.verbosity, words.format)

    place = folder(Path(app.srcdir) / "computed")
    pages = {"claims": claims, "errata": errata, "graph": lambda: graph(place), "commands": commands,
             "figures": lambda: figures(place, steps)}  # fmt: skip
    for name in steps(pages, "computing pages... "):
        put(place / f"{name}.md", pages[name]())
    put(place / "fates.txt", fates())  # no page of its own
    pictures = {"branches": branches, "manifolds": manifolds, "gamma_proved": gamma_proved,
                "grazing_exponent": grazing_exponent}  # fmt: skip
    for name in steps(pictures, "drawing pictures... "):
        pictures[name](place)
    for page in steps(sorted((Path(app.srcdir) / "models").glob("*.md")), "drawing named models... ", "{0.stem}"):
        named_models(page, place)
    for name in steps(LIVE, "writing live pages... "):
        live(name, folder(place / "pages" / "explore"))


def put(path: Path, text: str) -> None:
    """Write a page; one that has not changed is not read again."""
    from singimpact.store import write_text

    with contextlib.suppress(OSError):
        if path.read_text(encoding="utf-8") == text:
            return
    write_text(path, text)


def setup(app: Any) -> dict[str, Any]:
    """Before Sphinx looks for pages."""
    logging.getLogger("matplotlib").setLevel(logging.WARNING)  # it tells of each letter taken from another font
    app.connect("builder-inited", build)
    return {"parallel_read_safe": True}
