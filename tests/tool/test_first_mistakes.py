"""Mistakes of the first hour: each gets one sentence that says what would be accepted, or why there is no number."""

from decimal import Decimal

import numpy as np
import pytest

import singimpact as si
from singimpact.inputs import InputError

OSC = si.linear(2, "0.3", "0.5")


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (lambda: si.ImpactOscillator("x", "cos(2*s)", 0, "0.5"), "'s'"),
        (lambda: si.ImpactOscillator(None, "cos(2*t)", 0, "0.5"), "f = None"),
        (lambda: OSC.orbit(0.1, 0.2, n=3), "orbit has no argument 'n': give impacts"),
        (lambda: OSC.basins(grid=3), "argument of basins 'grid': the nearest known are size"),
        (lambda: si.ImpactOscillator("x", "0", 0, 1, params={}), "ImpactOscillator has no argument 'params'"),
        (lambda: si.ImpactOscillator("x"), "ImpactOscillator takes f, g, clearance, restitution"),
        (lambda: OSC.orbit(), "an orbit starts from tau and v, or off the wall from x=, xdot= and t="),
        (lambda: OSC.orbit("90deg", "0.1"), "angles are in radians: write 90*pi/180"),
        (lambda: si.linear(2, 0, "0.5", phase="30 degrees"), "angles are in radians: write 30*pi/180"),
        (lambda: si.linear(2, 0, -1), "restitution = -1 is not accepted: give a number from 0 to 1"),
        (lambda: si.claims["eq 5"], "claims have ids, not numbers: about equation (5) of the paper there is e:acc"),
        (lambda: si.claims["(4)"], "about equation (4) of the paper there is none"),
        (lambda: si.claims["e:mec"], "the nearest known are e:meq"),
    ],
)
def test_refusals(call, told):
    with pytest.raises(InputError) as caught:
        call()
    assert told in str(caught.value)
    assert "\n" not in str(caught.value)


def test_times_without_an_orbit_are_nan_with_a_warning():
    orbit = OSC.orbit("1.2", "0.3", impacts=5)
    with pytest.warns(UserWarning, match=r"t = -1: the orbit is known from 1.2 to .*; x and xdot are nan"):
        assert np.isnan(orbit.sample(-1).x)
    assert np.isnan(orbit.sample([-1, 1.3]).x).tolist() == [True, False]  # some are known: no warning


def test_a_threshold_that_is_none_says_why():
    above = si.threshold(si.linear(2, 2, "0.5"), "0.3")  # a_c < 0 always
    assert above.status == si.Status.none
    assert str(above).endswith(above.note)
    assert "a_c has no zero ahead into which gamma runs" in above.note
    found = OSC.threshold("1.2")
    assert found.note == ""
    assert str(found).endswith(")")


@pytest.mark.parametrize("value", [Decimal("0.25"), np.float64(0.25), np.float32(0.25), "1/4", 0.25])
def test_numbers_of_every_kind_are_numbers(value):
    assert si.linear(2, value, "0.5") == si.linear(2, "0.25", "0.5")


def test_a_picture_that_is_no_figure(singimpact, tmp_path):
    refused = singimpact("figure", "17", "-o", tmp_path / "swan.gif")
    assert refused.exit_code == 2
    assert "a folder, or for one figure a file name ending in .png, .pdf or .svg" in refused.stderr
    assert list(tmp_path.iterdir()) == []
    assert singimpact("figure", "1", "-o", tmp_path / "pictures.v1.2").exit_code == 0  # a folder may have a dot
    assert (tmp_path / "pictures.v1.2" / "figure01.png").is_file()
