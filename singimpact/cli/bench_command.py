"""`singimpact bench`: run time against error, compared with other programs that a user could take."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from singimpact.cli.output import as_json_text, columns, emit, markdown, output_options, save
from singimpact.cli.steep import steep_states
from singimpact.inputs import unknown
from singimpact.progress import ProgressLine
from singimpact.store import folder

if TYPE_CHECKING:
    from singimpact.bench.measuring import Effort, Measured


@click.command()
@click.argument("groups", metavar="[GROUP]...", nargs=-1)
@click.option("--quick", is_flag=True, help="Fewer cases, states and rounds, within two minutes.")
@click.option("--plots", metavar="DIR", help="Write a picture of time against error for each group into this folder.")
@click.option("--picture", type=click.Choice(["png", "pdf", "svg"]), default="png", show_default=True)
@click.option(
    "--format",
    "form",
    type=click.Choice(["text", "markdown", "page"]),
    default="text",
    show_default=True,
    help="`page` writes the page of the documentation, with the pictures of --plots.",
)
@click.option("--states", type=click.IntRange(1, 10**9), default=100_000, show_default=True, help="How many states.")
@click.option("--seed", type=click.IntRange(0), default=0, show_default=True, help="Seed of the random states.")
@click.option("--workers", type=click.IntRange(1, 1024), help="Processes.  [default: one for each core]")
@click.option("--keep", metavar="FILE.npz", help="Store results in this file, and resume from it.")
@click.option(
    "--family",
    type=click.Choice(["reference", "steep"]),
    default="reference",
    show_default=True,
    help="Of random states: linear and cubic, or steep layers.",
)
@click.option("--balls", type=click.IntRange(0), default=1000, show_default=True, help="Steep states flown in balls.")
@click.option(
    "--digits-checks",
    type=click.IntRange(0),
    default=100,
    show_default=True,
    help="States in balls that are also flown with digits=20.",
)
@click.option(
    "--digit-pairs",
    type=click.IntRange(0),
    default=200,
    show_default=True,
    help="Steep states enclosed twice, with digits=20 and digits=40.",
)
@click.option(
    "--smooth-pairs",
    type=click.IntRange(0),
    default=0,
    show_default=True,
    help="Smooth states enclosed twice, as well.",
)
@output_options
def command(
    groups: tuple[str, ...],
    quick: bool,
    plots: str | None,
    picture: str,
    form: str,
    states: int,
    seed: int,
    workers: int | None,
    keep: str | None,
    family: str,
    balls: int,
    digits_checks: int,
    digit_pairs: int,
    smooth_pairs: int,
    as_json: bool,
    output: str | None,
) -> None:
    """Measure CPU times and compare them with other tools. The groups are map, orbit, regimes, chatter, threshold,
    series, fixed-points, emitted, figures, growth, commands, sweep, scale, branches, start. The default is all of
    them (with --quick all but the last).

    The group `states` compares random states with a slow solver of 60 digits; --states, --seed, --workers and
    --keep belong to it. With `--family steep` it compares 20 families of steep models with a solver of small fixed
    steps, and --balls of the states with ball arithmetic; --digit-pairs and --smooth-pairs states are enclosed
    twice. --quick omits the run times. The exit code is 1 if an impact is wrong.
    """
    from singimpact.bench.groups import GROUPS, usual
    from singimpact.bench.measuring import FULL, QUICK

    effort = QUICK if quick else FULL
    chosen = list(dict.fromkeys(groups)) or usual(effort)
    for group in chosen:
        if group not in (*GROUPS, "states"):
            raise unknown("group", group, (*GROUPS, "states"))
    directory = None if plots is None else folder(plots)
    tables = _measured([group for group in chosen if group != "states"], effort)
    values = {"quick": quick, **_joined(tables)}
    texts = _page(tables, directory, picture, output) if form == "page" else [_text(table, form) for table in tables]
    wrong = False
    if "states" in chosen and family == "steep":
        steep = steep_states(states, seed, workers, keep, (balls, digits_checks, digit_pairs, smooth_pairs), not quick)
        values["states"], wrong = steep.data, steep.wrong
        texts.append(steep.text)
    elif "states" in chosen:
        values["states"], text = _states(states, seed, workers, keep)
        wrong = any(row["wrong"] for row in values["states"])
        texts.append(text)
    if directory is not None:
        _draw(tables, directory, picture)
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


def _joined(found: list[Measured]) -> dict[str, Any]:
    """One list of rows, of exponents and of skipped peers for all groups."""
    from singimpact.bench.report import as_data

    parts = [as_data(each) for each in found]
    joined: dict[str, Any] = {
        key: [item for part in parts for item in part[key]] for key in ("rows", "exponents", "notes")
    }
    return {**joined, "skipped": sorted({name for part in parts for name in part["skipped"]})}


def _page(found: list[Measured], place: Path | None, picture: str, output: str | None) -> list[str]:
    """The page of the documentation; pictures are linked from where it is written."""
    from singimpact.bench.page import page

    link = None
    if place is not None:
        beside = Path(output).resolve().parent if output is not None else Path.cwd()
        link = Path(os.path.relpath(place.resolve(), beside)).as_posix() + f"/bench-{{}}.{picture}"
    return [page([(each.group, _text(each, "page")) for each in found], link)]


def _text(found: Measured, form: str) -> str:
    from singimpact.bench.report import NOTE, reached, skipped, tables

    laid_out = columns if form == "text" else markdown
    heading = {"text": found.group, "markdown": f"## {found.group}"}.get(form, "")
    parts = [heading, *(laid_out(header, cells) for header, cells in tables(found)), skipped(found)]
    if any(row.wrong is not None for row in found.rows):
        parts.append(NOTE)
    parts += [reached(found), "\n".join(found.notes)]
    return "\n\n".join(part for part in parts if part)


def _draw(found: list[Measured], place: Path, picture: str) -> None:
    from singimpact.bench.report import plotted

    for each in found:
        save(plotted(each), place / f"bench-{each.group}.{picture}")


def _states(states: int, seed: int, workers: int | None, keep: str | None) -> tuple[list[dict[str, Any]], str]:
    """Random states against the truth."""
    from dataclasses import asdict

    from singimpact.bench.random_states import check
    from singimpact.case_pools import WorkerPool

    with WorkerPool(workers) as pool:
        rows = check(states, seed, pool, keep)
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
