"""Flights of any analytic model in balls: first hits, G and D G with proved radii, of points and of boxes.

`equation` is a model as programs over balls, `taylor_step` a step whose cut-off is bounded on a complex disc, `tube`
a polynomial with its error and the root that is proved to be its first. `motion` carries a set of states: as a ball, or
as a centre, columns and a rotated box; since the launch, or at equal times of the clock. `certified_hit` follows it to
its hit, and raises the precision until the digits asked for are there; `timed_flight` flies to a given time, where it
touches the wall; `jet_flight` flies a box with first and second derivatives, in an algebra of jets; `analytic_flow`
flies impact after impact at one precision, with one polynomial for those flights that are over soon.
Not here: doubles (`flights.kernels`), orbits (`dynamics`).
"""
