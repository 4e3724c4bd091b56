"""Border orbits: their numbers in doubles and digits, the proof, the cascade beside them, and what attracts there."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction
from functools import cache

import mpmath
import numpy as np
import pytest
from matplotlib.figure import Figure
from scipy.integrate import solve_ivp

import singimpact as si
from singimpact.algebra import Balls, balls_at, exact
from singimpact.branches import Releases, border_digits, cascade, settled_orbit
from singimpact.cli import as_listed
from singimpact.flights import AnalyticFlow
from singimpact.inputs import InputError
from singimpact.scenes import draw_border

DUFFING = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(omega*t)", 0.55, 0.5, {"omega": 2.8})
LINEAR = {"3/10": (0.47, 0.475), "1/2": (0.6, 0.61), "4/5": (0.81, 0.82)}


def linear(r):
    return si.linear("2.8", 0, r)


@cache
def doubles(name):
    """The border orbit of a model in doubles."""
    if name == "duffing":
        (found,) = si.border_orbits(DUFFING, between=(0.53, 0.55), points=3)
    else:
        (found,) = si.border_orbits(linear(name), between=LINEAR[name], points=3)
    return found


@cache
def certified(r):
    (found,) = si.border_orbits(linear(r), between=LINEAR[r], points=3, digits=30)
    return found


SLOW = pytest.param("4/5", marks=pytest.mark.slow)
"""Its cascade has 60 edges; those of the others 16 and 27."""


# ---- its number


def test_the_one_of_the_issue():
    found = doubles("1/2")
    assert 0.60 < found.parameter < 0.61
    assert (found.period, found.side, found.status) == (1.0, "above", si.Status.hit)
    assert abs(si.threshold(found.oscillator, found.tau).v - found.v) < 1e-15
    assert abs(found.oscillator.acceleration(found.release)) < 1e-15
    assert "back on gamma after one period; chatter completes above" in repr(found)


@pytest.mark.parametrize("r", ["3/10", pytest.param("1/2", marks=pytest.mark.slow), SLOW])
def test_doubles_are_within_their_error_of_the_certified_number(r):
    one, many = doubles(r), certified(r)
    assert many.certified is not None
    assert many.certified.radius < 1e-30
    off = abs(float(many.parameter - mpmath.mpf(one.parameter)))
    assert off <= one.error < 1e-14
    assert many.certified.contains(many.parameter)


@pytest.mark.slow
def test_more_digits_lie_in_the_ball():
    found = si.border_orbits(linear("1/2"), between=(0.604, 0.605), points=2, digits=45)[0]
    assert certified("1/2").certified.contains(exact("c", found.parameter))
    assert not certified("1/2").certified.contains(exact("c", found.parameter) + Fraction(1, 10**28))


@pytest.mark.parametrize(
    ("r", "narrow"), [pytest.param(*case, marks=pytest.mark.slow) for case in (("3/10", 1e-19), ("1/2", 1e-16))]
)
def test_edges_lead_to_the_same_number(r, narrow):
    """An edge is where an impact meets a zero of a_c: it knows nothing of gamma. Their limit is the border orbit."""
    with mpmath.workdps(40):
        a, b, c = (mpmath.mpf(each) for each in certified(r).cascade.parameter[-3:])
        limit = c - (c - b) ** 2 / ((c - b) - (b - a))
        assert abs(limit - certified(r).parameter) < narrow


@pytest.mark.parametrize("name", ["3/10", "1/2", SLOW, "duffing"])
def test_chatter_completes_on_one_side_and_not_on_the_other(name):
    """By `osc.orbit`, which knows no gamma."""
    found, start = doubles(name), DUFFING if name == "duffing" else linear(name)
    for distance in (3e-3, 1e-5, 1e-8, 1e-11):
        for sign in (1, -1):
            osc = start.replace(clearance=found.parameter + sign * distance)
            tau = next(float(at.tau) for at in si.tangency_points(osc) if at.kind == "gamma")
            orbit = osc.orbit(tau, 0, impacts=400)
            end = tau + 2 * np.pi / 2.8
            first = orbit.tau[orbit.kind == "complete"]
            assert bool(first.size and first[0] < end) == (sign > 0), (distance, sign)


def test_runge_kutta_sees_both_fates():
    """DOP853 of scipy, restarted at each impact."""
    found = doubles("duffing")
    for sign in (1, -1):
        c = found.parameter + sign * 2e-3
        ours = found.returned.flown(c)
        times, speeds = _runge_kutta(c, ours.tau, ours.zeros[0])
        count = min(len(times), ours.times.size)
        assert count > 4
        assert np.abs(np.array(times[:count]) - ours.times[:count]).max() < 1e-8
        assert np.abs(np.array(speeds[:count]) - ours.speeds[:count]).max() < 1e-8
        assert (times[-1] > ours.zeros[0]) == (ours.place == 0) == (sign < 0)


def _runge_kutta(c, start, end):
    """Times and velocities after impacts, until one is beyond the end or the chatter left is far shorter."""

    def field(t, state):
        x, u = state
        return [u, np.cos(2.8 * t) - x - 0.1 * u - 0.3 * x**3]

    def wall(_, state):
        return state[0] - c

    wall.terminal, wall.direction = True, -1
    times, speeds, tau, v = [], [], start, 0.0
    while tau < end:
        push = np.cos(2.8 * tau) - c - 0.3 * c**3
        if v and push < 0 and 2 * v / -push < (end - tau) / 50:
            break
        step = 0.5 if not v or push >= 0 else 0.4 * v / -push
        found = solve_ivp(field, (tau, tau + 5), [c, v], "DOP853", events=wall, rtol=1e-12, atol=1e-15, max_step=step)
        tau, v = float(found.t_events[0][-1]), -0.5 * float(found.y_events[0][-1][1])
        times.append(tau)
        speeds.append(v)
    return times, speeds


def test_fates_are_those_of_orbits():
    """Place by place over the clearance, against the first lift-off of `osc.orbit`."""
    for c in np.linspace(0.47, 0.97, 13).tolist():
        ours = Releases(linear("1/2"), "clearance", 12).flown(c, 0)
        orbit = ours.model.orbit(ours.tau, 0, impacts=900)
        lifted = orbit.tau[orbit.kind == "release"]
        turns = round((lifted[0] - ours.tau) / (2 * np.pi / 2.8)) if lifted.size else 0
        assert ours.decided
        assert ours.place == (turns if turns <= 12 else 0)


@pytest.mark.parametrize(
    ("over", "between", "value"),
    [
        ("omega", (2.78, 2.82), 2.8),
        pytest.param("restitution", (0.25, 0.35), 0.3, marks=pytest.mark.slow),
        pytest.param("amplitude", (0.95, 1.05), 1.0, marks=pytest.mark.slow),
        pytest.param("damping", (-0.01, 0.02), 0.0, marks=pytest.mark.slow),
        pytest.param("stiffness", (0.9, 1.1), 1.0, marks=pytest.mark.slow),
    ],
)
def test_any_number_of_the_model_gives_the_same_orbit(over, between, value):
    """With c at the border orbit of r = 3/10, omega = 2.8 the border orbit over r lies at 3/10, and so on."""
    osc = linear("0.3").replace(clearance=exact("c", certified("3/10").parameter))
    (found,) = si.border_orbits(osc, over, between, points=3)
    assert abs(found.parameter - value) <= found.error < 1e-12
    assert found.side == ("above" if over in ("damping", "stiffness") else "below")


@pytest.mark.slow
def test_returns_after_more_periods():
    found = si.border_orbits(linear("1/2"), between=(0.5, 0.62), periods=3, points=160, digits=20)
    assert [each.period for each in found] == [3] * (len(found) - 1) + [1]
    assert [each.side for each in found] == [("above", "below")[i % 2] for i in range(len(found))]
    assert len(found) >= 5
    assert all(each.certified is not None for each in found)
    plain = si.border_orbits(linear("1/2"), between=(0.5, 0.62), periods=3, points=160)
    for one, many in zip(plain, found, strict=True):
        assert abs(float(many.parameter - mpmath.mpf(one.parameter))) <= one.error


def test_two_releases_in_a_period():
    osc = si.ImpactOscillator("x", "cos(2*t) + 0.6*cos(4*t + 0.3)", 0.6, "0.6")
    found = si.border_orbits(osc, between=(0.87, 0.92), points=4)
    assert len(found) == 1
    assert len(found[0].returned.phases) in (1, 2)
    assert abs(si.threshold(found[0].oscillator, found[0].tau).v - found[0].v) < 1e-14


@pytest.mark.slow
def test_a_law_of_restitution():
    osc = si.ImpactOscillator("x", "cos(2.8*t)", 0.6, "-0.6*v + 0.1*v**2")
    (found,) = si.border_orbits(osc, between=(0.68, 0.7), points=5)
    assert abs(found.cascade.limit[0] / float(si.fixed_points.tangency("0.6").mu.value) - 1) < 1e-6


# ---- the proof


def test_a_wrong_number_is_not_proved():
    found, right = doubles("3/10").returned, exact("c", certified("3/10").certified.value)
    assert border_digits._proved(found, right, 25)[0] is not None
    for wrong in (right + Fraction(1, 10**23), right - Fraction(1, 10**23)):
        proof, note = border_digits._proved(found, wrong, 25)
        assert proof is None
        assert "one fate" in note


def test_the_other_side_is_not_proved():
    turned = replace(doubles("3/10").returned, side=-1)
    assert border_digits._proved(turned, exact("c", certified("3/10").certified.value), 25)[0] is None


def test_where_a_c_does_not_press_nothing_is_followed():
    """The entry is an impact after which a_c presses up to the zero: the release itself is none."""
    found = doubles("3/10").returned
    ends = found.ends(found.releases.model(found.value))
    with balls_at(200):
        flow = AnalyticFlow(found.releases.model(found.value), 200)
        assert border_digits._followed(flow, ends, found.entry) is not None
        assert border_digits._followed(flow, ends, 0) is None
        assert border_digits.rising_zero(flow, ends[0] + 0.1) is None
        # `presses` asks for a_c up to half of what was looked at before the zero, so the zero must not be nearer
        zeros = [border_digits.rising_zero(flow, ends[0] + off, Fraction(1, 64)) for off in (0.007, 0.009, 0.014)]
        assert [zero is None for zero in zeros] == [False, True, True]


def test_a_flow_of_all_numbers_in_a_ball_contains_each():
    osc = si.linear("2.8", "0.6", "0.5", damping="0.05")
    for name, middle in (("clearance", 0.6), ("restitution", 0.5), ("omega", 2.8), ("damping", 0.05)):
        with balls_at(160):
            low, high = Fraction(middle) - Fraction(1, 10**9), Fraction(middle) + Fraction(1, 10**9)
            wide = AnalyticFlow(osc, 160, (name, Balls(160).interval(low, high)))
            hit = wide.first_hit(wide.number(Fraction(3)), wide.number(Fraction(1, 5)))
            for value in (low, high, Fraction(middle)):
                one = AnalyticFlow(osc.replace(**{name: value}), 160)
                inside = one.first_hit(one.number(Fraction(3)), one.number(Fraction(1, 5)))
                assert hit.time.contains(inside.time)
                assert (wide.r * hit.velocity).contains(one.r * inside.velocity)
            assert hit.time.rad() < 1e-6


def test_analytic_flows_of_all_numbers_in_a_ball_contain_each():
    numbers = {"omega": "2.8", "b": "0.1"}
    osc = si.ImpactOscillator("x + b*xdot + 0.3*x**3", "cos(omega*t)", "0.55", "0.5", numbers)
    for name, middle in (("clearance", 0.55), ("restitution", 0.5), ("omega", 2.8), ("b", 0.1)):
        with balls_at(160):
            low, high = Fraction(middle) - Fraction(1, 10**9), Fraction(middle) + Fraction(1, 10**9)
            wide = AnalyticFlow(osc, 160, (name, Balls(160).interval(low, high)))
            hit = wide.first_hit(wide.number(Fraction(3)), wide.number(Fraction(1, 5)))
            for value in (low, high, Fraction(middle)):
                one = AnalyticFlow(osc.replace(**{name: value}), 160)
                inside = one.first_hit(one.number(Fraction(3)), one.number(Fraction(1, 5)))
                assert hit.time.contains(inside.time)
                assert (wide.r * hit.velocity).contains(one.r * inside.velocity)
                assert wide.acceleration(wide.number(Fraction(3)), 1).contains(
                    one.acceleration(one.number(Fraction(3)), 1))  # fmt: skip
            assert hit.time.rad() < 1e-6


@pytest.mark.parametrize(
    ("over", "between"),
    [
        pytest.param("clearance", (0.5404, 0.5405), marks=pytest.mark.slow),
        ("restitution", (0.5176, 0.5177)),
        pytest.param("damping", (-0.12, -0.119), marks=pytest.mark.slow),
    ],
)
def test_nonlinear_models_are_certified(over, between):
    (found,) = si.border_orbits(DUFFING, over, between=between, points=2, digits=18)
    assert found.certified.contains(found.parameter)
    assert found.certified.radius < 1e-18
    assert found.notes == ()
    (rough,) = si.border_orbits(DUFFING, over, between=between, points=2)
    assert abs(float(found.parameter - mpmath.mpf(rough.parameter))) <= rough.error
    right = exact("c", found.certified.value)
    for wrong in (right + Fraction(1, 10**8), right + Fraction(1, 10**16), right - Fraction(1, 10**16)):
        proof, note = border_digits._proved(rough.returned, wrong, 18)
        assert proof is None
        assert "one fate" in note


@pytest.mark.slow
def test_a_restitution_that_is_a_law_is_not_certified_and_says_so():
    osc = si.ImpactOscillator("x", "cos(2.8*t)", 0.6, "-0.6*v + 0.1*v**2")
    (found,) = si.border_orbits(osc, between=(0.68, 0.7), points=2, digits=16)
    assert found.certified is None
    assert found.notes == ("not certified: balls fly orbits of models with a number below 1 for restitution",)


# ---- the cascade


@pytest.mark.parametrize(
    "name", ["3/10", SLOW, *(pytest.param(name, marks=pytest.mark.slow) for name in ("1/2", "duffing"))]
)
def test_edges_shrink_by_mu_to_six_digits(name):
    found = doubles(name).cascade
    mu = float(si.fixed_points.tangency("1/2" if name == "duffing" else name).mu.value)
    limit, error = found.limit
    assert abs(float(found.mu) - mu) < 1e-15 * mu
    assert abs(limit - mu) <= error < 1e-6 * mu
    assert np.array_equal(np.diff(found.impacts), np.ones(len(found) - 1))
    # the ratios themselves come near it, each within its error and what is left of the cascade
    best = int(np.argmin(np.abs(found.ratios - mu) + found.errors))
    assert abs(found.ratios[best] - mu) < 2e-6 * mu


@pytest.mark.slow
@pytest.mark.parametrize("r", ["3/10", "1/2"])
def test_with_digits_the_ratios_themselves_are_mu(r):
    found = certified(r).cascade
    assert abs(found.ratios[-1] / found.mu - 1) < 1e-9
    limit, error = found.limit
    assert abs(limit - float(found.mu)) <= error + 1e-15
    assert "the edges go on" in found.notes[0]


@pytest.mark.slow
def test_with_digits_at_four_fifths():
    found = certified("4/5").cascade
    assert abs(found.ratios[-1] / found.mu - 1) < 1e-8
    assert abs(found.limit[0] - float(found.mu)) <= found.limit[1] + 1e-15


@pytest.mark.slow
def test_with_digits_of_a_nonlinear_model():
    found = si.border_orbits(DUFFING, between=(0.53, 0.55), points=6, digits=22)[0].cascade
    assert abs(found.ratios[-1] / found.mu - 1) < 1e-6


def test_numbers_of_impacts_are_those_of_orbits():
    """Between two edges, by `osc.orbit`."""
    found = doubles("1/2").cascade
    for i in range(0, len(found) - 1, 4):
        osc = linear("1/2").replace(clearance=float(found.parameter[i] + found.parameter[i + 1]) / 2)
        tau = next(float(at.tau) for at in si.tangency_points(osc) if at.kind == "gamma")
        orbit = osc.orbit(tau, 0, impacts=60)
        assert np.count_nonzero(orbit.tau[1:] < tau + 2 * np.pi / 2.8) == found.impacts[i]


def test_a_wrong_mu_would_be_seen():
    limit, error = doubles("1/2").cascade.limit
    for r in ("0.499999", "0.500001"):
        assert abs(limit - float(si.fixed_points.tangency(r).mu.value)) > 3 * error


@pytest.mark.parametrize("name", ["3/10", "1/2", pytest.param("duffing", marks=pytest.mark.slow)])
def test_windows_hold_attractors_whose_multipliers_fall_by_lambda_squared_mu(name):
    windows = doubles(name).cascade.windows
    at = si.fixed_points.tangency("1/2" if name == "duffing" else name)
    share = float(at.lambda_.value**2 * at.mu.value)
    deep = windows[-6:]
    assert all(each.orbit.stable and (each.orbit.n, each.orbit.k) == (each.impacts, 1) for each in deep)
    sizes = [abs(each.orbit.multipliers[0]) for each in deep]
    shares = np.array(sizes[1:]) / sizes[:-1]
    # a multiplier differs from its limit by a part of itself
    assert (np.abs(shares / share - 1) < 0.04 * np.array(sizes[:-1]) + 1e-4).all(), shares


def test_attractors_solve_closing_conditions():
    """`osc.periodic` finds the same orbits with the same multipliers, where impacts are not too weak for it."""
    for window in doubles("1/2").cascade.windows:
        if window.orbit is None or window.orbit.v.min() < 1e-7:
            continue
        orbit = window.orbit
        states = list(zip(orbit.tau.tolist(), orbit.v.tolist(), strict=True))
        (same,) = orbit.oscillator.periodic(int(orbit.n), orbit.k, start=states)
        assert same.visible
        assert np.abs(same.v - orbit.v).max() < 1e-9
        assert abs(same.multipliers[0] - orbit.multipliers[0]) < 1e-5


def test_settled_orbits():
    """Of one impact, with rest, and none at all."""
    (one,) = linear("1/2").replace(omega=4).periodic(1, 2)
    found = settled_orbit(one.oscillator, 0, 1)
    assert (found.n, found.k) == (1, 2)
    assert np.abs(found.multipliers - one.multipliers).max() < 1e-8
    resting = settled_orbit(si.linear(2, "0.7", "0.5"), 0, 0.3)
    assert (resting.kind, resting.k) == ("chatter", 1)
    assert settled_orbit(si.linear("2.8", 0, "0.8"), 0.1, 0.5) is None


def test_aitken_and_edges_of_a_plain_sequence():
    assert cascade._aitken(1.5, 1.25, 1.125) == 1.0
    assert cascade._regular([(4, 3), (3, 5), (2, 5), (1, 6), (0.5, -1)]) == []


# ---- what is not found, and refusals


def test_nothing_found_says_where_it_was_looked_for():
    found = si.border_orbits(linear("1/2"), between=(0.7, 0.8), points=4)
    assert list(found) == []
    assert not found.complete
    assert found.notes[0].startswith("looked for at 4 values of clearance, 0.0333 apart")
    assert "periods= looks further" in found.notes[1]


def test_a_swan_inside_is_named():
    found = si.border_orbits(linear("1/2"), between=(0.9, 1.1), points=5)
    assert any("the number of releases changes (a swan)" in note for note in found.notes)


@pytest.mark.parametrize(
    ("osc", "keywords", "sentence"),
    [
        (si.universal(1, "1/2"), {}, "one with a period"),
        (si.linear(2, 0, 1), {"between": (0.1, 0.2)}, "gives r = 1"),
        (linear("1/2"), {"over": "mass"}, "unknown number of the model 'mass'"),
        (linear("1/2"), {"between": (0.7, 0.6)}, "two numbers, the lower end first"),
        (linear("1/2"), {"over": "restitution", "between": (0.7, 1.2)}, r"low < high in \(0, 1\)"),
        (linear("1/2"), {"points": 1}, "points = 1 is not accepted"),
        (linear("1/2"), {"periods": 0}, "periods = 0 is not accepted"),
        (3, {}, "an ImpactOscillator"),
    ],
)
def test_refusals(osc, keywords, sentence):
    with pytest.raises(InputError, match=sentence):
        si.border_orbits(osc, **keywords)


# ---- shown


@pytest.mark.slow
def test_picture():
    upper, lower = Figure().subplots(2)
    draw_border(doubles("3/10"), upper, lower)
    assert upper.get_xscale() == lower.get_yscale() == "log"
    stairs = upper.lines[0].get_ydata()
    assert set(np.diff(stairs)) == {0, 1}
    words = [text.get_text() for text in lower.get_legend().get_texts()]
    assert "attractor that closes at each return" in words
    assert si.plot(doubles("3/10"), Figure().add_subplot()).get_xlabel().startswith("distance from the border orbit")


def test_cascade_as_json():
    cascade = as_listed(doubles("3/10"), True)["cascade"]
    assert cascade["attractors"][-1]["k"] == 1
    assert abs(cascade["limit"] / cascade["mu"] - 1) < 1e-6


@pytest.mark.slow
def test_command(singimpact, tmp_path):
    asked = ["border", "--omega", "2.8", "--clearance", "0", "--restitution", "3/10", "--from", "0.47", "--to", "0.475",
             "--points", "3"]  # fmt: skip
    (orbit,) = json.loads(singimpact(*asked, "--digits", "18", "--json").stdout)["orbits"]
    assert orbit["parameter"].startswith("0.4721987864319425")
    assert orbit["certified"]["value"].startswith("0.4721987864319425")
    shown = singimpact(*asked, "--cascade", "-o", tmp_path / "cascade.png").stdout
    assert "chatter completes above" in shown
    assert "ratio to the next" in shown
    assert (tmp_path / "cascade.png").stat().st_size > 10_000
    none = singimpact(*asked[:7], "--from", "0.7", "--to", "0.8", "--points", "3", "-o", tmp_path / "none.png")
    assert none.exit_code == 2
    assert "no border orbit to draw" in none.stderr


# ---- polynomials, whose orbits come to a later zero: at a contact of order three


def cubic(p, r, q="-0.25"):
    return si.ImpactOscillator("0", f"t**3 - {p}*t + q", 0, r, {"q": q})


def falls_short(q, r):
    """Whether chatter of the orbit released at the first zero of t^3 - t + q completes before the third, by roots."""
    a = np.polynomial.Polynomial([q, -1, 0, 1])
    first, _, third = sorted(a.roots().real)
    tau, v = first, 0.0
    while True:
        rise = a(np.polynomial.Polynomial([tau, 1])).integ(2) + np.polynomial.Polynomial([0, v])
        roots = rise.roots()
        hits = roots[(np.abs(roots.imag) < 1e-7) & (roots.real > 1e-3 * (third - tau) if v == 0 else roots.real > 1e-9)]
        if not hits.size or tau + hits.real.min() > third:
            return False
        flown = hits.real.min()
        tau, v = tau + flown, -r * float(rise.deriv()(flown))
        # what is left of the chatter under a constant push as strong as that here, where the push gets weaker
        if 2 * v / (-a(tau) * (1 - r)) < 1e-2 * (third - tau):
            return True


@pytest.mark.parametrize(
    ("r", "kappa"),
    [
        ("0.1", 0.163343),
        ("0.2", 0.184898),
        ("0.3", 0.205491),
        ("0.5", 0.247345775310),
        ("0.8", 0.318475),
        ("0.95", 0.363684),
    ],
)
def test_a_border_orbit_between_the_swans_of_a_contact_of_order_three(r, kappa):
    """From the first zero to gamma of the third; the witness flies polynomials and finds their roots by eigenvalues."""
    (found,) = si.border_orbits(cubic(1, r), "q", (-0.38, -0.13), points=5)
    assert abs(found.parameter + kappa) < 2e-6
    assert found.side == "below"
    assert np.isnan(found.period)
    assert found.as_dict()["periods"] is None
    low, high = -0.38, -0.13
    for _ in range(30):
        middle = (low + high) / 2
        low, high = (middle, high) if falls_short(middle, float(r)) else (low, middle)
    assert abs(found.parameter - low) < 1e-7
    assert f"back on gamma after the time {found.end - found.release:.9g}" in repr(found)


def test_the_coefficient_of_its_curve_does_not_depend_on_the_scale():
    """q = kappa |p|^(3/2), to 25 digits and certified."""
    (one,) = si.border_orbits(cubic(1, "1/2"), "q", (-0.26, -0.24), points=3, digits=25)
    (four,) = si.border_orbits(cubic(4, "1/2", "-2"), "q", (-2.08, -1.92), points=3, digits=25)
    with mpmath.workdps(40):
        apart = 8 * one.certified.value - four.certified.value
        assert abs(apart) <= 8 * one.certified.radius + four.certified.radius
    assert one.certified.contains(Fraction("-0.2473457753104248057909067350"))
    assert not one.certified.contains(Fraction("-0.2473457753104248057909167350"))


@pytest.mark.parametrize("r", ["0.9", "0.95", "0.99"])
def test_its_digits_where_little_is_lost(r):
    """Each impact forgets little of the cut of gamma there, so that the search begins with more of them."""
    (found,) = si.border_orbits(cubic(1, r), "q", ("-0.3848", "-0.13"), digits=20)
    assert found.certified.radius < 1e-20
    low, high = (float(found.parameter) + off for off in (-1e-7, 1e-7))
    assert (falls_short(low, float(r)), falls_short(high, float(r))) == (True, False)


def test_without_rebound_it_ends_at_a_closed_form():
    """The hop lands on the third zero for q = -56/57^(3/2); near r = 0 the distance is like sqrt(r)."""
    limit = -56 / 57**1.5
    off = [
        si.border_orbits(cubic(1, repr(r)), "q", (-0.16, -0.129), points=3)[0].parameter - limit for r in (1e-4, 1e-6)
    ]
    assert off[0] < off[1] < 0
    assert off[0] / off[1] == pytest.approx(10, rel=0.05)


def test_its_cascade_shrinks_by_mu():
    (found,) = si.border_orbits(cubic(1, "1/2"), "q", (-0.26, -0.24), points=3)
    assert found.cascade.limit[0] == pytest.approx(float(si.fixed_points.tangency("1/2").mu.value), rel=1e-6)


def side_for_all(q, low, high):
    """The fate of the orbit of q, for every r from low to high: -1 where chatter completes, 1 where it passes."""
    osc = cubic(1, (low + high) / 2, str(q))
    first, _, third = sorted(np.roots([1, 0, -1, float(q)]).real.tolist())
    with balls_at(128):
        flow = AnalyticFlow(osc, 128, ("restitution", Balls(128).interval(low, high)))
        return border_digits._fate(flow, (first, third), 1)


def between(low, high, kappa, shares=(1, Fraction(7, 10), Fraction(1, 2))):
    """Whether for every r from low to high a border orbit is shown between two values of q; kappa falls with r."""
    ends = {-1: kappa(high), 1: kappa(low)}
    return all(
        any(side_for_all(at + side * share * Fraction(1, 50), low, high) == side for share in shares)
        for side, at in ends.items()
    )


@pytest.mark.slow
def test_for_every_restitution_of_an_interval_there_is_one():
    """Pieces of r: at one q all orbits of a piece fall short, at another all pass, so between them each has its own."""

    @cache
    def kappa(r):
        (found,) = si.border_orbits(cubic(1, r), "q", (-0.384, -0.13), points=5)
        return Fraction(found.parameter).limit_denominator(10**6)

    pieces, covered = [(Fraction(1, 20), Fraction(3, 5))], Fraction(1, 20)
    while pieces:
        low, high = pieces.pop()
        if high - low < Fraction(1, 50) and between(low, high, kappa):
            assert low == covered
            covered = high
        else:
            assert high - low > Fraction(1, 5000)
            pieces += [((low + high) / 2, high), (low, (low + high) / 2)]
    assert covered == Fraction(3, 5)
    # and not at the values of another restitution
    assert not between(Fraction(2, 5), Fraction(403, 1000), lambda r: kappa(r) + Fraction(1, 20))


def test_a_file_of_it_is_refused():
    (found,) = si.border_orbits(cubic(1, "1/2"), "q", (-0.26, -0.24), points=3, digits=16)
    with pytest.raises(InputError, match="the border orbit of a model without a period has no file"):
        si.certify(found)


def test_other_models_without_a_period_are_refused():
    with pytest.raises(InputError, match="give period="):
        si.border_orbits(si.ImpactOscillator("0", "exp(t) - 2", 0, "1/2"), "clearance", (0, 1))
