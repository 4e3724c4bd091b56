"""`CompiledModel`: all that the flights of a model need, prepared once, and the one place that calls a kernel."""

import ctypes
from collections.abc import Callable, Sequence
from functools import lru_cache, partial
from time import perf_counter
from typing import Any

import numpy as np

from singimpact.algebra.expressions import names_in
from singimpact.algebra.numbers import Array
from singimpact.algebra.precision import kept_property
from singimpact.codegen.taylor_recurrence import Recurrence
from singimpact.flights.bind import Emitted
from singimpact.flights.flat_numbers import TABLES, Numbers, laid_out
from singimpact.flights.horizons import Allowance, horizon_of, reach_of, steps_of
from singimpact.flights.interpreted import LEFT_OPEN, Interpreter
from singimpact.flights.interruptible import LONG, interruptible, shared_out, threads_now
from singimpact.flights.kernels import entries, layout
from singimpact.flights.kernels.chatter import NO_ROOM
from singimpact.flights.kernels.hits import AT_REST, NOT_REFINED
from singimpact.flights.kernels.state import ACROSS, LANES, VELOCITY, VELOCITY_BY_TAU, VELOCITY_BY_V
from singimpact.flights.limits import LIMITS
from singimpact.flights.machine import FEW, Bound, Called, Machine, compilable, machine_of, one_by_one
from singimpact.flights.model_numbers import has_table, recurrence_of
from singimpact.flights.results import count_flights
from singimpact.flights.states import late
from singimpact.inputs import InputError
from singimpact.oscillator.linear import form_of, linear_form
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.period import reduced

# Kinds of work that fill the tables which an entry reads
PREPARATIONS = {"linear_entry": entries.PREPARE, "batch_entry": entries.PREPARE_BATCH}
# Kinds of work that look for hits; they return codes too
SEARCHES = (entries.HITS, entries.DROPS)
INTERPRETED: dict[int, Callable[..., None]] = {
    entries.RELEASES: Interpreter.releases, entries.PLACES: Interpreter.places,
    entries.VARIATIONS: Interpreter.variations}  # fmt: skip
# An entry and a kind of work
Work = tuple[Callable[..., int], int]


@lru_cache(maxsize=256)
def compiled_model(osc: Oscillator) -> "CompiledModel":
    """The compiled model of an oscillator with the default horizon, accuracy and number of steps."""
    return allowed(osc, Allowance(horizon_of(osc, None), steps=steps_of(osc), reach=reach_of(osc)))


@lru_cache(maxsize=64)
def allowed(osc: Oscillator, allowance: Allowance) -> "CompiledModel":
    """The compiled model of an oscillator under other rules."""
    return CompiledModel(osc, allowance)


class CompiledModel:
    """A model's numbers, tables and scratch in flat arrays, and the compiled entries that work on them.

    States are doubles here, v > 0; results are codes of the kernels, see `kernels.entries`, and rows of numbers.
    """

    def __init__(
        self,
        osc: Oscillator,
        allowance: Allowance,
        flow: Recurrence | None = None,
        numbers: Numbers | None = None,
        rows: int = TABLES.rows,
    ) -> None:
        """`flow` : a recurrence of the model with another third column, see `codegen.taylor_recurrence`. numbers : of
        many models, of which this is the first. rows : of the tables of a linear model.
        """
        self.osc, self.allowance = osc, allowance
        self.form = linear_form(osc)
        numbers = numbers or Numbers(osc)
        form = self.form and form_of(osc.force(numbers.letters), osc.forcing(numbers.letters))
        self.linear = flow is None and form is not None and has_table(osc)
        self.walls = numbers.sides
        self.constant_restitution = not any(names_in(item.restitution) for item in self.walls)
        self.flow = None if self.linear else flow or recurrence_of(osc)
        flows = [self.flow, *(None if self.linear else recurrence_of(item) for item in self.walls[1:])]
        texts = [numbers.law(above)[0] for above in range(len(self.walls))]
        # of all models; this one has the first rows
        self.sizes, self.flats, self.rhos = laid_out(numbers, allowance, flows, rows)
        self.flat, self.rho = self.flats[0], self.rhos[0]
        flats, rhos = np.split(self.flat, len(self.walls)), np.split(self.rho, len(self.walls))
        self.emitted = [Emitted(item.source if item else "", text) for item, text in zip(flows, texts, strict=True)]
        self.machine: Machine = machine_of(Emitted(steps=not self.linear))
        self.main = self.machine.emitted.entries[0]
        self.recurrences = [
            Called(machine_of(Emitted(item.flow)), numbers)
            for item, numbers in zip(self.emitted, flats, strict=True)
            if item.flow
        ]
        self.laws = [
            Called(machine_of(Emitted(rho=text)), numbers) for text, numbers in zip(texts, rhos, strict=True) if text
        ]
        self._sizes, self._flat_address = self.sizes.tolist(), address_of(self.flat)
        self._room = layout.scratch_length(self.sizes)
        # r of the lower wall and of the upper one
        self.rates = tuple(float(numbers[0]) if self.constant_restitution else np.nan for numbers in rhos)
        self.r = self.rates[0]
        self.price = LIMITS.interpreted_linear if self.linear else LIMITS.interpreted_taylor
        # launch times beyond are reduced by exact arithmetic first
        self.nearest = late(osc)
        self._spare: list[tuple[Array, int]] = []
        self._prepared: set[str] = set()
        self._bound: dict[int, Bound] = {}
        self._interpreter: Interpreter | None = None
        # seconds of a state by kind of work, as last measured; before that, and at least, with many steps allowed
        self._seconds: dict[int, float] = {}
        steps = 0.0 if self.linear else max(allowance.steps / LIMITS.steps - 1, 0.0)
        self._guess = 1e-6 if self.linear else 3e-4 * (1 + steps)
        self._least = 3e-4 * steps

    # ---- preparation

    def _entry(self, name: str) -> Callable[..., int] | None:
        """A compiled entry, with the tables that it needs filled."""
        found = self.machine.entry(name)
        return None if found is None else self._ready(name, found[0])

    def _here(self, name: str, laws: Sequence[Called] = ()) -> Callable[..., int]:
        """An entry compiled now, and what it calls, for what Python's numbers refuse or what takes too long."""
        if not compilable():
            raise InputError("the flight leaves the range of Python's numbers: install numba, which compiles flights")
        entry = self.machine.compile_here(name)[0]
        for text in (*self.recurrences, *laws):
            text.compile_here()
        return self._ready(name, entry)

    def _ready(self, name: str, entry: Callable[..., int]) -> Callable[..., int]:
        kind = PREPARATIONS.get(name)
        if kind is not None and name not in self._prepared:
            # in a copy, for other threads fly through the tables meanwhile, or fill others
            before = self.flat.copy()
            filled = before.copy()
            self._call(entry, (kind, 0, 0), flat=filled)
            changed = filled != before
            self.flat[changed] = filled[changed]
            self._prepared.add(name)
        return entry

    def _call(
        self, entry: Callable[..., int], job: tuple[int, int, int], arrays: tuple[Array, ...] = (),
        out: Array | None = None, status: Array | None = None, flat: Array | None = None, trace: Array | None = None,
    ) -> int:  # fmt: skip
        """One call of an entry.

        Parameters
        ----------
        job : its kind, the states, and impacts or rows of a trace. trace : scratch with room for such rows.
        """
        units = max(job[1], 1) * (max(job[2], 1) if job[0] == entries.ITERATE else 1)
        sizes = _SIZES(*self._sizes)
        sizes[layout.KIND], sizes[layout.COUNT], sizes[layout.IMPACTS] = job
        addresses = [address_of(array) for array in arrays] + [_NOWHERE] * (3 - len(arrays))
        addresses += [_NOWHERE if array is None else address_of(array) for array in (out, status)]
        model = self._flat_address if flat is None else address_of(flat)
        if trace is not None:
            return self._timed(
                entry, (sizes, model, address_of(trace), *addresses), units, (trace, arrays, out, status)
            )
        # scratch is lent to one call at a time, so that threads do not meet in it; an interrupted call keeps it
        try:
            scratch, at = self._spare.pop()
        except IndexError:
            scratch = self._new_scratch()
            at = address_of(scratch)
        result = self._timed(entry, (sizes, model, at, *addresses), units, (scratch, arrays, out, status, flat))
        self._spare.append((scratch, at))
        return result

    def _timed(self, entry: Callable[..., int], arguments: tuple[Any, ...], units: int, kept: tuple[Any, ...]) -> int:
        """A call of an entry; one that is expected to be long hears Ctrl-C."""
        kind, begun = arguments[0][layout.KIND], perf_counter()
        # an interrupted call goes on with the numbers of this model, whoever has let go of it
        found = interruptible(entry, arguments, (self, kept)) if self._is_long(kind, units) else entry(*arguments)
        self._measure(kind, units, begun)
        return found

    def _is_long(self, kind: int, units: int) -> bool:
        return self._seconds.get(kind, self._guess) * units > LONG

    def _measure(self, kind: int, units: int, begun: float) -> None:
        least = 0.9 * self._seconds[kind] if kind in self._seconds else self._least
        self._seconds[kind] = max((perf_counter() - begun) / units, least)

    def _compiled(self, name: str, seconds: float, laws: Sequence[Called] = ()) -> Callable[..., int] | None:
        """An entry for work that takes so long when it is interpreted; None: interpret it.

        Parameters
        ----------
        laws : what the work calls beside.
        """
        entry = self._entry(name)
        if entry is None:
            self.machine.interpreted(seconds, name)
            entry = self._entry(name)
        missing = [text for text in (*self.recurrences, *laws) if not text.is_bound(seconds)]
        return None if missing else entry

    def _unless_done(self, name: str, seconds: float, work: Callable[[], None]) -> Callable[..., int] | None:
        """The entry for work; None where it is not compiled and `work` has done it in Python's numbers."""
        entry = self._compiled(name, seconds)
        if entry is None:
            try:
                work()
            except LEFT_OPEN:
                return self._here(name)
        return entry

    def _work(self, kind: int, states: tuple[Array, ...], *results: Array) -> None:
        """Work on flights, one a state; interpreted until it is compiled, unless Python's numbers refuse it."""
        name, count = self._named(kind), states[0].size
        price = self.price * (1 if self.linear or kind != entries.VARIATIONS else LIMITS.varied)
        entry = self._unless_done(name, price * count, lambda: INTERPRETED[kind](self.interpreter, *states, *results))
        if entry is not None:
            self._call(entry, (kind, count, 0), states, *results)

    def _named(self, kind: int) -> str:
        """The entry that does a kind of work on one flight after the other."""
        return self.main if self.linear or kind == entries.HITS else "judge_entry"

    @kept_property
    def sometimes_kept(self) -> bool:
        """Whether some launches of a Taylor flow are proved not to return before they are flown."""
        from singimpact.flights.no_return.barrier import bounds_of, fastest_kept

        # of a mass between two walls the other wall may stop it
        one_wall = not self.linear and len(self.walls) == 1
        return one_wall and (bounds_of(self.osc) is not None or fastest_kept(self.osc) > 0)

    @property
    def interpreter(self) -> Interpreter:
        """The model over lists of floats."""
        if self._interpreter is None:
            self._interpreter = Interpreter(self.emitted, np.split(self.flat, len(self.walls)), self.sizes)
        return self._interpreter

    def forget_lists(self) -> None:
        """Numbers of `flat` were changed: the lists that interpreted flights read are made again."""
        self._interpreter = None

    def _new_scratch(self, trace: int = 0) -> Array:
        return np.zeros(self._room + 4 * trace)

    # ---- work

    def near(self, tau: Array) -> Array:
        """Launch times within the reach of the reduction in kernels; farther ones are reduced exactly."""
        period = self.osc.period
        if period is None or not tau.size or np.maximum.reduce(np.abs(tau)) < self.nearest:
            return tau
        return np.where(np.abs(tau) < self.nearest, tau, reduced(tau, period))

    def hits(self, tau: Array, v: Array, pushes: Array | None = None) -> tuple[Array, Array]:
        """Codes and columns of hits, shape (10, n), of many states.

        Parameters
        ----------
        pushes : a_c at the launches of a Taylor flow, nan where it is not known.
        """
        count_flights(int(np.count_nonzero(v)))
        return self._searched(entries.HITS, tau, v, pushes)

    def drops(self, tau: Array, v: Array, heights: Array) -> tuple[Array, Array]:
        """`hits` of starts off the wall, with v of either sign.

        Parameters
        ----------
        heights : x - c > 0 at the starts.
        """
        count_flights(tau.size)
        return self._searched(entries.DROPS, tau, v, heights)

    def _searched(self, kind: int, tau: Array, v: Array, quantities: Array | None) -> tuple[Array, Array]:
        """`hits` or `drops`."""
        if 0 < tau.size <= FEW and (results := self._hits_of_few(kind, tau, v, quantities)) is not None:
            return results
        status, out = np.empty(tau.size, np.int8), np.empty((10, tau.size))
        states: tuple[Array, ...] = (tau, v) if quantities is None else (tau, v, quantities)
        if not self.linear:
            out[4:] = np.nan
            states = (tau, v, np.full(tau.size, np.nan)) if quantities is None else states
        name, least, begin = self._named(kind), 1, 0
        if self.linear and tau.size >= LANES:
            name, least = "batch_entry", LANES
        while begin < tau.size:
            entry = self._compiled(name, self.price * (tau.size - begin))
            if entry is None:
                end = min(begin + TABLES.interpreted, tau.size)
                self._interpreted_hits(kind, states, (out, status), slice(begin, end))
            else:
                end = min(begin + TABLES.block * threads_now(), tau.size)
                fly = partial(self._compiled_hits, (entry, kind), states, (out, status), least)
                shared_out(fly, begin, end, TABLES.shared)
            begin = end
        return self._at_walls(status, out)

    def _hits_of_few(self, kind: int, tau: Array, v: Array, quantities: Array | None) -> tuple[Array, Array] | None:
        """`_searched` of few states; None for long flights, which hear an interruption, and until they are compiled."""
        is_long, begun = self._is_long(kind, tau.size), perf_counter()
        bound = None if is_long else self._bound.pop(kind, None) or self._for_few(kind)
        if bound is None:
            return None
        codes, rows = bound.few(tau, v, np.nan if quantities is None else quantities)
        self._bound[kind] = bound
        self._measure(kind, tau.size, begun)
        rows[4 if not self.linear else 10 :] = np.nan
        return self._at_walls(codes, rows)

    def _at_walls(self, codes: Array, rows: Array) -> tuple[Array, Array]:
        """Codes and columns of hits; those of the other wall count as hits, with x' > 0."""
        if len(self.walls) == 2:
            across = np.flatnonzero((codes == ACROSS) | (codes == ACROSS + NOT_REFINED))
            codes[across] -= ACROSS
            for column in (VELOCITY, VELOCITY_BY_TAU, VELOCITY_BY_V):  # rows of flights that did not end are not filled
                rows[column, across] *= -1.0
        return codes, rows

    def _compiled_hits(
        self, work: Work, states: tuple[Array, ...], results: tuple[Array, Array], least: int, chosen: slice
    ) -> None:
        (entry, kind), (out, status) = work, results
        if chosen.start == 0 and chosen.stop == status.size:
            self._call(entry, (kind, status.size, 0), states, out, status)
            return
        # a batch is full: the last one flies some states again
        chosen = slice(min(chosen.start, chosen.stop - least), chosen.stop)
        rows = out[:, chosen].copy()
        self._call(entry, (kind, rows.shape[1], 0), tuple(row[chosen] for row in states), rows, status[chosen])
        out[:, chosen] = rows

    def _interpreted_hits(
        self, kind: int, states: tuple[Array, ...], results: tuple[Array, Array], chosen: slice
    ) -> None:
        out, status = results
        rows = np.empty((10, chosen.stop - chosen.start))
        try:
            parts = tuple(column[chosen] for column in states)
            self.interpreter.hits(parts, kind == entries.DROPS, rows, status[chosen])
            out[:, chosen] = rows
        except LEFT_OPEN:
            if rows.shape[1] == 1:
                self._compiled_hits((self._here(self._named(kind)), kind), states, results, 1, chosen)
                return
            for index in range(chosen.start, chosen.stop):
                self._interpreted_hits(kind, states, results, slice(index, index + 1))

    def one(self, kind: int, tau: float, v: float, *quantities: float) -> tuple[int, list[float]]:
        """Code and results of one flight, v > 0, by the compiled entry with the least overhead.

        Parameters
        ----------
        kind : HITS, DROPS (the columns of a hit) or VARIATIONS. quantities : as for the method of that name; of hits of
            a Taylor flow, a_c at the launch where it is known.
        """
        bound = self._bound.pop(kind, None) or self._for_few(kind)
        if bound is not None:
            code, columns = bound.one(tau, v, *quantities)
            self._bound[kind] = bound
            if kind in SEARCHES:
                count_flights(1)
            if code >= ACROSS and code - ACROSS in (0, NOT_REFINED):
                for column in (VELOCITY, VELOCITY_BY_TAU, VELOCITY_BY_V):
                    columns[column] = -columns[column]
                code -= ACROSS
            return code, columns
        work: Any = {entries.HITS: self.hits, entries.DROPS: self.drops}
        outcome = work.get(kind, self.variations)(*(np.array([number]) for number in (tau, v, *quantities)))
        codes, rows = outcome if kind in SEARCHES else (np.zeros(1, np.int8), outcome)
        return int(codes[0]), rows.ravel().tolist()

    def _for_few(self, kind: int) -> Bound | None:
        """A compiled entry over memory of its own."""
        name = self._named(kind)
        entry = self.machine.entry(name)
        if entry is None or not all(text.is_bound() for text in self.recurrences):
            return None
        self._ready(name, entry[0])
        return Bound(entry[1], kind, (self.sizes, self.flat, self._new_scratch()))

    def releases(self, tau: Array, removed: Array) -> tuple[Array, Array]:
        """Codes and flight time, velocity, depth and bound, shape (10, n), of masses released at rest."""
        count_flights(tau.size)
        status, out, orders = np.empty(tau.size, np.int8), np.full((10, tau.size), np.nan), removed.astype(float)
        self._work(entries.RELEASES, (tau, tau, orders), out, status)
        return self._at_walls(status, out)

    def segment(self, tau: float, v: float, count: int, near: float = 0.0) -> tuple[Array, int]:
        """Rows of the impacts of one orbit, see `kernels.orbits`, and the code of the flight that ended it.

        Of impacts at the other wall x' > 0.
        """
        out, status = np.empty((count, 12)), np.zeros(1, np.int8)
        entry = self._compiled(self.main, self.price * count, self.laws)
        if entry is None:
            try:
                flown, code = self.interpreter.segment(tau, v, near, self.rho, out)
                count_flights(flown)
                return self._rows_at_walls(out[:flown]), code
            except LEFT_OPEN:
                entry = self._here(self.main, self.laws)
        states = np.array([tau]), np.array([v]), np.concatenate([[near], self.rho])
        flown = self._call(entry, (entries.SEGMENT, count, 0), states, out, status)
        count_flights(flown)
        return self._rows_at_walls(out[:flown]), int(status[0])

    def _rows_at_walls(self, rows: Array) -> Array:
        """Rows of a segment, with x' > 0 at the other wall."""
        if len(self.walls) == 2:
            rows[np.ix_(rows[:, 11] == 1, [3, 9, 10])] *= -1
        return rows

    def iterate(self, tau: Array, v: Array, impacts: int) -> tuple[Array, Array, Array, Array]:
        """The last states of orbits of so many impacts, the code of the flight that ended an orbit before, and 1 where
        the last state is one of the other wall, else 0.
        """
        if self.linear and tau.size <= TABLES.alone and impacts <= TABLES.block:
            return self._iterate_alone(tau, v, impacts)
        # linear models fly whole batches of states
        name, lanes, least = ("batch_entry", LANES, TABLES.batched) if self.linear else (self.main, 1, TABLES.shared)
        size = -(-tau.size // lanes) * lanes
        times, speeds, sides = np.resize(tau, size), np.resize(v, size), np.zeros(size)
        status = np.where(speeds > 0, 0, AT_REST).astype(np.int8)
        status[tau.size :] = AT_REST
        entry, begin = self._compiled(name, 0.0, self.laws), 0
        while begin < size:
            few = slice(begin, min(begin + LANES, size))
            if entry is None:
                entry = self._compiled(name, self.price * (few.stop - begin) * impacts, self.laws)
            if entry is None:
                self.interpreter.iterate(times[few], speeds[few], impacts, self.rho, sides[few], status[few])
                begin = few.stop
                continue

            def fly(part: slice, entry: Callable[..., int] = entry) -> None:
                """Orbits of so many times `lanes` states."""
                chosen = slice(part.start * lanes, part.stop * lanes)
                states, codes = (times[chosen], speeds[chosen], self.rho), status[chosen]
                self._call(entry, (entries.ITERATE, codes.size, impacts), states, sides[chosen], codes)

            block = max(LANES, TABLES.block // max(impacts, 1) // LANES * LANES)
            end = min(begin + block * threads_now(), size)
            shared_out(fly, begin // lanes, end // lanes, max(1, least // max(impacts, 1) // lanes))
            begin = end
        return times[: tau.size], speeds[: tau.size], status[: tau.size], sides[: tau.size]

    def _iterate_alone(self, tau: Array, v: Array, impacts: int) -> tuple[Array, Array, Array, Array]:
        """`iterate` of each orbit as a segment."""
        times, speeds, codes = tau.copy(), v.copy(), np.where(v > 0, 0, AT_REST).astype(np.int8)
        sides = np.zeros(tau.size)
        for index in np.flatnonzero(codes == 0).tolist():
            rows, codes[index] = self.segment(times[index], speeds[index], impacts)
            if len(rows):
                times[index], speeds[index], sides[index] = times[index] + rows[-1, 0], *rows[-1, [1, 11]]
        return times, speeds, codes, sides

    def brackets(self, tau: Array, velocities: Array, settings: tuple[float, ...]) -> tuple[Array, Array] | None:
        """Brackets of gamma, shape (n, 2), and codes; None where no compiled entry of a linear model is there.

        Parameters
        ----------
        velocities : velocities below and above gamma, and times to its end, shape (n, 3). settings : see
            `kernels.gamma.bracket_gamma`.
        """
        entry = self._search(0.05 * tau.size)
        if entry is None:
            return None
        out, status = np.empty((tau.size, 2)), np.empty(tau.size, np.int8)
        numbers = np.concatenate([settings, self.rho])
        rows = np.ascontiguousarray(velocities, dtype=float)
        self._call(entry, (entries.BRACKET, tau.size, 0), (tau, rows, numbers), out, status)
        return out, status

    def _search(self, seconds: float) -> Callable[..., int] | None:
        """The entry of searches along orbits; None where it is not compiled."""
        one_wall = self.linear and len(self.walls) == 1
        if not one_wall or self._compiled(self.main, seconds, self.laws) is None:
            return None
        return self._compiled("search_entry", 0.0, self.laws)

    def limits(self, tau: Array, v: Array, settings: tuple[float, float, float]) -> tuple[Array, Array] | None:
        """Codes of chatters, and end, error and impacts, shape (3, n); None where no compiled entry flies them.

        Parameters
        ----------
        tau, v : states, v > 0. settings : see `kernels.chatter.chatter_end`.
        """
        entry = self._search(0.0) if self.constant_restitution else None
        if entry is None:
            return None
        out, status = np.empty((3, tau.size)), np.empty(tau.size, np.int8)
        numbers, begin, many = np.concatenate([settings, self.rho]), 0, 4
        scratch, room = self._new_scratch(3 * TABLES.chatter[0] // 2), TABLES.chatter[0]
        while begin < tau.size:
            chosen = slice(begin, begin + many)
            rows, codes = np.empty((3, tau[chosen].size)), status[chosen]
            states = tau[chosen], v[chosen], numbers
            self._call(entry, (entries.LIMIT, codes.size, room), states, rows, codes, trace=scratch)
            for index in np.flatnonzero(codes == NO_ROOM).tolist():
                one, last = slice(begin + index, begin + index + 1), TABLES.chatter[1]
                end = np.empty((3, 1))
                states = tau[one], v[one], numbers
                more = self._new_scratch(3 * last // 2)
                self._call(entry, (entries.LIMIT, 1, last), states, end, codes[index : index + 1], trace=more)
                rows[:, index : index + 1] = end
            out[:, chosen] = rows
            begin += codes.size
            flown = int(rows[2].sum())
            count_flights(flown)
            many = max(1, min(TABLES.block, 4 * many, TABLES.block * codes.size // max(flown, 1)))
        return status, out

    def variations(self, tau: Array, v: Array, times: Array) -> Array:
        """dx/dv, dx'/dv, dx/dtau, dx'/dtau at given flight times, shape (n, 4)."""
        out = np.empty((tau.size, 4))
        self._work(entries.VARIATIONS, (tau, v, times), out)
        return out

    def places(self, tau: Array, v: Array, times: Array, heights: Array | float = 0.0) -> Array:
        """x - c and x' of flights of a linear model, each at its own time of either sign, shape (n, 2).

        Parameters
        ----------
        heights : x - c at the launches.
        """
        columns = np.stack([times, np.broadcast_to(heights, times.shape)], axis=1)
        tau, v = (np.ascontiguousarray(column, dtype=float) for column in (tau, v))
        out = np.empty((tau.size, 2))
        self._work(entries.PLACES, (tau, v, columns), out)
        return out

    def follow(self, tau: float, v: float, times: Array, height: float = 0.0) -> Array:
        """x - c and x' at times that run away from 0 in one direction, shape (n, 2); for Taylor flows.

        Parameters
        ----------
        height : x - c at the launch.
        """
        return self.follow_all(np.array([tau]), np.array([v]), np.array([times.size]), times, height)

    def follow_all(self, tau: Array, v: Array, counts: Array, times: Array, height: Array | float = 0.0) -> Array:
        """`follow` of many flights, one after the other: counts[i] of the times are those of flight i."""
        out, states = np.full((times.size, 2), np.nan), np.stack([tau, v, np.full(tau.size, height)], axis=1)
        if times.size:
            entry = self._unless_done(
                "judge_entry", self.price * tau.size, lambda: self.interpreter.follow(states, counts, times, out)
            )
            if entry is not None:
                arrays = states, states[0, 1:], times
                self._call(one_by_one(entry, counts.tolist()), (entries.FOLLOW, tau.size, 0), arrays, out)
        return out

    def judged(self, tau: Array, v: Array, removed: Array) -> Array:
        """Columns of hits of a Taylor flow with conditions and errors, and its steps, shape (11, n)."""
        orders = removed.astype(float)
        out = self._judged(tau, v, orders, LIMITS.traced)
        for index in np.flatnonzero(np.isnan(out[0])).tolist():
            one = slice(index, index + 1)
            out[:, one] = self._judged(tau[one], v[one], orders[one], self.allowance.steps + 1)
        return out

    def _judged(self, tau: Array, v: Array, removed: Array, room: int) -> Array:
        out = np.empty((11, tau.size))
        entry = self._unless_done(
            "judge_entry",
            self.price * LIMITS.varied * tau.size,
            lambda: self.interpreter.judged(tau, v, removed, out, room),
        )
        if entry is not None:
            job = entries.JUDGE, tau.size, room
            self._call(entry, job, (tau, v, removed), out, trace=self._new_scratch(room))
        return out


_SIZES = ctypes.c_int64 * 8


def address_of(array: Array) -> int:
    """Where the numbers of a contiguous array lie; `array.ctypes` takes four times as long."""
    return int(array.__array_interface__["data"][0])


_NONE = np.zeros(16)
_NOWHERE = address_of(_NONE)
