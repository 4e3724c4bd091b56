"""The command in this process, with what it writes and the code it leaves with; how much work a call is."""

import shutil
import signal
import sys
from collections.abc import Callable
from typing import Any

import pytest
from click.testing import CliRunner

# a background job of a shell ignores the signal that tests of interruptions send, and hands that on to its children
if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture
def singimpact():
    from singimpact.cli import main

    return lambda *args: CliRunner().invoke(main, [str(arg) for arg in args])


@pytest.fixture(scope="session")
def reference():
    """The table of reference values: name -> digits."""
    from singimpact.bench import values

    return values()


@pytest.fixture
def work_of() -> Callable[[Callable[[], Any]], int]:
    """How many functions a call runs, of Python and of C: on a busy machine the same as on a quiet one."""

    def counted(call: Callable[[], Any]) -> int:
        count = 0

        def watch(_frame: Any, event: str, _argument: Any) -> None:
            nonlocal count
            count += event in ("call", "c_call")

        before = sys.getprofile()
        sys.setprofile(watch)
        try:
            call()
        finally:
            sys.setprofile(before)
        return count

    return counted


@pytest.fixture(scope="module")
def browser():
    """Chromium without a window, as a browser of selenium; 1440 pixels wide."""
    chromium, driver = shutil.which("chromium"), shutil.which("chromedriver")
    if chromium is None or driver is None:
        pytest.skip("Debian's chromium and chromium-driver are not here")
    webdriver = pytest.importorskip("selenium.webdriver")
    options = webdriver.ChromeOptions()
    options.binary_location = chromium
    for argument in (
        "--headless=new",
        "--no-sandbox",
        "--disable-gpu",
        "--disable-dev-shm-usage",
        "--window-size=1440,1000",
    ):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    opened = webdriver.Chrome(options=options, service=webdriver.ChromeService(driver))
    yield opened
    opened.quit()
