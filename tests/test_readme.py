"""README: its example runs and prints what it says, its commands are the ones CI runs, its table names every room."""

import doctest
import re

import pytest

from singimpact.cli.group import COMMANDS


@pytest.fixture
def readme(clone):
    return (clone / "README.md").read_text()


def test_example_prints_what_it_says(readme):
    """Python blocks in order, as one session."""
    blocks = re.findall(r"```python\n(.*?)```", readme, re.DOTALL)
    assert blocks
    parser, runner = doctest.DocTestParser(), doctest.DocTestRunner(verbose=False)
    session = parser.get_doctest("\n".join(blocks), {}, "README.md", "README.md", 0)
    told = []
    runner.run(session, out=told.append)
    assert runner.summarize(verbose=False).failed == 0, "".join(told)


def test_two_commands(readme):
    (block,) = re.findall(r"```sh\n(.*?)```", readme, re.DOTALL)
    assert block.splitlines() == [
        "python -m pip install . && singimpact verify",
        "python -m pip install '.[test]' && python -m pytest",
    ]


def test_commands_that_are_shown_exist(readme):
    shown = re.findall(r"^singimpact +([a-z-]+)", readme, re.MULTILINE)
    assert set(shown) == set(COMMANDS)


def test_every_room_is_in_the_table(clone, readme):
    rooms = {path.parent.name for path in (clone / "singimpact").glob("*/__init__.py")}
    table = readme.partition("## Which room")[2].partition("##")[0]
    assert {room for room in rooms if f"`{room}`" not in table} == set()
