"""gamma proved: against true flights and thresholds, over models and intervals of r; what is false is refused."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from random import Random

import flint
import pytest

import singimpact as si
from singimpact.algebra import balls_at, constant
from singimpact.contact import next_zero
from singimpact.dynamics import (
    Models,
    ProofSettings,
    Undecided,
    certified_gamma,
    clock_of,
    flights_before,
    gravity,
    grown,
    phase_below,
    place_of,
    prove_box,
    ratio,
    rational,
    residual,
    restitution_at,
    speed_factor,
)
from singimpact.dynamics.gamma_proof import nonlinear

BITS = 160
TANGENCY = si.linear(2, "0.3", "0.5")
SWAN = si.linear(2, 1, "0.5")
MODELS = {
    "tangency": (TANGENCY, "2", Fraction(1, 4)),
    "swan": (SWAN, "2", Fraction(1, 4)),
    "damped": (si.linear("2.8", 0, "0.8", damping="0.3", phase="0.4"), None, Fraction(1, 4)),
    "two harmonics": (si.ImpactOscillator("4*x + 0.3*xdot", "cos(2*t) + sin(5*t + 1)/2", "0.1", "0.7"), None,
                      Fraction(1, 5)),
    "overdamped": (si.linear("2.8", 0, "0.8", damping=4), None, Fraction(1, 6)),
    "critical": (si.linear("2.8", 0, "0.6", damping=2), None, Fraction(1, 4)),
    "free": (si.ImpactOscillator("0", "cos(3*t)", 0, "0.7"), None, Fraction(1, 4)),
    "Duffing": (si.ImpactOscillator("x + x**3/5 + xdot/10", "cos(2*t)", "0.3", "0.5"), "2", Fraction(1, 8)),
    "cubic, swan": (si.ImpactOscillator("x**3 + xdot*x/10", "cos(2*t)", 1, "0.7"), "2", Fraction(1, 10)),
}  # fmt: skip
NONLINEAR = ("Duffing", "cubic, swan")


@pytest.fixture(scope="module")
def proved():
    kept = {}

    def of(name):
        if name not in kept:
            osc, tau, reach = MODELS[name]
            kept[name] = osc.certified_gamma(tau, reach=reach)
        return kept[name]

    return of


def prepared(osc, tau, reach, bits=96):
    """The relation of a model."""
    zero = next_zero(osc, constant("tau", tau)).zero
    return flights_before(osc, zero, reach, bits), zero


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=pytest.mark.slow) if name in ("cubic, swan", "Duffing") else name for name in MODELS],
)
def test_thresholds_in_many_digits_lie_within_the_proved_bound(name, proved):
    """Bisection on the fate of true orbits knows nothing of the gauge, the series or the lemmas."""
    found = proved(name)
    assert found.reach == MODELS[name][2]
    assert "reach" not in found.notes
    for share in (Fraction(99, 100), Fraction(1, 3))[: 1 if name in ("swan", "two harmonics") else 2]:
        tau = str(found.zero.tau - float(share) * float(found.duration.value))
        bound, true = found.threshold(tau), si.threshold(found.oscillator, tau, digits=15)
        assert bound.contains(true.v), (bound, true.v)
        assert 0 < bound.radius < bound.value / 10


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow) if name in NONLINEAR else name for name in MODELS]
)
def test_true_flights_satisfy_the_relation(name):
    """No lemma sees a wrong gravity; flights of 40 digits do."""
    osc, tau, reach = MODELS[name]
    if tau is None:
        tau = str(phase_below(osc))
    count, random = 15, Random(name)
    with balls_at(BITS):
        relation, zero = prepared(osc, tau, reach, BITS)
        numbers, j = clock_of(osc, zero, BITS), relation.j
        low = flint.arb(str(certified_gamma(osc, tau, reach=reach).duration.value))
    hits = 0
    for _ in range(4 * count):
        share, speed = Fraction(random.randint(1, 999), 1000), Fraction(random.randint(1, 999), 1000)
        with balls_at(BITS):
            T = low * flint.arb(flint.fmpq(share.numerator, share.denominator))
            tau0 = Fraction(str(float((zero.moved(BITS) - T).mid())))
            T = zero.moved(BITS) - flint.arb(flint.fmpq(tau0.numerator, tau0.denominator))
            S = place_of(numbers.square, T)
            top = S ** (j + 1) * relation.hats(S, flint.arb(0)).W * speed_factor(numbers, S)
            v = Fraction(float(top.mid())) * speed
        step = osc.impact_map(tau0, v, digits=40)
        with balls_at(BITS):
            after = zero.moved(BITS) - flint.arb(str(step.tau))
            if not after > 0:
                continue
            S1, y = place_of(numbers.square, after), flint.arb(flint.fmpq(v.numerator, v.denominator))
            ell = S1 / S
            hats = relation.hats(S, ell)
            launch = S ** (j + 1) * (1 - ell) * hats.W * speed_factor(numbers, S)
            landing = S ** (j + 1) * (1 - ell) * hats.U * speed_factor(numbers, S1)
            assert abs(launch - y) < y * flint.arb("1e-8")
            assert abs(flint.arb(osc.restitution.value.numerator) / osc.restitution.value.denominator * landing
                       - flint.arb(str(step.v))) < y * flint.arb("1e-8")  # fmt: skip
            hits += 1
        if hits == count:
            return
    raise AssertionError(f"{hits} flights")


@pytest.mark.parametrize("name", ["tangency", *(pytest.param(name, marks=pytest.mark.slow) for name in NONLINEAR)])
def test_derivative_columns_are_differences(name):
    with balls_at(200):
        relation, _ = prepared(*MODELS[name], 200)
        S, ell, h = flint.arb("0.07"), flint.arb("0.37"), flint.arb("1e-12")
        relation.tail = flint.arb(0)
        at = relation.hats(S, ell)
        along, across = relation.hats(S + h, ell), relation.hats(S, ell + h)
        assert at.V.overlaps(at.W - (1 - ell) * at.Wl)
        for found, difference in (
            (at.WS, along.W - at.W),
            (at.US, along.U - at.U),
            (at.Wl, across.W - at.W),
            (at.Ul, across.U - at.U),
        ):
            assert abs(found - difference / h) < flint.arb("1e-10")


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=pytest.mark.slow if name in NONLINEAR else ())
        for name in ("tangency", "swan", *NONLINEAR)
    ],
)
@pytest.mark.parametrize("spoiled", ["L_2", "L_5", "r", "exchanged", "exchanged in models", "M = 0", "tail"])
def test_what_is_false_is_refused(name, spoiled, monkeypatch):
    osc, tau, reach = MODELS[name]
    settings = ProofSettings()
    with balls_at(96):
        relation, _ = prepared(osc, tau, reach)
        half, kind = flint.arb(1) / 2, type(relation)
        box = ratio(relation.j, half, 25)
        assert prove_box(relation, box, settings, half).grow > 1
        series, r = None, half
        if spoiled.startswith("L_"):
            n, by = (2, "1e-6") if spoiled == "L_2" else (5, "1e-9")
            series = spoiled_series(relation, box, settings, n, flint.arb(by))
        elif spoiled == "r":
            r = half * (1 + flint.arb("1e-6"))
        elif spoiled == "exchanged":
            true = kind.hats
            monkeypatch.setattr(kind, "hats", lambda self, S, ell: (h := true(self, S, ell))._replace(
                W=h.U, U=h.W, WS=h.US, US=h.WS, Wl=h.Ul, Ul=h.Wl))  # fmt: skip
        elif spoiled == "exchanged in models":
            twice = kind.modelled
            monkeypatch.setattr(kind, "modelled", lambda self, models, S, ell: twice(self, models, S, ell)[::-1])
        elif spoiled == "M = 0":
            settings = replace(settings, steep=0.0)
        else:  # a tail as large as the first term
            relation.tail = flint.arb(0, 2 * relation.leading)
        with pytest.raises(Undecided):
            prove_box(relation, box, settings, r, series)


def spoiled_series(relation, box, settings, n, by):
    """The series of another program, with one coefficient off."""
    made = grown(relation, *map(rational, box), settings, flint.arb(1) / 2)
    models = Models(settings.D, relation.s0, flint.arb(0), 0)
    rows = [flint.arb_poly([made.L[i] + (by if i == n else 0)]) for i in range(settings.N)]
    left = residual(relation, models, rows, flint.arb_poly([made.r]))
    parts = [left[i] for i in range(settings.D + 1)]
    return made._replace(L=flint.arb_poly([row[0] for row in rows]), residual=parts[settings.N :],
                         low=parts[: settings.N])  # fmt: skip


def test_a_tail_holds_what_is_cut():
    with balls_at(96):
        zero = next_zero(TANGENCY, constant("tau", "2")).zero
        coarse = gravity(TANGENCY, zero, Fraction(1, 2), 96, 1.0)
        fine = gravity(TANGENCY, zero, Fraction(1, 2), 96, 1e-25)
        cut = sum(k * abs(b) * coarse.s0() ** k for k, b in enumerate(fine.b) if k >= len(coarse.b))
        assert len(fine.b) > len(coarse.b)
        assert cut < coarse.tail(0)


def test_the_bound_of_what_a_series_leaves_out_holds_it(monkeypatch):
    """With fewer terms: the others lie within the bound, of values and of derivatives, and the bound is not idle."""
    osc, tau, reach = MODELS["Duffing"]
    zero = next_zero(osc, constant("tau", tau)).zero
    with balls_at(96):
        fine = nonlinear.nonlinear_relation(osc, zero, reach, 96)
        monkeypatch.setattr(nonlinear, "TERMS", 3)
        coarse = nonlinear.nonlinear_relation.__wrapped__(osc, zero, reach, 96)
        bound, coarse.tail, fine.tail = coarse.tail, flint.arb(0), flint.arb(0)
        for ell in ("0", "0.3", "0.9", "1", "-0.5"):
            one, other = (each.hats(fine.s0, flint.arb(ell)) for each in (coarse, fine))
            gaps = [abs(a - b) for a, b in zip(one[:6], other[:6], strict=True)]
            assert all(bound.contains(gap) for gap in gaps)
            assert max(gaps) > bound.rad() / 1e6
        models = Models(3, fine.s0, flint.arb(0), 0)
        wide, narrow = coarse.modelled(models, models.S, flint.arb_poly(["0.3"])), fine.hats(fine.s0, flint.arb("0.3"))
        assert wide[0](fine.s0).contains(narrow.W)
        assert wide[1](fine.s0).contains(narrow.U)


def test_of_a_nonlinear_model_the_speed_is_bounded(proved):
    """A flight of a stiffening spring that is fast enough is back at once: the theorem stops before."""
    found = proved("Duffing")
    assert MODELS["swan"][0].certified_gamma("2", reach="1/16").fastest is None
    fastest, tau = float(found.fastest.value), found.zero.tau - 0.99 * float(found.duration.value)
    for part in (0.02, 0.3, 0.99):
        assert found.oscillator.impact_map(tau, part * fastest).tau > found.zero.tau  # above gamma: no impact before
    assert found.oscillator.impact_map(tau, 2000 * fastest).tau < found.zero.tau
    assert "linear models alone" in found.notes["after"]


def test_an_interval_of_r_is_covered():
    found = TANGENCY.certified_gamma(reach="1/8", restitution=("0.45", "0.55"))
    with balls_at(96):
        for one, other in zip(found.boxes, found.boxes[1:], strict=False):
            assert one.high == other.low
        ends = [restitution_at(1, rational(end)) for end in (found.boxes[0].low, found.boxes[-1].high)]
        assert ends[0] <= flint.arb("0.45")
        assert ends[1] >= flint.arb("0.55")
    assert found.grow > 1
    single = TANGENCY.certified_gamma(reach="1/8")
    holds = [box for box in found.boxes if box.low <= single.boxes[0].low and single.boxes[0].high <= box.high]
    assert len(holds) == 1
    for wide, narrow in zip(holds[0].series, single.boxes[0].series, strict=True):
        assert wide.contains(narrow)
    with pytest.raises(si.InputError, match="one restitution"):
        found.threshold("2.45")


@pytest.mark.slow
@pytest.mark.parametrize(("name", "reach"), [("tangency", "1/4"), ("swan", "1/4")])
def test_all_r(name, reach):
    osc, tau, _ = MODELS[name]
    found = osc.certified_gamma(tau, reach=reach, restitution=("0.05", "0.95"))
    assert found.reach == Fraction(reach)
    assert found.grow > 1
    assert len(found.boxes) < 80


def test_after_a_tangency_contact_is_lost(proved):
    """True orbits from above gamma have at most one impact in the time that is proved."""
    found = proved("tangency")
    assert found.settled is None
    end = found.zero.tau + float(found.lost.time)
    assert 1.25 < float(found.lost.time) < 1.2661
    for share in (0.2, 0.6, 0.99):
        tau = found.zero.tau - share * float(found.duration.value)
        v = float(found.threshold(tau).value)
        for factor in (1.01, 1.3, 2.0):
            orbit = found.oscillator.orbit(tau, factor * v, 60)
            assert sum(found.zero.tau < place < end for place in orbit.tau.tolist()) <= 1


def test_after_a_swan_chatter_completes(proved):
    """From above gamma, up to the proved speed: passes tau_*, and is at rest before the proved end."""
    found = proved("swan")
    assert found.lost is None
    settled, passed = found.settled, 0
    for share in (0.3, 0.7, 1.0):
        S = share * float(settled.launch)
        tau = found.zero.tau - float(flint.arb(S).atan().mid())
        top = float(settled.speed) * (1 + S * S) ** 0.5
        gamma = float(found.threshold(tau if share < 1 else tau + 1e-9).value)
        for part in (0.02, 0.5, 0.98):
            v = gamma + part * (top - gamma)
            limit = found.oscillator.chatter_limit(tau, v)
            assert limit.status == si.Status.complete
            assert found.zero.tau < limit.tau < found.zero.tau + float(flint.arb(float(settled.end)).atan().mid())
            passed += 1
    assert passed == 9


def test_below_chatter_completes_before(proved):
    for name in ("tangency", "swan"):
        found = proved(name)
        tau = found.zero.tau - 0.2
        bound = found.threshold(tau)
        limit = found.oscillator.chatter_limit(tau, float(bound.value) - 2 * float(bound.radius))
        assert limit.tau < found.zero.tau


def test_a_reach_that_is_not_proved_is_halved_and_said():
    found = TANGENCY.certified_gamma(reach=1)
    assert found.reach == Fraction(1, 2)
    assert "S <= 1:" in found.notes["reach"]


@pytest.mark.slow
def test_next_to_a_swan_the_reach_is_short():
    near = si.linear(2, "0.999", "0.5").certified_gamma(2)
    assert near.reach < Fraction(1, 10)
    assert "leaves 0 < l < 1" in near.notes["reach"]


def test_where_a_c_is_positive_nothing_is_proved():
    found = MODELS["free"][0].certified_gamma(reach="1.2")
    assert found.reach < Fraction(6, 5)
    assert "a_c is not shown to be negative" in found.notes["reach"]


@pytest.mark.parametrize(
    ("osc", "options", "why"),
    [
        (si.ImpactOscillator("x + xdot*abs(xdot)", "cos(3*t)", 0, "0.7"), {}, "not smooth where abs changes sign"),
        (si.linear(2, "0.3", 1), {}, "in \\(0, 1\\)"),
        (si.ImpactOscillator("x", "cos(2*t)", "0.3", "-0.5*v + 0.1*v**2"), {}, "a number r"),
        (si.linear(2, -2, "0.5"), {}, "at no phase"),
        (si.linear(2, 2, "0.5"), {}, "no zero"),
        (TANGENCY, {"tau": "0"}, "a_c\\(tau\\) < 0"),
        (TANGENCY, {"reach": 0}, "> 0"),
        (TANGENCY, {"reach": "pi"}, "rational"),
        (TANGENCY, {"restitution": ("0.6", "0.5")}, "low < high"),
        (TANGENCY, {"restitution": 3}, "two rational"),
    ],
)
def test_bad_input(osc, options, why):
    with pytest.raises(si.InputError, match=why):
        osc.certified_gamma(**options)


def test_launch_times_outside_are_refused(proved):
    with pytest.raises(si.InputError, match="launch time from"):
        proved("tangency").threshold(2)
