"""The work of compiled entries on Python's floats and lists: the same operations, until the compiled ones are there.

No table in double-double is filled here: a hit that is to be refined is left to balls.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.flights.bind import Emitted, over_floats
from singimpact.flights.kernels import layout
from singimpact.flights.kernels.state import ACROSS, FLIGHT_TIME, VELOCITY, Work

# What Python raises where doubles have an answer: 1/0, exp(1000), log(-1), a comparison of (-1)**0.5
LEFT_OPEN = (ZeroDivisionError, OverflowError, ValueError, TypeError)


def listed(part: Any) -> Any:
    """Named tuples of arrays as named tuples of lists."""
    if isinstance(part, np.ndarray):
        return part.tolist()
    if isinstance(part, tuple):
        values = [listed(each) for each in part]
        return type(part)(*values) if hasattr(part, "_fields") else tuple(values)
    return part.item() if isinstance(part, np.generic) else part


def workspace(zero: Any, order: int, rows: int) -> Work:
    """Scratch of one flight in numbers of any kind."""
    return Work([zero] * (order + 2), [[zero] * (order + 2) for _ in range(rows)], [zero] * (order + 2))


class Interpreter:
    """One model over lists."""

    def __init__(self, emitted: Sequence[Emitted], flats: Sequence[Array], sizes: Array) -> None:
        """`emitted`, `flats` : of the model, and of the one with x -> -x where there is another wall."""
        self.sizes, self.linear = sizes, not emitted[0].flow
        self.spaces = [over_floats(text.flow, text.rho) for text in emitted]
        self.models = [self._model(*each) for each in zip(self.spaces, flats, strict=True)]
        self.space, self.model = self.spaces[0], self.models[0]

    def _model(self, space: Mapping[str, Any], flat: Array) -> Any:
        if not self.linear:
            return listed(layout.taylor_model(flat, self.sizes))
        model = listed(layout.linear_model(flat, self.sizes))._replace(fine=[])
        space["tabulate"](model.numbers, model.table)
        space["bounds"](model.numbers, model.table)
        return model

    def work(self) -> Any:
        """New scratch."""
        flat = np.zeros(layout.scratch_length(self.sizes))
        return listed(layout.scratch_of(flat, self.sizes)), listed(layout.columns_of(flat, self.sizes))

    def hits(self, given: tuple[Array, ...], off_wall: bool, out: Array, status: Array) -> None:
        """`linear_hits`, `drops` or `taylor_hits`; given : tau, v, x - c off the wall or a_c at launches from it."""
        if self.linear:
            self._rows("linear_hits", given if off_wall else (*given[:2], np.zeros(0)), out, status)
        else:
            self._rows("drops" if off_wall else "taylor_hits", given, out, status)

    def releases(self, tau: Array, _: Array, removed: Array, out: Array, status: Array) -> None:
        """First hits of masses released at rest."""
        self._rows("releases", (tau, removed), out, status)

    def _rows(self, name: str, given: tuple[Array, ...], out: Array, status: Array) -> None:
        work, _ = self.work()
        rows, codes = np.full(out.shape, np.nan).tolist(), [0] * status.size
        self.space[name](*(part.tolist() for part in given), self.model, work, rows, codes)
        out[...], status[...] = rows, codes

    def segment(self, tau: float, v: float, near: float, w: Array, out: Array) -> tuple[int, int]:
        """One orbit, an impact a row."""
        work, _ = self.work()
        rows, laws = out.tolist(), [law.tolist() for law in np.split(w, len(self.models))]
        if len(self.models) == 1:
            flown, code = self.space["orbit_segment"](tau, v, near, laws * 2, self.models * 2, work, rows)
            out[...] = rows
            return flown, code
        # `orbit_segment` with what is bound for the flow and the law of each wall
        since, lost, side, flown, code = 0.0, 0.0, 0, 0, 0
        while flown < len(rows) and not code:
            here = self.spaces[side]
            code, push = here["hit_later"](tau, since, lost, v, near, self.models[side], work)
            if code == ACROSS:
                side, code = 1 - side, 0
            if code:
                break
            since, lost = here["later"](since, lost, work.hit[FLIGHT_TIME])
            v = self.spaces[side]["rebound"](work.hit[VELOCITY], laws[side])
            here["record"](rows[flown], since, v, push, float(side), work.hit)
            flown, code = flown + 1, 0 if v > 0 else 8
        out[...] = rows
        return flown, code

    def iterate(self, tau: Array, v: Array, impacts: int, w: Array, sides: Array, status: Array) -> None:
        """Orbits one after the other: tau, v become the last states."""
        if len(self.models) == 2:
            for k in np.flatnonzero(status == 0).tolist():
                rows = np.zeros((impacts, 12))
                flown, status[k] = self.segment(float(tau[k]), float(v[k]), 0.0, w, rows)
                if flown:
                    tau[k], v[k], sides[k] = tau[k] + rows[flown - 1, 0], *rows[flown - 1, [1, 11]]
            return
        work, _ = self.work()
        times, speeds, codes, laws = tau.tolist(), v.tolist(), status.tolist(), [w.tolist()] * 2
        self.space["iterate"](times, speeds, impacts, laws, self.models * 2, work, sides.tolist(), codes)
        tau[:], v[:], status[:] = times, speeds, codes

    def variations(self, tau: Array, v: Array, times: Array, out: Array) -> None:
        """`linear_variations` or `taylor_variations`."""
        if self.linear:
            self._fill("linear_variations", (tau, v, times), out)
        else:
            self._fill("taylor_variations", (tau, v, times), out, self.work()[1])

    def _fill(self, name: str, given: tuple[Array, ...], out: Array, *more: Any) -> None:
        """Results of a kernel that takes columns, the model, scratch and perhaps more."""
        rows = out.tolist()
        self.space[name](*(column.tolist() for column in given), self.model, self.work()[0], *more, rows)
        out[...] = rows

    def places(self, tau: Array, v: Array, times: Array, out: Array) -> None:
        """`linear_places`."""
        self._fill("linear_places", (tau, v, times), out)

    def follow(self, states: Array, counts: Array, times: Array, out: Array) -> None:
        """`follow` of Taylor flows from rows of t, x', x - c, each at as many of the times as `counts` says."""
        (work, _), rows, moments, begin = self.work(), out.tolist(), times.tolist(), 0
        for (tau, v, height), count in zip(states.tolist(), counts.tolist(), strict=True):
            t, t_low = self.space["reduced_twice"](tau, self.model.turn)
            self.space["placed"](t, t_low, self.model, work)
            places, work.flight.q[0] = rows[begin : begin + count], height  # the lists in it are those of `rows`
            parts = moments[begin : begin + count], self.model.numbers, self.model.rules, work.flight, places
            self.space["follow"](work.launch, v, *parts)
            begin += count
        out[...] = rows

    def judged(self, tau: Array, v: Array, removed: Array, out: Array, room: int) -> None:
        """`judged_hits`."""
        self._fill("judged_hits", (tau, v, removed), out, self.work()[1], [[0.0] * 4 for _ in range(room)])
