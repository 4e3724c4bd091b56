"""Certificates of claims as Coq files: `python derivations/certificates/emit.py CERTIFICATES DIR`.

CERTIFICATES is a folder that `singimpact verify --certificates` wrote.  DIR gets one file a claim with one theorem a
certificate, `certificates.v` with what they use, and `_CoqProject`.  A statement is that of its certificate in real
numbers; to an order, each letter stands with a power of h, its weight.  The kind `count` is not emitted, and named.
"""

from __future__ import annotations

import json
import shutil
import sys
from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any

from singimpact.certificates.claims_proofs import Letters, number

LEMMAS = Path(__file__).with_name("certificates.v")
HEAD = """From Coq Require Import Reals Lra List.
From Claims Require Import certificates.
Import ListNotations.
Open Scope R_scope.
Add Ring over_Q : RTheory (morphism numbers, constants [number_of], power_tac R_power_theory [Rpow_tac])."""
# words of Coq and names that proofs use; those that end in ' are no names of letters
TAKEN = {"R", "S", "Q", "Z", "N", "at", "in", "as", "fun", "let", "if", "then", "else", "match", "end", "with", "using"}
TAKEN |= {"row", "same", "zero", "eval", "nth", "Letter", "expr", "last", "map", "alternate", "above_0", "below_0"}
INFINITE = ("-oo", "oo")
Theorem = tuple[str, str]
"""Its statement and its proof."""


class Writer:
    """The letters of a certificate, and texts that Coq reads."""

    def __init__(self, data: Any) -> None:
        self.names = [f"{name}_" if name in TAKEN else name for name in data["variables"]]
        self.letters = Letters(self.names)

    def read(self, polynomial: Any) -> Any:
        return self.letters.read(polynomial)

    def text(self, polynomial: Any) -> str:
        return f"({self.letters.text(polynomial)})".replace("**", "^")

    def quotient(self, above: Any, below: Any) -> str:
        return self.text(above) if below == 1 else f"({self.text(above)} / {self.text(below)})"

    def image(self, outer: str, images: dict[int, str]) -> str:
        """A text with others in place of some of its letters, all at once."""
        if not images:
            return outer
        return f"((fun {' '.join(self.names[n] for n in images)} : R => {outer}) {' '.join(images.values())})"

    def every(self, conditions: Sequence[str], statement: str, names: Sequence[str] | None = None) -> str:
        names = self.names if names is None else names
        bound = f"forall {' '.join(names)} : R, " if names else ""
        return bound + "".join(f"{condition} -> " for condition in dict.fromkeys(conditions)) + statement

    def nonzero(self, polynomials: Sequence[Any]) -> list[str]:
        return [f"{self.text(polynomial)} <> 0" for polynomial in polynomials if not polynomial.is_constant()]

    def point(self) -> str:
        """The values of the letters, by their places."""
        return f"(fun n => nth n {listed(self.names)} 0)"

    def quoted(self, text: str) -> str:
        """The text of a polynomial as an expression of Coq, its letters as variables."""
        letters = " ".join(f"(Letter {n})" for n in range(len(self.names)))
        return f"((fun {' '.join(self.names)} : expr => ({text})%E) {letters})".replace(": R =>", ": expr =>")


def rational(text: Any) -> str:
    exact = Fraction(str(text))
    return f"({exact.numerator})" if exact.denominator == 1 else f"({exact.numerator}/{exact.denominator})"


def listed(items: Sequence[Any]) -> str:
    return f"[{'; '.join(map(str, items))}]"


# ---- signs


def inside(names: Sequence[str], box: Any) -> list[str]:
    """The conditions that say that a point is in a box."""
    conditions = []
    for name, (low, high) in zip(names, box, strict=True):
        conditions += [] if low in INFINITE else [f"{rational(low)} < {name}"]
        conditions += [] if high in INFINITE else [f"{name} < {rational(high)}"]
    return conditions


def expansion(names: Sequence[str], box: Any, proof: Any) -> tuple[str, str]:
    """(the positive factor, the sum of positive terms) in the proof of a sign."""
    factors, distances = ["1"], []
    for name, (low, high), raised in zip(names, box, proof["raised"], strict=True):
        above = None if low in INFINITE else f"({name} - {rational(low)})"
        below = None if high in INFINITE else f"({rational(high)} - {name})"
        factors += [f"(1 + {above or below}) ^ {raised}"] if raised else []
        distances.append((above, below))
    terms = []
    for powers, value in proof["expansion"]:
        product = [rational(value)]
        for power, (above, below), degree in zip(powers, distances, proof["degree"], strict=True):
            product.append(f"{above or below} ^ {power}")
            product += [f"{below} ^ {degree - power}"] if above and below else []
        terms.append(" * ".join(product))
    return " * ".join(factors), " + ".join(terms)


def by_expansion(lemma: str, factor: str, total: str, equal: str) -> str:
    replaced = f"match goal with |- ?a > 0 => replace a with ({total}) by ({equal}); pos end"
    return f"apply ({lemma} ({factor})); [pos | {replaced}]"


def positive(data: Any, w: Writer) -> Theorem:
    above, below = w.read(data["numerator"]), w.read(data["denominator"])
    greater = data["sign"] > 0
    lemma = f"{'above' if greater else 'below'}_0{'' if below == 1 else '_quotient'}"
    statement = w.every(inside(w.names, data["box"]), f"{w.quotient(above, below)} {'>' if greater else '<'} 0")
    return statement, f"intros; {by_expansion(lemma, *expansion(w.names, data['box'], data), 'ring')}."


def definite(data: Any, w: Writer) -> Theorem:
    a, b, c = map(rational, data["form"])
    x, y = w.names
    greater = data["sign"] > 0
    form = f"{a} * {x} ^ 2 + {b} * {x} * {y} + {c} * {y} ^ 2 {'>' if greater else '<'} 0"
    lemma = "definite_above" if greater else "definite_below"
    return w.every([f"{x} <> 0 \\/ {y} <> 0"], form), f"intros {x} {y}; apply ({lemma} {a} {b} {c}); lra."


# ---- equations


def agreement(data: Any, w: Writer, left: str, right: str, order: int | None) -> Theorem:
    """Two polynomials are equal, or below a weighted degree."""
    if order is None:
        proof = f"refine (same {w.point()} {w.quoted(left)} {w.quoted(right)} _); vm_compute; reflexivity."
        return f"{left} = {right}", proof
    weights, difference = data["weights"], f"{left} - {right}"
    moved = " ".join(f"(h' ^ {n} * {name})" for n, name in zip(weights, w.names, strict=True))
    return (
        f"(exists q', forall h', (fun {' '.join(w.names)} : R => {difference}) {moved} = h' ^ {order} * eval q' h')",
        f"refine (to_order {order} {listed(weights)}%nat {listed(w.names)} {w.quoted(difference)} _); "
        "vm_compute; reflexivity.",
    )


def identity(data: Any, w: Writer) -> Theorem:
    one, other = (tuple(map(w.read, data[side])) for side in ("left", "right"))
    return equal(data, w, w.quotient(*one), w.quotient(*other), one, other, [])


def equal(data: Any, w: Writer, left: str, right: str, one: Any, other: Any, nonzero: list[str]) -> Theorem:
    """Two quotients are equal, where the relation holds if there is one."""
    conditions = [*nonzero, *w.nonzero((one[1], other[1]))]
    if data["relation"] is None:
        return w.every(conditions, f"{left} = {right}"), "intros; cbv beta in *; field; nonzero."
    multiplier, cofactor, relation = map(w.read, data["relation"])
    conditions += [*w.nonzero([multiplier]), f"{w.text(relation)} = 0"]
    parts = [w.text(part) for part in (*one, *other, multiplier, cofactor, relation)]
    return w.every(conditions, f"{left} = {right}"), (
        f"intros; cbv beta in *; apply (by_relation _ _ {' '.join(parts)}); "
        "[field; nonzero | field; nonzero | | | | | ]; try assumption; try lra; ring."
    )


def composed(data: Any, w: Writer) -> Theorem:
    sides = [
        (tuple(map(w.read, side["outer"])), {n: tuple(map(w.read, pair)) for n, pair in side["images"]})
        for side in (data["left"], data["right"])
    ]
    texts, quotients, nonzero = [], [], []
    for outer, images in sides:
        shown = {n: w.quotient(*pair) for n, pair in images.items()}
        texts.append(w.image(w.quotient(*outer), shown))
        nonzero += w.nonzero([below for _, below in images.values()])
        nonzero += [] if outer[1].is_constant() else [f"{w.image(w.text(outer[1]), shown)} <> 0"]
        above, below = (w.letters.put(polynomial, images) for polynomial in outer)
        quotients.append((above[0] * below[1], below[0] * above[1]))
    polynomials = all(pair[1] == 1 for outer, images in sides for pair in (outer, *images.values()))
    if data["relation"] is None and polynomials:
        statement, proof = agreement(data, w, *texts, None if data["order"] is None else data["order"] + 1)
        return w.every([], statement), f"intros; {proof}"
    if data["order"] is None:
        return equal(data, w, *texts, *quotients, nonzero)
    return up_to_the_order(data, w, texts, quotients, nonzero)


def up_to_the_order(data: Any, w: Writer, texts: list[str], quotients: list[Any], nonzero: list[str]) -> Theorem:
    """Two quotients differ by a rest that is named, and its numerator is beyond the order."""
    (a, b), (p, q) = quotients
    multiplier, cofactor, relation = map(w.read, data["relation"] or ([], [], []))
    conditions, difference = [*nonzero, *w.nonzero((b, q))], a * q - p * b
    if data["relation"] is None:
        rest, below, equation = difference, (b, q), "cbv beta in *; field; nonzero."
    else:
        rest, below = multiplier * difference - cofactor * relation, (multiplier, b, q)
        conditions += [*w.nonzero([multiplier]), f"{w.text(relation)} = 0"]
        parts = [w.text(part) for part in (a, b, p, q, multiplier, cofactor, relation, rest)]
        equation = (
            f"cbv beta in *; apply (by_relation_to_order _ _ _ {' '.join(parts)}); "
            "[field; nonzero | field; nonzero | field; nonzero | | | | | ]; try assumption; try lra; ring."
        )
    if any(w.letters.with_degree(factor, data["weights"], 0) == 0 for factor in below):
        raise ValueError(f"{data['says']}: its denominator vanishes in the limit")
    beyond, proof = agreement(data, w, w.text(rest), "0", data["order"] + 1)
    named = f"{w.text(rest)} / ({' * '.join(map(w.text, below))})"
    statement = f"{texts[0]} = {texts[1]} + {named} /\\ {beyond}"
    return w.every(conditions, statement), f"intros; split.\n  - {equation}\n  - {proof}"


# ---- limits


def value(data: Any, w: Writer) -> Theorem:
    index, at = data["index"], data["at"]
    above, below = w.read(data["numerator"]), w.read(data["denominator"])
    if data["value"] == "infinite":
        above, below, limit = below, above, "0"  # 1 over it tends to 0
    else:
        limit = w.quotient(*map(w.read, data["value"]))
    x, others = w.names[index], [name for n, name in enumerate(w.names) if n != index]
    function = f"(fun {x} => {w.quotient(above, below)})"
    if at not in INFINITE:
        statement = f"limit1_in {function} (D_x no_cond {rational(at)}) {limit} {rational(at)}"
        conditions = w.nonzero([w.letters.at(below, index, number(at))])
        proof = "intros; apply limit_at; [continuous; nonzero | cbv beta; field; nonzero]."
        return w.every(conditions, statement, others), proof
    degree = max(w.letters.degree(above, index), w.letters.degree(below, index))

    def turned(polynomial: Any) -> Any:
        """At 1/x, times x^degree."""
        terms = w.letters.terms(polynomial).items()
        return w.letters.context.from_dict({(*k[:index], degree - k[index], *k[index + 1 :]): c for k, c in terms})

    over, under = turned(above), turned(below)
    side = f"(fun {x} => {'0 <' if at == 'oo' else '0 >'} {x} /\\ {w.text(under)} <> 0)"
    proof = (
        f"intros; apply (limit_towards (fun {x} => {w.quotient(over, under)})); [intros u' [H1' H2']; cbv beta; split; "
        "[lra | field; nonzero] | continuous; nonzero | cbv beta; field; nonzero]."
    )
    statement = f"limit1_in (fun {x} => {function} (/ {x})) {side} {limit} 0"
    return w.every(w.nonzero([w.letters.at(under, index, number(0))]), statement, others), proof


# ---- motions


def derivative(w: Writer, index: int, one: Any, two: Any) -> Theorem:
    """One polynomial is the derivative of another by a letter."""
    name, texts = w.names[index], (w.text(one), w.text(two))
    quoted = " ".join(map(w.quoted, texts))
    proof = f"refine (derivative {w.point()} {index} {quoted} {name} _); vm_compute; reflexivity."
    return f"derivable_pt_lim (fun {name} => {texts[0]}) {name} {texts[1]}", proof


def solution(data: Any, w: Writer, y: Any, index: int, clock: str, scale: str, order: int | None) -> list[Theorem]:
    """The derivatives of y, and that it solves the equation of motion up to the order."""
    speed = y.derivative(index)
    second = speed.derivative(index)
    claims = [derivative(w, index, one, two) for one, two in ((y, speed), (speed, second))]
    height = f"({scale} * {w.text(y)})"
    terms = [f"{scale} * {w.text(w.read(jet))} * {clock} ^ {n}" for n, jet in enumerate(data["acceleration"]) if jet]
    terms += [
        f"-1 * {scale} * {w.text(w.read(jet))} * {height} ^ {i} * {w.text(speed)} ^ {k}"
        for (i, k), jet in data["force"]
    ]
    return [*claims, agreement(data, w, w.text(second), f"({' + '.join(terms) or '0'})", order)]


def together(claims: Sequence[Theorem], w: Writer) -> Theorem:
    steps = "\n".join(f"  - {proof}" for _, proof in claims)
    statement = w.every([], " /\\ ".join(text for text, _ in claims))
    return statement, f"intros; repeat match goal with |- _ /\\ _ => split end.\n{steps}"


def motion(data: Any, w: Writer) -> Theorem:
    letters, x, order = w.letters, w.read(data["height"]), data["order"]
    claims = solution(data, w, x, 2, f"({w.names[0]} + {w.names[2]})", "1", order)
    speed = x.derivative(2)
    claims += [
        (f"{w.text(letters.at(x, 2, 0))} = 0", "ring."),
        (f"{w.text(letters.at(speed, 2, 0))} = {w.names[1]}", "ring."),
    ]
    if data["launch"] is not None:
        launch = {1: w.text(w.read(data["launch"]))}
        quotient = letters.context.from_dict({(*k[:2], k[2] - 1, *k[3:]): c for k, c in letters.terms(x).items()})
        pairs = [(quotient, "0")]
        pairs += [] if data["landing"] is None else [(speed, w.text(w.read(data["landing"])))]
        beyond = None if order is None else order + 1
        claims += [agreement(data, w, w.image(w.text(one), launch), stated, beyond) for one, stated in pairs]
    return together(claims, w)


def flight(data: Any, w: Writer) -> Theorem:
    z, sigma, t = w.names[:3]
    y, order = w.read(data["rise"]), data["order"] + 1
    claims = solution(data, w, y, 0, f"({sigma} + {z} * {t})", t, order)
    speed = y.derivative(0)
    for polynomial, at, name in ((y, 0, None), (y, 1, None), (speed, 0, "launch"), (speed, 1, "landing")):
        stated = "0" if name is None else w.text(w.read(data[name]))
        claims.append(agreement(data, w, w.text(w.letters.at(polynomial, 0, at)), stated, order))
    return together(claims, w)


# ---- roots


def chain(data: Any, w: Writer) -> Theorem:
    polynomial, places, names, box = w.read(data["polynomial"]), data["places"], w.names[1:], data["box"]
    x, degree = w.names[0], w.letters.degree(polynomial, 0)
    row = listed([w.text(w.letters.coefficient(polynomial, 0, n)) for n in range(degree + 1)])
    gaps = [k for k, (one, two) in enumerate(pairwise(places)) if one["sign"] != two["sign"]]
    roots, at = [f"{x}'{n}" for n in range(1, len(gaps) + 1)], f"(fun {x} : R => {w.text(polynomial)})"
    claims = []
    for root, k in zip(roots, gaps, strict=True):
        claims += [*inside([root], [(places[k]["at"], places[k + 1]["at"])]), f"{at} {root} = 0"]
    if data["all"]:
        one_of = " \\/ ".join(f"y' = {root}" for root in roots)
        claims.append(f"(forall y', {at} y' = 0 -> {one_of})")
    all_of = " /\\ ".join(claims)
    statement = w.every(inside(names, box), f"exists {' '.join(roots)}, {all_of}", names)
    steps = [f"intros; set (row := {row})."]
    steps.append(f"assert (same : forall y', {at} y' = eval row y') by (intro; unfold row; cbv [eval]; ring).")

    def sign(name: str, subject: str, place: Any) -> str:
        greater = place["sign"] > 0
        equation = "unfold_places; unfold row; cbv [eval last alternate map]; ring"
        reason = by_expansion("above_0" if greater else "below_0", *expansion(names, box, place), equation)
        return f"assert ({name} : {subject} {'>' if greater else '<'} 0) by ({reason})."

    finite = [rational(place["at"]) for place in places if place["at"] not in INFINITE]
    for k, place in enumerate(places):
        if place["at"] not in INFINITE:
            steps += [f"set (p'{k} := {rational(place['at'])}).", sign(f"sign'{k}", f"eval row p'{k}", place)]
            continue
        low = place["at"] == "-oo"
        steps.append(sign(f"lead'{k}", "last (alternate row) 0" if low else "last row 0", place))
        lemma = f"far_{'below' if low else 'above'}_{'positive' if place['sign'] > 0 else 'negative'}"
        nearest = (finite[0] if low else finite[-1]) if finite else "0"
        steps.append(f"destruct ({lemma} row {nearest} lead'{k}) as [p'{k} [order'{k} sign'{k}]].")
    for root, k in zip(roots, gaps, strict=True):
        steps.append(
            f"destruct (root_between row p'{k} p'{k + 1}) as [{root} [in'{k} zero'{k}]]; [unfold_places; lra | nra |]."
        )
    steps.append(
        f"exists {', '.join(roots)}; cbv beta in same; repeat split; try (unfold_places; lra);"
        " try (rewrite same; assumption)."
    )
    if data["all"]:
        steps.append(
            f"intros y' zero; rewrite same in zero; assert (W' := no_other row {listed(roots)} y'); "
            "simpl In in W'; destruct W' as [W'|W']; [distinct; unfold_places; lra | reflexivity | "
            "cbv [row last alternate map] in *; lra | intros z' Hz'; "
            "repeat (destruct Hz' as [Hz'|Hz']; [subst z'; assumption|]); contradiction | assumption | .. ]; "
            "repeat (destruct W' as [W'|W']); intuition congruence."
        )
    return statement, "\n  ".join(steps)


KINDS: dict[str, Callable[[Any, Writer], Theorem]] = {
    theorem.__name__: theorem for theorem in (positive, definite, identity, composed, value, motion, flight, chain)
}


def comment(text: str) -> str:
    return f"(* {text.replace('(*', '( *').replace('*)', '* )')} *)"


def claim_file(content: Any) -> str:
    """The Coq file of a claim, from the JSON of its certificates."""
    lines = [comment(f"{content['id']}: {content['title']}"), "", HEAD]
    for n, data in enumerate(content["certificates"]):
        lines += ["", comment(f"{data['kind']}: {data['says']}")]
        if data["kind"] in KINDS:
            statement, proof = KINDS[data["kind"]](data, Writer(data))
            lines += [f"Theorem certificate_{n} : {statement}.", f"Proof. {proof} Qed."]
        else:
            lines.append(comment("not emitted"))
    return "\n".join(lines) + "\n"


def emitted(certificates: str, folder: str) -> list[str]:
    """Write the files, and the names of those that are compiled, in their order."""
    Path(folder).mkdir(parents=True, exist_ok=True)
    shutil.copy(LEMMAS, folder)
    names = [LEMMAS.name]
    for path in sorted(Path(certificates).glob("*.json")):
        content = json.loads(path.read_text(encoding="utf-8"))
        if content["certificates"]:
            names.append("claim_" + "".join(c if c.isalnum() else "_" for c in content["id"]) + ".v")
            Path(folder, names[-1]).write_text(claim_file(content), encoding="utf-8")
            missing = [data["says"] for data in content["certificates"] if data["kind"] not in KINDS]
            for says in missing:
                print(f"{content['id']}, not emitted: {says}")
    Path(folder, "_CoqProject").write_text("\n".join(["-Q . Claims", *names]) + "\n", encoding="utf-8")
    return names


if __name__ == "__main__":
    print(len(emitted(*sys.argv[1:3])), "files")
