"""A row named `singimpact` times public names only: seen from what the bench calls while the row runs."""

from __future__ import annotations

import inspect
import subprocess
import sys
from pathlib import Path
from types import CodeType, FrameType, ModuleType

import pytest

import singimpact as si
from singimpact.bench import (
    BEFORE_SERIES,
    GROUPS,
    SCRIPTS,
    SERIES,
    Case,
    Effort,
    Method,
    cost,
    cpu_seconds,
    script,
)
from singimpact.bench.groups import series_rows

pytestmark = pytest.mark.plain_code  # compares code objects, which probes exchange
PACKAGE = str(Path(si.__file__).parent)
BENCH = str(Path(PACKAGE) / "bench")
SMALL = Effort(quick=True, rounds=1, least=0, once=0, fresh=1, judged=4)


def public_code() -> set[CodeType]:
    """The code of the functions and classes that `singimpact` and its public rooms name."""
    found: set[CodeType] = set()
    for name in (*si._HOMES, *si._ROOMS):
        reached = getattr(si, name)
        rooms = [value for key, value in vars(reached).items() if not key.startswith("_")] if name in si._ROOMS else []
        for value in (reached, *rooms):
            if not isinstance(value, ModuleType):
                found |= {*_codes(value), *_codes(inspect.unwrap(value) if callable(value) else value)}
    return found


def _codes(value: object) -> list[CodeType]:
    if inspect.isfunction(value):
        return [value.__code__]
    if not inspect.isclass(value) or not value.__module__.startswith("singimpact"):
        return []
    parts = [inspect.unwrap(part) for kind in value.__mro__ for part in vars(kind).values() if inspect.isfunction(part)]
    return [part.__code__ for part in parts]


def calls(run, *, text: str = "") -> tuple[list[str], list[str]]:
    """Functions of the package that the bench, or the text of a row, calls: with a public name, and without.

    Methods of objects that public functions return are public too; how an object came about is another call.
    Machine code is not seen: a row that calls a kernel directly calls nothing public.
    """
    allowed, public, private = public_code(), set(), set()

    def watch(frame: FrameType, event: str, _argument: object) -> None:
        code, caller = frame.f_code, frame.f_back
        if event != "call" or caller is None or not code.co_filename.startswith(PACKAGE):
            return
        ours = caller.f_code.co_filename.startswith(BENCH) or (text and caller.f_code.co_filename == text)
        if not ours or code.co_filename.startswith(BENCH) or code.co_name in ("<module>", "__getattr__"):
            return
        called = public if code in allowed or "self" in frame.f_locals else private
        called.add(f"{code.co_filename.removeprefix(PACKAGE)}:{code.co_name}")

    before = sys.getprofile()
    sys.setprofile(watch)
    try:
        run()
    finally:
        sys.setprofile(before)
    return sorted(public), sorted(private)


def _run(method: Method):
    """What is timed: other problems are drawn before."""
    given = () if method.draw is None else (method.draw(),)
    return lambda: method.run(*given)


def _rows(group: str) -> list[tuple[Case, Method]]:
    return [(case, method) for case in GROUPS[group](SMALL) for method in case.methods]


@pytest.mark.parametrize("group", ["chatter", pytest.param("public", marks=pytest.mark.slow)])
def test_rows_named_for_the_package_call_public_names_only(group):
    rows = [(case, method) for case, method in _rows(group) if method.name.startswith("singimpact")]
    assert rows
    for case, method in rows:
        public, private = calls(_run(method))
        assert public, f"{case.name}: {method.name}, {method.setting}"
        assert private == [], f"{case.name}: {method.name}, {method.setting}"


def _executed(text: str, before: str) -> tuple[list[str], list[str]]:
    space: dict[str, object] = {}
    exec(compile(before, "<before>", "exec"), space)
    return calls(lambda: exec(compile(text, "<row>", "exec"), space), text="<row>")


@pytest.mark.slow
def test_series_of_the_limits_call_public_names_only():
    for call in SERIES:
        public, private = _executed(call, BEFORE_SERIES)
        assert len(public) == 1
        assert private == []


def test_series_named_for_the_package_call_public_names_only():
    tasks = [task for task in series_rows.TASKS if task.method.startswith("singimpact")]
    assert {task.case for task in tasks} == set(series_rows.TRUTH)
    for task in (task for task in tasks if task.order <= 8):
        public, private = _executed(f"made = {task.made}", task.before + series_rows.AT)
        assert (len(public), private) == (1, [])
    own = "from singimpact.contact.contact import Contact\nfrom singimpact.theory.impact_sheet import sheet"
    _, private = _executed("made = sheet(Contact.generic(1, 4), 4)", own)
    assert private == ["/contact/contact.py:generic", "/theory/impact_sheet.py:sheet"]


@pytest.mark.parametrize("family", SCRIPTS)
def test_scripts_of_new_processes_are_public(family):
    public, private = _executed(script(family, 10), "")
    assert public
    assert private == []


BURN = "import time\nstart = time.process_time()\nwhile time.process_time() - start < 0.2: pass"


def test_time_of_children_is_counted():
    before = cpu_seconds()
    subprocess.run([sys.executable, "-c", BURN], check=True)
    assert cpu_seconds() - before > 0.2


def test_time_of_children_of_a_fresh_process_is_counted():
    child = f"import subprocess, sys; subprocess.run([sys.executable, '-c', {BURN!r}], check=True)"
    assert cost(child).seconds > 0.2
