"""The kernel of a model: which flow it has, the text joined for it, its numbers as doubles or mpf."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any

from singimpact.algebra.expressions import Expression, Number, Pi, multiply, number, power
from singimpact.algebra.numbers import as_float, sign_of
from singimpact.codegen import radii
from singimpact.codegen.interpreted import function
from singimpact.flights import first_root, march, pull, strides, variation
from singimpact.flights.flow import closed_form, table, taylor
from singimpact.oscillator.linear import LinearForm, at_rest, linear_form
from singimpact.oscillator.model import Oscillator

COMMON = (first_root.sums, first_root.safe_step, first_root.polished, first_root.first_root, march.advanced,
          march.note, march.moved, march.curvature, march.march, march.run, march.follow)  # fmt: skip
RADII = (radii.quotient, radii.real_power, radii.whole_power_radius, radii.power_radius, radii.power_of_square_radius,
         radii.exp_radius, radii.bell_radius, radii.circular_radius, radii.tan_radius, radii.tanh_radius,
         radii.atan_radius, radii.log_radius, radii.log_of_square_radius, radii.softplus_radius)  # fmt: skip
STEPS = (taylor.step_terms, taylor.wished_step, taylor.shortened_step, taylor.allowed_step, taylor.searched_step,
         taylor.proved_step, taylor.singular_part, taylor.step_size, taylor.restart)  # fmt: skip
EMITTED = ("coefficients", "disc", "rounding", "variations", "disc_of_columns")
COLUMNS = (variation.judge, variation.column_step, variation.respond, variation.respond_all, march.run_judged)
STRIDES = (table.tabulate, table.bounds, table.expansions, strides.series, strides.falling, strides.launched,
           strides.turned,
           strides.inner_stride, strides.place, strides.newton, strides.lowest, strides.crossing,
           strides.bent_stride, strides.renewed, strides.asked, strides.stride, strides.stride_all,
           pull.divided, pull.phase_of, pull.in_quarter, pull.wave,
           pull.wave_twice, pull.pull_twice, pull.pull)  # fmt: skip
HEAD = '''"""Written by singimpact from the text of its own functions and from f and g: edit those, not this file."""

from __future__ import annotations

from cmath import sqrt as complex_sqrt
from math import inf, nan
from typing import Any

from numpy import empty
'''


@dataclass(frozen=True, eq=False)
class Kernel:
    """What is needed to fly: text, names of its functions (callees first), rows of work, numbers, waves.

    Parameters
    ----------
    form : the linear form; None: the launch is its time.
    """

    text: str
    names: tuple[str, ...]
    rows: int
    constants: tuple[Expression, ...]
    form: LinearForm | None


@dataclass(frozen=True)
class Prices:
    """Microseconds of a flight when its text is interpreted.

    Attributes
    ----------
    stride : through the table of a linear model, measured from 16 to 23. place : of one flight after a known time, with
        its derivatives, by the closed form, from 15 to 25. taylor : in Taylor steps, from 1700 to 4000.
    """

    stride: float = 25.0
    place: float = 25.0
    taylor: float = 3000.0


PRICES = Prices()


def ready(kernel: Kernel, name: str, flights: int) -> Callable[..., Any]:
    """A function of a kernel for so many flights, compiled or not."""
    closed = {"stride_all": PRICES.stride, "responses": PRICES.place}
    return function(kernel.text, kernel.names, name, flights * closed.get(name, PRICES.taylor))


@lru_cache(maxsize=256)
def kernel_of(osc: Oscillator, exact_restart: bool = True) -> Kernel:
    """The kernel of a model; with `exact_restart` a linear model restarts from its closed form (doubles only)."""
    form = linear_form(osc)
    if form is None:
        return taylor_kernel(osc)
    text, names = _linear_text(exact_restart)
    return Kernel(text, names, max(4 * len(form.harmonics), 1), linear_constants(osc, form), form)


@lru_cache(maxsize=256)
def taylor_kernel(osc: Oscillator) -> Kernel:
    """The kernel of any model, linear or not, in Taylor steps."""
    emitted = taylor.recurrence_of(osc)
    parts = (*RADII, *STEPS, *COMMON, *COLUMNS)
    names = (*EMITTED, *_names(parts))
    return Kernel(joined(emitted.source, parts), names, emitted.rows, tuple(taylor.constants(osc)), None)


@lru_cache(maxsize=2)
def _linear_text(exact_restart: bool) -> tuple[str, tuple[str, ...]]:
    restart = (
        (
            pull.sum_twice,
            pull.product_twice,
            closed_form.turning,
            closed_form.pair,
            closed_form.triple,
            closed_form.restart,
        )
        if exact_restart
        else (taylor.restart,)
    )
    parts: tuple[Callable[..., Any], ...] = (
        closed_form.coefficients, closed_form.step_size, closed_form.singular_part, *restart, *COMMON,
    )  # fmt: skip
    if exact_restart:
        parts += (*STRIDES, closed_form.responses)
    return joined("", parts), _names(parts)


def _names(parts: tuple[Callable[..., Any], ...]) -> tuple[str, ...]:
    return tuple(part.__name__ for part in parts)


def joined(emitted: str, parts: tuple[Callable[..., Any], ...]) -> str:
    """The text of a kernel: an emitted source and the functions that go with it."""
    return "\n\n".join([HEAD, emitted, *(source(part) for part in parts)])


@lru_cache(maxsize=64)
def source(part: Callable[..., Any]) -> str:
    """The text of a function of this package."""
    return inspect.getsource(part)


def linear_constants(osc: Oscillator, form: LinearForm) -> tuple[Expression, ...]:
    """p of the closed form; the largest rate is only a scale, so a double of it is enough."""
    damping, stiffness = as_float(form.damping), as_float(form.stiffness)
    scale = max(abs(damping), abs(stiffness) ** 0.5, *(abs(as_float(wave.rate)) for wave in form.harmonics), 0.0)
    numbers = [osc.clearance, form.damping, form.stiffness, at_rest(form, osc.clearance), Number(Fraction(scale))]
    for wave in form.harmonics:
        numbers += [wave.rate, wave.cosine, wave.sine]
    return tuple(numbers)


@lru_cache(maxsize=256)
def turn(rate: Expression) -> Expression:
    """The time 2 pi/|rate| of a turn."""
    return multiply(number(2 * sign_of(rate)), Pi(), power(rate, number(-1)))
