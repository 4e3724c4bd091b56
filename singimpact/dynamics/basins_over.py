"""Basins over a number of the model: shares of the states that go to attractors, which are followed by their states.

At each value a sample of states is flown; attractors of neighbouring values are one where their class is and their
states are near, as in `global_continuation` of Attractors.jl: G. Datseris, K. Luiz Rossi, A. Wagemakers, Chaos 33
(2023) 073151.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from singimpact.algebra.numbers import Array, as_float, constant
from singimpact.cases import in_threads
from singimpact.dynamics import basins_of_attraction
from singimpact.dynamics.behaviours import JUMP, LongRun, matched
from singimpact.inputs import whole
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.moving_number import with_number
from singimpact.surface.curve import window_ends


@dataclass(frozen=True, repr=False)
class BasinsOver(basins_of_attraction.ClassGrid):
    """Shares of basins over a number of the model.

    Attributes
    ----------
    over : the number. values : shape (m,). attractors : those that occur, each as it is at the last value with it.
    codes : shape (m, states), indices into `attractors` of the states of the sample at each value.
    share, error : of the states that go to each attractor, shape (m, attractors), and standard errors of the shares.
    undecided : the share of states that no attractor is known of, shape (m,).
    """

    heads_csv = True
    array_axes: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "values": ("values",),
        "undecided": ("values",),
        "attractor": ("attractor",),
        "share": ("values", "attractor"),
        "error": ("values", "attractor"),
    }
    model: Oscillator
    over: str
    values: Array
    attractors: tuple[LongRun, ...]
    codes: Array

    @property
    def sides(self) -> tuple[tuple[str, Array], tuple[str, Array]]:
        """Numbers of the states, and the values."""
        return ("state", np.arange(self.codes.shape[1])), (self.over, self.values)

    @property
    def share(self) -> Array:
        """Shares of the states, shape (m, attractors)."""
        return np.asarray((self.codes[..., None] == np.arange(len(self.attractors))).mean(axis=1))

    @property
    def error(self) -> Array:
        """Binomial standard errors, with one state more in and one more out of each basin: none is 0."""
        n = self.codes.shape[1]
        share = (n * self.share + 1) / (n + 2)
        return np.asarray(np.sqrt(share * (1 - share) / (n + 3)))

    @property
    def undecided(self) -> Array:
        """Shares of states whose class is not decided, shape (m,)."""
        return np.asarray(self.share[:, ~self.decided].sum(axis=1))

    def __repr__(self) -> str:
        ends = f"{self.values.size} values from {self.values[0]:.6g} to {self.values[-1]:.6g}"
        return f"BasinsOver({self.over}: {ends}, {self.codes.shape[1]} states of each: {self.shares})"

    def as_dict(self) -> dict[str, Any]:
        """The values, names of the attractors, shares, their errors, and the shares that are not decided."""
        names = np.array([name for _, name, _ in sorted(self.classes)], dtype=object)
        columns = {name: getattr(self, name) for name in ("share", "error", "undecided")}
        return {"over": self.over, "values": self.values, "attractor": names} | columns


def basins_over(
    model: Oscillator,
    over: str,
    between: Any,
    window: tuple[Any, Any] = (None, None),
    values: int = 50,
    impacts: int = basins_of_attraction.SETTINGS.impacts,
    wall: Any = None,
    **sampling: Any,
) -> BasinsOver:
    """Shares of the basins of a window over a number of the model.

    Parameters
    ----------
    model, impacts, wall : as of `basins`. over : a number, as of `bifurcation`. between : its ends. values : of it.
    window : ends of both axes, each may be None. sampling : `states` at each value (400), drawn evenly from the window
        with the numpy `seed` (0), at the same places of the window at all values; `jump` (0.25), the distance of states
        of two neighbouring values, in periods and highest velocities, from which on they are two attractors; `executor`
        and `output` of `sweep`: a case is a value.

    Examples
    --------
    >>> found = basins_over(Oscillator("x", "cos(2*t)", 0, "1/2"), "clearance", ("0.2", "0.3"), values=3, states=20)
    >>> found.share.tolist(), found.attractors[0].name
    ([[1.0], [1.0], [1.0]], '(1, 1) orbit')
    """
    side = basins_of_attraction.checked_wall(model, wall)
    model = with_number(model, over)
    count = whole("states", sampling.pop("states", 400), 1, 10**6)
    seed = whole("seed", sampling.pop("seed", 0), 0, 2**63)
    jump = as_float(constant("jump", sampling.pop("jump", JUMP)))
    numbers = np.linspace(*window_ends(over, between), whole("values", values, 2, 10**5))
    places = np.random.default_rng(seed).random((2, count))
    models = [model.replace(**{over: value}) for value in numbers.tolist()]
    samples = [basins_of_attraction.placed(moved, window, places, side, impacts) for moved in models]
    tables = in_threads(
        basins_of_attraction.classified, [basins_of_attraction.case_of(*sample) for sample in samples], sampling
    )
    studies = [study for study, _ in samples]
    several = [
        basins_of_attraction.named(study, basins_of_attraction.for_ever(study, states, np.asarray(table))[0])
        for (study, states), table in zip(samples, tables, strict=True)
    ]
    units = [study.phases.unit if study.phases.clocked else np.inf for study in studies]
    attractors, labels = matched([runs for runs, _ in several], units, max(study.fast for study in studies), jump)
    codes = np.array([np.array(label)[code] for label, (_, code) in zip(labels, several, strict=True)])
    return BasinsOver(model, over, numbers, tuple(attractors), codes)
