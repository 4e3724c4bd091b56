"""The impact surface V_c' by its curves: zero set, horizon, outline, what is visible, and where they are singular.

Not here: one flight (`flights`), orbits and invariant curves (`dynamics`), germs and their normal forms (`germs`).
Files: `rest_flights` (flights launched at rest), `tracing` (a level set as polylines), `curve`, `named_vertices`,
`impact_surface` (Z and what follows from it by the involution), `swan_families` (swans as one number moves, curves of
them over two), `transitions` (those, swallowtails, lips, beaks), `classification` (singular points with their germs).
"""
