"""Certified events: closed forms and other integrators lie in them, and a statement that is wrong is refused."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import flint
import mpmath
import numpy as np
import pytest
from closed_forms import OneImpact
from witness import integrate

import singimpact as si
from singimpact.algebra import Balls, balls_at, constant
from singimpact.branches import (
    BallClosing,
    Krawczyk,
    Spans,
    TouchingClosing,
    enclosed_event as room,
    kind_of,
    rate_over,
    return_slope,
)
from singimpact.branches.enclosed_event import enclosed_event
from singimpact.flights import Launch, Refused, timed_flight, touches_first
from singimpact.inputs import InputError

DUFFING = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "A*cos(w*t)", "0.3", "0.6", {"w": "1.7", "A": 1})
"""Of its (2, 1) orbits over A: a hidden impact at 0.6757, a fold at 0.6408, a doubling at 0.7690, a graze at 1.2185."""


def events(branch, kind):
    return [event for event in branch.events if event.kind == kind]


def near(certified, truth, relative="1e-30"):
    """Whether a number that mpmath rounded lies within the radius."""
    return abs(certified.value - truth) <= certified.radius + mpmath.mpf(relative) * abs(truth)


@pytest.fixture(scope="module")
def duffing():
    (orbit,) = DUFFING.periodic(2, 1, start=(1.95786, 0.662042))
    return si.branch(orbit, "A", (0.6, 1.3))


# ---- closed forms


@pytest.mark.parametrize(
    ("w", "r", "k"),
    [
        ("2.8", "0.8", 1),
        *(pytest.param(*case, marks=pytest.mark.slow) for case in (("2.6", "0.5", 1), ("5.2", "0.7", 3))),
    ],
)
def test_events_of_one_impact_contain_their_closed_forms(w, r, k):
    osc = si.linear(w, "0.001", r, damping="0.1")
    truth = OneImpact("0.1", r, k)
    found = si.branch(osc.periodic(1, k)[0], "clearance", (-2, 2))
    seen = set()
    for event in found.events:
        if event.kind == "hidden impact" or not event.orbit.visible:
            continue
        if event.kind == "graze" and k > 1:  # the motion without impacts touches the wall in each period
            with pytest.raises(InputError, match="above the wall before it touches it"):
                event.certified(15)
            continue
        with mpmath.workdps(45):
            ball = event.certified(25)
            w_, v = mpmath.mpf(w), ball.v[0].value
            w1, w2, *_, R = truth.parts(w_)
            if event.kind == "fold":
                c = mpmath.sqrt(R * R * (1 + (w1 * w_ / w2) ** 2))
                assert near(ball.parameter, c * mpmath.sign(ball.parameter.value), "1e-40")
            elif event.kind == "graze":
                assert near(ball.parameter, R * mpmath.sign(ball.parameter.value), "1e-40")
            else:
                share = truth.doubling(w_, mpmath.mpf(1))  # v over c
                c = R / mpmath.sqrt((1 - w1 * share) ** 2 + (w2 * share / w_) ** 2)
                assert near(ball.parameter, c * mpmath.sign(ball.parameter.value), "1e-40")
                assert abs(v - share * ball.parameter.value) < mpmath.mpf("1e-25")
            assert ball.parameter.radius < mpmath.mpf("1e-26")
        seen.add(event.kind)
    assert seen >= {"fold"}


def test_the_bouncing_ball():
    """Luck and Mehta 1993: (1, 1) orbits meet at pi (1 - r)/(1 + r), and double at a square root."""
    ball = si.ImpactOscillator("1", "G*cos(t)", 0, "0.5", {"G": "1.2"})
    kinds = set()
    for orbit in ball.periodic(1, 1):
        for event in si.branch(orbit, "G", (0.9, 1.8)).events:
            if event.orbit.visible and event.kind in ("fold", "period-doubling"):
                with mpmath.workdps(45):
                    fold = mpmath.pi / 3
                    doubling = mpmath.sqrt(fold**2 + (2 * mpmath.mpf("1.25") / mpmath.mpf("2.25")) ** 2)
                    right = fold if event.kind == "fold" else doubling
                    assert near(event.certified(30).parameter, right, "1e-43")
                kinds.add(event.kind)
    assert kinds == {"fold", "period-doubling"}


@pytest.mark.parametrize("over", ["amplitude", "omega", "damping", "stiffness", "clearance"])
def test_grazes_of_orbits_without_impact(over):
    """|c| = |A|/|1 - w^2 + i b w|, with the period that moves with omega."""
    (free,) = si.linear("0.8", -1, "0.8", damping="0.1", amplitude="-0.365").periodic(0, 1)
    at = {"amplitude": -0.365, "omega": 0.8, "damping": 0.1, "stiffness": 1.0, "clearance": -1.0}[over]
    grazes = events(si.branch(free, over, (at - 0.1, at + 0.1)), "graze")
    assert grazes
    for graze in grazes:
        ball = graze.certified(30)
        with mpmath.workdps(45):
            p = {"amplitude": "-0.365", "omega": "0.8", "damping": "0.1", "stiffness": "1", "clearance": "-1"}
            p = {name: mpmath.mpf(each) for name, each in p.items()} | {over: ball.parameter.value}
            height = abs(p["amplitude"]) / mpmath.hypot(p["stiffness"] - p["omega"] ** 2, p["damping"] * p["omega"])
            assert abs(height + p["clearance"]) < mpmath.mpf("1e-29")
        assert ball.unique_within >= 1e-6
        assert float(ball.v[0].value) == 0 == float(ball.v[0].radius)


# ---- other integrators


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["graze", "hidden impact"])
def test_runge_kutta_sees_the_touch(duffing, kind):
    (event,) = events(duffing, kind)
    ball = event.certified(20)
    model = DUFFING.replace(A=float(ball.parameter.value))
    tau, v = ([float(each.value) for each in part] for part in (ball.tau, ball.v))
    tau.append(tau[0] + float(2 * np.pi / 1.7))
    v.append(0.0)
    for i in range(len(v) - 1):
        x, u = integrate(model, tau[i], v[i], np.linspace(0, tau[i + 1] - tau[i], 400)[1:])
        assert x[-1] == pytest.approx(0.3, abs=1e-10)
        assert -0.6 * u[-1] == pytest.approx(v[i + 1], abs=1e-10)
        assert x[3:-4].min() > 0.3
    assert event.graze_time % (2 * np.pi / 1.7) == pytest.approx(tau[0] % (2 * np.pi / 1.7), abs=1e-7)


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "multiplier"), [("fold", 1.0), ("period-doubling", -1.0)])
def test_doubles_see_the_multiplier(duffing, kind, multiplier):
    (event,) = [each for each in events(duffing, kind) if each.orbit.visible]
    ball = event.certified(20)
    model = DUFFING.replace(A=float(ball.parameter.value))
    total = np.eye(2)
    for tau, v in zip(ball.tau, ball.v, strict=True):
        total = model.derivative(float(tau.value), float(v.value)).matrix @ total
    assert np.abs(np.linalg.eigvals(total) - multiplier).min() < 1e-7
    assert ball.over == "A"
    assert 1e-6 < ball.unique_within <= ball.curve_within < 1e-3


@pytest.mark.slow
def test_orbits_beside_a_fold_lie_on_the_one_curve(duffing, monkeypatch):
    """Both orbits beyond the fold are within the box, with different values of one unknown; a smaller box is said
    where the operator refuses the wide ones.
    """
    (event,) = [each for each in events(duffing, "fold") if each.orbit.visible]
    ball = event.certified(12)
    at = float(ball.parameter.value)
    near = 0
    for shift in (-1, 1):
        model = DUFFING.replace(A=at + shift * float(ball.curve_within) ** 2)
        for orbit in model.periodic(event.orbit.n, event.orbit.k):
            away = [abs(float(one) - float(other.value)) for one, other in zip(orbit.v, ball.v, strict=True)]
            near += max(away) < float(ball.curve_within)
    assert near in (0, 2)
    honest = Krawczyk.image

    def narrow(operator, point, step, radius, spread=Fraction(0)):
        wide = spread and radius > Fraction(1, 10**6)
        return None if wide else honest(operator, point, step, radius, spread)

    monkeypatch.setattr(Krawczyk, "image", narrow)
    assert event.certified(12).curve_within <= Fraction(1, 10**6)


@pytest.mark.slow
def test_more_digits_lie_in_fewer(duffing):
    for event in duffing.events:
        if event.orbit.visible:
            few, many = event.certified(12), event.certified(40)
            for one, other in zip((few.parameter, *few.tau), (many.parameter, *many.tau), strict=True):
                assert abs(one.value - other.value) <= one.radius + other.radius
            assert few.parameter.radius < 1e-12
            assert many.parameter.radius < mpmath.mpf("1e-40")


@pytest.mark.slow
def test_a_torus():
    osc = si.ImpactOscillator("x - mu*(1 - x**2)*xdot", "A*cos(w*t)", 0, "0.9", {"mu": "0.2", "A": "1.5", "w": "2.2"})
    (orbit,) = osc.periodic(1, 1, start=(2.64089, 2.19428))
    (torus,) = events(si.branch(orbit, "A", (0.5, 1.6), step=0.1), "torus")
    ball = torus.certified(20)
    model = osc.replace(A=float(ball.parameter.value))
    matrix = model.derivative(float(ball.tau[0].value), float(ball.v[0].value)).matrix
    assert np.linalg.det(matrix) == pytest.approx(1, abs=1e-10)
    assert abs(np.trace(matrix)) < 2
    assert enclosed_event("fold", torus.orbit, "A", torus.parameter, 12) != ball


# ---- the only event on its curve


@pytest.fixture(scope="module")
def doubling(duffing):
    """The doubling of the (2, 1) orbits, and A there."""
    (event,) = [each for each in events(duffing, "period-doubling") if each.orbit.visible]
    return event, event.certified(30).parameter


def over_b(doubling, text):
    """The orbit at the doubling, of the model in which A is the doubling's value plus a function of B."""
    event, at = doubling
    osc = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", f"({at} + {text})*cos(1.7*t)", "0.3", "0.6", {"B": 0})
    return replace(event.orbit, oscillator=osc)


@pytest.mark.slow
def test_a_box_with_two_doublings_is_not_said_to_have_one(doubling, monkeypatch):
    """A = A_0 + B^2 - 1e-8: the doublings at B = 1e-4 and -1e-4 are on one curve; without the rate one is denied."""
    orbit = over_b(doubling, "B**2 - 1/10**8")
    for side in (1, -1):
        found = enclosed_event("period-doubling", orbit, "B", side * 1e-4, 12)
        assert float(found.parameter.value) == pytest.approx(side * 1e-4, rel=1e-12)
        assert 1e-8 < found.unique_within < 2e-4 < found.curve_within
    monkeypatch.setattr(room, "rate_over", lambda *_: flint.arb(1))
    assert enclosed_event("period-doubling", orbit, "B", 1e-4, 12).unique_within > 2e-4


@pytest.mark.slow
def test_three_doublings_next_to_one_another_are_not_one(doubling):
    """A = A_0 + B (B^2 - d^2): the test vanishes at -d, 0 and d, wide apart or within the digits."""
    found = enclosed_event("period-doubling", over_b(doubling, "B*(B**2 - 1/10**8)"), "B", 0.0, 12)
    assert found.unique_within < 1e-4 < found.curve_within
    for text in ("B**2", "B**2 + 1/10**12"):
        assert isinstance(enclosed_event("period-doubling", over_b(doubling, text), "B", 0.0, 12), str)


@pytest.mark.slow
def test_the_curve_is_shown_to_stay_where_its_rate_is_bounded(doubling, monkeypatch):
    """In the box of the rate Krawczyk's operator is applied again: a curve of a wider box may leave it."""
    honest, shown = Krawczyk.image, []

    def recorded(operator, point, step, radius, spread=Fraction(0)):
        found = honest(operator, point, step, radius, spread)
        if found is not None and spread:
            shown.append((radius, spread))
        return found

    monkeypatch.setattr(Krawczyk, "image", recorded)
    alone = doubling[0].certified(12).unique_within
    assert (alone * room.SETTINGS.reach, alone) in shown
    refused = alone * room.SETTINGS.reach
    monkeypatch.setattr(
        Krawczyk, "image", lambda *given: None if given[3] == refused and len(given) > 4 else honest(*given)
    )
    assert doubling[0].certified(12).unique_within < alone


@pytest.mark.slow
def test_a_test_that_vanishes_at_no_rate_is_refused(doubling, monkeypatch):
    """The cube of the test has the same signs, and its rate vanishes where it does."""
    rate = room.rate_over

    def cubed(kind, closing, operator, point, radius):
        value = kind_of(kind).of_return_map(return_slope(closing.slopes(point, radius)))
        return 3 * value**2 * rate(kind, closing, operator, point, radius)

    monkeypatch.setattr(room, "rate_over", cubed)
    with pytest.raises(InputError, match="a rate of one sign"):
        doubling[0].certified(12)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["fold", "period-doubling", "torus"])
def test_the_rate_is_that_of_differences(kind, duffing):
    """Along the curve of orbits through the doubling, for each of the three tests."""
    (event,) = [each for each in events(duffing, "period-doubling") if each.orbit.visible]
    near = [Fraction(float(part)) for pair in zip(event.orbit.tau, event.orbit.v, strict=True) for part in pair]
    with balls_at(200):
        closing = BallClosing(DUFFING, 1, 30, 200, "A")
        operator = Krawczyk(closing, [*near, Fraction(event.parameter)], Fraction(1, 10**32))
        point = operator.solved([*near, Fraction(event.parameter)])
        step = Fraction(1, 10**6)
        ends = [operator.solved(operator.moved(point, shift)) for shift in (-step, step)]
        low, high = (kind_of(kind).of_return_map(return_slope(closing.slopes(end, operator.small))) for end in ends)
        rate = rate_over(kind, closing, operator, point, Fraction(1, 10**9))
        truth = float(((high - low) / (2 * Balls(200).rational(step))).mid())
        assert float(rate.mid()) == pytest.approx(truth, rel=1e-6, abs=1e-8)  # d = r^4 e^(-b T) is constant here
        assert rate.rad() < 1e-3 * abs(truth) + 1e-4
        assert (kind == "torus") == rate.contains(0)


@pytest.mark.parametrize("kind", ["fold", "period-doubling", "torus"])
def test_the_rate_of_a_matrix_is_that_of_differences(kind):
    at, change, h = flint.arb_mat([[2, 3], [5, 7]]), flint.arb_mat([[1, -4], [6, 9]]), flint.arb(2) ** -20
    high, low = (kind_of(kind).of_return_map(at + change * side) for side in (h, -h))
    assert (
        abs((high - low) / (2 * h) - kind_of(kind).rate_of_return_map(at, change)) < 1e-9
    )  # quadratic: rounding alone


# ---- statements that are wrong


@pytest.mark.slow
def test_a_parameter_off_by_one_in_the_eighth_digit_is_refused(duffing, monkeypatch):
    """The point between the ends is forged: it is an orbit of the curve, and the event is elsewhere."""
    honest = room._Curve._crossing

    def forged(self, operator, near, close):
        return operator.solved(operator.moved(honest(self, operator, near, close), Fraction(1, 10**8)))

    monkeypatch.setattr(room._Curve, "_crossing", forged)
    for kind in ("fold", "period-doubling"):
        (event,) = [each for each in events(duffing, kind) if each.orbit.visible]
        with pytest.raises(InputError, match="one sign on both sides"):
            event.certified(15)


@pytest.mark.slow
def test_a_curve_that_misses_its_ends_is_refused(duffing, monkeypatch):
    """The ends are proved orbits next to a doubling, of which one lies on no curve through the box."""
    honest = room._Curve._end

    def forged(self, operator, near, shift):
        end = honest(self, operator, near, shift)
        return end._replace(point=[part + Fraction(1, 10**8) for part in end.point])

    monkeypatch.setattr(room._Curve, "_end", forged)
    (event,) = [each for each in events(duffing, "period-doubling") if each.orbit.visible]
    with pytest.raises(InputError, match="not shown to lie on its curve"):
        event.certified(15)


@pytest.mark.slow
def test_the_event_of_another_kind_is_refused(duffing):
    fold, doubling = (next(each for each in events(duffing, kind) if each.orbit.visible)
                      for kind in ("fold", "period-doubling"))  # fmt: skip
    found = enclosed_event("fold", doubling.orbit, "A", doubling.parameter, 15)  # the fold, some way along the curve
    assert isinstance(found, str) or float(found.parameter.value) == pytest.approx(fold.parameter)
    for event, kind in ((fold, "torus"), (doubling, "torus")):
        assert isinstance(enclosed_event(kind, event.orbit, "A", event.parameter, 15), str)
    assert isinstance(enclosed_event("graze", fold.orbit, "A", fold.parameter, 15), str)


def test_an_orbit_that_is_no_event_is_refused():
    """x'' + x = cos 4 t, r = 1/2, c = 0: no number but the clearance moves its one orbit to a fold next to it."""
    (orbit,) = si.linear(4, 0, "0.5").periodic(1, 2)
    for kind in ("fold", "period-doubling", "torus", "graze"):
        found = enclosed_event(kind, orbit, "restitution", 0.5, 15)
        assert isinstance(found, str) or abs(found.parameter.value - 0.5) > 1e-3


def test_a_box_beside_a_graze_is_not_accepted():
    """Krawczyk's condition decides: 1e-8 beside the graze a box of 1e-10 is refused, and at the graze it is not."""
    (free,) = si.linear("0.8", -1, "0.8", damping="0.1", amplitude="-0.36").periodic(0, 1)
    (graze,) = events(si.branch(free, "amplitude", (-0.46, -0.26)), "graze")
    orbit = graze.others()[0]
    with balls_at(200):
        closing = TouchingClosing(orbit.oscillator, 1, 20, 200, "amplitude")
        rough = [Fraction(float(orbit.tau[0])), Fraction(graze.parameter)]
        operator = Krawczyk(closing, rough, Fraction(1, 10**22))
        right = operator.solved(rough)
        for off, accepted in ((Fraction(0), True), (Fraction(1, 10**8), False), (Fraction(-1, 10**8), False)):
            point = [right[0], right[1] + off]
            image = operator.image(point, operator.step(point), Fraction(1, 10**10))
            assert (image is not None) == accepted


def test_virtual_events_are_refused_with_the_reason():
    """The wall is above the orbit that touches it, or the velocity of an impact is negative."""
    osc = si.linear("2.8", "0.001", "0.8")
    found = si.branch(osc.periodic(1, 1)[0], "clearance", (-2, 2))
    virtual = [event for event in found.events if not event.orbit.visible]
    assert len(virtual) == 3
    for event in virtual:
        with pytest.raises(InputError, match="its orbit is virtual"):
            event.certified(15)


@pytest.mark.slow
def test_a_graze_of_two_touches_is_refused(duffing):
    """The grazing (2, 1) orbit run through twice touches the wall twice: its three impacts are no graze of one."""
    (event,) = events(duffing, "graze")
    tau, v = ([float(each.value) for each in part] for part in (event.certified(16).tau, event.certified(16).v))
    later = float(tau[1] + 2 * np.pi / 1.7)
    twice = replace(event.orbit, tau=np.array([*tau, later]), v=np.array([*v, v[1]]), n=3, k=2)
    found = enclosed_event("graze", twice, "A", event.parameter, 15)
    assert isinstance(found, str)
    assert "both vanish" in found


@pytest.mark.slow
def test_events_of_orbits_without_impact_are_refused(duffing):
    event = duffing.events[0]
    free = si.linear("0.8", -1, "0.8", damping="0.1", amplitude="-0.36").periodic(0, 1)[0]
    turned = type(event)("fold", 0.1, free, 0, over="amplitude")
    with pytest.raises(InputError, match="a graze alone"):
        turned.certified()
    with pytest.raises(InputError, match="digits"):
        event.certified(0)


# ---- pieces


@pytest.mark.slow
def test_d_f_is_that_of_differences():
    """Columns by the states and by numbers, one of which the period depends on; both closings."""
    (orbit,) = DUFFING.periodic(2, 1, start=(1.95786, 0.662042))
    point = [Fraction(float(part)) for pair in zip(orbit.tau, orbit.v, strict=True) for part in pair]
    touching = [Fraction("3.5"), Fraction("5.4"), Fraction("1.5")]  # both flights are above the wall until they end
    for over in ("A", "w", "clearance", "restitution"):
        value = Fraction({"A": "1", "w": "1.7", "clearance": "0.3", "restitution": "0.6"}[over])
        for kind, at in ((BallClosing, [*point, value]), (TouchingClosing, [*touching, value])):
            with balls_at(140):
                closing = kind(DUFFING, 1, 24, 140, over)
                matrix = closing.matrix(closing.slopes(at, Fraction(1, 10**9))).table()
                for j in range(len(at)):
                    h = Fraction(1, 10**9)
                    ends = [closing.miss([*at[:j], at[j] + s, *at[j + 1 :]]).entries() for s in (-h, h)]
                    for row, low, high in zip(matrix, *ends, strict=True):
                        difference = (high - low) / closing.balls.rational(2 * h)
                        assert row[j].overlaps(difference), (over, kind, j)
                        assert row[j].rad() < 1e-5


def test_the_period_of_a_number_that_it_depends_on():
    balls = Balls(100)
    with balls_at(100):
        for text, over in (("cos(w*t) + sin(2*w*t)", "w"), ("A*cos(w*t)", "A")):
            osc = si.ImpactOscillator("x", text, 0, 1, {"w": "-2", **({"A": 1} if "A" in text else {})})
            length, slope = Spans(osc, 3, over).at(balls.rational(Fraction(-2 if over == "w" else 1)), balls)
            assert float(length.mid()) == pytest.approx(3 * np.pi)
            assert float(slope.mid()) == pytest.approx(1.5 * np.pi if over == "w" else 0)


def test_a_timed_flight_is_that_of_mpmath_and_stops_at_the_wall():
    launch, osc = (
        Launch(constant("tau", 0), constant("v", 1)),
        si.ImpactOscillator("x + x**3", "cos(2*t)", "0.1", "0.5"),
    )
    with balls_at(120):
        end = timed_flight(osc, launch, Balls(120).rational(Fraction(1)), 25)
        with pytest.raises(Refused):
            timed_flight(osc, launch, Balls(120).rational(Fraction(9)), 12)
    with mpmath.workdps(30):
        path = mpmath.odefun(lambda t, y: [y[1], mpmath.cos(2 * t) - y[0] - y[0] ** 3], 0, [mpmath.mpf("0.1"), 1])
        x, u = path(1)
        assert abs(mpmath.mpf(end.height.str(25, radius=False)) + mpmath.mpf("0.1") - x) < mpmath.mpf("1e-23")
        assert abs(mpmath.mpf(end.velocity.str(25, radius=False)) - u) < mpmath.mpf("1e-23")


def test_a_touch_after_an_impact_is_not_first():
    """x'' = -x: from (0, 1) the mass is at the wall at pi, and below it until 2 pi."""
    launch, osc = Launch(constant("tau", 0), constant("v", 1)), si.ImpactOscillator("x", "0", 0, 1)
    with balls_at(120):
        turn = Balls(120).pi()
        for time in (turn, 2 * turn):
            with pytest.raises(Refused):
                touches_first(osc, launch, time, 15)


def test_the_return_slope_is_the_product():
    with balls_at(64):
        import flint

        blocks = [[[flint.arb(each) for each in row] for row in rows] for rows in ([[1, 2], [3, 4]], [[0, 1], [1, 1]])]
        total = return_slope((blocks, None))
        assert [[float(part.mid()) for part in row] for row in total.table()] == [[3, 4], [4, 6]]
