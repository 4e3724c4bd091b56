"""Periodic orbits, their branches and events over a parameter, border orbits, and manifolds of saddles.

Not here: orbits that are not periodic (`dynamics`), the flights of a family of models (`flights.family`),
pictures (`scenes`).
Files: `closing` (the conditions, smooth through a graze; the lowest place of a flight), `free` (those of an orbit
without impact), `orbits` (the type of an orbit), `solutions` (the orbit at a point), `one_impact` (one impact, linear:
closed form), `two_impacts` (two, linear: isolated by balls), `enclosed_closing` (one or two, in a window: isolated by
balls), `starts` (Newton's method from many starts), `resting` (orbits without impact, and with rest), `digits`,
`krawczyk` (Krawczyk's operator), `enclosed_map` (G over boxes), `ball_closing` (the conditions in balls),
`enclosed_orbit` (that an orbit exists), `enclosed_event` (that an event does, and no other), `event_function` (what
vanishes there, and its rate along the curve of orbits), `periodic` (the search for all orbits), `continuation`
(pseudo-arclength), `events` (one file a kind: its test, equations, other branches and mark), `switching` (the other
branches at an event), `branch`, `branch_walk` (while it is followed), `event_tests` (what vanishes at events, in
doubles), `step_search` (its zeros within a step), `branch_points` (pitchforks, transcritical points), `kept` (on disk),
`event_curve` (events in two parameters); `saddle_arcs` (W^s and W^u next to a saddle), `manifold` (grown from there),
`cylinder` (polylines of phases and velocities), `homoclinic` (where W^u and W^s cross), `saddle_cones` (wedges that
hold W^u and W^s), `enclosed_crossing` (that an orbit between saddles exists), `horseshoe` (sets whose images cross one
another: chaos); `border` (released orbits that return onto gamma), `released` (that orbit), `border_digits`, `cascade`
(the edges beside it), `settled` (the periodic orbit to which an orbit converges), `transitions` (those of P with the
orbits between them).
"""

from singimpact.handed_on import names_of

_FILES = {
    "ball_closing": "BallClosing Spans TouchingClosing return_slope",
    "closing": "Closing",
    "continuation": "Curve root_between",
    "cylinder": "distances",
    "enclosed_closing": "ClosingBoxes SEARCH closed_boxes",
    "enclosed_crossing": "EnclosedCrossing",
    "enclosed_orbit": "EnclosedOrbit",
    "event_function": "rate_of rate_over",
    "events": "Event EventKind KINDS kind_of",
    "homoclinic": "Crossing Crossings crossings",
    "horseshoe": "CrossedSet Horseshoe",
    "krawczyk": "Krawczyk",
    "manifold": "Manifold",
    "orbits": "PeriodicOrbit",
    "released": "Releases",
    "saddle_arcs": "expansion local_arc returned",
    "saddle_cones": "Cones",
    "settled": "settled_orbit",
    "starts": "conditions",
    "transitions": "OrbitTransitions",
}
__getattr__ = names_of(__name__, _FILES)
