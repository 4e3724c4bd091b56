"""Section 4.1(b): what is printed and what is corrected there, tried on two models at a tangency with a' < 0."""

from functools import lru_cache
from typing import Any

from singimpact.contact.points import tangency_points
from singimpact.impact_oscillator import ImpactOscillator
from singimpact.paper.claims.claim import Trial, Trials
from singimpact.paper.trials import leaves
from singimpact.paper.trials.true_sheet import Place, foliated, number

ELL = 1.0  # the ray t = ell sigma on which the bounds are tried
NEAR = 5e-3  # sigma there: the leading terms rule, and rounding does not


def _place(_printed: Any, _corrected: Any) -> list[Trial]:
    """phi of a point of the sector: v over s^2, s = sigma + t."""
    found = []
    for place in foliated():
        value = place.leading(lambda h, p=place: p.impact(h, h) / (2 * h) ** 2)
        found.append(
            Trial(place.name, "v/s^2 of phi(sigma, sigma)", f"{value:.8g}", ">= 0", "<= 0", value >= 0, value <= 0)
        )
    return found


@lru_cache(maxsize=1)
def _gentle() -> tuple[Place, ...]:
    """The two models forced a tenth and a fifth as much, so that k is small."""
    models = {
        "x'' + x = cos(2t)/10, c = 0.03": ImpactOscillator("x", "cos(2*t)/10", "0.03", "0.5"),
        "damped Duffing, forced by cos(1.7t)/5": ImpactOscillator(
            "x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)/5", "0.05", "0.6"
        ),
    }
    return tuple(
        Place(name, model, next(point.tau for point in tangency_points(model) if point.kind == "foliation"))
        for name, model in models.items()
    )


def _range(printed: Any, corrected: Any) -> list[Trial]:
    """t/sigma of true flights from the edge v = -(9/4) r k sigma^2, against the last ray of each statement."""
    rows = []
    for point in _gentle():
        jets = point.jets()
        edge = -2.25 * point.r * jets["k"]
        last = point.leading(lambda h, p=point, e=edge: float(p.model.impact_map(p.tau + h, e * h * h).flight_time) / h)
        ends = [number(formula, jets) for formula in (printed, corrected)]
        rows.append(
            Trial(
                point.name,
                "l of the edge that the rays must reach",
                f"{last:.8g}",
                f"l <= {ends[0]:.8g}",
                f"l <= {ends[1]:.8g}",
                last <= ends[0],
                last <= ends[1],
            )
        )
    return rows


def _velocities(place: Place, sigma: float) -> tuple[float, float]:
    """p~ and q~ at sigma: launch on the ray there, and the velocity with which the flight that lands there goes on."""
    start = sigma / (1 + ELL)
    return place.launch(sigma, ELL * sigma), -place.r * place.impact(start, ELL * start)


def _stated(place: Place, expression: Any) -> float:
    return number(expression, place.jets() | {"ell": ELL, "sigma": NEAR})


def _bound(which: int, quantity: str, sign: int) -> Trials:
    """Trials of a bound on p~ (from below, sign 1), q~ or q~/p~ (from above, -1)."""

    def trials(printed: Any, corrected: Any) -> list[Trial]:
        rows = []
        for point in foliated():
            p, q = _velocities(point, NEAR)
            value = (p, q, q / p)[which]
            bounds = [_stated(point, formula) for formula in (printed, corrected)]
            says = [f"{'>' if sign > 0 else '<'} {bound:.8g}" for bound in bounds]
            holds = [(value - bound) * sign > 0 for bound in bounds]
            name = f"{quantity} at sigma = {NEAR}, l = {ELL}"
            rows.append(Trial(point.name, name, f"{value:.8g}", says[0], says[1], holds[0], holds[1]))
        return rows

    return trials


def _back(_printed: Any, _corrected: Any) -> list[Trial]:
    """The other end of the leaf with its foot at tau_* + sigma, as sigma -> 0."""
    rows = []
    for name in {leaf.name: None for leaf in leaves.ends()}:
        own = sorted((leaf for leaf in leaves.ends() if leaf.name == name), key=lambda leaf: leaf.foot)
        (one, two), before = own[:2], all(leaf.end < 0 < leaf.foot for leaf in own)
        limit = (one.end * two.foot - two.end * one.foot) / (two.foot - one.foot)
        gone = abs(limit) < 0.05 * abs(one.end)
        text = f"{limit:.1e} at sigma = 0, {one.end:.4g} at sigma = {one.foot:.4g}"
        rows.append(Trial(name, "sigma' of the other end", text, "< 0 at 0", "< 0 for sigma > 0", not gone, before))
    return rows


def _ratio(printed: Any, corrected: Any) -> list[Trial]:
    """The limit of q~/p~ on true flights."""
    rows = []
    for point in foliated():
        value = point.leading(lambda h, p=point: _velocities(p, h)[1] / _velocities(p, h)[0])
        bounds = [_stated(point, formula) for formula in (printed, corrected)]
        says = [f"< {bound:.8g}" for bound in bounds]
        rows.append(
            Trial(point.name, "limit of q~/p~", f"{value:.8g}", says[0], says[1], value < bounds[0], value < bounds[1])
        )
    return rows


TRIALS: dict[str, Trials] = {
    "s4b-T2-place": _place,
    "s4b-l-range": _range,
    "s4b-p-bound": _bound(0, "p~", 1),
    "s4b-q-bound": _bound(1, "q~", -1),
    "s4b-ratio": _ratio,
    "s4b-back": _back,
}
