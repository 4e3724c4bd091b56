"""The impact surface V_c' by its curves: zero set, horizon, outline, their visible parts and singular points.

Not here: one flight (`flights`), orbits and invariant curves (`dynamics`), germs and their normal forms (`germs`).
Files: `rest_flights` (flights launched at rest), `tracing` (a level set as polylines), `curve`, `named_vertices`,
`impact_surface` (Z, and H and P by the involution), `swan_families` (swans over one parameter, curves of
them over two), `transitions` (those, swallowtails, lips, beaks, and `rest_events`: tacnodes, triple points, periodic
grazes), `two_rests` (linear models over the clearance), `followed_rests` (others), `seen_events` (which are visible),
`proved_touches` (that no lips, beaks or swallowtail is missing), `enclosed_touches`, `boxes_from_rest` (the same of
nonlinear models, by boxes of flights), `classification` (singular points with their germs).
"""

from singimpact.handed_on import names_of

_FILES = {
    "boxes_from_rest": "FlightFromRest Tangencies",
    "classification": "classify",
    "curve": "Curve Window",
    "enclosed_touches": "EnclosedTouches",
    "followed_rests": "FollowedRests",
    "impact_surface": "ImpactSurface",
    "proved_touches": "RestFlight doubts_left rest_flight",
    "rest_flights": "RestFlights",
    "swan_families": "Family swan_curves",
    "transitions": "Transitions",
    "two_rests": "linear_rests newton",
}
__getattr__ = names_of(__name__, _FILES)
