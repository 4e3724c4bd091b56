"""Figures B7 and B8: arcs of the visible outline before, at and after transitions, by their ends."""

from functools import lru_cache

import numpy as np
import pytest

from singimpact.paper import B7, B8, picture, two_waves

made = lru_cache(maxsize=None)(picture)


def test_clearances_of_the_panels():
    assert len(B7) == 2
    assert len(B8) == 3
    assert two_waves().clearance == type(two_waves().clearance)(0)


@pytest.mark.slow
def test_a_lens_opens_at_the_tacnode():
    facts = made("B7").facts
    assert facts["tacnode"] == pytest.approx(np.cos(1.4 * np.pi) / (2.8**2 - 1), abs=1e-12)
    assert facts["tacnode <"] == facts["tacnode >"] + 2


@pytest.mark.slow
def test_the_foot_of_gamma_is_passed_over():
    facts = made("B8").facts
    assert facts["tangency first >"] == facts["tangency first <"] + 2


@pytest.mark.slow
def test_the_command(singimpact, tmp_path):
    done = singimpact("figure", "B7", "-o", str(tmp_path), "--format", "svg")
    assert done.exit_code == 0, done.output
    assert (tmp_path / "figureB7.svg").exists()
