"""The tables of `singimpact bench states --family steep`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from singimpact.cli.output import columns

if TYPE_CHECKING:
    import numpy as np

    from singimpact.bench.steep_balls import Enclosures, Estimate
    from singimpact.bench.steep_cost import Cost
    from singimpact.bench.steep_digits import Pairs
    from singimpact.bench.steep_states import Row

LISTED = 5  # states of each kind that are written out, each of another family
TIMES = ("seconds", "true_seconds")


@dataclass(frozen=True)
class SteepStates:
    """The output, as data and as text, and whether a flight is wrong."""

    data: dict[str, Any]
    text: str
    wrong: bool


def steep_states(
    states: int, seed: int, workers: int | None, keep: str | None, balls: tuple[int, int, int, int], costs: bool
) -> SteepStates:
    """Fly random steep states and some of them in balls; time each family.

    Parameters
    ----------
    balls : states in balls, how many of these with `digits=20`, and how many steep and how many smooth states with
        20 and with 40 digits.
    costs : whether families are timed.
    """
    from singimpact.bench import steep_balls, steep_digits, steep_states
    from singimpact.bench.steep_cost import cost
    from singimpact.bench.steep_families import FAMILIES
    from singimpact.case_pools import WorkerPool

    beside = None if keep is None else Path(keep).with_name(f"{Path(keep).stem}-balls.npz")
    with WorkerPool(workers) as pool:
        checked = steep_states.check(states, seed, pool, keep)
        enclosures = steep_balls.check(checked, balls[:2], seed, pool, beside)
        pairs = {
            name: steep_digits.check(count, seed, pool, steep=name == "steep")
            for name, count in zip(("steep", "smooth"), balls[2:], strict=True)
        }
    rows = steep_states.rows(checked)
    timed = {family.name: cost(family) for family in FAMILIES} if costs else {}
    listed = _listed(checked, seed)
    data = {
        "families": [asdict(row) for row in rows],
        "balls": asdict(enclosures),
        "pairs": {name: asdict(pair) for name, pair in pairs.items()},
        "cost": {name: asdict(figure) for name, figure in timed.items()},
        "listed": listed,
    }
    parts = [
        _table(rows),
        _balls(enclosures),
        *(_pairs(name, pair) for name, pair in pairs.items()),
        _cost(timed),
        *(_lines(name, table) for name, table in listed.items()),
    ]
    return SteepStates(
        data,
        "\n\n".join(table for table in parts if table),
        _is_wrong(rows, enclosures) or any(pair.apart for pair in pairs.values()),
    )


def _is_wrong(rows: Sequence[Row], balls: Enclosures) -> bool:
    """Whether a flight, an estimate of its error or the truth itself is wrong."""
    below = any(part is not None and part.below for part in (balls.time, balls.velocity))
    return any(row.wrong for row in rows) or bool(balls.disagree or balls.digits_wrong) or below


def _table(rows: Sequence[Row]) -> str:
    header = [
        "family",
        "states",
        "crossed",
        "wrong",
        "unresolved, K <= 1e3",
        "above",
        "truth undecided",
        "worst error",
        "us a state",
        "of the truth",
    ]
    cells = []
    for kind in (True, False):
        kin = [row for row in rows if row.steep == kind]
        cells += [
            [
                row.family,
                str(row.states),
                f"{row.crossed / row.states:.2f}" if kind else "-",
                str(row.wrong),
                str(row.unresolved),
                str(row.unresolved_steep),
                str(row.undecided),
                f"{row.worst_error:.1e}",
                f"{1e6 * row.seconds:.0f}",
                f"{1e6 * row.true_seconds:.0f}",
            ]
            for row in kin
        ]
        if kin:
            cells.append(_total("all steep" if kind else "all smooth", kin))
    note = (
        "wrong: relative error of a flight time above max(1e-9, 100 kappa epsilon), or another end of the flight.\n"
        "worst error: largest relative error of a flight time that is not wrong. crossed: part of the flights."
    )
    return columns(header, cells) + "\n" + note


def _total(name: str, rows: Sequence[Row]) -> list[str]:
    def total(field: str) -> int:
        return sum(getattr(row, field) for row in rows)

    fields = ("wrong", "unresolved", "unresolved_steep", "undecided")
    states, worst = total("states"), max(row.worst_error for row in rows)
    seconds = [1e6 * sum(getattr(row, field) * row.states for row in rows) / states for field in TIMES]
    crossed_share = f"{total('crossed') / states:.2f}" if rows[0].steep else "-"
    return [
        name,
        str(states),
        crossed_share,
        *(str(total(field)) for field in fields),
        f"{worst:.1e}",
        *(f"{figure:.0f}" for figure in seconds),
    ]


def _balls(balls: Enclosures) -> str:
    """The summary of the flights in balls."""
    if not balls.states:
        return ""
    lines = [
        f"balls: {balls.states} states, {balls.refused} refused, {balls.seconds:.3f} s a state",
        f"fixed steps against balls: {balls.agree} agree, {balls.disagree} do not; "
        f"largest relative error of a flight time {balls.worst_step:.1e}",
        f"largest error of a right hit in units of 10 kappa epsilon: flight time {balls.worst:.3g}, "
        f"velocity {balls.worst_velocity:.3g}",
        _estimate("error", balls.time),
        _estimate("velocity_error", balls.velocity),
    ]
    if balls.digits:
        lines.append(
            f"digits=20: {balls.digits} states, {balls.digits_wrong} wrong, {balls.digits_unresolved} unresolved, "
            f"{balls.digits_seconds:.3f} s a state"
        )
    return "\n".join(lines)


def _pairs(name: str, pairs: Pairs) -> str:
    """The summary of the states of steep or smooth families with 20 and with 40 digits."""
    if not pairs.states:
        return ""
    costs = "; ".join(
        f"digits={digits}: {1e3 * median:.0f} ms of CPU a unit of flight time, at most {1e3 * most:.0f}"
        for digits, (median, most) in ((20, pairs.seconds), (40, pairs.more_seconds))
    )
    return (
        f"digits=20 and digits=40: {pairs.states} {name} states, {pairs.enclosed} enclosed by both, "
        f"{pairs.misses} proved not to hit, {len(pairs.refused)} refused{_cases(pairs.refused)}, "
        f"{pairs.apart} with the truth outside a radius\n{costs}"
    )


def _cases(numbers: Sequence[int]) -> str:
    return f" (cases {', '.join(map(str, numbers[:9]))})" if numbers else ""


def _estimate(name: str, given: Estimate | None) -> str:
    if given is None:
        return f"`{name}`: flights have none"
    return (
        f"`{name}`: below the true error in {given.below} of {given.states} states, median of estimate/error "
        f"{given.median:.3g} (true errors below 2^-54 count as 2^-54)"
    )


def _cost(timed: dict[str, Cost]) -> str:
    """CPU time a family, and its ratio to steps chosen by their last terms."""
    cells = [
        [name, f"{figure.microseconds:.1f}", f"{figure.ratio:.2f}", f"{figure.agree:.2f}"]
        for name, figure in timed.items()
    ]
    note = "ratio: to steps chosen by their last two terms, in the same run, on the flights where both agree."
    return columns(["family", "first_hit, us a state", "ratio", "agree"], cells) + "\n" + note if cells else ""


def _listed(columns_: dict[str, np.ndarray[Any, Any]], seed: int) -> dict[str, dict[str, Any]]:
    """States of each kind that needs a look: how many, and calls that repeat some of them, or all the undecided."""
    import numpy as np

    from singimpact.bench.steep_states import drawn, wrong
    from singimpact.bench.truth.graded_steps import UNDECIDED
    from singimpact.status import Status

    kinds = {
        "wrong": wrong(columns_),
        "unresolved": columns_["status"] == Status.unresolved,
        "truth undecided": columns_["true_status"] == UNDECIDED,
    }
    listed: dict[str, dict[str, Any]] = {}
    for name, chosen in kinds.items():
        states = []
        places = chosen.nonzero()[0]
        if name != "truth undecided":
            places = places[np.unique(columns_["family"][places], return_index=True)[1]][:LISTED]
        for at in places.tolist():
            case = drawn(seed, int(columns_["case"][at]))
            states.append(
                {
                    "call": case.text(int(columns_["launch"][at])),
                    "flight_time": float(columns_["flight_time"][at]),
                    "true_time": float(columns_["true_time"][at]),
                }
            )
        listed[name] = {"states": int(chosen.sum()), "first": states}
    return listed


def _lines(name: str, part: dict[str, Any]) -> str:
    if not part["states"]:
        return ""
    lines = [
        f"  {state['call']}: {state['flight_time']:.10g}, truth {state['true_time']:.10g}" for state in part["first"]
    ]
    return "\n".join([f"{name}: {part['states']}, of which {len(lines)}:", *lines])
