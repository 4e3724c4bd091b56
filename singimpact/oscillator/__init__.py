"""The oscillator x'' + f(x, x') = g(t), x >= c, v -> -r v as data: expressions, exact numbers, a period, a digest.

Not here: points of the tau-axis (`contact`), motion (`flights`), a user's methods (`impact_oscillator`).
Files: `model` (the data), `period` (of g), `rebound` (rho), `rho_series` (its Taylor coefficients at
rest), `linear` (linear models), `linear_flight` (their motion
as formulas), `acceleration` (a_c), `nearest_zero` (the zero of a_c that a double stands for), `files` (TOML),
`equation` (the model in LaTeX), `shaken_wall` (a wall that moves), `moving_number` (a number that a model does not
name, put in).
"""

from singimpact.handed_on import names_of

_FILES = {
    "files": "fields_of read_fields",
    "linear": "linear_form",
    "model": "Oscillator",
    "rho_series": "series_of_rho",
}
__getattr__ = names_of(__name__, _FILES)
