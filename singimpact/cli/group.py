"""The group `singimpact`: its commands by name; every mistake of the caller gives one line on standard error."""

import re
import signal
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import Any, NoReturn

import click

from singimpact import __version__
from singimpact.inputs import InputError, Unfinished, meant, unknown

# The short helps are here, so that `singimpact --help` imports no command and no sub-package.
COMMANDS = {
    "verify": "check every claim of the paper and print its verdict",
    "derive": "write the derivations as LaTeX, PDF, Markdown or JSON",
    "map": "fly from an impact to the next one",
    "orbit": "fly many impacts; -o draws x(t)",
    "section": "the states of an orbit once a period; -o draws them",
    "lyapunov": "both Lyapunov exponents of an orbit",
    "chatter": "the time at which infinitely many impacts accumulate",
    "figure": "the paper's figures, from computed data",
    "scene": "draw the layers that a scene file names",
    "threshold": "the velocity below which chatter completes",
    "classify": "tangency, swan, fold and cusp points of a model",
    "explore": "a page with a slider for the clearance",
    "sweep": "the last state of an orbit for many values of a parameter",
    "basins": "the attractor of each state of a grid, as a picture",
    "bifurcation": "settled orbits for many values of a parameter, as a picture",
    "regions": "what an orbit does in the end, over two numbers, as a picture",
    "ensemble": "averages of many orbits through chatter and rest",
    "branch": "follow periodic orbits through grazes, folds and doublings",
    "border": "where a released orbit returns onto gamma, and the cascade beside it",
    "events": "curves of grazes, folds and doublings in two parameters",
    "bench": "run time against error, compared with other tools",
    "stress": "errors near singular points, in units of the rounding error",
    "selftest": "compare random states of your model with independent computations",
    "errata": "misprints of the paper, their corrections, and the reasons",
    "claims": "the claims: list, show, graph, impact",
    "certify": "a proved result with a certificate that a second program checks",
    "fixed-points": "fixed points and multipliers, certified, to any digits",
    "constants": "numbers of the theory at one restitution, certified, with their laws",
    "cite": "references to cite",
}
# Commands that share a file; NAME is in NAME_command.py otherwise.
FILES = {
    **dict.fromkeys(("map", "orbit", "section", "chatter", "threshold", "lyapunov"), "orbit_commands"),
    **dict.fromkeys(("sweep", "basins", "bifurcation", "regions", "ensemble"), "long_run_commands"),
    **dict.fromkeys(("branch", "events", "border", "certify"), "branch_commands"),
    **dict.fromkeys(("verify", "claims", "errata", "derive", "fixed-points", "constants", "cite"), "claim_commands"),
    **dict.fromkeys(("figure", "scene", "classify", "explore"), "picture_commands"),
    **dict.fromkeys(("bench", "stress", "selftest"), "measuring_commands"),
}

LINEAR = "--omega 2.8 --clearance 0.1 --restitution 0.8 --amplitude -1"
DOOR = f"""\
Motion of an oscillator that hits a wall: x'' + f(x, x') = g(t), x >= c, v -> -r v, with exact theory near grazes.
  singimpact orbit {LINEAR} --tau 0.3 --v 0.4 -o orbit.png   draws an orbit
  singimpact bifurcation {LINEAR} --from -0.1 --to 0.25 -o bifurcation.png   over the clearance
  singimpact verify   checks every statement of the theory and lists the misprints of its paper
Your own model: a file, --model FILE, with f = "x + 0.3*x**3", g = "cos(1.7*t)", clearance = 0.3, restitution = 0.6.
All commands: singimpact --help; of one: singimpact orbit --help."""


class Commands(click.Group):
    """Commands that are imported when they are called."""

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command:  # noqa: ARG002
        if cmd_name not in COMMANDS:
            raise unknown("command", cmd_name, COMMANDS)
        name = f"{cmd_name.replace('-', '_')}_command"
        command: click.Command = getattr(import_module(f"singimpact.cli.{FILES.get(cmd_name, name)}"), name)
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:  # noqa: ARG002
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))

    def main(self, args: Sequence[str] | None = None, *_: Any, **__: Any) -> NoReturn:
        """Run, and exit with a code: 2 for mistakes of the caller, each printed as one line without a traceback."""
        # the default action of SIGTERM would leave temporary files; an exception lets their owners remove them
        signal.signal(signal.SIGTERM, lambda number, _frame: sys.exit(128 + number))
        sys.exit(self._code(args))

    def _code(self, args: Sequence[str] | None) -> int:
        try:
            code = super().main(args, prog_name="singimpact", standalone_mode=False)
            return code if isinstance(code, int) else 0
        except InputError as error:
            return _refused(str(error))
        except click.ClickException as error:
            return _refused(_in_our_words(error, args))
        except (click.Abort, KeyboardInterrupt):
            click.echo("singimpact: interrupted", err=True)
            return 130
        except Unfinished as error:
            click.echo(f"singimpact: {error}", err=True)
            return 1
        except OSError as error:
            click.echo(f"singimpact: the system refused: {error}", err=True)
            return 1


def _in_our_words(error: click.ClickException, args: Sequence[str] | None) -> str:
    """The message of click, with the option that was meant, its value, and the accepted values."""
    match error:
        case click.NoSuchOption(ctx=click.Context() as ctx):
            names = [
                name.lstrip("-") for parameter in ctx.command.params for name in parameter.opts if name.startswith("--")
            ]
            instead = meant(error.option_name.lstrip("-"), names)
            return f"no option {error.option_name}: " + (
                f"give --{instead}" if instead else "--help lists those there are"
            )
        case click.MissingParameter(param=click.Option() as option) if set(option.opts) & set(args or sys.argv[1:]):
            return f"{option.opts[0]} was read as a value of the option before it, which takes two: --tau 0 3"
        case click.BadParameter(param=click.Option(type=click.IntRange() | click.types.IntParamType()) as option):
            match_ = re.fullmatch(r"'(.*)' is not a valid integer( range)?\.", error.message)
            if match_:
                return f"{option.opts[-1]} = {match_[1]} is not accepted: give a whole number"
    return error.format_message()


def _refused(message: str) -> int:
    click.echo(f"singimpact: {' '.join(message.split())}", err=True)
    return 2


@click.group(cls=Commands, invoke_without_command=True, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="singimpact")
@click.pass_context
def main(ctx: click.Context) -> None:
    """Impact oscillators x'' + f(x, x') = g(t), x >= c: simulation, periodic orbits, and exact theory near grazes.

    Output files appear only when complete. A mistake in the input gives one line and exit code 2.
    """
    if ctx.invoked_subcommand is None:
        click.echo(DOOR)
