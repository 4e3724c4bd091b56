"""The page of the documentation on run time: what one run measured, with what a reader needs to read it."""

from __future__ import annotations

from collections.abc import Sequence

COMMAND = "singimpact bench --format page --plots docs/benchmarks -o docs/benchmarks.md"
ABOUT = f"""<!-- written by `{COMMAND}`; do not edit -->
# Run time against error

CPU time of singimpact, and of the tools that a user would choose instead, against the error of the result. Lower and
further left is better."""
READING = f"""## How to read the tables

What a job costs here, and what it costs with what a user would pick instead, in one run on one machine: CPU time, and
the ratio to the first row of each case with its quartiles over interleaved rounds. *Wrong* counts answers that are off
by more than ten times condition times $\\varepsilon$, or missing; *missed* those that are off by more than a hundredth:
another impact, or none. A figure *to reach* stands beside the measured one, and whether it is reached is computed in
the run. Ratios carry over to another machine, microseconds do not. This page is written by

```sh
{COMMAND}
```

Rows named *singimpact* call public names only, with all that Python adds; a test follows their calls. Rows named
*kernel* time a private function. CPU time includes that of child processes, but for the one that compiles, which has
rows of its own under [a new process](#a-new-process). In the groups `map` and `orbit`, and where a case says *a call*,
every timed call has other states, and restitutions go from 0.5 to 0.999; answers are judged by flights in balls, with
condition numbers of their own, where tau counts within one period: an error by rounding $\\omega\\tau$ is an error. A
peer that is too slow for all states has the first ones of the same states, and its row says how many."""
TITLES = {
    "map": "The impact map",
    "orbit": "Orbits and iterates",
    "regimes": "Hard states",
    "chatter": "The chatter limit",
    "threshold": "The threshold",
    "series": "Series",
    "fixed-points": "Fixed points",
    "emitted": "Emitted code",
    "figures": "Figures",
    "growth": "How cost grows",
    "commands": "Series in symbols and commands",
    "sweep": "A sweep of many cases",
    "scale": "Large arrays",
    "branches": "Periodic orbits and their branches",
    "start": "A new process",
}


def page(sections: Sequence[tuple[str, str]], pictures: str | None) -> str:
    """The page from groups and their tables, all pictures first.

    Parameters
    ----------
    sections : a group and its tables as Markdown.
    pictures : path of a picture, with `{}` for the group; without pictures None.

    Examples
    --------
    >>> written = page([("map", "| a |")], "p/{}.png")
    >>> print(written[written.index("## Plots") : written.index("## How")])
    ## Plots
    <BLANKLINE>
    **The impact map** ([table](#the-impact-map))
    <BLANKLINE>
    ![The impact map: time against error](p/map.png)
    <BLANKLINE>
    <BLANKLINE>
    >>> print(written.partition("## Tables")[2])
    <BLANKLINE>
    <BLANKLINE>
    ### The impact map
    <BLANKLINE>
    `singimpact bench map`
    <BLANKLINE>
    | a |
    """
    plots, tables = [], []
    for group, text in sections:
        title = TITLES[group]
        if pictures is not None:
            plots.append(f"**{title}** ([table](#{title.lower().replace(' ', '-')}))")
            plots.append(f"![{title}: time against error]({pictures.format(group)})")
        tables += [f"### {title}", f"`singimpact bench {group}`", text]
    return "\n\n".join([ABOUT, *(["## Plots", *plots] if plots else []), READING, "## Tables", *tables])
