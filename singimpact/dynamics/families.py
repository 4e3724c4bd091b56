"""`osc.over(...)`: models that differ in numbers, as one thing that is flown in compiled loops."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial, reduce
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array, as_float, float_array
from singimpact.dynamics.lives import KINDS, RELEASE, SETTINGS as LIFE, START, Lives, Pressure
from singimpact.dynamics.orbit import Orbit, recorded
from singimpact.flights.flat_numbers import EPSILON
from singimpact.flights.impact_map import impact_map
from singimpact.flights.members import SETTINGS, Members
from singimpact.flights.orbits import SLOW, Ends, iterate
from singimpact.flights.results import JUDGED, Step
from singimpact.flights.states import States
from singimpact.flights.walls import at_walls, wall_codes
from singimpact.handed_on import Study
from singimpact.inputs import InputError, checked_methods, need, refuse, require, require_memory, whole
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.moving_number import CLEARANCE, RESTITUTION, UPPER, with_number
from singimpact.result import Result, in_words
from singimpact.status import Status, status_array

# Of a member's numbers and results, beside the tables of those that fly
BYTES = 64


@partial(checked_methods, two_walls=True)
class OscillatorFamily:
    """Models that differ in numbers alone: `osc.over(omega=array, restitution=array)`.

    Parameters
    ----------
    osc : the model. numbers : arrays by the names of its numbers, which broadcast to `shape`.

    Examples
    --------
    >>> import singimpact as si
    >>> many = si.linear(2, 0, "1/2").over(omega=[2, 3.1, 4])
    >>> many, many.impact_map(0.0, 1.0).tau.round(6).tolist()
    (OscillatorFamily(3 models of x'' + x = cos(omega*t): omega), [2.645848, 3.136466, 3.016613])
    >>> many[2]
    ImpactOscillator(f='x', g='cos(omega*t)', clearance='0', restitution='0.5', parameters={'omega': '4'})
    """

    def __init__(self, osc: Oscillator, numbers: Mapping[str, Any]) -> None:
        need(numbers, InputError("over() names no number of the model: give arrays by name, over(omega=[2, 3])"))
        osc = reduce(with_number, numbers, osc)
        arrays = {name: float_array(name, values) for name, values in numbers.items()}
        try:
            every = np.broadcast_arrays(*arrays.values())
        except ValueError:
            shapes = ", ".join(f"{name} {array.shape}" for name, array in arrays.items())
            raise InputError(f"the numbers have shapes {shapes}: give arrays that broadcast") from None
        self.shape = every[0].shape
        require_memory("members", self.shape, BYTES)
        self.numbers = dict(zip(arrays, every, strict=True))
        self.flat = {name: np.ascontiguousarray(values.ravel()) for name, values in self.numbers.items()}
        self._check(osc)
        self.osc = osc.replace(**{name: float(values[0]) for name, values in self.flat.items()}) if self.size else osc

    def _check(self, osc: Oscillator) -> None:
        for name in (RESTITUTION, UPPER[1]):
            wrong = [r for r in self.flat.get(name, np.ones(1)).tolist() if not 0 < r <= 1]
            if wrong:
                raise refuse(name, wrong[0], "numbers above 0, at most 1")
        if osc.upper is not None:
            low, high = (
                self.flat.get(name, np.array([as_float(getattr(osc, name))])) for name in (CLEARANCE, UPPER[0])
            )
            wrong = np.flatnonzero(~np.less(low, high)).tolist()
            if wrong:
                raise refuse(UPPER[0], float(np.broadcast_to(high, self.size)[wrong[0]]), "numbers above the clearance")

    @property
    def size(self) -> int:
        """The number of models."""
        return next(iter(self.flat.values())).size

    def __len__(self) -> int:
        return self.shape[0] if self.shape else 1

    def __getitem__(self, index: Any) -> Any:
        """A model, or a family of fewer."""
        some = {name: values[index] for name, values in self.numbers.items()}
        if all(np.ndim(value) == 0 for value in some.values()):
            return self.osc.replace(**{name: float(value) for name, value in some.items()})
        return OscillatorFamily(self.osc, some)

    def __iter__(self) -> Iterator[Oscillator]:
        return map(self.member, range(self.size))

    def member(self, index: int) -> Oscillator:
        """One of the models, counted along all axes."""
        return self.osc.replace(**{name: float(values[index]) for name, values in self.flat.items()})

    def __repr__(self) -> str:
        f, g = self.osc.f, self.osc.g
        return f"OscillatorFamily({self.size} models of x'' + {f} = {g}: {', '.join(self.numbers)})"

    periodic = Study()  # a function of `singimpact`, documented there

    # ---- flights

    def impact_map(self, tau: object, v: object, wall: object = None) -> Step:
        """The impact map of every model.

        Parameters
        ----------
        tau, v : states, which broadcast with the members. wall : of the states, of models with two walls.

        Returns
        -------
        Step : `.tau`, `.v`, `.flight_time`, `.velocity`, `.status`, as of one model.

        Examples
        --------
        >>> import singimpact as si
        >>> many = si.linear(2, 0, "1/2").over(restitution=[0.2, 0.4])
        >>> many.impact_map(0.0, [[1.0], [2.0]]).v.shape
        (2, 2)
        """
        columns = in_parts(self, (tau, v, wall), _stepped)
        time, velocity, after, ends, codes, cause, walls, *errors = columns
        nothing = np.nan * np.asarray(time)
        fields = {"depth": nothing, "bound": nothing, "cause": cause, "status": status_array(codes)}
        fields |= {"wall": walls} if self.osc.upper is not None else {}
        fields |= {"flight_time": time, "velocity": velocity, "v": after, "tau": ends}
        if errors:
            return Step.made(None, **fields, **dict(zip(JUDGED, errors, strict=True)))
        judged = partial(in_parts, self, (tau, v, wall), partial(_stepped, alone=True))
        return Step.made(lambda _name: dict(zip(JUDGED, judged()[-len(JUDGED) :], strict=True)), **fields)

    def iterate(self, tau: object, v: object, impacts: int = 100, wall: object = None) -> Ends:
        """Many impacts of every model; the last states, as of one model.

        Parameters
        ----------
        tau, v : states, which broadcast with the members. impacts : for each. wall : as for `impact_map`.

        Examples
        --------
        >>> import singimpact as si
        >>> ends = si.linear(2, 0, "1/2").over(omega=[2, 3.1, 4]).iterate(0.0, 1.0, 50)
        >>> ends.tau.shape, ends.status.tolist()
        ((3,), [0, 0, 0])
        """
        count = whole("impacts", impacts, 0, 10**7)
        columns = in_parts(self, (tau, v, wall), lambda *states: _iterated(count, *states))
        ends, speeds, codes, walls = columns
        return Ends(ends, speeds, status_array(codes), walls if self.osc.upper is not None else None)

    def orbit(self, tau: object, v: object, impacts: int = 200, wall: object = None) -> "Orbits":
        """The orbit of every model: impacts, complete chatter, rest and lift-off in order.

        Parameters
        ----------
        tau, v : states, which broadcast with the members. impacts : flights of each, of which a chatter that is summed
            up is one. wall : as for `impact_map`.

        Returns
        -------
        Orbits : arrays of events; `orbits[index]` is one of the orbits.

        Examples
        --------
        >>> import singimpact as si
        >>> orbits = si.linear(2, 0, "1/2").over(omega=[2, 3.1, 4]).orbit(0.0, 1.0, 50)
        >>> orbits.tau.shape, round(float(orbits[1].sample(1.0).x), 6)
        ((3, 51), 1.020267)
        """
        events, status = in_parts(self, (tau, v, wall), partial(_events, whole("impacts", impacts, 0, 10**7)))
        shape, member = np.shape(status), beside_members(self, (tau, v, wall))[2]
        tables = list(events.flat) if shape else [events]
        columns = np.full((4, member.size, max(map(len, tables), default=1)), np.nan)
        for column, rows in zip(columns.transpose(1, 0, 2), tables, strict=True):
            column[:, : len(rows)] = rows.T
        times, speeds, kinds, walls = columns.reshape(4, *shape, columns.shape[-1])
        return Orbits(
            self.osc,
            member.reshape(shape),
            {name: values[member].reshape(shape) for name, values in self.flat.items()},
            times,
            speeds,
            np.append(KINDS, "")[np.nan_to_num(kinds, nan=-1).astype(int)],
            status_array(status),
            None if self.osc.upper is None else np.nan_to_num(walls).astype(np.int8),
        )


@dataclass(frozen=True, eq=False)
class Orbits(Result):
    """Orbits of models of a family: `orbits[index]` is one of them, with `.phases` and `.sample(t)`.

    Parameters
    ----------
    model : the first of the models. member : that of each orbit, counted along all axes of the family.
    numbers : name -> the number of the model of each orbit.
    tau, v, kind, wall : of the events of `Orbit`, along the last axis; nan and "" after the last one.
    status : 0, or why an orbit ended before all impacts asked for.
    """

    heads_csv = True
    model: Oscillator
    member: Array
    numbers: dict[str, Array]
    tau: Array
    v: Array
    kind: Array
    status: Any
    wall: Array | None = None

    __repr__ = in_words

    def __getitem__(self, index: int | tuple[int, ...]) -> Orbit:
        """The orbit at a place of the arrays."""
        kinds = self.kind[index]
        require(kinds.ndim == 1, "index", index, f"one place in {self.member.shape}")
        some = slice(np.count_nonzero(kinds))
        walls = np.zeros(kinds.size, np.int8) if self.wall is None else self.wall[index]
        events = (self.tau[index][some], self.v[index][some], kinds[some], walls[some])
        model = self.model.replace(**{name: float(values[index]) for name, values in self.numbers.items()})
        return recorded(model, events, int(self.status[index]))

    def as_dict(self) -> dict[str, Any]:
        """Member, numbers of the model, events and status of each orbit."""
        values = super().as_dict()
        return self.numbers | {name: value for name, value in values.items() if name != "numbers"}


def beside_members(
    osc: Oscillator | OscillatorFamily, states: tuple[Any, ...]
) -> tuple[Oscillator, Mapping[str, Array], Array, list[Array], tuple[int, ...]]:
    """A model, its numbers along the members, and of each state the member, tau, v and wall; the shape of all.

    Parameters
    ----------
    states : tau, v and walls, which broadcast with the members.
    """
    model, flat, members = (osc.osc, osc.flat, osc.shape) if isinstance(osc, OscillatorFamily) else (osc, {}, ())
    read, codes = States.read(*states[:2]), wall_codes(model, states[2])
    try:
        shape = np.broadcast_shapes(read.shape, members, codes.shape)
    except ValueError:
        raise InputError(
            f"states of shape {read.shape} and members of shape {members} do not broadcast: give shapes that do"
        ) from None
    every = np.arange(int(np.prod(members))).reshape(members)
    which, *columns = (
        np.broadcast_to(np.reshape(column, own), shape).ravel()
        for column, own in ((every, members), (read.tau, read.shape), (read.v, read.shape), (codes, codes.shape))
    )
    return model, flat, which, columns, shape


def in_parts(
    osc: Oscillator | OscillatorFamily, states: tuple[Any, ...], work: Callable[..., tuple[Array, ...]]
) -> tuple[Array, ...]:
    """Results of states of a model, or each of its own model, put together from those of some models at a time.

    Parameters
    ----------
    states : tau, v and walls, which broadcast with the members. work : of members, the model of each state, tau, v
        and walls; it returns arrays along the states.
    """
    model, flat, which, columns, shape = beside_members(osc, states)
    size = osc.size if isinstance(osc, OscillatorFamily) and which.size else 1
    order = np.argsort(which, kind="stable")
    ends = np.searchsorted(which[order], np.arange(0, size + SETTINGS.held, SETTINGS.held))
    result: list[Array] = []
    for piece, (begin, end) in enumerate(zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True)):
        at, first = order[begin:end], piece * SETTINGS.held
        some = {name: values[first : first + SETTINGS.held] for name, values in flat.items() if which.size}
        results = work(Members(model, some), which[at] - first, *(column[at] for column in columns))
        result = result or [np.empty((which.size, *item.shape[1:]), item.dtype) for item in results]
        for array, values in zip(result, results, strict=True):
            array[at] = values
    return tuple(array.reshape((*shape, *array.shape[1:]))[()] for array in result)


def _stepped(
    members: Members, which: Array, tau: Array, v: Array, walls: Array, alone: bool = False
) -> tuple[Array, ...]:
    """The impact map of states, one a model or more; what is no plain hit, or all, is flown by its model alone."""
    lower = (walls == 0) & members.near(which, tau) & (v > 0) & (not alone)
    codes, columns = members.hits(which, tau, np.where(lower, v, 0.0))
    columns = columns.copy()
    plain = (codes == 0) & lower & members.model.constant_restitution
    velocity = columns[1]
    above = velocity > 0
    rates = [law[which, 0] for law in np.split(members.laws, len(members.model.walls), axis=1)]
    after = np.abs(velocity) * np.where(above, rates[-1], rates[0])
    later, time = tau + columns[0], columns[0]
    status, cause, landed = np.zeros(tau.size, np.int8), np.zeros(tau.size, np.int8), above.astype(np.int8)
    errors = columns[2:6] if members.linear or alone else columns[:0]
    for i in np.flatnonzero(~plain).tolist():
        one = members.member(int(which[i]))
        step = at_walls(impact_map, one, int(walls[i]), (float(tau[i]), float(v[i])))
        time[i], velocity[i], after[i], later[i] = step.flight_time, step.velocity, step.v, step.tau
        status[i], cause[i], landed[i] = step.status, step.cause, step.wall or 0
        errors[:, i] = [getattr(step, name) for name in JUDGED[: len(errors)]]
    return time, velocity, after, later, status, cause, landed, *errors


def _iterated(impacts: int, members: Members, which: Array, tau: Array, v: Array, walls: Array) -> tuple[Array, ...]:
    """The last states of orbits; what ends early is flown by its model alone."""
    ends, speeds, codes, sides = tau.copy(), v.copy(), np.zeros(tau.size, np.int8), walls.astype(np.int8)
    alone = np.flatnonzero(~members.near(which, tau) | (v == 0))
    going, left = np.flatnonzero(members.near(which, tau) & (v > 0)), impacts
    while left and going.size:
        count = min(left, 1024)
        rows, _, ended = members.segments(
            which[going], (ends[going], speeds[going], sides[going]), np.full(going.size, count)
        )
        alone = np.concatenate([alone, going[ended != 0]])
        going, rows = going[ended == 0], rows[ended == 0]
        last = rows[:, -1]
        ends[going], speeds[going] = ends[going] + last[:, 0], last[:, 1]
        sides[going] ^= last[:, 11].astype(np.int8)
        left -= count
    slow = np.flatnonzero((speeds < SLOW) & (v > 0))
    for above in (0, 1) if members.two_walls else (0,):
        at = slow[sides[slow] == above]
        push, r = Pressure(members, bool(above)).push(which[at], ends[at]), members.numbers.slope(above)[which[at]]
        over = at[(push < 0) & (2 * speeds[at] <= EPSILON / 4 * np.abs(ends[at] * push) * (1 - r))]
        codes[over], speeds[over] = Status.complete, 0.0
    for i in alone.tolist():
        one = members.member(int(which[i]))
        result = iterate(one, float(tau[i]), float(v[i]), impacts, wall=int(walls[i]))
        ends[i], speeds[i], codes[i], sides[i] = result.tau, result.v, result.status, result.wall or 0
    return ends, speeds, codes, sides


def _events(impacts: int, members: Members, which: Array, tau: Array, v: Array, walls: Array) -> tuple[Array, Array]:
    """Of each orbit the events, shape (events, 4): time, v, kind and wall; and why it ended before all impacts."""
    lives, every = Lives(members, which, tau, v, walls), np.arange(which.size)
    tables = [lives.events()]
    while (going := np.flatnonzero((lives.status == 0) & (lives.flown + lives.rests < impacts))).size:
        table = lives.events(lives.advance(np.minimum(LIFE.block, impacts - lives.flown[going]), going))
        tables.append(table[table[:, 3] != START])
    table = np.concatenate(tables)
    table = table[np.argsort(table[:, 0], kind="stable")]
    events, status = np.empty(which.size, dtype=object), lives.status.copy()
    for index, rows in enumerate(np.split(table[:, 1:], np.searchsorted(table[:, 0], every))[1:]):
        flights = np.cumsum((rows[:, 2] != START) & (rows[:, 2] != RELEASE))
        events[index] = rows[flights <= impacts]
        status[index] *= flights[-1] <= impacts
    return events, status
