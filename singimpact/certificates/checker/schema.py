"""The form of a certificate: the keys, types and ranges of all that a file may say, before anything is built from it.

A form is a function that refuses a value; a dictionary of forms, whose keys are the keys of the value, those that end
in "?" may be missing; or a list [form, least, most] of values of one form.
"""

import json
import re
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

from .formulas import FUNCTIONS, Refused, Wrong, need

SCHEMA = "singimpact certificate 1"
BYTES = 2_000_000  # of a file
CHARACTERS, BRACKETS = 10_000, 64  # of a formula: its length and its depth
DIGITS, EXPONENT = 4_000, 3_000  # of a number: characters, and the largest power of ten
ROUGH = 20  # a radius is at most this part of a number
NUMBER = re.compile(r"-?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d{1,4})?(/0*[1-9]\d*)?", re.ASCII)
WHOLE = re.compile(r"\d{1,6}", re.ASCII)
FORMULA = re.compile(r"[\w.+\-*/() ]+", re.ASCII)
SIGNS = re.compile(r"(?:[-+*/]\s*){8}")  # so many in a row
EXPONENTS = re.compile(r"(?<!\w)([\d.]+)[eE]([-+]?\d+)", re.ASCII)
NAME = re.compile(r"[A-Za-z_]\w{0,60}", re.ASCII)
DIGEST_TEXT = re.compile(r"[0-9a-f]{64}")
RESERVED = {"x", "xdot", "t", "v", "pi", *FUNCTIONS}
CURVED, TOUCHING = ("fold", "period-doubling", "torus"), ("graze", "hidden impact")
KINDS = (*CURVED, *TOUCHING)

Form = Any  # a function, a dictionary of forms, or [form, least, most]


def expect(holds: Any, why: str) -> None:
    """Refuse what has not the form of a certificate; a condition on its truth has a name: see `need`."""
    if not holds:
        raise Wrong(why)


def read(path: str) -> Any:
    """The content of a file: JSON whose objects have each key once, without numbers that JSON does not have."""
    expect(not Path(path).exists() or Path(path).is_file(), "it is no file")
    with Path(path).open("rb") as file:
        data = file.read(BYTES + 1)
    expect(len(data) <= BYTES, f"the file has more than {BYTES} bytes")
    try:
        return json.loads(
            data.decode("utf-8"),
            parse_constant=refuse_number,
            parse_int=refuse_number,
            parse_float=refuse_number,
            object_pairs_hook=once,
        )
    except UnicodeDecodeError:
        raise Refused("it is not text in UTF-8") from None
    except RecursionError:
        raise Refused("its lists are too deep") from None
    except json.JSONDecodeError as error:
        raise Refused(f"{error}: not JSON") from None


def refuse_number(text: str) -> Any:
    raise Refused(f"not JSON as certificates have it: the number {text[:20]} is no text")


def once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    expect(len({name for name, _ in pairs}) == len(pairs), "a key occurs twice")
    return dict(pairs)


def require(form: Form, value: Any, where: str = "the file") -> None:
    """Refuse a value that has not the form."""
    if isinstance(form, dict):
        expect(isinstance(value, dict), f"{where} is no record of names and values")
        names = {name.rstrip("?") for name in form}
        unknown, missing = set(value) - names, {name for name in form if not name.endswith("?")} - set(value)
        need("unknown", not unknown, f"{where} has the unknown field {min(unknown, default='')!r:.60}")
        expect(not missing, f"{where} has no {min(missing, default='')!r}")
        for name, entry in form.items():
            if name.rstrip("?") in value:
                require(entry, value[name.rstrip("?")], f"{where}.{name.rstrip('?')}".removeprefix("the file."))
    elif isinstance(form, list):
        inner, least, most = form
        expect(isinstance(value, list), f"{where} is no list")
        expect(least <= len(value) <= most, f"{where} has {len(value)} entries: {least} to {most} are accepted")
        for n, entry in enumerate(value):
            require(inner, entry, f"{where}[{n}]")
    else:
        form(value, where)


def text(value: Any, where: str, pattern: re.Pattern[str] = FORMULA, most: int = CHARACTERS) -> None:
    expect(isinstance(value, str), f"{where} is no text")
    expect(0 < len(value) <= most, f"{where} has {len(value)} characters: 1 to {most} are accepted")
    expect(pattern.fullmatch(value), f"{where} = {value!r:.60} is not understood")


def formula(value: Any, where: str) -> None:
    """A formula, whose brackets and signs are not too deep to be read, and whose numbers are not too long."""
    text(value, where)
    depth = deepest = 0
    for sign in value:
        depth += (sign == "(") - (sign == ")")
        deepest = max(deepest, depth)
    expect(deepest <= BRACKETS and not SIGNS.search(value), f"{where} has more than {BRACKETS} brackets in one another")
    powers = [power for _, power in EXPONENTS.findall(value)]
    expect(not any(len(power) > 5 for power in powers), f"{where} has a number that is too long")
    expect(sum(abs(int(power)) for power in powers) <= EXPONENT, f"{where} has exponents beyond {EXPONENT}")


def number(low: Any = None, high: Any = None, *, least: Any = None) -> Callable[[Any, str], None]:
    """A decimal or a fraction; low < it < high, or least <= it."""

    def form(value: Any, where: str) -> None:
        text(value, where, NUMBER, DIGITS)
        power = re.search(r"[eE]([-+]?\d+)", value)
        expect(not power or abs(int(power[1])) <= EXPONENT, f"{where} has an exponent beyond {EXPONENT}")
        need("above", low is None or Fraction(value) > low, f"{where} = {value:.40} is not above {low}")
        expect(high is None or Fraction(value) < high, f"{where} = {value:.40} is not below {high}")
        expect(least is None or Fraction(value) >= least, f"{where} = {value:.40} is less than {least}")

    return form


def whole(least: int, most: int) -> Callable[[Any, str], None]:
    def form(value: Any, where: str) -> None:
        text(value, where, WHOLE, 6)
        expect(least <= int(value) <= most, f"{where} = {value}: {least} to {most} are accepted")

    return form


def one_of(*words: str) -> Callable[[Any, str], None]:
    def form(value: Any, where: str) -> None:
        expect(isinstance(value, str) and value in words, f"{where} is not {' or '.join(words)}")

    return form


def ball(sign: int = 0) -> Callable[[Any, str], None]:
    """A number with its radius; with a sign, all numbers of the ball have it."""

    def form(written: Any, where: str) -> None:
        require({"value": number(), "radius": number(low=0)}, written, where)
        value, radius = Fraction(written["value"]), Fraction(written["radius"])
        size = sign * value if sign else max(abs(value), Fraction(1))
        need(
            "rough", radius * ROUGH <= size, f"{where} = {written['value']:.40} has the radius {written['radius']:.40}"
        )

    return form


def interval(low: Any, high: Any) -> Callable[[Any, str], None]:
    def form(value: Any, where: str) -> None:
        require([number(low, high), 2, 2], value, where)
        need("reversed", Fraction(value[0]) < Fraction(value[1]), f"{where} is reversed")

    return form


def name(value: Any, where: str) -> None:
    text(value, where, NAME)


def digest(value: Any, where: str) -> None:
    text(value, where, DIGEST_TEXT, 64)


def touching(content: dict[str, Any]) -> Form:
    """Of an orbit that touches the wall in its first state; a hidden impact is one between impacts."""

    def form(states: Any, where: str) -> None:
        expect(isinstance(states, list) and states, f"{where} has no state")
        require(TOUCH, states[0], f"{where}[0]")
        require([STATE, int(content["kind"] == "hidden impact"), 999], states[1:], f"{where} after the first")

    return form


def at_wall(content: dict[str, Any]) -> dict[str, Form]:
    """The wall of a state, of a model with two."""
    return {"wall": WALL} if isinstance(content.get("model"), dict) and "upper" in content["model"] else {}


def after(content: dict[str, Any]) -> Form:
    """Keys and types of the statement after a contact point; none where a certificate names the fastest launch."""
    names = (
        ("near", "time") if str(content.get("order"))[-1:] in tuple("13579") else ("launch", "speed", "first", "end")
    )
    return dict.fromkeys(names if content.get("after") and "fastest" not in content else (), SIZE)


def parameters(value: Any, where: str) -> None:
    expect(isinstance(value, dict) and len(value) <= 40, f"{where} is no record of at most 40 names")
    for name, part in value.items():
        text(name, f"a name in {where}", NAME)
        expect(name not in RESERVED, f"{where} has the name {name}")
        formula(part, f"{where}.{name}")


STATE = {"tau": ball(), "v": ball(1)}
TOUCH = {"tau": ball(), "v": {"value": one_of("0"), "radius": number(low=0)}}
SIZE = number(low=0, high=10**9)
MODEL = {
    "f": formula,
    "g": formula,
    "clearance": formula,
    "restitution": formula,
    "parameters?": parameters,
    "period?": formula,
    "upper?": formula,
    "upper_restitution?": formula,
}
WALL = one_of("lower", "upper")
PAIR, LOOPS = [number(), 2, 2], [whole(1, 1000), 2, 2]
SET = {"centre": PAIR, "frame": [PAIR, 2, 2], "radii": [SIZE, 2, 2]}
LAUNCH = {"tau": formula, "v": formula}
ORBIT = {"period": formula, "periods": whole(1, 1000)}
EVENT = {"kind": one_of(*KINDS), "over": name, "parameter": ball(), **ORBIT}
BOX = {
    "lambda": interval(0, 1),
    "N": whole(2, 200),
    "D": whole(3, 400),
    "pieces": whole(1, 20_000),
    "eta": SIZE,
    "M": SIZE,
    "R": number(least=0),
    "Kl": number(least=0),
    "grow": number(low=1),
    "series": [ball(), 2, 200],
    "tree": lambda value, where: text(value, where, re.compile("[Sl.]+"), 10**6),
}
# What the file of each statement says beside its schema, statement, model and digest.
STATEMENTS: dict[str, Callable[[dict[str, Any]], Form]] = {
    "first impact": lambda content: {
        "launch": LAUNCH | at_wall(content),
        "flight_time": ball(1),
        "velocity": ball() if at_wall(content) else ball(-1),
        "tau": ball(),
        "v": ball(1),
    },
    "periodic orbit": lambda content: {
        **ORBIT,
        "states": [STATE | at_wall(content), 1, 1000],
        "unique_within": number(0, 1),
        "multipliers": [{"real": ball(), "imaginary": ball()}, 0, 2],
    },
    "chatter limit": lambda _: {"launch": LAUNCH, "ends": one_of("accumulation", "lift-off"), "tau": ball()},
    "horseshoe": lambda _: {
        "period": formula,
        "loops": LOOPS,
        "entropy": ball(1),
        "sets": [SET, 2, 1000],
    },
    "horseshoes": lambda _: {
        "over": name,
        "between": [number(), 2, 2],
        "period": formula,
        "entropy": ball(1),
        "pieces": [
            {"number": number(), "reach": SIZE, "loops": LOOPS, "sets": [SET | {"drift": PAIR}, 2, 1000]},
            1,
            10_000,
        ],
    },
    "event": lambda content: (
        EVENT
        | (
            {"states": touching(content), "unique_within": number(0, 1)}
            if content.get("kind") in TOUCHING
            else {"states": [STATE | at_wall(content), 1, 1000]}
        )
    ),
    "border orbit": lambda _: {
        "over": name,
        "parameter": ball(),
        "release": number(),
        "end": number(),
        "impacts": whole(1, 10_000),
        "completes": one_of("above", "below"),
    },
    "invariant arc": lambda content: {
        "order": whole(1, 12),
        "tau": ball(),
        "reach": SIZE,
        "after": after(content),
        "boxes": [BOX, 1, 2000],
        **({"fastest": SIZE} if "fastest" in content else {}),
        **(
            {"restitution": one_of("model"), "threshold": ball(1)}
            if content.get("restitution") == "model"
            else {"restitution": interval(0, 1)}
        ),
    },
}


IN_TIME = ("first impact", "periodic orbit", "chatter limit")  # statements that may be on a model in whose f t occurs
BETWEEN = ("first impact", "periodic orbit", "event")  # statements that may be on a model with two walls


def require_statement(content: Any) -> None:
    """Refuse a file that is none of these statements."""
    only = f"only certificates {SCHEMA!r} of these are checked here: {', '.join(STATEMENTS)}"
    expect(isinstance(content, dict) and content.get("schema") == SCHEMA, only)
    expect(isinstance(content.get("statement"), str) and content["statement"] in STATEMENTS, only)


def require_form(content: dict[str, Any]) -> None:
    """Refuse a file that is not of the form of its statement."""
    head = {"schema": one_of(SCHEMA), "statement": one_of(*STATEMENTS), "model": MODEL, "digest": digest}
    require(head | STATEMENTS[content["statement"]](content), content)
    model = content["model"]
    parts = ("f", "g", "clearance", "restitution", "upper", "upper_restitution")
    used = re.findall(r"[A-Za-z_]\w*", " ".join(model.get(key, "") for key in parts))
    unused = set(model.get("parameters", ())) - set(used)
    expect(not unused, f"model has the parameter {min(unused, default='')!r}, which it does not use")
    moving = re.search(r"\bt\b", model["f"]) is not None and content["statement"] not in IN_TIME
    walls = "upper" not in model or (content["statement"] in BETWEEN and content.get("kind") not in TOUCHING)
    expect(walls, f"of a model with two walls only {', '.join(BETWEEN)} without a graze are checked here")
    expect(not moving, f"f = {model['f']} depends on t: of such a model only {', '.join(IN_TIME)} are checked here")


# The sentence of a certificate, as the programs print it: every number with its radius, a bound at its outer end.


def with_radius(written: dict[str, str]) -> str:
    """A number with its radius."""
    return f"{written['value']} +- {written['radius']}"


def below(written: dict[str, str], digits: int = 12) -> str:
    """A decimal that is no larger than any number of a ball."""
    least = (Fraction(written["value"]) - Fraction(written["radius"])) * 10**digits // 1
    return f"{least // 10**digits}.{least % 10**digits:0{digits}d}"


def sentence(content: dict[str, Any]) -> str:
    """The statement of a certificate as a sentence."""
    return SENTENCES[content["statement"]](content)


def states(content: dict[str, Any]) -> str:
    shown = ", ".join(f"({with_radius(each['tau'])}, {with_radius(each['v'])})" for each in content["states"])
    return f"(tau, v) = {shown}"


def launch(content: dict[str, Any]) -> str:
    wall = f" at the {content['launch']['wall']} wall" if "wall" in content["launch"] else ""
    return f"({content['launch']['tau']}, {content['launch']['v']}){wall}"


def impacts(content: dict[str, Any]) -> str:
    """The number of impacts, or between two walls their word."""
    return "".join(state.get("wall", "")[:1] for state in content["states"]) or str(len(content["states"]))


def event(content: dict[str, Any]) -> str:
    """The impacts of an orbit that touches the wall do not count the touch."""
    impacts = len(content["states"]) - ("unique_within" in content)
    alone = f", alone within {content['unique_within']}" if "unique_within" in content else ""
    number_of = f"{content['over']} = {with_radius(content['parameter'])}"
    return f"a {content['kind']}: {number_of}, of an orbit of {impacts} impacts in {content['periods']} periods{alone}"


def invariant_arc(content: dict[str, Any]) -> str:
    model = content["restitution"] == "model"
    which = f"r = {content['model']['restitution']}" if model else f"all r in {content['restitution']}"
    return f"gamma before tau_* = {with_radius(content['tau'])}: {which}, S <= {content['reach']}"


SENTENCES: dict[str, Callable[[dict[str, Any]], str]] = {
    "first impact": lambda content: (
        f"the first impact from {launch(content)}: tau = {with_radius(content['tau'])}, v = {with_radius(content['v'])}"
    ),
    "periodic orbit": lambda content: (
        f"the ({impacts(content)}, {content['periods']}) periodic orbit, alone within "
        f"{content['unique_within']}: {states(content)}"
    ),
    "chatter limit": lambda content: (
        f"the chatter limit from {launch(content)}: {content['ends']} at tau = {with_radius(content['tau'])}"
    ),
    "horseshoe": lambda content: (
        f"a horseshoe: loops of {content['loops'][0]} and {content['loops'][1]} impacts, "
        f"entropy >= {below(content['entropy'])}"
    ),
    "horseshoes": lambda content: (
        f"horseshoes for all {content['over']} in [{', '.join(content['between'])}], "
        f"entropy >= {below(content['entropy'])}"
    ),
    "event": event,
    "border orbit": lambda content: (
        f"a border orbit: {content['over']} = {with_radius(content['parameter'])}, "
        f"from tau = {content['release']} to {content['end']}, chatter completes {content['completes']}"
    ),
    "invariant arc": invariant_arc,
}
