"""Words into LaTeX and Markdown: signs that mean something there are written so that they mean themselves."""

from __future__ import annotations

import re

_LATEX = {
    "\\": r"\textbackslash{}",
    "{": r"\{",
    "}": r"\}",
    "$": r"\$",
    "&": r"\&",
    "#": r"\#",
    "%": r"\%",
    "_": r"\_",
    "^": r"\textasciicircum{}",
    "~": r"\textasciitilde{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
}
_FORMULA = re.compile(r"(\$[^$]*\$)")


def latex(text: str) -> str:
    """Plain text as LaTeX.

    Examples
    --------
    >>> print(latex("50% of f_10 & more"))
    50\\% of f\\_10 \\& more
    """
    return "".join(_LATEX.get(sign, sign) for sign in text)


def latex_words(text: str) -> str:
    """Words as LaTeX; what stands between dollar signs is a formula and stays.

    Examples
    --------
    >>> print(latex_words("at $v_c$ by 5%"))
    at $v_c$ by 5\\%
    """
    return "".join(part if _FORMULA.fullmatch(part) else latex(part) for part in _FORMULA.split(text))


def markdown(text: str) -> str:
    """Plain text as Markdown.

    Examples
    --------
    >>> print(markdown("f_10 * 2"))
    f\\_10 \\* 2
    """
    return re.sub(r"([\\`*_\[\]<>#|])", r"\\\1", text)


def markdown_words(text: str) -> str:
    """Words as Markdown; formulas between dollar signs stay."""
    return "".join(part if _FORMULA.fullmatch(part) else markdown(part) for part in _FORMULA.split(text))
