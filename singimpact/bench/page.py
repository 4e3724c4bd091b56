"""The pages of the documentation on run time and on numerical stability, each written by one command.

The first line of a page has a digest of the sources that it was measured with.
"""

import csv
import hashlib
import re
import tomllib
from collections.abc import Mapping, Sequence
from io import StringIO
from pathlib import Path

from singimpact.bench.measuring import Row
from singimpact.bench.report import in_words

TEXTS = tomllib.loads((Path(__file__).parent / "data" / "pages.toml").read_text(encoding="utf-8"))
COMMAND, STRESS_COMMAND = TEXTS["run-time"]["command"], TEXTS["stress"]["command"]
ABOUT, READING = TEXTS["run-time"]["about"], TEXTS["run-time"]["reading"].format(command=COMMAND)
STRESS_ABOUT = TEXTS["stress"]["about"].format(command=STRESS_COMMAND)
PEERS = ("heyoka", "scipy", "numba")
COLUMNS = ("case", "method", "setting", "microseconds", "ratio", "error", "wrong", "missed", "of")


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


def page(table: str, commit: str) -> str:
    """The page of run times, from its table as Markdown and the commit that was measured.

    Examples
    --------
    >>> "at commit `ab12`" in page("| a |", "ab12")
    True
    """
    plot = "![Time against error, a panel a call; lower and further left is better](benchmarks.png)"
    about = f"{opening(COMMAND, timed_digest())}\n{ABOUT}"
    return "\n\n".join([about, table, f"Measured at commit `{commit}`.", plot, READING])


def table(rows: Sequence[Row]) -> tuple[list[str], list[list[str]]]:
    """Header and cells of the page's table: a line a case, with the time and the error of its first row."""
    cases = {case: [row for row in rows if row.case == case] for case in dict.fromkeys(row.case for row in rows)}
    return ["call", "time", "error", *PEERS], [
        [case, in_words(own.microseconds), _error(own), *(_beside(peers, name) for name in PEERS)]
        for case, (own, *peers) in cases.items()
    ]


def _error(row: Row) -> str:
    return "" if row.error is None else f"{row.error:.0e}"


def _beside(rows: Sequence[Row], name: str) -> str:
    """A peer's time as a multiple, its error, and the answers that it missed; empty where it has no row."""
    parts = [
        (f"{float(f'{row.ratio:.2g}'):g} times", _error(row), f"{row.missed} of {row.of} missed" if row.missed else "")
        for row in rows
        if row.method == name
    ]
    return ", ".join(filter(None, parts[0] if parts else ()))


def as_csv(rows: Sequence[Row]) -> str:
    """All numbers of the page as text of a csv file."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([*COLUMNS, "lower_quartile", "upper_quartile"])
    writer.writerows([*(getattr(row, name) for name in COLUMNS), *row.spread] for row in rows)
    return text.getvalue()
