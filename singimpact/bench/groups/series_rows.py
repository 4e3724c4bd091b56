"""`bench series`: v_c and gamma order by order, each made in a fresh process, beside the plain sympy way.

x'' + x'/10 + x + 3x^3/10 = 0.3081 + t + t^2/3 with the wall at 0.3 has a tangency at 0; lambda is 3/5.  A series is
judged by its value: v_c at the end of a flight from (-0.2, 0.01) that was flown in 45 digits, gamma over -0.1.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from itertools import groupby

from singimpact.bench.drawn import values
from singimpact.bench.measuring import Case, Cost, Effort, Method, Timed, cost

FLIGHT_TIME = values()["v_c.flight_time[cubic, polynomial forcing](-0.2,0.01)"]
ON_GAMMA = values()["gamma.v[cubic, polynomial forcing](-0.1)"]

PUBLIC = """
import flint, numpy, sympy
from singimpact import ImpactOscillator, theory

CUBIC = ImpactOscillator("x + xdot/10 + 3*x**3/10", "3081/10000 + t + t**2/3", "0.3", "117/275")
"""
SYMPY = """
import sympy
from sympy import Rational
from singimpact.bench.peers import plain_series as plain
from singimpact.paper.routes import implicit

FORCE, CLEARANCE = plain.x + plain.xdot/10 + 3*plain.x**3/10, Rational(3, 10)
FORCING = Rational(3081, 10000) + plain.t + plain.t**2/3

def symbols(order):
    terms = [(i, k) for i in range(order) for k in range(order) if i + k and 2*i + k + 1 <= order]
    force = sum(sympy.Symbol(f"f_{i}{k}") * plain.x**i * plain.xdot**k / sympy.factorial(i) / sympy.factorial(k)
                for i, k in terms)
    return force, sum(sympy.Symbol(f"a_d{k}") * plain.t**k / sympy.factorial(k) for k in range(1, order + 1)), 0
"""
AT = f"""
from fractions import Fraction
SIGMA, T = Fraction(-1, 5), Fraction("{FLIGHT_TIME}")
"""
JETS = """
import sympy
KNOWN = {"a_d1": 1, "a_d2": Fraction(2, 3), "f_01": Fraction(1, 10), "f_10": Fraction(1081, 1000),
         "f_20": Fraction(54, 100), "f_30": Fraction(18, 10), "sigma": SIGMA, "t": T}
value = sympy.sympify(made).subs({s: sympy.Rational(KNOWN.get(s.name, 0)) for s in sympy.sympify(made).free_symbols})
answer = [str(value)]
"""
OF_POWERS = (
    "answer = [str(sum(sympy.Rational(str(c)) * sympy.Rational(-1, 10)**n for n, c in made.coefficients.items()))]"
)
OF_SUM = "answer = [str(sympy.Rational(made.subs({sympy.Symbol('sigma'): SIGMA, sympy.Symbol('t'): T})))]"
OF_EXPRESSION = "answer = [str(sympy.Rational(made.subs({plain.sigma: SIGMA, plain.t: T})))]"


@dataclass(frozen=True)
class Task:
    """One series.

    Attributes
    ----------
    case, method, order : as the table shows them. made : the statement that is timed. before, judged : around it.
    """

    case: str
    method: str
    order: int
    made: str
    before: str = PUBLIC
    judged: str = "answer = None"

    def cost(self) -> Cost:
        """CPU seconds, megabytes, and the value as text in a list."""
        return cost(f"made = {self.made}", self.before + AT, self.judged)

    def timed(self) -> Timed:
        """The call that a method times."""
        found = self.cost()
        return Timed(found.seconds, found.answer)


SYMBOLS, MODEL, GAMMA = "v_c, symbols for the jets", "v_c, cubic model", "gamma, cubic model"
TRUTH = {SYMBOLS: ["0.01"], MODEL: ["0.01"], GAMMA: [ON_GAMMA]}


def _public(case: str, order: int) -> Task:
    """The function that a user calls, with the sympy object that it returns."""
    made, judged = {
        SYMBOLS: (f"theory.v_c({order}, at='tangency')", JETS),
        MODEL: (f"theory.v_c({order}, 'tangency', CUBIC, 0)", OF_SUM),
        GAMMA: (f"theory.gamma({order}, 'tangency', CUBIC, 0)", OF_POWERS),
    }[case]
    return Task(case, "singimpact", order, made, judged=judged)


def _implicit(order: int) -> Task:
    made = f"implicit.at_contact(implicit.v_c({order}), 1)"
    return Task(SYMBOLS, "sympy, implicit function", order, made, SYMPY, JETS)


def _plain(case: str, order: int) -> Task:
    given = f"*symbols({order})" if case == SYMBOLS else "FORCE, FORCING, CLEARANCE"
    made, judged = f"plain.velocities({given}, {order})[0]", JETS if case == SYMBOLS else OF_EXPRESSION
    if case == GAMMA:
        made = f"plain.gamma({given}, Rational(3, 5), {order})"
        judged = OF_EXPRESSION.replace("SIGMA", "Rational(-1, 10)")
    return Task(case, "sympy, integrals and series", order, made, SYMPY, judged)


# as the table shows them: by case, then by order, the method that the others are compared with first
TASKS = (
    *(task for n in (2, 3, 4) for task in (_public(SYMBOLS, n), _plain(SYMBOLS, n), _implicit(n))),
    *(_public(SYMBOLS, n) for n in (8, 12)),
    *(task for n in (2, 3, 4, 5) for task in (_public(MODEL, n), _plain(MODEL, n))),
    *(_public(MODEL, n) for n in (8, 16)),
    *(task for n in (3, 4, 5) for task in (_public(GAMMA, n), _plain(GAMMA, n))),
    *(_public(GAMMA, n) for n in (8, 16, 32)),
)
QUICK = (2, 8)  # orders of a quick look


def cases(effort: Effort) -> Iterator[Case]:
    """A case a series and order."""
    chosen = [task for task in TASKS if task.order in QUICK or not effort.quick]
    for (name, _), tasks in groupby(chosen, key=lambda task: (task.case, task.order)):
        methods = [Method(task.method, f"order {task.order}", partial(Task.timed, task)) for task in tasks]
        yield Case(name, methods, TRUTH[name], missed=1.0)  # a cut series is coarse, and no other answer
