"""Run the notebooks and store their outputs: `python notebooks/run.py [FILE ...]`; it needs the extra `test`."""

import sys
from pathlib import Path

import nbformat
from nbclient import NotebookClient


def run(path: Path) -> None:
    """Run one notebook in place; what depends on the run alone is left out."""
    book = nbformat.read(path, as_version=4)
    NotebookClient(
        book, timeout=400, kernel_name="python3", resources={"metadata": {"path": str(path.parent)}}
    ).execute()
    for cell in (each for each in book.cells if each.cell_type == "code"):
        cell.metadata.pop("execution", None)
        cell.outputs = [each for each in cell.outputs if each.get("name") != "stderr"]
        for output in cell.outputs:
            output.get("metadata", {}).clear()
    book.metadata = {
        "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
        "language_info": {"name": "python"},
    }
    nbformat.write(book, path)


if __name__ == "__main__":  # pytest imports this file when it collects the folder
    for name in sys.argv[1:] or sorted(map(str, Path(__file__).parent.glob("*.ipynb"))):
        run(Path(name))
