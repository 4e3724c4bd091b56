"""Points of the tau-axis by contact order: the jets of a_c, f and rho there; tangency points; swan points of a family.

Not here: the model itself (`oscillator`), zeros of functions (`algebra`), power series built from the jets (`theory`),
flights (`flights`).
"""

from singimpact.handed_on import names_of

_FILES = {
    "contact": "Contact NAMED_ORDERS acceleration acceleration_jet contact_order series_of_rho",
    "contacts_over": "contact_points",
    "points": "MOST_DIGITS TangencyPoints enclosed tangency_points",
    "swans": "swan_points_over_clearance swans_are_listed",
    "zero_ahead": "next_zero",
}
__getattr__ = names_of(__name__, _FILES)
