"""The impact surface V_c' by its curves: zero set, horizon, outline, their visible parts and singular points.

Not here: one flight (`flights`), orbits and invariant curves (`dynamics`), germs and their normal forms (`germs`).
"""

from singimpact.handed_on import names_of

_FILES = {
    "boxes_from_rest": "FlightFromRest Tangencies",
    "classification": "classify",
    "curve": "Curve Window",
    "followed_rests": "FollowedRests",
    "impact_surface": "ImpactSurface",
    "outline_transitions": "Transitions transitions",
    "proved_touches": "EnclosedTouches RestFlight doubts_left rest_flight",
    "rest_flights": "RestFlights",
    "swan_families": "Family swan_curves",
    "two_rests": "linear_rests newton",
}
__getattr__ = names_of(__name__, _FILES)
