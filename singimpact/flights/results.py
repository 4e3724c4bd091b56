"""Results of flights: frozen dataclasses of arrays, or of scalars when the state was scalar."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field, fields
from typing import Any, ClassVar, Self

import numpy as np

from singimpact.algebra.certified import Certified
from singimpact.algebra.expressions import Expression
from singimpact.oscillator.model import Oscillator
from singimpact.result import Result, in_words, plain, value_in_words
from singimpact.status import Cause, Status, Wall, status_array

# Fields that may be computed when they are first read: of a Taylor flow they take longer than the flight
JUDGED = ("condition", "velocity_condition", "time_error", "velocity_error")
SCALAR_STATUS = tuple(np.int8(code) for code in range(len(Status)))


@dataclass(frozen=True)
class CertifiedImpact(Result):
    """A first impact with proved radii: flight time, x' < 0 there, and the state just after it.

    Attributes
    ----------
    flight_time, velocity, tau, v : `Certified`, each with `.value` and `.radius`.
    oscillator, launch : the model, and the exact launch time and velocity. wall : of the launch, 1 for the upper one.

    Examples
    --------
    >>> from singimpact.flights.impact_map import impact_map
    >>> from singimpact.oscillator.model import Oscillator
    >>> step = impact_map(Oscillator("sin(x)", "-2 + cos(t)", 0, "1/2"), 1, 3, digits=20)
    >>> print(step.certified.v)
    1.7977594605181043134
    """

    NUMBERS: ClassVar[tuple[str, ...]] = ("flight_time", "velocity", "tau", "v")
    flight_time: Certified
    velocity: Certified
    tau: Certified
    v: Certified
    oscillator: Oscillator | None = field(default=None, repr=False)
    launch: tuple[Expression, ...] = field(default=(), repr=False)
    wall: int = field(default=0, repr=False)

    @property
    def value(self) -> dict[str, Any]:
        """The four values by name."""
        return {name: getattr(self, name).value for name in self.NUMBERS}

    @property
    def radius(self) -> dict[str, Any]:
        """The four radii by name."""
        return {name: getattr(self, name).radius for name in self.NUMBERS}


@dataclass(frozen=True, eq=False, repr=False)
class Flight(Result):
    """First hits.

    Parameters
    ----------
    flight_time : time from launch to the hit; inf when there is none, nan beside `unresolved`.
    velocity : x' at the hit, <= 0; nan when there is no hit.
    status : int8, see `singimpact.status.Status`.
    depth : nan, or beside `unresolved` and `graze` the least x - c near the graze.
    bound : rounding bound of `depth`.
    condition : relative condition number kappa of the flight time; nan when there is no hit.
    velocity_condition : the same of the velocity.
    time_error, velocity_error : estimates of the relative errors of the flight time and of the velocity; nan when there
        is no hit.
    cause : int8, see `singimpact.status.Cause`: why a flight is `unresolved`.
    notes : by index in the flat arrays, for unresolved flights: where the flight came to. With `digits`, for every
        flight that is not certified: why.
    certified : with `digits`, `CertifiedImpact` of each hit that is proved, None for each that is not; else None.
    wall : int8, of a model with two walls: 1 where the upper one is hit or touched, else 0, see `status.Wall`; else
        None. At the upper wall the velocity is >= 0.

    Notes
    -----
    The errors are rounding errors and cut-offs of every step, carried to the hit by the variational equation as if they
    were independent, with a margin: an estimate, no bound.  Of models without a closed form, they and the condition
    numbers are computed when they are first read.
    """

    flight_time: Any
    velocity: Any
    status: Any
    depth: Any
    bound: Any
    condition: Any
    velocity_condition: Any
    time_error: Any
    velocity_error: Any
    cause: Any = field(default=0, kw_only=True)
    notes: Mapping[int, str] = field(default_factory=dict, kw_only=True)
    certified: Any = field(default=None, kw_only=True)
    wall: Any = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        object.__setattr__(self, "status", status_array(self.status))

    @classmethod
    def made(cls, later: Callable[[str], dict[str, Any]] | None = None, **values: Any) -> Self:
        """A result from its fields; `later` gives one that is not among them, perhaps with others, when it is read."""
        found = object.__new__(cls)
        found.__dict__.update(values)
        if later is not None:
            found.__dict__["_later"] = later
        return found

    def __getattr__(self, name: str) -> Any:
        later = self.__dict__.get("_later") if name in type(self).__dataclass_fields__ else None
        if later is None:
            raise AttributeError(f"{type(self).__name__} has no {name}")
        self.__dict__.update(later(name))
        return self.__dict__[name]

    def __getstate__(self) -> dict[str, Any]:
        return self.values()

    def values(self) -> dict[str, Any]:
        """All fields by name."""
        return {each.name: getattr(self, each.name) for each in fields(self)}

    @property
    def error(self) -> Any:
        """The larger of the two relative errors: nothing in the result is less well known than this."""
        return np.maximum(self.time_error, self.velocity_error)

    @property
    def sentence(self) -> Any:
        """The outcome of each flight, and what to type next: a text, or an array of texts of the shape of `status`."""
        flat = zip(np.ravel(self.status).tolist(), np.ravel(self.cause).tolist(), strict=True)
        texts = np.array([_sentence(*each, self.notes.get(at)) for at, each in enumerate(flat)] + [None], dtype=object)
        return texts[:-1].reshape(np.shape(self.status))[()]

    def __repr__(self) -> str:
        """One state with its numbers, arrays by how many ended how.

        Examples
        --------
        >>> from singimpact.flights.impact_map import impact_map
        >>> from singimpact.oscillator.model import Oscillator
        >>> impact_map(Oscillator("0", "-2", 0, "1/2"), 1.0, 3.0)
        Step(tau=4.0, v=1.5, flight_time=3.0, velocity=-3.0, status=hit)
        >>> impact_map(Oscillator("0", "-2", 0, "1/2"), 1.0, [0, 3])
        Step of 2 states, shape (2,): 1 hit, 1 sticks
        """
        statuses = np.asarray(self.__dict__["status"])
        if not statuses.shape:
            names = [name for name in ("tau", "v", "flight_time", "velocity") if name in self.__dict__]
            numbers = [f"{name}={value_in_words(self.__dict__[name])}" for name in names]
            if self.wall is not None:
                numbers.insert(0, f"wall={Wall(int(self.wall)).name}")
            return f"{type(self).__name__}({', '.join(numbers)}, status={value_in_words(statuses, Status)})"
        ends = value_in_words(statuses, Status)
        return f"{type(self).__name__} of {statuses.size} states, shape {statuses.shape}: {ends}"

    def as_dict(self) -> dict[str, Any]:
        """Flight time, x' at the hit, the next state, status; the cause of what is unresolved, and what is certified.

        Condition numbers and errors are left out: they may take longer than the flight.
        """
        names = [name for name in ("flight_time", "velocity", "tau", "v") if name in self.__dict__]
        values = {name: plain(getattr(self, name)) for name in [*names, "certified"] if getattr(self, name) is not None}
        if self.wall is not None:
            values["wall"] = plain(self.wall, "wall")
        words = {name: plain(getattr(self, name), name) for name in ("status", "cause")}
        return values | {name: word for name, word in words.items() if word is not None}


@dataclass(frozen=True, eq=False, repr=False)
class Step(Flight):
    """A hit and the state just after it; `tau` and `v` are the next ones."""

    tau: Any
    v: Any


@dataclass(frozen=True, repr=False)
class Derivative(Result):
    """D G of the impact map: `matrix` of shape (..., 2, 2) and the `status` of the flight."""

    matrix: Any
    status: Any

    __repr__ = in_words

    def __post_init__(self) -> None:
        object.__setattr__(self, "status", status_array(self.status))


def _sentence(status: int, cause: int, note: str | None) -> str:
    if status != Status.unresolved or not cause:
        return Status(status).sentence
    return Cause(cause).sentence if note is None else f"{note}; {Cause(cause).sentence}"


@dataclass
class Count:
    """Flights computed since counting began."""

    flights: int = 0


_OPEN: ContextVar[tuple[Count, ...]] = ContextVar("open counts", default=())


@contextmanager
def counted() -> Iterator[Count]:
    """Counts the flights of a block; blocks may stand inside one another.

    Examples
    --------
    >>> from singimpact.flights.impact_map import impact_map
    >>> from singimpact.oscillator.model import Oscillator
    >>> with counted() as count:
    ...     _ = impact_map(Oscillator("0", "-2", 0, 1), [0, 1], 1)
    >>> count.flights
    2
    """
    count = Count()
    token = _OPEN.set((*_OPEN.get(), count))
    try:
        yield count
    finally:
        _OPEN.reset(token)


def count_flights(flights: int) -> None:
    """Flights that were computed just now.

    Examples
    --------
    >>> with counted() as count:
    ...     count_flights(3)
    >>> count.flights
    3
    """
    for count in _OPEN.get():
        count.flights += flights
