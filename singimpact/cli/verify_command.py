"""`singimpact verify`: every claim, its verdict, and the misprints."""

import os
import shutil
import sys

import click

from singimpact.cli.group import LINEAR
from singimpact.cli.output import as_json_text, emit, output_options

COLOURS = {
    "proved": "green",
    "proved modulo": "green",
    "certified": "green",
    "corrected": "yellow",
    "open": "cyan",
    "error": "red",
}

MORE = f"""\
All of it: singimpact verify --all, or -o verify.html with the formulas set.
A picture of an oscillator: singimpact orbit {LINEAR} --tau 0.3 --v 0.4 -o orbit.png"""


@click.command()
@click.argument("ids", metavar="[ID]...", nargs=-1)
@click.option("--beyond", is_flag=True, help="The claims that are not in the paper, and those they rest on.")
@click.option("--all", "whole", is_flag=True, help="One line a claim, and of each misprint its witness.")
@click.option("--certificates", metavar="DIR", help="Write one JSON file a claim, with what its proof rests on.")
@output_options
@click.pass_context
def command(
    ctx: click.Context,
    ids: tuple[str, ...],
    beyond: bool,
    whole: bool,
    certificates: str | None,
    as_json: bool,
    output: str | None,
) -> None:
    """Derive, prove and cross-check every claim, or the named ones and those that they rest on.

    Of all claims it prints the counts and the misprints on one screen; `-o verify.html` writes the whole list with its
    formulas set, any other file the lines of --all. The exit code is 1 if a claim ends in `error`. The files of
    --certificates are checked by a second program, singimpact/certificates/claims_checker.py.
    """
    from singimpact.paper.claims.verdicts import verify

    verdicts = verify(ids or None, beyond=beyond)
    if certificates is not None:
        verdicts.save_certificates(certificates)
    # without a terminal lines are as long as they are, and have no colours
    width = shutil.get_terminal_size().columns if output is None and sys.stdout.isatty() else None
    if as_json:
        text = as_json_text(verdicts.as_dict())
    elif output is not None and output.endswith((".html", ".htm")):
        text = verdicts.html()
    elif whole or ids or beyond or output is not None:
        text = verdicts.text() if width is None else verdicts.text(width, _painted)
    else:
        text = f"{verdicts.screen(width)}\n\n{MORE}"
    emit(text, output)
    ctx.exit(verdicts.exit_code)


def _painted(text: str, kind: str) -> str:
    return text if "NO_COLOR" in os.environ else click.style(text, fg=COLOURS.get(kind))
