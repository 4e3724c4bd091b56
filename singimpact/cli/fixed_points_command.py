"""`singimpact fixed-points`: the fixed points of the blown-up maps and their multipliers."""

import click

from singimpact.cli.output import columns, give, output_options


@click.command()
@click.argument("contact", metavar="tangency|swan", type=click.Choice(["tangency", "swan"]))
@click.option("--restitution", "--r", metavar="NUMBER", required=True, help="Restitution, a rational in (0, 1).")
@click.option("--digits", type=int, default=50, show_default=True, help="Significant digits.")
@output_options
def command(contact: str, restitution: str, digits: int, as_json: bool, output: str | None) -> None:
    """Fixed points at a tangency or at a swan, each with a radius within which the true value lies."""
    from singimpact.theory import fixed_points

    enclosures = getattr(fixed_points, contact)(restitution, digits).as_dict()
    rows = [[name, x["value"], x["radius"]] for name, x in enclosures.items()]
    give(enclosures, columns(["name", "value", "radius"], rows), as_json, output)
