"""Certificates of claims: polynomials, and the rules by which each kind follows from its own numbers.

A polynomial is a list of [exponents, coefficient], a coefficient a whole number or the text of a fraction.  The kinds:

    positive   sign * numerator/denominator > 0 on an open box: the product is a sum of positive terms
    chain      signs of a polynomial at places of its first variable, for all values of the others in a box
    value      the limit of a quotient where one variable tends to a place
    definite   a quadratic form that has one sign off the origin
    identity   two different quotients are equal, or are where a quadratic relation holds
    composed   a function of images is another function of other images, exactly or to an order
    motion     x(sigma, v, t) solves x'' + f(x, x') = a from the wall; v = launch brings it back after t
    flight     t y(z; sigma, t) solves it between two touches of the wall, at z = 0 and z = 1
"""

import re
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from fractions import Fraction
from itertools import pairwise
from typing import Any

from flint import fmpq, fmpq_mpoly_ctx

# Of a number, of a certificate, of a variable, and of a product: more is refused before it is built.
DIGITS, NAMES, EXPONENT, TERMS = 4_000, 40, 1_000, 4_000_000
SECONDS = 9.0  # of CPU, for a certificate
ENDS = ("-oo", "oo")


class Refused(Exception):
    """A file that is not accepted, and why."""


def need(condition: Any, why: str) -> None:
    if not condition:
        raise Refused(why)


def number(value: Any) -> Any:
    text = str(value) if isinstance(value, str) or abs(value) < 10**DIGITS else ""
    need(
        re.fullmatch(r"-?\d+(/0*[1-9]\d*)?", text, re.ASCII) and len(text) < DIGITS, f"{text[:40]!r} is no exact number"
    )
    exact = Fraction(text)
    return fmpq(exact.numerator, exact.denominator)


class Letters:
    """The variables of a certificate: polynomials in them, and their text."""

    def __init__(self, names: Any) -> None:
        need(isinstance(names, list) and 0 < len(names) <= NAMES, f"variables are a list of at most {NAMES} names")
        self.names = names
        need(all(isinstance(name, str) and name.isidentifier() for name in self.names), "a name that is none")
        need(len(set(self.names)) == len(self.names), "a name twice")
        self.context = fmpq_mpoly_ctx.get(tuple(f"{name} {n}" for n, name in enumerate(self.names)), "lex")
        self.variables = self.context.gens()
        self.end = time.process_time() + SECONDS

    def read(self, data: Any) -> Any:
        """A polynomial from its data: each monomial once, no coefficient 0."""
        found: dict[tuple[int, ...], Any] = {}
        for powers, value in data:
            key = tuple(powers)
            need(len(key) == len(self.names), "exponents of another length")
            need(all(type(n) is int and 0 <= n <= EXPONENT for n in key), "an exponent that is none")
            need(key not in found and number(value) != 0, "a monomial twice, or with the coefficient 0")
            found[key] = number(value)
        return self.context.from_dict(found)

    def constant(self, value: Any) -> Any:
        return self.context.constant(value)

    def text(self, poly: Any) -> str:
        """A polynomial, highest powers first."""
        signed = []
        for key, value in sorted(self.terms(poly).items(), reverse=True):
            powers = [name if n == 1 else f"{name}**{n}" for name, n in zip(self.names, key, strict=True) if n]
            size = abs(value)
            head = [] if size == 1 and powers else [str(Fraction(int(size.p), int(size.q)))]
            signed.append((value < 0, "*".join(head + powers)))
        if not signed:
            return "0"
        first = ("-" if signed[0][0] else "") + signed[0][1]
        return first + "".join(f" {'-' if negative else '+'} {term}" for negative, term in signed[1:])

    def quotient_text(self, pair: Any) -> str:
        above, below = (self.text(self.read(part)) for part in pair)
        return above if below == "1" else f"({above})/({below})"

    @staticmethod
    def terms(poly: Any) -> dict[tuple[int, ...], Any]:
        return {tuple(map(int, key)): value for key, value in poly.to_dict().items()}

    def with_degree(self, poly: Any, weights: Sequence[int], order: int | None) -> Any:
        """A polynomial cut at a weighted degree."""
        if order is None:
            return poly
        degrees = {key: sum(n * w for n, w in zip(key, weights, strict=True)) for key in self.terms(poly)}
        return self.context.from_dict({key: c for key, c in self.terms(poly).items() if degrees[key] <= order})

    def power(self, poly: Any, exponent: int, weights: Sequence[int], order: int | None) -> Any:
        """A power, up to a weighted degree."""
        found = self.constant(1)
        for _ in range(exponent):
            found = self.with_degree(self.times(found, poly), weights, order)
        return found

    def times(self, one: Any, other: Any) -> Any:
        """A product, unless it is too long."""
        need(len(one) * len(other) <= TERMS, f"a product of more than {TERMS} terms")
        need(time.process_time() < self.end, f"it is not decided within {SECONDS:g} s of CPU")
        return one * other

    def put(
        self, poly: Any, images: dict[int, tuple[Any, Any]], weights: Sequence[int] = (), order: int | None = None
    ) -> tuple[Any, Any]:
        """(above, below) of a polynomial whose variables are replaced by quotients, all at once; above to an order."""
        degrees = [max((key[n] for key in self.terms(poly)), default=0) for n in range(len(self.names))]
        above = self.constant(0)
        for key, value in self.terms(poly).items():
            term = self.constant(value)
            for n, power in enumerate(key):
                over, under = images.get(n, (self.variables[n], self.constant(1)))
                factor = self.times(
                    self.power(over, power, weights, order), self.power(under, degrees[n] - power, (), None)
                )
                term = self.with_degree(self.times(term, factor), weights, order)
            above += term
        below = self.constant(1)
        for n, (_, under) in images.items():
            below = self.times(below, self.power(under, degrees[n], (), None))
        return above, below

    def at(self, poly: Any, index: int, value: Any) -> Any:
        return self.put(poly, {index: (self.constant(value), self.constant(1))})[0]

    def degree(self, poly: Any, index: int) -> int:
        return max((key[index] for key in self.terms(poly)), default=-1)

    def coefficient(self, poly: Any, index: int, power: int) -> Any:
        """The coefficient of a power of one variable, a polynomial in the others."""
        found = {
            (*key[:index], 0, *key[index + 1 :]): value
            for key, value in self.terms(poly).items()
            if key[index] == power
        }
        return self.context.from_dict(found)


# ---- signs, roots and values


def expands(letters: Letters, first: int, poly: Any, box: Any, proof: Any) -> bool:
    """poly prod (1 + distance)^raised is a sum, with positive coefficients, of products of distances to the ends."""
    one, total, left = letters.constant(1), letters.constant(0), poly
    distances = []
    for n, (low, high) in enumerate(box):
        x = letters.variables[first + n]
        raised, degree = proof["raised"][n], proof["degree"][n]
        degrees = all(type(product) is int and 0 <= product <= EXPONENT for product in (raised, degree))
        need(degrees, "a degree that is none")
        above = None if low in ENDS else x - number(low)
        below = None if high in ENDS else number(high) - x
        need(low != "oo" and high != "-oo" and (above is not None or below is not None), "an interval without an end")
        if above is not None and below is not None:
            need(number(low) < number(high) and raised == 0, "an interval without an inside")
        else:
            need(degree == 0, "a half-line has no degree")
            # 1 + a distance is positive on the half-line, so its powers do not change the sign
            left = letters.times(left, letters.power(one + (above if above is not None else below), raised, (), None))
        distances.append((above, below, degree))
    seen = set()
    for powers, value in proof["expansion"]:
        key = tuple(powers)
        need(len(key) == len(box) and key not in seen and number(value) > 0, "a part of the sum that is not positive")
        need(all(type(n) is int and 0 <= n <= EXPONENT for n in key), "an exponent that is none")
        seen.add(key)
        product = letters.constant(number(value))
        for power, (above, below, degree) in zip(key, distances, strict=True):
            if above is not None and below is not None:
                need(power <= degree, "a power above the degree")
                product = letters.times(product, above**power * below ** (degree - power))
            else:
                product = letters.times(product, (above if above is not None else below) ** power)
        total += product
    return bool(seen) and total == left


def positive(data: Any, letters: Letters) -> str:
    above, below = letters.read(data["numerator"]), letters.read(data["denominator"])
    need(data["sign"] in (-1, 1) and type(data["sign"]) is int, "a sign is 1 or -1")
    need(expands(letters, 0, above * below * data["sign"], data["box"], data), "the expansion is another")
    pair = letters.quotient_text((data["numerator"], data["denominator"]))
    return f"{pair} {'>' if data['sign'] > 0 else '<'} 0 for {box_text(letters.names, data['box'])}"


def box_text(names: Sequence[str], box: Any) -> str:
    need(len(names) == len(box), "a box of another dimension")
    return ", ".join(f"{low} < {name} < {high}" for name, (low, high) in zip(names, box, strict=True))


def place_of(at: str) -> tuple[int, Fraction]:
    return (-1, Fraction(0)) if at == "-oo" else (1, Fraction(0)) if at == "oo" else (0, Fraction(at))


def sign_part(letters: Letters, poly: Any, index: int, at: str) -> Any:
    """A polynomial that has the sign at a place of one variable: its value, or its leading coefficient, signed."""
    if at not in ENDS:
        return letters.at(poly, index, number(at))
    top = letters.degree(poly, index)
    return letters.coefficient(poly, index, top) * (-1 if at == "-oo" and top % 2 else 1)


def chain(data: Any, letters: Letters) -> str:
    poly, places = letters.read(data["polynomial"]), data["places"]
    for point in places:
        need(point["sign"] in (-1, 1) and type(point["sign"]) is int, "a sign is 1 or -1")
        value = sign_part(letters, poly, 0, point["at"]) * point["sign"]
        need(expands(letters, 1, value, data["box"], point), f"the sign at {point['at']} does not follow")
    ordered = [place_of(point["at"]) for point in places]
    need(all(one < two for one, two in pairwise(ordered)), "the places are not in order")
    gaps = [[one["at"], two["at"]] for one, two in pairwise(places) if one["sign"] != two["sign"]]
    # a root lies between places of different signs; as many as the degree are all that there are
    need(gaps == data["roots"], "the signs change elsewhere")
    need(data["all"] is (len(gaps) == letters.degree(poly, 0)), "there may be other roots, or none")
    brackets = ", ".join(f"({low}, {high})" for low, high in gaps) or "no gap"
    rest = f", for all {box_text(letters.names[1:], data['box'])}" if data["box"] else ""
    others = " and no other" if data["all"] else ""
    return f"{letters.text(poly)} has a root {letters.names[0]} in each of {brackets}{others}{rest}"


def value(data: Any, letters: Letters) -> str:
    index, at = data["index"], data["at"]
    need(type(index) is int and 0 <= index < len(letters.names), "no such variable")
    above, below = letters.read(data["numerator"]), letters.read(data["denominator"])
    need(below != 0, "a denominator that is 0")
    pair = letters.quotient_text((data["numerator"], data["denominator"]))
    if at in ENDS:
        more = letters.degree(above, index) - letters.degree(below, index)
        over, under = (
            sign_part(letters, polynomial, index, at) if polynomial != 0 else polynomial
            for polynomial in (above, below)
        )
        over = letters.constant(0) if more < 0 else over
        grows = more > 0
    else:
        over, under = (letters.at(polynomial, index, number(at)) for polynomial in (above, below))
        grows = under == 0
    limit = f"{letters.names[index]} -> {at}"
    if data["value"] == "infinite":
        need(grows and over != 0, "it is bounded, or 0/0")
        return f"{pair} is unbounded as {limit}"
    stated = [letters.read(polynomial) for polynomial in data["value"]]
    need(not grows and stated[1] != 0, "a quotient by 0")
    need(all(letters.degree(polynomial, index) <= 0 for polynomial in stated), "a value that depends on the variable")
    need(over * stated[1] == under * stated[0], "another value")
    return f"{pair} -> {letters.quotient_text(data['value'])} as {limit}"


def definite(data: Any, letters: Letters) -> str:
    a, b, c = map(number, data["form"])
    sign = data["sign"]
    need(type(sign) is int and sign in (-1, 1) and a * sign > 0 and b * b < 4 * a * c, "the form has not one sign")
    x, y = letters.variables
    form = letters.text(a * x**2 + b * x * y + c * y**2)
    return f"{form} {'>' if sign > 0 else '<'} 0 for all ({', '.join(letters.names)}) but (0, 0)"


# ---- identities


def by_relation(data: Any, letters: Letters, weights: Sequence[int], order: int | None, sides: Any) -> str:
    """Two quotients agree, up to the order, and at the roots of the relation where there is one; its text."""
    (above, below), (other, under) = sides
    difference = letters.with_degree(above * under - other * below, weights, order)
    if data["relation"] is None:
        for polynomial in (below, under):
            need(letters.with_degree(polynomial, weights, None if order is None else 0) != 0, "a quotient by 0")
        need(difference == 0, "the two sides differ")
        return ""
    multiplier, cofactor, relation = map(letters.read, data["relation"])
    last = len(letters.names) - 1
    need(letters.degree(relation, last) == 2 and letters.degree(multiplier, last) == 0, "no quadratic relation")
    if order is not None:
        need(
            all(letters.with_degree(polynomial, weights, 0) == polynomial for polynomial in (multiplier, relation)),
            "a small relation",
        )
    for polynomial in (below, under):
        lowest = letters.with_degree(polynomial, weights, None if order is None else 0)
        need(resultant(letters, lowest, relation, last) != 0, "a quotient by 0")
    left, right = (
        letters.with_degree(polynomial, weights, order) for polynomial in (multiplier * difference, cofactor * relation)
    )
    need(left == right, "the two sides differ at a root of the relation")
    return f" where {letters.text(relation)} = 0"


def resultant(letters: Letters, poly: Any, relation: Any, last: int) -> Any:
    """0 only when a polynomial is 0 at a root of the relation: its norm, by the remainder of a division by it."""
    c = [letters.coefficient(relation, last, n) for n in range(3)]
    while letters.degree(poly, last) >= 2:
        top = letters.degree(poly, last)
        lead = letters.coefficient(poly, last, top)
        poly = poly * c[2] - relation * lead * letters.variables[last] ** (top - 2)
    b = [letters.coefficient(poly, last, n) for n in range(2)]
    return b[0] ** 2 * c[2] - b[0] * b[1] * c[1] + b[1] ** 2 * c[0]


def identity(data: Any, letters: Letters) -> str:
    sides = [tuple(map(letters.read, data[side])) for side in ("left", "right")]
    need(lowest_form(*sides[0]) != lowest_form(*sides[1]), "a statement that says X = X")
    where = by_relation(data, letters, [0] * len(letters.names), None, sides)
    return f"{letters.quotient_text(data['left'])} = {letters.quotient_text(data['right'])}{where}"


def lowest_form(above: Any, below: Any) -> tuple[str, str]:
    """A quotient without common numbers: 2X/2 is X."""
    lead = below.leading_coefficient() if below != 0 else 1
    return str(above / lead), str(below / lead)


def form_of(letters: Letters, outer: Any, images: dict[int, tuple[Any, Any]]) -> Any:
    """A function of images without common numbers, without images of themselves and of variables that do not occur."""
    occurs = {n for part in outer for n in range(len(letters.names)) if letters.degree(part, n) > 0}
    itself = {n: lowest_form(letters.variables[n], letters.constant(1)) for n in images}
    forms = {n: lowest_form(*pair) for n, pair in images.items() if n in occurs}
    return lowest_form(*outer), {n: form for n, form in forms.items() if form != itself[n]}


def scale_of(data: Any, letters: Letters, least: int) -> tuple[list[int], int | None]:
    """(weights, order) of a certificate."""
    weights, order = data["weights"], data["order"]
    need(len(weights) == len(letters.names), "weights of another number of variables")
    need(all(type(each) is int and 0 <= each <= EXPONENT for each in weights), "a weight that is none")
    need(order is None or (type(order) is int and least <= order <= EXPONENT), "an order that is none")
    return weights, order


def order_text(letters: Letters, weights: Sequence[int], order: int | None) -> str:
    if order is None:
        return ""
    small = [(name, weight) for name, weight in zip(letters.names, weights, strict=True) if weight]
    return f", up to degree {order} in " + ", ".join(f"{x} (weight {w})" if w > 1 else x for x, w in small)


def composed(data: Any, letters: Letters) -> str:
    weights, order = scale_of(data, letters, 0)
    need(order is not None or not any(weights), "weights without an order")
    sides, texts, forms = [], [], []
    for side in (data["left"], data["right"]):
        images = {index: tuple(map(letters.read, pair)) for index, pair in side["images"]}
        places = range(len(letters.names))
        need(len(images) == len(side["images"]) and all(n in places for n in images), "an image of none")
        for _, under in images.values():
            lowest = letters.with_degree(under, weights, None if order is None else 0)
            need(lowest != 0, "an image by 0")
            if data["relation"] is not None:
                zero = letters.read(data["relation"][2])
                need(resultant(letters, lowest, zero, len(letters.names) - 1) != 0, "an image by 0")
        pair = tuple(map(letters.read, side["outer"]))
        forms.append(form_of(letters, pair, images))
        above, below = (letters.put(polynomial, images, weights, order) for polynomial in pair)
        sides.append((above[0] * below[1], below[0] * above[1]))
        put = ", ".join(f"{letters.names[n]} = {letters.quotient_text(pair)}" for n, pair in side["images"])
        outer = letters.quotient_text(side["outer"])
        texts.append(f"[{outer} at {put}]" if put else outer)
    need(forms[0] != forms[1], "a statement that says X = X")
    where = by_relation(data, letters, weights, order, sides)
    return f"{texts[0]} = {texts[1]}{where}{order_text(letters, weights, order)}"


# ---- motions


def equation(data: Any, letters: Letters, x: Any, speed: Any, clock: Any, clock_text: str) -> tuple[Any, str]:
    """(a - f + f(c, 0) on a motion, up to the order; the equation as text)."""
    scale = data["weights"], data["order"]
    total, pushed, held, seen = letters.constant(0), [], ["x''"], set()
    for n, coefficients in enumerate(data["acceleration"]):
        jet = jet_of(letters, coefficients)
        total += jet * letters.power(clock, n, *scale)
        if coefficients:
            pushed.append(f"({letters.text(jet)})*({clock_text})**{n}")
    for (i, k), coefficients in data["force"]:
        need(all(type(n) is int and n >= 0 for n in (i, k)) and i + k > 0, "powers that are none")
        need((i, k) not in seen, "powers that occur twice")
        seen.add((i, k))
        jet = jet_of(letters, coefficients)
        total -= jet * letters.with_degree(letters.power(x, i, *scale) * letters.power(speed, k, *scale), *scale)
        held.append(f"({letters.text(jet)})*x**{i}*x'**{k}")
    return total, f"{' + '.join(held)} = {' + '.join(pushed) or '0'}"


def jet_of(letters: Letters, part: Any) -> Any:
    found = letters.read(part)
    need(all(letters.degree(found, n) <= 0 for n in range(3)), "a jet that depends on the state")
    return found


def motion(data: Any, letters: Letters) -> str:
    weights, order = scale_of(data, letters, 1)
    need(weights[0] == weights[2] == 1 and weights[1] >= 1 and not any(weights[3:]), "weights that are none")
    need(order is not None or weights[1] == 1, "weights without an order")
    sigma, v, t = letters.variables[:3]
    names = letters.names
    x = letters.read(data["height"])
    speed = x.derivative(2)
    pushed, solved = equation(data, letters, x, speed, sigma + t, f"{names[0]} + {names[2]}")
    rest = letters.with_degree(speed.derivative(2) - pushed, weights, None if order is None else order - 1)
    need(rest == 0, "it does not solve the equation")
    need(letters.at(x, 2, 0) == 0 and letters.at(speed, 2, 0) == v, "it starts otherwise")
    text = f"x = {letters.text(x)} solves {solved}"
    need(data["launch"] is not None or data["landing"] is None, "a landing without a launch")
    if data["launch"] is not None:
        launch = letters.read(data["launch"])
        # terms of x beyond the order were not compared: put for v, a launch of low degree would bring them below it
        degrees = [sum(n * w for n, w in zip(key, weights, strict=True)) for key in letters.terms(launch)]
        need(letters.degree(launch, 1) <= 0 and all(n >= weights[1] for n in degrees), "a launch of too low a degree")
        images = {1: (launch, letters.constant(1))}
        quotient = letters.context.from_dict({(*k[:2], k[2] - 1, *k[3:]): c for k, c in letters.terms(x).items()})
        back, _ = letters.put(quotient, images, weights, order)
        need(letters.with_degree(back, weights, order) == 0, "it does not come back after t")
        text += f", and x/{names[2]} = 0 at {names[1]} = {letters.text(launch)}"
        if data["landing"] is not None:
            landed, _ = letters.put(speed, images, weights, order)
            landing = letters.read(data["landing"])
            need(letters.with_degree(landed - landing, weights, order) == 0, "it lands with another velocity")
            text += f", where x' = {letters.text(landing)}"
    return f"{text}, x = 0 and x' = {names[1]} at {names[2]} = 0{order_text(letters, weights, order)}"


def flight(data: Any, letters: Letters) -> str:
    weights, order = scale_of(data, letters, 1)
    need(weights[:3] == [0, 1, 1] and not any(weights[3:]), "weights that are none")
    z, sigma, t = letters.variables[:3]
    names = letters.names
    y = letters.read(data["rise"])
    speed = y.derivative(0)
    pushed, solved = equation(data, letters, t * y, speed, sigma + z * t, f"{names[1]} + {names[0]}*{names[2]}")
    need(letters.with_degree(speed.derivative(0) - t * pushed, weights, order) == 0, "it does not solve the equation")
    launch, landing = letters.read(data["launch"]), letters.read(data["landing"])
    for polynomial, at, stated in ((y, 0, 0), (y, 1, 0), (speed, 0, launch), (speed, 1, landing)):
        need(letters.with_degree(letters.at(polynomial, 0, at) - stated, weights, order) == 0, "its ends are others")
    return (
        f"x = {names[2]}*({letters.text(y)}), time {names[0]}*{names[2]}, solves {solved}, x = 0 at {names[0]} = 0 "
        f"with x' = {letters.text(launch)} and at {names[0]} = 1 with x' = {letters.text(landing)}"
        f"{order_text(letters, weights, order)}"
    )


EVERY, ORDERED = {"kind", "variables"}, {"weights", "order"}
# What shows each kind, and the fields that it has beside those of every certificate.
KINDS = {
    "positive": (positive, {"numerator", "denominator", "sign", "box", "degree", "raised", "expansion"}),
    "chain": (chain, {"polynomial", "places", "box", "roots", "all"}),
    "value": (value, {"index", "at", "numerator", "denominator", "value"}),
    "definite": (definite, {"form", "sign"}),
    "identity": (identity, {"left", "right", "relation"}),
    "composed": (composed, {"left", "right", "relation"} | ORDERED),
    "motion": (motion, {"height", "acceleration", "force", "launch", "landing"} | ORDERED),
    "flight": (flight, {"rise", "acceleration", "force", "launch", "landing"} | ORDERED),
}
INNER = {
    "places": {"at", "sign", "degree", "raised", "expansion"},
    "left": {"outer", "images"},
    "right": {"outer", "images"},
}


# ---- files


@contextmanager
def answered() -> Iterator[None]:
    """Whatever goes wrong with a file is a refusal of one line."""
    try:
        yield
    except Exception as error:
        kind = "" if isinstance(error, Refused | OSError) else f"not a certificate: {type(error).__name__} "
        raise Refused(" ".join(f"{kind}{error}".split())[:400]) from error


def check_certificate(data: Any) -> str:
    """The statement of a certificate that holds; where it says something itself, that is the statement.

    Raises
    ------
    Refused : it does not, and why.
    """
    with answered():
        need(isinstance(data, dict) and isinstance(data.get("kind"), str) and data["kind"] in KINDS, "no certificate")
        show, fields = KINDS[data["kind"]]
        fields_are(set(data) - {"says"}, fields | EVERY)
        for name, inner in INNER.items():
            for record in data.get(name, ()) if name == "places" else [data.get(name)]:
                if isinstance(record, dict):
                    fields_are(record, inner)
        said = show(data, Letters(data["variables"]))
        need(data.get("says", said) == said, f"the data say: {said}")
    return said


def fields_are(data: Any, names: set[str]) -> None:
    other = names ^ set(data)
    need(not other, f"the field {min(other, default='')!r:.60} is {'missing' if other <= names else 'unknown'}")
