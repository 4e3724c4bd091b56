"""Periodic orbits of every model of a family: in compiled loops where there is a closed form, else one by one."""

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from singimpact.algebra import Array, names_in
from singimpact.branches.periodic import SETTINGS as PERIODIC, periodic
from singimpact.branches.starts import one_impact
from singimpact.dynamics import Growth, Lives, OscillatorFamily, Stretch, in_parts
from singimpact.flights.family import LinearFamily, family
from singimpact.flights.members import Members
from singimpact.inputs import refuse, whole
from singimpact.oscillator.model import Oscillator
from singimpact.result import Result, numbered

# Distance of a flight time from k periods, beside a period, and of velocities, beside v: an orbit is closed
CLOSED = 1e-9


@dataclass(frozen=True, eq=False)
class FamilyOrbits(Result):
    """Periodic orbits of the models of a family, as a list in the order of the models.

    Attributes
    ----------
    model : the first of the models. n, k : impacts, in k periods of the forcing.
    member : index of the model of each orbit, in the flattened family, shape (m,). numbers : name -> the number of this
        model, shape (m,). tau, v : states after the impacts, from the least phase on, shape (m, n).
    multipliers : complex, the larger first, shape (m, 2).
    complete : whether the orbits of a model are shown to be all, in the shape of the family.
    """

    heads_csv = True
    model: Oscillator
    n: Any
    k: int
    member: Array
    numbers: dict[str, Array]
    tau: Array
    v: Array
    multipliers: Array
    complete: Array

    def __len__(self) -> int:
        return self.member.size

    @property
    def stable(self) -> Array:
        """Whether both multipliers are below 1 in size, shape (m,)."""
        return np.asarray((np.abs(self.multipliers) < 1).all(axis=1))

    @property
    def count(self) -> Array:
        """The number of orbits of each model, in the shape of the family."""
        return np.bincount(self.member, minlength=self.complete.size).reshape(self.complete.shape)

    def as_dict(self) -> dict[str, Any]:
        """Member, numbers of the model, stability, states and multipliers, each with a row for each orbit."""
        states = numbered("tau", self.tau) | numbered("v", self.v)
        parts = numbered("multiplier_re", self.multipliers.real) | numbered("multiplier_im", self.multipliers.imag)
        return {"member": self.member} | self.numbers | {"stable": self.stable} | states | parts

    def __repr__(self) -> str:
        shown = f"{len(self)} ({self.n}, {self.k}) orbits of {self.complete.size} models, {self.stable.sum()} stable"
        return f"FamilyOrbits({shown}; shown to be all for {np.sum(self.complete)} models)"


def orbits_of_members(osc: OscillatorFamily, n: float | str, k: int | None = None, **others: Any) -> FamilyOrbits:
    """The orbits of n impacts in k periods of every model.

    Parameters
    ----------
    n, k, others : as of `periodic`, but for digits.

    Examples
    --------
    >>> import singimpact as si
    >>> many = si.linear(4, 0, "0.5").over(restitution=[0.4, 0.5, 0.6])
    >>> found = orbits_of_members(many, 1, 2)
    >>> found.count.tolist(), found.v.ravel().round(12).tolist()
    ([1, 1, 1], [0.355555555556, 0.533333333333, 0.8])
    """
    if others.get("digits") is not None:
        raise refuse("digits", others["digits"], "none for a family; osc.over(...)[i].periodic(...) takes them")
    model, left = osc.osc, np.ones(osc.shape, bool)
    plain = model.upper is None and model.period is not None and not names_in(model.restitution)
    rows: list[tuple[int, Array, Array, Array]] = []
    if n == 1 and plain and not any(others.values()) and isinstance(family(model, tuple(osc.flat)), LinearFamily):
        table, left = in_parts(osc, (0.0, 0.0, None), partial(_closed, whole("k", k, 1, PERIODIC.most)))
        table = table.reshape(osc.size, *table.shape[-2:])
        for index, slot in np.argwhere(np.isfinite(table[..., 1]) & ~left.reshape(-1, 1)).tolist():
            rows.append((index, table[index, slot, :1].real, table[index, slot, 1:2].real, table[index, slot, 2:]))
    complete = ~left
    # a graze, or a solution that roundings leave open, is a matter of one model
    for index in np.flatnonzero(left).tolist():
        orbits = periodic(osc.member(index), n, k, **others)
        rows += [(index, orbit.tau, orbit.v, orbit.multipliers) for orbit in orbits]
        complete.flat[index] = n == 1 and orbits.complete
    rows.sort(key=lambda row: (row[0], *row[1], *row[2]))
    count = len(n) if isinstance(n, str) else int(n) if 0 < n < np.inf else 1
    member = np.array([row[0] for row in rows], int)
    numbers = {name: values[member] for name, values in osc.flat.items()}
    tau, v = (np.array([row[i] for row in rows]).reshape(-1, count) for i in (1, 2))
    multipliers = np.array([row[3] for row in rows], complex).reshape(member.size, len(rows[0][3]) if rows else 2)
    return FamilyOrbits(model, n, int(k or 0), member, numbers, tau, v, multipliers, complete)


def _closed(k: int, members: Members, which: Array, *_: Array) -> tuple[Array, Array]:
    """Phase, velocity and multipliers of each solution of one impact, nan of virtual ones; and whether that is open.

    Returns
    -------
    array : complex, shape (states, solutions, 4). array : whether there is a continuum, or a solution that the first
        hit neither closes nor comes before.
    """
    flights = family(members.osc, tuple(members.over))
    assert isinstance(flights, LinearFamily)
    tau, v, left = (
        column[which] for column in one_impact(flights, members.over, (members.period, members.numbers.slope(0)), k)
    )
    table, (one, slot) = np.full((*tau.shape, 4), np.nan, complex), np.nonzero(v > PERIODIC.least)
    at, starts = which[one], (tau[one, slot], v[one, slot])
    walls, flying = np.zeros(one.size, np.int8), np.arange(one.size)
    rows, flown, codes = members.segments(at, (*starts, walls), np.ones(one.size, int))
    if one.size:
        late, off = rows[:, 0, 0] - k * members.period[at], rows[:, 0, 1] - starts[1]
        near = CLOSED * members.period[at]
        closes = (codes == 0) & (np.abs(late) < near) & (np.abs(off) < CLOSED * starts[1])
        left[one[~closes & ~((codes == 0) & (late < -near))]] = True
        begun = starts[0], np.zeros(one.size), starts[1], walls
        stretch = Stretch(flying, rows, flown, codes == 0, begun, codes != 0, [])
        slope, area = Growth(Lives(members, at, *starts, walls)).derivatives(stretch)
        half, product = np.zeros((2, one.size))
        half[flown > 0], product[flown > 0] = (slope[0, 0] + slope[1, 1]) / 2, np.exp(area)
        root = np.sqrt((half**2 - product).astype(complex))
        first = half + np.where(half > 0, root, -root)
        with np.errstate(all="ignore"):
            columns = np.stack([*starts, first, product / first], axis=1)
        table[one[closes], slot[closes]] = columns[closes]
    return table, left
