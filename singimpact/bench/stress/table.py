"""The runs of `singimpact stress`, and its table: a row for each function, a column for each singular point.

A new public function: a row in `data/stress.toml`, and what judges it in one of the files here; a test compares the
rows with the public names.
"""

import tomllib
from collections.abc import Callable, Sequence
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Any

from singimpact.bench.stress import expanded, flown, named
from singimpact.bench.stress.judging import LIMITS, PLACES, Cell, Function, worst
from singimpact.inputs import require_known, unknown

JUDGES = flown.JUDGES | expanded.JUDGES | named.JUDGES


def _function(
    name: str, route: str, places: Sequence[str] = (), without: Sequence[str] = (), left_out: str = ""
) -> Function:
    """A function whose sweeps are one function of the place and the number of points."""
    chosen_places = places or [place for place in PLACES if place not in without]
    return Function(name, {place: partial(JUDGES[name], place) for place in chosen_places}, route, left_out)


ROWS = tomllib.loads((Path(__file__).parents[1] / "data" / "stress.toml").read_text(encoding="utf-8"))["function"]
FUNCTIONS = {fields["name"]: _function(**fields) for fields in ROWS}
POINTS, QUICK = 12, 4
NOTE = (
    f"Units: error over epsilon times (|value| + what a relative change of every input does to it); over"
    f" {LIMITS.failure:.0f} is a failure, marked !; inf: a wrong status. -: the function does not depend on the place."
)


def chosen(names: Sequence[str], limit: str | None) -> list[tuple[Function, str]]:
    """The requested sequences; an unknown name is refused.

    Examples
    --------
    >>> [(function.name, place) for function, place in chosen(["acceleration"], "a -> 0")]
    [('acceleration', 'a -> 0')]
    """
    require_known("function", names, FUNCTIONS)
    if limit is not None and limit not in PLACES:
        raise unknown("place", limit, tuple(PLACES))
    rows = [FUNCTIONS[name] for name in dict.fromkeys(names)] or list(FUNCTIONS.values())
    return [(row, at) for row in rows for at in PLACES if at in row.sweeps and limit in (None, at)]


def stressed(
    pairs: Sequence[tuple[Function, str]], points: int = POINTS, told: Callable[[int, str], None] = lambda *_: None
) -> list[Cell]:
    """A cell for each sweep; `told` is called with the number and the name of a sweep before it runs."""
    cells = []
    for number, (function, place) in enumerate(pairs):
        told(number, f"{function.name}, {place}")
        cells.append(worst(function.name, place, function.sweeps[place], points))
    return cells


def table(cells: Sequence[Cell]) -> tuple[list[str], list[list[str]]]:
    """Header and rows of the table of worst units."""
    places = [place for place in PLACES if any(cell.place == place for cell in cells)]
    rows = []
    for name in dict.fromkeys(cell.function for cell in cells):
        shown = {
            cell.place: f"{cell.units:.2g}{' !' if cell.failed else ''}" for cell in cells if cell.function == name
        }
        rows.append([name, *(shown.get(place, "-") for place in places)])
    return ["function", *places], rows


def worst_states(cells: Sequence[Cell]) -> tuple[list[str], list[list[str]]]:
    """The largest error of each function, the source of its 60 digits, and the reasons for omitted points."""
    rows = []
    for name in dict.fromkeys(cell.function for cell in cells):
        at = max((cell for cell in cells if cell.function == name), key=lambda cell: cell.units)
        function = FUNCTIONS[name]
        rows.append([name, f"{at.units:.2g}", at.place, at.state, function.route, function.left_out or "-"])
    return ["function", "worst", "place", "state", "60 digits from", "places left out (-)"], rows


def as_data(cells: Sequence[Cell]) -> list[dict[str, Any]]:
    """The cells as plain data."""
    return [{**asdict(cell), "failed": cell.failed} for cell in cells]
