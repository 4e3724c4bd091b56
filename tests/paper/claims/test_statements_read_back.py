"""What is shown is what was verified: the formulas of a statement's value are read back from its LaTeX."""

import pytest
import sympy
from latex_reading import formulas

from singimpact.paper import CLAIMS, s
from singimpact.paper.routes.implicit import sigma

H = sympy.Symbol("H")
UNITS = {"s4-blowup": s, "s4-beta-tangent": sigma, "s4b-eps": sigma**2, "s6-scaling": H**3}  # of the value
WORDS = {  # formulas of the value that the text gives in words: the reason
    ("p:phising-set", "v"): "Z_c is v_c = 0",
    ("s2-discontinuity", "xdot"): "H_c is x-dot = 0",
    ("s4-domain", "m_-"): "m_- and m_+ are the zeros of Q_r(1, m)",
    ("s5-coordinates", "t"): "t follows from two equations",
    ("s6n-cusp", "C''"): "phi(C) is evaluated",
    ("t:t1", "direction"): "a span",
    ("s6p-gamma", "interval"): "a product of sets",
    ("s6n-visible", "arcs"): "a closed curve, named by its corners",
}


def statements():
    """(name, statement) of what is printed and what is corrected."""
    for name in CLAIMS:
        claim = CLAIMS[name]
        yield name, claim.printed
        if claim.corrected:
            yield name, claim.corrected()


def parts(value):
    """The formulas in a value, and the numbers that are not whole."""
    if isinstance(value, tuple | list):
        return [part for item in value for part in parts(item)]
    if isinstance(value, sympy.MatrixBase):
        return parts(list(value.flat()))
    if not isinstance(value, sympy.Expr) or value.is_Integer or value.is_infinite or value == sympy.Symbol("*"):
        return []
    return [value]


def missing(name, latex, value):
    """The parts of a value that cannot be read in the text."""
    read = formulas(latex)
    read += [formula / UNITS[name] for formula in read] if name in UNITS else []
    numbers = {formula.as_coeff_Mul()[0] for formula in read}
    return [part for part in parts(value) if not (part in numbers if part.is_Rational else _among(part, read))]


def _among(part, read):
    return any(part.free_symbols <= other.free_symbols and sympy.simplify(part - other) == 0 for other in read)


STATEMENTS = {(name, at): each for at, (name, each) in enumerate(statements()) if parts(each.value)}
READ = [key for key in STATEMENTS if key[0] not in {name for name, _ in WORDS}]


@pytest.mark.parametrize(
    "key",
    [
        pytest.param(key, marks=pytest.mark.slow if key[0].endswith("eigenvalue-limit") else (), id=key[0])
        for key in READ
    ],
)
def test_text_holds_the_formulas_that_are_verified(key):
    assert missing(key[0], STATEMENTS[key].latex, STATEMENTS[key].value) == []


def test_most_statements_are_read():
    assert len(READ) > 75


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [("e:meq", "2rm", "3rm"), ("s4b-l-range", r"\tfrac94kr\ ", r"\tfrac14kr\ "),
     ("t:t2-exists", r"\tfrac38", r"\tfrac34"),
     ("e:swan", "4\\sigma", "8\\sigma"), ("s5-hbar", "8m", "4m"), ("s4-horizon-line", "2t", "3t")],
)  # fmt: skip
def test_a_text_that_says_something_else_is_found(name, old, new):
    printed = CLAIMS[name].printed
    assert old in printed.latex
    assert missing(name, printed.latex.replace(old, new, 1), printed.value)
