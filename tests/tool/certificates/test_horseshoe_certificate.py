"""Certificates of horseshoes: accepted as they were made; sets that are not crossed, and other loops, are refused."""

from __future__ import annotations

from fractions import Fraction

import flint
import numpy as np
import pytest
from second_program import copied, dropped, is_read_back, no_number_may_change, refuses, renewed

import singimpact as si
from singimpact.certificates import TERMS, Model, Set, check, derivative, impact

pytestmark = pytest.mark.slow  # seconds together: .ci/check runs them

OSC = si.linear("2.8", 0, "0.8")


@pytest.fixture(scope="module")
def made():
    return si.certify(si.homoclinic_points(OSC.periodic(1, 1)[0])[0].horseshoe())


def test_it_is_accepted_from_its_file(made, tmp_path):
    is_read_back(made, tmp_path / "horseshoe.json")
    assert repr(made).startswith("<certificate of a horseshoe: loops of 1 and 17 impacts, entropy >= 0.12566521424")


def test_any_changed_number_is_refused(made):
    no_number_may_change(made, 101)


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"period": "pi"}, "is not shown to have the period"),
        ({"loops": ["1", "16"]}, "loops are not those"),
        ({"loops": ["0", "16"]}, "1 to 1000 are accepted"),
        ({"entropy": {"value": "0.1256652142494", "radius": "1e-14"}}, "the entropy"),
        ({"entropy": {"value": "0.1256652142493", "radius": "1e-14"}}, "the entropy"),
        ({"sets": []}, "sets has 0 entries"),
    ],
)
def test_another_statement_is_refused(change, why, made):
    refuses({**copied(made.content), **change}, why)


@pytest.mark.parametrize(
    ("which", "place"),
    [
        (1, ("radii", 0)),
        (5, ("radii", 1)),
        (16, ("centre", 0)),
        (0, ("frame", 1)),
        (0, ("radii", 0)),
        (5, ("radii", 0)),
        (16, ("radii", 0)),
        (1, ("radii", 1)),
        (0, ("centre", 0)),
        (1, ("centre", 1)),
        (5, ("centre", 0)),
        (16, ("centre", 1)),
        (5, ("frame", 1)),
        (16, ("frame", 1)),
    ],
)
def test_sets_that_are_not_crossed_are_refused(which, place, made):
    """A set wider than the image that crosses it, one of a quarter of its height, and one elsewhere."""
    content = copied(made.content)
    each = content["sets"][which]
    part = each[place[0]]
    if place == ("radii", 0):
        part[0] = str(Fraction(part[0]) * 4)
    elif place == ("radii", 1):
        part[1] = str(Fraction(part[1]) / 4)
    elif place[0] == "centre":
        part[place[1]] = str(Fraction(part[place[1]]) + Fraction(1, 10**4))
    else:
        each["frame"] = [row[::-1] for row in each["frame"]]
    refuses(content)


def test_a_set_that_is_left_out_is_refused(made):
    content = copied(made.content)
    content["loops"] = ["1", "16"]
    del content["sets"][7]
    x = max(root.real for root in np.roots([1, -1, *[0] * 14, -1]) if abs(root.imag) < 1e-12)
    content["entropy"] = {"value": repr(float(np.log(x))), "radius": "1e-12"}
    refuses(content, "cross")


def test_the_set_round_the_saddle_alone_is_no_horseshoe(made):
    """N twice: a loop of one impact and another of one impact, which are the same."""
    content = copied(made.content)
    content |= {"sets": content["sets"][:1] * 2, "loops": ["1", "2"]}
    content["entropy"] = {"value": "0.481211825059603447", "radius": "1e-15"}
    refuses(content, "apart")


def test_another_restitution_is_refused(made):
    content = copied(made.content)
    content["model"]["restitution"] = "0.81"
    refuses(content, "cross")


@pytest.mark.parametrize(
    ("conditions", "change"),
    [
        (("width", "height"), "centre"),
        (("apart",), "again"),
        (("entropy",), "entropy"),
    ],
)
def test_a_checker_without_a_condition_accepts_what_is_false(conditions, change, made, monkeypatch):
    content = copied(made.content)
    if change == "centre":
        content["sets"][5]["centre"][0] = str(Fraction(content["sets"][5]["centre"][0]) + Fraction(1, 10**4))
    elif change == "again":
        content |= {"sets": content["sets"][:1] * 2, "loops": ["1", "2"]}
        content["entropy"] = {"value": "0.481211825059603447", "radius": "1e-15"}
    else:
        content["entropy"]["value"] = "0.2"
    refuses(content)
    dropped(monkeypatch, *conditions)
    check(renewed(content))


def test_boxes_flown_beside_their_centre_are_enclosed():
    """Images of members lie in the box, whose derivative contains difference quotients; and it is narrow."""
    osc, rng = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "0.3", "0.6"), np.random.default_rng(3)
    model, centre, width = Model(osc.to_dict()), (1.4, 0.6), 1e-3
    flint.ctx.prec, flint.ctx.cap = 100, TERMS
    try:
        box = [flint.arb(x, width) for x in centre]
        rows = impact(model, *box, 64, tuple(map(flint.arb, centre)))
        plain = impact(model, *box, 64)
        low, high = (np.array([[float(end(part)) for part in row] for row in rows])
                     for end in (flint.arb.lower, flint.arb.upper))  # fmt: skip
        assert (high - low < 1.6 * np.array([[float(part.rad()) for part in row] for row in plain])).all()
    finally:
        flint.ctx.prec, flint.ctx.cap = 53, 10
    for _ in range(20):
        one = np.array(centre) + width * rng.uniform(-1, 1, 2)
        slope = osc.derivative(*one).matrix
        assert (low - 1e-9 <= slope).all()
        assert (slope <= high + 1e-9).all()


def test_pieces_cover_a_set():
    told = {"centre": ["1", "2"], "frame": [["1", "1"], ["-1/2", "1/3"]], "radii": ["1/10", "1/50"]}
    one, rng = Set(told), np.random.default_rng(0)
    pieces = one.pieces(4)
    assert len(pieces) == 16
    for u, s in rng.uniform(-1, 1, (50, 2)):
        state = 1 + u / 10 + s / 50, 2 - u / 20 + s / 150
        assert any(all(part.contains(flint.arb(x)) for part, x in zip(piece, state, strict=True)) for piece in pieces)
    corner = 1 + 0.1 + 0.02, 2 - 0.05 + 0.02 / 3
    assert all(abs(x - float(c.mid())) <= float(r.abs_upper()) + 1e-12
               for x, c, r in zip(corner, one.centre, one.reach(), strict=True))  # fmt: skip


def test_two_impacts_of_a_box():
    """Over the images too: the product of the derivatives at every member."""
    model, width = Model(OSC.to_dict()), 1e-4
    flint.ctx.prec, flint.ctx.cap = 100, TERMS
    try:
        D = derivative(model, [flint.arb(2.2, width), flint.arb(0.27, width)], 2, 64)
        low, high = (np.array([[float(end(part)) for part in row] for row in D.table()])
                     for end in (flint.arb.lower, flint.arb.upper))  # fmt: skip
    finally:
        flint.ctx.prec, flint.ctx.cap = 53, 10
    for shift in (-width, 0, width):
        one = (2.2 + shift, 0.27 - shift)
        step = OSC.impact_map(*one)
        product = OSC.derivative(step.tau, step.v).matrix @ OSC.derivative(*one).matrix
        assert (low - 1e-9 <= product).all()
        assert (product <= high + 1e-9).all()
    assert (high - low < 0.2).all()


@pytest.mark.parametrize(
    "osc", [OSC, si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(2.8*t)", 0, "0.9")], ids=["linear", "Duffing"]
)
def test_others_are_accepted(osc):
    three = next(orbit for orbit in osc.periodic(3, 3) if not orbit.stable)
    si.certify(si.homoclinic_points(three, length=5)[0].horseshoe()).check(60)  # 4 s on one core, on slow ones 10


@pytest.fixture(scope="module")
def of_interval():
    crossing = si.homoclinic_points(OSC.periodic(1, 1)[0])[0]
    return si.certify(crossing.horseshoes("restitution", ("0.799", "0.801")))


def test_chaos_for_all_restitutions_of_an_interval_is_accepted(of_interval, tmp_path):
    is_read_back(of_interval, tmp_path / "horseshoes.json")
    assert repr(of_interval) == (
        "<certificate of horseshoes for all restitution in [799/1000, 801/1000], entropy >= 0.137022578262>"
    )
    assert len(of_interval.content["pieces"]) == 4


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"between": ["0.799", "0.8"]}, "do not cover the interval"),
        ({"between": ["0.8", "0.801"]}, "do not follow one another"),
        ({"entropy": {"value": "0.13703", "radius": "1e-14"}}, "the entropy"),
        ({"over": "g"}, "."),
        ({"pieces": []}, "pieces has 0 entries"),
    ],
)
def test_another_statement_of_an_interval_is_refused(change, why, of_interval):
    refuses({**copied(of_interval.content), **change}, why)


@pytest.mark.parametrize("factor", [3, Fraction(1, 2)])
def test_a_piece_of_another_width_is_refused(factor, of_interval):
    """Sets that follow the number cross for the piece that is written; wider ones, and gaps, are refused."""
    content = copied(of_interval.content)
    piece = content["pieces"][1]
    piece["reach"] = str(Fraction(piece["reach"]) * factor)
    refuses(content, "follow")


def test_sets_that_stay_where_they_are_do_not_cross(of_interval):
    content = copied(of_interval.content)
    for piece in content["pieces"]:
        for one in piece["sets"]:
            one["drift"] = ["0", "0"]
    refuses(content, "not shown")


def test_a_number_that_the_period_depends_on_is_refused(of_interval):
    """With g = cos(w t), 2.8 at the middle, it has no one period for all w."""
    content = copied(of_interval.content)
    model = {"f": "x", "g": "cos(w*t)", "clearance": "0", "restitution": "0.8", "parameters": {"w": "2.8"}}
    piece = {**content["pieces"][1], "number": "2.8", "reach": "0.0001"}
    refuses({**content, "model": model, "over": "w", "between": ["2.7999", "2.8001"], "pieces": [piece]}, "period")


@pytest.mark.parametrize(
    ("over", "between"), [("clearance", ("-1/8000", "1/8000")), ("amplitude", ("0.9998", "1.0002"))]
)
def test_other_numbers_move_the_wall_or_the_forcing(over, between):
    made = si.certify(si.homoclinic_points(OSC.periodic(1, 1)[0])[0].horseshoes(over, between))
    made.check()
    assert f"horseshoes for all {over}" in repr(made)
