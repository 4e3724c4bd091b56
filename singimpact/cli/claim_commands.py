"""Commands of the theory: verify, claims, errata, derive, fixed-points, cite."""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

import singimpact as si
from singimpact import __version__, documents, paper
from singimpact.cli.group import LINEAR
from singimpact.cli.output import as_json_text, columns, emit, give, output_options
from singimpact.inputs import InputError, need
from singimpact.store import folder, require_writable, written

if TYPE_CHECKING:
    from singimpact.documents.document_steps import Mark, Section
    from singimpact.documents.series_documents import SeriesRequest


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
@click.option("--coq", metavar="DIR", help="Write one Coq file a claim, with a theorem for each certificate.")
@output_options
@click.pass_context
def verify_command(
    ctx: click.Context,
    ids: tuple[str, ...],
    beyond: bool,
    whole: bool,
    certificates: str | None,
    coq: str | None,
    as_json: bool,
    output: str | None,
) -> None:
    """Derive, prove and cross-check every claim, or the named ones and those that they rest on.

    Of all claims it prints the counts and the misprints on one screen; `-o verify.html` writes the whole list with its
    formulas set, any other file the lines of --all. The exit code is 1 if a claim ends in `error`. The files of
    --certificates are checked by a second program, singimpact/certificates/claims_checker.py, those of
    --coq by Coq (8.16 or newer), in the order of _CoqProject: coqc -Q . Claims FILE.
    """
    verdicts = si.verify(ids or None, beyond=beyond)
    if certificates is not None:
        verdicts.save_certificates(certificates)
    if coq is not None:
        verdicts.save_coq(coq)
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


@click.group()
def claims_command() -> None:
    """The statements of the paper as claims."""


@claims_command.command("list")
@output_options
def listed(as_json: bool, output: str | None) -> None:
    """Every claim: id, section, statement."""
    rows = [[entry.id, entry.section, entry.title] for entry in paper.INDEX.values()]
    names = ("id", "section", "title")
    give({"claims": [dict(zip(names, row, strict=True)) for row in rows]}, columns(names, rows), as_json, output)


@claims_command.command()
@click.argument("name", metavar="ID")
@output_options
def show(name: str, as_json: bool, output: str | None) -> None:
    """One claim: the printed statement, the verdict, the evidence, the claims it rests on and those that rest on it."""
    index = paper.INDEX | paper.BEYOND
    verdict = paper.run(paper.select([name]), cached=True)[-1]
    data: dict[str, Any] = verdict.as_dict() | {
        "mutants": len(paper.CLAIMS[name].mutants),
        "rested_on_by": [other for other, entry in index.items() if name in entry.rests_on],
        "falls_with_it": paper.dependants(index, name),
    }
    give(data, "\n".join(f"{key:14} {_told(value)}" for key, value in data.items()), as_json, output)


def _told(value: Any) -> str:
    if isinstance(value, list) and value and isinstance(value[0], dict):
        return "".join(f"\n  {_item(item)}" for item in value)
    if isinstance(value, dict):
        return ", ".join(f"{key} = {item}" for key, item in value.items()) or "-"
    return (" ".join(map(str, value)) or "-") if isinstance(value, list) else "-" if value is None else str(value)


def _item(item: dict[str, Any]) -> str:
    if "says" in item:
        return f"{item['kind']}: {item['says']}"
    says = f"printed {item['printed']}, corrected {item['corrected']}"
    return f"{item['model']}: {item['quantity']} = {item['found']}; {says}"


@claims_command.command()
@click.option("--svg", is_flag=True, help="Draw it.")
@output_options
def graph(svg: bool, as_json: bool, output: str | None) -> None:
    """The claims that each claim rests on, as text, as JSON or as an SVG picture."""
    if as_json:
        text = as_json_text({name: list(entry.rests_on) for name, entry in paper.INDEX.items()})
    elif svg:
        verdicts = paper.run(paper.select(), cached=True)
        text = paper.as_svg(paper.INDEX, {one.id: one.in_words if one.corrected else one.worth for one in verdicts})
    else:
        text = paper.as_text(paper.INDEX)
    emit(text, output)


@claims_command.command()
@click.argument("name", metavar="ID")
@output_options
def impact(name: str, as_json: bool, output: str | None) -> None:
    """The claims that would fail with one claim."""
    paper.select([name])  # an unknown id is refused with the nearest known ones
    affected = paper.dependants(paper.INDEX, name)
    rows = [[other, paper.INDEX[other].title] for other in affected]
    text = columns(["id", "statement"], rows) if rows else f"nothing rests on {name}"
    give({"id": name, "falls": affected}, text, as_json, output)


LISTED = ("text", "markdown", "latex", "pdf", "json")


@click.command()
@click.option(
    "--format", "form", type=click.Choice(LISTED), default="text", show_default=True, help="Format of the output."
)
@click.option("--json", "as_json", is_flag=True, help="The same as --format json.")
@click.option("-o", "--output", metavar="FILE", help="Write to this file instead of standard output.")
def errata_command(form: str, as_json: bool, output: str | None) -> None:
    """Every statement that fails as printed, with its correction, a witness, and the effect on later statements."""
    form = "json" if as_json else form
    if form == "pdf" and output is None:
        raise InputError("--format pdf goes to a file only: give its name with -o")
    if output is not None:
        require_writable(output)
    misprints = si.errata()
    if form == "pdf":
        _write_pdf(misprints.latex(), str(output))
    else:
        emit(as_json_text(misprints.as_dict()) if form == "json" else getattr(misprints, form)(), output)


def _write_pdf(source: str, output: str) -> None:
    try:
        pdf = documents.compiled(source).pdf
    except documents.CompileError as error:
        raise click.ClickException(str(error)) from None
    with written(output) as draft:
        Path(draft).write_bytes(pdf)


FORMATS = ("latex", "pdf", "markdown", "json", "sympy", "numpy")


@click.command()
@click.argument("names", metavar="[SECTION]...", nargs=-1)
@click.option(
    "--format", "form", type=click.Choice(FORMATS), default="latex", show_default=True, help="Format of the output."
)
@click.option("--order", type=int, help="Write series to this order, not the derivations.  [default: 6]")
@click.option("--model", metavar="FILE", help="Write the series of this model.")
@click.option("--tau", help="With --model: the point of the series.  [default: tangency and swan points]")
@click.option("--keep", metavar="NAME", multiple=True, help="With --model: a parameter that stays a letter.")
@click.option("--only", metavar="SERIES", help="Print this series alone, such as gamma, as one formula in LaTeX.")
@click.option("--json", "as_json", is_flag=True, help="The same as --format json.")
@click.option(
    "-o", "--output", metavar="DIR", help="Write files into this folder instead of one text to standard output."
)
def derive_command(
    names: tuple[str, ...],
    form: str,
    order: int | None,
    model: str | None,
    tau: str | None,
    keep: tuple[str, ...],
    only: str | None,
    as_json: bool,
    output: str | None,
) -> None:
    """Write the derivations: steps in order, each equation with its label and the verdict of its claim.

    A SECTION is a number (4), a name (section4) or a subject (tangency); the default is all sections. The meanings of
    the letters follow them; the section notation prints them alone.
    LaTeX files are one for each section, and derivations.tex, which includes them.
    With --order or --model the series v_c, gamma and more are written instead, in any format. The formats sympy and
    numpy always write series. The numpy file of a model holds tau_* and the radius in which each series is accurate.
    """
    if only is not None:
        click.echo("\n".join(documents.series_formulas(_request(order, model, tau, keep), only)))
        return
    form = "json" if as_json else form
    if form == "pdf" and output is None:
        raise InputError("--format pdf goes to files only: give a folder with -o")
    if form == "pdf":
        documents.require_latex()
    if output is not None:
        folder(output)  # an error in the output path is raised before the computation, not after it
    if form in ("sympy", "numpy") or order is not None or model is not None:
        if names:
            raise InputError(f"{names[0]} is a section of the derivations: a series takes --order and --model alone")
        _series(_request(order, model, tau, keep), form, output)
        return
    need(tau is None and not keep, InputError("--tau and --keep belong to --model"))

    derived = paper.kept_sections(names)
    _write(derived, paper.marks_of(derived), form, output)


def _request(order: int | None, model: str | None, tau: str | None, keep: tuple[str, ...]) -> documents.SeriesRequest:
    from singimpact.impact_oscillator import read_model

    oscillator = None if model is None else read_model(model)
    return documents.SeriesRequest(6 if order is None else order, oscillator, tau, keep)


def _series(request: SeriesRequest, form: str, output: str | None) -> None:
    """The series as text to standard output, or as files in the folder."""
    if form in ("sympy", "numpy", "json"):
        text = documents.series_text(request, form)
        if output is None:
            click.echo(text, nl=False)
            return
        with written(Path(output) / ("series.json" if form == "json" else f"series_{form}.py")) as draft:
            draft.write_bytes(text.encode())
        return
    _write([documents.series_section(request), paper.NOTATION], {}, form, output)


def _write(document: list[Section], marks: dict[str, Mark], form: str, output: str | None) -> None:
    """The document as text to standard output, or as files in the folder."""
    if output is None:
        click.echo(documents.as_text(document, marks, form), nl=False)
        return
    try:
        files = documents.as_files(document, marks, form, _picture)
    except documents.CompileError as error:
        raise click.ClickException(str(error)) from None
    for name, content in files.items():
        with written(Path(output) / name) as draft:
            draft.write_bytes(content)


def _picture(name: str) -> bytes:
    """A figure of the paper as PDF, from its computed data."""
    from tempfile import TemporaryDirectory

    from singimpact.cli.output import save
    from singimpact.paper.figures import kept_picture

    with TemporaryDirectory() as directory:
        number = name.removeprefix("figure")
        save(paper.drawn(kept_picture(int(number) if number.isdigit() else number)), f"{directory}/{name}.pdf")
        return Path(directory, f"{name}.pdf").read_bytes()


@click.command()
@click.argument("contact", metavar="tangency|swan", type=click.Choice(["tangency", "swan"]))
@click.option("--restitution", "--r", metavar="NUMBER", required=True, help="Restitution, a rational in (0, 1).")
@click.option("--digits", type=int, default=50, show_default=True, help="Significant digits.")
@output_options
def fixed_points_command(contact: str, restitution: str, digits: int, as_json: bool, output: str | None) -> None:
    """Fixed points at a tangency or at a swan, each with a radius within which the true value lies."""
    enclosures = getattr(si.fixed_points, contact)(restitution, digits).as_dict()
    rows = [[name, x["value"], x["radius"]] for name, x in enclosures.items()]
    give(enclosures, columns(["name", "value", "radius"], rows), as_json, output)


@click.command()
@click.option(
    "--restitution", "--r", metavar="NUMBER", required=True, help="Restitution, a rational from 0.01 to 0.99."
)
@click.option("--digits", type=int, default=30, show_default=True, help="Significant digits, 16 or more.")
@output_options
def constants_command(restitution: str, digits: int, as_json: bool, output: str | None) -> None:
    """The numbers of the theory that depend on the restitution alone: lambda, mu, X and kappa_*, in balls.

    Each has its contact order, the claim that has it, and its laws as r tends to 0 and to 1.
    """
    numbers = si.constants(restitution, digits)
    header = ["name", "order", "value", "source", "r -> 0", "r -> 1"]
    rows = [[one.name, str(one.order), str(one.value), one.source, one.at_zero, one.at_one] for one in numbers]
    give([one.as_dict() for one in numbers], columns(header, rows), as_json, output)


PAPER = "D. R. J. Chillingworth, Dynamics of an impact oscillator near a degenerate graze"
SOFTWARE = f"singimpact {__version__}: low-velocity impacts of an oscillator near a degenerate graze"
ENTRY = f"""@software{{singimpact,
  title = {{{SOFTWARE}}},
  version = {{{__version__}}},
  license = {{MIT}}
}}"""


@click.command()
@output_options
def cite_command(as_json: bool, output: str | None) -> None:
    """References to cite: this version, with a BibTeX entry, and the paper."""
    data = {"software": SOFTWARE, "paper": PAPER, "bibtex": ENTRY}
    give(data, f"{SOFTWARE}\n{PAPER}\n\n{ENTRY}", as_json, output)
