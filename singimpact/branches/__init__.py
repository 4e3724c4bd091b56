"""Periodic orbits, their branches and events over a parameter, border orbits, and manifolds of saddles.

Not here: orbits that are not periodic (`dynamics`), the flights of a family of models (`flights.family`),
pictures (`scenes`).
"""

from singimpact.handed_on import names_of

_FILES = {
    "ball_closing": "BallClosing Spans TouchingClosing return_slope",
    "clearance_curves": "ClearanceCurve",
    "closing": "Closing",
    "cascade": "settled_orbit",
    "continuation": "Curve root_between",
    "cylinder": "distances",
    "enclosed_closing": "ClosingBoxes SEARCH closed_boxes",
    "enclosed_crossing": "EnclosedCrossing",
    "enclosed_event": "rate_over",
    "events": "Event EventKind KINDS kind_of",
    "homoclinic": "Crossing Crossings crossings",
    "horseshoe": "CrossedSet Horseshoe",
    "krawczyk": "EnclosedOrbit Krawczyk",
    "manifold": "Manifold",
    "starts": "conditions",
    "orbits": "PeriodicOrbit",
    "resting": "Releases",
    "saddle_arcs": "expansion local_arc returned",
    "saddle_cones": "Cones",
    "transitions": "OrbitTransitions",
}
__getattr__ = names_of(__name__, _FILES)
