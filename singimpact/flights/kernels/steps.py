"""The length of a Taylor step of any smooth f and g: its cut-off is bounded on a complex disc.

`disc` is emitted with the recurrence of f and g; `flights.bind` puts it in the place of the one here.
"""

from math import exp, log
from typing import Any


def disc(X: Any, W: Any, n: int, R: Any, p: Any) -> Any:  # noqa: ARG001
    """A bound of the defect of the Taylor polynomial on the disc of radius R; which part of f or g is singular there.

    This one is that of x'' = 0.
    """
    return 0 * R, 0


def step_size_of_discs(X: Any, W: Any, z: Any, n: int, longest: Any, ulp: Any, p: Any, pace: Any) -> Any:
    """(step, distance beyond it within which roots are valid, pace): the longest step of proved small truncation."""
    wish = wished_step(X, z, n, longest, ulp)
    step, pace = proved_step(X, W, n, wish, ulp, p, pace)
    return step, 65 / 64, pace


def wished_step(X: Any, z: Any, n: int, longest: Any, ulp: Any) -> Any:
    """The step on which the last two terms are below ulp/8 times the first ones, at most `longest`: no bound."""
    h = longest
    for _ in range(2):  # the step depends on the n-th root of the size, so a factor of 2 changes it by 3 %
        size = ulp * (abs(z) + step_terms(X, n, h)) / 8
        if not size > 0 or not size < 1e300:
            break
        # Jorba and Zou (2005): the last two coefficients estimate the radius of convergence; both, since one may vanish
        # by symmetry
        least = log(size)
        for k in range(n - 1, n + 1):
            if X[k] != 0:
                fit = exp((least - log(abs(X[k]))) / k)
                if not fit >= h:
                    h = fit
        if h > longest / 4:
            break
    return h


def whole_power(base: Any, n: int) -> Any:
    """base^n as a product: the same bits in compiled code and in Python, whose `**` calls the C library."""
    value = 1 + 0 * base
    for _ in range(n):
        value *= base
    return value


def step_terms(X: Any, n: int, h: Any) -> Any:
    """The size of the terms that move x on a step: three of them, or the first that is not zero for a mass at rest."""
    size = h * (abs(X[1]) + h * (abs(X[2]) + h * abs(X[3])))
    k = 4
    while size == 0 and k < n - 1:
        size = abs(X[k]) * whole_power(h, k)
        k += 1
    return size


def proved_step(X: Any, W: Any, n: int, wish: Any, ulp: Any, p: Any, pace: Any) -> Any:
    """The longest step found, at most `wish`, on which the bound of `disc` keeps the cut-off below rounding; 0 if none.

    Parameters
    ----------
    pace : radius of the last disc used, radius in units of the wish, part of the last wish that was granted, steps
        since the best radius was last searched for.
    """
    last, ratio, share, count = pace
    # the best radius is searched for on every eighth step; between, what the last step got is enough
    enough = (0.92 * share if share < 0.92 and count < 8 else 0.85) * wish
    # the last radius serves again, if it is near: its bound is computed while the wish still is
    if 0.8 * ratio * wish < last < 1.1 * ratio * wish:
        bound, _suspect = disc(X, W, n, last, p)
        step = allowed_step(bound, last, X, n, wish, ulp)
        if step > enough:
            return step, (last, ratio, step / wish, count + 1)
    return searched_step(X, W, n, wish, enough, ulp, p, pace)


def searched_step(X: Any, W: Any, n: int, wish: Any, enough: Any, ulp: Any, p: Any, pace: Any) -> Any:
    """`proved_step` by discs of several sizes, until a step is `enough` or no disc gives a longer one."""
    last, ratio, share, count = pace
    if not wish > 0:
        return 0 * ulp, pace
    # after a layer the wish is far too long, so the disc grows gradually
    R, free = ratio * wish, True
    if not 2 * last > R:
        R, free = 2 * last, False
    best, best_R, upwards = 0 * wish, R, False
    for attempt in range(100):
        bound, _suspect = disc(X, W, n, R, p)
        fit = allowed_step(bound, R, X, n, wish, ulp)
        if fit > 1.02 * best:
            # a step as long as the radius of its disc: try a larger disc next
            best, best_R, upwards = fit, R, upwards or fit > 0.69 * R
        elif best > 0 and (upwards or attempt != 1):
            break
        elif best > 0:
            upwards, R = True, R / 0.8
        if best > enough:
            break
        R *= 1.25 if upwards else 0.8 if best > 0 else 0.7
    if free and best > 0:
        ratio = min(max(best_R / wish, 0.8 * ratio), 1.5 * ratio, 4.5)
    return best, (best_R, ratio, best / wish, 0 * share if count > 7 else count + 1)


def allowed_step(bound: Any, R: Any, X: Any, n: int, wish: Any, ulp: Any) -> Any:
    """The longest step h <= wish whose error of x', times h, is below 25 ulp of the terms in h; 0 without a bound.

    The defect of the polynomial is at most D = bound q^(n-1)/(1 - q), q = s/R; integrated once, at most s D/n.
    """
    if not bound < 1e280:
        return 0 * wish
    h = min(wish, 0.7 * R)
    # Cauchy: coefficients of a function bounded by `bound` on |s| <= R are at most bound/R^k; those from n - 1 on sum
    # to bound q^(n-1)/(1 - q)
    q = h * (65 / 64) / R
    # 1.04: the reach of the root finder, squared, and that the bound is summed without outward rounding
    error = 1.04 * h * h * bound * whole_power(q, n - 1)
    size = 25 * ulp * n * (1 - q) * step_terms(X, n, h)
    if error <= size:
        return h
    # a part of h has an error smaller by its power n + 1 at least, and terms smaller by its power 3 at most
    if X[1] != 0 or X[2] != 0 or X[3] != 0:
        return h * exp(log(size / error) / (n - 2)) if size > 0 else 0 * h
    return shortened_step(bound, R, X, n, h, ulp)


def shortened_step(bound: Any, R: Any, X: Any, n: int, h: Any, ulp: Any) -> Any:
    """`allowed_step` for a mass at rest whose first terms vanish."""
    for _ in range(400):
        q = h * (65 / 64) / R
        if 1.04 * h * h * bound * whole_power(q, n - 1) <= 25 * ulp * n * (1 - q) * step_terms(X, n, h):
            return h
        h *= 0.9
    return 0 * h


def singular_part_of_discs(X: Any, W: Any, n: int, h: Any, p: Any) -> Any:
    """Which part of f or g is singular next to a step of length h, as `disc` numbers them; 0: none is found."""
    R = h
    for _ in range(12):
        R = R * 2
        _bound, suspect = disc(X, W, n, R, p)
        if suspect > 0:
            return suspect
    return 0


def quiet_in_steps(z: Any, u: Any, W: Any, p: Any) -> Any:  # noqa: ARG001
    """0: of a motion without a closed form no envelope is known."""
    return 0 * z


def state_kept(launch: Any, start: Any, time: Any, z: Any, u: Any, noise: Any, ulp: Any, p: Any) -> Any:  # noqa: ARG001
    """`restart` of a Taylor flow: the state a step ends in is the state the next one starts from."""
    return z, u, noise
