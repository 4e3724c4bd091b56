"""Curves of equations: followed round their turns, ended with a reason."""

from __future__ import annotations

import numpy as np
import pytest

from singimpact.branches import Curve, root_between


class Circle:
    """x^2 + y^2 = 1, which has no value beyond y = `end`."""

    def __init__(self, end: float = np.inf, corner: bool = False) -> None:
        self.end, self.corner = end, corner

    def equations(self, point: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        x, y = point
        if y > self.end:
            return np.full(1, np.nan), np.full((1, 2), np.nan)
        if self.corner:  # |y| = x: the curve has a corner at 0
            return np.array([abs(y) - x]), np.array([[-1.0, np.sign(y)]])
        return np.array([x * x + y * y - 1]), np.array([[2 * x, 2 * y]])


def followed(circle: Circle, start: list[float], most: int) -> tuple[np.ndarray, str]:
    curve = Curve(circle.equations, np.ones(2), 0.1)
    begin = curve.begin(np.array(start), np.array([0.0, 1.0]))
    assert begin is not None
    return np.array([after.at for _, _, after in curve.walk(begin, most)]), curve.note


def test_turns_are_passed() -> None:
    points, note = followed(Circle(), [1.0, 0.1], 120)
    assert np.hypot(*points.T) == pytest.approx(1, abs=1e-14)
    assert points[:, 0].min() == pytest.approx(-1, abs=0.01)
    assert "the curve goes on" in note


@pytest.mark.parametrize(("circle", "words"), [(Circle(0.7), "leaves the domain"), (Circle(corner=True), "singular")])
def test_an_end_says_why(circle: Circle, words: str) -> None:
    start = [1.0, 0.1] if words == "leaves the domain" else [1.0, -1.0]
    points, note = followed(circle, start, 1000)
    assert words in note
    end = [np.sqrt(1 - 0.49), 0.7] if words == "leaves the domain" else [0.0, 0.0]
    assert points[-1] == pytest.approx(end, abs=1e-4)


def test_roots_at_the_ends() -> None:
    assert root_between(lambda x: x, 0.0, 1.0, (0.0, 1.0)) == 0.0
    assert root_between(lambda x: x - 1, 0.0, 1.0, (-1.0, 0.0)) == 1.0
    assert root_between(lambda x: x - 0.3, 0.0, 1.0, (-0.3, 0.7)) == pytest.approx(0.3, rel=1e-15)
