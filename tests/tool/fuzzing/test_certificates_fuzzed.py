"""No damaged certificate that is accepted is false; `python tests/tool/fuzzing/certificates.py` is the long run."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

import certificates
import false_certificates as false


@pytest.mark.parametrize("count", [1500, pytest.param(100_000, marks=pytest.mark.slow)])
def test_no_false_certificate_is_accepted(count):
    told, wrong = certificates.fuzzed(count, 20261121)
    assert wrong == []
    assert set(told) == set(certificates.KINDS)  # what stays true after the damage is accepted, of every kind
    assert min(told.values()) > count / 500


SEEN = ["a negative part", "another polynomial", "a sign unproved",
        "degrees at infinity, falling", "a pole that is none", "a form of another sign", "a difference"]  # fmt: skip
"""Of the conditions of a relation about one in 16 000 damaged certificates meets one: `false_certificates` has them all."""


@pytest.mark.parametrize("name", [pytest.param(each, marks=pytest.mark.slow) for each in SEEN])
def test_the_fuzzer_sees_a_weakened_checker(name):
    condition, instead, _ = (false.WEAKENED | false.IN_IDENTITIES)[name]
    _, wrong = certificates.fuzzed(4000, 1, false.without(condition, instead))
    assert wrong
