"""Suite-wide: an empty cache, no display, and slow tests on demand.

It stands at the root so that it serves the doctests of the package too.
"""

import gc
import os
import shutil
import sys
import tempfile
import time
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent / "tests"))  # tests/fakes.py
os.environ["MPLBACKEND"] = "Agg"
gc.set_threshold(200_000, 50, 50)  # an eighth of the time: sympy makes millions of objects that stay


def pytest_addoption(parser):
    parser.addoption("--slow", action="store_true", help="run the slow tests too")


def pytest_configure(config):
    config.addinivalue_line("markers", "slow: takes more than some seconds; runs with --slow, and in .ci/run")
    config.addinivalue_line("markers", "quick: of a file in QUICK; -m quick collects these files alone, in 20 s")
    plain = "plain_code: reads bytecode or counts calls; .ci/check runs it without the probes that count lines"
    config.addinivalue_line("markers", plain)
    if not hasattr(config, "workerinput"):  # workers of one run share the cache of the first
        config.singimpact_cache = tempfile.mkdtemp(prefix="singimpact-suite-")
        os.environ["SINGIMPACT_CACHE"] = config.singimpact_cache
        from left_behind import SUITE

        os.environ[SUITE] = config.singimpact_cache
        Path(config.singimpact_cache, "kernels").symlink_to(_kept_kernels(config.rootpath), target_is_directory=True)
        os.environ["NUMBA_CACHE_DIR"] = str(Path(config.singimpact_cache) / "numba")


def _kept_kernels(root):
    """Compiled models, which the next run finds: a name says which source and model they are of; for two days."""
    kept = root / ".pytest_cache" / "kernels"
    kept.mkdir(parents=True, exist_ok=True)
    for file in kept.iterdir():
        if time.time() - file.stat().st_mtime > 2 * 86400:
            file.unlink(missing_ok=True)
    return kept


def pytest_unconfigure(config):
    if hasattr(config, "singimpact_cache"):
        shutil.rmtree(config.singimpact_cache, ignore_errors=True)


@pytest.hookimpl(trylast=True)
def pytest_sessionfinish(session):
    """No process of the suite outlives it: one that does is named, and the run fails."""
    if not hasattr(session.config, "singimpact_cache"):
        return
    from left_behind import left_behind

    left = left_behind(session.config.singimpact_cache)
    for pid, command in left.items():
        print(f"\nERROR: the suite has left process {pid} behind: {command}")
    if left:
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


def pytest_runtest_teardown(item):  # noqa: ARG001
    if "matplotlib.pyplot" in sys.modules:  # figures of pyplot stay open until they are closed
        sys.modules["matplotlib.pyplot"].close("all")


QUICK = (
    "tests/tool/algebra/test_puiseux.py",
    "tests/tool/branches/test_continuation.py",
    "tests/tool/branches/test_family.py",
    "tests/tool/cli/test_refusals.py",
    "tests/tool/codegen/test_recurrence.py",
    "tests/tool/contact/test_contact_orders.py",
    "tests/tool/dynamics/test_orbit.py",
    "tests/tool/flights/test_derivative.py",
    "tests/tool/flights/test_path.py",
    "tests/tool/germs/test_recognition.py",
    "tests/tool/oscillator/test_model.py",
    "tests/tool/scenes/test_style.py",
    "tests/tool/surface/test_followed_rests.py",
    "tests/architecture/test_public_names.py",
    "tests/tool/test_store.py",
    "tests/tool/theory/test_fixed_points.py",
    "tests/tool/theory/test_sheet.py",
)
"""One or two files of each room that take less than a second: `python -m pytest -m quick`."""


def pytest_ignore_collect(collection_path, config):
    """With -m quick no other file is even imported."""
    if config.option.markexpr != "quick" or collection_path.is_dir():
        return None
    return None if collection_path.relative_to(config.rootpath).as_posix() in QUICK else True


LONGEST = ("test_faults.py", "test_steep_layers.py", "test_threshold.py")
"""Files that take a minute: handed out next, so that no worker is left with one at the end."""


TOGETHER = (
    "tests/paper/claims/",
    "tests/paper/sections/",
    "tests/paper/cli/test_claims_and_errata.py",
    "tests/paper/certificates/test_claims",
)
"""Files that need the verdicts of all claims: one worker takes them, so that these are decided once and kept."""


def pytest_xdist_auto_num_workers():
    """One worker a core that this process may use; each takes up to 1 GB of memory."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return min(cores, 16)


def pytest_xdist_make_scheduler(config, log):
    if config.getoption("dist") != "loadfile":
        return None
    from xdist.scheduler import LoadFileScheduling

    class ByFile(LoadFileScheduling):
        def _split_scope(self, nodeid):
            return "verdicts" if nodeid.startswith(TOGETHER) else super()._split_scope(nodeid)

    return ByFile(config, log)


def pytest_collection_modifyitems(config, items):
    for item in items:
        if item.nodeid.partition("::")[0] in QUICK:
            item.add_marker("quick")
    items.sort(key=lambda item: item.path.name not in LONGEST)
    left_out = set() if config.getoption("--slow") else {"slow"}
    if os.environ.get("SLIPCOVER_ENABLED"):
        left_out.add("plain_code")
    dropped = [item for item in items if any(item.get_closest_marker(name) for name in left_out)]
    config.hook.pytest_deselected(items=dropped)
    items[:] = [item for item in items if not any(item.get_closest_marker(name) for name in left_out)]


@pytest.fixture
def clone():
    """The folder that holds pyproject.toml."""
    return Path(__file__).parent


@pytest.fixture(autouse=True)
def precision_is_put_back():
    """No test leaves flint's balls at another precision: what the next one prints would depend on the order."""
    yield
    flint = sys.modules.get("flint")
    assert flint is None or (flint.ctx.prec, flint.ctx.cap) == (53, 10)
