"""The zero set of a function by the contour of its values on a grid, as matplotlib draws it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np


def zero_set(
    function: Callable[[Any, Any], Any], x: tuple[float, float], y: tuple[float, float], side: int
) -> list[Any]:
    """Polylines, arrays (points, 2), from side x side values."""
    from contourpy import contour_generator

    across, up = np.linspace(*x, side), np.linspace(*y, side)
    return list(contour_generator(across, up, function(*np.meshgrid(across, up))).lines(0.0))
