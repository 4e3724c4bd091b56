"""Plain words of claims, with the letters of formulas between dollar signs; loads no sympy."""

from __future__ import annotations

import re

_GREEK = "sigma|tau|eta|omega|kappa|lambda|beta|gamma|phi|chi|psi|ell|Pi"
_SIGNS = {"!=": r"\ne", "<=": r"\le", ">=": r"\ge", "->": r"\to"}
_LETTERS = re.compile(
    rf"(?P<dot>x-dot|x_dot)(?P<wall>_c)?|(?P<sign>!=|<=|>=|->)|\b(?P<jet>a)_d(?P<order>\d)\b|\b(?P<name>{_GREEK}|dv|[A-Za-z])"
    r"(?P<below>_[A-Za-z0-9*+-]+|_\([a-z ]+\)|(?<=m)[123])?(?P<primes>'+)?(?![A-Za-z0-9_('])"
)


def in_letters(text: str) -> str:
    r"""Plain words in which the letters of formulas get dollar signs: sigma, a_d1, x-dot, tau_*, m2, f_10.

    Examples
    --------
    >>> print(in_letters("x-dot/h^2 at sigma' = -h, a_d1 = 7/4, m2 a root, f_10 = 2"))
    $\dot x$/h^2 at $\sigma'$ = -h, $a'$ = 7/4, $m_{2}$ a root, $f_{10}$ = 2
    """
    return _LETTERS.sub(_letter, text)


def _letter(letter: re.Match[str]) -> str:
    if letter["dot"]:
        return rf"$\dot x{letter['wall'] or ''}$"
    if letter["sign"]:
        return f"${_SIGNS[letter['sign']]}$"
    if letter["jet"]:
        return f"$a{chr(39) * int(letter['order'])}$"
    name, below, primes = letter["name"], (letter["below"] or "").strip("_()"), letter["primes"] or ""
    if len(name) == 1 and not below and not primes:
        return letter[0]  # an article, or a letter that reads as well without
    below = re.sub(rf"\b({_GREEK})\b", r"\\\1", below)
    return f"${name if name == 'dv' or len(name) == 1 else chr(92) + name}{f'_{{{below}}}' if below else ''}{primes}$"
