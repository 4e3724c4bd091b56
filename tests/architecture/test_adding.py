"""Adding costs as many files as CONTRIBUTING says: a toy of each kind is added to a copy of the package and run."""

import json
import os
import re
import shutil
import subprocess
import sys

import pytest

MOST_FILES = 3


@pytest.fixture(scope="module")
def copy(clone_of_module, tmp_path_factory):
    """A copy of the package and of what freezes it, to which all toys are added."""
    folder = tmp_path_factory.mktemp("copy")
    skipped = shutil.ignore_patterns("__pycache__")
    for name in ("singimpact", "derivations"):
        shutil.copytree(clone_of_module / name, folder / name, ignore=skipped)
    (folder / "tests/paper/sections/golden").mkdir(parents=True)
    return folder


@pytest.fixture(scope="module")
def clone_of_module(request):
    return request.config.rootpath


def run(folder, *words):
    """What a command of the copy prints."""
    environment = os.environ | {"PYTHONPATH": str(folder)}
    done = subprocess.run(
        [sys.executable, *words], cwd=folder, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def put(folder, path, old, new):
    """Put a text in the place of another, which occurs once."""
    file = folder / path
    text = file.read_text(encoding="utf-8")
    assert text.count(old) == 1
    file.write_text(text.replace(old, new), encoding="utf-8")


def steps(clone, heading):
    """Files that CONTRIBUTING names in the list of what is added."""
    text = (clone / "CONTRIBUTING.md").read_text(encoding="utf-8")
    row = next(line for line in text.splitlines() if line.startswith(f"- **{heading}**"))
    return re.findall(r"`((?:singimpact|tests|docs)/[^`]*)`", row)


@pytest.mark.parametrize("heading", ["an event", "a claim", "a command", "a bench row"])
def test_at_most_three_files_are_named(clone, heading):
    assert 0 < len(steps(clone, heading)) <= MOST_FILES


def test_a_command(copy, clone):
    assert steps(clone, "a command")[:2] == ["singimpact/cli/NAME_command.py", "singimpact/cli/group.py"]
    (copy / "singimpact/cli/toy_command.py").write_text(
        '"""`singimpact toy`: a word."""\n\nimport click\n\n\n@click.command()\ndef toy_command() -> None:\n'
        '    """Print a word."""\n    click.echo("a word")\n'
    )
    put(copy, "singimpact/cli/group.py", '    "cite": ', '    "toy": "a word",\n    "cite": ')
    assert run(copy, "-m", "singimpact", "toy") == "a word\n"
    assert "toy           a word" in run(copy, "-m", "singimpact", "--help")


def test_a_claim(copy, clone):
    section = "singimpact/paper/claims/sections/SECTION"
    assert steps(clone, "a claim") == [f"{section}.py", f"{section}.toml"]
    put(
        copy,
        "singimpact/paper/claims/sections/section2.py",
        "CLAIMS = {\n",
        'CLAIMS = {\n    "toy": Encoding(\n        sympy.Integer(2),\n'
        "        lambda value: every([('1 + 1', is_zero(value - 2))]),\n        (sympy.Integer(3),),\n    ),\n",
    )
    with (copy / "singimpact/paper/claims/sections/section2.toml").open("a") as words:
        words.write("\n[toy]\nsection = '2.1'\ntitle = 'one and one'\nprinted = '1+1=2'\n")
    verdicts = json.loads(run(copy, "-m", "singimpact", "verify", "toy", "--json"))["claims"]
    assert {verdict["id"]: verdict["verdict"] for verdict in verdicts} == {"toy": "proved"}


def test_a_bench_row(copy, clone):
    assert steps(clone, "a bench row") == ["singimpact/bench/groups/GROUP_rows.py"]
    put(
        copy,
        "singimpact/bench/groups/impact_map_rows.py",
        'states_case("duffing", 0.7, 1, effort)',
        'states_case("duffing", 0.9, 1, effort)',
    )
    assert "Duffing, r = 0.9, 1 state a call" in run(copy, "-m", "singimpact", "bench", "chatter", "--quick")


TOY_EVENT = '''"""Toys: the velocity of the first impact is 0.3."""

from singimpact.branches.events.kind import EventKind, Indexed
from singimpact.branches.events.kind import NUDGE, OrbitState, Test


class Toy(EventKind):
    """A velocity of 0.3."""

    name = "toy"
    word = "toy"
    marker = "h"

    def tests(self, state: OrbitState) -> Indexed:
        """v - 0.3 and its rate."""
        value = self.value(state, 0)
        yield 0, 0, Test(value, (self.value(state.beside, 0) - value) / NUDGE)

    def value(self, state: OrbitState, impact: int) -> float:
        """v - 0.3."""
        return float(state.at[state.closing.n]) - 0.3


TOY = Toy()
'''
FOLLOWED = """
import singimpact as si

model = si.ImpactOscillator("x + 0.1*xdot", "-A*cos(0.8*t)", -1, "0.8", {"A": "0.45"})
branch = si.branch(model.periodic(1, 1)[0], "A", (0.38, 0.6))
print([(event.kind, round(float(event.orbit.v[0]), 9)) for event in branch.events if event.kind == "toy"])
"""


def test_an_event(copy, clone):
    table = "singimpact/branches/events/table.py"
    assert steps(clone, "an event")[:2] == ["singimpact/branches/events/NAME.py", table]
    (copy / "singimpact/branches/events/toy.py").write_text(TOY_EVENT)
    text = (copy / table).read_text(encoding="utf-8")
    text = text.replace("    FOLD, ", "    TOY, FOLD, ").replace("    FOLD,\n", "    TOY,\n    FOLD,\n")
    (copy / table).write_text(text.replace("\nKINDS", "from singimpact.branches.events.toy import TOY\n\nKINDS"))
    assert run(copy, "-c", FOLLOWED) == "[('toy', 0.3)]\n"
