"""Pictures of orbits: drawn without a window, with everything that happened in them."""

from __future__ import annotations

import numpy as np
import pytest

from singimpact.impact_oscillator import linear
from singimpact.inputs import InputError
from singimpact.scenes import plot


def test_everything_that_happened_is_labelled() -> None:
    axes = plot(linear("0.9", "0.2", "0.4").orbit("0.3", "0.4", impacts=40))
    labels = axes.get_legend_handles_labels()[1]
    assert {"impact", "at rest on the wall", "end of chatter (summed)", "lifts off"} <= set(labels)
    axes.figure.canvas.draw()


def test_the_curve_stays_above_the_obstacle() -> None:
    axes = plot(linear("2.8", "0.1", "0.8").orbit(0.3, 0.4, impacts=30))
    places = axes.lines[0].get_ydata()
    assert np.nanmin(places) >= 0.1 - 1e-12


def test_an_orbit_of_nothing() -> None:
    plot(linear("2.8", "0.1", "0.8").orbit(0.3, 0.4, impacts=0)).figure.canvas.draw()


def test_what_cannot_be_drawn() -> None:
    with pytest.raises(InputError, match="orbit"):
        plot(3)
