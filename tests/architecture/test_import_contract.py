"""The direction of imports holds, and each contract catches the violation it is there for."""

import shutil
import subprocess
import sys

import pytest

# a file of the planted copy -> what is put at its end, and the contract that must break
PLANTED = {
    "direction": ("algebra/numbers.py", "from singimpact.oscillator import model", "An import points downwards only"),
    "inside a function": (
        "algebra/numbers.py",
        "def late() -> None:\n    from singimpact.oscillator import model",
        "An import points downwards only",
    ),
    "neighbours": ("algebra/numbers.py", "from singimpact import generated", "An import points downwards only"),
    "through the root": ("status.py", "from singimpact import cli", "An import points downwards only"),
    "a room nobody listed": ("helpers/__init__.py", "", "An import points downwards only"),
    "frozen source": (
        "oscillator/model.py",
        "from singimpact import generated",
        "Theory and all below it work with generated/ emptied",
    ),
    "frozen source, theory": (
        "theory/planted.py",
        "from singimpact import generated",
        "Theory and all below it work with generated/ emptied",
    ),
    "flows": (
        "flights/enclosures/analytic_flow.py",
        "from singimpact.flights.kernels import roots",
        "Balls and kernels are witnesses of each other",
    ),
    "routes": (
        "paper/routes/implicit.py",
        "from singimpact.theory import sheet",
        "The paper's routes and the theory share no solver",
    ),
    "routes, inside a function": (
        "paper/routes/swan.py",
        "def late() -> None:\n    from singimpact.theory.gamma_series import invariant_curve",
        "The paper's routes and the theory share no solver",
    ),
    "theory takes a route": (
        "theory/planted.py",
        "from singimpact.paper.routes import fold",
        "An import points downwards only",
    ),
    "trials that know their claim": (
        "paper/trials/arcs.py",
        "from singimpact.paper.claims import verifiers",
        "In the room of the paper an import points downwards only",
    ),
    "a user's picture of the paper": (
        "scenes/orbit_picture.py",
        "from singimpact.paper.figures import panel",
        "An import points downwards only",
    ),
}


def contracts(folder):
    """The contracts of the package in a folder: what lint-imports prints, and whether all are kept."""
    command = [sys.executable, "-c", "from importlinter.cli import lint_imports_command; lint_imports_command()"]
    done = subprocess.run([*command, "--no-cache"], cwd=folder, capture_output=True, text=True, check=False)
    return done.stdout + done.stderr, done.returncode == 0


@pytest.fixture
def copy(clone, tmp_path):
    shutil.copy(clone / ".importlinter", tmp_path)
    shutil.copytree(clone / "singimpact", tmp_path / "singimpact", ignore=shutil.ignore_patterns("__pycache__", "data"))
    return tmp_path


def add(package, path, text=""):
    """Put a text at the end of a file of the copy, with the packages above it."""
    file = package / path
    for room in reversed(list(file.relative_to(package).parents)[:-1]):
        (package / room).mkdir(exist_ok=True)
        (package / room / "__init__.py").touch()
    file.touch()
    file.write_text(f"{file.read_text()}\n{text}\n")


def test_contracts_are_kept(clone):
    told, kept = contracts(clone)
    assert kept, told


def test_a_copy_is_kept(copy):
    told, kept = contracts(copy)
    assert kept, told


@pytest.mark.parametrize("name", PLANTED)
def test_violation_is_caught(name, copy):
    path, text, contract = PLANTED[name]
    add(copy / "singimpact", path, text)
    told, kept = contracts(copy)
    assert not kept
    assert f"{contract} BROKEN" in told, told
