"""Steps from rest where the first terms vanish: as long as the bound of the cut-off allows, and no longer."""

import pytest

from singimpact.flights import over_floats

ULP, N = 2.0**-52, 20


@pytest.mark.parametrize("first", [4, 6, 9])
@pytest.mark.parametrize("bound", [1.0, 30.0])
@pytest.mark.parametrize("R", [1.5, 0.02])
def test_the_step_is_the_longest_of_its_series_that_is_allowed(first, bound, R):
    space, wish = over_floats(), 0.69 * R
    X = [0.0] * (N + 2)
    X[first] = 0.3

    def cut_off(h):
        """The error of x' on a step of length h, times h, by Cauchy's bound of the coefficients from N - 1 on."""
        q = h * (65 / 64) / R
        return 1.04 * h * h * bound * q ** (N - 1) / (1 - q) / N

    h = space["allowed_step"](bound, R, X, N, wish, ULP)
    assert 0 < h < wish
    assert cut_off(h) <= 25 * ULP * X[first] * h**first
    assert cut_off(h / 0.9) > 25 * ULP * X[first] * (h / 0.9) ** first
