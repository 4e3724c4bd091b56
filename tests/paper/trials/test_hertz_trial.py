"""gamma of impacts that lose a power of the speed: one place by halving, and the bracket on both sides."""

from fractions import Fraction

import pytest

from singimpact.algebra import DOUBLES
from singimpact.contact import acceleration_jet
from singimpact.oscillator import Oscillator
from singimpact.paper import POWERS, above, constant, edge
from singimpact.paper.trials.hertz_orbits import STARTS, measured


@pytest.mark.slow
def test_one_exponent_by_halving():
    q = Fraction(1, 5)
    found = measured(STARTS[0], q)
    assert found.exponent == pytest.approx(2.5, abs=1e-3)
    w = (float(constant(1, q)) * found.loss) ** 1.25
    assert found.speeds[1] / (w * found.distances[1] ** 2.5) == pytest.approx(1, abs=1e-3)


@pytest.mark.slow
def test_sides_and_refusals():
    osc = Oscillator("0", "t", 0, "-v*(1 - 3*(-v)**(1/5))")
    v, width = edge(osc, 1, 0.01, float(constant(1, Fraction(1, 5)) * 3) ** 1.25 * 1e-5, 1e-3)
    assert width < 1e-3
    assert above(osc, 1, 0.01, 1.01 * v)
    assert not above(osc, 1, 0.01, 0.99 * v)
    with pytest.raises(ArithmeticError, match="is not between"):
        edge(osc, 1, 0.01, 10 * v, 1e-3)


def test_the_starts_have_their_contact_orders():
    assert (Fraction(1, 10), Fraction(1, 5), Fraction(3, 10), Fraction(1, 2)) == POWERS
    for start in STARTS:
        sizes = acceleration_jet(Oscillator(start.f, start.g, 0, "1/2"), 0.0, start.order + 1, DOUBLES)
        wanted = [0.0] * start.order + [1.0, 0.0]
        assert [abs(float(size)) for size in sizes] == pytest.approx(wanted, abs=1e-15)
