"""Fuzz the checker with false certificates: `python tests/tool/fuzzing/certificates.py --certificates 100000 --seed 1`.

True certificates of every kind are made, damaged in one to three places (a number, an end, a sign, two parts exchanged, a
part of another certificate), and each one that the checker accepts is judged by a route that shares nothing with it:
values at points, roots isolated by flint, limits by nearby values.  Prints each false one that was accepted.
"""

from __future__ import annotations

import argparse
import copy
import json
import random
import sys
from collections import Counter
from fractions import Fraction
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parents[2]), str(Path(__file__).parents[3])]

KINDS = ("positive", "chain", "value", "definite", "identity")
NUMBERS = (0, 1, -1, 2, -2, 3, "1/2", "-1/3", "0", "1", "-1", "2", "oo", "-oo", "infinite", None, True, [], 7)


def seeds():
    """True certificates of every kind, made by the package."""
    import sympy

    from singimpact.algebra import certificates as make

    def quotients(above, below):
        """above/below = x + y, not cancelled."""
        right = [[[[1, 0], 1], [[0, 1], 1]], [[[0, 0], 1]]]
        return {"kind": "identity", "variables": ["x", "y"], "left": [above, below], "right": right, "relation": None}

    x, y, r = sympy.symbols("x y r")
    half, oo = sympy.Rational(1, 2), sympy.oo
    calls = [
        (make.positive_on, (1 - x) * (x + 3) / (2 - x), x, 0, 1), (make.positive_on, x**2 - x + half, x, 0, 1),
        (make.positive_on, x**2 - x + 1, x, 0, oo), (make.negative_on, x**3 - 1, x, -oo, 0),
        (make.positive_in, 2 - x - r * y / (1 + y), {x: (0, 1), y: (0, oo), r: (0, 1)}),
        (make.positive_in, 2 - x - y, {x: (0, 1), y: (0, 1)}),
        (make.sign_chain, x**2 - r, x, ((-oo, 1), (0, -1), (1, 1)), {r: (0, 1)}),
        (make.sign_chain, x**3 - 3 * x + 1, x, ((-oo, -1), (0, 1), (1, -1), (2, 1)), {r: (0, 1)}),
        (make.sign_chain, x**3 + x - r, x, ((0, -1), (1, 1)), {r: (0, 1)}),
        (make.value_at, (x**2 - y**2) / (x - y), x, 3), (make.value_at, y / (x - 1), x, 1),
        (make.value_at, (3 * x**2 - y) / (2 * x**2 + 1), x, oo), (make.value_at, x / (x**2 + y), x, -oo),
        (make.value_at, x**3 / (x + y), x, oo), (make.value_at, (x - 1) / (x + y), x, 1),
        (make.definite, -(6 * x**2) - 4 * x * y - y**2, x, y), (make.definite, x**2 + x * y + y**2, x, y),
        (make.left_behind, quotients([[[2, 0], 1], [[0, 2], -1]], [[[1, 0], 1], [[0, 1], -1]])),
        (make.left_behind, quotients([[[2, 0], 2], [[0, 2], -2]], [[[1, 0], 2], [[0, 1], -2]])),
        (make.identical, sympy.sqrt(x / (1 + y)) ** 3, x / (1 + y) * sympy.sqrt(x / (1 + y))),
        (make.identical, y / (1 + sympy.sqrt(x + y)), y * (1 - sympy.sqrt(x + y)) / (1 - x - y)),
    ]  # fmt: skip
    with make.collected() as found:
        for call, *arguments in calls:
            call(*arguments)
    return [{key: part for key, part in each.items() if key != "says"} for each in json.loads(json.dumps(found))]


def paths(data, path=()):
    """Every place of a certificate, inner ones too."""
    if path and path[0] in ("kind", "variables"):
        return
    if path:
        yield path
    if isinstance(data, dict | list):
        for key, part in data.items() if isinstance(data, dict) else enumerate(data):
            yield from paths(part, (*path, key))


def damaged(rng, given, pool):
    """A certificate with one to three places changed; sometimes both sides of its proof alike."""
    data = copy.deepcopy(given)
    for _ in range(rng.choice((1, 1, 2, 3))):
        places = list(paths(data))
        place = rng.choice(places)
        holder = data
        for step in place[:-1]:
            holder = holder[step]
        key = place[-1]
        change = rng.randrange(8)
        other = rng.choice([path for path in places if path[:-1] == place[:-1]])[-1]
        if change == 0:
            holder[key], holder[other] = holder[other], holder[key]
        elif change == 1 and isinstance(holder, list):
            del holder[key]
        elif change == 2 and isinstance(holder, list):
            holder.insert(key, copy.deepcopy(holder[key]))
        elif change == 3:
            holder[key] = copy.deepcopy(holder[other])
        elif change == 4:
            donor = rng.choice([each for each in pool if each["kind"] == given["kind"]])
            if key in donor:
                holder[key] = copy.deepcopy(donor[key])
        elif change == 5:
            holder[key] = _negated(holder[key])
        else:
            holder[key] = rng.choice(NUMBERS) if not isinstance(holder[key], list) else []
    return data


def _negated(part):
    """Numbers and texts of numbers turned round, the coefficients of a polynomial too."""
    if isinstance(part, list):
        return [_negated(each) for each in part]
    if isinstance(part, bool) or part is None:
        return part
    if isinstance(part, int):
        return -part
    if isinstance(part, str):
        return part[1:] if part.startswith("-") else f"-{part}"
    return part


# ---- what is true, by other means ----


def _poly(data, point):
    total = Fraction(0)
    for key, value in data:
        part = Fraction(value)
        for base, power in zip(point, key, strict=True):
            part *= Fraction(base) ** power
        total += part
    return total


def _between(low, high, part):
    if low in ("oo", "-oo") and high in ("oo", "-oo"):
        return (part - Fraction(1, 2)) * 40
    if high == "oo":
        return Fraction(low) + part / (1 - part)
    if low == "-oo":
        return Fraction(high) - part / (1 - part)
    return Fraction(low) + (Fraction(high) - Fraction(low)) * part


def _points(box, rng, count):
    for _ in range(count):
        yield [_between(low, high, Fraction(rng.randint(1, 255), 256)) for low, high in box]


def _ordered(low, high):
    ends = [-(10**9) if end == "-oo" else 10**9 if end == "oo" else Fraction(end) for end in (low, high)]
    return ends[0] < ends[1]


def _real_roots(coefficients, low, high):
    """The number of different real roots in the open interval, by flint's isolation of the squarefree part."""
    import flint

    poly = flint.fmpq_poly([flint.fmpq(Fraction(c).numerator, Fraction(c).denominator) for c in coefficients])
    total = 0
    _, factors = poly.factor()
    for factor, _ in factors:
        if factor.degree() == 1:
            root = -factor[0] / factor[1]
            place = Fraction(int(root.p), int(root.q))
            total += (low == "-oo" or place > Fraction(low)) and (high == "oo" or place < Fraction(high))
            continue
        for root, _ in flint.fmpz_poly([int(c * factor.denom()) for c in factor.coeffs()]).complex_roots():
            if root.imag == 0:  # no rational number is a root of such a factor: a ball tells the side
                at = float(root.real.mid())
                total += (low == "-oo" or at > float(Fraction(low))) and (high == "oo" or at < float(Fraction(high)))
    return total


def true(data, rng):
    """Whether what a certificate states holds; what cannot be read at all states nothing that holds."""
    try:
        return _TRUE[data["kind"]](data, rng)
    except (TypeError, ValueError, ZeroDivisionError, IndexError, KeyError, OverflowError):
        return False


def _true_positive(data, rng):
    if not all(_ordered(*ends) for ends in data["box"]):
        return False
    for point in _points(data["box"], rng, 24):
        below = _poly(data["denominator"], point)
        if not below or not _poly(data["numerator"], point) / below * data["sign"] > 0:
            return False
    return True


def _true_chain(data, rng):
    for point in _points(data["box"], rng, 6):
        fixed = {}
        for key, value in data["polynomial"]:
            fixed[key[0]] = fixed.get(key[0], 0) + _poly([[key[1:], value]], point)
        coefficients = [fixed.get(n, Fraction(0)) for n in range(max(fixed, default=0) + 1)]
        inside = [_ordered(*gap) and _real_roots(coefficients, *gap) for gap in data["roots"]]
        if not all(inside) or (data["all"] and sum(inside) != _real_roots(coefficients, "-oo", "oo")):
            return False
        if any(_ordered(a[0], b[1]) and _ordered(b[0], a[1]) for n, a in enumerate(data["roots"])
               for b in data["roots"][:n]):  # fmt: skip
            return False  # gaps that overlap do not tell roots apart
    return True


def _true_value(data, rng):
    size, index = len(data["variables"]), data["index"]
    far = {"oo": Fraction(10**12), "-oo": -Fraction(10**12)}
    for _ in range(4):
        point = [rng.choice((-1, 1)) * (1 + Fraction(rng.randint(1, 99), 64)) for _ in range(size)]
        point[index] = far[data["at"]] if data["at"] in far else Fraction(data["at"]) + Fraction(1, 10**12)
        below = _poly(data["denominator"], point)
        if not below:
            return False
        found = _poly(data["numerator"], point) / below
        if data["value"] == "infinite":
            if abs(found) < 10**3:
                return False
            continue
        above, under = (_poly(part, point) for part in data["value"])
        if not under or abs(found - above / under) > Fraction(1, 10**6) * (1 + abs(found)):
            return False
    return True


def _true_definite(data, rng):
    a, b, c = (Fraction(value) * data["sign"] for value in data["form"])
    directions = [(1, 0), (0, 1), (-b, 2 * a), (2 * c, -b)]
    directions += [(Fraction(rng.randint(-50, 50)), Fraction(rng.randint(-50, 50))) for _ in range(12)]
    return all(a * p * p + b * p * q + c * q * q > 0 for p, q in directions if p or q)


def _true_identity(data, rng):
    import cmath

    size = len(data["variables"])
    for _ in range(6):
        # no two coordinates alike: a quotient that is not cancelled has no value where they are
        point = [Fraction(rng.randint(-99, 99), 64) + Fraction(1, 1009 + 2 * n) for n in range(size)]
        if data["relation"] is None:
            values = [point]
        else:
            relation = [[key, value] for key, value in data["relation"][2] if Fraction(value)]
            powers = [complex(sum(_poly([[[*key[:-1], 0], value]], point) for key, value in relation if key[-1] == n))
                      for n in range(3)]  # fmt: skip
            if not powers[2] or max(key[-1] for key, _ in relation) != 2:
                return False
            root = cmath.sqrt(powers[1] ** 2 - 4 * powers[0] * powers[2])
            values = [[*point[:-1], (-powers[1] + sign * root) / (2 * powers[2])] for sign in (1, -1)]
        for at in values:
            (above, below), (other, under) = ([_complex(part, at) for part in data[side]] for side in ("left", "right"))
            if not abs(below) > 1e-9 or not abs(under) > 1e-9:
                return False
            if abs(above / below - other / under) > 1e-6 * (1 + abs(above / below)):
                return False
    return True


def _complex(data, point):
    total = 0j
    for key, value in data:
        part = complex(Fraction(value))
        for base, power in zip(point, key, strict=True):
            part *= complex(base) ** power
        total += part
    return total


_TRUE = {
    "positive": _true_positive,
    "chain": _true_chain,
    "value": _true_value,
    "definite": _true_definite,
    "identity": _true_identity,
}


def fuzzed(count, seed, checker=None):
    """(how many were accepted of each kind, the false ones that were accepted)."""
    from false_certificates import IN_DATA, WEAKENED, accepts

    checker = accepts if checker is None else checker
    rng = random.Random(seed)
    pool = seeds()
    assert {each["kind"] for each in pool} == set(KINDS)
    starts = pool * 2 + [row[2] for row in (*WEAKENED.values(), *IN_DATA.values()) if "says" not in row[2]]
    told, wrong = Counter(), []
    for _ in range(count):
        certificate = damaged(rng, rng.choice(starts), pool)
        if checker(certificate):
            told[certificate["kind"]] += 1
            if not true(certificate, rng):
                wrong.append(certificate)
    return told, wrong


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--certificates", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    told, wrong = fuzzed(options.certificates, options.seed)
    for certificate in wrong[:20]:
        print(json.dumps(certificate))
    print(f"{options.certificates} damaged certificates, seed {options.seed}: {sum(told.values())} still true and "
          f"accepted ({dict(sorted(told.items()))}), {len(wrong)} false and accepted")  # fmt: skip
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
