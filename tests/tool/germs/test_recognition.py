"""Germs are recognised after changes of source and target, and what is not decided says so."""

from fractions import Fraction

import flint
import pytest

from singimpact.algebra import EXACT, Balls, JetSpace
from singimpact.germs import recognised
from singimpact.theory import sheet

u, t = JetSpace(("u", "t"), 5, EXACT).generators()
NORMAL = {
    "regular": t,
    "fold": -t * t,
    "cusp": t**3 + u * t,
    "lips": t**3 + u * u * t,
    "beaks": t**3 - u * u * t,
    "swallowtail": t**4 + u * t,
    "degenerate": t**5 + u * u * t,
}


@pytest.mark.parametrize("kind", NORMAL)
def test_kind_survives_changes_of_source_and_target(kind):
    source = (u, t.scaled(2) + t * t - u * t + u * u)
    germ = NORMAL[kind].compose((u, source[1] - u * u))
    bent = germ.scaled(3) + germ * germ + u * u - u
    assert recognised(bent) == kind


def test_p_at_a_tangency_is_a_fold():
    from singimpact.contact import Contact

    point = Contact(1, EXACT, {k: Fraction(k + 1, 3) for k in range(1, 5)}, {(0, 1): Fraction(1, 7)})
    assert recognised(sheet(point, 4).v) == "fold"


def test_undecided_sign_is_said():
    balls = Balls(64)
    space = JetSpace(("u", "t"), 4, balls)
    with flint.ctx.workprec(64):
        wide = space.jet({(0, 1): flint.arb(0, 1), (0, 2): flint.arb(1)})
    with pytest.raises(ArithmeticError, match="more bits"):
        recognised(wide)


def test_low_order_is_refused():
    with pytest.raises(TypeError, match="order 4"):
        recognised(t.cut(3))
