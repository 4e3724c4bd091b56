"""Docstrings are plain text with formulas in ASCII: tau_*, |v|.  What Sphinx would take for markup is escaped."""

import re
from typing import Any

# a star, a bar, or the underscore at the end of a word begins markup in reStructuredText
MARKUP = re.compile(r"[*|]|(?<=\w)_(?=\W|$)")
FIELD = re.compile(r"^(\w+(?:, \w+)*) : (.*)$")
NEXT = re.compile(r"(?<=[.;]) (?=\w+(?:, \w+)* : )")  # several fields may share a line
NAMED = ("Parameters", "Attributes", "Returns", "Raises")


def readable(app: Any, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    """Escape all lines but those of examples; what stands behind a parameter describes it, and is not its type."""
    found: list[str] = []
    example, section = False, ""
    for index, line in enumerate(lines):
        if index + 1 < len(lines) and lines[index + 1].startswith("---"):
            section = line.strip()
        example = line.lstrip().startswith((">>>", "...")) or (example and bool(line.strip()))
        plain = line if example else MARKUP.sub(lambda hit: "\\" + hit.group(), line)
        for part in NEXT.split(plain) if section in NAMED else [plain]:
            field = FIELD.match(part) if section in NAMED else None
            found += [field[1], f"    {field[2]}"] if field else [part]
    lines[:] = found


def setup(app: Any) -> dict[str, Any]:
    """Before napoleon reads the sections."""
    app.connect("autodoc-process-docstring", readable, priority=100)
    return {"parallel_read_safe": True}
