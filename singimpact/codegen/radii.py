"""Bounds of a function's variation on a disc, as kernel text: plain arithmetic for doubles and mpf alike.

`quotient` and `real_power` are what the recurrence itself divides and raises by.  Each other function bounds
|phi(w') - phi(w)| over all complex w' with |w' - w| <= r, for a real centre w.  It is inf where the disc may meet a
singularity: a pole, a branch point, a kink.  Nothing here raises or overflows: exponents beyond 700 count as infinite.
`codegen.disc` writes the calls; the suite compares each bound with its circle.
"""

from math import cos, exp, expm1, inf, log, log1p, nan, sinh, tan
from typing import Any


def quotient(a: Any, b: Any) -> Any:
    """a/b; nan where b is 0, on every kind of number."""
    return a / b if b != 0 else nan


def real_power(w: Any, q: Any) -> Any:
    """w^q where it is real; else nan."""
    if w > 0 or (w == 0 and q > 0) or (w < 0 and q == int(q)):
        return w**q
    return nan


def whole_power_radius(w: Any, r: Any, n: int) -> Any:
    """For w^n, n >= 1: (|w| + r)^n - |w|^n, summed without a difference."""
    value, radius = 1.0, 0 * r
    for _ in range(n):
        radius = radius * (abs(w) + r) + value * r
        value *= abs(w)
    return radius


def power_radius(y: Any, w: Any, r: Any, q: Any) -> Any:
    """For y = w^q: the binomial series and its majorant."""
    if not r < abs(w) or (w < 0 and q != int(q)):
        return inf
    rise = log1p(-r / abs(w))
    if 0 < q < 1:
        return -abs(y) * expm1(q * rise)
    return abs(y) * expm1(-abs(q) * rise) if -abs(q) * rise < 700 else inf


def power_of_square_radius(y: Any, w: Any, r: Any, q: Any, shift: Any, factor: Any) -> Any:
    """For y = (shift + factor w^2)^q with zeros at +-i sqrt(kappa), kappa = shift/factor > 0.

    With d the distance of w from both zeros, |kappa + w'^2| >= (d - r) max(d - r, 2 sqrt(kappa) - d + r): the distances
    of w' from the zeros add up to 2 sqrt(kappa) at least.
    """
    if not shift * factor > 0:
        return inf
    kappa = shift / factor
    root = kappa**0.5
    distance = (w * w + kappa) ** 0.5
    if not r < distance:
        return inf
    rise, left = log1p(-r / distance), distance - r
    binomial = abs(y) * expm1(-2 * abs(q) * rise) if -2 * abs(q) * rise < 700 else inf
    # the modulus itself, at most or at least, instead of the difference
    bound = (1 + r / distance) ** 2 if q > 0 else left / distance * (max(left, 2 * root - left) / distance)
    size = q * log(bound) if bound > 0 else inf
    return min(binomial, abs(y) * (1 + exp(size)) if size < 700 else inf)


def exp_radius(y: Any, w: Any, r: Any) -> Any:
    """For y = e^w; where r is large y may have underflowed, so the sum of exponents is taken."""
    if r < 1:
        return y * expm1(r)
    return exp(w + r) if w + r < 700 else inf


def bell_radius(y: Any, w: Any, r: Any, c: Any) -> Any:
    """For y = e^(-c w^2), c > 0: Re w'^2 is at least (|w| - r)^2, or w^2/2 - r^2 where the disc is wide."""
    if not c > 0:
        return inf
    least = (abs(w) - r) * (abs(w) - r) if 2 * r < abs(w) else w * w / 2 - r * r
    return y + exp(-c * least) if -c * least < 700 else inf


def circular_radius(y: Any, slope: Any, r: Any) -> Any:
    """For y = sin w with slope cos w, or the other way round."""
    if not r < 700:
        return inf
    half = sinh(r / 2)
    return abs(y) * 2 * half * half + abs(slope) * sinh(r)


def tan_radius(y: Any, r: Any) -> Any:
    """For y = tan w, by the addition theorem."""
    if not r < 1.5707:
        return inf
    turn = tan(r)
    left = 1 - abs(y) * turn
    return (1 + y * y) * turn / left if left > 0 else inf


def tanh_radius(w: Any, r: Any) -> Any:
    """For tanh w: |tanh w' - tanh w| = |sinh(w' - w)|/|cosh w' cosh w| and |cosh|^2 = sinh^2 Re + cos^2 Im."""
    least = abs(w) - r
    if least > 20:
        return 4 * exp(-2 * least) if least < 350 else 1e-300
    if not r < 350:
        return inf
    real = sinh(least) if least > 0 else 0 * r
    imaginary = cos(r) if r < 1.5707 else 0 * r
    low = (real * real + imaginary * imaginary) ** 0.5
    # 1/cosh w >= e^-|w| is used where cosh itself would be too large
    high = abs(w) if abs(w) < 350 else 350.0
    grown = sinh(high)
    return sinh(r) / ((1 + grown * grown) ** 0.5 * low) if low > 0 else inf


def atan_radius(w: Any, r: Any) -> Any:
    """For atan w, whose derivative is 1/((w - i)(w + i))."""
    distance = (1 + w * w) ** 0.5
    return r / (distance * (distance - r)) if r < distance else inf


def log_radius(w: Any, r: Any) -> Any:
    """For log w."""
    return -log1p(-r / w) if r < w else inf


def log_of_square_radius(w: Any, r: Any, shift: Any, factor: Any) -> Any:
    """For log(shift + factor w^2), shift/factor > 0, up to a constant the sum of two logarithms."""
    if not shift * factor > 0:
        return inf
    distance = (w * w + shift / factor) ** 0.5
    return -2 * log1p(-r / distance) if r < distance else inf


def softplus_radius(w: Any, r: Any) -> Any:
    """For log(1 + e^w), whose derivative 1/(1 + e^-w) is singular at odd multiples of i pi."""
    low, high = w - r, w + r
    slope = inf
    if low > 0:
        slope = 1 / -expm1(-low)
    elif high < 0:
        slope = exp(high) / -expm1(high)
    if r < 3.14:
        slope = min(slope, exp(min(high / 2, 300.0)) / (2 * cos(r / 2)))
    return r * slope if slope < inf else inf
