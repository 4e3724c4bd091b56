"""Ratios of public calls to a reference computation: stored for every row, and a row that costs more fails."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from singimpact.bench import Aim
from singimpact.bench.groups import limit_rows
from singimpact.bench.measuring import QUICK, Row

CASES = {case.name: case for case in limit_rows.cases(QUICK)}
ROW = Row("limit", "arrays", "singimpact, f", "ten", 3.0, None, None, None, 1, 3.0, (2.9, 3.1), 3, Aim(), None)


def test_a_ratio_that_has_grown_by_half_is_over(monkeypatch, tmp_path):
    monkeypatch.setattr(limit_rows, "STORED", tmp_path / "limits.json")
    limit_rows.store([ROW])
    assert json.loads(limit_rows.STORED.read_text()) == {"arrays: f, ten": 3.0}
    assert limit_rows.over([ROW, replace(ROW, spread=(4.4, 9.0))]) == []
    assert limit_rows.over([replace(ROW, spread=(4.6, 9.0))]) == ["arrays: f, ten: 4.6 times the reference, 3 stored"]
    assert len(limit_rows.over([replace(ROW, method="singimpact, g")])) == 1  # not stored
    assert limit_rows.over([replace(ROW, group="map")]) == []


def test_launches_and_flights_between_walls_cost_few_first_hits(monkeypatch, tmp_path):
    monkeypatch.setattr(limit_rows, "STORED", tmp_path / "limits.json")
    hit, launch = (
        replace(ROW, method=f"singimpact, {name}", setting="linear, array") for name in ("first_hit", "launch")
    )
    slow = replace(launch, ratio=6.0, spread=(5.9, 6.1))
    limit_rows.store([hit, slow])
    assert limit_rows.over([hit, slow]) == ["arrays: launch, linear, array: 2.03 times first_hit, at most 2"]
    assert limit_rows.over([hit, replace(launch, spread=(5.7, 6.1))]) == []
    between = replace(slow, method="singimpact, between walls", spread=(4.6, 6.1))
    limit_rows.store([hit, between])
    assert limit_rows.over([hit, between]) == [
        "arrays: between walls, linear, array: 1.59 times first_hit, at most 1.5"
    ]
    keys = json.loads((limit_rows.Path(limit_rows.__file__).parents[1] / "data" / "limits.json").read_text())
    beside = [(key, key.replace(f": {name},", f": {plain},"), most)
              for name, (plain, most) in limit_rows.BESIDE.items() for key in keys if f": {name}," in key]  # fmt: skip
    assert len(beside) >= 9
    for key, plain, most in beside:
        assert keys[key] <= most * keys[plain]


def test_every_row_has_a_stored_ratio():
    rows = [
        replace(ROW, case=case.name, method=method.name, setting=method.setting)
        for case in CASES.values()
        for method in case.methods
    ]
    names = [name for name, _ in limit_rows._named(rows)]
    assert len(set(names)) == len(names)
    assert set(json.loads(limit_rows.STORED.read_text())) == set(names)


@pytest.mark.parametrize("name", ["arrays", "calls"])
def test_every_call_ends(name):
    """Each once: a row whose call raises would be missed by the command alone."""
    for method in CASES[name].methods:
        method.run(*(() if method.draw is None else (replace(method.draw, count=200)(),)))


def test_ratios_are_stored_with_their_group_alone(singimpact):
    before = limit_rows.STORED.read_text()
    refused = singimpact("bench", "chatter", "--quick", "--store")
    assert "give the group limit" in refused.output
    assert limit_rows.STORED.read_text() == before
