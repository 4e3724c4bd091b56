"""Coverage by room: lines that ran in the suite, from JSON of slipcover; fails where a room below `cli` has too few.

`python -m slipcover --json --out FILE -m pytest` writes such a file; lines of several runs count together. Settings
stand in pyproject.toml.
"""

import json
import sys
from collections import Counter
from pathlib import Path, PurePosixPath

LEAST = 90.0  # per cent of the lines of a room
ABOVE = {"cli"}  # rooms without a least figure: a command is tested by what it writes, often in a process of its own


def together(runs):
    """File -> lines that ran in one of the runs, and those that ran in none."""
    found = {}
    for files in runs:
        for name, lines in files.items():
            ran, missing = found.setdefault(name, (set(), set()))
            ran |= set(lines["executed_lines"])
            missing |= set(lines["missing_lines"])
    return {name: {"executed_lines": ran, "missing_lines": missing - ran} for name, (ran, missing) in found.items()}


def rooms(files):
    """Room -> (lines that ran, lines); the files beside the rooms are "the ground"."""
    ran, lines = Counter(), Counter()
    for name, found in files.items():
        inner = PurePosixPath(name.replace("\\", "/").rpartition("singimpact/")[2])
        room = inner.parts[0] if len(inner.parts) > 1 else "the ground"
        ran[room] += len(found["executed_lines"])
        lines[room] += len(found["executed_lines"]) + len(found["missing_lines"])
    return {room: (ran[room], lines[room]) for room in sorted(lines) if lines[room]}


def too_few(found):
    """The rooms below `cli` of which too few lines ran."""
    return [room for room, (ran, lines) in found.items() if room not in ABOVE and 100 * ran < LEAST * lines]


def main(*paths):
    found = rooms(together(json.loads(Path(path).read_text(encoding="utf-8"))["files"] for path in paths))
    print("Lines that ran, by room:")
    for room, (ran, lines) in found.items():
        print(f"{room:12} {ran:6} of {lines:6}  {100 * ran / lines:5.1f} %")
    short = too_few(found)
    if short:
        print(f"below {LEAST:g} %: {', '.join(short)}")
    return bool(short)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
