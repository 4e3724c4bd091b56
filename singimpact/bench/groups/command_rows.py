"""`bench commands`: series in symbols and the commands of the README, each in a new process, against figures to reach.

CPU seconds of the process and of its children.  Each command begins with a new cache folder of its own.
"""

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from singimpact.bench.fresh import cost
from singimpact.bench.measuring import Aim, Case, Effort, Method, Timed

PUBLIC = "import flint, numpy, sympy\nfrom singimpact import theory\n"
MODEL = """f = "x + 0.1*xdot + 0.3*x**3"
g = "cos(1.7*t)"
clearance = 0.3
restitution = 0.6
"""
RUN = "subprocess.run([sys.executable, '-m', 'singimpact', *{words!r}], cwd={place!r}, check=True, capture_output=True)"


@dataclass(frozen=True)
class Series:
    """A statement about a series in symbols: what is timed, what goes before; seconds to reach."""

    made: str
    seconds: float
    before: str = ""
    setting: str = ""

    def timed(self) -> Timed:
        """In a new process, with flint, numpy and sympy there."""
        return Timed(cost(self.made, PUBLIC + self.before).seconds, [None])


SERIES = (
    Series("made = theory.v_c(12, at='generic')", 1.2),
    Series("made = theory.v_c(12, at='generic')", 1e-3, "theory.v_c(12, at='generic')", "again"),
    Series("text = str(made)", 1.0, "made = theory.v_c(12, at='generic')", "of v_c(12)"),
    Series("made = theory.chatter_limit(8)", 0.4),
    Series("made = theory.gamma(8)", 0.1),
)


@dataclass(frozen=True)
class Command:
    """A command line, and the seconds to reach: with a new cache folder, and again. None: no aim."""

    line: str
    new: float | None = None
    again: float | None = None


COMMANDS = (
    Command("verify", 20.0, 0.5),
    Command("derive -o derivations", None, 1.0),
    Command("errata", None, 0.5),
    Command("explore duffing.toml --html swan.html", 2.0),
    Command("classify --model duffing.toml --over clearance --between 0.7 0.95", 1.0),
    Command("figure 17 -o pictures", None, 0.5),
    # the others of the README
    Command("orbit --model duffing.toml --tau 0.9 --v 0.005 -o orbit.png"),
    Command(
        "bifurcation --omega 2.8 --clearance 0.1 --restitution 0.8 --amplitude -1 --from -0.1 --to 0.25 "
        "--follow 1 1 -o bifurcation.png",
        3.0,
    ),
    Command("branch --omega 4.3 --clearance 0 --restitution 0.6 --orbit 1 2 --from -0.3 --to 0.3 -o branch.png"),
    Command("basins --omega 2.8 --clearance 0.1 --restitution 0.8 --amplitude -1 -o basins.png", 3.0, 0.3),
    Command("threshold --omega 2.8 --clearance 0 --restitution 0.5 --tau pi/2.8"),
    Command("derive --order 8 --model duffing.toml --format numpy"),
    Command("verify e:meq e:qdef"),
)


def cases(effort: Effort) -> Iterator[Case]:
    """Series, then with full effort the commands, first with a new cache folder, then again."""
    rows = [Method("singimpact", f"{_words(series)}", series.timed, aim=Aim(series.seconds * 1e6)) for series in SERIES]
    yield Case("series in symbols, new process", rows)
    if effort.quick:  # most commands take longer than two seconds in a new folder
        return
    with tempfile.TemporaryDirectory() as directory:
        (Path(directory) / "duffing.toml").write_text(MODEL, encoding="utf-8")
        for command in COMMANDS:
            yield Case(f"singimpact {command.line}", _turns(command, directory))


def _words(series: Series) -> str:
    name = series.made.partition(" = ")[2].replace("made", "v_c(12)").removeprefix("theory.")
    return f"{name}, again" if series.setting == "again" else name


def _turns(command: Command, place: str) -> list[Method]:
    """The first turn leaves what is kept, so it is measured once; the second one finds it."""
    first = _run(command, place)
    again = partial(_run, command, place)
    return [
        Method("singimpact", "new cache folder", lambda: first, first=True, aim=_aim(command.new)),
        Method("singimpact", "again", again, aim=_aim(command.again)),
    ]


def _aim(seconds: float | None) -> Aim:
    return Aim() if seconds is None else Aim(seconds * 1e6)


def _run(command: Command, place: str) -> Timed:
    text = RUN.format(words=command.line.split(), place=place)
    cache = Path(place) / "cache" / command.line.split()[0]
    around = {"SINGIMPACT_CACHE": str(cache)}
    return Timed(cost(text, "import subprocess, sys", around=around).seconds, [None])
