"""The options that name an oscillator, its periodic orbits and the branches through them."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING, Any, TypeVar

import click

import singimpact as si
from singimpact.cli.output import choice_option
from singimpact.inputs import InputError

if TYPE_CHECKING:
    from singimpact.branches.branch import Branch
    from singimpact.branches.orbits import PeriodicOrbit
    from singimpact.impact_oscillator import ImpactOscillator

Function = TypeVar("Function", bound=Callable[..., Any])

NEEDED = ("omega", "clearance", "restitution")
LINEAR = {
    "omega": "frequency of the forcing",
    "clearance": "position of the wall",
    "restitution": "coefficient of restitution, from 0 to 1",
    "damping": "coefficient of x'",
    "stiffness": "coefficient of x",
    "amplitude": "amplitude of the forcing",
    "phase": "phase of the forcing",
    "upper": "position of a second wall above",
    "upper_restitution": "that of the second wall; without it that of the first",
}


def model_options(function: Function) -> Function:
    """``--model FILE`` or the numbers of x'' + damping x' + stiffness x = amplitude cos(omega t + phase).

    Numbers stay the text that was written (``pi/2.8``, ``1/3``), so that the model is exact.
    """
    for name in reversed(LINEAR):
        option = f"--{name.replace('_', '-')}"
        function = click.option(option, metavar="NUMBER", help=f"Linear model: {LINEAR[name]}.")(function)
    return click.option("--model", metavar="FILE", help="TOML file: f, g, clearance, restitution, parameters.")(
        function
    )


def take_model(options: dict[str, str | None], file: str | None = None) -> ImpactOscillator:
    """The oscillator that the options or a file name; its options are removed from the mapping.

    Raises
    ------
    InputError : two models are named, or none is.
    """
    path = options.pop("model")
    if file is not None and path is not None:
        raise InputError(f"{file} and --model {path} name two models: give one of them")
    path = path if file is None else file
    numbers = {name: value for name in LINEAR if (value := options.pop(name)) is not None}
    if path is not None:
        if numbers:
            options_of_linear = ", ".join(f"--{name} {value}" for name, value in numbers.items())
            raise InputError(f"--model {path} and {options_of_linear} name two models: give one of them")
        from singimpact.impact_oscillator import read_model

        return read_model(path)
    missing = [f"--{name}" for name in NEEDED if name not in numbers]
    if missing:
        raise InputError(
            f"no {', '.join(missing)} given: a model is --model FILE, or --omega --clearance --restitution"
        )
    from singimpact.impact_oscillator import linear

    above = numbers.pop("upper_restitution", None)
    model = linear(**numbers)
    return model if above is None else model.replace(upper_restitution=above)


def wall_option(function: Function) -> Function:
    """``--wall lower`` or ``--wall upper``."""
    told = "Wall of the states, of a model with two walls.  [default: lower]"
    return choice_option("--wall", ["lower", "upper"], told)(function)


# Periodic orbits, and the branches through them.

SAME = 1e-6  # states that differ by less, of a period and of their velocity, are those of one orbit


def orbit_options(function: Function) -> Function:
    """``--orbit N K`` and ``--start TAU V``."""
    function = click.option(
        "--start", nargs=2, metavar="TAU V", help="A state near the orbit.  [default: every orbit found]"
    )(function)
    return click.option(
        "--orbit",
        nargs=2,
        type=(str, int),
        metavar="N K",
        default=("1", 1),
        show_default=True,
        help="N impacts in K periods of the forcing; N = 0: no impact. Without t: limit cycles of N impacts. Between "
        "two walls N is a word such as lu.",
    )(function)


def over_option(function: Function) -> Function:
    """``--over NAME``."""
    return click.option(
        "--over",
        metavar="NAME",
        default="clearance",
        show_default=True,
        help="The parameter, or clearance, restitution, ...",
    )(function)


def take_orbits(
    model: ImpactOscillator, orbit: tuple[int | str, int], start: tuple[str, str] | None
) -> list[PeriodicOrbit]:
    """The orbits that the options name.

    Raises
    ------
    InputError : there is none.
    """
    n, k = orbit
    with suppress(ValueError):  # a word of walls stays one
        n = int(n)
    # limit cycles count no periods: K = 1, which is the default of the option, is none
    orbits = model.periodic(n, None if model.autonomous and k == 1 else k, start=start)
    if not orbits:
        more = f" ({'; '.join(orbits.notes)})" if orbits.notes else ""
        raise InputError(
            f"--orbit {orbit[0]} {orbit[1]}: the model has no such orbit{more}: give another N K, another value of a "
            "number, or --start TAU V"
        )
    return list(orbits)


def take_branches(orbits: list[PeriodicOrbit], over: str, ends: tuple[str, str] | None, points: int) -> list[Branch]:
    """Branches through orbits, each once."""
    found: list[Branch] = []
    for orbit in orbits:
        if not any(on_branch(orbit, each) for each in found):
            found.append(si.branch(orbit, over, ends, points=points))
    return found


def on_branch(orbit: PeriodicOrbit, branch: Branch) -> bool:
    """Whether an orbit is one of a branch's, with the model where the branch began.

    Examples
    --------
    >>> from singimpact.branches.branch import branch
    >>> from singimpact.impact_oscillator import linear
    >>> low, high = linear("2.8", "0.1", "0.8", amplitude=-1).periodic(3, 3)  # both sides of a fold
    >>> on_branch(high, branch(low, "clearance", (-0.2, 0.3)))
    True
    """
    from singimpact.branches.periodic import periodic
    from singimpact.oscillator.moving_number import value_of

    if not branch.n:
        return False
    osc = branch.oscillator
    gap = branch.parameter - value_of(osc, branch.over)
    for i in (gap[:-1] * gap[1:] <= 0).nonzero()[0].tolist():
        share = gap[i] / (gap[i] - gap[i + 1]) if gap[i] != gap[i + 1] else 0.0
        tau, v = ((1 - share) * states[i] + share * states[i + 1] for states in (branch.tau, branch.v))
        try:
            near: list[PeriodicOrbit]
            if osc.autonomous:
                cycles = periodic(osc, branch.n)
                gaps = [abs(float(cycle.v[0]) - float(v[0])) for cycle in cycles]
                near = [cycles[gaps.index(min(gaps))]] if gaps else []
            else:
                near = periodic(osc, branch.impacts, branch.k, start=list(zip(tau.tolist(), v.tolist(), strict=True)))
        except InputError:
            continue
        for other in near:
            if abs(other.tau[0] - orbit.tau[0]) < SAME and abs(other.v[0] - orbit.v[0]) <= SAME * abs(orbit.v[0]):
                return True
    return False


def take_ends(low: Any, high: Any) -> Any:
    """--from and --to together, or neither.

    Raises
    ------
    InputError : one of them alone.

    Examples
    --------
    >>> take_ends("1", "2"), take_ends(None, None)
    (('1', '2'), None)
    """
    if (low is None) != (high is None):
        raise InputError(f"--{'to' if high is None else 'from'} is missing: give --from and --to, or neither")
    return None if low is None else (low, high)
