"""Certificates with one number changed."""

import copy

import sympy


def leaves(data, path=()):
    """The paths of all numbers in a certificate, as numbers or as text of numbers."""
    if isinstance(data, dict):
        for name, part in data.items():
            if name not in ("says", "kind", "variables"):
                yield from leaves(part, (*path, name))
    elif isinstance(data, list):
        for n, part in enumerate(data):
            yield from leaves(part, (*path, n))
    else:
        yield path


def changed(data, path, change):
    copied = copy.deepcopy(data)
    part = copied
    for step in path[:-1]:
        part = part[step]
    part[path[-1]] = change(part[path[-1]])
    return copied


def bumped(value):
    """The next number; another end for an infinite one."""
    if isinstance(value, bool):
        return not value
    if value is None:
        return []
    if value == "infinite":
        return "finite"
    if value in ("oo", "-oo"):
        return "7"
    return value + 1 if isinstance(value, int) else str(sympy.Rational(value) + 1)
