"""Flights of any analytic model in balls: first hits, G and D G with proved radii, of points and of boxes.

`equation` is a model as programs over balls, `taylor_step` a step whose cut-off is bounded on a complex disc, `tube`
a polynomial with its error, `first_root` the root that is proved to be the first. `plain_motion` carries a state as a
ball, `framed_motion` as a centre, columns and a rotated box; `ball_flight` follows either to its hit, `certified_hit`
raises the precision until the digits asked for are there, `timed_flight` flies to a given time, where it touches the
wall; `jet_flight` flies a box with first and second derivatives, in the algebra of `jets`; `free_motion` flies a box
through the wall, `clocked_motion` at equal times of the clock; `analytic_flow` flies impact after impact at one
precision, `short_flight` those of them that are over soon.
Not here: doubles (`flights.kernels`), orbits (`dynamics`).
"""
