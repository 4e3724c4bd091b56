"""Certificates of claims as files for Coq, one a claim: each becomes a theorem in real numbers, with its proof.

To an order, each letter stands with a power of h, its weight, and what is left has the factor h^order.  The lemmas that
the proofs use, and polynomials whose normal forms Coq computes, are `certificates.v` among the templates.  What a
certificate says is read by `certificates.claims_proofs`; here is no mathematics, and Coq alone decides.
"""

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any

from singimpact.certificates.claims_proofs import ENDS, Letters, number
from singimpact.documents.rendering import environment

LEMMAS = Path(__file__).parent / "templates" / "certificates.v"
# words of Coq and names that proofs use; those that end in ' are no names of letters
TAKEN = {"R", "S", "Q", "Z", "N", "at", "in", "as", "fun", "let", "if", "then", "else", "match", "end", "with", "using"}
TAKEN |= {"row", "same", "zero", "eval", "nth", "Letter", "expr", "last", "map", "alternate", "above_0", "below_0"}
Data = Mapping[str, Any]
Polynomial = Any
Theorem = tuple[str, str]  # its statement and its proof


class Writer(Letters):
    """The letters of a certificate, and texts that Coq reads."""

    def __init__(self, names: Sequence[str]) -> None:
        super().__init__([f"{name}_" if name in TAKEN else name for name in names])

    def text(self, poly: Polynomial) -> str:
        """A polynomial, highest powers first, in parentheses."""
        return f"({super().text(poly)})".replace("**", "^")

    def quotient(self, above: Polynomial, below: Polynomial) -> str:
        return self.text(above) if below == 1 else f"({self.text(above)} / {self.text(below)})"

    def image(self, outer: str, images: Mapping[int, str]) -> str:
        """A text with others in place of some of its letters, all at once."""
        letters = " ".join(self.names[n] for n in images)
        return f"((fun {letters} : R => {outer}) {' '.join(images.values())})" if images else outer

    def every(self, conditions: Sequence[str], statement: str, names: Sequence[str] | None = None) -> str:
        """A statement for all real numbers that fulfil conditions."""
        letters = " ".join(self.names if names is None else names)
        bound = f"forall {letters} : R, " if letters else ""
        return bound + "".join(f"{condition} -> " for condition in dict.fromkeys(conditions)) + statement

    def nonzero(self, polynomials: Sequence[Polynomial]) -> list[str]:
        return [f"{self.text(polynomial)} <> 0" for polynomial in polynomials if not polynomial.is_constant()]

    def point(self) -> str:
        """The values of the letters, by their places."""
        return f"(fun n => nth n {listed(self.names)} 0)"

    def quoted(self, text: str) -> str:
        """The text of a polynomial as an expression of Coq, its letters as variables."""
        letters = " ".join(f"(Letter {n})" for n in range(len(self.names)))
        return f"((fun {' '.join(self.names)} : expr => ({text})%E) {letters})".replace(": R =>", ": expr =>")


def rational(text: object) -> str:
    return f"({Fraction(str(text))})"


def listed(items: Sequence[object]) -> str:
    return f"[{'; '.join(map(str, items))}]"


# Signs.


def inside(names: Sequence[str], box: Sequence[tuple[str, str]]) -> list[str]:
    """The conditions that say that a point is in a box."""
    ends = [pair for name, (low, high) in zip(names, box, strict=True) for pair in ((low, name), (name, high))]
    finite = [pair for pair in ends if not {*ENDS} & {*pair}]
    return [" < ".join(each if each in names else rational(each) for each in pair) for pair in finite]


def by_expansion(lemma: str, names: Sequence[str], box: Sequence[tuple[str, str]], proof: Data, equal: str) -> str:
    """A tactic that proves a sign: times a positive factor it is a sum of positive terms."""
    distances = [
        ("" if low in ENDS else f"({name} - {rational(low)})", "" if high in ENDS else f"({rational(high)} - {name})")
        for name, (low, high) in zip(names, box, strict=True)
    ]
    raised = zip(distances, proof["raised"], strict=True)
    factor = " * ".join(["1", *(f"(1 + {above or below}) ^ {more}" for (above, below), more in raised if more)])

    def term(powers: Sequence[int], value: object) -> str:
        parts = [
            f"{above or below} ^ {power}" + (f" * {below} ^ {degree - power}" if above and below else "")
            for power, (above, below), degree in zip(powers, distances, proof["degree"], strict=True)
        ]
        return " * ".join([rational(value), *parts])

    total = " + ".join(term(*pair) for pair in proof["expansion"])
    replaced = f"match goal with |- ?a > 0 => replace a with ({total}) by ({equal}); pos end"
    return f"apply ({lemma} ({factor})); [pos | {replaced}]"


def positive(data: Data, w: Writer) -> Theorem:
    above, below = w.read(data["numerator"]), w.read(data["denominator"])
    name, relation = ("above_0", ">") if data["sign"] > 0 else ("below_0", "<")
    lemma = name if below == 1 else f"{name}_quotient"
    statement = w.every(inside(w.names, data["box"]), f"{w.quotient(above, below)} {relation} 0")
    return statement, f"intros; {by_expansion(lemma, w.names, data['box'], data, 'ring')}."


def definite(data: Data, w: Writer) -> Theorem:
    a, b, c = map(rational, data["form"])
    x, y = w.names
    lemma, relation = ("definite_above", ">") if data["sign"] > 0 else ("definite_below", "<")
    form = f"{a} * {x} ^ 2 + {b} * {x} * {y} + {c} * {y} ^ 2 {relation} 0"
    return w.every([f"{x} <> 0 \\/ {y} <> 0"], form), f"intros {x} {y}; apply ({lemma} {a} {b} {c}); lra."


def chain(data: Data, w: Writer) -> Theorem:
    """Signs of a polynomial at places of its first letter, and a root in each gap in which they change."""
    polynomial, places, names = w.read(data["polynomial"]), data["places"], w.names[1:]
    gaps = [k for k, (one, two) in enumerate(pairwise(places)) if one["sign"] != two["sign"]]
    roots, at = [f"{w.names[0]}'{n + 1}" for n in range(len(gaps))], f"(fun {w.names[0]} : R => {w.text(polynomial)})"
    equation = "try unfold_places; unfold row; cbv [eval last alternate map]; ring"
    finite = [spot["at"] for spot in places if spot["at"] not in ENDS]
    template = environment().get_template("roots.v.j2")
    proof = template.render(
        at=at,
        row=[w.text(w.coefficient(polynomial, 0, n)) for n in range(w.degree(polynomial, 0) + 1)],
        places=[
            {
                "at": spot["at"],
                "value": "" if spot["at"] in ENDS else rational(spot["at"]),
                "nearest": rational((finite or [0])[0 if spot["at"] == "-oo" else -1]),
                "sign": spot["sign"],
                "proof": by_expansion("above_0" if spot["sign"] > 0 else "below_0", names, data["box"], spot, equation),
            }
            for spot in places
        ],
        gaps=list(zip(roots, gaps, strict=True)),
        all=data["all"],
    )
    one_of = " \\/ ".join(f"y' = {root}" for root in roots)
    claims = [
        text
        for root, k in zip(roots, gaps, strict=True)
        for text in (*inside([root], [(places[k]["at"], places[k + 1]["at"])]), f"{at} {root} = 0")
    ] + ([f"(forall y', {at} y' = 0 -> {one_of})"] if data["all"] else [])
    statement = f"exists {' '.join(roots)}, " + " /\\ ".join(claims)
    return w.every(inside(names, data["box"]), statement, names), proof


# Equations.


def agreement(data: Data, w: Writer, left: str, right: str, order: int | None) -> Theorem:
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


def identity(data: Data, w: Writer) -> Theorem:
    one, other = ((w.read(above), w.read(below)) for above, below in (data["left"], data["right"]))
    return equal(data, w, (w.quotient(*one), w.quotient(*other)), (one, other), [])


Pair = tuple[Polynomial, Polynomial]


def equal(data: Data, w: Writer, texts: Sequence[str], sides: Sequence[Pair], nonzero: list[str]) -> Theorem:
    """Two quotients are equal, where the relation holds if there is one."""
    conditions = [*nonzero, *w.nonzero([below for _, below in sides])]
    statement = f"{texts[0]} = {texts[1]}"
    if data["relation"] is None:
        return w.every(conditions, statement), "intros; cbv beta in *; field; nonzero."
    multiplier, cofactor, relation = map(w.read, data["relation"])
    conditions += [*w.nonzero([multiplier]), f"{w.text(relation)} = 0"]
    parts = [w.text(polynomial) for polynomial in (*sides[0], *sides[1], multiplier, cofactor, relation)]
    return w.every(conditions, statement), (
        f"intros; cbv beta in *; apply (by_relation _ _ {' '.join(parts)}); "
        "[field; nonzero | field; nonzero | | | | | ]; try assumption; try lra; ring."
    )


def composed(data: Data, w: Writer) -> Theorem:
    texts, sides, nonzero, polynomials = [], [], [], data["relation"] is None
    for side in (data["left"], data["right"]):
        images = {n: (w.read(above), w.read(below)) for n, (above, below) in side["images"]}
        outer, shown = tuple(map(w.read, side["outer"])), {n: w.quotient(*pair) for n, pair in images.items()}
        texts.append(w.image(w.quotient(*outer), shown))
        nonzero += w.nonzero([below for _, below in images.values()])
        nonzero += [] if outer[1].is_constant() else [f"{w.image(w.text(outer[1]), shown)} <> 0"]
        above, below = (w.put(polynomial, images) for polynomial in outer)
        sides.append((above[0] * below[1], below[0] * above[1]))
        polynomials &= all(pair[1] == 1 for pair in (outer, *images.values()))
    if polynomials:
        statement, proof = agreement(data, w, texts[0], texts[1], None if data["order"] is None else data["order"] + 1)
        return w.every([], statement), f"intros; {proof}"
    theorem = equal if data["order"] is None else up_to_the_order
    return theorem(data, w, texts, sides, nonzero)


def up_to_the_order(data: Data, w: Writer, texts: Sequence[str], sides: Sequence[Pair], nonzero: list[str]) -> Theorem:
    """Two quotients differ by a rest that is named, and its numerator is beyond the order."""
    (a, b), (p, q) = sides
    multiplier, cofactor, relation = map(w.read, data["relation"] or ([[[0] * len(w.names), 1]], [], []))
    rest, below = multiplier * (a * q - p * b) - cofactor * relation, (multiplier, b, q)
    if any(w.with_degree(factor, data["weights"], 0) == 0 for factor in below):
        raise ValueError(f"{data['says']}: its denominator vanishes in the limit")
    conditions, equation = [*nonzero, *w.nonzero((b, q))], "cbv beta in *; field; nonzero."
    if data["relation"] is not None:
        conditions += [*w.nonzero([multiplier]), f"{w.text(relation)} = 0"]
        parts = [w.text(polynomial) for polynomial in (a, b, p, q, multiplier, cofactor, relation, rest)]
        equation = (
            f"cbv beta in *; apply (by_relation_to_order _ _ _ {' '.join(parts)}); "
            "[field; nonzero | field; nonzero | field; nonzero | | | | | ]; try assumption; try lra; ring."
        )
    beyond, proof = agreement(data, w, w.text(rest), "0", data["order"] + 1)
    named = f"{w.text(rest)} / ({' * '.join(map(w.text, below))})"
    statement = f"{texts[0]} = {texts[1]} + {named} /\\ {beyond}"
    return w.every(conditions, statement), f"intros; split.\n  - {equation}\n  - {proof}"


# Limits.


def value(data: Data, w: Writer) -> Theorem:
    index, at, x = data["index"], data["at"], w.names[data["index"]]
    infinite, others = data["value"] == "infinite", [name for name in w.names if name != x]
    above, below = map(w.read, (data[side] for side in ("numerator", "denominator")[:: -1 if infinite else 1]))
    limit = "0" if infinite else w.quotient(*map(w.read, data["value"]))  # 1 over what grows tends to 0
    function, proof = f"(fun {x} => {w.quotient(above, below)})", "[continuous; nonzero | cbv beta; field; nonzero]."
    if at not in ENDS:
        statement = f"limit1_in {function} (D_x no_cond {rational(at)}) {limit} {rational(at)}"
        conditions = w.nonzero([w.at(below, index, number(at))])
        return w.every(conditions, statement, others), f"intros; apply limit_at; {proof}"
    degree = max(w.degree(above, index), w.degree(below, index))
    over, under = (  # at 1/x, times x^degree
        w.context.from_dict(
            {(*k[:index], degree - k[index], *k[index + 1 :]): c for k, c in w.terms(polynomial).items()}
        )
        for polynomial in (above, below)
    )
    side = f"(fun {x} => {'0 <' if at == 'oo' else '0 >'} {x} /\\ {w.text(under)} <> 0)"
    statement = f"limit1_in (fun {x} => {function} (/ {x})) {side} {limit} 0"
    return w.every(w.nonzero([w.at(under, index, number(0))]), statement, others), (
        f"intros; apply (limit_towards (fun {x} => {w.quotient(over, under)})); "
        f"[intros u' [H1' H2']; cbv beta; split; [lra | field; nonzero] | {proof[1:]}"
    )


# Motions.


def derivative(w: Writer, index: int, one: Polynomial, two: Polynomial) -> Theorem:
    """One polynomial is the derivative of another by a letter."""
    name, texts = w.names[index], (w.text(one), w.text(two))
    proof = (
        f"refine (derivative {w.point()} {index} {' '.join(map(w.quoted, texts))} {name} _); vm_compute; reflexivity."
    )
    return f"derivable_pt_lim (fun {name} => {texts[0]}) {name} {texts[1]}", proof


def solution(data: Data, w: Writer, y: Polynomial, n: int, clock: str, scale: str, order: int | None) -> list[Theorem]:
    """The derivatives of y, and that it solves the equation of motion up to the order."""
    speed, height = y.derivative(n), f"({scale} * {w.text(y)})"
    second = speed.derivative(n)
    terms = [f"{scale} * {w.text(w.read(jet))} * {clock} ^ {k}" for k, jet in enumerate(data["acceleration"]) if jet]
    terms += [
        f"-1 * {scale} * {w.text(w.read(jet))} * {height} ^ {i} * {w.text(speed)} ^ {k}"
        for (i, k), jet in data["force"]
    ]
    equation = agreement(data, w, w.text(second), f"({' + '.join(terms) or '0'})", order)
    return [derivative(w, n, y, speed), derivative(w, n, speed, second), equation]


def together(claims: Sequence[Theorem], w: Writer) -> Theorem:
    steps = "\n".join(f"  - {proof}" for _, proof in claims)
    statement = w.every([], " /\\ ".join(text for text, _ in claims))
    all_of = "conj _ (" * (len(claims) - 1) + "_" + ")" * (len(claims) - 1)
    return statement, f"intros; refine ({all_of}).\n{steps}"


def motion(data: Data, w: Writer) -> Theorem:
    x, beyond = w.read(data["height"]), None if data["order"] is None else data["order"] + 1
    speed = x.derivative(2)
    claims = solution(data, w, x, 2, f"({w.names[0]} + {w.names[2]})", "1", data["order"])
    claims += [(f"{w.text(w.at(x, 2, 0))} = 0", "ring."), (f"{w.text(w.at(speed, 2, 0))} = {w.names[1]}", "ring.")]
    if data["launch"] is not None:
        launch = {1: w.text(w.read(data["launch"]))}
        quotient = w.context.from_dict({(*k[:2], k[2] - 1, *k[3:]): c for k, c in w.terms(x).items()})
        landing = [] if data["landing"] is None else [(speed, w.text(w.read(data["landing"])))]
        for one, stated in ((quotient, "0"), *landing):
            claims.append(agreement(data, w, w.image(w.text(one), launch), stated, beyond))
    return together(claims, w)


def flight(data: Data, w: Writer) -> Theorem:
    z, sigma, t = w.names[:3]
    y, (launch, landing) = w.read(data["rise"]), (w.text(w.read(data[end])) for end in ("launch", "landing"))
    speed, beyond = y.derivative(0), data["order"] + 1
    ends = ((y, 0, "0"), (y, 1, "0"), (speed, 0, launch), (speed, 1, landing))
    touches = [agreement(data, w, w.text(w.at(part, 0, at)), text, beyond) for part, at, text in ends]
    return together([*solution(data, w, y, 0, f"({sigma} + {z} * {t})", t, beyond), *touches], w)


KINDS: dict[str, Callable[[Data, Writer], Theorem]] = {
    theorem.__name__: theorem for theorem in (positive, definite, identity, composed, value, motion, flight, chain)
}


def coq_file(content: Data) -> str:
    """The Coq file of a claim, from the content of the file of its certificates.

    Examples
    --------
    >>> form = {"kind": "definite", "variables": ["x", "y"], "form": ["1", "0", "1"], "sign": 1, "says": "a square sum"}
    >>> print(coq_file({"id": "two", "title": "squares", "certificates": [form]}).splitlines()[-2])
    Theorem certificate_0 : forall x y : R, x <> 0 \\/ y <> 0 -> (1) * x ^ 2 + (0) * x * y + (1) * y ^ 2 > 0.
    """
    theorems = [(data, *KINDS[data["kind"]](data, Writer(data["variables"]))) for data in content["certificates"]]
    return str(environment().get_template("claim.v.j2").render(claim=content, theorems=theorems))
