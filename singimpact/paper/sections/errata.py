"""The errata: each statement that fails as printed, with what holds instead, why, the witness, and what survives."""

import re
import tomllib
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from typing import Any, overload

from singimpact.documents.rendering import environment, wrapping
from singimpact.inputs import checked_keywords
from singimpact.paper.claims.claim import Claim, Verdict
from singimpact.paper.claims.index import Entry, places_in_paper
from singimpact.paper.sections.stored_sections import LETTERS, kept_legend

# Where a claim stands in the paper: page, equation, theorem and line, for a reader with the paper beside him.

PAPER = "D. R. J. Chillingworth, Dynamics of an impact oscillator near a degenerate graze"
VERSION = (
    "Preprint submitted to Nonlinearity. Numbers of equations and theorems are those of its LaTeX source; pages are "
    "those of the source set in the class article at 12 pt (24 pages), and may differ by one or two in print."
)


@dataclass(frozen=True)
class Place:
    """Where a claim stands in the paper.

    Attributes
    ----------
    page : of the preprint, see `VERSION`. line : of its LaTeX source. equations : the numbers of the displayed
        equations that hold the claim, empty where it stands in the text. statement : such as "Theorem 4.1", or "".
    """

    page: int
    line: int
    equations: tuple[int, ...]
    statement: str

    def __str__(self) -> str:
        return ", ".join(part for part in (f"p. {self.page}", self.statement, self.numbers) if part)

    @property
    def numbers(self) -> str:
        """The numbers of the equations, as they are printed.

        Examples
        --------
        >>> place_of("s4-blowup").numbers, str(place_of("t:t2-fixed"))
        ('(24), (25)', 'p. 11, Theorem 4.1')
        """
        return ", ".join(f"({number})" for number in self.equations)


def place_of(claim: str) -> Place:
    """The place of a claim of the paper, by its id.

    Raises
    ------
    KeyError : a claim that the paper does not have.
    """
    where = {line["id"]: line for line in places_in_paper()}[claim]
    return Place(where["page"], where["line"], tuple(where["equations"]), where["statement"])


# Remarks on each misprint, in `remarks.toml`: its kind, its reason, and what it does not touch. Verdicts, corrections
# and numbers are computed; a claim that is corrected and has no remark, or has one and is not corrected, fails a test.

GRADES = {
    "slip": "slip of the pen",
    "sign": "wrong sign",
    "constant": "wrong constant",
    "argument": "argument to repair",
    "reading": "matter of reading",
}
PLURALS = {
    "slip": "slips of the pen",
    "sign": "wrong signs",
    "constant": "wrong constants",
    "argument": "steps of arguments to repair",
    "reading": "matters of reading",
}


@dataclass(frozen=True)
class Remark:
    """One remark on the paper.

    Attributes
    ----------
    claims : ids of the claims that it is about. grade : a key of `GRADES`. reason : why the printed statement fails.
    survives : what of the paper does not depend on it, or how it is repaired.  Formulas stand between dollar signs.
    """

    claims: tuple[str, ...]
    grade: str
    reason: str
    survives: str


REMARKS = tuple(
    Remark(tuple(fields.pop("claims")), **fields)
    for fields in tomllib.loads(Path(__file__).with_name("remarks.toml").read_text(encoding="utf-8"))["remarks"]
)


@cache
def remark_on(claim: str) -> Remark | None:
    """The remark on a claim, by its id; None where there is none.

    Examples
    --------
    >>> remark_on("s4b-ratio").grade, remark_on("e:meq")
    ('constant', None)
    """
    return next((remark for remark in REMARKS if claim in remark.claims), None)


# Plain words of claims, with the letters of formulas between dollar signs; loads no sympy.

_GREEK = "sigma|tau|eta|omega|kappa|lambda|beta|gamma|phi|chi|psi|ell|Pi"
_SIGNS = {"!=": r"\ne", "<=": r"\le", ">=": r"\ge", "->": r"\to"}
_LETTERS = re.compile(
    rf"(?P<dot>x-dot|x_dot)(?P<wall>_c)?|(?P<sign>!=|<=|>=|->)|\b(?P<jet>a)_d(?P<order>\d)\b|\b(?P<name>{_GREEK}|dv|[A-Za-z])"
    r"(?P<below>_[A-Za-z0-9*+-]+|_\([a-z ]+\)|(?<=m)[123])?(?P<primes>'+)?(?![A-Za-z0-9_'])"
)


def in_letters(text: str) -> str:
    r"""Plain words in which the letters of formulas get dollar signs: sigma, a_d1, x-dot, tau_*, m2, f_10.

    Examples
    --------
    >>> print(in_letters("x-dot/h^2 at sigma' = -h, a_d1 = 7/4, m2 a root, f_10 = 2, Q_r(1, m)"))
    $\dot x$/h$^{2}$ at $\sigma'$ = -h, $a'$ = 7/4, $m_{2}$ a root, $f_{10}$ = 2, $Q_{r}$(1, m)
    """
    return re.sub(r"\^(\d+)", r"$^{\1}$", _LETTERS.sub(_letter, text)).replace("$$^", "^")


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


@dataclass(frozen=True)
class Erratum:
    """One misprint.

    Attributes
    ----------
    verdict : of the claim.
    dependants : id -> effective verdict, in words, of the claims that rest directly on it, that is on the corrected
        statement.
    """

    verdict: Verdict
    dependants: dict[str, str]

    @property
    def place(self) -> Place:
        """Page, equation and theorem of the paper."""
        return place_of(self.verdict.id)

    @property
    def remark(self) -> Remark:
        """The kind of misprint, its reason, and what it does not touch; several misprints may share one remark."""
        found = remark_on(self.verdict.id)
        if found is None:
            raise LookupError(f"{self.verdict.id} is corrected and has no remark in remarks.toml")
        return found

    @property
    def witness(self) -> str:
        """The numbers at which the printed statement fails, on one line."""
        return ", ".join(f"{name} = {value}" for name, value in (self.verdict.witness or {}).items())

    @property
    def numbers(self) -> list[tuple[str, str]]:
        """The numbers that a person can check, each with the name of its kind; trials say what both give."""
        return [("witness", self.witness), *(("tried", trial.line()) for trial in self.verdict.trials)]

    @property
    def survives(self) -> str:
        """The claims that rest on it, with their verdicts for the corrected statement."""
        return ", ".join(f"{name} ({kind})" for name, kind in self.dependants.items())

    def as_dict(self) -> dict[str, Any]:
        """The erratum as plain data."""
        verdict, where, remark = self.verdict, self.place, self.remark
        names = ("id", "section", "title", "printed", "corrected", "corrected_kind", "effective", "worth", "evidence")
        return {name: getattr(verdict, name) for name in names} | {
            "page": where.page,
            "equations": list(where.equations),
            "statement": where.statement,
            "line": where.line,
            "grade": remark.grade,
            "reason": remark.reason,
            "survives": remark.survives,
            "same_remark": [name for name in remark.claims if name != verdict.id],
            "witness": dict(verdict.witness or {}),
            "trials": [asdict(trial) for trial in verdict.trials],
            "dependants": self.dependants,
        }


@dataclass(frozen=True, repr=False)
class Errata(Sequence[Erratum]):
    """The misprints in the order of the paper; prints as text."""

    entries: tuple[Erratum, ...]

    @overload
    def __getitem__(self, at: int) -> Erratum: ...
    @overload
    def __getitem__(self, at: slice) -> Sequence[Erratum]: ...
    def __getitem__(self, at: int | slice) -> Erratum | Sequence[Erratum]:
        return self.entries[at]

    def __len__(self) -> int:
        return len(self.entries)

    def __repr__(self) -> str:
        return self.text()

    def _repr_markdown_(self) -> str:
        return self.markdown()

    @property
    def remarks(self) -> list[tuple[Erratum, ...]]:
        """The misprints in groups, each explained by one remark, in the order of their first places in the paper."""
        groups: dict[Remark, list[Erratum]] = {}
        for entry in self:
            groups.setdefault(entry.remark, []).append(entry)
        return sorted((tuple(group) for group in groups.values()), key=lambda group: group[0].place.line)

    @property
    def summary(self) -> str:
        """Numbers of statements that fail, by grade."""
        grades = Counter(entry.remark.grade for entry in self)
        errors = ", ".join(f"{grades[name]} {PLURALS[name]}" for name in GRADES if name != "reading")
        return (
            f"{len(self)} statements fail as printed, in {len(self.remarks)} remarks: {len(self) - grades['reading']} "
            f"errors ({errors}) and {grades['reading']} {PLURALS['reading']}."
        )

    def text(self) -> str:
        """Plain text, for a terminal."""
        return self._filled("text").removesuffix("\n")

    def markdown(self) -> str:
        """Markdown with formulas between dollar signs: a table for a first look, then each remark."""
        return self._filled("markdown", legend=kept_legend())

    def latex(self) -> str:
        """A LaTeX document: two pages for a first look, then each remark with its numbers."""
        return self._filled("latex", legend=kept_legend())

    def _filled(self, form: str, legend: Sequence[str] = ()) -> str:
        """The template of a format, which stands beside this file, with the errata put in."""
        template = Path(__file__).with_name(f"errata.{form}.j2").read_text(encoding="utf-8")
        functions: dict[str, Any] = {
            "places": lambda group: "; ".join(dict.fromkeys(str(entry.place) for entry in group)),
            "in_letters": in_letters,
            "wrapping": wrapping,
            "models": legend[len(LETTERS) :],
        }
        fields = {"errata": self, "paper": PAPER, "version": VERSION, "grades": GRADES, "letters": LETTERS}
        return str(environment().from_string(template).render(fields | functions))

    def as_dict(self) -> dict[str, Any]:
        """The errata as plain data; ``singimpact errata --json`` prints it."""
        return {"paper": PAPER, "version": VERSION, "grades": GRADES, "errata": [entry.as_dict() for entry in self]}


@checked_keywords
def errata(on_start: Callable[[Entry | Claim, int, int], None] | None = None) -> Errata:
    """The misprints of the paper, as the verifiers found them; the twin of the command `singimpact errata`.

    Parameters
    ----------
    on_start : called with the claim, its place and the number of claims before each is worked on; without it a line of
        progress is shown on a terminal, or under the cell of a notebook.
    """
    from singimpact.paper.claims import run, select

    claims = select()
    verdicts = {verdict.id: verdict for verdict in run(claims, on_start=on_start, cached=True)}
    above = {name: {c.id: verdicts[c.id].worth for c in claims if name in c.rests_on} for name in verdicts}
    corrected = [verdict for verdict in verdicts.values() if verdict.kind == "corrected"]
    return Errata(tuple(Erratum(verdict, above[verdict.id]) for verdict in corrected))
