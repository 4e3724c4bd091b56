"""Commands that measure: bench, stress, selftest."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import astuple
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

import singimpact as si
from singimpact import bench
from singimpact.cli.model_options import model_options, take_model
from singimpact.cli.output import (
    as_json_text,
    choice_option,
    columns,
    emit,
    give,
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
    from singimpact.bench.measuring import Effort, Measured


# ---- the tables of `singimpact bench states`

COLUMNS = ("kind", "states", "crossed", "wrong", "unresolved", "truth undecided", "worst")
BY_SOLVER = "worst: largest error of a state that is not wrong, in units of 10 kappa epsilon."
BY_STEPS = (
    "wrong: relative error of a flight time above max(1e-9, 100 kappa epsilon), or another end of the flight.\n"
    "worst: largest error of a flight time that is not wrong, in units of this limit. crossed: flights through a layer."
)


def random_states(
    states: int, seed: int, workers: int | None, keep: str | None, family: str
) -> tuple[dict[str, Any], str, bool]:
    """Random states of a family, as data and as text, and whether one of them or a truth is wrong."""
    from singimpact.bench import random_states, steep_states
    from singimpact.case_pools import WorkerPool

    steep = family in ("steep", "parametric")
    with WorkerPool(workers) as pool:
        if steep:
            checked = steep_states.check(states, seed, pool, keep, family == "parametric")
        else:
            checked = random_states.check(states, seed, pool, keep, family)
    rows, listed = checked.rows(), checked.listed()
    cells = [[*map(str, astuple(row)[:-1]), f"{row.worst:.2g}"] for row in rows]
    lists = ["\n  ".join([f"{sort}, for example:", *texts]) for sort, texts in listed.items() if texts]
    text = "\n\n".join([f"{columns(COLUMNS, cells)}\n{BY_STEPS if steep else BY_SOLVER}", *lists])
    return checked.as_data(), text, any(row.wrong for row in rows)


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
@click.option("--store", is_flag=True, help="Store the ratios of the group limit in place of those of the package.")
@output_options
def bench_command(
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
    as_json: bool,
    output: str | None,
) -> None:
    """Measure CPU times and compare them with other tools.

    The groups are public, chatter, series, regions, ensemble, fit, limit.

    The default is all but public, which has twelve calls beside loops of numba (with --quick without limit).

    The group `limit` compares public calls with a reference computation of the same run; the exit code is 1 if a ratio
    is more than half above its stored one.

    The group `states` compares random states with a slow solver of 60 digits; --states, --seed, --workers and
    --keep belong to it. With `--family steep` it compares 20 families of steep models with a solver of small fixed
    steps, with `--family parametric` four in whose f t occurs or that have no t at all.
    `--family between-walls` has the solver of 60 digits for models with two walls, `--family plastic`
    for releases from rest with restitution 0. The exit code is 1 if an impact is wrong.
    """
    effort = bench.QUICK if quick else bench.FULL
    if form == "page" and groups:
        raise InputError(f"--format page is not accepted with {', '.join(groups)}: the page has the group public alone")
    chosen = ["public"] if form == "page" else list(dict.fromkeys(groups)) or bench.usual(effort)
    require_known("group", chosen, (*bench.GROUPS, "states"))
    if store and "limit" not in chosen:
        raise InputError(
            f"--store is not accepted with {', '.join(chosen)}: give the group limit, whose ratios it keeps"
        )
    directory = None if plots is None else folder(plots)
    tables = _measured([group for group in chosen if group != "states"], effort)
    values = {"quick": quick, **_joined(tables)}
    texts = [_page(tables[0], output)] if form == "page" else [_text(table, form) for table in tables]
    wrong = _is_over(tables, store)
    if "states" in chosen:
        values["states"], text, states_wrong = random_states(states, seed, workers, keep, family)
        wrong |= states_wrong
        texts.append(text)
    if directory is not None:
        for table in tables:
            save(bench.plotted(table), directory / f"bench-{table.group}.png")
    emit(as_json_text(values) if as_json else "\n\n".join(texts), output)
    if wrong:
        sys.exit(1)


def _measured(chosen: list[str], effort: Effort) -> list[Measured]:
    with ProgressLine() as line:
        return [
            bench.measured(name, effort, lambda text, at=at: line.show(at, len(chosen), text))  # type: ignore[misc]
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
    parts = [bench.as_data(each) for each in found]
    return {
        "rows": [row for part in parts for row in part["rows"]],
        "skipped": sorted({name for part in parts for name in part["skipped"]}),
        "growth": [power for part in parts for power in part["growth"]],
    }


def _page(public: Measured, output: str | None) -> str:
    """The page of the documentation; its numbers and its picture are written beside it."""
    from singimpact.bench.page import as_csv, page, table

    if output is not None:
        write_text(Path(output).with_suffix(".csv"), as_csv(public.rows))
        save(bench.plotted(public), Path(output).with_suffix(".png"))
    command = ["git", "-C", str(Path(__file__).parent), "rev-parse", "HEAD"]
    answer = subprocess.run(command, capture_output=True, text=True, check=False)
    return page(markdown(*table(public.rows)), answer.stdout.strip() or "unknown")


def _text(found: Measured, form: str) -> str:
    from singimpact.bench.report import NOTE, growth, reached, skipped, table

    laid_out = columns if form == "text" else markdown
    parts = [found.group if form == "text" else f"## {found.group}", laid_out(*table(found)), skipped(found)]
    if any(row.wrong is not None for row in found.rows):
        parts.append(NOTE)
    powers = [f"{case}: {method} takes a time like n^{power:.2f}" for case, method, power in growth(found)]
    parts += ["\n".join(powers), reached(found)]
    return "\n\n".join(part for part in parts if part)


@click.command()
@click.argument("functions", metavar="[FUNCTION]...", nargs=-1)
@click.option("--place", "limit", metavar="PLACE", help="One row of the table alone, such as 'a -> 0'.")
@click.option("--quick", is_flag=True, help="Fewer points in every sequence.")
@page_format()
@output_options
def stress_command(
    functions: tuple[str, ...], limit: str | None, quick: bool, form: str, as_json: bool, output: str | None
) -> None:
    """The largest error of every public numerical function near its singular points, compared with 60 digits.

    The exit code is 1 if an error exceeds 100 units of condition times epsilon, or a status is wrong.
    """
    from singimpact.bench.stress.table import NOTE, POINTS, QUICK, as_data, chosen, stressed, table, worst_states

    pairs = chosen(functions, limit)
    with ProgressLine() as line:
        cells = stressed(pairs, QUICK if quick else POINTS, lambda done, text: line.show(done, len(pairs), text))
    laid_out = columns if form == "text" else markdown
    text = "\n\n".join([laid_out(*table(cells)), NOTE, laid_out(*worst_states(cells))])
    if form == "page":
        text = bench.stress_page(text)
    emit(as_json_text({"quick": quick, "cells": as_data(cells)}) if as_json else text, output)
    if any(cell.failed for cell in cells):
        sys.exit(1)


@click.command()
@click.argument("file", metavar="[MODEL]", required=False)
@model_options
@whole_option("--states", 1, 10**6, "Number of states.", 1000)
@whole_option("--seed", 0, None, "Seed of the random states.", 0)
@output_options
def selftest_command(
    file: str | None, states: int, seed: int, as_json: bool, output: str | None, **options: str | None
) -> None:
    """Fly random states of a model forward and back, against small fixed steps, with more digits and in balls; try its
    orbits, chatter limits, basins and tangency points.

    MODEL is a TOML file, as for --model. The exit code is 1 if a result is wrong.
    """
    osc = take_model(options, file)

    report = si.selftest(osc, states=states, seed=seed)
    give({"model": osc.to_dict(), **report.as_data()}, str(report), as_json, output)
    if report.wrong:
        sys.exit(1)
