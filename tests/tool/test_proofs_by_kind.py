"""The table of what is proved for which kind of model says what the public calls give."""

import re
from pathlib import Path

import pytest

import singimpact as si
from singimpact.inputs import InputError

PAGE = Path(__file__).parents[2] / "docs" / "trust.md"
DAMPED, FORCED = "x + xdot/10", "cos(1.7*t)"
KINDS = {
    "forced": (DAMPED, FORCED, "0.6", {}),
    "two walls": (DAMPED, FORCED, "0.6", {"upper": "0.4"}),
    "$t$ in $f$": ("x*(1 + cos(1.7*t)/10) + xdot/10", FORCED, "0.6", {}),
    "no clock": ("x + (x**2 - 1)*xdot/5", "0", "0.6", {}),
    "no period": (DAMPED, f"{FORCED} + cos(sqrt(2)*t)/5", "0.6", {}),
    "restitution 0": (DAMPED, FORCED, "0", {}),
}


def model(kind, clearance):
    f, g, restitution, upper = KINDS[kind]
    return si.ImpactOscillator(f, g, clearance, restitution, **upper)


def orbit(kind):
    osc = model(kind, "-0.3")
    return (osc.periodic(1) if kind == "no clock" else osc.periodic("lu" if "walls" in kind else 1, 1))[0]


RESULTS = {
    "first impact": lambda kind: model(kind, "-0.3").impact_map("0.3", "1.2", digits=20),
    "chatter limit": lambda kind: model(kind, "0.3").chatter_limit("1.8", "1e-4", digits=20),
    "threshold": lambda kind: si.threshold(model(kind, "0.3"), "1.8", digits=20),
    "periodic orbit": lambda kind: orbit(kind).certified(20),
    "gamma": lambda kind: model(kind, "0.3").certified_gamma("2.6"),
}


def strength(result):
    """How much is known of a result, in the words of the table."""
    try:
        value = result()
    except InputError:
        return "-"
    if not getattr(value, "error", 0) < 1e-15:
        return "-"
    if getattr(value, "certified", value) is None:
        return "digits"
    try:
        si.certify(value).check()
    except InputError:
        return "certified"
    return "file"


@pytest.fixture(scope="module")
def table():
    """Row -> kind of model -> word."""
    text = PAGE.read_text(encoding="utf-8")
    rows = re.search(r"\| of \|.*?(?=\n\n)", text, re.DOTALL).group().splitlines()
    cells = [[cell.strip() for cell in row.strip("|").split("|")] for row in rows]
    return {row[0]: dict(zip(cells[0][1:], row[1:], strict=True)) for row in cells[2:]}


def test_the_table_has_every_kind_and_every_result(table):
    assert set(RESULTS) <= set(table)
    assert all(set(row) == set(KINDS) for row in table.values())


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", RESULTS)
def test_a_cell_is_what_the_call_gives(table, name, kind):
    assert table[name][kind] == strength(lambda: RESULTS[name](kind))
