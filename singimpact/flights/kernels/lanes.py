"""Rows of the array that holds a batch of states: row ROW of state k is lane[ROW + k]."""

LANES = 64
"""States of a batch."""

V, ACC, SIZE, SINCE, LOST, TURNS = range(0, 6 * LANES, LANES)
"""v, a_c and the size of its terms at the launch; time since the start, what its sum has lost, whole periods less."""

MODE, PLACE, TIME, SPEED = range(6 * LANES, 10 * LANES, LANES)
"""What becomes of the flight (0 flies, 1 a plain crossing, 2 left to `tabulated_flight`, 3 over); its step; time and
velocity of the hit."""

Z0, U0, E0, Z1, U1, E1, BOUND = range(10 * LANES, 17 * LANES, LANES)
"""x - c, x' and x'' at both ends of the step, and the bound that x - c must exceed."""

LANE_ROWS = 17
"""Rows of the array."""

BATCH_ORDER = 18
"""Degree of a Taylor step of a batch: a step is one radian of the fastest motion."""
