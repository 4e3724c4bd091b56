"""`Claim`: a sentence of the paper that can be checked.  `Verdict`: what its verifier found."""

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import lru_cache
from math import floor, log10
from typing import Any

from singimpact.certificates.claims_proofs import check_certificate
from singimpact.inputs import need
from singimpact.notebook import table

PROVED = "proved"
MODULO = "proved modulo"  # an exact argument that uses theorems, which are named and not proved here
IN_MODEL = "proved in the model"  # an exact argument about x'' = 12 kappa (s^2 - 1) alone, which oscillators tend to
ARGUED = "argued"  # exact checks decide some links of an argument; the others are sentences that no program decides
FORMAL = "formal"  # an exact expansion to the orders named; existence, uniqueness and the remainder are not shown
STRONGEST_FIRST = (PROVED, MODULO, IN_MODEL, "certified", ARGUED, FORMAL, "supported", "cited", "open", "error")
STRENGTH = {word: len(STRONGEST_FIRST) - 1 - place for place, word in enumerate(STRONGEST_FIRST)}
KINDS = ("corrected", *(word for word in STRONGEST_FIRST if word != IN_MODEL))  # in the model: found, never stated
WITH_THEOREMS = (PROVED, MODULO, IN_MODEL, "certified", ARGUED)  # a theorem can be missing from these; numbers use none


def told(kind: str, modulo: Sequence[str]) -> str:
    """A kind with the theorems that its argument uses; of numbers and citations the kind alone.

    Examples
    --------
    >>> told("proved modulo", ["the stable manifold theorem"]), told("proved", []), told("supported", ["Rolle's"])
    ('proved modulo the stable manifold theorem', 'proved', 'supported')
    >>> told("certified", ["Smale's theorem", "the shadowing lemma"])
    "certified, modulo Smale's theorem and the shadowing lemma"
    """
    if not modulo or kind not in WITH_THEOREMS:
        return kind
    names = " and ".join(names_ for names_ in (", ".join(modulo[:-1]), modulo[-1]) if names_)
    return f"{kind} {names}" if kind == MODULO else f"{kind}, modulo {names}"


@lru_cache(maxsize=4096)
def statement_shown_by(certificate: str) -> str:
    """The statement of a certificate, given as JSON, that the second program accepts; it raises where it refuses one.

    Many claims share the certificates of what they rest on.
    """
    return check_certificate(json.loads(certificate))


@dataclass(frozen=True)
class Statement:
    """A statement in two forms: LaTeX to be read, and the object that the verifier takes."""

    latex: str
    value: Any


@dataclass(frozen=True)
class Check:
    """The verdict of a verifier on one statement.

    Attributes
    ----------
    holds : whether the statement passed.
    kind : what the argument is worth if it holds: proved, certified, argued, formal, supported or cited.
    evidence : one line for a person. witness : numbers at which a failing statement fails.
    modulo : names of theorems that the argument uses; with any, "proved" becomes "proved modulo".
    transverse : conditions, each found to hold, by which what holds in the universal model of section 6 holds near it.

    Raises
    ------
    ValueError : a kind that no argument has, a theorem without a name, or "proved modulo" without a theorem.

    Examples
    --------
    >>> Check(True, "proved", "hyperbolic for all r", modulo=("the stable manifold theorem",)).kind
    'proved modulo'
    """

    holds: bool
    kind: str
    evidence: str
    witness: Mapping[str, str] | None = None
    modulo: tuple[str, ...] = ()
    transverse: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if isinstance(self.modulo, str) or not all(isinstance(name, str) and name.strip() for name in self.modulo):
            raise ValueError(f"modulo has to be a tuple of theorems' names, not {self.modulo!r}")
        if self.kind == PROVED and self.modulo:
            object.__setattr__(self, "kind", MODULO)
        if self.kind not in KINDS or self.kind == "corrected":
            raise ValueError(f"no argument has the kind {self.kind!r}")
        need(self.kind != MODULO or self.modulo, ValueError('"proved modulo" needs the name of a theorem'))


@dataclass(frozen=True)
class Trial:
    """The printed and the corrected statement on one model.

    Attributes
    ----------
    model : an oscillator at a point; where the statement is about r alone, a value of r.
    quantity : what is compared. found : what the model gives. printed, corrected : what the statements say.
    """

    model: str
    quantity: str
    found: str
    printed: str
    corrected: str
    printed_holds: bool
    corrected_holds: bool

    def __post_init__(self) -> None:
        for name in ("printed_holds", "corrected_holds"):  # a comparison of numpy numbers is not a bool for JSON
            object.__setattr__(self, name, bool(getattr(self, name)))

    @property
    def tells(self) -> bool:
        """Whether the printed statement fails here and the corrected one holds."""
        return self.corrected_holds and not self.printed_holds

    def line(self) -> str:
        """One line for a table."""
        return f"{self.model}: {self.quantity} = {self.found}; printed {self.printed}, corrected {self.corrected}"


def compared(
    model: str, quantity: str, measured: float, printed: float, corrected: float, tolerance: float = 1e-3
) -> Trial:
    """A trial of two numbers against the one found, to a part `tolerance` of the largest of the three.

    Shown are the digits that are compared, and one more.
    """
    near = tolerance * max(abs(measured), abs(printed), abs(corrected))
    digits = 1 - floor(log10(tolerance))
    texts = [f"{value:.{digits}g}" for value in (measured, printed, corrected)]
    holds = [abs(value - measured) <= near for value in (printed, corrected)]
    return Trial(model, quantity, texts[0], texts[1], texts[2], holds[0], holds[1])


Trials = Callable[[Any, Any], Sequence[Trial]]


def at_each(places: Callable[[], Iterable[Any]], trial: Callable[..., Trial]) -> Trials:
    """Trials at several places: `trial` takes a place, the printed statement and the corrected one."""
    return lambda printed, corrected: [trial(place, printed, corrected) for place in places()]


@dataclass(frozen=True)
class Claim:
    """A checkable statement of the paper.

    Attributes
    ----------
    id : the claim's name; the paper's equation label where it has one.
    section : where it stands. title : the statement in our words, one line.
    printed : as printed. verify : decides any statement of this form; also shown the mutants.
    corrected : makes the statement that holds instead, from what was derived; None if the printed one should hold.
    mutants : wrong statements that the verifier must reject.
    rests_on : ids of the claims that the verifier uses.
    trials : tries the printed and the corrected statement on models; a correction needs two that tell them apart.
    """

    id: str
    section: str
    title: str
    printed: Statement
    verify: Callable[[Any], Check]
    mutants: tuple[Any, ...]
    corrected: Callable[[], Statement] | None = None
    rests_on: tuple[str, ...] = ()
    trials: Trials | None = None

    @property
    def label(self) -> str | None:
        """The equation label, when the claim is a displayed equation."""
        return self.id if self.id.startswith(("e:", "e3")) else None

    def _repr_html_(self) -> str:
        rows = [("printed", f"${self.printed.latex}$"), ("rests on", ", ".join(self.rests_on) or "no other claim")]
        return table([], rows, f"{self.id}, section {self.section}: {self.title}")


@dataclass(frozen=True)
class Encoding:
    """A statement of the paper in the form that its verifier takes; its words stand in a file of data.

    Attributes
    ----------
    printed : the statement as printed. verify, mutants : as in `Claim`.
    corrected : makes the statement that holds instead: its value, or a `Statement` where the LaTeX is derived too.
    """

    printed: Any
    verify: Callable[[Any], Check]
    mutants: tuple[Any, ...]
    corrected: Callable[[], Any] | None = None


@dataclass(frozen=True)
class Verdict:
    """The verdict on a claim, as computed.

    Attributes
    ----------
    kind : one of `KINDS`. effective : the weakest kind along what it rests on; `worth` is what documents print.
    in_model : whether its verifier used the universal model of section 6 and found no condition by which the statement
        persists for the oscillators that tend to it, so that a proof is one in that model.
    corrected, corrected_kind : the statement that holds instead, in LaTeX, and its own verdict.
    witness : numbers at which the printed statement fails. seconds : of CPU time.
    certificates : plain data on which the verdict rests where it is proved, each accepted by the second program.
    trials : of the printed and the corrected statement, on two models or more.
    modulo : theorems that its own argument uses. effective_modulo : those, and the ones along what it rests on.
    """

    id: str
    section: str
    title: str
    kind: str
    effective: str
    printed: str
    corrected: str | None
    corrected_kind: str | None
    witness: Mapping[str, str] | None
    evidence: str
    rests_on: tuple[str, ...]
    certificates: tuple[dict[str, Any], ...]
    trials: tuple[Trial, ...]
    seconds: float
    in_model: bool = False
    modulo: tuple[str, ...] = ()
    effective_modulo: tuple[str, ...] = ()

    @property
    def strength(self) -> str:
        """The kind that dependants rest on: of the corrected statement when the printed one fails."""
        return self.corrected_kind if self.kind == "corrected" and self.corrected_kind else self.kind

    @property
    def in_words(self) -> str:
        """The kind, with the effective verdict in brackets where that is another word; with the theorems they use.

        Examples
        --------
        >>> from singimpact.paper.claims import run, select
        >>> [run(select([name]))[-1].in_words for name in ("s3-dvdt", "s6-sections")]
        ['corrected (proved)', 'proved in the model']
        """
        own = told(self.kind, self.modulo)
        both_proved = self.kind in (PROVED, MODULO) and self.effective in (PROVED, MODULO, IN_MODEL)
        return self.worth if both_proved or self.effective == self.kind else f"{own} ({self.worth})"

    @property
    def worth(self) -> str:
        """The effective verdict in words: with the theorems that it uses, and that is what documents print."""
        return told(self.effective, self.effective_modulo)

    def _repr_html_(self) -> str:
        rows = [("verdict", self.in_words), ("printed", f"${self.printed}$")]
        if self.corrected is not None:
            rows.append((f"corrected ({self.worth})", f"${self.corrected}$"))
        return table([], [*rows, ("evidence", self.evidence)], f"{self.id}, section {self.section}: {self.title}")

    def as_dict(self) -> dict[str, Any]:
        """The verdict as plain data; the kind is called "verdict" there."""
        data = asdict(self)
        data |= {"verdict": data.pop("kind"), "worth": self.worth, "seconds": round(self.seconds, 4)}
        data["witness"] = dict(self.witness) if self.witness is not None else None
        data |= {
            name: list(data[name]) for name in ("rests_on", "modulo", "effective_modulo", "certificates", "trials")
        }
        first = ("id", "verdict", "effective", "worth", "title", "printed", "corrected", "corrected_kind", "witness")
        return {key: data[key] for key in first} | {key: value for key, value in data.items() if key not in first}
