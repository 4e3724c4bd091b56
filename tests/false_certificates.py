"""False and malformed certificates, each with the condition of the second program that refuses it.

`without` is the program without one condition.
"""

from __future__ import annotations

import types

from singimpact.certificates import claims_proofs


def const(value):
    return [[[0], value]] if value else []


def poly(*values):
    """In x, from the constant coefficient on."""
    return [[[n], value] for n, value in enumerate(values) if value]


def positive(numerator, box=("0", "1"), degree=0, raised=0, expansion=(), **more):
    return {"kind": "positive", "variables": ["x"], "numerator": numerator, "denominator": const(1), "sign": 1,
            "box": [list(box)], "degree": [degree], "raised": [raised],
            "expansion": [list(part) for part in expansion]} | more  # fmt: skip


def place(at, sign, degree=(), raised=(), expansion=(([], 1),)):
    return {"at": at, "sign": sign, "degree": list(degree), "raised": list(raised),
            "expansion": [list(part) for part in expansion]}  # fmt: skip


def chain(polynomial, places, roots, everything):
    return {"kind": "chain", "variables": ["x"], "polynomial": polynomial, "box": [], "places": places,
            "roots": roots, "all": everything}  # fmt: skip


def value(numerator, denominator, at, stated):
    return {"kind": "value", "variables": ["x"], "numerator": numerator, "denominator": denominator, "index": 0,
            "at": at, "value": stated}  # fmt: skip


def definite(form, sign=1):
    return {"kind": "definite", "variables": ["x", "y"], "form": form, "sign": sign}


def identity(left, right, relation=None, variables=("w",)):
    return {"kind": "identity", "variables": list(variables), "left": left, "right": right, "relation": relation}


# w^2 = 2
ROOT_OF_TWO = [[[2], 1], [[0], -2]]
OF_DEGREE_3 = poly(-2, -2, 1, 1)  # (w + 1)(w^2 - 2)

# name -> (the condition in the source, what stands there without it, a certificate that it must refuse)
WEAKENED = {
    "an empty expansion": ("bool(seen) and total == left", "total == left", positive([], expansion=[])),
    "a negative part": (
        " and number(value) > 0, \"a part", ", \"a part", positive(poly(-1), expansion=[[[0], -1]])),
    "a part of zero": (
        "number(value) > 0, \"a part", "number(value) >= 0, \"a part", positive([], expansion=[[[0], 0]])),
    "another polynomial": ("bool(seen) and total == left", "bool(seen)", positive(poly(-1), expansion=[[[0], 1]])),
    "an interval without inside": (
        "need(number(low) < number(high) and raised == 0", "need(raised == 0",
        positive(poly(-2, 3, -1), ("2", "1"), 2, 0, [[[1], 1]])),
    "a finite interval raised": (
        " and raised == 0, ", ", ", positive(poly(0, 1), ("0", "1"), 1, 3, [[[1], 1]])),
    "a half-line with a degree": (
        "need(degree == 0, ", "need(True, ", positive(poly(0, 1), ("0", "oo"), 3, 0, [[[1], 1]])),
    "a sign of 2": (
        "need(data[\"sign\"] in (-1, 1) and type(data[\"sign\"]) is int, ", "need(True, ",
        positive(poly(1), expansion=[[[0], 2]], sign=2)),
    "places out of order": (
        "need(all(one < two for one, two in pairwise(ordered)), ", "need(True, ",
        chain(poly(-1, 0, 1), [place("0", -1), place("2", 1, expansion=[[[], 3]]), place("0", -1)],
              [["0", "2"], ["2", "0"]], True)),
    "gaps that are none": (
        "need(gaps == data[\"roots\"], ", "need(True, ",
        chain(poly(-1, 0, 1), [place("0", -1)], [["2", "3"]], False)),
    "no others, unproved": (
        "need(data[\"all\"] is (len(gaps) == letters.degree(poly, 0)), ", "need(True, ",
        chain(poly(-1, 0, 1), [place("0", -1), place("2", 1, expansion=[[[], 3]])], [["0", "2"]], True)),
    "a sign unproved": (
        "need(expands(letters, 1, value, data[\"box\"], point), ", "need(True, ",
        chain(poly(1, 0, 1), [place("0", -1), place("1", 1)], [["0", "1"]], False)),
    "degrees at infinity, falling": (
        "letters.constant(0) if more < 0 else over", "over", value(const(1), poly(0, 1), "oo", [const(1), const(1)])),
    "degrees at infinity, rising": (
        "grows = more > 0", "grows = False", value(poly(0, 0, 1), poly(0, 1), "oo", [const(1), const(1)])),
    "a pole at infinity that is none": (
        "grows = more > 0", "grows = True", value(poly(0, 1), poly(0, 1), "oo", "infinite")),
    "a pole that is none": ("need(grows and over != 0", "need(over != 0", value(const(1), const(1), "0", "infinite")),
    "nothing by nothing is no pole": (
        "need(grows and over != 0", "need(grows", value(poly(0, 1), poly(0, 1), "0", "infinite")),
    "a value with the variable in it": (
        "need(all(letters.degree(polynomial, index) <= 0 for polynomial in stated), ", "need(True, ",
        value(const(2), const(1), "0", [poly(0, 2), poly(0, 1)])),
    "zero by zero": (
        "need(not grows and stated[1] != 0", "need(stated[1] != 0",
        value(poly(0, 1), poly(0, 1), "0", [const(5), const(1)])),
    "a value by zero": (" and stated[1] != 0, ", ", ", value([], const(1), "0", [[], []])),
    "another value": (
        "need(over * stated[1] == under * stated[0], ", "need(True, ",
        value(const(1), const(1), "0", [const(5), const(1)])),
    "a denominator that is zero": (
        "need(below != 0, ", "need(True, ", value(const(1), [], "0", "infinite")),
    "a variable counted from the end": (
        "need(type(index) is int and 0 <= index < len(letters.names), ", "need(True, ",
        value(const(2), const(1), "0", [const(2), const(1)]) | {"index": -1}),
    "a form that vanishes on a line": ("b * b < 4 * a * c", "b * b <= 4 * a * c", definite(["1", "2", "1"])),
    "a form of another sign": ("and a * sign > 0 ", "", definite(["-1", "0", "-1"])),
    "a saddle": (" and b * b < 4 * a * c", "", definite(["1", "0", "-1"])),
    "a form and the sign 2": ("type(sign) is int and sign in (-1, 1) and ", "", definite(["6", "4", "1"], 2)),
    "another sentence": (
        "need(data.get(\"says\", said) == said, ", "need(True, ", definite(["6", "4", "1"]) | {"says": "1 = 2"}),
}  # fmt: skip

E = [[[0, 1], 1]]  # the small variable, the second of (w, e)
ONE_TWO, TWO_TWO = ([[[0, 0], n]] for n in (1, 2))


def side(outer, *images, below=ONE_TWO):
    return {"outer": [outer, below], "images": [[index, list(pair)] for index, pair in images]}


def composed(left, right, relation=None, order=None, weights=(0, 0)):
    return {"kind": "composed", "variables": ["w", "e"], "weights": list(weights), "order": order, "left": left,
            "right": right, "relation": relation}  # fmt: skip


SQUARE = [[[2, 0], 1]]
LINE = [[[1, 0], 1]]  # w
E_SQUARED_IS_2 = [[[0, 2], 1], [[0, 0], -2]]

E_AND_1 = [*E, *ONE_TWO]

IN_IDENTITIES = {
    "a difference": (
        "need(difference == 0, ", "need(True, ", identity([const(1), const(1)], [const(2), const(1)])),
    "nothing by nothing": (
        "need(letters.with_degree(polynomial, weights, None if order is None else 0) != 0, ", "need(True, ",
        identity([[], []], [const(1), const(1)])),
    "a multiplier of zero": (
        "letters.degree(multiplier, last) == 0", "letters.degree(multiplier, last) <= 0",
        identity([const(1), const(1)], [const(2), const(1)], [[], [], ROOT_OF_TWO])),
    "a multiplier that vanishes": (
        " and letters.degree(multiplier, last) == 0", "",
        identity([const(1), const(1)], [const(2), const(1)], [ROOT_OF_TWO, const(-1), ROOT_OF_TWO])),
    "a relation of a higher degree": (
        "letters.degree(relation, last) == 2 and ", "",
        identity([OF_DEGREE_3, poly(1, 1)], [[], const(1)], [const(1), const(1), OF_DEGREE_3])),
    "a left denominator that the relation makes zero": (
        "in (below, under):\n        lowest", "in (under,):\n        lowest",
        identity([ROOT_OF_TWO, ROOT_OF_TWO], [const(5), const(1)], [const(1), const(-4), ROOT_OF_TWO])),
    "a right denominator that the relation makes zero": (
        "in (below, under):\n        lowest", "in (below,):\n        lowest",
        identity([const(5), const(1)], [ROOT_OF_TWO, ROOT_OF_TWO], [const(1), const(4), ROOT_OF_TWO])),
    "a cofactor that is another": (
        "need(left == right, ", "need(True, ",
        identity([const(1), const(1)], [const(2), const(1)], [const(1), [], ROOT_OF_TWO])),
    "a statement that is equal to itself": (
        "need(lowest_form(*sides[0]) != lowest_form(*sides[1]), ", "need(True, ",
        identity([poly(1, 1), const(1)], [poly(1, 1), const(1)])),
    "a composition that is equal to itself": (
        "need(forms[0] != forms[1], ", "need(True, ", composed(side(LINE), side(LINE))),
    "an image twice": (
        "len(images) == len(side[\"images\"]) and ", "",
        composed(side(LINE, (0, (TWO_TWO, ONE_TWO)), (0, (ONE_TWO, ONE_TWO))), side(ONE_TWO))),
    "an image by zero": (
        "need(lowest != 0, ", "need(True, ",
        composed(side(E_AND_1, (0, (ONE_TWO, []))), side(LINE, (0, (E_AND_1, ONE_TWO))))),
    "an image that the relation makes zero": (
        "need(resultant(letters, lowest, zero, len(letters.names) - 1) != 0, ", "need(True, ",
        composed(side(E_AND_1, (0, (ONE_TWO, E_SQUARED_IS_2))), side(LINE, (0, (E_AND_1, ONE_TWO))),
                 [ONE_TWO, [], E_SQUARED_IS_2])),
    "a quotient by something small": (
        "None if order is None else 0) != 0, \"a quotient", "None) != 0, \"a quotient",
        composed(side([[[0, 2], 1]], below=E), side([]), order=1, weights=(0, 1))),
    "negative weights": (
        "type(each) is int and 0 <= each <= EXPONENT for", "type(each) is int for",
        composed(side(LINE, (0, ([*LINE, *ONE_TWO], ONE_TWO))), side([*LINE, *ONE_TWO]), order=0, weights=(0, -1))),
    "an order that is none": (
        "type(order) is int and least", "least",
        composed(side(LINE, (0, ([*LINE, *ONE_TWO], ONE_TWO))), side([*LINE, *ONE_TWO]), order=True)),
    "weights without an order": (
        "need(order is not None or not any(weights), ", "need(True, ",
        composed(side(LINE, (0, ([*LINE, *ONE_TWO], ONE_TWO))), side([*LINE, *ONE_TWO]), weights=(0, 1))),
    "a small multiplier": (
        "all(letters.with_degree(polynomial, weights, 0) == polynomial for polynomial in (multiplier, relation))",
        "True", composed(side(ONE_TWO), side(TWO_TWO), [LINE, [], E_SQUARED_IS_2], 0, (1, 0))),
}  # fmt: skip


def motion(height, acceleration, force=(), launch=None, landing=None, order=None, weights=(1, 1, 1)):
    """Of x in (sigma, v, t): a_0 alone, unless a list of polynomials is given."""
    return {"kind": "motion", "variables": ["sigma", "v", "t", "a"][: len(weights)], "weights": list(weights),
            "order": order, "height": height, "acceleration": acceleration, "force": [list(part) for part in force],
            "launch": launch, "landing": landing}  # fmt: skip


def flight(rise, launch, landing, order=3):
    """Of x'' = 2."""
    return {"kind": "flight", "variables": ["z", "sigma", "t"], "weights": [0, 1, 1], "order": order, "rise": rise,
            "acceleration": [[[[0, 0, 0], 2]]], "force": [], "launch": launch, "landing": landing}  # fmt: skip


VT, T, TT, ONE_THREE = [[[0, 1, 1], 1]], [[[0, 0, 1], 1]], [[[0, 0, 2], 1]], [[[0, 0, 0], 1]]
PUSH = [[[[0, 0, 0], 2]]]  # x'' = 2
FALL = VT + TT  # its motion
BACK = [[[0, 0, 1], -1]]  # v = -t brings it back
RISE = [[[2, 0, 1], 1], [[1, 0, 1], -1]]  # of the flight: (z^2 - z) t
ANY_SLOPE = [[[0, 1], ONE_THREE], [[0, 1], [[[0, 0, 0], -1]]]]  # x' and -x'

IN_MOTIONS = {
    "another motion": ("need(rest == 0, ", "need(True, ", motion([*VT, [[0, 0, 2], 2]], PUSH)),
    "a start elsewhere": ("letters.at(x, 2, 0) == 0 and ", "", motion(FALL + ONE_THREE, PUSH)),
    "another start": (
        " and letters.at(speed, 2, 0) == v, ", ", ", motion([[[0, 1, 1], 2], *TT], PUSH)),
    "a landing of no launch": (
        "need(data[\"launch\"] is not None or data[\"landing\"] is None, ", "need(True, ",
        motion(FALL, PUSH, landing=T)),
    "a launch that depends on v": (
        "letters.degree(launch, 1) <= 0 and ", "", motion(FALL, PUSH, launch=[*BACK, [[0, 2, 0], 1]], order=1)),
    "a launch of too low a degree": (
        " and all(n >= weights[1] for n in degrees), ", ", ",
        motion(FALL, PUSH, launch=BACK, order=1, weights=(1, 2, 1))),
    "a launch that does not come back": (
        "need(letters.with_degree(back, weights, order) == 0, ", "need(True, ", motion(FALL, PUSH, launch=T)),
    "a landing after no return": (
        "need(letters.with_degree(back, weights, order) == 0, ", "need(True, ",
        motion(FALL, PUSH, launch=T, landing=[[[0, 0, 1], 3]])),
    "another landing": (
        "need(letters.with_degree(landed - landing, weights, order) == 0, ", "need(True, ",
        motion(FALL, PUSH, launch=BACK, landing=[[[0, 0, 1], 2]])),
    "another flight": (
        "need(letters.with_degree(speed.derivative(0) - t * pushed, weights, order) == 0, ", "need(True, ",
        flight([[[2, 0, 1], 2], [[1, 0, 1], -2]], [[[0, 0, 1], -2]], [[[0, 0, 1], 2]])),
    "another end of a flight": (
        "need(letters.with_degree(letters.at(polynomial, 0, at) - stated, weights, order) == 0, ", "need(True, ",
        flight(RISE, BACK, [[[0, 0, 1], 3]])),
    "weights of a flight": (
        "need(weights[:3] == [0, 1, 1] and ", "need(", flight(RISE, BACK, [[[0, 0, 1], 3]]) | {"weights": [0, 0, 9]}),
    "weights of letters": (
        "weights[1] >= 1 and not any(weights[3:]), ", "weights[1] >= 1, ",
        motion([[[0, 1, 1, 0], 1]], [[[[0, 0, 0, 1], 1]]], order=2, weights=(1, 1, 1, 9))),
    "other weights of the state": (
        "weights[0] == weights[2] == 1 and ", "", motion(VT, [[], [[[0, 0, 0], 1]]], order=1, weights=(9, 1, 9))),
    "an order of a motion that is none": ("least <= order <= EXPONENT", "order <= EXPONENT", motion(VT, PUSH, order=0)),
    "a jet that is a function of time": (
        "need(all(letters.degree(found, n) <= 0 for n in range(3)), ", "need(True, ",
        motion([*VT, [[0, 0, 3], 1]], [[[[0, 0, 1], 6]]])),
    "a jet twice": ("need((i, k) not in seen, ", "need(True, ", motion(FALL, PUSH, ANY_SLOPE)),
    "a power that is no number": (
        "all(type(n) is int and n >= 0 for n in (i, k)) and ", "", motion(FALL, PUSH, [[[0, True], []]])),
    "weights of an exact motion": (
        "need(order is not None or weights[1] == 1, ", "need(True, ", motion(FALL, PUSH, weights=(1, 2, 1))),
    "a force at rest": (" and i + k > 0, ", ", ", motion(FALL, [], [[[0, 0], [[[0, 0, 0], -2]]]])),
}  # fmt: skip

IN_DATA = {
    "exponents twice": (
        "need(key not in found and ", "need(", positive([[[0], -1], [[0], 1]], expansion=[[[0], 1]])),
    "a coefficient of zero": (
        " and number(value) != 0, ", ", ", value([[[0], 0]], const(1), "0", [[], const(1)])),
    "exponents that are not whole": (
        "            need(all(type(n) is int and 0 <= n <= EXPONENT for n in key), \"an exponent that is none\")\n"
        "            need(key", "            need(key", value([[[True], 1]], const(1), "1", [const(1), const(1)])),
    "coefficients in floating point": (
        "re.fullmatch(r\"-?\\d+(/0*[1-9]\\d*)?\", text, re.ASCII) and ", "", definite([6.0, 4.0, 1.0])),
    "a name twice": (
        "need(len(set(self.names)) == len(self.names), ", "need(True, ",
        definite(["6", "4", "1"]) | {"variables": ["x", "x"]}),
    "a name that is none": (
        " and name.isidentifier()", "", definite(["6", "4", "1"]) | {"variables": ["x", "1"]}),
    "a field that has no meaning": (
        "fields_are(set(data) - {\"says\"}, fields | EVERY)", "pass", definite(["6", "4", "1"]) | {"proves": "all"}),
}  # fmt: skip
EVERY = WEAKENED | IN_IDENTITIES | IN_MOTIONS | IN_DATA


def accepts(certificate, program=claims_proofs):
    """Whether the second program accepts a certificate, with or without its sentence."""
    try:
        program.check_certificate(certificate)
    except program.Refused:
        return False
    return True


def without(condition, instead):
    """`accepts` of the second program with one condition taken out."""
    with open(claims_proofs.__file__, encoding="utf-8") as file:
        text = file.read()
    assert text.count(condition) == 1, f"{condition!r} stands {text.count(condition)} times"
    program = types.ModuleType("weakened")
    exec(compile(text.replace(condition, instead), "weakened.py", "exec"), program.__dict__)
    return lambda certificate: accepts(certificate, program)
