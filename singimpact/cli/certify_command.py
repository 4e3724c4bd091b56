"""`singimpact certify`: results with their certificates, and certificates that are checked."""

from typing import Any

import click

from singimpact.branches.events import KINDS, PERIOD_DOUBLING
from singimpact.cli.model_options import model_options, take_model
from singimpact.cli.output import emit, whole_option
from singimpact.inputs import InputError
from singimpact.store import require_writable

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
@click.option("--between", type=(str, str), metavar="LOW HIGH", help="With gamma: for all restitutions of an interval.")
@whole_option("--digits", 1, 1000, "Significant digits.", 30)
@click.option("-o", "--output", metavar="FILE.json", help="The certificate.  [default: standard output]")
def certify_command(files: tuple[str, ...], tau: str | None, v: str | None, **options: Any) -> None:
    """Enclose the impact from (tau, v), its chatter limit, a periodic orbit, an event of its branch, a border orbit or
    a horseshoe, and write a certificate; or check FILE.json ...

    `certify gamma MODEL.toml` (or the options of a linear model) proves gamma before the next zero of a_c after --tau:
    that it exists, is unique, and decides the fate of every launch; standard error says how far it got.

    A certificate is accepted by a second program, which imports python-flint alone, reads the model as text and
    encloses the motion again with its own code.
    """
    from singimpact.certificates.certificate import read_certificate

    if files and files[0] == "gamma":
        _gamma(files[1:], tau, options)
        return
    if options["reach"] is not None or options["between"] is not None:
        raise InputError("--reach and --between are of gamma: give `certify gamma`")
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
    certificate.check()
    emit(certificate.text.rstrip("\n"), options["output"])


def _gamma(files: tuple[str, ...], tau: str | None, options: dict[str, Any]) -> None:
    """`certify gamma [MODEL]`."""
    from singimpact.certificates.certificate import certify

    taken = [f"--{name}" for name in ("orbit", "border", "chatter", "horseshoe", "event", "doubling") if options[name]]
    if len(files) > 1 or taken:
        raise InputError(f"certify gamma takes one model: {', '.join([*files[1:], *taken])} is not accepted")
    if options["output"] is not None:
        require_writable(options["output"])
    proof = take_model(options, *files).certified_gamma(tau, reach=options["reach"], restitution=options["between"])
    certificate = certify(proof)
    certificate.check()
    click.echo("\n".join([repr(proof)[1:-1], *proof.notes.values()]), err=True)
    emit(certificate.text.rstrip("\n"), options["output"])


def _made(model: Any, kind: str, near: State, options: dict[str, Any]) -> Any:
    from singimpact.branches.homoclinic import homoclinic_points
    from singimpact.certificates.certificate import certify

    digits = options["digits"]
    if kind == "":
        return certify(model.impact_map(*(near or ()), digits=digits))
    if kind == "chatter":
        return certify(model.chatter_limit(*(near or ()), digits=digits))
    if kind == "border":
        return certify(_border(model, options["border"], digits))
    if kind == "orbit":
        orbit = _orbit(model, kind, options[kind], near)
        wanted = options["event"] or ((PERIOD_DOUBLING.name, *options["doubling"]) if options["doubling"] else None)
        return certify((_event(orbit, *wanted) if wanted else orbit).certified(digits))
    crossings = homoclinic_points(_orbit(model, kind, options[kind], near, saddle=True))
    if not len(crossings):
        raise InputError("no homoclinic orbit of the saddle is found")
    return certify(crossings[0].horseshoe())


def _border(model: Any, given: tuple[str, float, float], digits: int) -> Any:
    """The first border orbit between two values."""
    from singimpact.branches.border import border_orbits

    over, low, high = given
    found = border_orbits(model, over=over, between=(low, high), digits=digits)
    if not found:
        raise InputError(f"--border {over} {low:g} {high:g}: no border orbit is found there")
    return found[0]


def _event(orbit: Any, kind: str, over: str, low: float, high: float) -> Any:
    """The first event of a kind, of visible orbits of a branch."""
    from singimpact.branches.branch import branch

    found = [each for each in branch(orbit, over, (low, high)).events if each.kind == kind and each.orbit.visible]
    if not found:
        raise InputError(f"--event {kind} {over} {low:g} {high:g}: no {kind} of visible orbits is found there")
    return found[0]


def _orbit(model: Any, kind: str, counts: tuple[int, int], near: State, saddle: bool = False) -> Any:
    orbits = [each for each in model.periodic(*counts, start=near) if not (saddle and each.stable)]
    if len(orbits) != 1:
        kinds = "saddles" if saddle else "orbits"
        raise InputError(
            f"--{kind} {counts[0]} {counts[1]}: {len(orbits)} {kinds} are found; give --tau and --v near one"
        )
    return orbits[0]
