"""Outputs of sweeps and commands on full and read-only file systems, and results that a stranger wrote."""

from __future__ import annotations

import contextlib
import os
import subprocess
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import numpy as np
import pytest

from singimpact.cases import sweep
from singimpact.inputs import InputError


@pytest.fixture
def mounted(tmp_path):
    """A function that mounts a file system of a small size below a folder; a user who is not root may not."""
    places = []

    def mount(size):
        place = tmp_path / f"small{len(places)}"
        place.mkdir()
        told = subprocess.run(
            ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", place], capture_output=True, text=True
        )
        if told.returncode:
            pytest.skip(f"needs a user who may mount a file system: {told.stderr.strip()}")
        places.append(place)
        return place

    yield mount
    for place in places:
        subprocess.run(["umount", "-l", place], check=True)


def fill(place, leave):
    """Leave so many bytes of a file system."""
    filler = place / "filler"
    with contextlib.suppress(OSError), filler.open("wb", 0) as stream:
        while True:
            stream.write(bytes(4096))
    os.truncate(filler, max(0, filler.stat().st_size - leave))
    return filler


def refusal(function, cases, output):
    """The sentence that refuses a sweep, or None."""
    try:
        with ThreadPoolExecutor(1) as pool:
            sweep(function, cases, pool, output)
    except InputError as error:
        return str(error)
    return None


@pytest.mark.parametrize("ending", ["npz", "zarr"])
def test_a_sweep_goes_on_once_a_full_disk_has_room(ending, mounted):
    """Wherever the disk is full, the output is named, and it is neither locked nor half-written."""
    refused = 0
    for leave in range(0, 60_000, 4096):
        place = mounted("256k")
        output, filler = place / f"kept.{ending}", fill(place, leave)
        told = refusal(partial(np.full, 200), np.arange(60.0), output)
        if told is not None:
            refused += 1
            assert told.startswith("output = ")
            assert told.endswith("cannot be written (No space left on device): give a place that can")
            assert not output.exists()
        filler.unlink()
        with ThreadPoolExecutor(1) as pool:
            found = np.asarray(sweep(partial(np.full, 200), np.arange(60.0), pool, output))
        assert np.array_equal(found, np.repeat(np.arange(60.0), 200).reshape(60, 200))
        assert [path.name for path in place.iterdir()] == [output.name]
    assert refused > 3


def test_an_output_on_a_read_only_file_system_is_named(mounted, singimpact):
    place = mounted("64k")
    subprocess.run(["mount", "-o", "remount,ro", place], check=True)
    for command in (
        ["verify", "e:yeq"],
        ["fixed-points", "tangency", "--r", "1/2"],
        ["orbit", "--tau", "1", "--v", "1"],
    ):
        told = singimpact(*command, "-o", place / "told.txt")
        assert told.exit_code == 2
        assert told.stderr.startswith("singimpact: output = ")
        assert "cannot be written (Read-only file system): give a place that can" in told.stderr
    for ending in ("npz", "zarr"):
        with ThreadPoolExecutor(1) as pool, pytest.raises(InputError, match="cannot be written"):
            sweep(abs, [1.0], pool, place / f"kept.{ending}")


def _changed(group, name, data):
    del group[name]
    group.create_array(name, data=data)


FOREIGN = {
    "a group of results": lambda group: (group.__delitem__("result"), group.create_group("result")),
    "no results": lambda group: group.__delitem__("result"),
    "fewer results": lambda group: _changed(group, "result", np.zeros(3)),
    "one number": lambda group: _changed(group, "result", np.array(1.0)),
    "truths": lambda group: _changed(group, "result", np.zeros(8, np.bool_)[:7]),
    "chunks of three": lambda group: _changed(group, "chunks", np.ones((2, 3), int)),
    "chunks that are floats": lambda group: _changed(group, "chunks", np.array([[0.0, 8.0]])),
    "chunks that overlap": lambda group: _changed(group, "chunks", np.array([[0, 4], [2, 4]])),
    "chunks before the first case": lambda group: _changed(group, "chunks", np.array([[-4, 4], [0, 4]])),
    "chunks without cases": lambda group: _changed(group, "chunks", np.array([[0, 8], [8, 0]])),
    "short digests": lambda group: _changed(group, "cases", np.zeros((1, 3), np.uint8)),
    "one digest": lambda group: _changed(group, "cases", np.zeros(32, np.uint8)),
    "digests that are floats": lambda group: _changed(group, "cases", np.zeros((1, 32))),
    "no digests": lambda group: group.__delitem__("cases"),
}


@pytest.mark.parametrize("what", FOREIGN)
def test_a_store_of_a_stranger_is_refused(what, tmp_path):
    import zarr

    output = tmp_path / "kept.zarr"
    with ThreadPoolExecutor(1) as pool:
        sweep(abs, np.arange(8.0), pool, output)
        FOREIGN[what](zarr.open_group(output, mode="r+"))
        with pytest.raises(InputError, match="is not a store of results"):
            sweep(abs, np.arange(8.0), pool, output)


@pytest.mark.parametrize("name", ["kept.npz", "kept.npz.part", "kept.zarr", "kept.zarr.part/journal"])
def test_a_pipe_in_the_place_of_results_is_refused(name, tmp_path):
    pipe = tmp_path / name
    pipe.parent.mkdir(exist_ok=True)
    os.mkfifo(pipe)
    with ThreadPoolExecutor(1) as pool, pytest.raises(InputError, match=r"is not a (file|store)"):
        sweep(abs, [1.0], pool, tmp_path / name.partition(".part")[0])
