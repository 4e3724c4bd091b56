"""A precision is set in one place: flint's is global, and `mpmath.mp` is the user's."""

import ast

import pytest

HOME = "algebra/precision.py"
# programs of other people, which are timed as their users write them: in mpmath.mp, in the command's own process
PEERS = ("bench/peers/", "bench/groups/", "bench/stress/", "bench/measuring.py")
CARRIERS = {"libmp", "ctx_mp", "nstr"}  # of mpmath: what reads no precision of the process


def faults(text, *kinds):
    """Lines that read or set a precision of the process: flint's context, or anything that computes in mpmath.mp."""
    return sorted({node.lineno for node in ast.walk(ast.parse(text)) if any(kind(node) for kind in kinds)})


def of_flint(node):
    if isinstance(node, ast.ImportFrom) and (node.module or "").partition(".")[0] == "flint":
        return any(alias.name in ("ctx", "*") for alias in node.names)
    named = isinstance(node, ast.Attribute) and node.attr == "ctx" and isinstance(node.value, ast.Name)
    return named and node.value.id == "flint"


def of_mpmath(node):
    if isinstance(node, ast.Import):
        return any(alias.name == "mpmath" or (alias.name == "flint" and alias.asname) for alias in node.names)
    if isinstance(node, ast.ImportFrom) and (node.module or "").partition(".")[0] == "mpmath":
        parts = (node.module or "").split(".")[1:] or [alias.name for alias in node.names]
        return not set(parts[:1] if len(parts) == 1 else parts) <= CARRIERS
    return False


def test_precision_is_set_in_one_place(clone):
    package = clone / "singimpact"
    texts = {path.relative_to(package).as_posix(): path.read_text() for path in package.rglob("*.py")}
    kinds = {path: (of_flint,) if path.startswith(PEERS) else (of_flint, of_mpmath) for path in texts}
    found = {path: faults(text, *kinds[path]) for path, text in texts.items()}
    assert found.pop(HOME)
    assert found.pop("certificates/checker/files.py")  # a program of its own, which runs in a process of its own
    assert {path: lines for path, lines in found.items() if lines} == {}


@pytest.mark.parametrize(
    "text",
    [
        "import flint\nwith flint.ctx.workprec(100):\n    pass",
        "from flint import ctx",
        "from flint import arb, ctx as precision",
        "import flint as f",
        "import mpmath\nwith mpmath.workdps(30):\n    pass",
        "import mpmath as mp",
        "from mpmath import mp, nstr",
        "def late():\n    from mpmath import workdps",
        "from mpmath import mpf",
    ],
)
def test_planted_precision_is_seen(text):
    assert faults(text, of_flint, of_mpmath)


@pytest.mark.parametrize(
    "text", ["import flint\nflint.arb(1)", "from mpmath.libmp import to_str", "from mpmath import nstr"]
)
def test_plain_use_is_no_fault(text):
    assert not faults(text, of_flint, of_mpmath)
