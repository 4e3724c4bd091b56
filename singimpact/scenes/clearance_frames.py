"""The curves of the impact surface for many clearances on both sides of a swan: what the page with a slider shows."""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from singimpact.algebra import DOUBLES, Array, as_float, compare, derivative, evaluate, names_in, number, substitute
from singimpact.contact import SwanPoint, is_polynomial, swan_points_over_clearance, swans_are_listed
from singimpact.dynamics.invariant_arcs import grown_gamma
from singimpact.inputs import refuse, whole
from singimpact.oscillator import Oscillator, acceleration, require_model, require_rebound
from singimpact.studies import interval
from singimpact.surface import Curve, ImpactSurface, Window, default_window

Span = tuple[float, float]


@dataclass(frozen=True)
class FilmSettings:
    """The curves and points that are shown of a swan that opens.

    Attributes
    ----------
    opening : half the distance of the two tangency points at the ends of the slider, in periods: the window below is
        then less than a period. alone : the same when there is no period. aside : of the clearance, where no swan is.
        around : of the clearance, where swans are looked for if f(x, 0) is not a polynomial.
    upwards : the largest part of the way to an upper wall that the slider takes.
    height : of the picture, in sizes of the cusp of P, (64/24) |a''| half^3.
    steps : of the slider. pixels : of a panel.
    """

    opening: float = 1 / 12
    alone: float = 0.5
    aside: float = 0.1
    around: float = 2.0
    upwards: float = 0.75
    height: float = 1.5  # a swan that is opened wide is higher than its leading part
    # a window shrinks with the swan, but slower, so that one sees the swan open: by (1 + 3 e)/4 for tau and t, times
    # e^2 more for v, where e is half the distance of A and B in that of the ends, and at least `least`
    least: float = 0.15
    steps: int = 41
    pixels: int = 300  # a chord is then 12 pixels of a panel of 600, and leaves a smooth curve by much less than one
    trust: float = 1e-8  # of the series of gamma, relative: inverse images shrink its error, and a line is wider


SETTINGS = FilmSettings()


@dataclass(frozen=True)
class View:
    """The window of a frame: tau, t : ends. size : of velocities, which are shown from -size to size."""

    tau: Span
    t: Span
    size: float

    @property
    def v(self) -> Span:
        """Ends of the velocity."""
        return -self.size, self.size


@dataclass(frozen=True)
class ClearanceFrame:
    """The curves at one clearance.

    Attributes
    ----------
    clearance : c. curves : "Z", "H", "P", "jumps" (the visible part of P), "gamma"; of a model with two walls "cut",
        the flights that graze the upper wall, and "cut-launches", their launches. tangencies : their times.
    view : the window of this frame.
    """

    clearance: float
    curves: dict[str, list[Curve]]
    tangencies: tuple[float, ...]
    view: View

    def line(self, name: str) -> tuple[Array, Array]:
        """All pieces of a curve as one line with gaps, where nan stands for a gap."""
        gap = np.full((1, 2), np.nan)
        points = np.vstack([part for curve in self.curves[name] for part in (curve.points, gap)] or [gap])
        return points[:, 0], points[:, 1]


@dataclass(frozen=True)
class ClearanceFilm:
    """Frames in order of the clearance, one of them exactly at the swan, if there is one.

    Attributes
    ----------
    model : the oscillator. swan : the point that the slider goes through, or None. frames : the pictures.
    tau, t, v : the widest of their windows. flights : computed for Z, H and P.
    """

    model: Oscillator
    swan: SwanPoint | None
    frames: tuple[ClearanceFrame, ...]
    tau: Span
    t: Span
    v: Span
    flights: int

    @property
    def sentence(self) -> str:
        """A sentence on the clearances of the slider."""
        upper = self.model.upper
        above = (
            "" if upper is None else f" The upper wall stays at x = {as_float(upper):.9g}; the curves are of the lower."
        )
        if self.swan is not None:
            return (
                f"At c_0 = {self.swan.clearance:.9g} the acceleration at the wall has a double zero at "
                f"tau = {self.swan.tau:.9g}: a {self.swan.kind} swan. Move the slider through it.{above}"
            )
        low, high = self.frames[0].clearance, self.frames[-1].clearance
        why = "" if _feels_clearance(self.model) else ": f does not contain x, and no curve depends on the clearance"
        return f"No swan lies between c = {low:.9g} and c = {high:.9g}{why}.{above}"


def clearance_film(
    model: Oscillator,
    between: Any = None,
    steps: int = SETTINGS.steps,
    progress: Callable[[int, int, str], None] = lambda done, total, text: None,  # noqa: ARG005
) -> ClearanceFilm:
    """Z, H, P and gamma as the clearance moves through the swan whose clearance is nearest to the model's.

    A model without a swan, or with none between the ends, is shown around its own clearance, or between the ends.

    Parameters
    ----------
    between : two numbers, ends of the clearance; as much on both sides of the swan as opens it well when not given.
    steps : how many clearances. progress : is called with what is being done.

    Examples
    --------
    >>> film = clearance_film(Oscillator("x", "cos(2*t)", "0.9", "1/2"), steps=3)
    >>> [(round(frame.clearance, 6), len(frame.tangencies)) for frame in film.frames]
    [(0.862922, 2), (1.0, 1), (1.137078, 0)]
    """
    require_model("model", model)
    require_rebound(model, "the page, which draws gamma,")
    steps = whole("steps", steps, 2, 1001)
    ends = None if between is None else interval(between)
    if ends is not None and ends[1] >= _highest(model):
        raise refuse("between", between, f"clearances below the upper wall, which stays at x = {model.upper}")
    swan = _nearest_swan(model, ends)
    views = _across(model, ends, steps) if swan is None else _through(swan, ends, steps)
    surfaces, frames = [], []
    for n, (clearance, view) in enumerate(views):
        progress(n, len(views), f"c = {clearance:.6g}")
        at = swan.place if swan is not None and clearance == swan.clearance else clearance
        surfaces.append(ImpactSurface(model.replace(clearance=at), view.tau, view.t, 1 / SETTINGS.pixels))
        frames.append(_frame(surfaces[-1], clearance, view))
    flights = sum(surface.flights for surface in surfaces)
    widest = max((view for _, view in views), key=lambda view: view.size)
    return ClearanceFilm(model, swan, tuple(frames), widest.tau, widest.t, widest.v, flights)


def _highest(model: Oscillator) -> float:
    """The place of the upper wall, inf without one."""
    return np.inf if model.upper is None else as_float(model.upper)


def _below_the_upper_wall(model: Oscillator, high: float, clearance: float) -> float:
    """The upper end of the slider, or a point between a clearance and the upper wall where that is lower."""
    return min(high, clearance + SETTINGS.upwards * (_highest(model) - clearance))


def _feels_clearance(model: Oscillator) -> bool:
    return "x" in names_in(substitute(model.force(), {"xdot": number(0)}))


def _nearest_swan(model: Oscillator, between: tuple[Fraction, Fraction] | None) -> SwanPoint | None:
    here = as_float(model.clearance)
    if between is None and not is_polynomial(substitute(model.force(), {"xdot": number(0)})):  # no bound of all swans
        between = Fraction(here - SETTINGS.around), Fraction(here + SETTINGS.around)
    swans = swan_points_over_clearance(model, between) if _feels_clearance(model) and swans_are_listed(model) else ()
    below = [swan for swan in swans if swan.clearance < _highest(model)]
    return min(below, key=lambda swan: abs(swan.clearance - here), default=None)


def _across(model: Oscillator, between: tuple[Fraction, Fraction] | None, steps: int) -> list[tuple[float, View]]:
    """The clearances around the model's own, or between the ends, in the window that `classify` looks at."""
    here = as_float(model.clearance)
    high = _below_the_upper_wall(model, here + SETTINGS.aside, here)
    low, high = (here - SETTINGS.aside, high) if between is None else map(float, between)
    tau, t = default_window(model)
    surface = ImpactSurface(model, tau, t, 1 / SETTINGS.pixels)
    heights = [float(np.abs(curve.points[:, 1]).max()) for curve in (*surface.outline, *surface.discontinuities)]
    view = View(tau, t, SETTINGS.height * max(heights, default=1.0))
    places = np.linspace(low, high, steps)
    _with_own(places, here, None)
    return [(clearance, view) for clearance in places.tolist()]


def _with_own(places: Array, own: float, swan: float | None) -> None:
    """Move the nearest place between the ends to the model's own clearance, if it is not that of the swan."""
    nearest = int(np.clip(np.argmin(np.abs(places - own)), 1, max(places.size - 2, 1)))
    if places[0] < own < places[-1] and places.size > 2 and places[nearest] != swan:
        places[nearest] = own


def _through(swan: SwanPoint, between: tuple[Fraction, Fraction] | None, steps: int) -> list[tuple[float, View]]:
    """The clearances with c_0 among them; windows and the size of P from half the distance of A and B.

    a = a'' (sigma^2 - half^2)/2 and a = -f_x (c - c_0) at the swan, to leading order.
    """
    curvature = abs(float(acceleration(swan.model.replace(clearance=swan.place), np.array([swan.tau]), 2)[0]))
    rest = substitute(swan.model.force(), {"xdot": number(0)})
    slope = abs(float(evaluate(derivative(rest, "x"), {"x": swan.clearance, "t": swan.tau}, DOUBLES)))
    period = swan.model.period
    widest = SETTINGS.alone if period is None else SETTINGS.opening * as_float(period)
    if between is None:
        away = curvature * widest**2 / (2 * slope)
        here = as_float(swan.model.clearance)
        low, high = swan.clearance - away, swan.clearance + away
        low, high = here - away / 2 if here < low else low, here + away / 2 if here > high else high
        high = _below_the_upper_wall(swan.model, high, max(here, swan.clearance))
    else:
        low, high = map(float, between)
        away = max(swan.clearance - low, high - swan.clearance)
    half = min(widest, (2 * slope * away / curvature) ** 0.5)
    places = np.linspace(low, high, steps)
    places[np.argmin(np.abs(places - swan.clearance))] = swan.clearance
    _with_own(places, as_float(swan.model.clearance), swan.clearance)
    size = SETTINGS.height * 64 / 24 * curvature * half**3

    def view(clearance: float) -> View:
        open_ = (2 * slope * abs(clearance - swan.clearance) / curvature) ** 0.5 / half
        share = float(np.clip(open_, SETTINGS.least, 1))
        scale = (1 + 3 * share) / 4
        # the window, in halves of the distance of A and B: the unfolded swan reaches to 3 and 4
        tau, t = 4.0 * half * scale, 6.0 * half * scale
        return View((swan.tau - tau, swan.tau + tau), (-t, t), size * scale * share**2)

    return [(clearance, view(clearance)) for clearance in places.tolist()]


def _frame(surface: ImpactSurface, clearance: float, view: View) -> ClearanceFrame:
    curves = {"Z": surface.zero_set, "H": surface.horizon, "P": surface.outline, "jumps": surface.discontinuities}
    if surface.model.upper is not None:
        curves["cut"] = surface.cut
        curves["cut-launches"] = [curve for curve in curves["jumps"] if curve.name == "cut"]
        curves["jumps"] = [curve for curve in curves["jumps"] if curve.name != "cut"]
    times = tuple(tau for _, tau in surface.placed_tangencies)
    return ClearanceFrame(clearance, {**curves, "gamma": _gammas(surface, view.size)}, times, view)


def _gammas(surface: ImpactSurface, size: float) -> list[Curve]:
    """gamma at each point of the window that has one, cut to the picture."""
    curves: list[Curve] = []
    low, high = surface.window.x
    if compare(surface.model.slope_at_rest(), 1) == 0:  # no invariant curve attracts then
        return curves
    for point, tau in surface.placed_tangencies:
        turns = tau - point.tau  # whole periods
        swan = point.kind == "degenerate" and acceleration(surface.model, np.array([tau]), 2)[0] < 0
        if point.kind == "gamma" or swan:
            frame = Window((low - turns, high - turns), (0.0, size), surface.window.resolution)
            curves += [
                Curve("gamma", curve.points + np.array([turns, 0.0]), curve.axes, curve.marks)
                for curve in grown_gamma(surface.model, frame, point.tau, SETTINGS.trust)
            ]
    return curves
