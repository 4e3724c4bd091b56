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


def test_a_curve_of_tori_and_its_resonances(torus):
    curve = si.event_curve(torus, ("A", "w"), ((0.3, 1.6), (1.8, 2.6)), step=0.05)
    (special,) = curve.special
    assert (special.kind, special.label) == ("1:4 resonance", "R4")
    assert "1:4 resonance (R4) at (1.304" in repr(curve)
    assert special.as_dict()["label"] == "R4"
    for (A, w), tau, v in zip(curve.parameters, curve.tau, curve.v, strict=True):
        (orbit,) = POL.replace(A=A, w=w).periodic(1, 1, start=(tau[0], v[0]))
        assert np.abs(orbit.multipliers) == pytest.approx(np.ones(2), abs=1e-9)
    A, w = special.parameters
    near = np.abs(curve.parameters[:, 0] - A).argmin()
    (orbit,) = POL.replace(A=A, w=w).periodic(1, 1, start=(curve.tau[near][0], curve.v[near][0]))
    assert np.sort_complex(np.asarray(orbit.multipliers)) == pytest.approx(np.array([-1j, 1j]), abs=1e-8)
