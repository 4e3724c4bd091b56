"""The time before a contact point and the coordinate S = tan(sqrt(w) T)/sqrt(w), each as a function of the other."""

from __future__ import annotations

from typing import Any

from flint import arb

from singimpact.contact.zero_ahead import ContactZero
from singimpact.dynamics.gamma_proof.folded import symmetric
from singimpact.dynamics.gamma_proof.gravity import LinearNumbers, numbers_of
from singimpact.oscillator.linear import linear_form
from singimpact.oscillator.model import Oscillator


def clock_of(osc: Oscillator, zero: ContactZero, bits: int) -> LinearNumbers:
    """The numbers by which S and time are exchanged: those of a linear model; S is the time for others."""
    if linear_form(osc) is None:
        return LinearNumbers(arb(0), arb(0), arb(0), ())
    return numbers_of(osc, zero, bits)


def time_of(w: Any, S: Any) -> Any:
    """T = atan(sqrt(w) S)/sqrt(w), by atanh for w < 0.

    Examples
    --------
    >>> print(time_of(arb(1), arb(1)).str(10, radius=False))
    0.7853981634
    """
    if w > 0:
        return (w.sqrt() * S).atan() / w.sqrt()
    if w < 0:
        return ((-w).sqrt() * S).atanh() / (-w).sqrt()
    root = arb(abs(w).upper()).sqrt()  # w may be 0: the distance from T = S is at most that for w = -|w|
    return S + symmetric((root * S).atanh() / root - S) if root > 0 else S


def place_of(w: Any, T: Any) -> Any:
    """S = tan(sqrt(w) T)/sqrt(w), by tanh for w < 0."""
    if w > 0:
        return (w.sqrt() * T).tan() / w.sqrt()
    if w < 0:
        return ((-w).sqrt() * T).tanh() / (-w).sqrt()
    root = arb(abs(w).upper()).sqrt()
    return T + symmetric((root * T).tan() / root - T) if root > 0 else T


def speed_factor(numbers: LinearNumbers, S: Any) -> Any:
    """v/y' at an impact S before the contact point: e^(b T) sqrt(1 + w S^2)."""
    return (numbers.damping * time_of(numbers.square, S)).exp() * (1 + numbers.square * S * S).sqrt()
