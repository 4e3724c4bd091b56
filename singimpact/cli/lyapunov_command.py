"""`singimpact lyapunov`: both Lyapunov exponents of an orbit."""

import click

from singimpact.cli.model_options import model_options, take_model
from singimpact.cli.output import give, lines_of, output_options, state_options, whole_option
from singimpact.status import Status

# Of the result, in JSON.
SHOWN = ("exponents", "error", "per_impact", "impacts", "time", "superstable", "status", "transient", "converged")


@click.command()
@model_options
@state_options
@whole_option("--impacts", 1, 100_000_000, "Impacts used.", 10_000)
@whole_option("--transient", 0, 100_000_000, "Impacts flown before.  [default: until the orbit settles]")
@output_options
def command(
    tau: str, v: str, impacts: int, transient: int | None, as_json: bool, output: str | None, **options: str | None
) -> None:
    """Lyapunov exponents per unit of time and per impact, with standard errors.

    An orbit that comes to rest again and again is superstable: its exponents are -inf.
    """
    osc = take_model(options)
    from singimpact.dynamics.lyapunov import lyapunov

    result = lyapunov(osc, tau, v, impacts, transient=transient)
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
