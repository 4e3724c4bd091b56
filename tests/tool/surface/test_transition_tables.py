"""Transitions with two rests and more: four models against a table, and against square systems in 30 digits."""

from __future__ import annotations

from itertools import pairwise

import mpmath
import numpy as np
import pytest

import singimpact as si
from singimpact.algebra import as_float
from singimpact.flights import backwards, first_hit
from singimpact.oscillator import acceleration
from singimpact.surface import Transitions, transitions

pytestmark = pytest.mark.slow  # seconds together: .ci/check runs them

TWO, FAST = (si.linear(rate, 0, "0.8") for rate in (2, "2.8"))
LIGHT = si.ImpactOscillator("x + 0.04*xdot", "cos(2.8*t) + 0.5*cos(5.6*t + 2)", 0, "0.8")
HEAVY = si.ImpactOscillator("x + 0.1*xdot", "cos(3.6*t) + 0.5*cos(7.2*t + 2)", 0, "0.8")
# event, clearance, rests, launch with v > 0
SEEN = {
    "two": (TWO, 2 * np.pi, [
        ("swan", 1, (0,), None), ("periodic graze", -1 / 3, (0, np.pi), None), ("swan", -1, (np.pi / 2,), None),
    ]),
    "fast": (FAST, 5 * np.pi, [
        ("swan", 1, (0,), None), ("tacnode", -0.0451779, (1.79520, 4.93679), (1.40882, 0.0660846)),
        ("tangency to tangency", -0.0461684, (1.66650, 5.06548), None),
        ("periodic graze", -0.146199, (0, 2.24399), None),
        ("swan", -1, (1.12200,), (-4.43304, 0.825527)), ("swallowtail", -1, (1.12200,), (-4.43304, 0.825527)),
    ]),
    "light": (LIGHT, 4 * np.pi, [
        ("swan", 1.17883, (2.00590,), None), ("swan", 0.213870, (0.509903,), None),
        ("tangency last", 0.211743, (0.332259, 0.542321), (-1.55013, 0.706146)),
        ("swan", 0.208073, (0.407712,), (-1.55755, 0.703623)),
        ("swallowtail", 0.208073, (0.407712,), (-1.55755, 0.703623)),
        ("tacnode", -0.0528776, (1.88512, 5.02734), (1.12869, 0.355704)),
        ("tangency last", -0.0552099, (1.84230, 5.25908), (1.21709, 0.277008)),
        ("periodic graze", -0.143255, (2.15708, 4.40108), None),
        ("triple point", -0.922413, (1.67866, 7.14288, 13.5500), (-4.29187, 1.06688)),
        ("triple point", -1.12855, (0.962738, 1.53284, 7.17795), (-4.32280, 1.23238)),
        ("tacnode", -1.14604, (0.838088, 7.12253), (-4.39583, 1.18124)),
        ("tangency first", -1.19219, (1.39250, 7.18218), None),
        ("swan", -1.39270, (1.25790,), (-4.34518, 1.38932)), ("swallowtail", -1.39270, (1.25790,), (-4.34518, 1.38932)),
    ]),
    "heavy": (HEAVY, 4 * np.pi, [
        ("swan", 1.17883, (1.56014,), None), ("swan", 0.213870, (0.396591,), None),
        ("tangency last", 0.211745, (0.258405, 0.421791), (-1.28890, 0.497038)),
        ("swan", 0.208073, (0.317109,), (-1.29707, 0.493525)),
        ("swallowtail", 0.208073, (0.317109,), (-1.29707, 0.493525)),
        ("tangency last", 0.0620278, (1.46022, 4.04705), (0.949853, 0.240887)),
        ("periodic graze", -0.0821299, (1.67125, 3.41658), None),
        ("tangency first", -0.219702, (1.24844, 5.70793), None),
        ("triple point", -0.304994, (0.19892, 1.51271, 6.94148), (-4.74426, 0.521290)),
        ("tangency first", -0.628773, (1.18908, 6.93734), None),
        ("swan", -1.39270, (0.978366,), (-4.58675, 1.62446)),
        ("swallowtail", -1.39270, (0.978366,), (-4.58675, 1.62446)),
    ]),
}  # fmt: skip
CUTS = {"tacnode": 2, "tangency last": 1, "tangency first": 1, "triple point": 1, "tangency to tangency": 1}
"""By how many the cuts of the visible outline a period change."""


@pytest.fixture(scope="module")
def found():
    """name -> the transitions of a model, searched once."""
    kept: dict[str, Transitions] = {}

    def of(name: str) -> Transitions:
        if name not in kept:
            model, longest, _ = SEEN[name]
            kept[name] = transitions(model, "clearance", (-2, 2), (-longest, longest))
        return kept[name]

    return of


EACH = ["two", "fast", "light", "heavy"]


@pytest.mark.parametrize("name", EACH)
def test_visible_ones(name, found):
    """Each number to its last digit."""
    rows = SEEN[name][2]
    seen = sorted(found(name).visible, key=lambda each: (-each.value, len(each.rests), each.event != "swan"))
    assert [each.event for each in seen] == [row[0] for row in rows]
    for each, (_, value, rests, launch) in zip(seen, rows, strict=True):
        assert each.value == pytest.approx(value, rel=4e-6)
        assert each.rests == pytest.approx(rests, rel=6e-6, abs=1e-9)
        assert (each.launch is None) == (launch is None), each
        if launch is not None:
            assert each.launch == pytest.approx(launch, rel=6e-6)


def test_all_of_two(found):
    """x'' + x = cos 2t: c = 1, 1/3, -1/3, -1 alone."""
    listed = [(each.event, each.value, each.visible) for each in found("two") if each.event != "swallowtail"]
    wanted = [("swan", -1, True), ("periodic graze", -1 / 3, True), ("periodic graze", 1 / 3, False), ("swan", 1, True)]
    assert [(event, pytest.approx(value, abs=1e-14), seen) for event, value, seen in listed] == wanted
    assert not transitions(TWO, "clearance", (0.4, 0.9), (-3, 3))


def test_all_of_two_are_proved_to_be_all(found):
    below = transitions(TWO, "clearance", (-2, 2), (-6.2, 6.2))
    assert below.complete
    assert {each.value for each in below} == {each.value for each in found("two")}


def test_all_of_fast(found):
    """Both senses of c, of which a half is never seen; 42 triples of rests within half a period of the flights."""
    wanted = {
        "tangency to tangency": (0.447691, 0.265575, 0.144613, 0.0461684),
        "tacnode": (0.118277, 0.0451779), "periodic graze": (0.146199,),
    }  # fmt: skip
    for event, sizes in wanted.items():
        values = [each.value for each in found("fast") if each.event == event]
        assert sorted(values) == pytest.approx(sorted([*sizes, *(-size for size in sizes)]), rel=6e-6), event
    triples = [each for each in found("fast") if each.event == "triple point"]
    assert triples
    assert not any(each.visible for each in triples)
    (doubt,) = transitions(FAST, "clearance", (0.5, 0.9), (0, 3), "triple point").doubts
    assert "triple points are met on a grid of step 0.02" in doubt


def test_triples_of_fast():
    """Quadruples of rests taken three at a time, over the whole period 10 pi of the flights."""
    made = transitions(FAST, "clearance", (-2, 2), (0, 31.4), kinds="triple point")
    assert len(made) == 168
    assert len({round(each.value, 9) for each in made}) == 20
    assert max(abs(each.value) for each in made) == pytest.approx(0.200427, rel=3e-6)
    assert not made.visible


def test_hidden_ones(found):
    (last,) = (each for each in transitions(LIGHT, "clearance", (-0.05, -0.03), (-4.0, 0), "tangency"))
    assert (last.event, last.visible, last.launch) == ("tangency last", False, None)
    assert last.value == pytest.approx(-0.0392850, rel=1e-6)
    assert "no first hit changes" in last.effect
    assert all(each.effect for each in found("two"))


class Exact:
    """x - c, x' and their derivatives by the launch velocity, of a linear model with two waves, in mpmath."""

    def __init__(self, damping, waves):
        self.damping, self.waves = mpmath.mpf(damping), [tuple(map(mpmath.mpf, wave)) for wave in waves]
        self.beta = self.damping / 2
        self.w = mpmath.sqrt(1 - self.beta**2)

    def q(self, t, order=0):
        total = 0
        for rate, height, phase in self.waves:
            gain = height * mpmath.expj(phase) / (1 - rate**2 + mpmath.j * self.damping * rate)
            total += (gain * (mpmath.j * rate) ** order * mpmath.expj(rate * t)).real
        return total

    def a(self, t, c):
        return sum(height * mpmath.cos(rate * t + phase) for rate, height, phase in self.waves) - c

    def at(self, s, d, c):
        """x - c and x' d after a rest at s, by the exponents of the free motion."""
        root = mpmath.mpc(-self.beta, self.w)
        start, speed = c - self.q(s), -self.q(s, 1)
        free = mpmath.mpc(start, (root.real * start - speed) / root.imag)
        x, v = ((free * root**n * mpmath.exp(root * d)).real + self.q(s + d, n) for n in (0, 1))
        return x - c, v

    def system(self, each):
        """The square system of an event: functions of the first rest, the times to the others, and c."""
        if each.event == "triple point":
            return lambda s, d, e, c: [*self.at(s, d, c), *self.at(s, e, c)]
        if each.event == "periodic graze":
            return lambda s, c: [self.q(s) - c, self.q(s, 1)]
        if each.event == "tacnode":
            return lambda s, d, c: [*self.at(s, d, c), mpmath.sin(self.w * d)]
        last = each.event == "tangency last"
        return lambda s, d, c: [*self.at(s, d, c), self.a(s + d if last else s, c)]


EXACT = {
    "light": Exact("0.04", [("2.8", 1, 0), ("5.6", "0.5", 2)]),
    "heavy": Exact("0.1", [("3.6", 1, 0), ("7.2", "0.5", 2)]),
}


def exact_value(exact, each):
    gaps = [rest - each.rests[0] for rest in each.rests[1:]]
    unknowns = [each.rests[0], *([] if each.event == "periodic graze" else gaps), each.value]
    with mpmath.workdps(30):
        return mpmath.findroot(exact.system(each), unknowns)


@pytest.mark.parametrize("name", ["light", "heavy"])
def test_all_against_square_systems_in_thirty_digits(name, found):
    """Every event, seen or not: value and times of rest; the closed form here is complex, that of the search real."""
    compared = 0
    for each in found(name):
        if each.event in ("swan", "swallowtail"):
            continue
        place = exact_value(EXACT[name], each)
        gaps = [rest - each.rests[0] for rest in each.rests[1:]]
        wanted = [each.rests[0], *([] if each.event == "periodic graze" else gaps), each.value]
        assert max(abs(float(a) - b) for a, b in zip(place, wanted, strict=True)) < 2e-11, each
        assert abs(float(place[len(place) - 1]) - each.value) < 1e-12, each
        compared += 1
    assert compared > 45


def test_some_against_square_systems_and_a_wrong_system_disagrees():
    made = transitions(LIGHT, "clearance", (-0.06, -0.05), (-4, 4))
    assert {each.event for each in made.visible} == {"tacnode", "tangency last"}
    for each in made.visible:
        assert abs(float(exact_value(EXACT["light"], each)[2]) - each.value) < 1e-12
        wrong = Exact("0.05", [("2.8", 1, 0), ("5.6", "0.5", 2)])
        assert abs(float(exact_value(wrong, each)[2]) - each.value) > 1e-6


def cuts(model, count=3000):
    """How often the first hit of the flight that comes to rest at s jumps, as s runs over {a > 0}, a period."""
    period = as_float(model.period)
    s = (np.arange(count) + 0.31) * period / count
    a = acceleration(model, s)
    hit = first_hit(backwards(model), -s[a > 1e-9], np.zeros(int((a > 1e-9).sum())))
    back = np.full(count, -1.0)  # -1 where no flight comes to rest
    back[a > 1e-9] = np.where(np.isfinite(hit.flight_time), hit.flight_time, 1e9)
    ring = np.append(back, back[0])
    far = np.abs(np.diff(ring)) > 0.05 + 40 * period / count
    return int((far & (ring[1:] >= 0) & (ring[:-1] >= 0)).sum())


@pytest.mark.parametrize(("name", "graze"), [("light", -0.143255), ("heavy", -0.0821299)])
def test_cuts_are_counted_without_the_list(name, graze):
    """N(c) changes at visible transitions alone, and by the number that belongs to each; at a graze by several."""
    model, values = SEEN[name][0], sorted({row[1] for row in SEEN[name][2]})
    by_value = {row[1]: row[0] for row in SEEN[name][2] if row[0] != "swallowtail"}
    counts = []
    for low, high in pairwise([*values, 1.24]):
        shares = (0.2, 0.5) if high == graze else (0.2, 0.5, 0.8)  # just below a graze arcs are too short to be sampled
        met = {cuts(model.replace(clearance=low + share * (high - low))) for share in shares}
        assert len(met) == 1, (low, high, met)
        counts.append(met.pop())
    for value, below, above in zip(values[1:], counts[:-1], counts[1:], strict=True):
        wanted = {"swan": (0, 1), "periodic graze": (3, 4)}.get(by_value[value], (CUTS.get(by_value[value]),))
        assert abs(below - above) in wanted, (value, below, above)
    assert sum(count > 0 for count in counts) > 5


def test_cuts_next_to_two_transitions():
    """A tacnode makes two cuts and a tangency takes one; the hidden tangency of c = -0.039285 does nothing."""
    assert [cuts(LIGHT.replace(clearance=c), 2000) for c in (-0.035, -0.045, -0.054, -0.06)] == [0, 0, 2, 1]
