"""
Digits that are proved
======================

With ``digits=`` a result has a radius within which the true value lies: the flight is enclosed in balls. This measures
the doubles of an ordinary call.
"""

import matplotlib.pyplot as plt
import numpy as np

import singimpact as si

osc = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "0.3", "0.6")
v = np.geomspace(1e-6, 1, 40)
usual = osc.impact_map(1.4, v)
proved = [osc.impact_map(1.4, float(speed), digits=30) for speed in v]
errors = [abs(float(time - hit.flight_time)) / time for time, hit in zip(usual.flight_time, proved)]
figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
axes.loglog(v, np.maximum(errors, 1e-18), "o", label="true error of a double, by 30 proved digits")
axes.loglog(v, usual.error, label="error that the double states")
axes.set(xlabel="velocity of launch", ylabel="relative error of the flight time")
axes.legend(frameon=False, loc="center")
plt.show()

# %%
# The points lie below the curve: the stated error is honest.
