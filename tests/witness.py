"""scipy's DOP853 as an independent witness: it evaluates f and g at points and shares no code with the other flows."""

from __future__ import annotations

from typing import Any

import numpy as np

from singimpact.algebra import DOUBLES, as_float, evaluate
from singimpact.oscillator import Oscillator


def integrate(
    osc: Oscillator, tau: float, v: float, t: Any, rtol: float = 1e-12, atol: float = 1e-13
) -> np.ndarray[Any, Any]:
    """x and x' at times t >= 0 after the launch from (c, v) at tau, the obstacle not felt.

    Parameters
    ----------
    osc : the model. tau, v : the launch. t : increasing times since the launch.
    rtol, atol : tolerances of DOP853.

    Returns
    -------
    array of shape (2, len(t)).

    Examples
    --------
    >>> integrate(Oscillator("0", "-2", 0, 1), 0.0, 3.0, [1.0]).round(9).tolist()
    [[2.0], [1.0]]
    """
    from scipy.integrate import solve_ivp

    force, forcing = osc.force(), osc.forcing()
    times = np.atleast_1d(np.asarray(t, dtype=float))

    def field(time: float, state: Any) -> list[float]:
        pull = evaluate(force, {"x": state[0], "xdot": state[1]}, DOUBLES)
        return [state[1], evaluate(forcing, {"t": tau + time}, DOUBLES) - pull]

    start = [as_float(osc.clearance), v]
    found = solve_ivp(field, (0.0, times[-1]), start, method="DOP853", t_eval=times, rtol=rtol, atol=atol)
    result: np.ndarray[Any, Any] = found.y
    return result
