"""The second program with conditions taken out, and certificates with a number changed."""

import json
import re
from pathlib import Path

import pytest

import singimpact as si
from singimpact.certificates import checker
from singimpact.certificates.checker import formulas

FOLDER = Path(checker.__file__).parent


def weakened(name, condition, instead=None):
    """The function of a statement, from the source of its file without a condition."""
    text = (FOLDER / f"{name}.py").read_text(encoding="utf-8")
    assert text.count(condition) == 1
    weak = {"__name__": "weak", "__package__": checker.__name__}
    instead = ("True" if "<" in condition else "0") if instead is None else instead
    exec(compile(text.replace(condition, instead), "weak", "exec"), weak)
    return weak[name]


def dropped(monkeypatch, *names):
    """The second program without these of its conditions."""
    true = formulas.refuse
    monkeypatch.setattr(formulas, "refuse", lambda name, error: None if name in names else true(name, error))


def copied(content):
    return json.loads(json.dumps(content))


def renewed(content):
    """With the digest of what it now says."""
    return {**content, "digest": checker.digest_of(content)}


def places_of(content, path=()):
    """The places of all numbers of a certificate, in lists too."""
    for key, part in content.items() if isinstance(content, dict) else enumerate(content):
        if isinstance(part, dict | list):
            yield from places_of(part, (*path, key))
        elif key not in ("schema", "statement", "digest") and re.search(r"\d", part):
            yield (*path, key)


def changed(content, place):
    """A copy in which the last digit that counts is another one."""
    made = copied(content)
    inner = made
    for key in place[:-1]:
        inner = inner[key]
    mantissa, e, exponent = inner[place[-1]].partition("e-")
    at = max(found.start() for found in re.finditer(r"\d", mantissa))
    digit = str((int(mantissa[at]) + 3) % 10)
    inner[place[-1]] = mantissa[:at] + digit + mantissa[at + 1 :] + e + exponent
    return made


def refuses(content, why=None):
    """Refused for this reason, though its digest is that of what it says."""
    with pytest.raises(checker.Refused, match=why):
        checker.check(renewed(content))


def is_read_back(made, file):
    """Accepted from a file, as it was made."""
    made.save(file)
    assert si.read_certificate(file) == made


def no_number_may_change(made, least):
    """Each of its numbers, at least so many, changes the digest."""
    places = list(places_of(made.content))
    assert len(places) >= least
    for place in places:
        with pytest.raises(checker.Refused, match="digest"):
            checker.check(changed(made.content, place))
