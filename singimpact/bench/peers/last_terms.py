"""The usual step rule of Taylor integrators, in place of the package's: a step is chosen by its last two terms.

Nothing looks at the step afterwards, so it passes over a layer whose terms are below rounding where it begins.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any


def step_size(X: Any, W: Any, z: Any, n: int, longest: Any, ulp: Any, p: Any, pace: Any) -> Any:  # noqa: ARG001
    """The step on which the last two terms are below ulp/8 times the first ones, at most `longest`."""
    h = longest
    for _ in range(2):
        size = abs(z) + h * (abs(X[1]) + h * (abs(X[2]) + h * abs(X[3])))
        k = 4
        while size == 0 and k < n - 1:
            size = abs(X[k]) * h**k
            k += 1
        for k in range(n - 1, n + 1):
            if X[k] != 0:
                fit = (ulp * size / (8 * abs(X[k]))) ** (1 / (k + 0 * h))
                if not fit >= h:
                    h = fit
    return h, 17 / 16, pace


@contextmanager
def last_terms() -> Iterator[None]:
    """A block in which flights in Taylor steps take this rule."""
    from singimpact.flights import kernel

    usual = kernel.STEPS
    kernel.STEPS = tuple(step_size if part.__name__ == "step_size" else part for part in usual)  # type: ignore[assignment]
    _forget()
    try:
        yield
    finally:
        kernel.STEPS = usual
        _forget()


def _forget() -> None:
    from singimpact.flights import kernel

    for cached in (kernel.taylor_kernel, kernel.kernel_of):
        cached.cache_clear()
