"""Which tests run which lines: a plugin of pytest that `mutate.py` uses, as only a test that runs a mutant notices it.

The files that are watched stand in MUTATION_FILES, and what was seen goes to the JSON file MUTATION_LINES: for each
file and line the tests with their seconds.  Lines that run at import belong to no test.
"""

import json
import os
import sys
import time
from pathlib import Path

import pytest

WATCHED = {str(Path(name).resolve()): name for name in json.loads(os.environ.get("MUTATION_FILES", "[]"))}
SEEN: dict[str, dict[str, list[tuple[str, float]]]] = {}


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_protocol(item):
    lines: set[tuple[str, int]] = set()

    def line_run(frame, event, _argument):
        if event == "line":
            lines.add((frame.f_code.co_filename, frame.f_lineno))
        return line_run

    def called(frame, _event, _argument):
        if frame.f_code.co_filename not in WATCHED:
            return None
        lines.add((frame.f_code.co_filename, frame.f_lineno))
        return line_run

    before, began = sys.gettrace(), time.process_time()
    sys.settrace(called)
    yield
    sys.settrace(before)
    test = (item.nodeid, round(time.process_time() - began, 2))
    for file, line in lines:
        SEEN.setdefault(WATCHED[file], {}).setdefault(str(line), []).append(test)


def pytest_sessionfinish():
    Path(os.environ["MUTATION_LINES"]).write_text(json.dumps(SEEN))
