"""Timer, judge and picture on made-up methods whose cost and answers are known."""

from __future__ import annotations

import time

import pytest
from matplotlib.colors import to_hex

from singimpact.bench import (
    EPSILON,
    Aim,
    Case,
    Counted,
    Effort,
    Measured,
    Method,
    Timed,
    condition,
    measure,
    plotted,
    reached,
    table,
)

EFFORT = Effort(rounds=5, least=0, once=100, fresh=5)


def fixed(seconds, answers):
    """A method that says what it took."""
    return lambda: Timed(seconds, answers)


def test_wrong_and_missed_answers_are_counted():
    truth = ["1", "2", "3", "4"]
    planted = Method("planted", "", fixed(1.0, [1 + 1e-10, 2.1, None, float("nan")]))
    right = Method("right", "", fixed(1.0, [1, 2, 3, 4]))
    right, wrong = measure("group", Case("case", [right, planted], truth), EFFORT)
    assert (right.wrong, right.missed, right.error) == (0, 0, 0.0)
    assert (wrong.wrong, wrong.missed, wrong.of) == (4, 3, 4)
    assert wrong.error == pytest.approx((0.05 + 1e-10) / 2, rel=1e-6)


def test_condition_allows_what_it_explains_and_no_more():
    off = 1e4 * EPSILON
    methods = [Method("near", "", fixed(1.0, [1 + off])), Method("digits", "", fixed(1.0, [1 + off]), epsilon=1e-30)]
    allowed = measure("group", Case("case", methods, [1], [2e3]), EFFORT)
    assert [row.wrong for row in allowed] == [0, 1]
    assert measure("group", Case("case", methods[:1], [1], [5e2]), EFFORT)[0].wrong == 1


def test_ratios_are_taken_within_a_round():
    """A machine that slows down fourfold in the middle does not change them."""
    slow = iter([1.0, 1, 1, 4, 4, 4, 1, 1, 1])
    turns = {"first": [], "second": []}

    def method(name, cost):
        def run():
            if name == "first":
                turns["now"] = next(slow)
            turns[name].append(cost * turns["now"])
            return Timed(turns[name][-1], [1])

        return Method(name, "", run)

    case = Case("case", [method("first", 1.0), method("second", 3.0)])
    first, second = measure("group", case, EFFORT)
    assert (first.ratio, second.ratio, second.spread, second.rounds) == (1, 3, (3, 3), 5)
    assert max(turns["first"]) == 4


def test_cpu_time_of_a_problem():
    """Sleep is not work; problems and repeated calls divide."""

    def work():
        stop = time.process_time() + 2e-3
        while time.process_time() < stop:
            pass
        return [None, None]

    def sleep():
        time.sleep(0.02)
        return [None, None]

    methods = [Method("work", "", work), Method("copies", "", work, problems=20), Method("sleep", "", sleep)]
    one, copies, asleep = measure("group", Case("case", methods), Effort(rounds=3, least=0))
    assert one.microseconds == pytest.approx(1000, rel=0.5)
    assert copies.microseconds == pytest.approx(one.microseconds / 10, rel=0.5)
    assert asleep.microseconds < 0.5 * one.microseconds


def test_drawn_problems_are_others_in_every_call_and_cost_nothing():
    drawn, run = [], []

    def draw():
        stop = time.process_time() + 5e-3
        while time.process_time() < stop:
            pass
        drawn.append(len(drawn) + 1)
        return drawn[-1]

    def work(given):
        run.append(given)
        return [given]

    (row,) = measure("group", Case("case", [Method("drawn", "", work, draw=draw)], ["1"]), Effort(rounds=3, least=0))
    assert run == drawn == [1, 2, 3, 4, 5]
    assert row.microseconds < 1000
    assert (row.wrong, row.of) == (0, 1)  # the answer of the first call is judged


def test_a_run_may_count_its_problems():
    methods = [Method("counted", "", lambda: Counted(4, [1]))]
    (row,) = measure("group", Case("case", methods, ["1"]), Effort(rounds=3, least=0))
    assert (row.wrong, row.of) == (0, 1)


def test_an_aim_needs_right_answers():
    planted = (("right", 1e-6, 1, 2.0), ("wrong", 1e-6, 2, 2.0), ("slow", 3e-6, 1, 2.0))
    methods = [Method(name, "", fixed(seconds, [answer]), aim=Aim(most)) for name, seconds, answer, most in planted]
    found = Measured("group", measure("group", Case("case", methods, ["1"]), EFFORT))
    assert [row.reached for row in found.rows] == [True, False, False]
    _, cells = table(found)
    assert [cell[4] for cell in cells] == ["2 us: reached", "2 us: missed", "2 us: missed"]
    assert "1 of 3 are reached" in reached(found)
    assert [line.split(", ")[1] for line in reached(found).splitlines() if line.startswith("missed")] == [
        "wrong",
        "slow",
    ]


def test_condition():
    assert condition(lambda tau, v: tau**3 / v, 2.0, 0.1) == pytest.approx(5, rel=1e-6)


def test_picture_shows_every_method_and_the_missed_ones_hollow():
    cases = [Case("judged", [Method("a", "1", fixed(1.0, [1])), Method("b", "1", fixed(2.0, [2]))], [1]),
             Case("timed", [Method("a", "once", fixed(3.0, [None]))])]  # fmt: skip
    found = Measured("group", [row for case in cases for row in measure("group", case, EFFORT)])
    judged, timed = plotted(found).axes
    assert judged.get_title() == "judged"
    hollow = [line for line in judged.lines if to_hex(line.get_markerfacecolor()) == "#ffffff" != line.get_color()]
    assert [(line.get_xdata()[0], line.get_ydata()[0]) for line in hollow] == [(1.0, 2e6)]
    assert len({(line.get_color(), line.get_marker()) for line in judged.lines}) == 2
    assert [bar.get_width() for bar in timed.patches] == [3.0]
