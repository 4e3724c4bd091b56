"""The real derivations, told and judged once a session, as running the claims takes seconds."""

import importlib.util
from pathlib import Path

import pytest

from singimpact.paper import marks_of
from singimpact.paper.sections.derivation_sections import sections


@pytest.fixture(scope="session")
def told():
    return sections()


@pytest.fixture(scope="session")
def marks(told):
    return marks_of(told)


@pytest.fixture(scope="session")
def freeze():
    place = Path(__file__).parents[3] / "derivations" / "freeze.py"
    spec = importlib.util.spec_from_file_location("freeze", place)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
