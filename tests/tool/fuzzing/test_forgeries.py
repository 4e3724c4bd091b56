"""No forgery of a certificate is accepted, none ends in a traceback; `python tests/tool/fuzzing/forgeries.py` is the long run."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

import forgeries


@pytest.mark.parametrize("count", [60, pytest.param(400, marks=pytest.mark.slow)])
def test_no_forgery_is_accepted(count, monkeypatch):
    """A number that moves costs seconds: all of them in the long run alone."""
    monkeypatch.setattr(forgeries, "DEAR", dict.fromkeys(forgeries.EXAMPLES, 0))
    answers = {n: forgeries.judged(count, n)[0] for n in range(count)}
    assert {n: answer for n, answer in answers.items() if answer not in ("refused", "true")} == {}
    assert list(answers.values()).count("refused") > 0.9 * count


def test_every_kind_is_forged():
    said = {content["statement"] for content, _ in forgeries.EXAMPLES.values()}
    kinds = {content.get("kind") for content, _ in forgeries.EXAMPLES.values()}
    assert said == set(forgeries.WORDS[:8])
    assert kinds >= {"fold", "period-doubling", "torus", "graze", "hidden impact"}
