"""`singimpact certify`: an impact or a periodic orbit with its certificate, and certificates that are checked."""

from __future__ import annotations

from typing import Any

import click

from singimpact.cli.model import model_options, take_model
from singimpact.cli.output import emit
from singimpact.inputs import InputError
from singimpact.store import require_writable


@click.command(short_help="an impact or a periodic orbit with a certificate that a second program checks")
@click.argument("files", metavar="[FILE.json]...", nargs=-1)
@model_options
@click.option("--tau", metavar="NUMBER", help="Launch time.")
@click.option("--v", metavar="NUMBER", help="Launch velocity, > 0.")
@click.option(
    "--orbit", type=(int, int), metavar="N K", help="An orbit of N impacts in K periods; --tau, --v: near it."
)
@click.option("--digits", type=click.IntRange(1, 1000), default=30, show_default=True, help="Significant digits.")
@click.option("-o", "--output", metavar="FILE.json", help="The certificate.  [default: standard output]")
def command(
    files: tuple[str, ...], tau: str | None, v: str | None, orbit: tuple[int, int] | None, digits: int,
    output: str | None, **options: Any,
) -> None:  # fmt: skip
    """Enclose the impact from (tau, v), or a periodic orbit, and write its certificate; or check FILE.json ...

    A certificate is accepted by a second program, which imports python-flint alone, reads the model as text and
    encloses the motion again with its own code.
    """
    from singimpact.certificates.certificate import certify, read_certificate

    if files:
        for path in files:
            emit(f"{path}: {read_certificate(path)!r} holds", None)
        return
    if orbit is None and (tau is None or v is None):
        raise InputError("give --tau and --v, or --orbit N K, for a new certificate; or the files to check")
    if output is not None:
        require_writable(output)
    model = take_model(options)
    if orbit is None:
        found = certify(model.impact_map(tau, v, digits=digits))
    else:
        orbits = model.periodic(*orbit, start=None if tau is None or v is None else (tau, v))
        if len(orbits) != 1:
            raise InputError(
                f"--orbit {orbit[0]} {orbit[1]}: {len(orbits)} orbits are found; give --tau and --v near one"
            )
        found = certify(orbits[0].certified(digits))
    found.check()
    emit(found.text.rstrip("\n"), output)
