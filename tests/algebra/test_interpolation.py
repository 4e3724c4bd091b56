"""Rational functions from values: degrees that hide in the combination of monomials are found out."""

import flint
import pytest

from singimpact.algebra import interpolation
from singimpact.algebra.interpolation import interpolated


def cancelling(node):
    """Two monomials whose combination with equal weights vanishes."""
    return [{(1, 0): flint.fmpq(node**9), (0, 1): flint.fmpq(-(node**9))}]


@pytest.mark.parametrize("weight", [lambda _: 1, interpolation._weight])
def test_what_cancels_in_the_combination_is_found_all_the_same(monkeypatch, weight):
    monkeypatch.setattr(interpolation, "_weight", weight)
    monkeypatch.setattr(interpolation, "MOST_NODES", 30)
    if weight((1, 0)) == weight((0, 1)):
        with pytest.raises(ArithmeticError):
            interpolated(cancelling, [flint.fmpq_poly([1])])
    else:
        (found,) = interpolated(cancelling, [flint.fmpq_poly([1])])
        assert found.at(flint.fmpq(50)) == cancelling(50)[0]


def test_a_wrong_denominator_is_refused(monkeypatch):
    monkeypatch.setattr(interpolation, "MOST_NODES", 30)
    with pytest.raises(ArithmeticError, match="denominators"):
        interpolated(lambda node: [{(1,): flint.fmpq(1, node + 1)}], [flint.fmpq_poly([2, 1])])
