"""README: its example runs, its commands write what they should; CONTRIBUTING names every room."""

import doctest
import re
import shlex
import subprocess
import sys
import tomllib

import matplotlib.image as mpimg
import pytest

import singimpact
from singimpact.cli import COMMANDS


@pytest.fixture
def readme(clone):
    return (clone / "README.md").read_text()


def test_three_lines_draw_the_picture_beside_them(readme, clone, tmp_path, monkeypatch):
    """Python blocks in order, as one session; it writes the picture that stands below the first."""
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", readme, re.DOTALL)
    assert blocks
    parser, runner = doctest.DocTestParser(), doctest.DocTestRunner(verbose=False)
    session = parser.get_doctest("\n".join(blocks), {}, "README.md", "README.md", 0)
    told = []
    runner.run(session, out=told.append)
    assert runner.summarize(verbose=False).failed == 0, "".join(told)
    drawn, shown = (mpimg.imread(place / "basins.png")[..., :3] for place in (tmp_path, clone / "docs" / "pictures"))
    assert drawn.shape == shown.shape
    assert abs(drawn - shown).mean() < 0.01
    assert abs(drawn - shown[:, ::-1]).mean() > 0.1  # another picture is told from it
    assert readme.index("basins.png") < readme.index("## ")  # before any heading


def test_two_commands(readme):
    (block,) = re.findall(r"```sh\n(.*?)```", readme, re.DOTALL)
    assert block.splitlines() == [
        "python -m pip install . && singimpact verify",
        "python -m pip install '.[test]' && python -m pytest",
    ]


def test_one_sentence_says_what_it_is(clone):
    """In the metadata, the package and the command."""
    project = tomllib.loads((clone / "pyproject.toml").read_text())["project"]
    told = subprocess.run([sys.executable, "-m", "singimpact", "--help"], capture_output=True, text=True, check=True)
    assert singimpact.__doc__.startswith(f"{project['description']}.")
    assert f"{project['description']}." in " ".join(told.stdout.split())
    minors = re.search(r"for minor in ([\d ]+);", (clone / ".ci" / "release").read_text())[1].split()
    pythons = [line for line in project["classifiers"] if line.startswith("Programming Language :: Python :: 3.")]
    assert pythons == [f"Programming Language :: Python :: 3.{minor}" for minor in minors]


def test_optional_parts_are_named_where_a_user_looks(readme, clone):
    extras = tomllib.loads((clone / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    table = (clone / "docs" / "install.md").read_text().partition("## Install optional parts")[2]
    assert [name for name in extras if f"pip install '.[{name}]'" not in table] == []
    assert [name for name in extras if f"`{name}`" not in readme and f"[{name}]" not in readme] == []


def lines_of(readme):
    return re.findall(r"^singimpact +(.*)$", readme, re.MULTILINE)


WRITES = {"orbit": ["orbit.png"], "bifurcation": ["bifurcation.png"], "branch": ["branch.png"],
          "basins": ["basins.png"], "figure": ["pictures/figure17.png"]}  # fmt: skip
SAYS = {"threshold": r"v +0\.10086999126", "classify": "negative", "derive": "def ", "verify": "e:meq.*proved",
        "branch": "graze", "basins": r"\(3, 3\) orbit", "bifurcation": "300 values"}  # fmt: skip


def test_the_command_alone_names_three_that_run(tmp_path):
    program = [sys.executable, "-m", "singimpact"]
    alone = subprocess.run(program, capture_output=True, text=True, check=True).stdout.splitlines()
    assert len(alone) == 6
    lines = [line.partition("   ")[0].split() for line in map(str.strip, alone) if line.startswith("singimpact ")]
    assert [line[1] for line in lines] == ["orbit", "bifurcation", "verify"]
    for line in lines[:2]:
        subprocess.run([*program, *line[1:]], cwd=tmp_path, check=True, stdout=subprocess.DEVNULL)
        assert (tmp_path / line[-1]).is_file()


def test_commands_exist(readme):
    shown = lines_of(readme)
    assert {line.split()[0] for line in shown} <= set(COMMANDS)
    assert {line.split()[0] for line in shown} == {*WRITES, *SAYS}


@pytest.mark.slow
def test_commands_run_as_printed(readme, tmp_path):
    (model,) = re.findall(r"```toml\n(.*?)```", readme, re.DOTALL)
    (tmp_path / "duffing.toml").write_text(model)
    for line in lines_of(readme):
        command = [sys.executable, "-m", "singimpact", *shlex.split(line)]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
        name = line.split()[0]
        assert done.returncode == 0, done.stderr
        assert re.search(SAYS.get(name, ""), done.stdout), done.stdout
        for path in WRITES.get(name, ()):
            assert (tmp_path / path).stat().st_size > 10_000
            assert (tmp_path / path).read_bytes()[1:4] == b"PNG"


def test_links_and_pictures_are_there(clone, readme):
    links = re.findall(r"\]\(([^)#:]+)\)", readme)
    assert len(links) > 12
    assert [link for link in links if not (clone / link).is_file()] == []


def test_every_room_is_in_the_table(clone):
    rooms = {path.parent.name for path in (clone / "singimpact").glob("*/__init__.py")}
    table = (clone / "CONTRIBUTING.md").read_text().partition("## Which room")[2].partition("\n## ")[0]
    assert {room for room in rooms if f"`{room}`" not in table} == set()


def test_a_flight_is_flown_in_at_most_ten_ways_that_are_there(clone):
    table = (clone / "CONTRIBUTING.md").read_text().partition("## Ways to fly")[2].partition("\n## ")[0]
    ways = [line.split("|")[1] for line in table.splitlines() if line.startswith("| `")]
    assert 5 <= len(ways) <= 10
    named = [name for way in ways for name in re.findall(r"`([^`]+)`", way) if name != "tests"]
    paths = [clone / "singimpact" / name for name in named]
    assert [path for path in paths if not path.exists() and not path.with_suffix(".py").exists()] == []
