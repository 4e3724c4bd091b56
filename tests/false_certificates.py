"""False and malformed certificates, each with the condition of the checker that refuses it, and checkers without it."""

from __future__ import annotations

import types

from singimpact.algebra import checking, plain


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
        "if place[\"sign\"] not in (-1, 1) or not _expands(signed, place | {\"box\": data[\"box\"]}):",
        "if place[\"sign\"] not in (-1, 1):",
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
        "free = not any(key[index] for part in stated for key in part) and", "free =",
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
    "a difference": ("and not difference", "", identity([const(1), const(1)], [const(2), const(1)])),
    "nothing by nothing": (
        "return bool(below and under) and not", "return not", identity([[], []], [const(1), const(1)])),
    "a multiplier of zero": (
        "sound = bool(multiplier) and", "sound =",
        identity([const(1), const(1)], [const(2), const(1)], [[], [], ROOT_OF_TWO])),
    "a multiplier that vanishes": (
        " and not any(key[-1] for key in multiplier)", "",
        identity([const(1), const(1)], [const(2), const(1)], [ROOT_OF_TWO, const(-1), ROOT_OF_TWO])),
    "a relation of a higher degree": (
        "max(key[-1] for key in relation) == 2 and", "",
        identity([OF_DEGREE_3, poly(1, 1)], [[], const(1)], [const(1), const(1), OF_DEGREE_3])),
    "a left denominator that the relation makes zero": (
        "_norm(below, relation) and", "bool(below) and",
        identity([ROOT_OF_TWO, ROOT_OF_TWO], [const(5), const(1)], [const(1), const(-4), ROOT_OF_TWO])),
    "a right denominator that the relation makes zero": (
        "and _norm(under, relation))", "and bool(under))",
        identity([const(5), const(1)], [ROOT_OF_TWO, ROOT_OF_TWO], [const(1), const(4), ROOT_OF_TWO])),
    "a cofactor that is another": (
        "and times(multiplier, difference) == times(cofactor, relation)", "",
        identity([const(1), const(1)], [const(2), const(1)], [const(1), [], ROOT_OF_TWO])),
    "another sentence": (
        "certificate.get(\"says\", said) == said and ", "", definite(["6", "4", "1"]) | {"says": "1 = 2"}),
}  # fmt: skip

IN_PLAIN = {
    "exponents twice": ("or key in found", "", positive([[[0], -1], [[0], 1]], expansion=[[[0], 1]])),
    "negative exponents": (
        "type(power) is not int or power < 0", "type(power) is not int",
        value([[[-1], 1]], const(1), "1", [const(1), const(1)])),
    "a coefficient of zero": (
        "if not all(found.values()):", "if False:", identity([[], const(1)], [[[[3], 0]], const(1)])),
    "exponents that are not whole": (
        "type(power) is not int or power < 0", "power < 0", value([[[True], 1]], const(1), "1", [const(1), const(1)])),
    "coefficients in floating point": (
        "or not isinstance(value, int | str)", "", definite([6.0, 4.0, 1.0])),
    "coefficients that are words": ("isinstance(value, bool) or", "", definite([True, 0, True])),
}  # fmt: skip


def without(condition, instead, name):
    """`accepts` of a checker whose source has one condition taken out."""
    module = checking if name == "checking" else plain
    with open(module.__file__) as file:
        text = file.read()
    assert text.count(condition) == 1, f"{condition!r} stands {text.count(condition)} times in {name}.py"
    return loaded(name, text.replace(condition, instead))


def loaded(name, text):
    """`accepts` with another source of checking.py, or of plain.py and all that reads by it."""
    from singimpact.algebra import sentences

    made = types.ModuleType(name)
    made.__dict__["__file__"] = f"{name}.py"
    exec(compile(text, f"{name}.py", "exec"), made.__dict__)
    if name == "checking":
        return made.accepts
    changed = {key: part for key, part in vars(made).items() if not key.startswith("__")}
    rooms = []
    for room in (sentences, checking):
        again = types.ModuleType(room.__name__)
        with open(room.__file__) as file:
            exec(compile(file.read(), room.__file__, "exec"), again.__dict__)
        again.__dict__.update({key: part for key, part in changed.items() if key in again.__dict__})
        rooms.append(again)
    rooms[1].sentence = rooms[0].sentence
    return rooms[1].accepts
