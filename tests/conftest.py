"""The command in this process, with what it writes and the code it leaves with."""

import pytest
from click.testing import CliRunner


@pytest.fixture
def singimpact():
    from singimpact.cli import main

    return lambda *args: CliRunner().invoke(main, [str(arg) for arg in args])


@pytest.fixture(scope="session")
def reference():
    """The table of reference values: name -> digits."""
    from singimpact.bench.problems import values

    return values()
