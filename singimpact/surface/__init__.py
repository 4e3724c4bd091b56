"""The impact surface V_c' by its curves: zero set, horizon, outline, their visible parts and singular points.

Not here: one flight (`flights`), orbits and invariant curves (`dynamics`), germs and their normal forms (`germs`).
"""

from singimpact.handed_on import names_of

__getattr__ = names_of(__name__)
