"""Periodic orbits, what becomes of them as numbers of the model move, and the manifolds of those that are saddles.

Not here: flights after flights that need not close (`dynamics`), the flights of a family of models (`flights.family`),
pictures (`scenes`).
Files: `closing` (the conditions, smooth through a graze; the lowest place of a flight), `free` (those of an orbit
without impact), `orbits` (what an orbit is), `solutions` (the orbit at a point), `one_impact` (one impact, linear:
closed form), `starts` (Newton's method from many starts), `resting` (orbits without impact, and with rest), `digits`,
`periodic` (what a user asks), `continuation` (pseudo-arclength), `events`, `switching`
(the other branches at an event), `branch`, `kept` (on disk), `event_curve` (events in two numbers), `saddle_arcs` (W^s
and W^u next to a saddle), `manifold` (grown from there), `cylinder` (polylines of phases and velocities), `homoclinic`
(where W^u and W^s cross), `transitions` (those of P with the orbits between them).
"""
