"""`singimpact lyapunov`: both Lyapunov exponents of an orbit."""

from __future__ import annotations

from typing import Any

import click

from singimpact.cli.model import model_options, take_model
from singimpact.cli.output import as_json_text, emit, output_options
from singimpact.status import Status


@click.command(short_help="both Lyapunov exponents of an orbit")
@model_options
@click.option("--tau", metavar="NUMBER", required=True, help="Launch phase.")
@click.option("--v", metavar="NUMBER", required=True, help="Launch velocity.")
@click.option("--impacts", type=click.IntRange(1, 100_000_000), default=10_000, show_default=True, help="Impacts used.")
@click.option(
    "--transient", type=click.IntRange(0, 100_000_000), help="Impacts flown before.  [default: until the orbit settles]"
)
@output_options
def command(
    tau: str, v: str, impacts: int, transient: int | None, as_json: bool, output: str | None, **options: Any
) -> None:
    """Lyapunov exponents per unit of time and per impact, with standard errors.

    An orbit that comes to rest again and again is superstable: its exponents are -inf.
    """
    osc = take_model(options)
    from singimpact.dynamics.lyapunov import lyapunov

    found = lyapunov(osc, tau, v, impacts, transient=transient)
    status = Status(int(found.status))
    rows = {"exponents": found.exponents, "error": found.error, "per impact": found.per_impact}
    if as_json:
        told = {name.replace(" ", "_"): values.tolist() for name, values in rows.items()}
        told |= {"impacts": found.impacts, "time": found.time, "superstable": found.superstable, "status": status.name,
                 "transient": found.transient, "converged": found.converged}  # fmt: skip
        emit(as_json_text({"model": osc.to_dict(), **told}), output)
        return
    lines = [f"{name:11} {'  '.join(f'{value:.9g}' for value in values.tolist())}" for name, values in rows.items()]
    lines += [
        f"impacts     {found.impacts} in a time of {found.time:.9g}, after {found.transient}",
        f"status      {status.name}: {status.sentence}",
    ]
    if not found.converged:
        lines.append("not converged: the exponents of both halves differ, give more --impacts or a --transient")
    emit("\n".join([*lines, *(["superstable"] if found.superstable else [])]), output)
