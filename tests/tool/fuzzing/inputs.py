"""Inputs for the fuzzer: grown from a grammar, mutated from valid ones, or taken from a list of nasty ones.

An input is named by kind, seed and number, and the same name always gives the same input.
"""

from __future__ import annotations

from random import Random

NASTY = [
    "9**9**9", "9**9**9**9", "(" * 80 + "1" + ")" * 80, "-" * 3000 + "1", "1" * 5000, "0." + "3" * 4000, "1e999999999",
    "1e-999999999", "1e4000", "1e309", "1e-4000", "2**-4000", "10**1000", "(1/3)**1000", "exp(exp(exp(9)))",
    "exp(exp(1000))", "sqrt(-1)", "log(0)", "tan(pi/2)", "1/0", "0**-1", "0**0", "0**(1/2)", "pi**pi", "(x+t)**1000",
    "(1+x)**999*(1-x)**999", "cos(cos(cos(cos(1e300))))", "__import__('os').system('true')", "canary()", "canary",
    "().__class__.__bases__", "x.__class__", "lambda: 1", "lambda x: x", "[i for i in (1,)]", "{}", "f'{1}'", "exec('1')",
    "eval('canary()')", "open('/etc/passwd')", "os.system('true')", "%s%n%d", "\0", "\x1b[2J", "\ufeff1", "١٢٣", "ⅷ", "²",
    "π", "𝟙", "x\u0301", "é" * 300, "nan", "inf", "-inf", "NaN", "1_000", "0x10", "1j", "1e", "1e+", ".", "..", "1..2", "",
    " ", "\t\n", "True", "None", "root(u**2 - 2, 1, 2)", "root(u**99 - 2, 0, 9)", "root(sin(u), 1, 1e9)", "root(u, 1, 2)",
    "root(root(u-1,0,2), 0, 1)", "root(tan(u)-u, 1, 4000)", "root((u-1)**60, 0, 3)", "root(exp(u*1000)-2, -900, 900)",
    "root(cos(1/u), 0, 1)", "root(u - 1e-3000, -1, 1)", "sin(1e3000)", "exp(1e3000)", "exp(-1e3000)", "atan(1e3000)",
    "1-1+1e-3999", "sqrt(2)**2-2", "sin(pi)", "abs(sin(pi))", "log(1+1e-3000)", "+".join("x" * 2500), "*".join(["(1+x)"] * 60),
    "/".join(["7"] * 2500), "**".join(["2"] * 50), "a" * 9000, "sin(" * 59 + "x" + ")" * 59, ";", "#", "'", '"', "\\", "--", "-",
]  # fmt: skip
NAMES = ["x", "xdot", "t", "v", "u", "omega", "w", "a", "pi", "sin", "tau"]
CALLS = ["sin", "cos", "tan", "exp", "log", "sqrt", "tanh", "atan", "abs", "root", "gamma"]
F = ["x", "x + 0.1*xdot", "x + 0.3*x**3", "sin(x)", "0", "x + a*x**3 + 0.02*xdot", "tanh(x) + xdot/7", "exp(x) - 1"]
G = [
    "cos(2*t)",
    "cos(omega*t)",
    "sin(t) + sin(3*t)/2",
    "12*(t**2 - 1)",
    "cos(t)**3",
    "cos(sqrt(2)*t)",
    "1",
    "exp(-t**2)",
]
NUMBERS = ["0", "1", "0.3", "1/2", "pi/2.8", "-0.7", "1e-12", "2.8", "sqrt(2)", "0.999999", "1e5", "3", "1e-300"]
LAYERS = [
    "discontinuities",
    "gamma",
    "foliation",
    "horizon",
    "zero-set",
    "visible",
    "shadow",
    "outline",
    "orbits",
    "nothing",
]
CLAIMS = ["e:meq", "e:qdef", "s3-dvdt", "e:swan", "e:lin", "s3-slope-r", "e:phinew"]
RAW = ["true", "false", "nan", "inf", "-1", "[]", "{}", "[[1, 2]]", "1979-05-27", "07:32:00", "0x1F", '"text"', "1e999",
       "[1, [2, [3]]]", "9" * 400, '""', "{a = 1}", "'''\n'''", "[" * 300 + "]" * 300]  # fmt: skip
COMMANDS = ["map", "orbit", "chatter", "fixed-points", "map", "map", "threshold", "mapp", "cite", "claims"]


def made(kind: str, seed: int, number: int) -> str | list[str]:
    """The input of a name; a command is a list of arguments."""
    random = Random(f"{seed}:{kind}:{number}")
    return {"expression": _expression, "model": _model, "scene": _scene, "claim": _claim, "command": _command}[kind](
        random
    )


def _expression(random: Random) -> str:
    way = random.random()
    if way < 0.1:
        return random.choice(NASTY)
    text = _grown(random, random.randrange(1, 7)) if way < 0.6 else random.choice(F + G + NUMBERS + NASTY)
    return text if random.random() < 0.4 else _mutated(random, text)


def _grown(random: Random, depth: int) -> str:
    if depth == 0 or random.random() < 0.1:
        return random.choice(
            random.choice([NAMES, NUMBERS, NUMBERS, NASTY] if random.random() < 0.2 else [NAMES, NUMBERS])
        )
    way = random.randrange(5)
    if way == 0:
        return f"{random.choice(CALLS)}({_grown(random, depth - 1)})"
    if way == 1:
        return f"({_grown(random, depth - 1)})**{random.choice(['2', '3', '-1', '(1/2)', '17', '1000', 'x', '0'])}"
    sign = random.choice(["+", "-", "*", "/", " - ", " * "])
    return f"({_grown(random, depth - 1)}{sign}{_grown(random, depth - 1)})"


def _mutated(random: Random, text: str) -> str:
    for _ in range(random.randrange(1, 4)):
        at, to = sorted((random.randint(0, len(text)), random.randint(0, len(text))))
        piece = random.choice([
            "", chr(random.randrange(1, 128)), chr(random.choice([0, 233, 0x661, 0x3C0, 0x202E, 0x1D7D9, 0xFEFF])),
            random.choice(NASTY), text[at:to] * random.choice([2, 40]), random.choice("()*/+-.,^e='\"[]{}\n"),
        ])  # fmt: skip
        text = text[:at] + piece + text[random.choice([at, to, min(at + 1, len(text))]) :]
        text = text[:20_000]
    return text


def _value(random: Random, usual: list[str]) -> str:
    way = random.random()
    if way < 0.75:
        return f'"{random.choice(usual)}"'
    if way < 0.85:
        return random.choice(NUMBERS[:3] + RAW)
    text = _expression(random).replace("\\", "").replace('"', "")
    return f'"{text}"'


def _fields(random: Random) -> list[str]:
    f, g = _value(random, F), _value(random, G)
    lines = [f"f = {f}", f"g = {g}", f"clearance = {_value(random, NUMBERS)}",
             f"restitution = {_value(random, ['0.5', '0.8', '1', '1/3', '-0.8*v'])}"]  # fmt: skip
    if random.random() < 0.1:
        lines.append(f"period = {_value(random, ['pi', '2*pi', '1', '0'])}")
    named = [name for name in ("omega", "a") if name in f + g]
    if random.random() < 0.05:
        named.append(random.choice(["x", "__class__", "sin", "lambda", "q" * 500, "é"]))
    if named:
        inside = ", ".join(f"{name} = {_value(random, NUMBERS)}" for name in named)
        lines.append(f"parameters = {{{inside}}}")
    if random.random() < 0.1:
        del lines[random.randrange(len(lines))]
    if random.random() < 0.1:
        lines.append(f"{random.choice(['clearence', 'f', '__init__', 'a.b.c'])} = {random.choice(RAW)}")
    return lines


def _model(random: Random) -> str:
    text = "\n".join(_fields(random))
    return text if random.random() < 0.7 else _mutated(random, text)


def _scene(random: Random) -> str:
    layers = [f'"{name}"' for name in random.sample(LAYERS, random.randrange(3))]
    given = {"layers": f"[{', '.join(layers)}]", "tau": "[-1.2, 1.0]", "v": "[0, 0.3]", "t": "[-1, 1]", "pixels": "800",
             "title": '"a"', "leaves": "16", "impacts": "50", "feet": '["0.1"]', "orbits": "[[0.1, 0.2]]",
             "marks": '[["A", 0, 1]]'}  # fmt: skip
    lines = []
    for key, usual in given.items():
        if key in ("layers", "tau", "v") or random.random() < 0.3:
            lines.append(f"{key} = {usual if random.random() < 0.8 else _odd(random)}")
    text = "\n".join([*lines, "[model]", *_fields(random)])
    return text if random.random() < 0.7 else _mutated(random, text)


def _odd(random: Random) -> str:
    one = random.choice([*RAW, _value(random, NUMBERS)])
    return one if random.random() < 0.5 else f"[{one}, {_value(random, NUMBERS)}]"


def _claim(random: Random) -> str:
    text = random.choice(CLAIMS + NASTY)
    return text if random.random() < 0.2 else _mutated(random, text)


def _command(random: Random) -> list[str]:
    name = random.choice(COMMANDS)
    if name == "fixed-points":
        args = [name, random.choice(["tangency", "swan", "fold"]), "--r", _number(random)]
        return args + (
            ["--digits", random.choice(["5", "50", "-1", "x", "1" * 30, "nan"])] if random.random() < 0.4 else []
        )
    if name in ("cite", "claims"):
        return [
            name,
            *random.sample(["--json", "show", "list", "impact", _claim(random), "--help"], random.randrange(3)),
        ]
    args = [name]
    for option in ("omega", "clearance", "restitution", "tau", "v"):
        if random.random() < 0.98 and (name, option) != ("threshold", "v"):
            args += [f"--{option}", _number(random)]
    for option, usual in (("digits", ["20", "0", "-5", "x", "9" * 40]), ("impacts", ["3", "0", "many", "-1"])):
        if random.random() < 0.1:
            args += [f"--{option}", random.choice(usual)]
    return (
        args
        + _small(name, args)
        + (
            random.sample(["--json", "--restitutoin", "--", "", "--help", "--damping=0.1"], 1)
            if random.random() < 0.2
            else []
        )
    )


def _small(name: str, args: list[str]) -> list[str]:
    """What a host of strangers would add: all that these numbers ask for may take hours, and is not what is tried here."""
    most = {"orbit": "3", "chatter": "500", "threshold": "500"}
    given = ["--impacts", most[name]] if name in most and "--impacts" not in args else []
    return given + (["--horizon", "20"] if name in ("map", "orbit") else [])


def _number(random: Random) -> str:
    return random.choice(NUMBERS) if random.random() < 0.65 else _expression(random)
