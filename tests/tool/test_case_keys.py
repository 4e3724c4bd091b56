"""The key of a sweep's output: whatever a function names is part of it, and nothing else is."""

from __future__ import annotations

import decimal
import json
import math
import os
import pkgutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from itertools import permutations
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from singimpact.case_keys import function_key
from singimpact.cases import sweep
from singimpact.inputs import InputError

HEAD = """
import dataclasses, decimal, enum, fractions, functools, math, operator, types
import numpy as np
from collections import namedtuple, deque
import case_units as units
"""
UNITS = "R = 2.0\ndef scale(v):\n    return R*v"
VARIANTS = {
    # the value that changes stands between the braces: {before|after}
    "a model": "import singimpact as si\nM = si.linear(2, '0.7', '{0.5|0.9}')\n"
               "def f(v): return float(M.impact_map(0.1, v).v)",
    "a dict": "P = dict(k={1.0|2.0})\ndef f(v): return P['k']*v",
    "a list": "P = [0.0, {1.0|2.0}]\ndef f(v): return P[1]*v",
    "a set": "P = {'a', '{b|c}'}\ndef f(v): return len(P & {'a', 'b'})*v",
    "a deque": "P = deque([{1.0|2.0}])\ndef f(v): return P[0]*v",
    "a number of numpy": "K = np.int64({1|2})\ndef f(v): return float(K*v)",
    "a fraction": "K = fractions.Fraction({1|2}, 3)\ndef f(v): return float(K)*v",
    "a decimal": "K = decimal.Decimal('{1|2}.5')\ndef f(v): return float(K)*v",
    "a complex number": "K = {1|2}j\ndef f(v): return abs(K)*v",
    "bytes": "K = b'{a|b}'\ndef f(v): return K[0]*v",
    "a sign of zero": "K = {0.0|-0.0}\ndef f(v): return math.copysign(v, K)",
    "a range": "K = range({3|4})\ndef f(v): return sum(K)*v",
    "containers in one another": "P = {'a': [(1, {'b': {1|2}})]}\ndef f(v): return P['a'][0][1]['b']*v",
    "a partial": "h = functools.partial(operator.mul, {2|3})\ndef f(v): return h(v)",
    "a dataclass": "@dataclasses.dataclass\nclass P:\n    k: float = 1.0\np = P({2|3})\ndef f(v): return p.k*v",
    "a factory of a dataclass": "@dataclasses.dataclass\nclass P:\n"
               "    k: list = dataclasses.field(default_factory=lambda: [{1|2}])\ndef f(v): return P().k[0]*v",
    "a namespace": "p = types.SimpleNamespace(k={1|2})\ndef f(v): return p.k*v",
    "a default of a named tuple": "P = namedtuple('P', 'k', defaults=[{1|2}])\ndef f(v): return P().k*v",
    "a member of an enum": "class E(enum.Enum):\n    A = {1|2}\ndef f(v): return E.A.value*v",
    "an attribute of a class": "class P:\n    k = {1|2}\n    def f(self, v): return self.k*v\nf = P().f",
    "another method": "class P:\n    def k(self): return {1|2}\n    def f(self, v): return self.k()*v\nf = P().f",
    "a method of a base": "class B:\n    def k(self): return {1|2}\nclass P(B):\n"
               "    def f(self, v): return self.k()*v\nf = P().f",
    "a metaclass": "class T(type):\n    def k(cls): return {1|2}\nclass P(metaclass=T): pass\n"
               "def f(v): return P.k()*v",
    "a property": "class P:\n    @property\n    def k(self): return {1|2}\np = P()\ndef f(v): return p.k*v",
    "a cached property": "class P:\n    @functools.cached_property\n    def k(self): return {1|2}\np = P()\n"
               "def f(v): return p.k*v",
    "a static method": "class P:\n    @staticmethod\n    def k(): return {1|2}\ndef f(v): return P.k()*v",
    "a method of a class": "class P:\n    s = {1|2}\n    @classmethod\n    def k(cls): return cls.s\n"
               "def f(v): return P.k()*v",
    "a slot": "class P:\n    __slots__ = ('k',)\np = P()\np.k = {1|2}\ndef f(v): return p.k*v",
    "a callable object": "class P:\n    def __init__(self, k): self.k = k\n    def __call__(self, v): return self.k*v\n"
               "f = P({1|2})",
    "an attribute of a list": "class L(list): pass\np = L([1])\np.k = {1|2}\ndef f(v): return p.k*v",
    "an attribute of a number": "class F(float): pass\np = F(1)\np.k = {1|2}\ndef f(v): return p.k*v",
    "an attribute of a function": "def h(): pass\nh.k = {1|2}\ndef f(v): return h.k*v",
    "a function in a dict": "P = dict(k=lambda v: {1|2}*v)\ndef f(v): return P['k'](v)",
    "a cached function": "@functools.lru_cache\ndef h(v): return {1|2}*v\ndef f(v): return h(v)",
    "a decorator": "def d(k):\n    def deco(g):\n        @functools.wraps(g)\n        def inner(v): return k*g(v)\n"
               "        return inner\n    return deco\n@d({1|2})\ndef f(v): return v",
    "a function that a library has wrapped": "import contextlib\n@contextlib.contextmanager\ndef h(v): yield {1|2}*v\n"
               "def f(v):\n    with h(v) as k: return k",
    "a case of a dispatched function": "@functools.singledispatch\ndef f(v): return v\n"
               "@f.register\ndef _(v: float): return {1|2}*v",
    "an attribute that pickle leaves out": "class P:\n    def __init__(self, k): self.k = k\n"
               "    def __getstate__(self): return {}\n    def __call__(self, v): return self.k*v\nf = P({1|2})",
    "a slot that pickle leaves out": "class P:\n    __slots__ = ('k',)\n    def __reduce__(self): return (P, ())\n"
               "p = P()\np.k = {1|2}\ndef f(v): return p.k*v",
    "an attribute of an array": "class A(np.ndarray): pass\np = np.arange(2.0).view(A)\np.k = {1|2}\n"
               "def f(v): return p.k*v",
    "the function of a function": "def a(v): return {1|2}*v\ndef b(v): return a(v)\ndef f(v): return b(v)",
    "functions that call each other": "def a(n): return {1|2} if n == 0 else b(n - 1)\n"
               "def b(n): return a(n)\ndef f(v): return a(3)*v",
    "a default of a function": "def h(v, k={1|2}): return k*v\ndef f(v): return h(v)",
    "a default by name": "def h(v, *, k={1|2}): return k*v\ndef f(v): return h(v)",
    "a closure": "def m(k):\n    def h(v): return k*v\n    return h\nh = m({1|2})\ndef f(v): return h(v)",
    "a name in a comprehension": "K = {1|2}\ndef f(v): return sum(K*v for _ in range(2))",
    "a name in a class inside": "K = {1|2}\ndef f(v):\n    class P:\n        k = K\n    return P.k*v",
    "which exception is caught": "def f(v):\n    try:\n        {}['a']\n    "
               "except {KeyError|(ValueError,)}:\n        return v\n    except LookupError:\n        return 2*v",
    "a method of a builtin": "get = dict(a={1|2}).get\ndef f(v): return get('a')*v",
    "an item": "get = operator.itemgetter({0|1})\ndef f(v): return get([1, 2])*v",
    "an array": "A = np.array([1.0, {1|2}])\ndef f(v): return A[1]*v",
    "a mask": "A = np.ma.array([1.0, 2.0], mask=[0, {0|1}])\ndef f(v): return float(A.sum())*v",
    "an array of objects": "A = np.array([{'k': {1|2}}], dtype=object)\ndef f(v): return A[0]['k']*v",
    "the name of a field": "A = np.array([(1.0, 2.0)], dtype=[('{k|m}', 'f8'), ('{m|k}', 'f8')])\n"
               "def f(v): return float(A['k'][0])*v",
    "a polynomial": "p = np.polynomial.Polynomial([0, {1|2}])\ndef f(v): return float(p(v))",
    "a compiled pattern": "import re\np = re.compile('{a|b}')\ndef f(v): return len(p.findall('aab'))*v",
    "an abstract method": "import abc\nclass A(abc.ABC):\n    @abc.abstractmethod\n    def k(self): return {1|2}\n"
               "class B(A):\n    def k(self): return super().k()\np = B()\ndef f(v): return p.k()*v",
    "an expression of sympy": "import sympy\ne = {1|2}*sympy.Symbol('x')\ndef f(v): return float(e.subs('x', v))",
    "a function of a module": ("R = 2.0\ndef scale(v):\n    return {1|2}*v", "def f(v): return units.scale(v)"),
    "a number of a module": ("R = {1.0|2.0}", "def f(v): return units.R*v"),
    "what a module's function names": ("R = {1|2}\ndef scale(v): return R*v", "def f(v): return units.scale(v)"),
    "an attribute by text": ("R = {1|2}", "def f(v): return getattr(units, 'R')*v"),
    "a module under another name": ("R = {1|2}", "def f(v):\n    u = units\n    return u.R*v"),
    "a module imported inside": ("R = {1|2}", "def f(v):\n    import case_units\n    return case_units.R*v"),
    "a number imported inside": ("R = {1|2}", "def f(v):\n    from case_units import R as K\n    return K*v"),
    "a class of a module": ("class P:\n    k = {1|2}", "def f(v): return units.P.k*v"),
}  # fmt: skip


def sides(text):
    """The text before and after its change."""
    before, after = [], []
    while "{" in text:
        first, _, rest = text.partition("{")
        inner, _, last = rest.partition("}")
        if "|" in inner and "{" not in inner:
            pair = inner.split("|")
            before, after, text = [*before, first, pair[0]], [*after, first, pair[1]], last
        else:
            before, after, text = [*before, first, "{"], [*after, first, "{"], rest
    return "".join([*before, text]), "".join([*after, text])


def built(variant, side=0):
    """The function of a variant, in modules made anew."""
    units, text = variant if isinstance(variant, tuple) else (UNITS, variant)
    for module, source in (("case_units", sides(units)[side]), ("case_script", HEAD + sides(text)[side])):
        sys.modules[module] = ModuleType(module)
        exec(source, vars(sys.modules[module]))
    return sys.modules["case_script"].f


@pytest.fixture(autouse=True)
def no_modules_stay():
    yield
    for name in ("case_units", "case_script"):
        sys.modules.pop(name, None)


def all_keys():
    return {name: function_key(built(VARIANTS[name])) for name in VARIANTS}


@pytest.mark.plain_code
@pytest.mark.parametrize("name", VARIANTS)
def test_results_are_not_returned_after_what_is_named_has_changed(name, tmp_path):
    output = tmp_path / "stored.npz"
    with ThreadPoolExecutor(1) as pool:
        first = sweep(built(VARIANTS[name]), [1.0, 2.0], pool, output).tolist()
        assert sweep(built(VARIANTS[name]), [1.0, 2.0], NoPool(), output).tolist() == first
        changed = built(VARIANTS[name], 1)
        with pytest.raises(InputError, match="another function"):
            sweep(changed, [1.0, 2.0], pool, output)
        assert str(sweep(changed, [1.0, 2.0], pool, tmp_path / "other.npz").tolist()) != str(first)


class NoPool:
    """An executor for sweeps that compute nothing."""

    def submit(self, *_):
        raise AssertionError("a result was computed")


@pytest.mark.plain_code
def test_reading_a_key_does_not_change_it():
    """Python stores the names of slots in a class when one of its objects is read for the first time."""
    for name in VARIANTS:
        function = built(VARIANTS[name])
        assert function_key(function) == function_key(function), name


@pytest.mark.plain_code
def test_another_process_has_the_same_keys():
    code = (
        "import sys, json; sys.path.insert(0, sys.argv[1]); import test_case_keys as t; print(json.dumps(t.all_keys()))"
    )
    runs = [
        subprocess.Popen(
            [sys.executable, "-c", code, Path(__file__).parent],
            env=os.environ | {"PYTHONHASHSEED": seed},
            stdout=subprocess.PIPE,
            text=True,
        )
        for seed in ("1", "2")
    ]
    answers = [run.communicate()[0] for run in runs]
    assert [json.loads(answer) for answer in answers] == [all_keys()] * 2


PUT_IN = {
    # what a program puts in the place of what an installed package holds
    "a number": ("def f(v): return math.pi*v", "math", "pi", 3.0),
    "a function": ("def f(v): return math.sin(v)", "math", "sin", lambda v: 5*v),
    "another function of the package": ("def f(v): return math.sin(v)", "math", "sin", math.cos),
    "a function of a part": ("def f(v): return float(np.linalg.norm([v]))", "numpy.linalg", "norm", lambda v: 7*v[0]),
    "a function imported inside": ("def f(v):\n    from math import sin\n    return sin(v)", "math", "sin", abs),
    "a builtin": ("def f(v): return abs(v)", "builtins", "abs", lambda v: 9*v),
    "a new builtin": ("def f(v): return k_of_tests*v", "builtins", "k_of_tests", 2.0),
    "a class": ("def f(v): return float(fractions.Fraction(v))", "fractions", "Fraction", type("Half", (float,), {})),
    "a method": ("x = fractions.Fraction(1, 3)\ndef f(v): return float(x.limit_denominator(2))*v",
                 "fractions:Fraction", "limit_denominator", lambda x, n: x/n),
    "the digits of mpmath": ("import mpmath\ndef f(v): return float((mpmath.mpf(v) + mpmath.mpf(10)**-20 - v)*1e20)",
                             "mpmath:mp", "dps", 40),
    "the digits of a context": ("from mpmath import mp\ndef f(v): return float((mp.mpf(v) + mp.mpf(10)**-20 - v)*1e20)",
                                "mpmath:mp", "dps", 40),
}  # fmt: skip


@pytest.mark.plain_code
@pytest.mark.parametrize("name", PUT_IN)
def test_results_are_not_returned_after_an_installed_package_was_changed(name, monkeypatch):
    text, place, attribute, value = PUT_IN[name]
    function = built(text)
    key = function_key(function)
    with monkeypatch.context() as patch:
        patch.setattr(pkgutil.resolve_name(place), attribute, value, raising=False)
        assert function_key(function) != key
    assert function_key(function) == key


@pytest.mark.plain_code
def test_the_digits_of_decimals_are_part_of_the_key():
    function = built("def f(v): return float(decimal.Decimal(v)/3)")
    keys = []
    for digits in (28, 9, 28):
        with decimal.localcontext() as context:
            context.prec = digits
            keys.append(function_key(function))
    assert keys[0] == keys[2] != keys[1]


CYCLES = """
class Node:
    def __init__(self, k): self.k, self.next, self.peers = k, self, {self}
n = Node({1|2})
L = [1]
L.append(L)
def f(v): return n.k*v*L[0]
"""


@pytest.mark.plain_code
def test_objects_that_contain_themselves_have_keys():
    keys = [function_key(built(CYCLES, side)) for side in (0, 0, 1)]
    assert keys[0] == keys[1] != keys[2]


@pytest.mark.plain_code
def test_what_a_function_computes_from_its_names_does_not_change_its_key():
    """A log that is only written, and a value that an object stores, may differ when a sweep is resumed."""
    text = """
LOG = []
class P:
    @functools.cached_property
    def k(self): return 2
p = P()
def f(v):
    LOG.append(v)
    return p.k*v
"""
    function = built(text)
    before = function_key(function)
    assert function(1.0) == 2
    assert function_key(function) == before


REFUSED = {
    "a lock": "import threading\nLOCK = threading.Lock()\ndef f(v):\n    with LOCK: return v",
    "a generator": "G = (n for n in range(3))\ndef f(v): return next(G)*v",
    "a hidden function": "h = np.frompyfunc(lambda v: 2*v, 1, 1)\ndef f(v): return h(v)",
    "globals": "K = 2\ndef f(v): return globals()['K']*v",
    "globals of a function": "K = 2\ndef f(v): return f.__globals__['K']*v",
    "the environment": "import os\ndef f(v): return len(os.environ['PATH'])*v",
    "the environment by another name": "from os import environ\ndef f(v): return len(environ['PATH'])*v",
    "a variable of the environment": "import os\ndef f(v): return len(os.getenv('PATH'))*v",
    "text that is run": "K = 2\ndef f(v): return eval('K*v')",
    "a deep list": "D = []\nfor _ in range(1000): D = [D]\ndef f(v): return len(D)*v",
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_has_no_key_is_refused_by_its_name(name, tmp_path):
    function = built(REFUSED[name])
    with ThreadPoolExecutor(1) as pool:
        with pytest.raises(InputError, match=r"has no key for stored results, .*: leave output= out, or"):
            sweep(function, [1.0], pool, tmp_path / "stored.npz")
        assert not list(tmp_path.iterdir())


ALIKE = (
    ([1, 2], [12], [True], [1.0], ["1"], [(1, 2)], [[1], 2], [[1, 2]], [np.int64(1), 2]),
    (["a", "b"], ["ab"], ["a str 1 b"], [b"a"], ["b'a'"], ["\ud800"], ["\\ud800"], ["None"], [None]),
    ([0.0], [-0.0], [2**70], [float(2**70)], [np.float64(0)], [float("nan")]),
)


@pytest.mark.parametrize("alike", ALIKE)
def test_results_of_cases_that_look_alike_are_not_returned(alike, tmp_path):
    with ThreadPoolExecutor(1) as pool:
        for number, (first, second) in enumerate(permutations(alike, 2)):
            output = tmp_path / f"{number}.npz"
            for _ in range(2):
                assert sweep(lambda _: 1.0, first, pool, output).size == len(first)
            with pytest.raises(InputError, match="other cases"):
                sweep(lambda _: 1.0, second, pool, output)
