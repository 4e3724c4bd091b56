"""How a flight time answers to its launch: the relative condition number of a linear model's flights."""

from __future__ import annotations

from typing import Any

import numpy as np

from singimpact.algebra.numbers import as_float
from singimpact.oscillator.linear import LinearForm

Array = np.ndarray[Any, Any]


def condition(form: LinearForm, tau: Array, v: Array, acceleration: Array, time: Array, velocity: Array) -> Array:
    """kappa = 1 + (|dT/dtau| max(|tau|, |T|) + |dT/dv| v)/T for flights that hit.

    Parameters
    ----------
    form : the linear model. tau : launch times, already less whole periods. v, acceleration : x' and a_c there.
    time, velocity : T and x' at the hit; an entry that is not a hit gives nan.

    Notes
    -----
    With the flow matrix entries S = dx/dx'_0 and S' + d S = dx/dx_0 over the time T,
    dT/dv = -S/x' and dT/dtau = -1 + (v (S' + d S) + (a_c - d v) S)/x'.
    """
    damping, stiffness = as_float(form.damping), as_float(form.stiffness)
    root = np.sqrt(complex(damping * damping / 4 - stiffness))
    a, b = -damping / 2 + root, -damping / 2 - root
    with np.errstate(all="ignore"):
        half = (a - b) * time / 2
        ratio = np.where(np.abs(half) < 1e-4, 1 + half * half / 6, np.sinh(half) / np.where(half == 0, 1, half))
        free = np.exp((a + b) * time / 2) * time * ratio
        slope = (np.exp(a * time) + b * free).real
        free = free.real
        by_tau = -1 + (v * (slope + damping * free) + (acceleration - damping * v) * free) / velocity
        by_v = -free / velocity
        kappa = 1 + (np.abs(by_tau) * np.maximum(np.abs(tau), time) + np.abs(by_v) * v) / time
    return np.where(np.isfinite(kappa), kappa, np.nan)
