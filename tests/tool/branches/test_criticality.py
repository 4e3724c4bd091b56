"""First coefficients of doublings and tori: against differences of the impact map, and orbits on both sides."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import singimpact as si

BALL = si.ImpactOscillator("1", "G*cos(t)", 0, "0.5", {"G": "1.4"})
DUFFING = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "A*cos(1.7*t)", "-0.3", "0.6", {"A": "0.75"})
POL = si.ImpactOscillator("x - mu*(1 - x**2)*xdot", "A*cos(w*t)", 0, "0.9", {"mu": "0.2", "A": "1.5", "w": "2.2"})


def event_of(kind, branch):
    (event,) = [event for event in branch.events if event.kind == kind]
    return event


@pytest.fixture(scope="module")
def doublings():
    return {
        "ball": event_of("period-doubling", si.branch(BALL.periodic(1, 1)[1], "G", (1.2, 2))),
        "duffing": event_of("period-doubling", si.branch(DUFFING.periodic(1, 1)[0], "A", (0.25, 0.8))),
    }


@pytest.fixture(scope="module")
def torus():
    return event_of("torus", si.branch(POL.periodic(1, 1, start=(2.64089, 2.19428))[0], "A", (0.5, 1.6), step=0.1))


def flown(force, r, c, period):
    """The map from an impact to that about a period later by scipy, tau less a period; flights may pass the wall."""
    settings = {"method": "DOP853", "rtol": 3e-14, "atol": 1e-15}

    def hit(_, y):
        return y[0] - c

    def motion(t, y):
        return [y[1], force(t, *y)]

    hit.terminal = True

    def step(state):
        late = state[0] + 0.95 * period
        near = solve_ivp(motion, (state[0], late), [c, state[1]], **settings).y[:, -1]
        found = solve_ivp(motion, (late, late + period), near, events=hit, **settings)
        return np.array([found.t_events[0][0] - period, -r * found.y_events[0][0][1]])

    return step


def multilinear(P, z, order, vectors, h):
    """D^order P by central differences along each of the vectors."""
    total = 0
    for signs in np.ndindex(*(2,) * order):
        s = 1 - 2 * np.array(signs)
        total = total + np.prod(s) * P(z + h * s @ np.array(vectors))
    return total / (2 * h) ** order


def by_differences(P, z, h):
    """c and Re a of Kuznetsov's formulas for maps of the plane, from differences of the map alone."""
    A = np.stack([multilinear(P, z, 1, [e], h) for e in np.eye(2)], axis=1)
    mu, vectors = np.linalg.eig(A)
    lead = int(np.argmin(abs(mu + 1))) if not mu.imag.any() else int(np.argmax(mu.imag))
    q = vectors[:, lead] / np.linalg.norm(vectors[:, lead])
    p = np.linalg.inv(vectors)[lead] / (np.linalg.inv(vectors)[lead] @ q)

    def form(*args):
        # multilinear over complex arguments
        total = 0
        for part in np.ndindex(*(2,) * len(args)):
            real = [a.imag if i else a.real for a, i in zip(args, part, strict=True)]
            if all(np.abs(a).max() > 0 for a in real):
                total = total + 1j ** sum(part) * multilinear(P, z, len(args), real, h)
        return total

    if not mu.imag.any():
        h2 = np.linalg.solve(np.eye(2) - A, form(q, q))
        return float((p @ (form(q, q, q) / 6 + form(q, h2) / 2)).real)
    m = mu[lead] / abs(mu[lead])
    h11 = np.linalg.solve(np.eye(2) - A, form(q, q.conj()))
    h20 = np.linalg.solve(m * m * np.eye(2) - A, form(q, q))
    return float((p @ (form(q, q, q.conj()) + 2 * form(q, h11) + form(q.conj(), h20)) / m).real) / 2


@pytest.mark.parametrize("name", ["ball", "duffing"])
def test_coefficients_of_doublings_are_those_of_the_flow(doublings, name):
    event = doublings[name]
    value = event.parameter
    step = (
        flown(lambda t, *_: value * np.cos(t) - 1, 0.5, 0, 2 * np.pi)
        if name == "ball"
        else flown(lambda t, x, u: value * np.cos(1.7 * t) - x - 0.1 * u - 0.3 * x**3, 0.6, -0.3, 2 * np.pi / 1.7)
    )
    z = np.array([float(event.orbit.tau[0]), float(event.orbit.v[0])])
    assert np.abs(step(z) - z).max() < 1e-11  # and the flow has the orbit
    coarse, fine = by_differences(step, z, 4e-3), by_differences(step, z, 2e-3)
    truth = fine + (fine - coarse) / 3  # the differences have an error of the second order
    form = event.normal_form
    assert form.value == pytest.approx(truth, rel=2e-4)
    assert form.error < 1e-8
    assert event.criticality == "supercritical"


def test_the_coefficient_of_a_torus_is_that_of_the_flow(torus):
    A = torus.parameter
    step = flown(lambda t, x, u: A * np.cos(2.2 * t) - x + 0.2 * (1 - x * x) * u, 0.9, 0, 2 * np.pi / 2.2)
    z = np.array([float(torus.orbit.tau[0]), float(torus.orbit.v[0])])
    coarse, fine = by_differences(step, z, 8e-3), by_differences(step, z, 4e-3)
    assert torus.normal_form.value == pytest.approx(fine + (fine - coarse) / 3, rel=2e-4)
    assert torus.criticality == "supercritical"


def test_the_doubled_orbit_is_stable_where_the_doubling_is_supercritical(doublings):
    events = [*doublings.values()]
    model = si.linear(1, -1, "0.8", damping="0.1", amplitude="-0.12")
    events += si.branch(model.periodic(1, 1)[0], "amplitude", (-0.3, -0.05)).events
    words = set()
    for event in events:
        if event.kind == "period-doubling":
            (doubled,) = event.others()
            assert (event.criticality == "supercritical") == doubled.stable
            words.add(event.criticality)
    assert words == {"supercritical", "subcritical"}


@pytest.mark.slow
def test_amplitudes_beside_a_torus_grow_like_the_square_root(torus):
    """|z|^2 = (|mu| - 1)/|a| on the torus: twice the excess, the square root of two times the size."""
    sizes = []
    for share in (1e-3, 2e-3):
        model = POL.replace(A=torus.parameter * (1 - share))
        (orbit,) = model.periodic(1, 1, start=(float(torus.orbit.tau[0]), float(torus.orbit.v[0])))
        grown = abs(complex(orbit.multipliers[0])) - 1
        z = np.sqrt(grown / -torus.normal_form.value)
        run = model.iterate(float(orbit.tau[0]), float(orbit.v[0]) + z, impacts=int(30 / grown) + 2000, keep=True)
        sizes.append(np.ptp(run.v[-1000:]) / 2 / z)
    assert sizes[1] == pytest.approx(sizes[0], rel=0.03)


def test_events_without_a_coefficient():
    fold = event_of("fold", si.branch(DUFFING.periodic(1, 1)[0], "A", (0.25, 0.8)))
    assert np.isnan(fold.normal_form.value)
    assert fold.criticality == ""
    assert repr(fold) == "<fold at A = 0.274199345009>"


def orbit_at(model, curve, numbers):
    """The orbit of a model that is next to a point of a curve."""
    near = np.abs(curve.parameters - numbers).sum(axis=1).argmin()
    (orbit,) = model.periodic(1, 1, start=(curve.tau[near][0], curve.v[near][0]))
    assert orbit.visible
    return orbit


DRIVEN = si.ImpactOscillator(
    "x + 1.142*x**2 - mu*xdot + xdot**3/5", "A*cos(w*t)", "-0.591", "0.939", {"mu": "0.387", "A": "1.582", "w": "1.409"}
)
BENT = si.ImpactOscillator("x - 0.516*x**2 + 0.598*xdot", "A*cos(1.034*t)", "-0.465", "0.82", {"A": "0.865"})


def driven(mu):
    """The map of the driven model by scipy, of its other numbers."""

    def step(A, w):
        force = lambda t, x, u: A * np.cos(w * t) - x - 1.142 * x * x + mu * u - u**3 / 5  # noqa: E731
        return flown(force, 0.939, -0.591, 2 * np.pi / w)

    return step


def bent(A, c):
    force = lambda t, x, u: A * np.cos(1.034 * t) - x + 0.516 * x * x - 0.598 * u  # noqa: E731
    return flown(force, 0.82, c, 2 * np.pi / 1.034)


def coefficient_beside(curve, model, step, numbers):
    """The first coefficient by differences of the flow at two steps, of the orbit at a point of a curve."""
    orbit = orbit_at(model.replace(**dict(zip(curve.over, numbers, strict=True))), curve, numbers)
    z = np.array([orbit.tau[0], orbit.v[0]])
    coarse, fine = (by_differences(step(*numbers), z, h) for h in (4e-3, 2e-3))
    return fine + (fine - coarse) / 3


def changes_its_sign(curve, model, step, point):
    """Whether the coefficient is 0 at a point, and has both signs on the curve beside it."""
    at, before, after = (
        coefficient_beside(curve, model, step, numbers)
        for numbers in (point.parameters, *curve.parameters[point.index : point.index + 2])
    )
    return before * after < 0 and abs(at) < 2e-3 * min(abs(before), abs(after))


@pytest.fixture(scope="module")
def tori():
    branch = si.branch(DRIVEN.periodic(1, 1, start=(2.16940583, 1.81211459))[0], "mu", (0.3, 0.6), step=0.1)
    event = event_of("torus", branch)
    return event.parameter, si.event_curve(event, ("A", "w"), ((0.3, 1.6), (1.4, 1.85)), step=0.05, points=200)


def test_resonances_on_a_curve_of_tori(tori):
    mu, curve = tori
    assert [point.label for point in curve.special] == ["R1", "CH", "R4", "R3", "R2", "R2"]
    assert "1:4 resonance (R4) at (0.583" in repr(curve)
    assert curve.special[2].as_dict()["label"] == "R4"
    assert curve.visible.all()
    for point, angle in zip(curve.special[2:], (90, 120, 180, 180), strict=True):
        A, w = point.parameters
        orbit = orbit_at(DRIVEN.replace(A=A, w=w, mu=mu), curve, point.parameters)
        z = np.array([orbit.tau[0], orbit.v[0]])
        matrix = np.stack([multilinear(driven(mu)(A, w), z, 1, [e], 2e-4) for e in np.eye(2)], axis=1)
        assert np.trace(matrix) == pytest.approx(2 * np.cos(np.radians(angle)), abs=1e-6)
        assert np.linalg.det(matrix) == pytest.approx(1, abs=1e-6)


def test_between_its_resonances_multipliers_of_a_curve_of_tori_are_on_the_circle(tori):
    """Before R1 and between both R2 they are real, with the product 1: neutral saddles, which have no coefficient."""
    mu, curve = tori
    first, second, third = (curve.special[i].index for i in (0, 4, 5))
    for index, ((A, w), tau, v) in enumerate(zip(curve.parameters, curve.tau, curve.v, strict=True)):
        (orbit,) = DRIVEN.replace(A=A, w=w, mu=mu).periodic(1, 1, start=(tau[0], v[0]))
        assert abs(np.prod(orbit.multipliers) - 1) < 1e-9
        assert np.iscomplex(orbit.multipliers).all() == (first < index <= second or third < index)


def test_a_chenciner_point(tori):
    mu, curve = tori
    point = curve.special[1]
    assert (point.kind, point.label) == ("Chenciner", "CH")
    assert changes_its_sign(curve, DRIVEN.replace(mu=mu), driven(mu), point)
    assert not changes_its_sign(curve, DRIVEN.replace(mu=mu), driven(mu), curve.special[2])


def test_a_generalized_flip():
    event = event_of("period-doubling", si.branch(BENT.periodic(1, 1)[0], "A", (0.5, 1.2), step=0.1))
    curve = si.event_curve(event, ("A", "clearance"), ((0.5, 1.2), (-0.9, -0.4)), step=0.05, points=100)
    (point,) = [point for point in curve.special if point.kind == "generalized flip"]
    assert point.label == "GPD"
    assert changes_its_sign(curve, BENT, bent, point)
