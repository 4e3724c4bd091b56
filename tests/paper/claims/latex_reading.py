"""Reads LaTeX of statements back: the formulas in it as sympy expressions, by a parser of its own."""

import re
from itertools import pairwise

import sympy

COMMANDS = {
    name: name for name in ("sigma", "tau", "eta", "ell", "lambda", "kappa", "omega", "delta", "psi", "phi", "xdot")
}
NAMED = {  # what the paper abbreviates
    "_c(\\tau)": "",
    r"_c'(\tau)": "'",
    r"\dot x_c(\tau,0;t)": r"\xdot ",
    r"\dot x_c": r"\xdot ",
    r"a(\tau)": "a",
    "m_1": "m",
    "Q_r(1,m)": r"(r(2m^2-3m)+\tfrac94(m-\tfrac12)^2)",
    r"Q_r(\sigma,\eta)": r"(r(2\eta^2-3\sigma\eta)+\tfrac94(\eta-\tfrac12\sigma)^2)",
    "Mr(": r"(3+2\ell)(3+\ell)^{-1}(1+\ell)^{-2}r(",
    "f'(m_*)/g'(m_*)": r"(\tfrac{r(6+16m+9m^2)}{(1+m)^3}-\tfrac{3r(6m+8m^2+3m^3)}{(1+m)^4})(6+8m+3m^2)^{-1}",
    "N_r(m)\\end": r"r(2m+3)(2m-1)^{-2}Q^{-\frac12}\end",
}
SPACES = re.compile(r"\\[,!; ]|\\q?quad|\\[bB]ig[lr]?|\\left(?![a-z])|\\right(?![a-z])")
BETWEEN = re.compile(
    r"\\text\{[^}]*\}|\\(?:mapsto|to|sim|le|ge|ne|Rightarrow|subset|iff|in|nearrow|cup|cap|setminus)(?![a-zA-Z])"
    r"|\\(?:begin|end)\{pmatrix\}|\\\\|\\[{}]|[<>:;&]"
)
PRIMES = {"a": "a_d"}


class Unreadable(ValueError):
    """The text is no formula."""


class Reader:
    """Recursive descent over sums, products and powers; a product needs no sign."""

    def __init__(self, text):
        self.text, self.at = text, 0

    def peek(self):
        while self.text.startswith(" ", self.at):
            self.at += 1
        return self.text[self.at] if self.at < len(self.text) else ""

    def take(self, expected):
        if not self.text.startswith(expected, self.at):
            raise Unreadable(self.text)
        self.at += len(expected)

    def whole(self):
        value = self.sum()
        if self.peek():
            raise Unreadable(self.text)
        return value

    def sum(self):
        total, sign = sympy.Integer(0), 1
        if self.peek() and self.peek() in "+-":
            sign = -1 if self.peek() == "-" else 1
            self.at += 1
        while True:
            total += sign * self.product()
            if not self.peek() or self.peek() not in "+-":
                return total
            sign = -1 if self.peek() == "-" else 1
            self.at += 1

    def product(self):
        value = self.power()
        while self.peek() and self.peek() not in "+-)]},":
            if self.peek() == "/":
                self.at += 1
                value /= self.power()
            else:
                value *= self.power()
        return value

    def power(self):
        base = self.atom()
        if self.peek() == "^":
            self.at += 1
            base **= self.short()
        return base

    def short(self):
        """A group in braces, or one digit, letter or command."""
        if self.peek() == "{":
            self.at += 1
            value = self.sum()
            self.take("}")
            return value
        if self.peek().isdigit():
            self.at += 1
            return sympy.Integer(self.text[self.at - 1])
        return self.atom()

    def atom(self):
        if self.peek() and self.peek() in "([":
            close = {"(": ")", "[": "]"}[self.peek()]
            self.at += 1
            value = self.sum()
            self.take(close)
            return value
        if number := re.match(r"\d+", self.text[self.at :]):
            self.at += number.end()
            return sympy.Integer(number.group())
        if command := re.match(r"\\([a-zA-Z]+)", self.text[self.at :]):
            return self.command(command)
        if self.peek().isalpha() or self.peek() == "*":
            self.at += 1
            return self.letter(self.text[self.at - 1])
        raise Unreadable(self.text)

    def command(self, match):
        name = match.group(1)
        self.at += match.end()
        if name in ("frac", "tfrac"):
            return self.short() / self.short()
        if name == "sqrt":
            return sympy.sqrt(self.short())
        if name == "cos":
            return sympy.cos(self.product())
        if name == "pi":
            return sympy.pi
        if name == "bar":
            return sympy.Symbol(f"{self.short()}bar")
        if name not in COMMANDS:
            raise Unreadable(self.text)
        return self.letter(COMMANDS[name])

    def letter(self, name):
        primes = re.match(r"'+", self.text[self.at :])
        if primes:
            self.at += primes.end()
            name = f"{PRIMES.get(name, name + '_')}{primes.end()}"
        if self.peek() == "_":
            index = re.match(r"_(\{[^}]*\}|.)", self.text[self.at :])
            self.at += index.end()
            inner = index.group(1).strip("{}")
            name = name if inner in ("*", "c") else f"{name}_{inner}"
        return sympy.Symbol(name)


def without_remainders(text):
    """(the text without + O(...) and + dots, what stands in each O)."""
    text, orders = text.replace(r"+\dots", ""), []
    while (start := text.find("+O(")) >= 0:
        depth, end = 1, start + 3
        while depth:
            depth += {"(": 1, ")": -1}.get(text[end], 0)
            end += 1
        orders.append(text[start + 3 : end - 1])
        text = text[:start] + text[end:]
    return text, orders


def clauses(text):
    """Texts between relations, arrows, words and commas, at every depth of parentheses; equations stay whole."""
    found = []
    for piece in BETWEEN.split(text):
        parts, depth, start = [], 0, 0
        for at, letter in enumerate(piece):
            depth += {"(": 1, "[": 1, "{": 1, ")": -1, "]": -1, "}": -1}.get(letter, 0)
            if letter == "," and depth == 0:
                parts.append(piece[start:at])
                start = at + 1
        parts.append(piece[start:])
        for part in parts:
            found.append(part)
            for side in part.split("="):
                inner = re.fullmatch(r"[^(]*?\((.*)\)\s*", side)
                found += clauses(inner.group(1)) if inner and "," in inner.group(1) else []
    return found


def formulas(latex):
    """Every formula that can be read in a statement; of an equation also its sides' difference and its solutions."""
    text, orders = without_remainders(SPACES.sub(" ", latex).replace(" +O", "+O"))
    for name, meaning in NAMED.items():
        text = text.replace(name, meaning)
    found = [value for order in orders if (value := read(order)) is not None]
    for clause in clauses(text):
        sides = [value for side in clause.split("=") if (value := read(side)) is not None]
        found += sides
        for left, right in pairwise(sides):
            found += [left - right, right - left, *solutions(left - right)]
    named = dict(re.findall(r"([TD])=(\\frac\{.*?\}\{\([^)]*\)\^\{2\}\})", text))
    if set(named) == {"T", "D"}:  # trace and determinant: the larger root
        trace, determinant = (read(named[name]) for name in "TD")
        found.append((trace + sympy.sqrt(trace**2 - 4 * determinant)) / 2)
    return found


def solutions(difference):
    """What an equation says each of its letters is, where it is linear in it."""
    lines = [
        (letter, sympy.Poly(difference, letter)) for letter in difference.free_symbols if difference.is_polynomial()
    ]
    return [letter - line.as_expr() / line.LC() for letter, line in lines if line.degree() == 1]


def read(text):
    """The expression that a text means, or None."""
    try:
        return Reader(text).whole()
    except (Unreadable, IndexError):
        return None
