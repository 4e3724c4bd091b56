"""The options that name an oscillator: a model file, or the linear one by its numbers."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

import click

from singimpact.inputs import InputError

if TYPE_CHECKING:
    from singimpact.impact_oscillator import ImpactOscillator

Function = TypeVar("Function", bound=Callable[..., Any])

NEEDED = ("omega", "clearance", "restitution")
LINEAR = {
    "omega": "frequency of the forcing",
    "clearance": "position of the wall",
    "restitution": "coefficient of restitution, in (0, 1]",
    "damping": "coefficient of x'",
    "stiffness": "coefficient of x",
    "amplitude": "amplitude of the forcing",
    "phase": "phase of the forcing",
}


def model_options(function: Function) -> Function:
    """``--model FILE`` or the numbers of x'' + damping x' + stiffness x = amplitude cos(omega t + phase).

    Numbers stay the text that was written (``pi/2.8``, ``1/3``), so that the model is exact.
    """
    for name in reversed(LINEAR):
        function = click.option(f"--{name}", metavar="NUMBER", help=f"Linear model: {LINEAR[name]}.")(function)
    return click.option("--model", metavar="FILE", help="TOML file: f, g, clearance, restitution, parameters.")(
        function
    )


def take_model(options: dict[str, Any]) -> ImpactOscillator:
    """The oscillator that the options name; its options are removed from the mapping.

    Raises
    ------
    InputError : two models are named, or none is.
    """
    path = options.pop("model")
    numbers = {name: value for name in LINEAR if (value := options.pop(name)) is not None}
    if path is not None:
        return _from_file(path, numbers)
    missing = [f"--{name}" for name in NEEDED if name not in numbers]
    if missing:
        raise InputError(
            f"no {', '.join(missing)} given: a model is --model FILE, or --omega --clearance --restitution"
        )
    from singimpact.impact_oscillator import linear

    return linear(**numbers)


def _from_file(path: str, numbers: dict[str, str]) -> ImpactOscillator:
    if numbers:
        given = ", ".join(f"--{name} {value}" for name, value in numbers.items())
        raise InputError(f"--model {path} and {given} name two models: give one of them")
    from singimpact.impact_oscillator import read_model

    return read_model(path)
