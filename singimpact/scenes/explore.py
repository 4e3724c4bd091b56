"""The interactive page: one HTML file that needs no network, with sliders and with orbits that the browser computes.

Left V_c' with the zero set Z and the horizon H, right the plane of states with the outline P and gamma.  The curves of
every place of the clearance's slider are computed beforehand and lie in the page.  Orbits are flown in the page: the
kernels are those of `flights`, translated into JavaScript; every model is flown by its Taylor recurrence there, linear
ones too.
"""

import inspect
import json
from dataclasses import dataclass
from html import escape
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from singimpact.algebra import Array, Expression, as_float, derivative, names_in, negate, number, substitute
from singimpact.codegen import radii
from singimpact.codegen.javascript import formula, translated
from singimpact.codegen.scalar import scalar
from singimpact.flights import ACROSS, LIMITS, degree_for, horizon_of, numbers_of_flow, reach_of, recurrence_of
from singimpact.flights.kernels import roots, steps, taylor
from singimpact.inputs import checked_keywords, takes_two_walls, whole
from singimpact.oscillator import Oscillator, require_model, rho_of
from singimpact.progress import ProgressLine
from singimpact.scenes.clearance_frames import SETTINGS, ClearanceFilm, ClearanceFrame, clearance_film
from singimpact.scenes.style import BLACK, BLUE, GREY, PENS, SHADE, WALL, WHITE, Pen, on_dark
from singimpact.store import write_text

# Curves of a frame, with the pen of each and its words in the legend.
CURVES = {
    "Z": ("Z", "Z: launched at rest, meets x = c again"),
    "H": ("H", "H: the same flights run back, landing at rest"),
    "P": ("P", "P: the states whose flight grazes (the outline)"),
    "jumps": ("jump", "its visible part: the impact map jumps"),
    "gamma": ("gamma", "\u03b3: below it, chatter completes before the tangency"),
    "": ("orbit", "impacts of the orbit"),
}
# What the legend has of a model with two walls, in place of its words or beside them.
AT_TWO_WALLS = {
    "": ("orbit", "impacts of the orbit at the lower wall"),
    "upper": ("orbit", "impacts of the orbit at the upper wall"),
    "cut": ("cut", "cut: the flight grazes the upper wall"),
}
BOTH_WALLS = (
    " Every step is searched for both walls, and the nearer root is the impact; from the upper wall the model with "
    "x -> -x is flown. Velocities are those away from the wall."
)
GROUND = {"ink": BLACK, "grid": SHADE, "axis": GREY, "wall": WALL, "ground": WHITE}  # behind the curves and beside them
PARTS_OF_A_WINDOW = 40_000  # in which the page has coordinates: below a hundredth of a pixel
PARTS = Path(__file__).with_name("page")
METHOD = (
    "Orbits are computed in this page, in double precision, with the Taylor method of the package for this f and g. "
    "The first root of x - c on a step is found from bounds of its derivatives, so no impact is stepped over. "
    "A flight that touches x = c so nearly that rounding decides ends the orbit, and the page says so; after a near "
    "graze the later states have fewer digits. Chatter is summed when less than 1e-7 of the forcing's time scale is "
    "left of it. For certified digits use osc.orbit of the Python package singimpact."
)


@dataclass(frozen=True)
class ExplorePage:
    """A page with a slider for the clearance; a notebook shows it below its cell.

    Attributes
    ----------
    film : the curves at each place of the slider. html : the page, one text that needs no network.
    """

    film: ClearanceFilm
    html: str

    def __repr__(self) -> str:
        low, high = self.film.frames[0].clearance, self.film.frames[-1].clearance
        megabytes = len(self.html) / 1e6
        return f"ExplorePage({len(self.film.frames)} clearances from {low:.6g} to {high:.6g}, {megabytes:.2g} MB)"

    def _repr_html_(self) -> str:
        return f'<iframe srcdoc="{escape(self.html)}" width="100%" height="800" frameborder="0"></iframe>'

    def save(self, path: Any) -> None:
        """Write the page to a file."""
        write_text(path, self.html)


@checked_keywords
@takes_two_walls
def explore(osc: Oscillator, between: Any = None, points: int = SETTINGS.steps) -> ExplorePage:
    """A page on which Z, H, P and gamma change as the clearance moves through the nearest swan.

    It has sliders for the restitution and the parameters too. A click in the plane of states starts an orbit.
    Orbits of a model with two walls bounce between them; the curves are those of the lower wall, which the slider
    moves. `explore(osc.mirrored)` shows those of the upper one.

    Parameters
    ----------
    osc : the model. between : two clearances, the ends of the slider, below an upper wall; both sides of the swan
        without them.
    points : clearances of the slider, from 2 to 1001.

    Returns
    -------
    ExplorePage : `.save("page.html")` writes it; `.film.frames` has the curves as arrays.

    Raises
    ------
    InputError : ends of an interval, or points, that are not valid.

    Examples
    --------
    >>> page = explore(Oscillator("x", "cos(2*t)", "0.9", "1/2"), points=2)
    >>> print(repr(page).partition(", ")[0])
    ExplorePage(2 clearances from 1 to 1.13708
    """
    require_model("osc", osc)
    whole("points", points, 2, 1001)
    with ProgressLine() as line:
        film = clearance_film(osc, between, points, line.show)
    return ExplorePage(film, explore_page(film))


def explore_page(film: ClearanceFilm) -> str:
    """The page of a film."""
    model = film.model
    places = "x \u2265 c" if model.upper is None else f"c \u2264 x \u2264 {model.upper}"
    text = f"x'' + f(x, x') = g(t), {places}, with f = {model.f}, g = {model.g}, restitution {model.restitution}."
    if model.upper is not None:
        text += f" At the upper wall the restitution is {model.upper_restitution}."
    if model.parameters:
        text += f" Parameters: {', '.join(f'{name} = {value}' for name, value in model.parameters.items())}."
    page = (PARTS / "page.html").read_text(encoding="utf-8")
    filled = {
        "title": escape(f"x'' + {model.f} = {model.g}, {places}"),
        "model": escape(text),
        "sentence": escape(film.sentence.replace("c_0", "c\u2080").replace("tau =", "\u03c4 =")),
        "method": escape(METHOD if model.upper is None else METHOD + BOTH_WALLS),
        "style": (PARTS / "page.css").read_text(encoding="utf-8"),
        "accent": BLUE,
        "night": on_dark(WHITE),
        "script": _script(film),
    }
    for name, content in filled.items():
        page = page.replace(f"@{name}@", content)
    return page


def _script(film: ClearanceFilm) -> str:
    """The model, the film, how curves look, and the code of the page."""
    parts = [model_in_javascript(film.model), as_script("FILM", _film(film))]
    curves = CURVES if film.model.upper is None else CURVES | AT_TWO_WALLS
    parts.append(as_script("PENS", {name: _pen(PENS[name]) for name, _ in curves.values()}))
    parts.append(as_script("GROUNDS", {"day": GROUND, "night": {name: on_dark(GROUND[name]) for name in GROUND}}))
    legend = [
        {"name": pen, "label": label, "dot": PENS[pen].color if pen == "orbit" else None, "open": name == "upper"}
        for name, (pen, label) in curves.items()
    ]
    legend.append({"name": "P", "label": "tangency points", "dot": "currentColor"})
    parts.append(as_script("LEGEND", legend))
    return "\n".join([*parts, *((PARTS / name).read_text(encoding="utf-8") for name in ("flight.js", "page.js"))])


def _pen(pen: Pen) -> dict[str, Any]:
    """Colour, width and dashes of a curve in the terms of SVG; matplotlib counts dashes in widths of the line."""
    dashes = "none" if pen.style == "solid" else " ".join(f"{part * pen.width:.3g}" for part in pen.style[1])
    return {"color": pen.color, "dark": on_dark(pen.color), "width": pen.width, "dashes": dashes}


def _film(film: ClearanceFilm) -> dict[str, Any]:
    places = [frame.clearance for frame in film.frames]
    swan = None if film.swan is None else places.index(film.swan.clearance)
    here = as_float(film.model.clearance)
    start = int(np.argmin([abs(place - here) for place in places]))
    own = start if places[start] == here else None
    frames = [_frame(frame) for frame in film.frames]
    return {"swan": swan, "start": start, "own": own, "parts": PARTS_OF_A_WINDOW, "frames": frames}


def _frame(frame: ClearanceFrame) -> dict[str, Any]:
    heights = dict.fromkeys(("Z", "H", "cut"), frame.view.t)
    curves = {
        CURVES.get(name, (name,))[0]: [
            # chords of the cut are half as long as those of the others
            _steps(
                curve.points if name in CURVES else np.vstack([curve.points[:-1:2], curve.points[-1:]]),
                frame.view.tau,
                heights.get(name, frame.view.v),
            )
            for curve in parts
        ]
        for name, parts in frame.curves.items()
    }
    none = [CURVES[name][0] for name in ("Z", "H", "P") if not frame.curves[name]]
    empty = f"At this clearance the window has no {' and no '.join(none)}." if none else ""
    return {
        "c": frame.clearance,
        "tau": frame.view.tau,
        "t": frame.view.t,
        "v": frame.view.v,
        "tangencies": frame.tangencies,
        "curves": curves,
        "empty": empty,
    }


def _steps(points: Array, tau: tuple[float, float], up: tuple[float, float]) -> list[int]:
    """Steps from each point to the next, the first from the lower ends, in parts of the window: few digits each."""
    low, high = np.array([tau, up]).T
    places = np.rint((points - low) / (high - low) * PARTS_OF_A_WINDOW).astype(int)
    steps: list[int] = np.diff(places, axis=0, prepend=[[0, 0]]).ravel().tolist()
    return steps


# A model as JavaScript: the kernels that fly it in a browser, its recurrence, and its numbers.

KERNELS = (roots, steps, taylor)
# What `flights.bind` puts in the places of functions of linear models.
BOUND = {
    "step_size": "step_size_of_discs",
    "singular_part": "singular_part_of_discs",
    "restart": "state_kept",
    "quiet": "quiet_in_steps",
}
GIVEN = "given"
EMITTED = ("coefficients", "disc")  # the recurrence of f and g
# What the page calls and reads of one wall, beside `taylor_flight` and `follow`.
USED = ("coefficients", "rebound", "constants_of", "law_of", "MODEL")


def model_in_javascript(osc: Oscillator) -> str:
    """The text of `SIDES`, what flies from each wall, and of `MODEL`, the numbers of the first.

    From the upper wall the model with x -> -x is flown, whose lower wall that is.

    Examples
    --------
    >>> text = model_in_javascript(Oscillator("x", "cos(w*t)", 0, "1/2", {"w": 2}))
    >>> [line for line in text.splitlines() if line.startswith("const constants_of")]
    ['const constants_of = (given) => [given["w"], (-1 * given["w"]), 1];']
    """
    kernels = {name: text for module in KERNELS for name, text in _functions(module).items()}
    kernels.pop("disc")  # that of x'' = 0
    sides = [osc] if osc.upper is None else [osc, osc.mirrored]
    # kernels in a scope of their own: the page has functions of the same names
    return "\n".join(
        [
            as_script("ACROSS", ACROSS),
            *_functions(radii).values(),
            f"const flights_with = ({', '.join(EMITTED)}) => {{",
            *kernels.values(),
            *(f"const {name} = {other};" for name, other in BOUND.items()),
            "return { taylor_flight, follow };",
            "};",
            f"const SIDES = [{', '.join(map(_side, sides))}];",
            "const { MODEL } = SIDES[0];",
        ]
    )


def _functions(module: ModuleType) -> dict[str, str]:
    return translated(inspect.getsource(module))


def _side(osc: Oscillator) -> str:
    """The recurrence of f and g, the rebound law and the numbers of a model with its flights, as one expression."""
    flow = recurrence_of(osc)
    text, law = _rebound(osc)
    model = {
        "parameters": {name: as_float(value) for name, value in osc.parameters.items()},
        "numbers": numbers_of_flow(osc, flow).tolist(),
        "rows": flow.rows,
        "order": degree_for(2.0**-52),
        "safety": LIMITS.safety,
        "budget": LIMITS.steps,
        "horizon": horizon_of(osc, None),
        "reach": reach_of(osc),
        "period": None if osc.period is None else as_float(osc.period),
        "clearance": as_float(osc.clearance),
        "upper": None if osc.upper is None else as_float(osc.upper),
        "r": as_float(osc.slope_at_rest()),
        "r_moves": not names_in(osc.restitution),
    }
    return "\n".join(
        [
            "(() => {",
            *translated(flow.source, EMITTED).values(),
            text,
            f"const constants_of = ({GIVEN}) => [{_formulas(flow.constants)}];",
            law,
            as_script("MODEL", model),
            f"return {{ ...flights_with({', '.join(EMITTED)}), {', '.join(USED)} }};",
            "})()",
        ]
    )


def _rebound(osc: Oscillator) -> tuple[str, str]:
    """The function `rebound`, and its constants with r = -rho'(0) for parameters and for r of the slider."""
    if not names_in(osc.restitution):
        text = "function rebound(velocity, w) {\n  return Math.abs(w[0] * velocity);\n}"
        return text, f"const law_of = ({GIVEN}, r) => ({{ w: [r], r }});"
    source, trees = scalar(rho_of(osc.restitution), ("v",), "rebound")
    slope = formula(negate(substitute(derivative(osc.restitution, "v"), {"v": number(0)})), GIVEN)
    return translated(source)["rebound"], f"const law_of = ({GIVEN}) => ({{ w: [{_formulas(trees)}], r: {slope} }});"


def _formulas(trees: tuple[Expression, ...]) -> str:
    return ", ".join(formula(tree, GIVEN) for tree in trees)


def as_script(name: str, value: Any) -> str:
    """A constant of the page; no text of a model ends the script early."""
    return f"const {name} = {json.dumps(value, separators=(',', ':'))};".replace("</", "<\\/")
