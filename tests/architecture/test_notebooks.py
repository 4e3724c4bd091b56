"""What notebooks are committed as: run from top to bottom, with their pictures; .ci/check executes them again."""

import ast
import importlib
import json
import re

import pytest


@pytest.fixture(scope="module")
def notebooks(request):
    return {
        path.name: json.loads(path.read_text()) for path in sorted(request.config.rootpath.glob("notebooks/*.ipynb"))
    }


def test_nine_stories_in_order(notebooks):
    assert [name.partition("_")[0] for name in notebooks] == ["1", "2", "3", "4", "5", "6", "7", "8", "9"]


def test_what_a_notebook_imports_is_there(notebooks):
    """A file of the package that was renamed is renamed here too."""
    for name, notebook in notebooks.items():
        cells = ["".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code"]
        for imported in (node for cell in cells for node in ast.walk(ast.parse(cell))):
            if isinstance(imported, ast.ImportFrom) and imported.module.startswith("singimpact"):
                module = importlib.import_module(imported.module)
                assert all(hasattr(module, alias.name) for alias in imported.names), (name, imported.module)


def test_stored_as_run_with_pictures(notebooks):
    for name, notebook in notebooks.items():
        cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
        assert [cell["execution_count"] for cell in cells] == list(range(1, len(cells) + 1)), name
        outputs = [output for cell in cells for output in cell["outputs"]]
        assert not [output for output in outputs if output["output_type"] == "error" or output.get("name") == "stderr"]
        assert any("image/png" in output.get("data", {}) for output in outputs), name
        assert len(json.dumps(notebook)) < 600_000, name


def test_no_place_on_a_machine(notebooks):
    places = re.compile(r"/(home|root|tmp|Users|work|mnt)/|[A-Z]:\\\\")
    assert [name for name, notebook in notebooks.items() if places.search(json.dumps(notebook))] == []


def test_each_asks_a_question_and_ends_in_a_picture(notebooks):
    for name, notebook in notebooks.items():
        sources = ["".join(cell["source"]) for cell in notebook["cells"]]
        assert any("?" in text for text in sources), name
        assert "plt.subplots" in "".join(sources[len(sources) // 2 :]), name
