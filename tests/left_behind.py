"""Processes that a run of the suite has left behind."""

import os
import time
from pathlib import Path

SUITE = "SINGIMPACT_SUITE"
"""In the environment of every process of a run of the suite, so that those left behind are recognised."""


def left_behind(mark, patience=10.0):
    """Process number -> command of the processes of a run, but for this one, that live on after a while."""
    end = time.monotonic() + patience
    while True:
        left = marked_processes(mark)
        if not left or time.monotonic() > end:
            return left
        time.sleep(0.05)


def marked_processes(mark):
    """Process number -> command of the living processes whose environment has the mark of a run."""
    found = {}
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            environment = (folder / "environ").read_bytes().split(b"\0")
            command = (folder / "cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace").strip()
        except OSError:  # it has ended, or belongs to somebody else
            continue
        helper = "multiprocessing.resource_tracker" in command or "multiprocessing.forkserver" in command
        if f"{SUITE}={mark}".encode() in environment and int(folder.name) != os.getpid() and not helper:
            found[int(folder.name)] = command
    return found
