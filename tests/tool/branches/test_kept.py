"""A branch that was interrupted goes on where it was."""

from __future__ import annotations

import numpy as np
import pytest

import singimpact as si
from singimpact.branches import Curve


def test_points_are_not_computed_twice(tmp_path, monkeypatch) -> None:
    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path))
    osc = si.ImpactOscillator("x + 0.1*xdot + b*x**3", "cos(1.7*t)", "-0.3", "0.6", {"b": "0.3"})
    (orbit,) = osc.periodic(1, 1, start=(2.12287, 1.16715))
    count = 0
    beyond = Curve.beyond

    def counted(self, start, length):
        nonlocal count
        count += 1
        if count == 12:
            raise KeyboardInterrupt
        return beyond(self, start, length)

    monkeypatch.setattr(Curve, "beyond", counted)
    with pytest.raises(KeyboardInterrupt):
        si.branch(orbit, "b", (0.2, 0.4), step=0.05)
    assert len(list((tmp_path / "branches").glob("*.points"))) == 1
    monkeypatch.setattr(Curve, "beyond", beyond)
    whole = si.branch(orbit, "b", (0.2, 0.4), step=0.05)
    # all of it is known now: nothing is left but the ends of the interval
    steps = []
    monkeypatch.setattr(Curve, "beyond", lambda self, start, length: steps.append(1) or beyond(self, start, length))
    again = si.branch(orbit, "b", (0.2, 0.4), step=0.05)
    assert len(steps) < len(whole) / 2 + 30
    np.testing.assert_allclose(again.parameter[1:-1], whole.parameter[1:-1], rtol=0, atol=1e-12)
    np.testing.assert_allclose(again.multipliers[1:-1], whole.multipliers[1:-1], atol=1e-9)
    assert again.visible.tolist() == whole.visible.tolist()


def test_branches_of_linear_models_are_not_kept(tmp_path, monkeypatch) -> None:
    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path))
    (orbit,) = si.linear("0.8", -1, "0.8", damping="0.1", amplitude="-0.45").periodic(1, 1)
    si.branch(orbit, "amplitude", (-0.5, -0.4))
    assert not (tmp_path / "branches").exists()
