"""The impact surface V_c' by its curves: zero set, horizon, outline, their visible parts and singular points.

Not here: one flight (`flights`), orbits and invariant curves (`dynamics`), germs and their normal forms (`germs`).
Files: `rest_flights` (flights launched at rest), `tracing` (a level set as polylines), `curve`, `named_vertices`,
`impact_surface` (Z, and H and P by the involution), `swan_families` (swans over one parameter, curves of
them over two), `transitions` (those, swallowtails, lips, beaks), `proved_touches` (that none of these is missing),
`enclosed_touches`, `boxes_from_rest` (the same of nonlinear models, by boxes of flights), `classification` (singular
points with their germs).
"""
