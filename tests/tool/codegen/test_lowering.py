"""Text of LLVM without numba computes what Python and numba compute; what cannot be written so is refused."""

from __future__ import annotations

import ast
import ctypes
import inspect
import math
import random
import sys
import types

import numpy as np
import pytest
from llvmlite import ir

from singimpact.codegen import FUNCTIONS, REAL, WHOLE, Unsupported, emitted, loaded, lowered, whole_power_radius
from singimpact.flights import LAW, MODULES, Allowance, CompiledModel, Emitted, KernelCompiler, constants, text_of_model
from singimpact.oscillator import Oscillator

RADII = sys.modules[whole_power_radius.__module__]
COMPILERS = sys.modules[KernelCompiler.__module__]

ADDRESS = REAL.as_pointer()


def trees(text):
    return {tree.name: tree for tree in ast.parse(text).body}


def compiled(text, entry="f", count=2, space=()):
    """A function of doubles, called through its object code."""
    takes = ir.FunctionType(REAL, [REAL] * count)
    code = emitted(lowered(trees(text), dict(space), entry, takes), entry)
    address = ctypes.cast(loaded(code, entry, count)[0], ctypes.c_void_p).value
    return ctypes.CFUNCTYPE(ctypes.c_double, *[ctypes.c_double] * count)(address)


def same(one, other):
    return one == other or (math.isnan(one) and math.isnan(other))


TEXTS = {
    "loops and whole numbers": """
def f(a, b):
    s, n = 0.0, 0
    for i in range(1, 9):
        j = i
        while j > 2 and s < 40:
            s += i * a / (j + b * b)
            j -= 1
        n += j
    return s + n
""",
    "a variable that becomes a double": """
def f(a, b):
    s = 1
    for _ in range(5):
        s = s + 1 if s > 2 or a > b else s * a
    return s
""",
    "branches and several results": """
def f(a, b):
    low, which = g(a, b)
    if not which == 1:
        return low - 1
    elif 0 < a <= 1:
        return -low
    return low

def g(a, b):
    if a < b:
        return a, 1
    return b, 2
""",
    "powers": "def f(a, b):\n    return a**3 - b**-2 + abs(a)**b + (a**2)**0.5\n",
    "extremes": "def f(a, b):\n    return max(a, b, 1) - min(a, 2) + int(10 * a) + max(3, 4)\n",
    "named numbers": "def f(a, b):\n    return inf if a != a else b - LEVEL\n",
}


@pytest.mark.parametrize("name", TEXTS)
def test_it_computes_what_python_computes(name):
    space = {"LEVEL": 4, "inf": math.inf}
    plain = dict(space)
    exec(TEXTS[name], plain)
    function = compiled(TEXTS[name], space=space.items())
    draw = random.Random(1)
    for _ in range(300):
        a, b = draw.uniform(-3, 3), draw.uniform(-3, 3)
        if name == "powers":
            assert function(a, b) == pytest.approx(plain["f"](a, b), rel=1e-13, abs=1e-13)
        else:
            assert same(function(a, b), float(plain["f"](a, b))), (a, b)
    if name in ("extremes", "powers"):
        return
    for a, b in [(math.nan, 1.0), (1.0, math.nan), (math.inf, -0.0)]:
        assert same(function(a, b), float(plain["f"](a, b)))


def test_a_division_by_zero_has_the_answer_of_doubles():
    function = compiled("def f(a, b):\n    return a / b\n")
    assert function(1.0, 0.0) == math.inf
    assert function(-1.0, 0.0) == -math.inf
    assert math.isnan(function(0.0, 0.0))


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_are_those_of_the_system(name):
    function = compiled(f"def f(a, b):\n    return {name}(a) + b\n")
    for x in np.linspace(0.01, 2.9, 40):
        assert function(x, 0.0) == pytest.approx(getattr(math, name)(x), rel=3e-16)


BOUNDS = [tree for tree in ast.parse(inspect.getsource(RADII)).body if isinstance(tree, ast.FunctionDef)]
WHOLE_ARGUMENTS = {"whole_power_radius": 3}


@pytest.mark.parametrize("tree", BOUNDS, ids=lambda tree: tree.name)
def test_every_bound_of_a_function_is_that_of_python(tree):
    """At 400 points: of either sign, small, and large."""
    names = [argument.arg for argument in tree.args.args]
    last = WHOLE_ARGUMENTS.get(tree.name)
    text = inspect.getsource(RADII)
    if last is not None:
        text += f"\ndef f({', '.join(names[:-1])}):\n    return {tree.name}({', '.join(names[:-1])}, {last})\n"
        names = names[:-1]
    functions = {each.name: each for each in ast.parse(text).body if isinstance(each, ast.FunctionDef)}
    entry = tree.name if last is None else "f"
    code = emitted(
        lowered(functions, {"inf": math.inf, "nan": math.nan}, entry, ir.FunctionType(REAL, [REAL] * len(names))), entry
    )
    address = ctypes.cast(loaded(code, entry, len(names))[0], ctypes.c_void_p).value
    function = ctypes.CFUNCTYPE(ctypes.c_double, *[ctypes.c_double] * len(names))(address)
    plain = getattr(RADII, tree.name)
    draw, compared = random.Random(2), 0
    for _ in range(400):
        values = [draw.choice((-1, 1)) * 10 ** draw.uniform(-3, 1.5) for _ in names]
        values = [abs(value) if name == "r" else value for name, value in zip(names, values, strict=True)]
        try:
            want = plain(*values, *([] if last is None else [last]))
        except (ValueError, OverflowError, ZeroDivisionError):
            continue
        if isinstance(want, complex):
            continue
        compared += 1
        assert same(function(*values), want) or function(*values) == pytest.approx(want, rel=1e-14), values
    assert compared > 100


MODELS = {
    "duffing": ("x + x**3", "cos(t)"),
    "rational, exponential, friction": ("x/(1 + x**2) + exp(-x) + tanh(xdot)", "cos(t)"),
    "pendulum": ("sin(x) + xdot/10", "cos(t) + sin(2*t)/3"),
    "van der pol": ("(x**2 - 1)*xdot + x", "cos(t)"),
    "logarithm, arc tangent, tangent": ("log(2 + x**2) + atan(x)*xdot + tan(x/9)", "exp(cos(t))"),
    "logistic, softplus, root": ("x/(1 + exp(x)) + log(1 + exp(3*x)) + sqrt(1 + x**2)", "cos(t)**3/(2 + sin(t))"),
    "a power that is not whole": ("(3 + x)**(1/3) + x**2*xdot**3", "t"),
}
PARTS = range(5)
ROOM, DEGREE = 24, 20


def by_numba(flow):
    """The same recurrence as numba compiles it, an entry over the same addresses."""
    import numba
    from numba import types as kinds

    space = vars(types.ModuleType("recurrence"))
    space |= {**{name: getattr(math, name) for name in FUNCTIONS}, **constants()}
    functions = {
        name: each for module in MODULES for name, each in COMPILERS.functions_of(module).items() if name != "block"
    }
    made = {}
    exec(flow, {}, made)
    needed = {**{tree.name: functions[tree.name] for tree in BOUNDS}, **made}
    for name, function in needed.items():
        space[name] = numba.njit(error_model="numpy", **COMPILERS.UNWRAPPED)(
            types.FunctionType(function.__code__, space, name)
        )
    space |= COMPILERS._of_addresses()
    entry = types.FunctionType(functions["recurrence_entry"].__code__, space, "recurrence_entry")
    address = kinds.CPointer(kinds.float64)
    takes = kinds.void(kinds.CPointer(kinds.int64), *[address] * 6)
    return numba.cfunc(takes, error_model="numpy")(entry)


@pytest.mark.parametrize("name", [pytest.param(name, marks=pytest.mark.slow) for name in MODELS])
def test_a_recurrence_has_the_bits_that_numba_gives_it(name):
    model = CompiledModel(Oscillator(*MODELS[name], 0, "4/5"), Allowance(10.0))
    flow = model.emitted[0].flow
    code = emitted(text_of_model(Emitted(flow)), "recurrence_entry")
    takes = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 7)
    mine = takes(ctypes.cast(loaded(code, "recurrence_entry", 7)[0], ctypes.c_void_p).value)
    numbas = by_numba(flow)
    theirs = takes(numbas.address)
    draw = np.random.default_rng(0)
    p = np.zeros(ROOM)
    p[: model.flat.size - 16] = model.flat[16:]
    for _ in range(100):
        numbers, launch = draw.normal(size=4) / 2, draw.normal(size=ROOM)
        numbers[0] = abs(numbers[0])
        columns = np.zeros((3, ROOM))
        columns[:, :2] = draw.normal(size=(3, 2))
        results = []
        for function in (mine, theirs):
            X, W, A, shown = np.zeros(ROOM), np.zeros((model.flow.rows, ROOM)), columns.copy(), []
            for part in PARTS:
                sizes, own = np.array([part, DEGREE, len(W), ROOM]), numbers.copy()
                function(*(array.ctypes.data for array in (sizes, own, p, launch, X, W, A)))
                shown += [own.copy(), X.copy(), W.copy(), A.copy()]
            results.append(shown)
        assert all(np.array_equal(one, other, equal_nan=True) for one, other in zip(*results, strict=True))


def test_a_law_is_that_of_its_formula():
    model = CompiledModel(Oscillator("x", "cos(t)", 0, "-v/2 + v**2/(1 - v)/3 + v**2*(2 - v)**(1/5)"), Allowance(10.0))
    code = emitted(text_of_model(Emitted(rho=model.emitted[0].rho)), LAW)
    address = ctypes.cast(loaded(code, LAW, 2)[0], ctypes.c_void_p).value
    law = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double, ctypes.c_void_p)(address)
    for v in np.linspace(-3, -0.1, 60):
        want = -v / 2 + v**2 / (1 - v) / 3 + v**2 * (2 - v) ** 0.2
        assert law(v, model.rho.ctypes.data) == pytest.approx(want, rel=1e-14)


def test_a_wrong_formula_has_other_results():
    """The comparison above would see it: one sign of one line is changed."""
    text = TEXTS["loops and whole numbers"]
    wrong = compiled(text.replace("j + b * b", "j - b * b"))
    assert not same(wrong(0.5, 0.7), compiled(text)(0.5, 0.7))


@pytest.mark.parametrize(
    "line",
    ["return [a, b]", "with a:\n        pass", "return a % b", "return unknown(a)", "x: float = a",
     "return a if True else b", "return a.real", "a[0] = b"],
)  # fmt: skip
def test_other_constructs_are_refused(line):
    with pytest.raises((Unsupported, AttributeError)):
        lowered(trees(f"def f(a, b):\n    {line}\n"), {}, "f", ir.FunctionType(REAL, [REAL, REAL]))


def test_whole_numbers_stay_whole():
    text = lowered(trees("def f(n):\n    return 3 * n + 1\n"), {}, "f", ir.FunctionType(WHOLE, [WHOLE]))
    assert "mul i64" in text
    assert "double" not in text
