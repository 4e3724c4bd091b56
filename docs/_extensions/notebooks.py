"""The notebooks of the repository as pages, with the outputs that they are stored with."""

import base64
import json
import re
from pathlib import Path
from typing import Any

from computed import put
from latex2mathml.converter import convert

FORMULA = re.compile(r"\$([^$<>]+)\$")
TABLES = re.compile(r"<(table|style|svg|img)\b")


def lines_of(text: Any) -> str:
    """Text of a notebook, which is a list of lines or one string."""
    return "".join(text)


def fenced(language: str, text: str) -> str:
    """A block of a page, between fences longer than any inside it."""
    fence = "`" * max(3, 1 + max(map(len, re.findall("`+", text)), default=0))
    return f"{fence}{language}\n{text.rstrip()}\n{fence}"


def shown(output: dict[str, Any], picture: Path) -> str:
    """One output of a cell: a picture in a file of its own, a formula, a table or text."""
    data = output.get("data", {})
    if "image/png" in data:
        content = base64.b64decode(lines_of(data["image/png"]))
        if not picture.exists() or picture.read_bytes() != content:
            picture.write_bytes(content)
        return f"![What the lines above draw]({picture.name})"
    if lines_of(data.get("text/latex", "")):
        return f"$${lines_of(data['text/latex']).strip().strip('$')}$$"
    html = lines_of(data.get("text/html", ""))
    if TABLES.search(html):
        formulas = FORMULA.sub(lambda hit: f'<div class="formula">{convert(hit[1])}</div>', html)
        return fenced("{raw} html", f'<div class="notebook-output">{formulas}</div>')
    text = lines_of(output.get("text", data.get("text/plain", "")))
    return fenced("text", text) if text.strip() else ""


def page(notebook: Path, folder: Path) -> str:
    """A page with the cells of a notebook and a link to it; its pictures are written into the folder."""
    title, *cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
    source = Path("..", "..", "..", "notebooks", notebook.name)
    heading, _, words = lines_of(title["source"]).partition("\n")
    parts = [heading, f"{{download}}`Download this notebook <{source.as_posix()}>`", words.strip()]
    for number, cell in enumerate(cells):
        text = lines_of(cell["source"])
        parts.append(text if cell["cell_type"] == "markdown" else fenced("python", text))
        for index, output in enumerate(cell.get("outputs", [])):
            parts.append(shown(output, folder / f"{notebook.stem}_{number}_{index}.png"))
    return "\n\n".join(part for part in parts if part) + "\n"


def build(app: Any) -> None:
    """Write a page for each notebook beside the other computed pages."""
    folder = Path(app.srcdir) / "computed" / "notebooks"
    folder.mkdir(parents=True, exist_ok=True)
    for notebook in sorted((Path(app.srcdir).parent / "notebooks").glob("*.ipynb")):
        put(folder / f"{notebook.stem}.md", page(notebook, folder))


def setup(app: Any) -> dict[str, Any]:
    """Before Sphinx looks for pages."""
    app.connect("builder-inited", build)
    return {"parallel_read_safe": True}
