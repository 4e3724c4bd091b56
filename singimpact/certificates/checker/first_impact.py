"""The first impact of a launch."""

from typing import Any

from .motion import Flight, Model
from .told import compared, launched

PARTS = ("flight_time", "velocity", "tau", "v")


def first_impact(model: Model, content: dict[str, Any], bits: int) -> None:
    """Check that the motion from the launch meets the wall first where and as fast as it is written."""
    tau, v = launched(content)
    time, velocity, _ = Flight(model, tau, v, bits).first_hit()
    found = zip(PARTS, (time, velocity, tau + time, model.rebound(velocity)), strict=True)
    compared({name: (each, content[name]) for name, each in found})
