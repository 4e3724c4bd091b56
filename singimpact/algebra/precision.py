"""The one place that sets a precision: of flint's balls, and of the mpmath numbers that the package computes with.

flint has one precision for the whole process: it is changed under a lock, which is held until it is put back. mpmath
numbers are computed in a context of the package's own; `mpmath.mp` is the user's, its precision is neither read nor
changed.

- A number with digits goes back to the user by `for_user`; a number of the user comes in by `context.convert`.
  Both round nothing. Arithmetic between the two kinds is done at the precision of the left one: convert first.
- Nothing waits for another thread under the lock, and no generator yields under it.
"""

import functools
import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from threading import RLock
from types import TracebackType
from typing import Any, TypeVar

from singimpact.handed_on import flint

T = TypeVar("T")
_LOCK = RLock()
if hasattr(os, "register_at_fork"):
    # a child forked in the middle of a computation would find the lock taken for ever, and its precision changed
    os.register_at_fork(before=_LOCK.acquire, after_in_parent=_LOCK.release, after_in_child=_LOCK.release)


class Precision:
    """The lock, and a precision that is put back with it."""

    __slots__ = ("before", "context", "name", "restored", "value")

    def __init__(self, context: Any, name: str, value: int, restored: str = "prec") -> None:
        self.context, self.name, self.value, self.restored = context, name, value, restored

    def __enter__(self) -> Any:
        _LOCK.acquire()
        try:
            self.before = getattr(self.context, self.restored)
            setattr(self.context, self.name, self.value)
        except BaseException:
            _LOCK.release()
            raise
        return self.context

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            setattr(self.context, self.restored, self.before)
        finally:
            _LOCK.release()


def balls_at(bits: int) -> Precision:
    """The lock, with flint's balls at so many bits.

    Examples
    --------
    >>> import flint
    >>> with balls_at(100):
    ...     (flint.arb(1) / 3).rel_accuracy_bits() > 90
    True
    """
    return Precision(flint.ctx, "prec", bits)


def bits_of_balls() -> int:
    """The bits that balls have now."""
    return int(flint.ctx.prec)


def digits_at(digits: int) -> Precision:
    """The lock, with the package's mpmath context at so many decimal digits; `as` names the context.

    Examples
    --------
    >>> with digits_at(30) as mp:
    ...     print(+mp.pi)
    3.14159265358979323846264338328
    """
    return Precision(_own_context(), "dps", digits)


def bits_at(bits: int) -> Precision:
    """A context with a precision in bits, as `digits_at` has one in digits."""
    return Precision(_own_context(), "prec", bits)


def series_of_any_length() -> Precision:
    """The lock, with flint's power series uncut: by itself flint cuts each after ten terms and does not say so."""
    return Precision(flint.ctx, "cap", 10**6, "cap")


@dataclass
class Ladder:
    """Bits or digits of one attempt after the other, raised until an attempt decides.

    Parameters
    ----------
    first : of the first attempt. most : none above is tried. higher : the next from the one before; one that is not
        higher is the end.
    lack : what the last attempt says to lack; the next one then has so much more, and at most `most`.

    Examples
    --------
    >>> list(Ladder(100, 500)), list(Ladder(100, 250, lambda bits: min(2 * bits, 250)))
    ([100, 200, 400], [100, 200, 250])
    """

    first: int
    most: int
    higher: Callable[[int], int] = lambda bits: 2 * bits
    lack: int | None = None

    def __iter__(self) -> Iterator[int]:
        before, bits = 0, self.first
        while before < bits <= self.most:
            yield bits
            before = bits
            bits = self.higher(bits) if self.lack is None else min(bits + self.lack, self.most)
            self.lack = None


def for_user(value: Any) -> Any:
    """A number as one of `mpmath.mp`, with all its bits."""
    import mpmath

    return mpmath.mp.make_mpc(value._mpc_) if hasattr(value, "_mpc_") else mpmath.mp.make_mpf(value._mpf_)


def negative(value: Any) -> Any:
    """A number, or an array of numbers, times -1; those of mpmath, whose minus rounds, keep all their bits.

    Examples
    --------
    >>> import mpmath
    >>> with mpmath.workdps(30):
    ...     third = mpmath.mpf(1) / 3
    >>> negative(third) + third == 0
    True
    """
    if hasattr(value, "_mpf_"):
        from mpmath.libmp import mpf_neg

        return type(value).context.make_mpf(mpf_neg(value._mpf_))
    if getattr(getattr(value, "dtype", None), "kind", "f") != "O":
        return -value
    turned = value.copy()
    turned.ravel()[:] = [negative(entry) for entry in value.ravel().tolist()]
    return turned


def _own_context() -> Any:
    with _LOCK:
        return _made_context()


@functools.cache
def _made_context() -> Any:
    from mpmath.ctx_mp import MPContext

    return MPContext()


class kept_property(functools.cached_property[T]):
    """A `cached_property` for values that are computed in balls.

    Python 3.11 gives each cached property a lock of its own: a thread that holds it and waits for balls, and one that
    holds the balls and waits for the property, would wait for ever. Under the package's own lock they cannot.
    """

    def __init__(self, function: Callable[[Any], T]) -> None:
        super().__init__(function)
        self.lock = _LOCK
