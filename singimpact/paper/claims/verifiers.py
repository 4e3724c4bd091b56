"""Ways to decide a statement: an identity of exact expressions, and signs proved on an interval."""

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from itertools import product
from typing import Any

import sympy

from singimpact.algebra import At, identical, substitution
from singimpact.paper.claims.claim import Check
from singimpact.paper.routes.implicit import X, Y

_SAMPLES = [Fraction(n, d) for n, d in ((3, 5), (7, 4), (2, 9), (11, 6), (5, 13), (17, 8), (1, 7), (19, 12))]


def is_zero(expression: Any) -> bool:
    """Whether an expression with rational coefficients and one square root vanishes identically, decided exactly.

    Where its terms cancel by the relation of the root, that is kept as a certificate; rational functions that are the
    same once they are cancelled leave none.

    Raises
    ------
    ArithmeticError : two roots whose radicands are not in the ratio of two rational squares.
    """
    expression = sympy.sympify(expression)
    if not _cancels(sympy.together(expression)):
        return False
    if expression.is_Add:
        identical(expression.args[0], sympy.Add(*(-term for term in expression.args[1:])))
    return True


def same(left: Any, right: Any) -> bool:
    """Whether two expressions are equal, decided as by `is_zero`, with its certificate."""
    left, right = sympy.sympify(left), sympy.sympify(right)
    equal = _cancels(sympy.together(left - right))
    if equal:
        identical(left, right)
    return equal


def agree(outer: Any, images: Mapping[Any, Any], stated: Any) -> bool:
    """Whether a function with images put for its variables, at once, is the stated one, with its certificate.

    Examples
    --------
    >>> x, y = sympy.symbols("x y")
    >>> agree(x * y, {x: y, y: 1 / x}, y / x), agree(x * y, {x: y}, y)
    (True, False)
    """
    equal = _cancels(sympy.together(outer.subs(images, simultaneous=True) - stated))
    if equal:
        substitution(At(outer, images), stated)
    return equal


def is_eigenvector(matrix: sympy.MatrixBase, value: Any, vector: tuple[Any, Any]) -> bool:
    """Whether a matrix of two rows multiplies a vector by a number, with certificates."""
    images = dict(zip((X, Y), vector, strict=True))
    return all(agree(a * X + b * Y, images, value * x) for (a, b), x in zip(matrix.tolist(), vector, strict=True))


def _cancels(expression: sympy.Expr) -> bool:
    roots = sorted((p for p in expression.atoms(sympy.Pow) if p.exp.is_Rational and p.exp.q == 2), key=str)
    if not roots:
        return bool(sympy.cancel(expression) == 0)
    w, base = sympy.Dummy("w"), sympy.expand(roots[0].base)
    replaced = expression.subs({root: (w * _root_ratio(root.base, base)) ** (2 * root.exp) for root in roots})
    numerator = sympy.fraction(sympy.cancel(replaced))[0]
    below, above = sympy.fraction(sympy.cancel(base))[::-1]
    return bool(sympy.cancel(sympy.rem(numerator, below * w**2 - above, w)) == 0)


def _root_ratio(radicand: sympy.Expr, base: sympy.Expr) -> Any:
    """sqrt(radicand)/sqrt(base), when it is a positive rational."""
    ratio = sympy.sqrt(sympy.cancel(radicand / base))
    if not ratio.is_Rational:
        raise ArithmeticError(f"more than one radical: {radicand} and {base}")
    return ratio


def parts_of(value: Any) -> list[Any]:
    """The scalar parts of an expression, a tuple (nested or not) or a matrix."""
    if isinstance(value, tuple | list):
        return [part for item in value for part in parts_of(item)]
    return list(value.flat()) if isinstance(value, sympy.MatrixBase) else [sympy.sympify(value)]


def root_of_line(expression: Any, letter: sympy.Expr) -> Any:
    """The root of an expression of degree 1 in a letter.

    Raises
    ------
    ArithmeticError : it has another degree.

    Examples
    --------
    >>> x, y = sympy.symbols("x y")
    >>> root_of_line(2 * x - y, x)
    y/2
    """
    line = sympy.Poly(expression, letter)
    if line.degree() != 1:
        raise ArithmeticError(f"{expression} is not linear in {letter}")
    return -line.nth(0) / line.nth(1)


def identity(truth: Callable[[], Any], what: str = "derived from the equation of motion") -> Callable[[Any], Check]:
    """A verifier: the statement equals what `truth` derives, part by part, as exact expressions.

    Parameters
    ----------
    truth : derives the expression, tuple or matrix; called when the claim runs.
    what : where the derived side comes from, for the evidence.
    """

    def verify(value: Any) -> Check:
        stated, derived = parts_of(value), parts_of(truth())
        if len(stated) != len(derived):
            raise ArithmeticError(f"{len(stated)} parts are stated, {len(derived)} derived")
        for left, right in zip(stated, derived, strict=True):
            if not _cancels(sympy.together(left - right)):
                return Check(False, "proved", f"differs from what is {what}", sample(left, right))
        for left, right in zip(stated, derived, strict=True):
            identical(left, right)
        return Check(True, "proved", f"equal to what is {what}, as exact expressions")

    return verify


def sample(stated: Any, derived: Any) -> dict[str, str]:
    """Numbers at which two expressions differ: few letters that are 1 and the rest 0, where that tells them apart."""
    symbols = sorted(stated.free_symbols | derived.free_symbols, key=str)
    few = sorted(product((Fraction(0), Fraction(1)), repeat=len(symbols)), key=sum)
    for values in (*few, *((_SAMPLES * 3)[shift : shift + len(symbols)] for shift in range(len(_SAMPLES)))):
        point = dict(zip(symbols, map(sympy.Rational, values), strict=True))
        left, right = (side.subs(point) for side in (stated, derived))
        if left.is_finite and right.is_finite and (left - right).equals(0) is False:
            at = ", ".join(f"{name} = {value}" for name, value in point.items() if value)
            return {
                "at": f"{at}, all else 0".lstrip(", ") if 0 in point.values() else at or "every point",
                **{of: str(x if x.is_Rational else sympy.N(x, 9)) for of, x in (("stated", left), ("derived", right))},
            }
    raise ArithmeticError("no sample point tells the two expressions apart")


def every(
    checks: Mapping[str, bool] | Sequence[tuple[str, bool] | Check],
    kind: str = "proved",
    witness: Callable[[], dict[str, str]] | None = None,
    modulo: tuple[str, ...] = (),
    tried: Callable[[], tuple[str, bool]] | None = None,
) -> Check:
    """One check from several named ones; all must pass.

    Parameters
    ----------
    checks : what was tested -> whether it passed; or a list of such pairs and of checks that have their own evidence.
    witness : numbers for a failure of a part that has none of its own; without it the parts that failed are named.
    modulo : names of theorems that take the checks for their hypotheses.
    tried : a trial on true orbits, run where the checks pass. It decides nothing: an integrator that fails or raises
        makes no theorem wrong, and the evidence names it.

    Examples
    --------
    >>> every({"0 < mu < 1": True}, modulo=("the stable manifold theorem",)).kind
    'proved modulo'
    >>> every({"0 < mu < 1": True}, tried=lambda: ("two orbits agree to 1e-9", False)).evidence
    '0 < mu < 1; a trial apart from the argument FAILS: two orbits agree to 1e-9'
    """
    checks = list(checks.items()) if isinstance(checks, Mapping) else checks
    named = [(check.evidence, check.holds) if isinstance(check, Check) else check for check in checks]
    failed = [name for name, passed in named if not passed]
    if not failed:
        apart = [] if tried is None else [_apart(tried)]
        return Check(True, kind, "; ".join([*(name for name, _ in named), *apart]), modulo=modulo)
    own = next((check.witness for check in checks if isinstance(check, Check) and check.witness), None)
    shown = own or (witness() if witness else {"fails": "; ".join(failed)})
    return Check(False, kind, f"fails: {'; '.join(failed)}", shown, modulo)


def _apart(trial: Callable[[], tuple[str, bool]]) -> str:
    try:
        name, passed = trial()
    except Exception as error:  # whatever ends an integrator, the argument stands
        name, passed = f"{type(error).__name__}: {error}", False
    return f"a trial apart from the argument{'' if passed else ' FAILS'}: {name}"
