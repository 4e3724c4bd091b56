"""What notebooks are committed as: without outputs, without a place on a machine; .ci/check executes them."""

import json
import re

import pytest


@pytest.fixture(scope="module")
def notebooks(request):
    return {
        path.name: json.loads(path.read_text()) for path in sorted(request.config.rootpath.glob("notebooks/*.ipynb"))
    }


def test_seven_stories_in_order(notebooks):
    assert [name.partition("_")[0] for name in notebooks] == ["1", "2", "3", "4", "5", "6", "7"]


def test_no_outputs(notebooks):
    cells = [cell for notebook in notebooks.values() for cell in notebook["cells"] if cell["cell_type"] == "code"]
    assert len(cells) > 20
    assert not any(cell["outputs"] or cell["execution_count"] for cell in cells)


def test_no_place_on_a_machine(notebooks):
    places = re.compile(r"/(home|root|tmp|Users|work|mnt)/|[A-Z]:\\\\")
    assert [name for name, notebook in notebooks.items() if places.search(json.dumps(notebook))] == []


def test_each_asks_a_question_and_ends_in_a_picture(notebooks):
    for name, notebook in notebooks.items():
        sources = ["".join(cell["source"]) for cell in notebook["cells"]]
        assert any("?" in text for text in sources), name
        assert "plt.subplots" in "".join(sources[len(sources) // 2 :]), name
