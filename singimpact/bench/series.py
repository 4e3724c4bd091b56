"""`singimpact bench series`: CPU time and memory of the series in fresh processes, beside the plain sympy way."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import dataclass

BEFORE = """
import json, resource, sys, time
import flint, numpy, sympy
from fractions import Fraction
from singimpact.algebra.balls import Balls
from singimpact.algebra.rings import DOUBLES, EXACT
from singimpact.contact.contact import Contact
from singimpact.oscillator.model import Oscillator
from singimpact.theory import implicit_route
from singimpact.theory.completion import symbolic_completion
from singimpact.theory.invariant_curve import invariant_curve
from singimpact.theory.letters import LetteredModel
from singimpact.theory.sheet import sheet
from singimpact.theory.symbolic_curve import symbolic_curve

DUFFING = Oscillator("x + xdot/10 + 3*x**3/10", "3081/10000 + t + t**2/3", "0.3", "1/2")
LETTERED = Oscillator("x + d*xdot + k*x**3", "cos(t)", "0.3", "1/2", {"d": "0.1", "k": "0.3"})

def memory():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024

base, start = memory(), time.process_time()
"""
AFTER = """
print(json.dumps([time.process_time() - start, memory() - base]))
"""


@dataclass(frozen=True)
class Task:
    """One series.

    Attributes
    ----------
    name : what is made. code : how. limit : CPU seconds that it may take; None for a peer, shown for comparison.
    """

    name: str
    code: str
    limit: float | None


TASKS = (
    Task("v_c, generic jets, order 8", "sheet(Contact.generic(0, 8), 8).xdot", 0.05),
    Task("v_c, generic jets, order 12", "sheet(Contact.generic(0, 12), 12).xdot", 0.5),
    Task("v_c at a tangency, order 14", "sheet(Contact.generic(1, 14), 14).xdot", 1.0),
    Task("v_c, cubic Duffing model, order 12", "sheet(Contact.of(DUFFING, Fraction(1), 0, 12, EXACT), 12).xdot", 0.05),
    Task("v_c, cubic Duffing model, its parameters letters, order 12",
         'sheet(LetteredModel(LETTERED, ["d", "k"], 1).contact(12), 12).xdot', 0.05),
    Task("gamma, exact, order 32",
         "invariant_curve(Contact.of(DUFFING, Fraction(0), 1, 32, EXACT), Fraction(3, 5), 32)", 1.0),
    Task("gamma, 256-bit balls, order 64",
         "invariant_curve(Contact.of(DUFFING, Fraction(0), 1, 64, Balls(256)), Fraction(3, 5), 64)", 0.5),
    Task("gamma, doubles, order 20", "invariant_curve(Contact.of(DUFFING, 0.0, 1, 20, DOUBLES), 0.6, 20)", 0.01),
    Task("gamma, symbolic jets and r, order 8", "symbolic_curve(1, 8)", 3.0),
    Task("chatter completion, symbolic jets and r, order 6", "symbolic_completion(6)", 0.3),
    Task("sympy, implicit differentiation, v_c, order 4", "implicit_route.v_c(4)", None),
    Task("sympy, implicit differentiation, v_c, order 6", "implicit_route.v_c(6)", None),
)  # fmt: skip


@dataclass(frozen=True)
class Measured:
    """CPU seconds after the imports, and megabytes above them, of one task in a fresh process."""

    task: Task
    seconds: float
    megabytes: float

    @property
    def good(self) -> bool:
        """Whether it kept its limit; a peer has none."""
        return self.task.limit is None or self.seconds <= self.task.limit

    def line(self) -> str:
        """One line of the table."""
        limit = "" if self.task.limit is None else f"  (limit {self.task.limit * 1e3:.0f} ms)"
        return f"{self.task.name:60} {self.seconds * 1e3:9.1f} ms {self.megabytes:6.0f} MB{limit}"


def measured(task: Task) -> Measured:
    """One task in a process of its own: sympy's cache and a warm allocator would flatter a second run."""
    done = subprocess.run(
        [sys.executable, "-c", BEFORE + task.code + AFTER], capture_output=True, text=True, check=True
    )
    seconds, megabytes = json.loads(done.stdout)
    return Measured(task, seconds, megabytes)


def table(tasks: tuple[Task, ...] = TASKS) -> list[Measured]:
    """All tasks, one after the other."""
    return [measured(task) for task in tasks]
