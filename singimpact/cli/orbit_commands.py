"""Commands of single orbits: map, orbit, section, chatter, threshold, lyapunov."""

from pathlib import Path
from typing import Any

import click

import singimpact as si
from singimpact.cli.model_options import model_options, take_model, wall_option
from singimpact.cli.output import (
    PICTURES,
    columns,
    give,
    lines_of,
    number_text,
    output_options,
    state_options,
    whole_option,
)
from singimpact.inputs import InputError, refuse
from singimpact.status import Status, Wall
from singimpact.store import written

FIELDS = ("tau", "v", "flight_time", "status")


@click.command()
@model_options
@click.option("--tau", "taus", metavar="NUMBER", multiple=True, required=True, help="Launch phase; may be repeated.")
@click.option("--v", "vs", metavar="NUMBER", multiple=True, required=True, help="Launch velocity; may be repeated.")
@whole_option("--digits", 1, 10_000, "Significant digits.  [default: a double]")
@click.option("--horizon", metavar="NUMBER", help="Longest flight time that is searched.")
@wall_option
@output_options
def map_command(
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
    count = max(len(taus), len(vs))
    if min(len(taus), len(vs)) not in (1, count):
        raise InputError(
            f"{len(taus)} --tau and {len(vs)} --v do not pair: give one of each, or as many, or one of one kind"
        )
    states = list(zip(taus * (count // len(taus)), vs * (count // len(vs)), strict=True))
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
    give({"model": oscillator.to_dict(), "steps": steps}, _steps_table(states, rows, walls), as_json, output)


def _steps_table(states: list[tuple[str, str]], rows: list[list[Any]], walls: list[str] | None) -> str:
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


@click.command()
@model_options
@state_options
@whole_option("--impacts", 1, 10_000_000, "Number of impacts.", 200)
@click.option("--horizon", metavar="NUMBER", help="Longest flight time that is searched.")
@wall_option
@output_options
def orbit_command(
    tau: str,
    v: str,
    impacts: int,
    horizon: str | None,
    wall: str | None,
    as_json: bool,
    output: str | None,
    **options: str | None,
) -> None:
    """An orbit of the impact map: impacts, chatter, rest on the wall.

    With -o FILE.png (or .pdf, .svg) the orbit is drawn. Numbers may be expressions such as pi/2.8.
    """
    check_ending(output, as_json)
    oscillator = take_model(options)
    orbit = oscillator.orbit(tau, v, impacts=impacts, horizon=horizon, wall=wall)
    if output is not None and not as_json and Path(output).suffix.lower() in PICTURES:
        draw(orbit, output)
    else:
        listed = {"impacts": orbit.rows(), "phases": orbit.as_dict()["phases"]}
        give({"model": oscillator.to_dict(), **listed}, _table(orbit, listed), as_json, output)


def check_ending(output: str | None, as_json: bool) -> None:
    """Refuse a file name whose suffix is that of a picture format which is not written."""
    known = (".json", "") if as_json else (*PICTURES, ".txt", "")
    if output is not None and Path(output).suffix.lower() not in known:
        what = ".json" if as_json else ".png, .pdf or .svg for a picture, or in .txt for a table"
        raise refuse("output", output, f"a file name ending in {what}")


def draw(thing: Any, output: str) -> None:
    """The picture of an orbit or of a section, in the format its file name ends in."""
    import matplotlib

    matplotlib.use("Agg")
    from singimpact.dynamics.orbit import Orbit
    from singimpact.scenes import plot
    from singimpact.scenes.orbit_picture import orbit_sheet

    figure = orbit_sheet(thing) if isinstance(thing, Orbit) else plot(thing).figure
    with written(output) as draft:
        figure.savefig(draft, format=Path(output).suffix[1:].lower())


def _table(orbit: Any, listed: dict[str, Any]) -> str:
    names = ["tau", "v", *(["wall"] if orbit.wall is not None else []), "kind"]
    impacts = [[str(at), *(str(event[name]) for name in names)] for at, event in enumerate(listed["impacts"])]
    phases = [[p["kind"], str(p["start"]), str(p["end"])] for p in listed["phases"]]
    return columns(["", *names], impacts) + "\n\n" + columns(["phase", "from tau", "to tau"], phases)


@click.command()
@model_options
@state_options
@whole_option("--impacts", 1, 10_000_000, "Number of impacts.", 2000)
@click.option("--at", "at", metavar="NUMBER", default="0", show_default=True, help="Time after the start of a period.")
@whole_option("--skip", 0, 10_000_000, "Number of first states that are left out.", 0)
@output_options
def section_command(
    tau: str, v: str, impacts: int, at: str, skip: int, as_json: bool, output: str | None, **options: str | None
) -> None:
    """x and x' of an orbit once in each period of the forcing: a stroboscopic section.

    With -o FILE.png (or .pdf, .svg) the section is drawn. Numbers may be expressions such as pi/2.8.
    """
    check_ending(output, as_json)
    osc = take_model(options)
    section = osc.orbit(tau, v, impacts=impacts).section(at).after(skip)
    if output is not None and not as_json and Path(output).suffix.lower() in PICTURES:
        draw(section, output)
    else:
        text = columns(list(section.table()), [list(map(str, row.values())) for row in section.rows()])
        give({"model": osc.to_dict(), "at": at, **section.as_dict()}, text, as_json, output)


@click.command()
@model_options
@state_options
@whole_option("--digits", 1, 2000, "Significant digits.  [default: a double]")
@whole_option("--impacts", 1, 10_000_000, "Impacts at most.", 1_000_000)
@output_options
def chatter_command(
    tau: str, v: str, digits: int | None, impacts: int, as_json: bool, output: str | None, **options: str | None
) -> None:
    """The accumulation time of a chatter sequence, its error, and the impacts flown before a series gave the rest."""
    osc = take_model(options)
    end = osc.chatter_limit(tau, v, digits=digits, impacts=impacts)
    status = Status(int(end.status))
    enclosure = end.certified.as_dict() if end.certified else {}
    time, error = number_text(end.tau, digits), float(end.error)
    values = {"tau": time, "error": error, "impacts": end.impacts, **enclosure, "status": status.name}
    rows = {"tau": time, "error": f"{error:.1e}", **enclosure, "impacts": end.impacts}
    give({"model": osc.to_dict(), **values}, "\n".join(lines_of(rows, status)), as_json, output)


@click.command()
@model_options
@click.option("--tau", metavar="NUMBER", required=True, help="A phase with a_c < 0.")
@whole_option("--digits", 1, 2000, "Significant digits.  [default: a double]")
@whole_option("--impacts", 1, 10_000_000, "Impacts at most.", 640_000)
@wall_option
@output_options
def threshold_command(
    tau: str,
    digits: int | None,
    impacts: int,
    wall: str | None,
    as_json: bool,
    output: str | None,
    **options: str | None,
) -> None:
    """The velocity of gamma at tau: chatter completes below it, and is interrupted by lift-off above it.

    With two walls the status is other_wall where a flight meets the other one from a lower velocity on, which is given.
    """
    osc = take_model(options)
    limit = si.threshold(osc.seen_from(wall), tau, digits=digits, impacts=impacts)
    status = Status(int(limit.status))
    enclosure = limit.certified.as_dict() if limit.certified else {}
    speed, error = number_text(limit.v, digits), float(limit.error)
    values = {"v": speed, "error": error, "status": status.name, **enclosure}
    rows = {"v": speed, "error": f"{error:.1e}", **enclosure}
    text = "\n".join(lines_of(rows, status, (Status.complete,)))
    give({"model": osc.to_dict(), **values}, text, as_json, output)


# Of the result, in JSON.
SHOWN = ("exponents", "error", "per_impact", "impacts", "time", "superstable", "status", "transient", "converged")


@click.command()
@model_options
@state_options
@whole_option("--impacts", 1, 100_000_000, "Impacts used.", 10_000)
@whole_option("--transient", 0, 100_000_000, "Impacts flown before.  [default: until the orbit settles]")
@output_options
def lyapunov_command(
    tau: str, v: str, impacts: int, transient: int | None, as_json: bool, output: str | None, **options: str | None
) -> None:
    """Lyapunov exponents per unit of time and per impact, with standard errors.

    An orbit that comes to rest again and again is superstable: its exponents are -inf.
    """
    osc = take_model(options)
    result = si.lyapunov(osc, tau, v, impacts, transient=transient)
    status = Status(int(result.status))
    values = result.as_dict()
    numbers = {"exponents": result.exponents, "error": result.error, "per impact": result.per_impact}
    rows = {name: "  ".join(f"{value:.9g}" for value in values.tolist()) for name, values in numbers.items()}
    rows["impacts"] = f"{result.impacts} in a time of {result.time:.9g}, after {result.transient}"
    lines = lines_of(rows, status)
    if not result.converged:
        lines.append("not converged: the exponents of both halves differ, give more --impacts or a --transient")
    if result.superstable:
        lines.append("superstable")
    give({"model": osc.to_dict(), **{name: values[name] for name in SHOWN}}, "\n".join(lines), as_json, output)
