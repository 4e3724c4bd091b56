"""One-line refusals: every bad input ends in a sentence that names it, its value and what would be accepted."""

import difflib
import math
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial, wraps
from numbers import Integral
from types import FunctionType
from typing import Any, ParamSpec, Protocol, TypedDict, TypeVar, Unpack

P = ParamSpec("P")
T = TypeVar("T")
R = TypeVar("R", covariant=True)

LONGEST = 1500  # characters of a refusal


class InputError(ValueError):
    """The caller's mistake, told in one line, whatever was put into it.

    Examples
    --------
    >>> len(str(InputError("1" * 5000 + " is not accepted")))
    1500
    """

    def __init__(self, sentence: str) -> None:
        text = " ".join(sentence.split())
        super().__init__(text if len(text) <= LONGEST else text[: LONGEST - 3] + "...")


class Unfinished(RuntimeError):
    """Work that ended too early through no mistake in what was given, told in one line."""


def refuse(name: str, value: object, accepted: str) -> InputError:
    """The error for an input that cannot be used; the caller raises it.

    Examples
    --------
    >>> print(refuse("restitution", 1.5, "a number in (0, 1]"))
    restitution = 1.5 is not accepted: give a number in (0, 1]
    """
    return InputError(f"{name} = {shown(value)} is not accepted: give {accepted}")


def need(holds: object, error: Exception) -> None:
    """Raise an error unless a condition holds.

    Examples
    --------
    >>> need(2 + 2 == 4, ArithmeticError("the sum is another"))
    """
    if not holds:
        raise error


def require(holds: object, name: str, value: object, accepted: str) -> None:
    """Refuse an input unless a condition holds.

    Examples
    --------
    >>> require(0.5 <= 1, "restitution", 0.5, "a number in (0, 1]")
    """
    if not holds:
        raise refuse(name, value, accepted)


def whole(name: str, value: object, least: int, most: int) -> int:
    """A whole number from least to most, or a refusal.

    Examples
    --------
    >>> whole("impacts", 3, 1, 10), whole("impacts", 1e3, 1, 10_000)
    (3, 1000)
    """
    counts = isinstance(value, Integral) or (isinstance(value, float) and value.is_integer())
    if isinstance(value, bool) or not counts or not least <= int(value) <= most:  # type: ignore[call-overload]
        raise refuse(name, value, f"a whole number from {least} to {most}")
    return int(value)  # type: ignore[call-overload,no-any-return]


def require_memory(name: str, shape: tuple[int, ...], size: int, remedy: str = "give fewer") -> None:
    """Refuse arrays whose results no memory holds; the system would end the process while it fills them.

    Parameters
    ----------
    name : of the arguments. shape : of their broadcast. size : bytes that the result of one number needs.

    Examples
    --------
    >>> require_memory("tau and v", (1000, 1000), 34)
    """
    try:
        memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):  # Windows
        return
    count = math.prod(shape)
    if count * size > memory:
        raise InputError(
            f"{name} of shape {shape} are {count} states, whose results need {count * size / 1e9:.3g} GB of "
            f"{memory / 1e9:.3g}: {remedy}"
        )


def shown(value: object, limit: int = 60) -> str:
    """A value as one short line, whatever its size."""
    text = value[: limit + 1] if isinstance(value, str) else _plain(value)
    text = repr(text) if isinstance(value, str) else text
    text = " ".join(text.split())
    return text if len(text) <= limit else text[: limit - 3] + "..."


def _plain(value: object) -> str:
    size = getattr(value, "size", None)
    if isinstance(size, int) and size > 8:
        return f"an array of shape {getattr(value, 'shape', '?')}"
    return str(value)


def nearest(name: str, known: Iterable[str], count: int = 3) -> list[str]:
    """The known names that look most like the one given.

    Examples
    --------
    >>> nearest("clearence", ["clearance", "restitution"])
    ['clearance']
    """
    return difflib.get_close_matches(name[:200], list(known), n=count, cutoff=0.6)


# Other names of what the package names so
SYNONYMS = {
    "r": "restitution",
    "e": "restitution",
    "c": "clearance",
    "d": "clearance",
    "w": "omega",
    "frequency": "omega",
    "v": "xdot",
    "u": "xdot",
    "x_dot": "xdot",
    "dx": "xdot",
    "dxdt": "xdot",
    "y": "x",
    "time": "t",
    "tau": "t",
    "out": "output",
    "n": "impacts",
    "grid": "size",
    "params": "parameters",
    "rho": "restitution",
}


def meant(name: str, accepted: Iterable[str]) -> str | None:
    """The known name that was meant by another one: a synonym, or the nearest in letters; None where none is near.

    Examples
    --------
    >>> meant("r", ["omega", "restitution"]), meant("omga", ["omega", "restitution"]), meant("eq:1", ["t:t1"])
    ('restitution', 'omega', None)
    """
    names = list(accepted)
    return SYNONYMS[name] if SYNONYMS.get(name) in names else next(iter(nearest(name, names, count=1)), None)


def unknown(kind: str, name: str, accepted: Iterable[str]) -> InputError:
    """The error for a name that does not exist, with the nearest names that do, or with some where none is near."""
    names = list(accepted)
    near = nearest(name, names)
    if SYNONYMS.get(name) in names:
        near = [SYNONYMS[name]]
    if near:
        return InputError(f"unknown {kind} {shown(name)}: the nearest known are {', '.join(near)}")
    some = sorted(names)[:8]
    more = f" and {len(names) - len(some)} more" if len(names) > len(some) else ""
    return InputError(f"unknown {kind} {shown(name)}: none is near; there are {', '.join(some) or 'none'}{more}")


def require_known(kind: str, names: Iterable[str], accepted: Iterable[str]) -> None:
    """Refuse the first name that is not one of those accepted."""
    known = list(accepted)
    for name in names:
        if name not in known:
            raise unknown(kind, name, known)


# the attribute of a function that takes a model with two walls
TWO_WALLS = "two_walls"


def takes_two_walls(function: T, how: object = True) -> T:
    """The function, marked as one that takes a model with two walls; others refuse it, see `checked_keywords`."""
    setattr(function, TWO_WALLS, how)
    return function


class FlightOptions(TypedDict, total=False):
    """Options of flights from either wall."""

    digits: int | None
    tolerance: object
    horizon: object
    steps: int | None
    out: Mapping[str, Any] | None
    threads: int | None
    wall: object


class FromWalls(Protocol[R]):
    """A method `with_walls`, as type checkers see it."""

    def __call__(self, tau: Any, v: Any, **options: Unpack[FlightOptions]) -> R: ...


def with_walls(shared_out: Callable[..., Any]) -> Callable[[Callable[..., R]], FromWalls[R]]:
    """A mark as `takes_two_walls`, of a method of states at the lower wall that takes `wall=` besides.

    Parameters
    ----------
    shared_out : calls the method for states at given walls: of the method, its model, wall, and other arguments.
    """

    return partial(takes_two_walls, how=shared_out)


def require_one_wall(name: str, values: Sequence[Any], named: dict[str, Any]) -> None:
    """Refuse a model with two walls: it would be taken for one with its lower wall alone."""
    for value in (*values[:2], *named.values()):
        value = getattr(value, "oscillator", value)  # of an orbit, or of an event
        if getattr(value, "upper", None) is not None and hasattr(value, "one_wall"):
            raise InputError(
                f"{name} takes a model with one wall, and this one has a second at upper = {shown(str(value.upper))}: "
                "give osc.one_wall('lower') or osc.one_wall('upper')"
            )


def checked_keywords(function: Callable[P, T]) -> Callable[P, T]:
    """The function, whose calls with other arguments than it takes are refused in a sentence.

    So is a model with two walls, unless the function `takes_two_walls`.

    Examples
    --------
    >>> checked_keywords(lambda clearance: clearance)(c=1)
    Traceback (most recent call last):
    singimpact.inputs.InputError: <lambda> has no argument 'c': give clearance
    """

    mark = getattr(function, TWO_WALLS, False)
    guarded = not mark
    name = function.__qualname__.removesuffix(".__init__").rpartition(".")[2]
    first = int(function.__name__ == "__init__")  # of a class, whose model comes second

    @wraps(function)
    def checked(*values: P.args, **named: P.kwargs) -> T:
        # an orbit and an event have a model, and perhaps a text too
        if guarded and (
            len(values) <= first
            or hasattr(values[first], "oscillator")
            or getattr(values[first], "upper", None) is not None
            or "model" in named
        ):
            require_one_wall(name, values, named)
        if callable(mark) and "wall" in named:
            rest: dict[str, Any] = dict(named)
            wall = rest.pop("wall")
            try:
                return mark(function, values[0], wall, values[1:], dict(rest))  # type: ignore[no-any-return]
            except (TypeError, KeyError):
                _refuse_arguments(function, values, rest)
                raise
        try:
            return function(*values, **named)
        except TypeError:
            _refuse_arguments(function, values, named)
            raise

    if callable(mark):
        from inspect import Parameter, signature

        takes = signature(function)
        last = Parameter("wall", Parameter.KEYWORD_ONLY, default=None, annotation="Any")
        checked.__signature__ = takes.replace(parameters=[*takes.parameters.values(), last])  # type: ignore[attr-defined]
    return checked


def checked_methods(kind: type[T], two_walls: bool = False) -> type[T]:
    """The class, each public method of which is `checked_keywords`.

    Parameters
    ----------
    two_walls : whether all of them take a model with two walls.
    """
    for name, method in list(vars(kind).items()):
        if isinstance(method, FunctionType) and (name == "__init__" or not name.startswith("_")):
            setattr(kind, name, checked_keywords(takes_two_walls(method) if two_walls else method))
    return kind


def _refuse_arguments(function: Callable[..., Any], values: Sequence[Any], named: dict[str, Any]) -> None:
    """Nothing where the function takes these arguments.

    Raises
    ------
    InputError : it does not.
    """
    from inspect import signature

    takes = signature(function).parameters
    names = [name for name, item in takes.items() if name != "self" and item.kind is not item.VAR_KEYWORD]
    title = type(values[0]).__name__ if function.__name__ == "__init__" else function.__name__
    for name in named:
        if name not in names and len(names) + ("self" in takes) == len(takes):
            instead = meant(name, names) or ", ".join(names) or "none"
            raise InputError(f"{title} has no argument {name!r}: give {instead}") from None
    try:
        signature(function).bind(*values, **named)
    except TypeError as error:
        raise InputError(f"{title} takes {', '.join(names)}: {error}") from None
