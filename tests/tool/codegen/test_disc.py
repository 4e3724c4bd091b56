"""Radii: no function leaves the bound of its disc, and a bound that is too small is seen."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest

from singimpact.algebra import parse
from singimpact.codegen import (
    FUNCTIONS,
    atan_radius,
    bell_radius,
    circular_radius,
    exp_radius,
    log_of_square_radius,
    log_radius,
    power_of_square_radius,
    power_radius,
    recurrence,
    softplus_radius,
    tan_radius,
    tanh_radius,
    whole_power_radius,
)
from singimpact.flights import Work, over_floats

CIRCLE = np.exp(2j * np.pi * np.arange(64) / 64)

# function of w, its radius from (w, r), where w is drawn from
CASES = {
    "w^5": (lambda w: w**5, lambda w, r: whole_power_radius(w, r, 5), (-3, 3)),
    "1/w": (lambda w: 1 / w, lambda w, r: power_radius(1 / w, w, r, -1.0), (-3, 3)),
    "w^(1/3)": (lambda w: w ** (1 / 3), lambda w, r: power_radius(w ** (1 / 3), w, r, 1 / 3), (0.1, 3)),
    "w^2.5": (lambda w: w**2.5, lambda w, r: power_radius(w**2.5, w, r, 2.5), (0.1, 3)),
    "1/(0.3 + 2 w^2)": (
        lambda w: 1 / (0.3 + 2 * w * w),
        lambda w, r: power_of_square_radius(1 / (0.3 + 2 * w * w), w, r, -1.0, 0.3, 2.0), (-2, 2)),
    "sqrt(1 + w^2)": (
        lambda w: cmath.sqrt(1j + w) * cmath.sqrt(-1j + w) if w.real > 0 else cmath.sqrt(-1j - w) * cmath.sqrt(1j - w),
        lambda w, r: power_of_square_radius(math.sqrt(1 + w * w), w, r, 0.5, 1.0, 1.0), (0.6, 2)),
    "log(2 + w^2)": (
        lambda w: cmath.log(2 + w * w), lambda w, r: log_of_square_radius(w, r, 2.0, 1.0), (-0.9, 0.9)),
    "exp": (cmath.exp, lambda w, r: exp_radius(math.exp(w), w, r), (-5, 5)),
    "exp(-3 w^2)": (
        lambda w: cmath.exp(-3 * w * w), lambda w, r: bell_radius(math.exp(-3 * w * w), w, r, 3.0), (-4, 4)),
    "sin": (cmath.sin, lambda w, r: circular_radius(math.sin(w), math.cos(w), r), (-5, 5)),
    "tan": (cmath.tan, lambda w, r: tan_radius(math.tan(w), r), (-1.5, 1.5)),
    "tanh": (cmath.tanh, tanh_radius, (-30, 30)),
    "atan": (cmath.atan, atan_radius, (-4, 4)),
    "log": (cmath.log, log_radius, (0.1, 4)),
    "log(1 + e^w)": (lambda w: cmath.log(1 + cmath.exp(w)), softplus_radius, (-9, 9)),
}  # fmt: skip


def difference(function, one, other):
    if function is cmath.tanh:  # where tanh saturates, a difference is rounding alone
        return cmath.sinh(one - other) / (cmath.cosh(one) * cmath.cosh(other))
    return function(one) - function(other)


def worst(function, radius, low, high, count=400):
    """The largest |phi(w') - phi(w)|/radius over random circles on which the radius is finite."""
    rng = np.random.default_rng(2)
    most, finite = 0.0, 0
    for _ in range(count):
        w, r = float(rng.uniform(low, high)), float(10 ** rng.uniform(-3, 1))
        bound = radius(w, r)
        if not bound < 1e200:
            continue
        finite += 1
        for turn in CIRCLE:
            moved = abs(difference(function, complex(w) + r * turn, complex(w)))
            most = max(most, moved / bound if bound else (math.inf if moved else 0.0))
    assert finite > count // 20
    return most


@pytest.mark.parametrize("name", CASES)
def test_a_radius_holds_on_its_circle(name) -> None:
    function, radius, (low, high) = CASES[name]
    assert worst(function, radius, low, high) <= 1 + 1e-9


@pytest.mark.parametrize("name", CASES)
def test_a_radius_that_is_too_small_is_seen(name) -> None:
    function, radius, (low, high) = CASES[name]
    share = worst(function, radius, low, high)
    assert worst(function, lambda w, r: radius(w, r) * share / 1.01, low, high) > 1


@pytest.mark.parametrize(
    ("radius", "singular"),
    [(lambda r: power_radius(2.0, 0.5, r, -1.0), 0.5), (lambda r: log_radius(0.5, r), 0.5),
     (lambda r: atan_radius(0.0, r), 1.0), (lambda r: tanh_radius(0.0, r), math.pi / 2),
     (lambda r: tan_radius(0.0, r), math.pi / 2), (lambda r: softplus_radius(0.0, r), math.pi),
     (lambda r: power_of_square_radius(1.0, 0.0, r, -1.0, 1.0, 4.0), 0.5)],
)  # fmt: skip
def test_a_disc_that_meets_a_singularity_has_no_bound(radius, singular) -> None:
    assert radius(0.99 * singular) < math.inf
    assert radius(1.001 * singular) == math.inf


FORCES = [
    "x + 3*tanh(5*xdot)/10", "x*exp(-4*(x - 1/2)**2)", "log(1 + exp(3*x))", "1/(1 + exp(2*x))*xdot", "sqrt(2 + x**2)*x",
    "x**3*xdot - sin(x*xdot)", "atan(4*xdot) + (x + 3)**(-2)", "log(x + 4)", "tan(x/3)",
]  # fmt: skip


@pytest.mark.parametrize("force", FORCES)
def test_the_bound_of_a_model_holds(force) -> None:
    """|F(s) - F(0)| on circles, with F = g - f along the Taylor polynomial, from f and g as they are defined."""
    made = recurrence(parse(force, ["x", "xdot"]), parse("cos(2*t) + exp(3*(cos(t) - 1))", ["t"]))
    space = over_floats(made.source)
    from singimpact.algebra import as_float

    rng, order, tightest = np.random.default_rng(4), 16, 0.0
    for _ in range(20):
        c, tau, u = (float(rng.uniform(-1, 1)) for _ in range(3))
        p = [c, *(as_float(tree) for tree in made.constants)]
        X, W = [0.0] * (order + 2), [[0.0] * (order + 2) for _ in range(made.rows)]
        space["coefficients"]([tau], 0.0, 0.0, u, 0.0, order, p, Work(X, W, []))
        R = float(10 ** rng.uniform(-2, 0))
        bound, suspect = space["disc"](X, W, order, R, p)
        assert (bound < math.inf) == (suspect == 0)
        if not bound < 1e100:
            continue

        def field(s: complex, X=X, tau=tau) -> complex:
            x = sum(X[k] * s**k for k in range(order + 1))
            xdot = sum(k * X[k] * s ** (k - 1) for k in range(1, order + 1))
            names = {"x": x, "xdot": xdot, **{name: getattr(cmath, name, None) for name in FUNCTIONS}}
            pull = eval(force.replace("1/2", "0.5"), {**names, "sqrt": cmath.sqrt})
            return cmath.cos(2 * (tau + s)) + cmath.exp(3 * (cmath.cos(tau + s) - 1)) - pull

        ratio = max(abs(field(R * turn) - field(0j)) for turn in CIRCLE) / bound
        assert ratio <= 1 + 1e-9
        tightest = max(tightest, ratio)
    assert tightest > 0.05  # a bound that is never near is no bound of this model


def test_logistic_and_softplus_do_not_overflow() -> None:
    made = recurrence(parse("1/(1 + exp(900*x)) + log(1 + exp(900*x))", ["x"]), parse("0*t", ["t"]))
    space = over_floats(made.source)
    from singimpact.algebra import as_float

    for x, pull in ((1.0, 900.0), (-1.0, 1.0)):
        X, W = [0.0] * 10, [[0.0] * 10 for _ in range(made.rows)]
        space["coefficients"]([0.0], 0.0, 0.0, 0.0, 0.0, 8, [x, *map(as_float, made.constants)], Work(X, W, []))
        assert -2 * X[2] == pytest.approx(pull, rel=1e-14)
        assert all(math.isfinite(value) for value in X)
