"""`si.fit`: numbers of a model from measured impacts, times of impacts, or a measured motion x(t).

The unknowns are the numbers and the true states of all impacts. What was measured is approached by least squares, under
the conditions that each state leads to the next, which are smooth through grazes:

    x(tau_{i+1}; tau_i, v_i) = c,        rho(x'(tau_{i+1})) = v_{i+1}

So the orbit is one of the model, although it may be chaotic: no flight starts from a state with an error.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array, as_float, float_array
from singimpact.flights.family import Family, family
from singimpact.flights.impact_map import impact_map
from singimpact.inputs import InputError, checked_keywords, refuse
from singimpact.oscillator.model import Oscillator, require_model
from singimpact.oscillator.moving_number import CLEARANCE, with_number
from singimpact.result import Result
from singimpact.status import Status

# What is measured: names of the columns
KINDS = (("tau", "v"), ("tau",), ("t", "x"))
NAMES = ("tau", "v", "t", "x")


@dataclass(frozen=True)
class FitSettings:
    """Steps of a fit, and when it is there."""

    # how far, in standard deviations of the noise, a state may miss the next one at first; this falls by `tighter`
    loose: float = 1e3
    tighter: float = 0.2
    least: float = 1e-6
    # steps at most, and the change of the numbers, in their errors, below which the fit is there
    steps: int = 80
    still: float = 1e-3
    # part of a flight by which its time may be missed
    off: float = 0.25
    # velocities below so many standard deviations are chatter that noise hides
    slow: float = 10.0
    # change of slope at a corner beside that between lines farther away, which is 0.4 where x is a parabola
    sharp: float = 0.7


SETTINGS = FitSettings()


@dataclass(frozen=True, eq=False)
class Fit(Result):
    """Numbers that were fitted.

    Attributes
    ----------
    values, error : name -> value, and its standard error. covariance : of the numbers, in the order of `values`.
    model : with these numbers. tau, v : the states of its orbit beside the impacts. t, residuals : what was measured
        less the orbit, with its times; shape (n, 2) of impacts (tau, v), else (n, 1). noise : name -> standard
        deviation of what was measured.
    missing : impacts of the model between measured ones. cut : indices of impacts after which the orbit is begun anew,
        as chatter, rest, too long a gap or another motion separates them from the next.
    """

    heads_csv = True
    model: Oscillator
    values: dict[str, float]
    error: dict[str, float]
    covariance: Array
    tau: Array
    v: Array
    t: Array
    residuals: Array
    noise: dict[str, float]
    missing: int
    cut: tuple[int, ...]

    @property
    def correlation(self) -> Array:
        """Correlations of the numbers."""
        size = np.sqrt(np.diag(self.covariance))
        return np.asarray(self.covariance / np.outer(size, size))

    def as_dict(self) -> dict[str, Any]:
        """Times and residuals by their names; values, errors, covariance, noise, what is missing and cut."""
        columns = {f"{name}_residual": off for name, off in zip(self.noise, self.residuals.T, strict=True)}
        lists = {"covariance": self.covariance.tolist(), "cut": list(self.cut)}
        names = ("values", "error", "noise", "missing")
        return {"t": self.t, **columns} | {name: getattr(self, name) for name in names} | lists

    def __repr__(self) -> str:
        numbers = ", ".join(f"{name} = {value:.8g} +- {self.error[name]:.2g}" for name, value in self.values.items())
        gaps = f", {self.missing} missing" if self.missing else ""
        cuts = f", begun anew after {len(self.cut)}" if self.cut else ""
        return f"Fit({numbers}; {self.tau.size} impacts{gaps}{cuts})"


@checked_keywords
def fit(osc: Oscillator, data: Any, over: Sequence[str], *, noise: Any = None) -> Fit:
    """Numbers of a model whose orbit is nearest to what was measured.

    Parameters
    ----------
    osc : the model, of one wall, with values of the numbers to start from. over : names of the numbers, such as
        ("restitution", "clearance").
    data : {"tau": times, "v": velocities} of impacts, also an orbit; {"tau": times} alone; or {"t": times, "x":
        places}, a motion whose impacts lie between samples.
    noise : standard deviations of what was measured, one for each column that has noise (tau, v; tau; x). None: they
        are taken from the residuals, equal at first.

    Returns
    -------
    Fit : `.values`, `.error`, `.correlation`, `.model`, `.residuals`; `si.plot` draws the residuals.

    Notes
    -----
    The errors are the Cramer-Rao bound at the fitted orbit: those of an efficient estimate with normal noise.

    Examples
    --------
    >>> true = Oscillator("x", "-cos(14/5*t)", "0.1", "0.8")
    >>> from singimpact.dynamics.orbit import orbit
    >>> seen, rng = orbit(true, "0.3", "0.4", 60), np.random.default_rng(1)
    >>> data = {"tau": seen.tau + rng.normal(0, 1e-3, 61), "v": seen.v + rng.normal(0, 1e-3, 61)}
    >>> found = fit(true.replace(clearance="0.15", restitution="0.7"), data, ("restitution", "clearance"))
    >>> bool(abs(found.values["restitution"] - 0.8) < 4 * found.error["restitution"] < 1e-2)
    True
    """
    require_model("osc", osc)
    names = tuple(over)
    if not names or isinstance(over, str) or len(set(names)) < len(names):
        raise refuse("over", over, 'different names of numbers, ("restitution", "clearance")')
    osc = reduce(with_number, names, osc)
    columns = _columns(data)
    wanted = len(columns) - ("x" in columns)
    sizes = np.ones(wanted) if noise is None else float_array("noise", noise).ravel()
    if sizes.size != wanted or not (np.isfinite(sizes) & (sizes > 0)).all():
        raise refuse("noise", noise, f"{wanted} standard deviations above 0")
    moving = family(osc, names)
    numbers = np.array([moving.start[name] for name in names])
    record = _Motion(columns, sizes) if "x" in columns else _Impacts(columns, sizes, moving)
    states = record.states()
    # the first impacts are fitted first, because what a wrong period misses grows with time
    counts = [count for count in (12, 36) if count < len(states)]
    for count in (*counts, len(states), None):  # last with the first hits, once the numbers tell them
        run = _Run(moving, record, (numbers, states[:count]), count is None)
        run.settle(noise is None)
        numbers, states[:count] = run.numbers, run.states[run.seen]
    if "x" in columns and run.cut_outliers():
        run.settle(noise is None)
    return run.result(names)


def _columns(data: Any) -> dict[str, Array]:
    item = data if isinstance(data, Mapping) else {name: getattr(data, name, None) for name in NAMES}
    order = [name for name in NAMES if name in item] + [str(name) for name in item if name not in NAMES]
    columns = {name: float_array(name, item[name]) for name in order if item[name] is not None}
    if tuple(columns) not in KINDS:
        accepted = " or ".join(str(list(kind)) for kind in KINDS)
        raise InputError(f"data has the columns {list(columns)}: give arrays by name, {accepted}")
    times = next(iter(columns.values()))
    if any(values.shape != times.shape for values in columns.values()) or times.ndim != 1 or times.size < 3:
        raise refuse(
            "data", {name: values.shape for name, values in columns.items()}, "columns of three numbers or more"
        )
    if not all(np.isfinite(values).all() for values in columns.values()) or not (np.diff(times) > 0).all():
        raise refuse("data", "columns with nan, or times that fall", "finite numbers, at times that rise")
    return columns


class _Impacts:
    """Measured impacts: their times, and perhaps velocities after them."""

    def __init__(self, columns: Mapping[str, Array], sizes: Array, moving: Family) -> None:
        self.columns, self.sizes, self.moving, self.names = columns, sizes, moving, tuple(columns)

    def states(self) -> Array:
        """States to start from, shape (n, 2)."""
        tau, moving, values = self.columns["tau"], self.moving, self.moving.start
        if "v" in self.columns:
            return np.stack([tau, self.columns["v"]], axis=1)
        v = np.ones(tau.size)
        for i, time in enumerate(np.diff(tau).tolist()):
            for _ in range(4):  # the velocity from which x is at the wall then
                end = moving.end(values, float(tau[i]), float(v[i]), time)
                v[i] -= end.place[0] / end.by_v[0]
        v[-1] = moving.rebound(float(end.place[1]), values)[0]
        return np.stack([tau, v], axis=1)

    def rows(self, run: _Run) -> tuple[Array, Array, Any]:
        """Times of what was measured, what it exceeds the orbit by, and the derivatives of the orbit there."""
        from scipy.sparse import csr_array

        seen, columns = run.seen, np.stack(list(self.columns.values()), axis=1)[: len(run.seen)]
        count = columns.shape[1]
        slots = (2 * seen[:, None] + np.arange(count)).ravel()
        matrix = csr_array((np.ones(slots.size), (np.arange(slots.size), slots)), shape=(slots.size, run.size))
        return columns[:, 0], columns - run.states[seen, :count], matrix


class _Motion:
    """A motion that was sampled."""

    def __init__(self, columns: Mapping[str, Array], sizes: Array) -> None:
        self.t, self.x, self.sizes, self.names = columns["t"], columns["x"], sizes, ("x",)

    def states(self) -> Array:
        """Impacts at the corners of x(t)."""
        # lines are laid through so many samples beside a corner, which is low: in a tenth of the whole height
        t, x, n = self.t, self.x, 3
        low, high = x.min(), x.max()
        states = []
        for i in range(2 * n, t.size - 2 * n):
            if x[i] > x[i - n : i + n + 1].min() or x[i] > low + 0.1 * (high - low):
                continue
            lines = [
                np.polyfit(t[begin : begin + n] - t[i], x[begin : begin + n], 1)
                for begin in (i - 2 * n, i - n, i + 1, i + n + 1)
            ]
            (before, _), (fall, left), (rise, right), (after, _) = lines
            # at a minimum without impact the slope changes as much farther away
            if fall < 0 < rise and rise - fall > SETTINGS.sharp * (after - before):
                states.append((t[i] + (left - right) / (rise - fall), rise))
        if len(states) < 3:
            raise refuse("data", f"a motion with {len(states)} impacts", "three impacts or more, with samples between")
        return np.array(states)

    def rows(self, run: _Run) -> tuple[Array, Array, Any]:
        """Residuals as of `_Impacts`, of samples between two impacts of which one leads to the next."""
        from scipy.sparse import csr_array

        flight = np.searchsorted(run.states[:, 0], self.t) - 1
        inside = np.flatnonzero((flight >= 0) & np.isin(flight, run.links))
        rows, slots, entries, off = [], [], [], np.empty(inside.size)
        clearance = run.values.get(CLEARANCE, as_float(run.moving.osc.clearance))
        by_clearance = [float(name == CLEARANCE) for name in run.moving.over]
        for row, at in enumerate(inside.tolist()):
            i = int(flight[at])
            tau, v = run.states[i].tolist()
            end = run.moving.end(run.values, tau, v, float(self.t[at]) - tau)
            off[row] = self.x[at] - clearance - end.place[0]
            by_numbers = end.by_numbers[:, 0] + by_clearance
            rows += [row] * (2 + by_numbers.size)
            slots += [2 * i, 2 * i + 1, *range(run.size - by_numbers.size, run.size)]
            entries += [end.by_tau[0] - end.by_time[0], end.by_v[0], *by_numbers]
        return self.t[inside], off[:, None], csr_array((entries, (rows, slots)), shape=(inside.size, run.size))


class _Run:
    """States of an orbit, numbers, and the conditions by which each state leads to the next.

    Parameters
    ----------
    begin : numbers and states. first : whether flights must be first hits; numbers far off tell others.
    """

    def __init__(self, moving: Family, record: Any, begin: tuple[Array, Array], first: bool) -> None:
        (numbers, states), self.first = begin, first
        self.moving, self.record, self.numbers = moving, record, numbers
        self.model = moving.oscillator(self.values)
        # the noise of velocities is known in the last run
        self.slow = SETTINGS.slow * record.sizes[-1] if first and len(record.sizes) == 2 else 0.0
        pieces: list[Array] = []
        links: list[int] = []
        seen: list[int] = []
        self.cut: list[int] = []
        for i, state in enumerate(states):
            seen.append(len(pieces))
            pieces.append(state)
            if i + 1 == len(states):
                break
            between = self._between(state, states[i + 1])
            if between is None:
                self.cut.append(i)
                continue
            links += range(len(pieces) - 1, len(pieces) + len(between))
            pieces += between
        self.states, self.links, self.seen = np.array(pieces), np.array(links), np.array(seen)
        if self.links.size < len(moving.over):
            raise InputError(
                f"the numbers {', '.join(moving.over)} are not determined: only {self.links.size} measured impacts "
                "lead to the next one; start from a model nearer to what was measured"
            )
        self.size = self.states.size + numbers.size

    @property
    def values(self) -> dict[str, float]:
        """The numbers by name."""
        return dict(zip(self.moving.over, self.numbers.tolist(), strict=True))

    def _between(self, state: Array, following: Array) -> list[Array] | None:
        """The impacts that are missing between two measured ones; None where the first does not lead to the second."""
        (tau, v), gap = state.tolist(), float(following[0] - state[0])
        between: list[Array] = []
        if v <= self.slow:
            return None
        end = self.moving.end(self.values, tau, v, gap)
        rho, *_ = self.moving.rebound(float(end.place[1]), self.values)
        beside = abs(rho - following[1]) < SETTINGS.off * max(v, following[1])
        if not self.first and beside and abs(end.place[0]) < -SETTINGS.off * gap * end.by_time[0]:
            return between  # it comes down to the wall about then
        # so many impacts may be missing
        while len(between) <= 8:
            step = impact_map(self.model, tau, v)
            if step.status != Status.hit:
                return None
            tau, v = float(step.tau), float(step.v)
            if abs(tau - following[0]) < SETTINGS.off * min(gap, float(step.flight_time)):
                return between
            if tau > following[0]:
                return None
            between.append(np.array([tau, v]))
        return None

    def cut_outliers(self) -> bool:
        """Whether flights beside which the motion does not lie, as of one with an impact more, are left out now."""
        t, off, _ = self.record.rows(self)
        flight = np.searchsorted(self.states[:, 0], t) - 1
        counts = np.bincount(flight, minlength=len(self.states))
        sizes = np.sqrt(np.bincount(flight, off[:, 0] ** 2, len(self.states)) / np.maximum(counts, 1))
        # flights with such residuals, beside those of most flights, are left out
        far = np.flatnonzero(sizes > 3.0 * np.median(sizes[counts > 0]))
        self.links = np.setdiff1d(self.links, far)
        self.cut = sorted({*self.cut, *(np.searchsorted(self.seen, far, side="right") - 1).tolist()})
        return bool(far.size)

    def settle(self, spread: bool) -> None:
        """The least squares; with the noise that the residuals of a first try have, if it is not given."""
        # states at which the first hits are told are an orbit already
        self._fitted(SETTINGS.least if self.first else SETTINGS.loose)
        if spread:
            self.record.sizes = self.spread()
            self._fitted(SETTINGS.least)

    def _fitted(self, loose: float) -> None:
        """Newton's method of the least squares, whose conditions are so loose at first."""
        from scipy.sparse import block_array, csc_array, diags_array
        from scipy.sparse.linalg import splu

        count = self.numbers.size
        for _ in range(SETTINGS.steps):
            missed, slopes = self._conditions()
            _, off, orbit = self.record.rows(self)
            weights = diags_array(np.tile(1 / self.record.sizes**2, len(off)))
            soft = diags_array(np.full(missed.size, -((loose * float(self.record.sizes[0])) ** 2)))
            # a light weight of each step: a state that nothing was measured of stays where it is
            still = diags_array(np.full(self.size, 1e-9 / float(self.record.sizes[0]) ** 2))
            normal = orbit.T @ weights @ orbit + still
            matrix = csc_array(block_array([[normal, slopes.T], [slopes, soft]]))
            right = np.concatenate([orbit.T @ (weights @ off.ravel()), -missed])
            unit = np.zeros((right.size, count))
            unit[self.size - count : self.size] = np.eye(count)
            solver = splu(matrix)
            step = solver.solve(right)[: self.size]
            self.covariance = solver.solve(unit)[self.size - count : self.size]
            # no state moves by more than half of its flight
            far = np.abs(step[: self.states.size : 2]).max() / np.diff(self.states[:, 0]).min()
            step *= min(1.0, 0.5 / far) if far else 1.0
            self.states += step[: self.states.size].reshape(-1, 2)
            self.numbers = self.numbers + step[self.states.size :]
            small = (np.abs(step[self.states.size :]) < SETTINGS.still * np.sqrt(np.diag(self.covariance))).all()
            if loose <= SETTINGS.least and small:
                return
            loose = max(SETTINGS.tighter * loose, SETTINGS.least)
        raise InputError(
            f"data: no orbit beside it was found in {SETTINGS.steps} steps: start from a model nearer to what was "
            "measured"
        )

    def _conditions(self) -> tuple[Array, Any]:
        """Distances by which flights miss the next states, and their derivatives."""
        from scipy.sparse import csr_array

        values, count, base = self.values, self.numbers.size, self.states.size
        missed, entries = np.empty((self.links.size, 2)), np.empty((self.links.size, 2, 4 + count))
        for row, i in enumerate(self.links.tolist()):
            missed[row], entries[row] = self.moving.link(values, self.states[i], self.states[i + 1])
        slots = np.column_stack(
            [2 * self.links[:, None] + np.arange(4), np.tile(np.arange(base, base + count), (self.links.size, 1))]
        )
        rows = np.repeat(np.arange(missed.size), 4 + count)
        every = np.repeat(slots, 2, axis=0).ravel()
        return missed.ravel(), csr_array((entries.ravel(), (rows, every)), shape=(missed.size, self.size))

    def spread(self) -> Array:
        """Standard deviations of what was measured, from the residuals; the orbit has taken some of them in."""
        off = self.record.rows(self)[1]
        free = self.size - 2 * self.links.size
        if off.size <= free:
            raise refuse("data", f"{off.size} numbers", f"more than {free}, which the orbit has free, or noise=")
        size = np.sqrt((off**2).sum(axis=0) / len(off) * off.size / (off.size - free))
        # noise at least, beside the size of what was measured
        return np.asarray(np.maximum(size, 1e-12 * np.abs(self.states).max()))

    def result(self, names: tuple[str, ...]) -> Fit:
        """The result of the last step."""
        t, off, _ = self.record.rows(self)
        tau, v = self.states.T
        return Fit(
            self.moving.oscillator(self.values),
            self.values,
            dict(zip(names, np.sqrt(np.diag(self.covariance)).tolist(), strict=True)),
            self.covariance,
            tau,
            v,
            t,
            off,
            dict(zip(self.record.names, self.record.sizes.tolist(), strict=True)),
            len(self.states) - len(self.seen),
            tuple(self.cut),
        )
