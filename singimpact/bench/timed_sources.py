"""A digest of the sources that `docs/benchmarks.md` and `docs/stress.md` were measured with.

Each file counts by the name that git gives its content, so the digest of any commit comes from `git ls-tree` alone.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping
from pathlib import Path

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
