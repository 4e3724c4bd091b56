"""Sentences of certificates, made from their data alone: a reader sees what was checked."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from singimpact.algebra.plain import rational, row, terms


def sentence(certificate: Mapping[str, Any]) -> str:
    """The statement of a certificate.

    Raises
    ------
    KeyError, TypeError, ValueError, IndexError : the data are damaged, or the names are not one for each variable.

    Examples
    --------
    >>> sentence({"kind": "definite", "variables": ["x", "y"], "form": ["6", "4", "1"], "sign": 1})
    '6*x**2 + 4*x*y + y**2 > 0 for all (x, y) but (0, 0)'
    """
    return _SENTENCES[certificate["kind"]](certificate, _names(certificate["variables"]))


def _names(given: Any) -> tuple[str, ...]:
    names = tuple(given)
    if not all(isinstance(name, str) and name.isidentifier() for name in names) or len(set(names)) < len(names):
        raise ValueError("names of variables are different identifiers")
    return names


def polynomial(data: Any, names: Sequence[str]) -> str:
    """A polynomial as text, highest powers first.

    Examples
    --------
    >>> polynomial([[[0, 0], -1], [[2, 1], "1/2"]], ["x", "y"])
    '1/2*x**2*y - 1'
    """
    parts: list[str] = []
    for key, value in sorted(terms(data).items(), reverse=True):
        if len(key) != len(names):
            raise ValueError(f"{len(names)} names for {len(key)} exponents")
        powers = [name if n == 1 else f"{name}**{n}" for name, n in zip(names, key, strict=True) if n]
        size = abs(value)
        text = "*".join(([str(size)] if size != 1 or not powers else []) + powers)
        parts.append(("- " if value < 0 else "+ ") + text)
    joined = " ".join(parts) or "0"
    return joined[2:] if joined.startswith("+ ") else f"-{joined[2:]}" if joined.startswith("- ") else joined


def _quotient(pair: Any, names: Sequence[str]) -> str:
    above, below = pair
    under = polynomial(below, names)
    return polynomial(above, names) if under == "1" else f"({polynomial(above, names)})/({under})"


def _box(box: Any, names: Sequence[str]) -> str:
    return ", ".join(f"{low} < {name} < {high}" for name, (low, high) in zip(names, box, strict=True))


def _positive(data: Mapping[str, Any], names: Sequence[str]) -> str:
    side = {1: ">", -1: "<"}[data["sign"]]
    return f"{_quotient((data['numerator'], data['denominator']), names)} {side} 0 for {_box(data['box'], names)}"


def _chain(data: Mapping[str, Any], names: Sequence[str]) -> str:
    gaps = ", ".join(f"({low}, {high})" for low, high in data["roots"]) or "no gap"
    rest = f", for all {_box(data['box'], names[1:])}" if data["box"] else ""
    others = " and no other" if data["all"] else ""
    return f"{polynomial(data['polynomial'], names)} has a root {names[0]} in each of {gaps}{others}{rest}"


def _count(data: Mapping[str, Any], names: Sequence[str]) -> str:
    poly = polynomial([[list(key), str(value)] for key, value in row(data["chain"][0]).items()], names)
    return f"{poly} has {data['roots']} real roots in ({data['low']}, {data['high']})"


def _value(data: Mapping[str, Any], names: Sequence[str]) -> str:
    stated = data["value"]
    told = "is unbounded" if stated == "infinite" else f"-> {_quotient(stated, names)}"
    place = f"{names[data['index']]} -> {data['at']}"
    return f"{_quotient((data['numerator'], data['denominator']), names)} {told} as {place}"


def _definite(data: Mapping[str, Any], names: Sequence[str]) -> str:
    x, y = names
    form = [[[2 - n, n], value] for n, value in enumerate(data["form"]) if rational(value)]
    return f"{polynomial(form, names)} {({1: '>', -1: '<'})[data['sign']]} 0 for all ({x}, {y}) but (0, 0)"


def _identity(data: Mapping[str, Any], names: Sequence[str], side_of: Callable[..., str] = _quotient) -> str:
    left, right = (side_of(data[side], names) for side in ("left", "right"))
    where = f" where {polynomial(data['relation'][2], names)} = 0" if data["relation"] else ""
    return f"{left} = {right}{where}"


def _at_images(side: Mapping[str, Any], names: Sequence[str]) -> str:
    images = ", ".join(f"{names[index]} = {_quotient(pair, names)}" for index, pair in side["images"])
    outer = _quotient(side["outer"], names)
    return f"[{outer} at {images}]" if images else outer


def _order(data: Mapping[str, Any], names: Sequence[str]) -> str:
    """Up to which degree, in which variables."""
    if data["order"] is None:
        return ""
    small = [(name, weight) for name, weight in zip(names, data["weights"], strict=True) if weight]
    told = ", ".join(name if weight == 1 else f"{name} (weight {weight})" for name, weight in small)
    return f", up to degree {data['order']} in {told}"


def _equation(data: Mapping[str, Any], clock: str, names: Sequence[str]) -> str:
    """The equation of motion that the jets in the data say."""
    pushed = [f"({polynomial(part, names)})*({clock})**{n}" for n, part in enumerate(data["acceleration"]) if part]
    held = [f"({polynomial(part, names)})*x**{i}*x'**{k}" for (i, k), part in data["force"]]
    left = " + ".join(["x''", *held])
    return f"{left} = {' + '.join(pushed) or '0'}"


def _motion(data: Mapping[str, Any], names: Sequence[str]) -> str:
    sigma, v, t = names[:3]
    told = f"x = {polynomial(data['height'], names)} solves {_equation(data, f'{sigma} + {t}', names)}"
    if data["launch"] is not None:
        told += f", and x/{t} = 0 at {v} = {polynomial(data['launch'], names)}"
    if data["landing"] is not None:
        told += f", where x' = {polynomial(data['landing'], names)}"
    return f"{told}, x = 0 and x' = {v} at {t} = 0{_order(data, names)}"


def _flight(data: Mapping[str, Any], names: Sequence[str]) -> str:
    z, sigma, t = names[:3]
    launch, landing = (polynomial(data[name], names) for name in ("launch", "landing"))
    return (
        f"x = {t}*({polynomial(data['rise'], names)}), time {z}*{t}, solves "
        f"{_equation(data, f'{sigma} + {z}*{t}', names)}, x = 0 at {z} = 0 with x' = {launch} and at {z} = 1 with "
        f"x' = {landing}{_order(data, names)}"
    )


_SENTENCES: dict[str, Callable[..., str]] = {
    "positive": _positive,
    "chain": _chain,
    "count": _count,
    "value": _value,
    "definite": _definite,
    "identity": _identity,
    "composed": lambda data, names: _identity(data, names, _at_images) + _order(data, names),
    "motion": _motion,
    "flight": _flight,
}
