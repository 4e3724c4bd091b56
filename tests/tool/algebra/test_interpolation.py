"""Rational functions from one value: large coefficients, fractions that one value hides, wrong denominators."""

from dataclasses import replace

import flint
import pytest
import sympy

from singimpact.algebra import READING, interpolated, interpolation

ONE = flint.fmpq_poly([1])


BASE = READING.bases[0]


def test_the_bases_are_primes():
    assert all(sympy.isprime(base) for base in READING.bases)


def fractions(node):
    """Numerators over 2 and over a large prime; the first one is a whole number at every whole node."""
    return [{(1, 0): flint.fmpq(node**2 + node, 2), (0, 1): flint.fmpq(node - BASE, 10_007) * node}]


def test_fractions_that_the_base_hides_are_read_all_the_same():
    (found,) = interpolated(fractions, [ONE])
    assert found.at(flint.fmpq(50)) == fractions(50)[0]


def test_a_base_that_is_too_small_is_left():
    used = []

    def values(node):
        used.append(node)
        return [{(1,): flint.fmpq(3**100 * node, 7**20)}]

    (found,) = interpolated(values, [ONE])
    assert used[0] == BASE
    assert READING.bases[1] in used
    assert found.at(flint.fmpq(50)) == values(50)[0]


@pytest.mark.parametrize("bits", [100, 127, 129, 700])
def test_coefficients_longer_than_the_first_base_are_found(bits):
    large = 2**bits + 12_345

    def values(node):
        return [{(2,): flint.fmpq(large * node**3 - node, node**2 + 1)}]

    (found,) = interpolated(values, [flint.fmpq_poly([1, 0, 1])])
    assert found.at(flint.fmpq(7)) == values(7)[0]


def test_a_wrong_denominator_is_refused(monkeypatch):
    monkeypatch.setattr(interpolation, "READING", replace(READING, bases=READING.bases[:2]))
    with pytest.raises(ArithmeticError, match="denominators"):
        interpolated(lambda node: [{(1,): flint.fmpq(1, node + 1)}], [flint.fmpq_poly([2, 1])])


def test_a_polynomial_that_agrees_at_the_base_alone_is_refused(monkeypatch):
    monkeypatch.setattr(interpolation, "READING", replace(READING, bases=READING.bases[:2]))
    with pytest.raises(ArithmeticError, match="denominators"):
        interpolated(lambda node: [{(1,): flint.fmpq(node if node > 2**64 else node + 1)}], [ONE])
