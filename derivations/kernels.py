"""Write the object code of the kernels that comes with the package: `python derivations/kernels.py`.

It takes about three minutes of CPU, and is needed after every change of the kernels or of what compiles them: until
then they are compiled on each machine once more.
"""

from __future__ import annotations

import hashlib
import json
import lzma
import os
import re
import subprocess
import sys
import tempfile
from collections import Counter
from importlib.metadata import version
from pathlib import Path

import llvmlite.binding as llvm

from singimpact.codegen.object_code import emitted, machine_of
from singimpact.flights.bind import Emitted
from singimpact.flights.compilers import KernelCompiler
from singimpact.flights.shipped import FOLDER, INDEX, PLATFORMS, sources_digest
from singimpact.store import folder, written

WIDE = "znver5"  # LLVM gives x86-64-v4 itself registers of half the width
TARGETS = {
    "linux-x86-64-v4": ("x86_64-unknown-linux-gnu", "x86-64-v4", WIDE),
    "linux-x86-64-v3": ("x86_64-unknown-linux-gnu", "x86-64-v3", "x86-64-v3"),
    "win32-x86-64-v4": ("x86_64-pc-windows-msvc", "x86-64-v4", WIDE),
    "win32-x86-64-v3": ("x86_64-pc-windows-msvc", "x86-64-v3", "x86-64-v3"),
    "linux-aarch64": ("aarch64-unknown-linux-gnu", "generic", "x86-64-v2"),
    "darwin-aarch64": ("arm64-apple-darwin", "apple-m1", "x86-64-v2"),
}
"""Names of each platform and its processor to LLVM, and a processor of this machine's kind with registers as wide:
numba arranges loops over states for it, and a loop that is arranged for wider registers takes a sixth longer."""
INTO = "--into"


def main() -> None:
    """Write them all; what was there before is removed."""
    contents: dict[str, bytes] = {}
    widths: dict[str, int] = {}
    for registers in sorted({registers for _, _, registers in TARGETS.values()}):
        with tempfile.TemporaryDirectory() as place:
            settings = {"NUMBA_CPU_NAME": registers, "NUMBA_CPU_FEATURES": ""}
            subprocess.run([sys.executable, __file__, INTO, place, registers], env=os.environ | settings, check=True)
            found = {path.name: path.read_bytes() for path in Path(place).iterdir()}
        widths[registers] = int(found.pop("width"))
        contents |= found
    folder(FOLDER)
    for old in FOLDER.glob("*.xz"):
        old.unlink()
    files = {f"{name}.xz": lzma.compress(content, preset=9 | lzma.PRESET_EXTREME) for name, content in contents.items()}
    files[INDEX] = (json.dumps(index_of(contents, widths), indent=1) + "\n").encode()
    for name, content in files.items():
        with written(FOLDER / name) as draft:
            draft.write_bytes(content)
    print(f"{len(contents)} files of object code, {sum(map(len, files.values()))} bytes")


def index_of(contents: dict[str, bytes], widths: dict[str, int]) -> dict[str, object]:
    """The index of object code by `entry.platform`: digests of the sources and of each file, and what made them.

    Parameters
    ----------
    widths : doubles of a vector in batches, by the third name of `TARGETS`.
    """
    return {
        "sources": sources_digest(),
        "made with": {name: version(name) for name in ("numba", "llvmlite")},
        "widths": widths,
        "objects": {name: hashlib.sha256(content).hexdigest() for name, content in sorted(contents.items())},
    }


def into(place: Path, registers: str) -> None:
    """Object code for platforms with such registers, and the width of its loops, as files of a folder."""
    targets = {name: target for name, target in TARGETS.items() if target[2] == registers}
    made_from = texts({entry for name in targets for entry in PLATFORMS[name].entries})
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    for name, (triple, processor, _) in targets.items():
        for entry in PLATFORMS[name].entries:
            code = emitted(made_from[entry], entry, machine_of(triple, processor, ""))
            (place / f"{entry}.{name}").write_bytes(code)
    (place / "width").write_text(str(width(made_from["batch_entry"])))


def texts(wanted: set[str]) -> dict[str, str]:
    """Texts of LLVM by entry, for the processor that NUMBA_CPU_NAME names; always the same in a new process."""
    return {
        entry: compiler.text(entry)
        for steps in (False, True)
        if wanted & {*Emitted(steps=steps).entries}
        for compiler in (KernelCompiler(steps),)
        for entry in Emitted(steps=steps).entries
        if entry in wanted
    }


def width(text: str) -> int:
    """How many doubles most vectors of a text of LLVM have."""
    found = Counter(re.findall(r"<(\d+) x double>", text)).most_common(1)
    return int(found[0][0]) if found else 1


if __name__ == "__main__":
    if sys.argv[1:2] == [INTO]:
        into(Path(sys.argv[2]), sys.argv[3])
    else:
        main()
