"""`singimpact claims`: the list of claims, one claim, the graph of their dependences, the claims that need one."""

from typing import Any

import click

from singimpact.cli.output import as_json_text, columns, emit, give, output_options


@click.group()
def command() -> None:
    """The statements of the paper as claims."""


@command.command("list")
@output_options
def listed(as_json: bool, output: str | None) -> None:
    """Every claim: id, section, statement."""
    from singimpact.paper.claims import INDEX

    rows = [[entry.id, entry.section, entry.title] for entry in INDEX.values()]
    names = ("id", "section", "title")
    give({"claims": [dict(zip(names, row, strict=True)) for row in rows]}, columns(names, rows), as_json, output)


@command.command()
@click.argument("name", metavar="ID")
@output_options
def show(name: str, as_json: bool, output: str | None) -> None:
    """One claim: the printed statement, the verdict, the evidence, the claims it rests on and those that rest on it."""
    from singimpact.paper.claims import BEYOND, CLAIMS, INDEX, run, select
    from singimpact.paper.claims.index import dependants

    index = INDEX | BEYOND
    verdict = run(select([name]), cached=True)[-1]
    data: dict[str, Any] = verdict.as_dict() | {
        "mutants": len(CLAIMS[name].mutants),
        "rested_on_by": [other for other, entry in index.items() if name in entry.rests_on],
        "falls_with_it": dependants(index, name),
    }
    give(data, "\n".join(f"{key:14} {_told(value)}" for key, value in data.items()), as_json, output)


def _told(value: Any) -> str:
    if isinstance(value, list) and value and isinstance(value[0], dict):
        return "".join(f"\n  {_item(item)}" for item in value)
    if isinstance(value, dict):
        return ", ".join(f"{key} = {item}" for key, item in value.items()) or "-"
    return (" ".join(map(str, value)) or "-") if isinstance(value, list) else "-" if value is None else str(value)


def _item(item: dict[str, Any]) -> str:
    """A certificate or a trial on one line."""
    if "says" in item:
        return f"{item['kind']}: {item['says']}"
    says = f"printed {item['printed']}, corrected {item['corrected']}"
    return f"{item['model']}: {item['quantity']} = {item['found']}; {says}"


@command.command()
@click.option("--svg", is_flag=True, help="Draw it.")
@output_options
def graph(svg: bool, as_json: bool, output: str | None) -> None:
    """The claims that each claim rests on, as text, as JSON or as an SVG picture."""
    from singimpact.paper.claims import INDEX, run, select
    from singimpact.paper.claims.index import as_svg, as_text

    if as_json:
        text = as_json_text({name: list(entry.rests_on) for name, entry in INDEX.items()})
    elif svg:
        verdicts = run(select(), cached=True)
        text = as_svg(INDEX, {one.id: one.in_words if one.corrected else one.worth for one in verdicts})
    else:
        text = as_text(INDEX)
    emit(text, output)


@command.command()
@click.argument("name", metavar="ID")
@output_options
def impact(name: str, as_json: bool, output: str | None) -> None:
    """The claims that would fail with one claim."""
    from singimpact.paper.claims import INDEX, select
    from singimpact.paper.claims.index import dependants

    select([name])  # an unknown id is refused with the nearest known ones
    affected = dependants(INDEX, name)
    rows = [[other, INDEX[other].title] for other in affected]
    text = columns(["id", "statement"], rows) if rows else f"nothing rests on {name}"
    give({"id": name, "falls": affected}, text, as_json, output)
