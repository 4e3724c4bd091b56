"""Record what public calls answer, and compare the answers of another version with a record.

    python tests/same_results/compare.py record FILE [--seed N] [--models N]
    python tests/same_results/compare.py compare FILE [--seed N] [--models N]

Drawn models and states: statuses, causes and texts to the letter, doubles bit by bit, enclosures by their value and
radius, verdicts, JSON and help of commands, certificates.  `compare` lists each answer that differs, doubles with their
distance in units in the last place, and ends with exit code 1 if there is one.  Use it before and after a change that
is to leave results as they are.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

import singimpact as si

PERIODIC = ("cos(w*t)", "cos(w*t) + sin(2*w*t)/5", "cos(w*t)**3", "1/(2 - cos(w*t))", "exp(cos(w*t)) - 1")
FORCES = (
    "x + x**3/3", "sin(x) + xdot/10", "x - xdot*(1 - x**2)/4", "x + tanh(5*xdot)/10", "x + xdot**3/5", "x**3",
    "x/(1 + x**2)", "x*sqrt(1 + x**2) + xdot/20",
)  # fmt: skip
LAWS = ("0.5", "0.8", "0.95", "-v*(1 - v/10)/2", "-tanh(v/2)", "-v/2*exp(v/20)")


def models(seed: int, count: int) -> Iterator[tuple[str, Any, np.random.Generator]]:
    """Names, models, and a generator for their states; three in five are linear."""
    for turn in range(count):
        rng = np.random.default_rng([seed, turn])
        clearance, w = f"{rng.uniform(-0.6, 0.9):.4f}", f"{rng.uniform(1.2, 4.5):.4f}"
        if turn % 5 < 3:
            numbers = {"damping": f"{rng.uniform(0, 3):.3f}"} if turn % 3 else {}
            model = si.linear(w, clearance, f"{rng.uniform(0.3, 0.95):.3f}", **numbers)
        else:
            f, g, rho = (str(rng.choice(choices)) for choices in (FORCES, PERIODIC, LAWS))
            model = si.ImpactOscillator(f, g, clearance, rho, parameters={"w": w})
        yield f"{turn}", model, rng


def states(rng: np.random.Generator, count: int) -> tuple[Any, Any]:
    return rng.uniform(-3, 9, count), 10.0 ** rng.uniform(-6, 0.5, count)


def orbit_of(model: Any) -> Any:
    """The first orbit of one impact in a period, or in two."""
    found = list(model.periodic(1, 1)) or list(model.periodic(1, 2))
    return found[0] if found else None


def local_calls(model: Any, rng: np.random.Generator) -> dict[str, Callable[[], Any]]:
    """Calls that take milliseconds."""
    tau, v = states(rng, 12)
    one, speed = f"{tau[0]:.6f}", f"{v[0]:.9f}"
    return {
        "model": lambda: [repr(model), model.to_toml(), str(model.period)],
        "first_hit": lambda: model.first_hit(tau, v),
        "impact_map": lambda: model.impact_map(tau, v),
        "impact_map of one": lambda: [model.impact_map(float(t), float(u)) for t, u in zip(tau, v, strict=True)],
        "impact_map, 20 digits": lambda: model.impact_map(one, speed, digits=20),
        "enclosed_impact": lambda: model.enclosed_impact(one, speed, radii={"tau": "1e-9"}, digits=15),
        "flight": lambda: model.flight(tau[0], v[0], [0, 0.1, 1.5]),
        "acceleration": lambda: [model.acceleration(tau, order) for order in (0, 1, 3)],
        "iterate": lambda: model.iterate(tau, v, impacts=40),
        "iterate, kept": lambda: model.iterate(tau[:3], v[:3], impacts=4, keep=True),
        "derivative": lambda: model.derivative(tau, v),
        "inverse_map": lambda: model.inverse_map(tau, v),
        "chatter_limit": lambda: model.chatter_limit(tau, 1e-3 * v),
        "chatter_limit, 15 digits": lambda: model.chatter_limit(one, f"{1e-4 * v[0]:.12f}", digits=15),
        "orbit": lambda: model.orbit(one, speed, impacts=60),
        "orbit sampled": lambda: model.orbit(one, speed, impacts=10).sample([float(tau[0]) + 0.3, float(tau[0]) + 2.5]),
        "release": lambda: [model.release(float(t)) for t in tau[:4]],
        "launch": lambda: model.launch(2, v[:4], tau[:4]),
        "tangency_points": lambda: si.tangency_points(model),
    }  # fmt: skip


def global_calls(model: Any, _rng: np.random.Generator) -> dict[str, Callable[[], Any]]:
    """Calls that take a second."""
    return {
        "threshold": lambda: [si.threshold(model, float(tau) - 0.3) for tau in si.tangency_points(model).tau],
        "lyapunov": lambda: si.lyapunov(model, 0.1, 0.4, impacts=400),
        "basins": lambda: si.basins(model, size=6, impacts=600),
        "bifurcation": lambda: si.bifurcation(model, "clearance", ("0.1", "0.2"), 4, impacts=60, kept=6),
        "periodic": lambda: model.periodic(1, 1),
        "branch": lambda: si.branch(orbit_of(model), "clearance"),
        "orbit certified": lambda: orbit_of(model).certified(15),
        "certificate": lambda: si.certify(orbit_of(model).certified(15)).text,
        "classify": lambda: si.classify(model),
    }


def commands() -> dict[str, tuple[str, ...]]:
    """Command lines by names: the help of all, the JSON of some."""
    from singimpact.cli import COMMANDS

    numbers = ("--omega", "2.8", "--clearance", "0.1", "--restitution", "0.8")
    told = {f"{name} --help": (name, "--help") for name in COMMANDS}
    return told | {
        "help": ("--help",),
        "map": ("map", *numbers, "--tau", "0.9", "--v", "0.005", "--json"),
        "orbit": ("orbit", *numbers, "--tau", "0.9", "--v", "0.005", "--json"),
        "chatter": ("chatter", *numbers, "--tau", "0.9", "--v", "0.005", "--json"),
        "threshold": ("threshold", *numbers, "--tau", "pi/2.8", "--json"),
        "classify": ("classify", *numbers, "--json"),
        "fixed points": ("fixed-points", "swan", "--r", "1/2", "--json"),
        "errata": ("errata", "--json"),
        "series": ("derive", "--order", "5", "--format", "numpy"),
    }


def plain(value: Any, depth: int = 0) -> Any:
    """An answer as JSON: doubles in hexadecimal, arrays as lists, objects by their public fields."""
    if value is None or isinstance(value, bool | np.bool_ | str):
        return value if not isinstance(value, np.bool_) else bool(value)
    if isinstance(value, int | np.integer):
        return int(value)
    if isinstance(value, float | np.floating):
        return float(value).hex()
    if isinstance(value, complex | np.complexfloating):
        return [value.real.hex(), value.imag.hex()]
    if isinstance(value, np.ndarray):
        return [plain(item, depth + 1) for item in value.tolist()]
    if isinstance(value, Mapping):
        return {str(key): plain(item, depth + 1) for key, item in value.items()}
    if isinstance(value, list | tuple) and not hasattr(value, "__dict__"):
        return [plain(item, depth + 1) for item in value]
    if isinstance(value, Fraction) or hasattr(value, "_mpf_") or type(value).__module__.startswith(("flint", "sympy")):
        return str(value)
    fields = getattr(value, "__dict__", {})
    if depth > 6 or not fields or callable(value):
        return repr(value)
    items = [plain(item, depth + 1) for item in value] if isinstance(value, list | tuple) else []
    shown = {name: plain(item, depth + 1) for name, item in fields.items() if not name.startswith("_")}
    return {"text": repr(value), **shown, **({"items": items} if items else {})}


def answered(call: Callable[[], Any]) -> Any:
    try:
        return plain(call())
    except Exception as error:  # a refusal is an answer too
        return f"{type(error).__name__}: {error}"


def answers(seed: int, count: int) -> Iterator[tuple[str, Any]]:
    """Name and answer of each call."""
    for name, model, rng in models(seed, count):
        calls = local_calls(model, rng)
        if int(name) % 10 == 0:
            calls |= global_calls(model, rng)
        for call, run in calls.items():
            yield f"{name} {call}", answered(run)
    for name, words in commands().items():
        run = subprocess.run([sys.executable, "-m", "singimpact", *words], capture_output=True, text=True, check=False)
        yield f"command {name}", [run.returncode, run.stdout, run.stderr]
    for verdict in si.verify():
        yield f"claim {verdict.id}", [verdict.kind, verdict.effective, verdict.corrected, verdict.evidence]


def ulps(left: str, right: str) -> float:
    """The distance of two doubles in units in the last place."""
    one, other = float.fromhex(left), float.fromhex(right)
    if math.isnan(one) or math.isnan(other) or math.isinf(one) or math.isinf(other):
        return math.inf
    return abs(one - other) / math.ulp(max(abs(one), abs(other)))


RADIUS = re.compile(r" \+- [0-9.e+-]+|\berror=[0-9.e+-]+|\"radius\": \"[0-9.e+-]+\"|\"digest\": \"[^\"]*\"")
ENCLOSURE = re.compile(r"Certified\((\S+) \+- (\S+)\)")


def overlap(left: str, right: str) -> bool:
    """Whether two texts of `Certified` are of balls that have a number in common."""
    (one, near), (other, beside) = (ENCLOSURE.fullmatch(text).groups() for text in (left, right))  # type: ignore[union-attr]
    last = [Fraction(1, 10 ** len(text.partition(".")[2].partition("e")[0])) for text in (one, other)]
    scale = [Fraction(10) ** int(text.partition("e")[2] or 0) for text in (one, other)]
    shown = sum(unit * size for unit, size in zip(last, scale, strict=True))  # the texts are rounded
    return abs(Fraction(one) - Fraction(other)) <= Fraction(near) + Fraction(beside) + shown


def differences(left: Any, right: Any, path: str = "") -> Iterator[str]:
    """Where two answers differ, in words; of enclosures where they do not overlap."""
    if isinstance(left, dict) and isinstance(right, dict) and {"radius", "text"} <= left.keys() & right.keys():
        if not overlap(left["text"], right["text"]):
            yield f"{path}: {left['text']} and {right['text']} do not overlap"
    elif isinstance(left, str) and isinstance(right, str) and RADIUS.sub("", left) == RADIUS.sub("", right):
        return
    elif isinstance(left, dict) and isinstance(right, dict):
        for key in sorted(left.keys() | right.keys()):
            yield from differences(left.get(key, "absent"), right.get(key, "absent"), f"{path}.{key}")
    elif isinstance(left, list) and isinstance(right, list) and len(left) == len(right):
        for place, (one, other) in enumerate(zip(left, right, strict=True)):
            yield from differences(one, other, f"{path}[{place}]")
    elif left != right:
        doubles = all(isinstance(each, str) and "0x" in each and " " not in each for each in (left, right))
        if doubles:
            yield f"{path}: {float.fromhex(left)!r} and {float.fromhex(right)!r}, {ulps(left, right):.3g} ulp"
        else:
            yield f"{path}: {str(left)[:200]} and {str(right)[:200]}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("action", choices=("record", "compare"))
    parser.add_argument("file", type=Path)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--models", type=int, default=200)
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as empty:
        os.environ.setdefault("SINGIMPACT_CACHE", empty)
        found = dict(answers(chosen.seed, chosen.models))
    if chosen.action == "record":
        chosen.file.write_text(json.dumps(found, indent=0), encoding="utf-8")
        print(f"{len(found)} answers recorded")
        return 0
    before = json.loads(chosen.file.read_text(encoding="utf-8"))
    lines = list(differences(before, json.loads(json.dumps(found))))
    print("\n".join(lines))
    print(f"{len(found)} answers compared, {len(lines)} differences")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
