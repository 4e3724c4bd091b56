"""Periodic orbits and branches with restitution 0: slopes of the map of release phases, Mehta and Luck's thresholds."""

import numpy as np
import pytest

import singimpact as si
from singimpact.inputs import InputError

TURN = 2 * np.pi


def table(G):
    return si.models.luck_mehta(G=G, restitution=0)


def test_the_thresholds_of_mehta_and_luck():
    """A. Mehta and J. M. Luck, Phys. Rev. Lett. 65 (1990) 393: the orbits begin at G_1 and double."""
    (orbit,) = table("3.5").periodic(1, 1)
    events = {event.kind: event.parameter for event in orbit.branch("G", (3.2, 4.5)).events}
    assert events == {
        "onset of rest": pytest.approx(np.sqrt(1 + np.pi**2), rel=1e-13),
        "period-doubling": pytest.approx(np.sqrt(4 + np.pi**2), rel=1e-13),
    }


@pytest.mark.parametrize("G", ["3.3", "3.5", "3.7", "4.2"])
def test_one_orbit_of_a_ball_in_closed_form(G):
    (orbit,) = found = table(G).periodic(1, 1)
    slope = 1 - np.sqrt(float(G) ** 2 - np.pi**2)
    assert found.complete
    assert orbit.tau[0] == pytest.approx(TURN - np.arcsin(np.pi / float(G)), rel=1e-14)
    assert orbit.v.tolist() == [0.0]
    assert orbit.multipliers.tolist() == [pytest.approx(slope, abs=1e-13), 0.0]
    assert orbit.stable == (abs(slope) < 1)


def test_no_orbit_leaves_where_the_mass_would_rest():
    """Below G_1 the closing conditions have a solution at which a_c < 0."""
    assert list(table("3.25").periodic(1, 1)) == []
    (resting,) = table("3.25").periodic(np.inf, 1)
    assert resting.multipliers.tolist() == [0.0, 0.0]
    (orbit,) = table("3.5").periodic(1, 1)
    branch = orbit.branch("G", (3.2, 3.5))
    below = np.array(branch.parameter) < np.sqrt(1 + np.pi**2) - 1e-9
    assert below.any()
    assert not np.array(branch.visible)[below].any()
    assert np.array(branch.visible)[~below].all()


@pytest.mark.parametrize(
    ("osc", "counts"),
    [
        (table("3.8"), (2, 2)),
        (si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "-0.3", 0), (1, 1)),
        (si.ImpactOscillator("sin(x) + 0.2*xdot", "1.2*cos(2.1*t)", "-0.4", 0), (1, 2)),
    ],
)
def test_multipliers_are_products_of_slopes_of_the_map(osc, counts):
    orbits = osc.periodic(*counts)
    assert orbits
    for orbit in orbits:
        found = osc.release_map(orbit.tau)
        assert not found.flat.any()
        again = orbit.tau
        for _ in range(counts[0]):
            again = osc.release_map(again).tau
        np.testing.assert_allclose(again - orbit.tau, orbit.period, rtol=1e-12)
        assert orbit.multipliers[0] == pytest.approx(np.prod(found.slope), rel=1e-9)
        assert orbit.multipliers[1] == 0


def test_digits_and_proofs():
    (orbit,) = table("3.5").periodic(1, 1, digits=30)
    truth = 1 - np.sqrt(3.5**2 - np.pi**2)
    assert float(orbit.multipliers[0].real) == pytest.approx(truth, rel=1e-14)
    proved = table("3.5").periodic(1, 1)[0].certified(20)
    assert proved.stable
    assert abs(float(proved.tau[0].value) - (TURN - np.arcsin(np.pi / 3.5))) < 1e-14


def test_curves_of_both_thresholds():
    """The clearance adds nothing to a ball, so that both stay where they are."""
    (orbit,) = table("3.5").periodic(1, 1)
    onset, doubling = orbit.branch("G", (3.2, 4.5)).events
    for event, value in ((onset, np.sqrt(1 + np.pi**2)), (doubling, np.sqrt(4 + np.pi**2))):
        curve = si.event_curve(event, ("G", "clearance"), ((3, 4.5), (-0.1, 0.1)))
        np.testing.assert_allclose(curve.parameters[:, 0], value, rtol=1e-9)


def test_refusals():
    with pytest.raises(InputError, match="restitution = 0 is not accepted here: a search for limit cycles"):
        si.ImpactOscillator("x - (1 - x**2)*xdot", "0", "-1.5", 0).periodic(1)
    (orbit,) = table("3.5").periodic(1, 1)
    with pytest.raises(InputError, match="restitution = 0 is not accepted here: a branch over it"):
        orbit.branch("restitution")
    with pytest.raises(InputError, match="no v with restitution = 0"):
        table("3.5").periodic(1, 1, v=(0, 1))
    with pytest.raises(InputError, match="restitution = 0 is not accepted here: a border orbit"):
        si.border_orbits(table("3.5"), "G", (3, 4))
