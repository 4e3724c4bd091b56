"""A flight whose state is carried from step to step as a ball, with its columns: of points, and not for long."""

from __future__ import annotations

from typing import Any

from singimpact.flights.enclosures.equation import Equation, Refused
from singimpact.flights.enclosures.taylor_step import Column, Step, step
from singimpact.flights.enclosures.tube import Tube, divided, height, speed


class PlainMotion:
    """The state (t, z, z') in balls, and the derivatives by the launch time, by v and by the names of the equation.

    Parameters
    ----------
    equation : the model. tau, v : the launch. bits : of a step. removed : 1, or the power of t in z from rest.
    expected : the flight time in doubles, or 0.
    with_columns : whether the derivatives are carried; the one by tau is at equal time since the launch.
    """

    def __init__(
        self, equation: Equation, tau: Any, v: Any, bits: int, removed: int = 1, with_columns: bool = False,
        expected: float = 0.0,
    ) -> None:  # fmt: skip
        from flint import arb

        self.equation, self.tau, self.bits, self.removed, self.expected = equation, tau, bits, removed, expected
        self.time, self.z, self.v = arb(0), arb(0), v
        self.drives = [0, -1, *range(1, len(equation.names) + 1)] if with_columns else []
        self.starts = [(arb(0), arb(int(drive == -1))) for drive in self.drives]
        self.step: Step | None = None
        self.flown = 0

    @property
    def launched(self) -> bool:
        """Whether the next step is the first."""
        return bool(self.time == 0)

    def tubes(self, most: Any = None) -> tuple[Tube, Tube, Any]:
        """z and z' on the next step, and its length."""
        columns = [Column(start, drive) for start, drive in zip(self.starts, self.drives, strict=True)]
        removed = self.removed if self.launched else 1
        self.step = step(
            self.equation,
            (self.tau + self.time, self.z, self.v),
            columns,
            self.bits,
            most,
            removed,
            self.expected - float(self.time),
            self.step,
        )
        return height(self.step.coefficients, self.step.bound), speed(self.step.coefficients, self.step.bound), (
            self.step.length)  # fmt: skip

    def advance(self, length: Any) -> None:
        """To a time within the step."""
        assert self.step is not None
        tubes = [(height(P, K), speed(P, K)) for P, K in self._series()]
        (self.z, self.v), *self.starts = [(value(length), slope(length)) for value, slope in tubes]
        self.time = self.time + length
        if not self.z > 0:
            raise Refused("x - c is not shown positive at the end of a step")

    def _series(self) -> list[tuple[list[Any], Any]]:
        assert self.step is not None
        return [(self.step.coefficients, self.step.bound),
                *zip(self.step.columns, self.step.column_bounds, strict=True)]  # fmt: skip

    def at_hit(self, root: Any, velocity: Any, rate: Any) -> tuple[Any, Any, list[tuple[Any, Any]]]:
        """Time since the launch, velocity, and the derivatives of both in the order tau, v, names.

        Parameters
        ----------
        root : the time since the step began. velocity : z' there. rate : z' there, or y' on the first step.
        """
        total, by = self.time + root, []
        if self.drives:
            f, g = self.equation.run("force", x=velocity * 0, xdot=velocity)[0], self.equation.run(
                "forcing", t=self.tau + total)[0]  # fmt: skip
            for P, K in self._series()[1:]:
                value, slope = height(P, K), speed(P, K)
                if self.launched:  # psi/z' = (psi/s)/y', with all its digits as v -> 0
                    value = divided(value, slope, 1)[0]
                delay = -value(root) / rate
                by.append((delay, slope(root) + (g - f) * delay))
        return total, velocity, by
