"""Studies of long runs beside single orbits: transients, settled classes, horizons, exponents that add up."""

import warnings
from time import process_time

import numpy as np
import pytest

import singimpact as si
from singimpact.bench import Follower, plain_orbits


def settled_class(osc, tau, v, impacts=100_000, longest=64):
    """What one orbit does after many impacts, from its events alone."""
    orbit = osc.orbit(tau, v, impacts=impacts)
    kinds = orbit.kind[-400:]
    if orbit.phases[-1][0] in ("no_return", "unresolved"):
        return orbit.phases[-1][0], 0, 0
    if "complete" in kinds or orbit.phases[-1][0] == "sticking":
        return "chatter", 0, 0
    period = osc.period_number
    for n in range(1, longest + 1):
        turns = (orbit.tau[-1] - orbit.tau[-1 - n]) / period
        if abs(turns - round(turns)) < 1e-6 and abs(orbit.v[-1] - orbit.v[-1 - n]) < 1e-6:
            return "orbit", n, round(turns)
    return "no period", 0, 0


class Drawn:
    """A linear model with its period as a double."""

    def __init__(self, rng):
        r = rng.uniform(0.3, 0.99)
        self.numbers = f"{rng.uniform(1.2, 5):.3f}", f"{rng.uniform(-0.5, 0.9):.3f}", f"{r:.3f}"
        self.model = si.linear(*self.numbers)
        self.period_number = 2 * np.pi / float(self.numbers[0])

    def orbit(self, *given, **named):
        return self.model.orbit(*given, **named)


def compare(seed, models, pixels):
    """Sampled pixels of basins beside 10^5 impacts of single orbits; the number that was compared."""
    rng, compared = np.random.default_rng(seed), 0
    for _ in range(models):
        drawn = Drawn(rng)
        found = si.basins(drawn.model, size=8)
        for place in rng.choice(64, pixels, replace=False).tolist():
            row, column = divmod(place, 8)
            run = found.attractors[found.codes[row, column]]
            if run.kind in ("chaotic", "not decided", "sensitive", "unresolved"):
                # the name says what was seen, or what would decide
                assert any(words in run.name for words in ("in 20 000 impacts", "rounding decides", "osc.orbit says"))
                continue
            seen = settled_class(drawn, float(found.tau[column]), float(found.v[row]))
            told = ("orbit", run.n, run.k) if run.kind == "orbit" else ("chatter", 0, 0)
            case = f"{drawn.numbers} from {found.tau[column]!r}, {found.v[row]!r}: {run.name}, {seen}"
            assert seen == told or (seen[0] == "no period" and run.n > 8), case
            compared += 1
    return compared


def test_pixels_of_random_models_are_what_single_orbits_do():
    assert compare(1, 3, 3) > 4


@pytest.mark.slow
def test_pixels_of_many_random_models_are_what_single_orbits_do():
    assert compare(2, 16, 5) > 40


@pytest.mark.slow
def test_chatter_for_ever_comes_back_as_plain_orbits_do():
    """Also where the impacts after a lift-off do not accumulate at once: periods of the cycle by fixed steps."""
    rng, compared, late = np.random.default_rng(8), 0, 0
    drawn = [("4.3365", "0.1677", "0.394")]
    drawn += [
        (f"{rng.uniform(3, 5):.3f}", f"{rng.uniform(0, 0.3):.3f}", f"{rng.uniform(0.3, 0.5):.3f}") for _ in range(40)
    ]
    for numbers in drawn:
        model = si.linear(*numbers)
        found = si.basins(model, size=4)
        for run in found.attractors:
            assert run.kind != "not decided" or "chatter" not in {each.kind for each in found.attractors}, (
                numbers,
                found,
            )
            if run.kind != "chatter":
                continue
            follower = Follower(plain_orbits(model, float(numbers[0]), 200.0, 2.0), 2.0, 20_000, 200.0)
            first = follower.first(float(found.tau[0]), float(found.v[-1]))
            if first.kind == "chatter":
                assert follower.last(first).k == run.k, (numbers, run.name)
                compared, late = compared + 1, late + (run.k > 2)
    assert compared > 10
    assert late > 1


def test_a_long_chaotic_transient_ends_on_its_orbit():
    """289 of 300 states of this model settle on the (2, 2) orbit, half of them after more than 3800 impacts."""
    found = si.basins(si.linear("3.3", "0.03", "0.95"), size=14)
    shares = {name: share for _, name, share in found.classes}
    settled = sum(share for name, share in shares.items() if "in 20 000 impacts" not in name)
    assert shares["(2, 2) orbit"] >= 0.95 * settled
    assert settled > 0.85
    early = si.basins(si.linear("3.3", "0.03", "0.95"), size=8, impacts=300)
    assert any("no period in 300 impacts" in name for _, name, _ in early.classes)


def test_a_chaotic_orbit_is_no_periodic_one_that_came_back_by_chance():
    """An attractor that is nearly a curve, with an exponent of 0.05: orbits of 81 and 228 impacts were seen there."""
    found = si.basins(si.linear("1.865", "0.384", "0.653", damping="0.48"), size=14)
    assert {run.kind for run in found.attractors} == {"chaotic"}


@pytest.mark.slow
def test_a_long_chaotic_transient_costs_its_flights():
    """2500 states fly 6000 impacts each until they settle: searches and idle lanes may add three fifths."""
    osc = si.linear("3.3", "0.03", "0.95")
    tau, v = np.meshgrid((np.arange(50) + 0.5) / 50 * 2 * np.pi / 3.3, (np.arange(50) + 0.5) / 25)
    # both compiled
    osc.iterate(tau[:2], v[:2], 200)
    si.basins(osc, size=10, impacts=300)
    ratios = []
    for _ in range(3):
        begin = process_time()
        osc.iterate(tau, v, 6000)
        between = process_time()
        found = si.basins(osc, size=50)
        ratios.append((process_time() - between) / (between - begin))
    shares = {name: share for _, name, share in found.classes}
    assert shares["(2, 2) orbit"] > 0.95
    assert min(ratios) < 1.6


def test_never_returns_is_said_of_proved_escapes_alone():
    weak = si.ImpactOscillator("0", "cos(2*t) - 1/2000", 0, "0.8")
    assert "never returns" not in {name for _, name, _ in si.basins(weak, size=2, impacts=20).classes}
    away = si.ImpactOscillator("0", "cos(2*t) + 1/2000", 0, "0.8")
    found = si.basins(away, ((0, 3), (1, 2)), size=3, impacts=50)
    for row, column in np.ndindex(found.codes.shape):
        kind = found.attractors[found.codes[row, column]].kind
        step = away.impact_map(found.tau[column], found.v[row])
        if kind == "never returns":
            assert step.status in (si.Status.hit, si.Status.escaped)
    orbit = weak.orbit(0, 1.7, impacts=5, horizon=100)
    assert "no impact within 100" in repr(orbit)
    assert "never returns" in repr(away.orbit(0.1, 1.5, impacts=200))


def test_both_exponents_add_up_to_the_mean_shrinking():
    """2 ln r n/T - d + ln(v_0/v_n)/T, for damping up to 5; no warning, no -inf of an orbit that goes on."""
    rng = np.random.default_rng(4)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        compared = 0
        for index in range(200):
            damping, r = f"{rng.uniform(0.1, 5):.2f}", f"{rng.uniform(0.5, 0.95):.2f}"
            numbers = f"{rng.uniform(0.4, 3):.2f}", f"{rng.uniform(-1, 0.2):.2f}", r
            osc = si.linear(*numbers, damping=damping, amplitude=f"{rng.uniform(1, 6):.2f}")
            found = si.lyapunov(osc, 0.1, 0.5, 300, transient=0)
            if found.superstable or not found.impacts:
                continue
            loss = 2 * np.log(float(r)) * found.impacts + np.log(found.start[1] / found.last[1])
            truth = loss / found.time - float(damping)
            assert found.exponents.sum() == pytest.approx(truth, abs=1e-9 * max(1, abs(truth))), (index, numbers)
            assert np.isfinite(found.exponents).all()
            compared += 1
    assert compared > 60


def test_a_transient_is_dropped_until_the_halves_agree():
    osc = si.linear("3.3", "0.03", "0.95")
    found = si.lyapunov(osc, 0.1, 0.5)
    orbit = next(each for each in osc.periodic(2, 2) if each.stable)
    truth = np.log(np.abs(orbit.multipliers)).max() / (2 * 2 * np.pi / 3.3)
    assert found.converged
    assert found.transient > 500
    assert found.exponents[0] == pytest.approx(truth, abs=2e-3)


@pytest.mark.parametrize("r", ["0.5", "0.8", "0.3"])
def test_iterates_of_a_chatter_that_is_over_are_complete(r):
    """A bouncing ball from v = 1 comes to rest at tau + 2/(1 - r); no iterate ends as a hit at v = 1e-182."""
    ball, tau = si.ImpactOscillator("0", "-1", 0, r), np.linspace(0, 3, 40)
    for impacts in (600, 4000):
        ends = ball.iterate(tau, 1.0, impacts)
        assert (ends.status == si.Status.complete).all()
        assert (ends.v == 0).all()
        assert ends.tau == pytest.approx(tau + 2 / (1 - float(r)), rel=1e-14)
    few = ball.iterate(tau, 1.0, 10)
    assert (few.status == si.Status.hit).all()
    assert few.v == pytest.approx(float(r) ** 10, rel=1e-12)
    kept = ball.iterate(tau[:3], 1.0, 200, keep=True)
    assert (kept.status == si.Status.complete).all()


def test_a_bifurcation_diagram_shows_settled_orbits():
    """Next to c = 0.03 all orbits end on the (2, 2) orbit, most after thousands of chaotic impacts."""
    osc = si.linear("3.3", "0.03", "0.95")
    found = si.bifurcation(osc, "clearance", ("0.029", "0.031"), 12)
    assert found.settled.all()
    on_it = 0
    for clearance, events in zip(found.values, found.events, strict=True):
        orbit = next(each for each in osc.replace(clearance=clearance).periodic(2, 2) if each.stable)
        on_it += np.abs(events[-2:, 1][:, None] - orbit.v).min(axis=1).max() < 1e-4
    assert on_it >= 10  # next to c = 0.0295 there is a (6, 6) orbit too
    hurried = si.bifurcation(osc, "clearance", ("0.029", "0.031"), 12, settle=0)
    assert hurried.settled.sum() < 6
    assert "without a period" in repr(hurried)
