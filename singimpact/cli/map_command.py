"""`singimpact map`: from an impact to the next one."""

from typing import Any

import click

from singimpact.cli.model_options import model_options, take_model, wall_option
from singimpact.cli.output import columns, give, number_text, output_options, whole_option
from singimpact.inputs import InputError
from singimpact.status import Status, Wall

FIELDS = ("tau", "v", "flight_time", "status")


@click.command()
@model_options
@click.option("--tau", "taus", metavar="NUMBER", multiple=True, required=True, help="Launch phase; may be repeated.")
@click.option("--v", "vs", metavar="NUMBER", multiple=True, required=True, help="Launch velocity; may be repeated.")
@whole_option("--digits", 1, 10_000, "Significant digits.  [default: a double]")
@click.option("--horizon", metavar="NUMBER", help="Longest flight time that is searched.")
@wall_option
@output_options
def command(
    taus: tuple[str, ...],
    vs: tuple[str, ...],
    digits: int | None,
    horizon: str | None,
    wall: str | None,
    as_json: bool,
    output: str | None,
    **options: str | None,
) -> None:
    """The impact map G: phase and velocity of the next impact, the flight time, and the status of the flight.

    Numbers may be expressions such as pi/2.8.
    """
    oscillator = take_model(options)
    states = _paired(taus, vs)
    keywords: dict[str, Any] = {"digits": digits, "horizon": horizon, "wall": wall}
    step = oscillator.impact_map(
        [tau for tau, _ in states], [v for _, v in states], **{key: value for key, value in keywords.items() if value}
    )
    rows: list[list[Any]] = []
    steps: list[dict[str, Any]] = []
    walls = None if step.wall is None else [Wall(code).name for code in step.wall]
    for at, (tau, v) in enumerate(states):
        numbers = [number_text(getattr(step, name)[at], digits) for name in FIELDS[:3]]
        status = Status(int(step.status[at]))
        rows.append([*numbers, status])
        steps.append({"from": {"tau": tau, "v": v}} | dict(zip(FIELDS, [*numbers, status.name], strict=True)))
        if digits is not None:
            impact = step.certified[at]
            without = {"certified": None, "note": step.notes.get(at, "")}
            steps[at] |= without if impact is None else {"certified": impact.as_dict()}
        if walls is not None:
            steps[at]["wall"] = walls[at]
    give({"model": oscillator.to_dict(), "steps": steps}, _table(states, rows, walls), as_json, output)


def _paired(taus: tuple[str, ...], vs: tuple[str, ...]) -> list[tuple[str, str]]:
    count = max(len(taus), len(vs))
    if min(len(taus), len(vs)) not in (1, count):
        raise InputError(
            f"{len(taus)} --tau and {len(vs)} --v do not pair: give one of each, or as many, or one of one kind"
        )
    return list(zip(taus * (count // len(taus)), vs * (count // len(vs)), strict=True))


def _table(states: list[tuple[str, str]], rows: list[list[Any]], walls: list[str] | None) -> str:
    header = ["tau", "v", "flight time", "next tau", "next v", "status"] + ["next wall"] * (walls is not None)
    cells = [
        [*state, str(time), str(tau), str(v), status.name, *wall]
        for state, (tau, v, time, status), wall in zip(
            states, rows, [[]] * len(rows) if walls is None else [[name] for name in walls], strict=True
        )
    ]
    notes = [
        f"{status.name}: {status.sentence}" for status in sorted({row[3] for row in rows}) if status is not Status.hit
    ]
    return "\n".join([columns(header, cells), *notes])
