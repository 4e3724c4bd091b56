"""Random states of any family that were flown and judged: a row for each kind, and the states that need a look.

A case is a model and some states; it is drawn from its number and the seed alone, so cases run anywhere, in any order.
"""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array

EACH = 25  # states of a case, whose model is made once
SHOWN = 5  # states of each sort that are written out, each of another kind
# `wrong`, `unresolved` (by the package) and `undecided` (by the truth) are 0 or 1, `crossed` is 1 where a flight
# crossed a steep layer, `ratio` is the error in units of what is allowed
COLUMNS = ("case", "launch", "crossed", "wrong", "unresolved", "undecided", "ratio")
SORTS = ("wrong", "unresolved", "undecided")


@dataclass(frozen=True)
class Row:
    """States of one kind: how many, how many of each sort, and the largest error of one that is not wrong."""

    kind: str
    states: int
    crossed: int
    wrong: int
    unresolved: int
    undecided: int
    worst: float


@dataclass(frozen=True)
class RandomStates:
    """States that were flown.

    Parameters
    ----------
    columns : those of COLUMNS, and others of the family. kind_of : the kind of a case.
    text_of : a state as it is typed, from its case and launch.
    """

    columns: dict[str, Array]
    kind_of: Callable[[int], str]
    text_of: Callable[[int, int], str]

    @property
    def kinds(self) -> Array:
        """The kind of each state."""
        return np.array([self.kind_of(int(number)) for number in self.columns["case"]])

    def rows(self) -> list[Row]:
        """A row a kind, in the order of the cases."""
        kinds, table = self.kinds, []
        for kind in dict.fromkeys(kinds.tolist()):
            here = {name: self.columns[name][kinds == kind] for name in COLUMNS}
            right = here["ratio"][(here["wrong"] == 0) & np.isfinite(here["ratio"])]
            counts = {name: int(here[name].sum()) for name in ("crossed", *SORTS)}
            table.append(Row(kind, len(here["case"]), worst=float(right.max(initial=0.0)), **counts))
        return table

    def listed(self) -> dict[str, list[str]]:
        """States of each sort as they are typed: a few, each of another kind, and all that the truth leaves open."""
        kinds, texts = self.kinds, {}
        for sort in SORTS:
            states = self.columns[sort].nonzero()[0]
            # what the truth does not decide is rare, and each such state is a fault of the truth
            if sort != "undecided":
                states = states[np.unique(kinds[states], return_index=True)[1]][:SHOWN]
            pairs = zip(self.columns["case"][states], self.columns["launch"][states], strict=True)
            texts[sort] = [self.text_of(int(number), int(launch)) for number, launch in pairs]
        return texts

    def as_data(self) -> dict[str, Any]:
        """The rows and the listed states as plain data."""
        return {"rows": [asdict(row) for row in self.rows()], "listed": self.listed()}
