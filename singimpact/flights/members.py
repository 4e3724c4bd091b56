"""Models that differ in numbers alone, flown in compiled loops: each has its numbers and tables in a flat array.

What a model costs beside its flights is the filling of its tables. All else (trees, their derivatives, horizons) is
computed for all of them at once, over arrays of numbers in two doubles.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.flights.compiled_model import CompiledModel, address_of, compiled_model
from singimpact.flights.flat_numbers import Numbers
from singimpact.flights.horizons import Allowance, steps_of, usual
from singimpact.flights.interruptible import shared_out
from singimpact.flights.kernels import entries, layout
from singimpact.flights.kernels.hits import AT_REST
from singimpact.flights.machine import compilable
from singimpact.flights.results import count_flights
from singimpact.flights.states import FAR
from singimpact.oscillator.model import Oscillator


@dataclass(frozen=True)
class MemberSettings:
    """Sizes of what is flown together."""

    # rows of a table: flights are shorter than a turn or two of the fastest motion, and a longer one begins again
    rows: int = 48
    # members whose tables are held together: 28 kB each; orbits that take long are then many enough to fly together
    held: int = 2048
    # impacts of one call that are worth a thread
    shared: int = 2000


SETTINGS = MemberSettings()


class Members:
    """Some models of a family, ready to fly.

    Parameters
    ----------
    osc : the model. over : names of its numbers, each with a double for every member, shape (n,).
    """

    def __init__(self, osc: Oscillator, over: Mapping[str, Array]) -> None:
        self.osc, self.over, self.letters = osc, dict(over), frozenset(over)
        self.numbers = Numbers(osc, self.over)
        self.size, self.two_walls = self.numbers.size, osc.upper is not None
        arrays = {name: values[:, None] for name, values in self.over.items()}
        horizon, reach = (np.ravel(column) for column in usual(osc, arrays))
        allowance = Allowance(horizon, steps=steps_of(osc), reach=reach)
        self.model = CompiledModel(osc, allowance, None, self.numbers, SETTINGS.rows)
        self.linear, self.flats, self.laws = self.model.linear, self.model.flats, self.model.rhos
        period = self.numbers.period
        self.period = np.broadcast_to(np.nan if period is None else period.high, self.size)
        self._made: dict[int, Oscillator] = {}

    def member(self, index: int) -> Oscillator:
        """One of the models; its numbers are the doubles that were given."""
        if index not in self._made:
            self._made[index] = self.numbers.member(index)
        return self._made[index]

    def side(self, index: int, above: int) -> Oscillator:
        """One of the models, seen from its lower or its upper wall."""
        return self.member(index).mirrored if above else self.member(index)

    # ---- flights

    def near(self, which: Array, tau: Array) -> Array:
        """Whether launch times of members are within the reach of the reduction in kernels."""
        period = self.period[which]
        return np.asarray(np.isnan(period) | (np.abs(tau) < FAR * period))

    @cached_property
    def _entries(self) -> tuple[Callable[..., int], Callable[..., int]] | None:
        """The compiled entries of orbits and of flights from rest, with all tables filled; None: flown one by one."""
        if not compilable():
            return None
        model = self.model
        for text in (*model.recurrences, *model.laws):
            text.compile_here()
        main, rest = (
            model.machine.compile_here(name)[0] for name in (model.main, model.main if self.linear else "judge_entry")
        )
        # addresses of compiled texts, which the first model has, are those of all
        for array in (self.laws, *(() if self.linear else (self.flats,))):
            for piece in np.split(array, len(model.walls), axis=1):
                piece[:, -1] = piece[0, -1]
        if self.linear:
            shared_out(lambda part: self._prepare(main, part), 0, self.size, 16)
        return main, rest

    @cached_property
    def _turned(self) -> Array:
        """The models seen from the other wall."""
        return np.concatenate(np.split(self.flats, 2, axis=1)[::-1], axis=1)

    def _prepare(self, entry: Callable[..., int], chosen: slice) -> None:
        call, flats = _Call(self, entry, entries.PREPARE), _Table(self.flats)
        for index in range(chosen.start, chosen.stop):
            call(flats.at(index))

    def segments(
        self, which: Array, states: tuple[Array, Array, Array], counts: Array, near: float = 0.0
    ) -> tuple[Array, Array, Array]:
        """Impacts of orbits, see `CompiledModel.segment`: rows, shape (n, most, 12), impacts flown, and codes.

        Parameters
        ----------
        which : the member of each orbit. states : tau, v > 0 and wall of each. counts : impacts of each at most.
        """
        tau, v, walls = states
        rows = np.empty((tau.size, int(counts.max(initial=0)), 12))
        flown, codes = np.zeros(tau.size, int), np.zeros(tau.size, np.int8)
        result = self._entries
        if result is None:
            for i in range(tau.size):
                model = compiled_model(self.side(int(which[i]), int(walls[i])))
                some, codes[i] = model.segment(float(tau[i]), float(v[i]), int(counts[i]), near)
                rows[i, : len(some)], flown[i] = some, len(some)
            return rows, flown, codes
        numbers = np.column_stack([np.full(self.size, near), self.laws])
        behind = np.split(self.laws, len(self.model.walls), axis=1)[::-1]
        laws = _Table(numbers), _Table(np.column_stack([numbers[:, 0], *behind]))
        flats = _Table(self.flats), _Table(self._turned if walls.any() else self.flats)
        arrays = [_Table(np.ascontiguousarray(array)) for array in (tau, v)]

        def fly(chosen: slice) -> None:
            call, out = _Call(self, result[0], entries.SEGMENT), [_Table(rows), _Table(codes)]
            part = slice(chosen.start, chosen.stop)
            each = zip(which[part].tolist(), walls[part].tolist(), counts[part].tolist(), strict=True)
            for i, (m, above, count) in enumerate(each, chosen.start):
                if not count:
                    continue
                call.sizes[layout.COUNT] = count
                at = arrays[0].at(i), arrays[1].at(i), laws[above].at(m), out[0].at(i), out[1].at(i)
                flown[i] = call(flats[above].at(m), *at)

        shared_out(fly, 0, tau.size, max(1, SETTINGS.shared // max(rows.shape[1], 1)))
        count_flights(int(flown.sum()))
        if self.two_walls:
            for column in (3, 9, 10):
                rows[..., column] *= np.where(rows[..., 11] == 1, -1.0, 1.0)
        return rows, flown, codes

    def hits(self, which: Array, tau: Array, v: Array) -> tuple[Array, Array]:
        """Codes and columns of first hits, shape (10, n), as of `CompiledModel.hits`; AT_REST where v = 0."""
        return self._flights(which, (tau, v, np.full(tau.size, np.nan)), entries.HITS, 0)

    def releases(self, which: Array, tau: Array, removed: Array) -> tuple[Array, Array]:
        """Codes and columns of flights from rest, as of `CompiledModel.releases`."""
        return self._flights(which, (tau, tau, removed.astype(float)), entries.RELEASES, 1)

    def variations(self, which: Array, states: tuple[Array, Array, Array], times: Array) -> Array:
        """Derivatives of x - c and x' at flight times by v and tau, as of `CompiledModel.variations`, shape (4, n)."""
        tau, v, walls = states
        return self._flights(which, (tau, v, times), entries.VARIATIONS, 1, walls)[1][:4]

    def _flights(
        self, which: Array, states: tuple[Array, ...], kind: int, entry: int, walls: Array | None = None
    ) -> tuple[Array, Array]:
        size, columns = which.size, [np.ascontiguousarray(column) for column in states]
        width = 4 if kind == entries.VARIATIONS else 10
        out, codes, result = np.full((size, width), np.nan), np.full(size, AT_REST, np.int8), self._entries
        sides = np.zeros(size, np.int8) if walls is None else walls
        if result is None:
            for i in range(size):
                one = compiled_model(self.side(int(which[i]), int(sides[i])))
                some = [column[i : i + 1] for column in states]
                if kind == entries.VARIATIONS:
                    out[i] = one.variations(*some)[0]
                    continue
                ended = one.hits(*some[:2]) if kind == entries.HITS else one.releases(*some[::2])
                codes[i], out[i] = ended[0][0], ended[1][:, 0]
            return codes, out.T

        def fly(chosen: slice) -> None:
            call = _Call(self, result[entry], kind, 1)
            flats = _Table(self.flats), _Table(self._turned if sides.any() else self.flats)
            arrays = [_Table(array) for array in (*columns, out, codes)]
            for i, (m, side) in enumerate(
                zip(which[chosen].tolist(), sides[chosen].tolist(), strict=True), chosen.start
            ):
                call(flats[side].at(m), *(array.at(i) for array in arrays))

        shared_out(fly, 0, size, SETTINGS.shared)
        if kind == entries.VARIATIONS:
            return codes, out.T
        count_flights(size)
        return self.model._at_walls(codes, out.T)


class _Table:
    """Where the rows of an array lie."""

    def __init__(self, array: Array) -> None:
        self._array, self._begin, self._step = array, address_of(array), array.strides[0]

    def at(self, row: int) -> int:
        """The address of a row."""
        return self._begin + row * self._step


class _Call:
    """A compiled entry with scratch of its own, called for one member after the other."""

    def __init__(self, members: Members, entry: Callable[..., int], kind: int, count: int = 0) -> None:
        sizes = members.model.sizes.copy()
        sizes[layout.KIND], sizes[layout.COUNT] = kind, count
        scratch, nothing = members.model._new_scratch(), np.zeros(16)
        self._kept, self._entry, self.sizes = (scratch, nothing), entry, sizes
        self._nothing = address_of(nothing)
        self._addresses = sizes.ctypes.data, address_of(scratch)

    def __call__(self, flat: int, *arrays: int) -> int:
        sizes, scratch = self._addresses
        return self._entry(sizes, flat, scratch, *(arrays or [self._nothing] * 5))
