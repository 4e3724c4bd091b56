"""The pages of the documentation on run time and on numerical stability, each written by one command.

The first line of a page has a digest of the sources that it was measured with.
"""

import hashlib
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

COMMAND = "singimpact bench --format page --plots docs/benchmarks -o docs/benchmarks.md"
ABOUT = """# Run time against error

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
*kernel* time a private function. CPU time includes that of child processes. In the groups `map` and `orbit`, and where
a case says *a call*, every timed call has other states, and restitutions go from 0.5 to 0.999; answers are judged by
flights in balls, with condition numbers of their own, where tau counts within one period: an error by rounding
$\\omega\\tau$ is an error. A peer that is too slow for all states has the first ones of the same states, and its row
says how many."""
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
    "limit": "Figures to reach",
}
STRESS_COMMAND = "singimpact stress --format page -o docs/stress.md"
STRESS_ABOUT = f"""# Stress: next to every bad place

Each public numerical function is driven towards each place that is hard for it, geometrically, on both sides where
there are two, and its error is measured against 60 digits: $v \\to 0$, $t \\to 0$, resonance, $r \\to 0$ and
$r \\to 1$, a tangency ($a \\to 0$), a swan ($a' \\to 0$), the outline $P$, the zero set $Z$, phases far from zero,
long flights. One unit is what rounding of the inputs alone must cost: $\\varepsilon$ times the size of the value
and of what a relative change of each input does to it. Over 100 units is a failure, and the command ends with exit
code 1; `inf` would be a wrong status.

These are the results of one run of

```sh
{STRESS_COMMAND}
```

`--quick` takes fewer points, and a name or `--place` restricts it."""


# The digest of the sources that `docs/benchmarks.md` and `docs/stress.md` were measured with. Each file counts by the
# name that git gives its content, so the digest of any commit comes from `git ls-tree` alone.

ROOMS = (
    "algebra",
    "bench",
    "branches",
    "codegen",
    "contact",
    "dynamics",
    "flights",
    "generated",
    "oscillator",
    "surface",
    "theory",
)
RECORDED = re.compile(r"from sources ([0-9a-f]{64}); do not edit -->")


def digest_of(files: Mapping[str, str]) -> str:
    """The digest of timed sources.

    Parameters
    ----------
    files : path below the package's folder, such as "flights/state.py" -> git's name of its content; files outside the
        timed rooms, and those that are not Python, are left out.

    Examples
    --------
    >>> digest_of({"flights/a.py": "1", "cli/b.py": "2"}) == digest_of({"flights/a.py": "1", "cli/b.py": "3"})
    True
    >>> digest_of({"flights/a.py": "1"}) == digest_of({"flights/a.py": "2"})
    False
    """
    timed = sorted(path for path in files if path.endswith(".py") and path.partition("/")[0] in ROOMS)
    return hashlib.sha256("".join(f"{path} {files[path]}\n" for path in timed).encode()).hexdigest()


def timed_digest() -> str:
    """The digest of the timed sources of this package as they lie on disk."""
    package = Path(__file__).parents[1]
    return digest_of(
        {path.relative_to(package).as_posix(): _named(path.read_bytes()) for path in package.rglob("*.py")}
    )


def recorded(page: str) -> str | None:
    """The digest that a page names, or None.

    Examples
    --------
    >>> recorded("<!-- written by hand -->") is None
    True
    """
    found = RECORDED.search(page)
    return None if found is None else found[1]


def _named(content: bytes) -> str:
    """Git's name of a file with this content."""
    return hashlib.sha1(b"blob %d\0" % len(content) + content, usedforsecurity=False).hexdigest()


def opening(command: str, digest: str) -> str:
    """The first line of a page: the command that wrote it, and the digest of the sources that it measured."""
    return f"<!-- written by `{command}` from sources {digest}; do not edit -->"


def stress_page(tables: str) -> str:
    """The page on numerical stability, from its tables as Markdown.

    Examples
    --------
    >>> print(stress_page("| a |").splitlines()[1])
    # Stress: next to every bad place
    """
    return f"{opening(STRESS_COMMAND, timed_digest())}\n{STRESS_ABOUT}\n\n{tables}"


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
    about = f"{opening(COMMAND, timed_digest())}\n{ABOUT}"
    return "\n\n".join([about, *(["## Plots", *plots] if plots else []), READING, "## Tables", *tables])
