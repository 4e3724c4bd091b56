"""The oscillator x'' + f(x, x') = g(t), x >= c, v -> -r v as data: expressions, exact numbers, a period, a digest.

Not here: points of the tau-axis (`contact`), motion (`flights`), a user's methods (`impact_oscillator`).
"""

from singimpact.handed_on import names_of

_FILES = {
    "linear": "linear_form",
    "moving_number": "value_of with_number",
    "model": "FIELDS Oscillator fields_of read_fields",
    "wall_acceleration": "acceleration",
}
__getattr__ = names_of(__name__, _FILES)
