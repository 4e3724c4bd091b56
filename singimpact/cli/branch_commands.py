"""Commands of periodic orbits, of borders and of certificates: branch, events, border, certify."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

import singimpact as si
from singimpact import documents, scenes
from singimpact.branches.events import KINDS, PERIOD_DOUBLING
from singimpact.cli.model_options import (
    model_options,
    orbit_options,
    over_option,
    take_branches,
    take_ends,
    take_model,
    take_orbits,
)
from singimpact.cli.output import (
    as_json_text,
    choice_option,
    columns,
    csv_option,
    emit,
    give,
    picture_option,
    save,
    whole_option,
)
from singimpact.inputs import InputError, need
from singimpact.oscillator.moving_number import value_of
from singimpact.result import one_table
from singimpact.store import require_writable, write_table

if TYPE_CHECKING:
    from singimpact.branches.border import BorderOrbit
    from singimpact.branches.branch import Branch
    from singimpact.branches.event_curve import EventCurve
    from singimpact.branches.events import Event
    from singimpact.branches.orbits import PeriodicOrbit
    from singimpact.certificates.certificate import Certificate
    from singimpact.impact_oscillator import ImpactOscillator


@click.command()
@model_options
@orbit_options
@over_option
@click.option("--from", "low", metavar="NUMBER", help="Its least value.  [default: half of the model's value]")
@click.option("--to", "high", metavar="NUMBER", help="Its largest value.  [default: 1.5 times the model's]")
@whole_option("--points", 2, 1_000_000, "At most, each way.", 2000)
@choice_option("--height", ["v", "phase"], "Vertical axis of the picture.", "v")
@csv_option("branch, parameter, states, multipliers, ...")
@picture_option()
@click.option("--json", "as_json", is_flag=True, help="Give points and events as JSON.")
def branch_command(
    orbit: tuple[str, int],
    start: tuple[str, str] | None,
    over: str,
    height: str,
    csv: str | None,
    output: str | None,
    as_json: bool,
    **options: Any,
) -> None:
    """Follow orbits of N impacts, or of a word of walls, in K periods as a parameter changes.

    Prints folds, period doublings, tori, pitchforks, grazes and hidden impacts, and the end of each branch.
    """
    ends, points = take_ends(options.pop("low"), options.pop("high")), options.pop("points")
    model = take_model(options)
    branches = take_branches(take_orbits(model, orbit, start), over, ends, points)
    if csv is not None:
        write_table(csv, one_table({"branch": number, **branch.table()} for number, branch in enumerate(branches, 1)))
    if output is not None:
        save(si.plot(branches, scenes.new_axes(7.2, 4.8), height=height).figure, output)
    values = {"model": model.to_dict(), "over": over, "branches": [branch.as_dict() for branch in branches]}
    give(values, shown_branches(branches), as_json)


def shown_branches(branches: list[Branch]) -> str:
    """Branches as text: a table of events, then the end of each branch."""
    parts = []
    for number, branch in enumerate(branches, 1):
        ends = f"{branch.over} from {branch.parameter.min():.9g} to {branch.parameter.max():.9g}"
        parts.append(f"branch {number}: ({branch.impacts}, {branch.k}) orbits, {len(branch)} points, {ends}")
        rows = [
            [event.kind, f"{event.parameter:.15g}", *state(event.orbit), "" if event.orbit.visible else "virtual"]
            for event in branch.events
        ]
        if rows:
            parts.append(columns(["event", branch.over, "tau", "v", ""], rows))
        parts += [f"  {note}" for note in branch.notes]
    return "\n".join(parts)


def state(orbit: PeriodicOrbit) -> list[str]:
    """Phase and velocity of the weakest impact of an orbit, 12 digits."""
    weakest = min(range(len(orbit.v)), key=lambda i: float(orbit.v[i]))
    return [f"{float(orbit.tau[weakest]):.12g}", f"{float(orbit.v[weakest]):.12g}"]


NEAR = 0.05  # an event that is nearer to a step of a curve than this part of the step is on the curve
FOLLOWED = tuple(kind.name for kind in KINDS if kind.look is not None)


@click.command()
@model_options
@orbit_options
@click.option(
    "--over",
    nargs=2,
    metavar="A B",
    default=("clearance", "restitution"),
    show_default=True,
    help="Two parameters; the orbits are followed over A first.",
)
@click.option("--from", "low", nargs=2, metavar="A B", help="Their least values.  [default: half of the model's]")
@click.option("--to", "high", nargs=2, metavar="A B", help="Their largest values.")
@click.option(
    "--event", "kinds", type=click.Choice(FOLLOWED), multiple=True, help="Events of this kind.  [default: all]"
)
@whole_option("--index", 1, None, "Only the event with this number in the list of `branch`.")
@whole_option("--points", 2, 1_000_000, "At most, each way.", 1000)
@csv_option("curve, kind, both parameters, states, visible.")
@picture_option()
@click.option("--json", "as_json", is_flag=True, help="Give points and points of codimension two as JSON.")
def events_command(
    orbit: tuple[str, int],
    start: tuple[str, str] | None,
    over: tuple[str, str],
    kinds: tuple[str, ...],
    csv: str | None,
    output: str | None,
    as_json: bool,
    **options: Any,
) -> None:
    """Follow events of the orbits of N impacts in K periods as curves in the plane of two parameters.

    Prints the points of codimension two: resonant grazes, cusps, two grazes at once, and others.
    """
    ends, points = take_ends(options.pop("low"), options.pop("high")), options.pop("points")
    index = options.pop("index")
    model = take_model(options)
    both = None if ends is None else ((ends[0][0], ends[1][0]), (ends[0][1], ends[1][1]))
    branches = take_branches(take_orbits(model, orbit, start), over[0], None if both is None else both[0], 2000)
    chosen = choose(branches, kinds, index)

    curves: list[EventCurve] = []
    for event in chosen:
        if not any(on_curve(event, curve) for curve in curves):
            curves.append(si.event_curve(event, over, both, points=points))
    if csv is not None:
        tables = [{"curve": number, "kind": curve.kind, **curve.table()} for number, curve in enumerate(curves, 1)]
        write_table(csv, one_table(tables))
    if output is not None:
        save(si.plot(curves, scenes.new_axes(7.2, 4.8)).figure, output)
    values = {"model": model.to_dict(), "over": over, "curves": [curve.as_dict() for curve in curves]}
    give(values, shown_curves(curves), as_json)


def choose(branches: list[Branch], kinds: tuple[str, ...], index: int | None) -> list[Event]:
    """The events that the options name; the graze of an orbit without impact is that of the orbit with one.

    Raises
    ------
    InputError : there is none.
    """
    every = [event for branch in branches for event in branch.events]
    chosen = [
        event for number, event in enumerate(every, 1) if index in (None, number) and event.kind in (kinds or FOLLOWED)
    ]
    if not chosen:
        names = ", ".join(f"{number} {event.kind}" for number, event in enumerate(every, 1)) or "none"
        raise InputError(f"no such event: those of the branch are {names}; --from and --to make it longer")
    return [event if event.orbit.n else _with_impact(event, branches[0]) for event in chosen]


def _with_impact(event: Event, free: Branch) -> Event:
    """A graze of orbits without impact, on the branch of orbits with the impact that begins there."""
    ends = float(free.parameter.min()), float(free.parameter.max())
    same = [each for each in si.branch(event.others()[0], event.over, ends).events if each.described.at_impact]
    return min(same, key=lambda each: abs(each.parameter - event.parameter))


def on_curve(event: Event, curve: EventCurve) -> bool:
    """Whether an event is one of a curve's."""
    import numpy as np

    if (event.kind, event.orbit.n, event.orbit.k) != (curve.kind, curve.n, curve.k):
        return False
    # the two numbers and the least velocity, each in units of its range
    rows = np.column_stack([curve.parameters, curve.v.min(axis=1)])
    numbers = [event.parameter if name == event.over else value_of(event.orbit.oscillator, name) for name in curve.over]
    scale = np.maximum(np.ptp(rows, axis=0), 1e-300)
    scale[2] = np.abs(curve.v).max() or 1.0
    points, at = rows / scale, np.array([*numbers, float(np.min(event.orbit.v))]) / scale
    move = np.diff(points, axis=0)
    length = np.linalg.norm(move, axis=1) + 1e-300
    share = (((at - points[:-1]) * move).sum(axis=1) / length**2).clip(0, 1)
    gap = np.linalg.norm(points[:-1] + share[:, None] * move - at, axis=1)
    return bool((gap < NEAR * length).any())


def shown_curves(curves: list[EventCurve]) -> str:
    """Curves for people: special points as a table, then how each ends."""
    parts = []
    for number, curve in enumerate(curves, 1):
        parts.append(f"curve {number}: {curve.kind} of ({curve.impacts}, {curve.k}) orbits, {len(curve)} points")
        if curve.special:
            rows = [[point.kind, *map("{:.15g}".format, point.parameters)] for point in curve.special]
            parts.append(columns(["point", *curve.over], rows))
        parts += [f"  {note}" for note in curve.notes]
    return "\n".join(parts)


@click.command()
@model_options
@over_option
@click.option("--from", "low", metavar="NUMBER", help="Its least value; half of the model's value without it.")
@click.option("--to", "high", metavar="NUMBER", help="Its largest value; one and a half of the model's without it.")
@whole_option("--periods", 1, 1000, "Within which it returns.", 1)
@whole_option("--points", 2, 1_000_000, "Values looked at.", 200)
@click.option("--digits", type=int, metavar="N", help="Decimal digits, certified where r is a number.")
@click.option("--cascade", is_flag=True, help="Give edges and attractors beside each; -o does, too.")
@picture_option("The picture of the first one's cascade: .png, .pdf or .svg.")
@click.option("--json", "as_json", is_flag=True, help="Give them as JSON.")
def border_command(
    over: str,
    periods: int,
    points: int,
    digits: int | None,
    cascade: bool,
    output: str | None,
    as_json: bool,
    **options: str | None,
) -> None:
    """Border orbits: released at rest at a zero of a_c, back exactly on gamma of such a zero.

    There complete chatter becomes incomplete. Beside it the number of impacts changes at edges whose distances shrink
    by mu(r), with attractors between.
    """
    ends = take_ends(options.pop("low"), options.pop("high"))
    model = take_model(options)

    borders = si.border_orbits(model, over, ends, digits=digits, periods=periods, points=points)
    if output is not None:
        if not borders:
            raise InputError(f"no border orbit to draw: {'; '.join(borders.notes)}")
        save(_picture(borders[0]), output)
    if as_json:
        rows = [as_listed(border, cascade) for border in borders]
        click.echo(as_json_text({"model": model.to_dict(), "over": over, "orbits": rows, "notes": list(borders.notes)}))
    else:
        parts = [line for border in borders for line in shown_border(border, cascade)] or ["no border orbit found"]
        click.echo("\n".join([*parts, *(f"  {note}" for note in borders.notes)]))


def _picture(border: BorderOrbit) -> Any:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 5.2), dpi=150, layout="constrained")
    return scenes.draw_border(border, *figure.subplots(2, sharex=True, height_ratios=(3, 2))).figure


def as_listed(border: BorderOrbit, cascade: bool) -> dict[str, Any]:
    """A border orbit as JSON, with its cascade or without."""
    return border.as_dict() | ({"cascade": border.cascade.as_dict()} if cascade else {})


def shown_border(border: BorderOrbit, cascade: bool) -> list[str]:
    """A border orbit for people."""
    lines = [repr(border)[1:-1], *(f"  {note}" for note in border.notes)]
    if cascade:
        edges = border.cascade
        rows = []
        for i, number in enumerate(edges.impacts.tolist()):
            ratio = f"{float(edges.ratios[i]):.10f}" if i < len(edges.ratios) else ""
            orbit = edges.windows[i].orbit if i < len(edges.windows) else None
            size = name = ""
            if orbit is not None:
                size = f"{abs(complex(orbit.multipliers[0])):.4f}"
                name = f"({'inf' if orbit.kind == 'chatter' else int(orbit.n)}, {orbit.k})"
            rows.append([str(number), f"{float(edges.distance[i]):.6e}", ratio, name, size])
        names = ["impacts", "distance of the edge", "ratio to the next", "attractor", "multiplier"]
        lines += [repr(edges)[1:-1], columns(names, rows), *(f"  {note}" for note in edges.notes)]
    return lines


State = tuple[str, str] | None
# Kinds of events of a branch: those that the checker knows, as a test compares, then those refused in a sentence.
EVENTS = tuple(kind.name for kind in KINDS if kind.is_class)


@click.command()
@click.argument("files", metavar="[FILE.json]... | gamma [MODEL]", nargs=-1)
@model_options
@click.option("--tau", metavar="NUMBER", help="Launch time.")
@click.option("--v", metavar="NUMBER", help="Launch velocity, > 0.")
@click.option(
    "--orbit", type=(int, int), metavar="N K", help="An orbit of N impacts in K periods; --tau, --v: near it."
)
@click.option(
    "--doubling",
    type=(str, float, float),
    metavar="OVER LOW HIGH",
    help=f"As --event {PERIOD_DOUBLING.name} OVER LOW HIGH.",
)
@click.option(
    "--event",
    type=(click.Choice(EVENTS), str, float, float),
    metavar="KIND OVER LOW HIGH",
    help=f"With --orbit: the first event of its branch over a parameter, of the kind {', '.join(EVENTS)}.",
)
@click.option(
    "--border",
    type=(str, float, float),
    metavar="OVER LOW HIGH",
    help="The first orbit between two values that is released at a zero of a_c and accumulates at the next one.",
)
@click.option("--chatter", is_flag=True, help="The chatter limit from --tau, --v.")
@click.option(
    "--horseshoe",
    type=(int, int),
    metavar="N K",
    help="Beside a saddle of N impacts in K periods; --tau, --v: near it.",
)
@click.option(
    "--reach",
    metavar="NUMBER",
    help="With gamma: tan(omega_d T)/omega_d at most, T = tau_* - tau; T if nonlinear.  [default: as far as it gets]",
)
@click.option("--between", type=(str, str), metavar="LOW HIGH", help="With gamma or --horseshoe: for all restitutions.")
@whole_option("--digits", 1, 1000, "Significant digits.", 30)
@choice_option("--format", ["json", "coq"], "The certificate, or of linear models a file that coqc proves.", "json")
@click.option("-o", "--output", metavar="FILE", help="The certificate.  [default: standard output]")
def certify_command(files: tuple[str, ...], tau: str | None, v: str | None, **options: Any) -> None:
    """Enclose the impact from (tau, v), its chatter limit, a periodic orbit, an event of its branch, a border orbit or
    a horseshoe, and write a certificate; or check FILE.json ...

    `certify gamma MODEL.toml` (or the options of a linear model) proves gamma before the next zero of a_c after --tau:
    that it exists, is unique, and decides the fate of every launch; standard error says how far it got.

    A certificate is accepted by a second program, which imports python-flint alone, reads the model as text and
    encloses the motion again with its own code. With --format coq the first impact, or an orbit of one impact, is
    proved in Coq's real numbers instead, from the equation of motion: coqc and coq-interval accept the file.
    """
    from singimpact.certificates.certificate import read_certificate

    if files and files[0] == "gamma":
        _gamma(files[1:], tau, options)
        return
    if options["reach"] is not None or (options["between"] is not None and not options["horseshoe"]):
        raise InputError("--reach and --between are of gamma: give `certify gamma`; or --horseshoe N K with --between")
    if files:
        for path in files:
            emit(f"{path}: {read_certificate(path)!r} holds", None)
        return
    near = None if tau is None or v is None else (tau, v)
    kinds = [name for name in ("orbit", "border", "chatter", "horseshoe") if options[name]]
    if len(kinds) > 1:
        raise InputError(f"give one of --{kinds[0]} and --{kinds[1]}")
    if (options["event"] or options["doubling"]) and kinds != ["orbit"]:
        raise InputError("--event and --doubling are of an orbit: give --orbit N K")
    if near is None and kinds in ([], ["chatter"]):
        raise InputError(
            "give --tau and --v, or --orbit N K, --horseshoe N K or --border OVER LOW HIGH, for a new "
            "certificate; or the files to check"
        )
    if options["output"] is not None:
        require_writable(options["output"])
    certificate = _made(take_model(options), kinds[0] if kinds else "", near, options)
    text = certificate.text
    if options["format"] == "coq":
        text = documents.coq_flight(certificate.content, repr(certificate)[1:-1])
    certificate.check()
    emit(text.rstrip("\n"), options["output"])


def _gamma(files: tuple[str, ...], tau: str | None, options: dict[str, Any]) -> None:
    taken = [
        *(f"--{name}" for name in ("orbit", "border", "chatter", "horseshoe", "event", "doubling") if options[name]),
        *(["--format coq"] if options["format"] == "coq" else []),
    ]
    if len(files) > 1 or taken:
        raise InputError(f"certify gamma takes one model: {', '.join([*files[1:], *taken])} is not accepted")
    if options["output"] is not None:
        require_writable(options["output"])
    proof = take_model(options, *files).certified_gamma(tau, reach=options["reach"], restitution=options["between"])
    certificate = si.certify(proof)
    certificate.check()
    click.echo("\n".join([repr(proof)[1:-1], *proof.notes.values()]), err=True)
    emit(certificate.text.rstrip("\n"), options["output"])


def _made(model: ImpactOscillator, kind: str, near: State, options: dict[str, Any]) -> Certificate:
    digits = options["digits"]
    if kind == "":
        return si.certify(model.impact_map(*(near or ()), digits=digits))
    if kind == "chatter":
        return si.certify(model.chatter_limit(*(near or ()), digits=digits))
    if kind == "border":
        return si.certify(_border(model, options["border"], digits))
    if kind == "orbit":
        orbit = _orbit(model, kind, options[kind], near)
        wanted = options["event"] or ((PERIOD_DOUBLING.name, *options["doubling"]) if options["doubling"] else None)
        return si.certify((_event(orbit, *wanted) if wanted else orbit).certified(digits))
    crossings = si.homoclinic_points(_orbit(model, kind, options[kind], near, saddle=True))
    need(len(crossings), InputError("no homoclinic orbit of the saddle is found"))
    between = options["between"]
    return si.certify(crossings[0].horseshoes("restitution", between) if between else crossings[0].horseshoe())


def _border(model: ImpactOscillator, given: tuple[str, float, float], digits: int) -> BorderOrbit:
    over, low, high = given
    found = si.border_orbits(model, over=over, between=(low, high), digits=digits)
    need(found, InputError(f"--border {over} {low:g} {high:g}: no border orbit is found there"))
    return found[0]


def _event(orbit: PeriodicOrbit, kind: str, over: str, low: float, high: float) -> Event:
    """The first event of a kind, of visible orbits of a branch."""
    found = [each for each in si.branch(orbit, over, (low, high)).events if each.kind == kind and each.orbit.visible]
    need(found, InputError(f"--event {kind} {over} {low:g} {high:g}: no {kind} of visible orbits is found there"))
    return found[0]


def _orbit(
    model: ImpactOscillator, kind: str, counts: tuple[int, int], near: State, saddle: bool = False
) -> PeriodicOrbit:
    orbits = [each for each in model.periodic(*counts, start=near) if not (saddle and each.stable)]
    if len(orbits) != 1:
        kinds = "saddles" if saddle else "orbits"
        raise InputError(
            f"--{kind} {counts[0]} {counts[1]}: {len(orbits)} {kinds} are found; give --tau and --v near one"
        )
    return orbits[0]
