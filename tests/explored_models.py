"""Models whose interactive pages are tested: with one wall and with two."""

import singimpact as si

NEGATIVE = si.linear(2, "0.9", "0.5")
DUFFING = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(omega*t)", "0.7", "0.6", {"omega": "1.7"})
PARAMETRIC = si.ImpactOscillator("(1 + 0.3*cos(2*t))*x + 0.1*xdot + 0.2*x**3", "cos(t)", "0.15", "0.7")
BENT = si.ImpactOscillator(
    "tanh(x) + 0.2*xdot + k*x/(1 + x**2)", "exp(sin(2*t)) - 1", "0.2", "-0.8*v + b*v**2", {"k": "0.5", "b": "0.05"}
)
TWO_WALLS = {
    "linear": si.linear("2.8", "-0.5", "0.8", upper=("0.5", "0.7")),
    "impact pair": si.models.impact_pair(),
    "harvester": si.models.harvester(),
    "stops": si.models.shaw_stops(),
    "Duffing": si.ImpactOscillator(
        "x + 0.1*xdot + 0.3*x**3", "cos(omega*t)", "-0.3", "0.6", {"omega": "1.7"}, upper="0.4", upper_restitution="0.8"
    ),
    "bent": BENT.replace(clearance="-0.2", upper="0.3", upper_restitution="-0.7*v + b*v**2"),
}
