"""Every group at its smallest size: what is ours is right, what is absent is named, what is wrong is counted."""

from __future__ import annotations

import csv
import json
import re
import sys

import numpy as np
import pytest
from click.testing import CliRunner

from singimpact.bench import (
    ABOUT,
    COMMAND,
    FULL,
    GROUPS,
    KINDS,
    NO_AIM,
    QUICK,
    READING,
    RESTITUTIONS,
    Draws,
    Effort,
    Measured,
    Row,
    as_data,
    flights,
    growth,
    in_words,
    measured,
    numbers,
    orbit,
    taylor_stepper,
    timed_digest,
    usual,
)
from singimpact.bench.groups import series_rows
from singimpact.cli import main

SMALL = Effort(quick=True, rounds=1, least=0, once=0, fresh=1, judged=4)
COSTLY = ("public", "series")
EVENTS = {"scipy DOP853, terminal event", "heyoka, terminal event"}
PEERS = {
    "public": {"heyoka", "scipy", "numba"},
    "chatter": {"scipy DOP853, 1e-9", "heyoka, 1e-9", *EVENTS},
    "series": {"sympy, integrals and series", "sympy, implicit function"},
    "regions": {"numba", "scipy DOP853, terminal event"},
    "ensemble": set(),
    "fit": {"scipy DOP853, terminal event"},
    "limit": {"reference"},  # a command of .ci/check measures it
}
CUT = ("order", "tolerance")  # settings at which an answer is not meant to have all digits


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow if name in COSTLY else ()) for name in GROUPS if name != "limit"]
)
def test_group_at_its_smallest_size(name):
    pytest.importorskip("heyoka")
    found = measured(name, SMALL)
    ours = [row for row in found.rows if row.method.startswith("singimpact")]
    assert {row.method for row in found.rows} - {row.method for row in ours} == PEERS[name]
    assert all(row.microseconds > 0 for row in found.rows)
    judged = [row for row in ours if row.wrong is not None and not row.setting.startswith(CUT)]
    assert [row for row in judged if row.wrong] == []
    assert judged or name in ("series", "regions", "ensemble")
    assert not found.skipped


def test_growth_is_the_power_of_a_known_law():
    """Of whole times, by method, where there is more than one size; a constant is no growth."""

    def row(method, problems, microseconds, case="a case"):
        return Row("fit", case, method, "", microseconds, *(None,) * 3, 1, 1.0, (1.0, 1.0), 3, NO_AIM, None, problems)

    rows = [row("square", n, 3.0 * n) for n in (10, 40, 160)] + [row("even", n, 2.0) for n in (10, 40)]
    found = Measured("fit", [*rows, row("alone", 10, 1.0), row("square", 10, 1.0, "another")])
    assert growth(found) == [("a case", "square", pytest.approx(2)), ("a case", "even", pytest.approx(1))]
    assert as_data(found)["growth"][0] == {"case": "a case", "method": "square", "power": pytest.approx(2)}
    assert growth(Measured("series", rows)) == []


@pytest.mark.slow
@pytest.mark.parametrize("name", ["regions", "ensemble", "fit"])
def test_times_of_many_models_grow_with_their_number(name):
    """No faster: members, orbits and places do not slow each other down; one run of three, as machines are busy."""
    for _ in range(3):
        powers = [power for _, method, power in growth(measured(name, QUICK)) if method.startswith("singimpact")]
        assert powers
        if max(powers) < 1.3:
            break
    assert max(powers) < 1.3


@pytest.mark.parametrize("kind", KINDS)
def test_every_call_has_other_states(kind):
    """And every method has the same ones, in the same order."""
    made = [Draws("linear", kind, n) for n in (50, 20)]
    first, few = [each() for each in made]
    assert np.array_equal(few.tau, first.tau[:20])
    assert np.array_equal(few.v, first.v[:20])
    second = made[0]()
    assert not np.isin(second.tau, first.tau).any()
    assert not np.isin(second.v, first.v).any()


def test_restitutions_are_taken_in_turn():
    draw = Draws("linear", "generic", 1)
    assert [draw().restitution for _ in range(6)] == [*RESTITUTIONS, RESTITUTIONS[0]]
    assert (min(RESTITUTIONS), max(RESTITUTIONS)) == (0.5, 0.999)


def test_groups_of_a_quick_look(singimpact):
    assert set(GROUPS) == {*usual(FULL), "public"} == set(PEERS)
    assert set(GROUPS) - set(usual(QUICK)) == {"public", "limit"}
    told = " ".join(singimpact("bench", "--help").stdout.split())
    assert [name for name in GROUPS if name not in told] == []


def test_peers_miss_what_they_are_known_to_miss():
    """Chatter: the root is 1e-12 away from the trivial one, and a terminal event does not see it."""
    rows = [row for row in measured("chatter", SMALL).rows if row.method.endswith("1e-9")]
    assert rows
    assert all(row.wrong == row.missed == 1 for row in rows)


def test_peer_that_is_not_installed_is_named(monkeypatch, singimpact):
    monkeypatch.setitem(sys.modules, "heyoka", None)
    taylor_stepper.cache_clear()
    found = measured("chatter", SMALL)
    assert found.skipped == ["heyoka"]
    assert not [row for row in found.rows if row.method.startswith("heyoka")]
    told = singimpact("bench", "chatter", "--quick")
    assert told.exit_code == 0
    assert "chatter: heyoka is not installed, skipped" in told.stdout
    assert "scipy DOP853" in told.stdout


@pytest.mark.parametrize(
    "task",
    [
        *(series_rows._public(case, 5) for case in series_rows.TRUTH),
        series_rows._plain(series_rows.MODEL, 2),
        series_rows._implicit(3),
    ],
    ids=lambda task: f"{task.case}, {task.method}",
)
def test_series_gains_a_digit_and_more_by_orders(task):
    """Against flights: order 2 is off by a twentieth, order 5 by a millionth."""
    from singimpact.bench import relative_error

    off = relative_error(task.timed().answers[0], series_rows.TRUTH[task.case][0])
    assert 0 < off < {2: 0.06, 3: 2e-3, 5: 1e-5}[task.order]


def test_command_writes_table_data_and_pictures(singimpact, tmp_path):
    told = singimpact("bench", "chatter", "--quick", "--json", "-o", tmp_path / "b.json", "--plots", tmp_path / "p")
    assert told.exit_code == 0, told.output
    data = json.loads((tmp_path / "b.json").read_text())
    named = "group case method setting microseconds error wrong missed of ratio spread rounds aim reached problems"
    assert list(data["rows"][0]) == named.split()
    assert data["quick"] is True
    assert all(row["spread"][0] <= row["ratio"] <= row["spread"][1] for row in data["rows"])
    assert [path.name for path in (tmp_path / "p").iterdir()] == ["bench-chatter.png"]
    assert (tmp_path / "p" / "bench-chatter.png").read_bytes().startswith(b"\x89PNG")


def test_markdown(singimpact):
    told = singimpact("bench", "chatter", "--quick", "--format", "markdown")
    lines = told.stdout.splitlines()
    assert lines[0] == "## chatter"
    assert lines[2].startswith("| case | method | setting | time | to reach | error | wrong | missed |")
    assert len({line.count("|") for line in lines[2:] if line.startswith("|")}) == 1


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """The page of a quick run, in a folder with its numbers and its picture."""
    place = tmp_path_factory.mktemp("page") / "page.md"
    told = CliRunner().invoke(main, ["bench", "--quick", "--format", "page", "-o", str(place)])
    assert told.exit_code == 0, told.output
    return place


@pytest.mark.slow
def test_one_command_writes_the_page_its_numbers_and_its_picture(page):
    text = page.read_text()
    assert text.startswith(f"<!-- written by `{COMMAND}` from sources {timed_digest()}; do not edit -->")
    assert [path.name for path in sorted(page.parent.iterdir())] == ["page.csv", "page.md", "page.png"]
    assert rows_of(text) == rows_of_numbers(page.with_suffix(".csv"))
    assert len(rows_of(text)) == 12


def rows_of(text):
    """The lines of the table, without its head."""
    return [line for line in text.splitlines() if line.startswith("| ")][1:]


def rows_of_numbers(path):
    """The lines of the table from the numbers of the csv file."""
    with path.open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    lines = []
    for case in dict.fromkeys(row["case"] for row in rows):
        own, *peers = [row for row in rows if row["case"] == case]
        cells = [case, in_words(float(own["microseconds"])), f"{float(own['error']):.0e}" if own["error"] else ""]
        for name in ("heyoka", "scipy", "numba"):
            found = [row for row in peers if row["method"] == name]
            ratio = f"{float(format(float(found[0]['ratio']), '.2g')):g} times" if found else ""
            error = f"{float(found[0]['error']):.0e}" if found and found[0]["error"] else ""
            missed = (
                f"{found[0]['missed']} of {found[0]['of']} missed"
                if found and found[0]["missed"] not in ("", "0")
                else ""
            )
            cells.append(", ".join(filter(None, [ratio, error, missed])))
        lines.append("| " + " | ".join(cells) + " |")
    return lines


def test_the_stored_page_has_the_numbers_of_its_csv_file_and_one_picture(clone):
    text = (clone / "docs" / "benchmarks.md").read_text(encoding="utf-8")
    assert rows_of(text) == rows_of_numbers(clone / "docs" / "benchmarks.csv")
    assert len(rows_of(text)) == 12
    assert text.count("![") == text.count("](benchmarks.png)") == 1
    assert text.partition("\n")[2].startswith(ABOUT)
    assert text.rstrip().endswith(READING.rstrip())
    assert (clone / "docs" / "benchmarks.png").stat().st_size > 20_000


def test_five_rows_stand_in_the_readme(clone):
    stored = rows_of((clone / "docs" / "benchmarks.md").read_text(encoding="utf-8"))
    told = (clone / "README.md").read_text(encoding="utf-8").partition("## How fast")[2].partition("\n## ")[0]
    assert len(rows_of(told)) == 5
    assert set(rows_of(told)) <= set(stored)


TIME = re.compile(r"\b\d+(?:\.\d+)? (?:us|µs|ms|ns|s|minutes?)\b")
LIMITS = ("has used 10 s of CPU time", "in chunks of 0.2 s", "takes 9 s of CPU at most")  # no speeds


def test_other_pages_have_no_speed_of_their_own(clone):
    stored = set(rows_of((clone / "docs" / "benchmarks.md").read_text(encoding="utf-8")))
    pages = [clone / "README.md", *(path for path in (clone / "docs").rglob("*.md") if "computed" not in path.parts)]
    others = [path for path in pages if path.name not in ("benchmarks.md", "stress.md")]
    lines = [line for path in others for line in path.read_text(encoding="utf-8").splitlines()]
    told = [line for line in lines if TIME.search(line) and line not in stored]
    assert [line for line in told if not any(limit in line for limit in LIMITS)] == []
    assert TIME.search("a state takes 5 us")
    assert TIME.search("0.1 to 0.4 s for a few products")
    assert len(pages) > 40


def test_loops_of_fixed_steps_fly_to_the_impact_and_lose_digits_where_v_is_small():
    states = Draws("linear", "generic", 50, restitution=0.9)()
    loops = numbers("linear", 2.8, 0.3)
    step = states.osc.impact_map(states.tau, states.v)
    assert np.abs(flights(states.tau, states.v, loops) / step.flight_time - 1).max() < 1e-9
    rows = orbit(states.tau[0], states.v[0], 5, 0.9, loops)
    exact = states.osc.orbit(float(states.tau[0]), float(states.v[0]), 5)
    assert np.abs(rows / np.column_stack([exact.tau, exact.v])[1:6] - 1).max() < 1e-9
    slow = Draws("linear", "v from 1e-8 to 1e-2", 200, restitution=0.9)()
    off = np.abs(flights(slow.tau, slow.v, loops) / slow.osc.impact_map(slow.tau, slow.v).flight_time - 1)
    assert np.nanmax(off) > 1e-2


def test_interrupted_run_leaves_nothing(singimpact, tmp_path, monkeypatch):
    def stopped(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("singimpact.bench.groups.measured", stopped)
    told = singimpact("bench", "chatter", "-o", tmp_path / "b.txt", "--plots", tmp_path / "p")
    assert told.exit_code == 130
    assert [path for path in tmp_path.rglob("*") if path.is_file()] == []


@pytest.mark.parametrize(
    ("arguments", "told"),
    [(("chater",), "unknown group 'chater': the nearest known are chatter"),
     (("chatter", "--plots", "{file}"), "cannot be written"),
     (("chatter", "-o", "{file}/absent/b.txt"), "cannot be written"),
     (("chatter", "--format", "page"), "--format page is not accepted with chatter")],
)  # fmt: skip
def test_refused_before_anything_is_measured(arguments, told, singimpact, tmp_path, monkeypatch):
    monkeypatch.setattr("singimpact.bench.groups.measured", lambda *_: pytest.fail("it was measured"))
    (tmp_path / "file").touch()
    result = singimpact("bench", *(word.format(file=tmp_path / "file") for word in arguments))
    assert result.exit_code == 2
    assert told in result.stderr
