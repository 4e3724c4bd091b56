"""`singimpact bench`: run time against error, compared with other programs that a user could take."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from singimpact.cli.output import (
    as_json_text,
    choice_option,
    columns,
    emit,
    markdown,
    output_options,
    page_format,
    save,
    whole_option,
)
from singimpact.inputs import InputError, require_known
from singimpact.progress import ProgressLine
from singimpact.store import folder, write_text

if TYPE_CHECKING:
    import numpy as np

    from singimpact.bench.measuring import Effort, Measured
    from singimpact.bench.steep_balls import Enclosures, Estimate
    from singimpact.bench.steep_digits import Pairs
    from singimpact.bench.steep_states import Row

LISTED = 5  # states of each kind that are written out, each of another family
TIMES = ("seconds", "true_seconds")
COUNTS = ("states", "crossed", "wrong", "unresolved", "unresolved_steep", "undecided")


# ---- the tables of `singimpact bench states --family steep`


def steep_states(
    states: int, seed: int, workers: int | None, keep: str | None, balls: tuple[int, int, int], parametric: bool
) -> tuple[dict[str, Any], str, bool]:
    """Random steep states and some of them in balls, as data and as text, and whether a flight is wrong.

    Parameters
    ----------
    balls : states in balls, how many of these with `digits=20`, and how many steep states with 20 and with 40 digits.
    parametric : fly the families in whose f t occurs, in place of the steep ones.
    """
    from singimpact.bench import steep_balls, steep_digits, steep_states
    from singimpact.case_pools import WorkerPool

    beside = None if keep is None else Path(keep).with_name(f"{Path(keep).stem}-balls.npz")
    with WorkerPool(workers) as pool:
        checked = steep_states.check(states, seed, pool, keep, parametric)
        enclosures = steep_balls.check(checked, balls[:2], seed, pool, beside)
        pairs = steep_digits.check(balls[2], seed, pool)
    rows = steep_states.rows(checked)
    listed = _listed(checked, seed)
    data = {
        "families": [asdict(row) for row in rows],
        "balls": asdict(enclosures),
        "pairs": {"steep": asdict(pairs)},
        "listed": listed,
    }
    parts = [
        _table(rows),
        _balls(enclosures),
        _pairs(pairs),
        *(_lines(name, table) for name, table in listed.items()),
    ]
    # a flight, an estimate of its error, or the truth itself
    below = any(value is not None and value.below for value in (enclosures.time, enclosures.velocity))
    wrong = enclosures.disagree or enclosures.digits_wrong or below or pairs.apart or any(row.wrong for row in rows)
    return data, "\n\n".join(table for table in parts if table), bool(wrong)


def _table(rows: Sequence[Row]) -> str:
    header = (
        "family|states|crossed|wrong|unresolved, K <= 1e3|above|truth undecided|worst error|us a state|of the truth"
    )
    cells = []
    for kind in (True, False):
        kin = [row for row in rows if row.steep == kind]
        cells += [_cells(row) for row in kin]
        if kin:
            cells.append(_cells(_total("all steep" if kind else "all smooth", kin)))
    note = (
        "wrong: relative error of a flight time above max(1e-9, 100 kappa epsilon), or another end of the flight.\n"
        "worst error: largest relative error of a flight time that is not wrong. crossed: part of the flights."
    )
    return columns(header.split("|"), cells) + "\n" + note


def _cells(row: Row) -> list[str]:
    crossed = f"{row.crossed / row.states:.2f}" if row.steep else "-"
    counts = row.wrong, row.unresolved, row.unresolved_steep, row.undecided
    times = row.seconds, row.true_seconds
    shown = [*map(str, counts), f"{row.worst_error:.1e}", *(f"{1e6 * seconds:.0f}" for seconds in times)]
    return [row.family, str(row.states), crossed, *shown]


def _total(name: str, rows: Sequence[Row]) -> Row:
    """All states of some families as those of one."""
    sums = {field: sum(getattr(row, field) for row in rows) for field in COUNTS}
    means = {field: sum(getattr(row, field) * row.states for row in rows) / sums["states"] for field in TIMES}
    return replace(rows[0], family=name, worst_error=max(row.worst_error for row in rows), **sums, **means)


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


def _pairs(pairs: Pairs) -> str:
    """The summary of the steep states with 20 and with 40 digits."""
    if not pairs.states:
        return ""
    costs = "; ".join(
        f"digits={digits}: {1e3 * median:.0f} ms of CPU a unit of flight time, at most {1e3 * most:.0f}"
        for digits, (median, most) in ((20, pairs.seconds), (40, pairs.more_seconds))
    )
    cases = f" (cases {', '.join(map(str, pairs.refused[:9]))})" if pairs.refused else ""
    return (
        f"digits=20 and digits=40: {pairs.states} steep states, {pairs.enclosed} enclosed by both, "
        f"{pairs.misses} proved not to hit, {len(pairs.refused)} refused{cases}, "
        f"{pairs.apart} with the truth outside a radius\n{costs}"
    )


def _estimate(name: str, given: Estimate | None) -> str:
    if given is None:
        return f"`{name}`: flights have none"
    return (
        f"`{name}`: below the true error in {given.below} of {given.states} states, median of estimate/error "
        f"{given.median:.3g} (true errors below 2^-54 count as 2^-54)"
    )


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


@click.command()
@click.argument("groups", metavar="[GROUP]...", nargs=-1)
@click.option("--quick", is_flag=True, help="Fewer cases, states and rounds, within two minutes.")
@click.option("--plots", metavar="DIR", help="Write a picture of time against error for each group into this folder.")
@page_format(", of the group public, with a .csv and a .png beside it")
@whole_option("--states", 1, 10**9, "How many states.", 100_000)
@whole_option("--seed", 0, None, "Seed of the random states.", 0)
@whole_option("--workers", 1, 1024, "Processes.  [default: one for each core]")
@click.option("--keep", metavar="FILE.npz", help="Store results in this file, and resume from it.")
@choice_option(
    "--family",
    ["reference", "steep", "parametric", "between-walls", "plastic"],
    "Of random states: linear and cubic, steep layers, f with t, linear and cubic between two walls, or at rest.",
    "reference",
)
@whole_option("--balls", 0, None, "Steep states flown in balls.", 1000)
@whole_option("--digits-checks", 0, None, "States in balls that are also flown with digits=20.", 100)
@whole_option("--digit-pairs", 0, None, "Steep states enclosed twice, with digits=20 and digits=40.", 200)
@click.option("--store", is_flag=True, help="Store the ratios of the group limit in place of those of the package.")
@output_options
def command(
    groups: tuple[str, ...],
    quick: bool,
    store: bool,
    plots: str | None,
    form: str,
    states: int,
    seed: int,
    workers: int | None,
    keep: str | None,
    family: str,
    balls: int,
    digits_checks: int,
    digit_pairs: int,
    as_json: bool,
    output: str | None,
) -> None:
    """Measure CPU times and compare them with other tools. The groups are public, chatter, series, ensemble, limit.

    The default is all but public, which has twelve calls beside loops of numba (with --quick without limit).

    The group `limit` compares public calls with a reference computation of the same run; the exit code is 1 if a ratio
    is more than half above its stored one.

    The group `states` compares random states with a slow solver of 60 digits; --states, --seed, --workers and
    --keep belong to it. With `--family steep` it compares 20 families of steep models with a solver of small fixed
    steps, with `--family parametric` four in whose f t occurs or that have no t at all, and --balls of the states with
    ball arithmetic; --digit-pairs states are enclosed twice. `--family between-walls` has the solver of 60 digits for
    models with two walls, `--family plastic` for releases from rest with restitution 0. The exit code is 1 if an
    impact is wrong.
    """
    from singimpact.bench.groups import GROUPS, usual
    from singimpact.bench.measuring import FULL, QUICK

    effort = QUICK if quick else FULL
    if form == "page" and groups:
        raise InputError(f"--format page is not accepted with {', '.join(groups)}: the page has the group public alone")
    chosen = ["public"] if form == "page" else list(dict.fromkeys(groups)) or usual(effort)
    require_known("group", chosen, (*GROUPS, "states"))
    if store and "limit" not in chosen:
        raise InputError(
            f"--store is not accepted with {', '.join(chosen)}: give the group limit, whose ratios it keeps"
        )
    directory = None if plots is None else folder(plots)
    tables = _measured([group for group in chosen if group != "states"], effort)
    values = {"quick": quick, **_joined(tables)}
    texts = [_page(tables[0], output)] if form == "page" else [_text(table, form) for table in tables]
    wrong = _is_over(tables, store)
    if "states" in chosen and family in ("steep", "parametric"):
        sizes, parametric = (balls, digits_checks, digit_pairs), family == "parametric"
        values["states"], text, found_wrong = steep_states(states, seed, workers, keep, sizes, parametric)
        wrong |= found_wrong
        texts.append(text)
    elif "states" in chosen:
        values["states"], text = _states(states, seed, workers, keep, family)
        wrong |= any(row["wrong"] for row in values["states"])
        texts.append(text)
    if directory is not None:
        from singimpact.bench.report import plotted

        for table in tables:
            save(plotted(table), directory / f"bench-{table.group}.png")
    emit(as_json_text(values) if as_json else "\n\n".join(texts), output)
    if wrong:
        sys.exit(1)


def _measured(chosen: list[str], effort: Effort) -> list[Measured]:
    from singimpact.bench.groups import measured

    with ProgressLine() as line:
        return [
            measured(name, effort, lambda text, at=at: line.show(at, len(chosen), text))  # type: ignore[misc]
            for at, name in enumerate(chosen)
        ]


def _is_over(tables: list[Measured], store: bool) -> bool:
    """Whether a ratio of the group limit is too large, each with a line on stderr; or store the ratios."""
    from singimpact.bench.groups import limit_rows

    rows = [row for table in tables if table.group == "limit" for row in table.rows]
    if store:
        limit_rows.store(rows)
    lines = limit_rows.over(rows)
    for line in lines:
        click.echo(line, err=True)
    return bool(lines)


def _joined(found: list[Measured]) -> dict[str, Any]:
    """One list of rows and of skipped peers for all groups."""
    from singimpact.bench.report import as_data

    parts = [as_data(each) for each in found]
    return {
        "rows": [row for part in parts for row in part["rows"]],
        "skipped": sorted({name for part in parts for name in part["skipped"]}),
    }


def _page(public: Measured, output: str | None) -> str:
    """The page of the documentation; its numbers and its picture are written beside it."""
    from singimpact.bench.page import as_csv, page, table
    from singimpact.bench.report import plotted

    if output is not None:
        write_text(Path(output).with_suffix(".csv"), as_csv(public.rows))
        save(plotted(public), Path(output).with_suffix(".png"))
    command = ["git", "-C", str(Path(__file__).parent), "rev-parse", "HEAD"]
    answer = subprocess.run(command, capture_output=True, text=True, check=False)
    return page(markdown(*table(public.rows)), answer.stdout.strip() or "unknown")


def _text(found: Measured, form: str) -> str:
    from singimpact.bench.report import NOTE, reached, skipped, table

    laid_out = columns if form == "text" else markdown
    parts = [found.group if form == "text" else f"## {found.group}", laid_out(*table(found)), skipped(found)]
    if any(row.wrong is not None for row in found.rows):
        parts.append(NOTE)
    parts.append(reached(found))
    return "\n\n".join(part for part in parts if part)


def _states(
    states: int, seed: int, workers: int | None, keep: str | None, family: str
) -> tuple[list[dict[str, Any]], str]:
    """Random states against the truth."""
    from singimpact.bench.random_states import check
    from singimpact.case_pools import WorkerPool

    with WorkerPool(workers) as pool:
        rows = check(states, seed, pool, keep, family)
    header = ["states", "flown", "wrong", "unresolved", "flight time, worst", "v, worst"]
    cells = [
        [
            row.kind,
            str(row.states),
            str(row.wrong),
            str(row.unresolved),
            f"{row.time_error:.3f}",
            f"{row.velocity_error:.3f}",
        ]
        for row in rows
    ]
    text = columns(header, cells) + "\nErrors in units of max(1e-14, 10 kappa epsilon), for v of 1e-13."
    for row in rows:
        for tau, v, depth, bound in row.open:
            text += f"\nunresolved, {row.kind}: tau {tau!r}, v {v!r}, depth {depth:.3g}, known to {bound:.3g}"
    return [asdict(row) for row in rows], text
