"""Forge certificates of every kind: `python tests/tool/fuzzing/forgeries.py --forgeries 100000 --seed 1`.

Each forgery is a certificate of `tests/tool/certificates/examples` with something changed and its digest made anew: a field
of another type, one more, one less, a number moved, a radius, a list reversed, cut or doubled, a word of another kind.
Prints those that are accepted and false, those that end otherwise than in a refusal of one line, and those that take
more than 10 s of CPU; exits with 1 when there is one.

A change may leave a statement true.  An accepted one is no fault when each of its changes is one of these:

    a ball that contains the true number, which is known to more digits than the certificate has;
    a weaker bound, a shorter interval, or something that is no longer said;
    data of the proof, which the statement does not mention and which the second program checks anew;
    a number of the model that the statement does not depend on.
"""

from __future__ import annotations

import argparse
import copy
import json
import multiprocessing
import sys
import time
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from fractions import Fraction
from pathlib import Path
from random import Random
from typing import Any

sys.path[:0] = [str(Path(__file__).parents[3])]

from singimpact.certificates import checker  # noqa: E402

FOLDER = Path(__file__).parents[1] / "certificates" / "examples"
SLOW = 10.0  # CPU seconds
PORTION = 250
OTHERS: tuple[Any, ...] = (
    None, True, [], {}, [[]], "", " ", "0", "-1", "1e9999999999", "1e999999999", "9" * 5000, "nan", "inf", "Infinity",
    "1/0", "0/1", "-0", "1e-99999", "x", "t", "v", "\u0663", "1_000", "0x10", "-" * 3000 + "1", "(" * 500 + "1" + ")" * 500,
    "__import__('os')", "lambda: 0", "1 if 1 else 2", "cos", "1;2", "\n1", ["1"], {"value": "1", "radius": "1"},
    {"value": "0", "radius": "9"}, [["1"] * 3] * 3, "2**2**2**2**2**9", "log(-1)", "1/(1-1)", "exp(exp(exp(exp(9))))",
)  # fmt: skip
WORDS = ("first impact", "periodic orbit", "chatter limit", "horseshoe", "horseshoes", "event", "border orbit", "invariant arc",
         "fold", "period-doubling", "torus", "graze", "hidden impact", "accumulation", "lift-off", "above", "below", "model")  # fmt: skip
DEAR = {"torus": 0.005, "fold": 0.01, "doubling": 0.01, "border": 0.015, "gamma_at_swan": 0.015, "hidden": 0.03}
USUAL = 0.03
"""Shares of the forgeries in which a number moves: the second program has to enclose the motion again."""


def examples() -> dict[str, tuple[Any, Any]]:
    """name -> a certificate, and the same statement with more digits."""
    found = {}
    for path in sorted(FOLDER.glob("*.json")):
        if not path.name.endswith(".true.json"):
            true = path.with_name(f"{path.stem}.true.json")
            found[path.stem] = tuple(
                json.loads(each.read_text(encoding="utf-8")) for each in (path, true if true.exists() else path)
            )
    return found


EXAMPLES = examples()


def places(content: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """All fields, those in lists too."""
    for key, part in content.items() if isinstance(content, dict) else enumerate(content):
        if path or key != "digest":
            yield (*path, key)
            if isinstance(part, dict | list):
                yield from places(part, (*path, key))


def at(content: Any, path: tuple[Any, ...]) -> Any:
    for key in path:
        content = content[key]
    return content


def is_number(value: Any) -> bool:
    try:
        return isinstance(value, str) and Fraction(value) is not None
    except (ValueError, ZeroDivisionError):
        return False


def forgery(seed: int, n: int) -> tuple[str, Any]:
    """The name of an example, and a forgery of it."""
    rng = Random(f"{seed} {n}")
    name = list(EXAMPLES)[n % len(EXAMPLES)]
    content = copy.deepcopy(EXAMPLES[name][0])
    deep = rng.random() < DEAR.get(name, USUAL)
    for _ in range(1 if rng.random() < 0.8 else 2):
        path = rng.choice(list(places(content)))
        (moved if deep else other_form)(content, path, rng)
    return name, {**content, "digest": checker.digest_of(content)}


def other_form(content: Any, path: tuple[Any, ...], rng: Random) -> None:
    """A field of another type, one less, one more, or another word."""
    owner, key, choice = at(content, path[:-1]), path[-1], rng.random()
    if choice < 0.7:
        owner[key] = copy.deepcopy(rng.choice(OTHERS))
    elif choice < 0.8:
        del owner[key]
    elif choice < 0.9 and isinstance(owner, dict):
        owner[rng.choice(("proves", "unique_within", "after", "note", key + "_"))] = rng.choice(("10", "anything"))
    else:
        owner[key] = rng.choice(WORDS)


def moved(content: Any, path: tuple[Any, ...], rng: Random) -> None:
    """Another number, or a list in another order."""
    owner, key = at(content, path[:-1]), path[-1]
    value = owner[key]
    if is_number(value):
        exact = Fraction(value)
        radius = (
            Fraction(owner["radius"])
            if key == "value" and is_number(owner.get("radius"))
            else abs(exact) or Fraction(1)
        )
        factor = (
            rng.choice((10, 1000, 10**6)) if key == "value" else Fraction(rng.choice((1, 3, -2))) / rng.choice((2, 50))
        )
        change = {"move": exact + rng.choice((-1, 1)) * factor * radius, "minus": -exact, "tenfold": 10 * exact,
                  "tenth": exact / 10, "small": exact / 10**9, "next": exact + 1, "last": exact - 1}  # fmt: skip
        number = rng.choice(list(change.values()))
        owner[key] = str(number) if number.denominator == 1 or key in ("tau", "v") else repr(float(number))
    elif isinstance(value, list) and value:
        half = len(value) // 2
        owner[key] = rng.choice((value[::-1], value[:-1], value * 2, value[half:] + value[:half], []))
    elif isinstance(value, str):
        owner[key] = rng.choice((value + " + 1/1000", f"-({value})", value[: len(value) // 2], value * 2, value[::-1]))
    elif isinstance(value, dict) and value:
        del value[rng.choice(list(value))]


PROOF = {"eta", "M", "pieces", "D", "tree", "R", "impacts", "frame", "centre", "radii", "first"}
"""Fields of a proof, wherever they stand: the second program shows the statement with them, or refuses."""
SMALLER, LARGER = {"grow", "fastest", "near", "time", "launch", "speed", "reach", "unique_within"}, {"end"}
"""Numbers that make a weaker statement when they are smaller, or larger."""
PI = Fraction("3.14159265358979323846264338327950288419716939937510582")
SHOWN = Fraction(1, 2)  # the bounds Kl that the numbers of the examples show are at least this part of those written
ALONE = Fraction(1, 100)  # the orbits of the examples have no others of so many impacts and periods so near
SAME = Fraction(1, 2**30)  # the zero of a_c beside a time is the same for times so near


def still_true(name: str, forged: Any) -> bool:
    """Whether an accepted forgery says what the certificate does, or less."""
    content, true = EXAMPLES[name]
    return not list(false_changes(content, true, forged, content, ()))


def false_changes(old: Any, true: Any, new: Any, whole: Any, path: tuple[Any, ...]) -> Iterator[tuple[Any, ...]]:
    """The places of changes that may make it false."""
    if old == new or (
        path
        and (
            path[-1] == "digest" or path[-1] in PROOF or unused(path, Fraction(new) if is_number(new) else None, whole)
        )
    ):
        return
    if path[-1:] in (("after",), ("multipliers",)) and not new:
        return
    # an orbit with impacts that touches at rest is a graze too: the sentence says how many impacts there are
    if path == ("kind",) and (old, new) == ("hidden impact", "graze"):
        return
    if path == ("model", "parameters") and isinstance(new, dict):  # the value of the number that is varied has no use
        old, new = ({name: part for name, part in each.items() if name != whole.get("over")} for each in (old, new))
    # an impact at the lower wall does not depend on what the upper one gives back
    if path == ("model",) and isinstance(new, dict) and str(whole.get("velocity", {}).get("value")).startswith("-"):
        old, new = ({name: part for name, part in each.items() if name != "upper_restitution"} for each in (old, new))
    if isinstance(old, dict) and isinstance(new, dict) and set(old) == set(new):
        if set(old) == {"value", "radius"}:
            value, radius = (Fraction(new[part]) for part in ("value", "radius"))
            if path == ("tau",) and whole["statement"] == "invariant arc":  # g has the period pi, and so has gamma
                value += round((Fraction(true["value"]) - value) / PI) * PI
            # about the swan at pi the forcing cos(2t) is even, about 2 pi sin(t) is odd: every second coefficient is 0
            even = whole.get("order") == "2" or whole["model"]["g"] == "sin(t)"
            zero = even and path[-2:-1] == ("series",) and path[-1] % 2 == 1
            zero |= path[-1] == "v" and whole.get("kind") == "graze"  # the velocity of an orbit that touches at rest
            zero |= path[-1] == "imaginary" and distinct(whole)
            middle, spread = (Fraction(0 if zero else true[part]) for part in ("value", "radius"))
            if not abs(middle - value) + spread <= radius:
                yield path
            return
        for key in old:
            yield from false_changes(old[key], true[key], new[key], whole, (*path, key))
    elif isinstance(old, list) and isinstance(new, list) and len(old) == len(new):
        if path[-1] in ("lambda", "restitution"):
            low, high = (Fraction(part) for part in new)
            if not Fraction(old[0]) <= low <= high <= Fraction(old[1]):
                yield path
            return
        for n, (one, exact, other) in enumerate(zip(old, true, new, strict=True)):
            yield from false_changes(one, exact, other, whole, (*path, n))
    elif not (is_number(old) and is_number(new) and weaker(path, Fraction(old), Fraction(new), whole)):
        yield path


def distinct(whole: Any) -> bool:
    """Whether the multipliers have different real parts: they are no conjugate pair then, so both are real."""
    (one, some), (other, more) = (
        (Fraction(each["real"]["value"]), Fraction(each["real"]["radius"])) for each in whole["multipliers"]
    )
    return abs(one - other) > some + more


def weaker(path: tuple[Any, ...], old: Fraction, new: Fraction, whole: Any) -> bool:
    if path[-1] in ("release", "end") and "release" in whole:
        return abs(old - new) < SAME
    if path[-1] == "unique_within":
        return new <= ALONE
    if path[-1] == "Kl":
        return new >= SHOWN * old
    if path[0] == "reach" and "threshold" in whole:  # gamma is as high as is written at the reach
        return new == old
    smaller, larger = path[-1] in SMALLER, path[-1] in LARGER
    return old == new or (smaller and 0 < new <= old) or (larger and new >= old)


def unused(path: tuple[Any, ...], number: Any, whole: Any) -> bool:
    """Whether a statement does not depend on a number of its model."""
    if path == ("model", "period") or (path[:2] == ("model", "parameters") and path[2:] == (whole.get("over"),)):
        return True
    rates = [("model", "parameters", name) for name in ("omega", "w")]
    if path in rates and number is not None and abs(number) == Fraction(at(whole, path)):
        return True  # g = cos(omega*t)
    impacts = whole.get("kind") != "graze" or len(whole["states"]) > 1
    return path == ("model", "restitution") and (not impacts or isinstance(whole.get("restitution"), list))


def judged(seed: int, n: int) -> tuple[str, float]:
    """refused, true, or what is wrong; and CPU seconds."""
    name, forged = forgery(seed, n)
    start = time.process_time()
    try:
        checker.check(forged)
        answer = "true" if still_true(name, forged) else "accepted"
    except checker.Refused as reason:
        answer = "refused" if str(reason) and "\n" not in str(reason) and len(str(reason)) < 500 else "several lines"
    except BaseException as error:  # whatever it is, it is a fault
        answer = f"traceback {type(error).__name__}"
    spent = time.process_time() - start
    return ("slow" if spent > SLOW else answer), spent


def portion(seed: int, numbers: range) -> list[tuple[int, str, float]]:
    return [(n, *judged(seed, n)) for n in numbers]


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--forgeries", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--show", type=int, metavar="NUMBER", help="Print one forgery again.")
    options = parser.parse_args()
    if options.show is not None:
        print(json.dumps(forgery(options.seed, options.show)[1], indent=1))
        return 0
    parts = [range(k, min(k + PORTION, options.forgeries)) for k in range(0, options.forgeries, PORTION)]
    answers, longest, spent, faults = Counter[str](), (0.0, 0), 0.0, 0
    with ProcessPoolExecutor(options.workers, mp_context=multiprocessing.get_context("spawn")) as pool:
        for k, done in enumerate(pool.map(portion, [options.seed] * len(parts), parts)):
            if k % 8 == 0:
                print(f"{k * PORTION} forgeries: {dict(answers)}", file=sys.stderr, flush=True)
            for n, answer, seconds in done:
                answers[answer] += 1
                longest, spent = max(longest, (seconds, n)), spent + seconds
                if answer not in ("refused", "true"):
                    faults += 1
                    print(f"{n}: {answer}, {seconds:.1f} s, of {forgery(options.seed, n)[0]}", flush=True)
    print(f"{options.forgeries} forgeries, seed {options.seed}, {spent:.0f} s of CPU, the longest {longest[0]:.1f} s "
          f"(number {longest[1]}): {dict(answers)}")  # fmt: skip
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
