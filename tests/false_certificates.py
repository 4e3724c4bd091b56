"""False and malformed certificates, each with the condition of the checker that refuses it, and checkers without it."""

from __future__ import annotations

import os
import sys
import types

from singimpact.algebra import checking


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


def count(rows, steps, low, high, roots, first="2"):
    return {"kind": "count", "variables": ["x"], "chain": rows, "first": first, "steps": steps, "low": low,
            "high": high, "roots": roots}  # fmt: skip


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
SQUARE_LESS_ONE = [["-1", "0", "1"], ["0", "1"], ["1"]]  # x^2 - 1, its Sturm chain
STEPS = [[["0", "1"], "1"], [["0", "1"], "1"]]

# name -> (the condition in the source, what stands there without it, a certificate that it must refuse)
WEAKENED = {
    "an empty expansion": ("bool(expansion) and all(", "all(", positive([], expansion=[])),
    "a negative part": (
        "all(value > 0 for value in expansion.values())", "True", positive(poly(-1), expansion=[[[0], -1]])),
    "another polynomial": ("and left == total", "", positive(poly(-1), expansion=[[[0], 1]])),
    "an interval without inside": (
        "if not rational(low) < rational(high):", "if False:",
        positive(poly(-2, 3, -1), ("2", "1"), 2, 0, [[[1], 1]])),
    "a finite interval raised": (
        "if more if low not in INFINITE and high not in INFINITE else proof[\"degree\"][index]:", "if False:",
        positive(poly(0, 1), ("0", "oo"), 3, 0, [[[1], 1]])),
    "places out of order": (
        "order == sorted(order) and ", "",
        chain(poly(-1, 0, 1), [place("0", -1), place("2", 1, expansion=[[[], 3]]), place("0", -1)],
              [["0", "2"], ["2", "0"]], True)),
    "gaps that are none": (
        "and gaps == data[\"roots\"]", "", chain(poly(-1, 0, 1), [place("0", -1)], [["2", "3"]], False)),
    "no others, unproved": (
        "and data[\"all\"] == (len(gaps) == degree)", "",
        chain(poly(-1, 0, 1), [place("0", -1), place("2", 1, expansion=[[[], 3]])], [["0", "2"]], True)),
    "a sign unproved": (
        "if point[\"sign\"] not in (-1, 1) or not _expands(signed, point | {\"box\": data[\"box\"]}):",
        "if point[\"sign\"] not in (-1, 1):",
        chain(poly(1, 0, 1), [place("0", -1), place("1", 1)], [["0", "1"]], False)),
    "a derivative turned round": (
        "rational(data[\"first\"]) <= 0 or ", "",
        count([["-1", "0", "1"], ["0", "-1"], ["1"]], [[["0", "-1"], "1"], [["0", "-1"], "1"]], "-2", "2", -2, "-2")),
    "another derivative": (
        "or slope != times(chain[1], {(0,): rational(data[\"first\"])})", "",
        count([["-1", "0", "1"], ["1"]], [[["-1", "0", "1"], "1"]], "-2", "2", 0)),
    "a step turned round": (
        "rational(scale) <= 0 or chain", "chain",
        count([["1", "0", "1"], ["0", "1"], ["1"]], [[["0", "1"], "-1"], [["0", "1"], "1"]], "-2", "2", 2)),
    "a step that is wrong": (
        "or chain[n] != right ", "", count([["1", "0", "1"], ["0", "1"], ["1"]], STEPS, "-2", "2", 2)),
    "a last step of another scale": (
        "or (not last and rational(scale) != 1)", "",
        count(SQUARE_LESS_ONE, [[["0", "1"], "1"], [["0", "1"], "7"]], "-2", "2", 2)),
    "a chain cut short": (
        "len(data[\"steps\"]) == len(chain) - 1 and ", "",
        count([["1", "0", "1"], ["0", "1"], ["1"]], [], "-2", "2", 2)),
    "a multiple root": (
        "and set(chain[-1]) == {(0,)}", "",
        count([["-3", "7", "-5", "1"], ["7", "-10", "3"], ["-1", "1"]],
              [[["-5/9", "1/3"], "8/9"], [["-7", "3"], "1"]], "1", "4", 0, "1")),
    "ends out of order": ("and ends[0] < ends[1]", "", count(SQUARE_LESS_ONE, STEPS, "2", "-2", -2)),
    "a root at the end": (
        " - at_end == data[\"roots\"]", " == data[\"roots\"]", count(SQUARE_LESS_ONE, STEPS, "-2", "1", 2)),
    "another count": (
        "changes[0] - changes[1] - at_end == data[\"roots\"]", "True", count(SQUARE_LESS_ONE, STEPS, "-2", "2", 5)),
    "degrees at infinity, falling": (
        "if at in INFINITE and more < 0:", "if False:", value(const(1), poly(0, 1), "oo", [const(1), const(1)])),
    "degrees at infinity, rising": (
        "and not (at in INFINITE and more > 0)", "", value(poly(0, 0, 1), poly(0, 1), "oo", [const(1), const(1)])),
    "a pole at infinity that is none": (
        "(more > 0 if at in INFINITE else not below)", "(at in INFINITE or not below)",
        value(poly(0, 1), poly(0, 1), "oo", "infinite")),
    "a pole that is none": (
        "(more > 0 if at in INFINITE else not below)", "True", value(const(1), const(1), "0", "infinite")),
    "nothing by nothing is no pole": (
        "return bool(above) and (more", "return (more", value(poly(0, 1), poly(0, 1), "0", "infinite")),
    "a value with the variable in it": (
        "free = not any(key[index] for side in stated for key in side) and", "free =",
        value(const(2), const(1), "0", [poly(0, 2), poly(0, 1)])),
    "zero by zero": (
        "bool(below and stated[1]) and", "bool(stated[1]) and",
        value(poly(0, 1), poly(0, 1), "0", [const(5), const(1)])),
    "a value by zero": ("bool(below and stated[1])", "bool(below)", value([], const(1), "0", [[], []])),
    "another value": (
        "and times(above, stated[1]) == times(below, stated[0])", "",
        value(const(1), const(1), "0", [const(5), const(1)])),
    "a denominator that is zero": (
        "if not polys[1]:\n        return False",
        "if not polys[1]:\n        polys[1] = {(0,): ONE}\n        below = polys[1]",
        value(const(1), [], "0", [const(1), const(1)])),
    "a form that vanishes on a line": ("4 * a * c > b * b", "4 * a * c >= b * b", definite(["1", "2", "1"])),
    "a form of another sign": ("a > 0 and", "", definite(["-1", "0", "-1"])),
    "a saddle": (" and 4 * a * c > b * b", "", definite(["1", "0", "-1"])),
    "another sentence": (
        "certificate.get(\"says\", said) == said and ", "", definite(["6", "4", "1"]) | {"says": "1 = 2"}),
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

IN_IDENTITIES = {
    "a difference": ("return not difference", "return True", identity([const(1), const(1)], [const(2), const(1)])),
    "nothing by nothing": (
        "else lowest)", "else True)", identity([[], []], [const(1), const(1)])),
    "a multiplier of zero": (
        "sound = bool(multiplier) and", "sound =",
        identity([const(1), const(1)], [const(2), const(1)], [[], [], ROOT_OF_TWO])),
    "a multiplier that vanishes": (
        " and not any(key[-1] for key in multiplier)", "",
        identity([const(1), const(1)], [const(2), const(1)], [ROOT_OF_TWO, const(-1), ROOT_OF_TWO])),
    "a relation of a higher degree": (
        "max(key[-1] for key in zero) == 2 and", "",
        identity([OF_DEGREE_3, poly(1, 1)], [[], const(1)], [const(1), const(1), OF_DEGREE_3])),
    "a left denominator that the relation makes zero": (
        "_invertible(left[1], relation, truncation) and", "",
        identity([ROOT_OF_TWO, ROOT_OF_TWO], [const(5), const(1)], [const(1), const(-4), ROOT_OF_TWO])),
    "a right denominator that the relation makes zero": (
        "and _invertible(right[1], relation, truncation)", "",
        identity([const(5), const(1)], [ROOT_OF_TWO, ROOT_OF_TWO], [const(1), const(4), ROOT_OF_TWO])),
    "a cofactor that is another": (
        "and truncation.of(times(multiplier, difference)) == truncation.of(times(cofactor, zero))", "",
        identity([const(1), const(1)], [const(2), const(1)], [const(1), [], ROOT_OF_TWO])),
    "a statement that is equal to itself": (
        "return left != right and _equal(left", "return _equal(left",
        identity([poly(1, 1), const(1)], [poly(1, 1), const(1)])),
    "a composition that is equal to itself": (
        "return data[\"left\"] != data[\"right\"] and", "return", composed(side(LINE), side(LINE))),
    "an image twice": (
        "len(images) != len(data[side][\"images\"]) or", "",
        composed(side(LINE, (0, (TWO_TWO, ONE_TWO)), (0, (ONE_TWO, ONE_TWO))), side(ONE_TWO))),
    "an image by zero": (
        "            return False\n        above", "            pass\n        above",
        composed(side(ONE_TWO, (0, (ONE_TWO, []))), side(ONE_TWO, (1, (ONE_TWO, ONE_TWO))))),
    "a quotient by something small": (
        "return poly if self.order is None else cut(poly, self.weights, 0)", "return poly",
        composed(side([[[0, 2], 1]], below=E), side([]), order=1, weights=(0, 1))),
    "negative weights": (
        "type(weight_) is int and weight_ >= 0 for", "type(weight_) is int for",
        composed(side(LINE, (0, ([*LINE, *ONE_TWO], ONE_TWO))), side([*LINE, *ONE_TWO]), order=0, weights=(0, -1))),
    "an order that is none": (
        "type(truncation.order) is not int or truncation.order < 0", "False",
        composed(side(LINE, (0, ([*LINE, *ONE_TWO], ONE_TWO))), side([*LINE, *ONE_TWO]), order=True)),
    "weights without an order": (
        "if truncation.order is None and any(truncation.weights):", "if False:",
        composed(side(LINE, (0, ([*LINE, *ONE_TWO], ONE_TWO))), side([*LINE, *ONE_TWO]), weights=(0, 1))),
    "a small multiplier": (
        " and truncation.spared(multiplier, zero)", "",
        composed(side(ONE_TWO), side(TWO_TWO), [LINE, [], E_SQUARED_IS_2], 0, (1, 0))),
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
    "another motion": (
        "if residual or not starts or data[\"launch\"] is None:\n        return not residual and starts and",
        "if not starts or data[\"launch\"] is None:\n        return starts and",
        motion([*VT, [[0, 0, 2], 2]], PUSH)),
    "a start elsewhere": ("not at(height, 2, ZERO) and at(", "at(", motion(FALL + ONE_THREE, PUSH)),
    "another start": (
        " and at(speed, 2, ZERO) == line(ZERO, 1, 1, size)", "", motion([[[0, 1, 1], 2], *TT], PUSH)),
    "a landing of no launch": (
        " and data[\"landing\"] is None\n    launch", "\n    launch", motion(FALL, PUSH, landing=T)),
    "a launch that depends on v": (
        "any(key[1] for key in launch) or", "",
        motion(FALL, PUSH, launch=[*BACK, [[0, 2, 0], 1]], order=1)),
    "a launch of too low a degree": (
        " or any(weight(key, weights) < weights[1] for key in launch)", "",
        motion(FALL, PUSH, launch=BACK, order=1, weights=(1, 2, 1))),
    "a launch that does not come back": ("return not back\n", "return True\n", motion(FALL, PUSH, launch=T)),
    "a landing after no return": (
        "return not back and cut(", "return cut(", motion(FALL, PUSH, launch=T, landing=[[[0, 0, 1], 3]])),
    "another landing": (
        " and cut(landed, weights, order) == cut(terms(data[\"landing\"]), weights, order)", "",
        motion(FALL, PUSH, launch=BACK, landing=[[[0, 0, 1], 2]])),
    "another flight": (
        "        return False\n    ends", "        pass\n    ends",
        flight([[[2, 0, 1], 2], [[1, 0, 1], -2]], [[[0, 0, 1], -2]], [[[0, 0, 1], 2]])),
    "another end of a flight": ("return ends == stated", "return True", flight(RISE, BACK, [[[0, 0, 1], 3]])),
    "weights of letters": (
        " or any(weights[3:])", "",
        motion([[[0, 1, 1, 0], 1]], [[[[0, 0, 0, 1], 1]]], order=2, weights=(1, 1, 1, 9))),
    "other weights of the state": (
        " or not right", "", motion(VT, [[], [[[0, 0, 0], 1]]], order=1, weights=(9, 1, 9))),
    "an order of a motion that is none": (
        "type(order) is not int or order < 1", "False", motion(VT, PUSH, order=0)),
    "a jet that is a function of time": (
        "if any(any(key[:3]) for jet", "if False and any(any(key[:3]) for jet",
        motion([*VT, [[0, 0, 3], 1]], [[[[0, 0, 1], 6]]])),
    "a jet twice": ("len(set(pairs)) < len(pairs) or", "", motion(FALL, PUSH, ANY_SLOPE)),
    "a power that is no number": (
        " or not all(type(n) is int and n >= 0 for pair in pairs for n in pair)", "",
        motion(FALL, PUSH, [[[0, True], []]])),
    "weights of an exact motion": (
        "if order is None and weights[:3] != (1, 1, 1):", "if False:", motion(FALL, PUSH, weights=(1, 2, 1))),
    "a force at rest": ("if (0, 0) in pairs:", "if False:", motion(FALL, [], [[[0, 0], [[[0, 0, 0], -2]]]])),
}  # fmt: skip

IN_PLAIN = {
    "exponents twice": ("or key in sums", "", positive([[[0], -1], [[0], 1]], expansion=[[[0], 1]])),
    "negative exponents": (
        "type(power) is not int or power < 0", "type(power) is not int",
        value([[[-1], 1]], const(1), "1", [const(1), const(1)])),
    "a coefficient of zero": (
        "if not all(sums.values()):", "if False:", identity([[], const(1)], [[[[3], 0]], const(1)])),
    "exponents that are not whole": (
        "type(power) is not int or power < 0", "power < 0", value([[[True], 1]], const(1), "1", [const(1), const(1)])),
    "coefficients in floating point": (
        "or not isinstance(value, int | str)", "", definite([6.0, 4.0, 1.0])),
    "coefficients that are words": ("isinstance(value, bool) or", "", definite([True, 0, True])),
}  # fmt: skip


CHAIN = ("plain", "sentences", "checking")


def without(condition, instead, name):
    """`accepts` of a checker one of whose files has one condition taken out."""
    with open(f"{os.path.dirname(checking.__file__)}/{name}.py") as file:
        text = file.read()
    assert text.count(condition) == 1, f"{condition!r} stands {text.count(condition)} times in {name}.py"
    return loaded(name, text.replace(condition, instead))


def loaded(name, text):
    """`accepts` of a checker with another source of one of its files."""
    known = {part: sys.modules[f"singimpact.algebra.{part}"] for part in CHAIN}
    try:
        for part in CHAIN:
            made = types.ModuleType(f"singimpact.algebra.{part}")
            with open(known[part].__file__) as file:
                source = text if part == name else file.read()
            exec(compile(source, f"{part}.py", "exec"), made.__dict__)
            sys.modules[made.__name__] = made
        return made.accepts
    finally:
        sys.modules.update({f"singimpact.algebra.{part}": module for part, module in known.items()})
