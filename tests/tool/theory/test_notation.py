"""The printer: what is shown has the value it was given, and reads in the right order."""

import re

import pytest
import sympy
from hypothesis import given, settings, strategies as st

from singimpact import theory
from singimpact.theory import by_degree, factored, in_powers, latex

a, a1, a2, b, k, r, m, lam, sigma, eta, t = sympy.symbols("a a_d1 a_d2 b k r m lambda sigma eta t")
Q = sympy.Symbol("Q")


@pytest.mark.parametrize(
    ("expression", "shown"),
    [
        (sympy.Integer(0), "0"),
        (-sympy.Rational(3, 2), r"-\tfrac{3}{2}"),
        (1 - r, "1 - r"),
        (-k * eta**2 + 9 * k * sigma**2 / 4, r"\tfrac{9}{4} k \sigma^{2} - k \eta^{2}"),
        (a * (r - 1) * -1, "a (1 - r)"),
        (-2 / a, r"-\frac{2}{a}"),
        (a1**2, r"{a'}^{2}"),
        (sympy.sqrt(Q) / (m - sympy.Rational(1, 2)), r"\frac{\sqrt{Q}}{m - \tfrac{1}{2}}"),
        (r * (2 * m + 3) / (2 * m - 1) ** 2 / sympy.sqrt(Q), r"\frac{r (2 m + 3)}{(2 m - 1)^{2} \sqrt{Q}}"),
        (1 / (3 * m), r"\frac{1}{3 m}"),
        ((sigma, eta), r"\bigl(\sigma,\ \eta\bigr)"),
        (sympy.Matrix([[1, -2 / a], [0, r]]), r"\begin{pmatrix}1 & -\dfrac{2}{a}\\[0.6em] 0 & r\end{pmatrix}"),
        (sympy.Symbol("a_d7"), "a^{(7)}"),
    ],
)
def test_shown(expression, shown):
    assert latex(expression) == shown


def test_sums_by_degree():
    assert by_degree(a2 * sigma * t / 6 - a * t / 2 - (2 * a1 - a * b) * t**2 / 12, sigma, t) == [
        r"-\tfrac{1}{2} a t",
        r"\tfrac{1}{6} a'' \sigma t - \tfrac{1}{12} (2 a' - a b) t^{2}",
    ]


def _read(text):
    """A formula of sums, products and powers of m, r, t read back."""
    from sympy import Rational

    text = text.replace(r"\tfrac", "Rational").replace("}{", ",").replace("^{", "**(")
    text = text.replace("Rational{", "Rational(").replace("}", ")").replace(r"\bigl", "").replace(r"\bigr", "")
    out = []
    for at, token in enumerate(words := text.split(" ")):
        out.append(token)
        if at + 1 < len(words) and token not in "+-" and words[at + 1] not in "+-":
            out.append("*")
    return eval("".join(out).replace(")(", ")*("), {"Rational": Rational, "m": m, "r": r, "t": t})


coefficients = st.fractions(min_value=-9, max_value=9, max_denominator=9).map(lambda x: sympy.Rational(str(x)))


@settings(deadline=None)  # a first call loads sympy's printer, on a busy machine for seconds
@given(st.lists(st.tuples(coefficients, st.integers(0, 3), st.integers(0, 3), st.integers(0, 3)), max_size=6))
def test_a_polynomial_read_back_is_the_same(terms):
    expression = sympy.Add(*(c * m**i * r**j * t**n for c, i, j, n in terms))
    assert sympy.expand(_read(latex(expression)) - expression) == 0
    if expression != 0:
        assert sympy.expand(_read(in_powers(expression, r)) - expression) == 0
        assert sympy.expand(_read(factored(expression)) - expression) == 0
        assert sympy.expand(sum(_read(part) for part in by_degree(expression, m, t)) - expression) == 0


@pytest.mark.parametrize(
    "series",
    [
        theory.v_c(order=4, at="tangency"),
        theory.gamma(order=5),
        theory.fibre(order=3),
        theory.grazing_map(order=3),
        theory.normal_form(order=5).source,
        theory.normal_form(order=5).outline_of_p,
    ],
    ids=lambda series: type(series).__name__,
)
def test_sympy_writes_a_series_in_the_letters_of_the_paper(series):
    shown = sympy.latex(series)
    assert "a''" in shown
    assert not re.search(r"a_\{?d|PowerSeries|mathtt", shown)


def test_a_series_is_written_by_rising_powers_up_to_where_it_is_cut():
    shown = sympy.latex(theory.gamma(order=5))
    powers = [shown.index(rf"\sigma^{{{n}}}") for n in (2, 3, 4, 5)]
    assert powers == sorted(powers)
    assert shown.endswith(r" + O(\sigma^{6})")
    assert sympy.latex(theory.v_c(order=2, at="tangency")) == r"- \frac{a' \sigma t}{2} - \frac{a' t^{2}}{6}"
