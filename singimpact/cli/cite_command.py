"""`singimpact cite`: references to cite."""

import click

from singimpact import __version__
from singimpact.cli.output import give, output_options

PAPER = "D. R. J. Chillingworth, Dynamics of an impact oscillator near a degenerate graze"
SOFTWARE = f"singimpact {__version__}: low-velocity impacts of an oscillator near a degenerate graze"
ENTRY = f"""@software{{singimpact,
  title = {{{SOFTWARE}}},
  version = {{{__version__}}},
  license = {{MIT}}
}}"""


@click.command()
@output_options
def command(as_json: bool, output: str | None) -> None:
    """References to cite: this version, with a BibTeX entry, and the paper."""
    data = {"software": SOFTWARE, "paper": PAPER, "bibtex": ENTRY}
    give(data, f"{SOFTWARE}\n{PAPER}\n\n{ENTRY}", as_json, output)
