"""Object code of the package's own kernels that comes with it, so that only a user's f, g and law are compiled.

It is made by `python derivations/kernels.py` for the platforms below.  The index beside it has the digest of the
kernels' sources and of each file: what was made from other sources, or is damaged, is never loaded.
"""

import hashlib
import json
import platform
import sys
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from singimpact.codegen import object_code
from singimpact.flights import bind, compilers
from singimpact.flights.bind import Emitted
from singimpact.store import tell

FOLDER = Path(__file__).parents[1] / "generated" / "kernels"
INDEX = "index.json"


@dataclass(frozen=True)
class Platform:
    """A kind of machine.

    Parameters
    ----------
    needs : features that its processor must have, as LLVM names them. entries : that are made for it.
    """

    needs: tuple[str, ...] = ()
    entries: tuple[str, ...] = (*Emitted().entries, *Emitted(steps=True).entries)


V3 = ("avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe", "popcnt", "sse4.2")
V4 = (*V3, "avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl")
BATCHES = ("batch_entry",)  # lanes of states: twice as wide registers make it half again as fast, and nothing else
# The first that fits a machine and has an entry is loaded there
PLATFORMS = {
    "linux-x86-64-v4": Platform(V4, BATCHES),
    "linux-x86-64-v3": Platform(V3),
    "win32-x86-64-v4": Platform(V4, BATCHES),
    "win32-x86-64-v3": Platform(V3),
    "linux-aarch64": Platform(),
    "darwin-aarch64": Platform(),
}
NAMES = {"x86_64": "x86-64", "amd64": "x86-64", "aarch64": "aarch64", "arm64": "aarch64"}


def shipped_code(entry: str) -> bytes | None:
    """The object code of an entry of the kernels for this machine; None, with its reason said once, if there is none.

    Examples
    --------
    >>> shipped_code("no_entry") is None
    True
    """
    index = _index()
    for name in platforms_here():
        if entry in PLATFORMS[name].entries and (digest := index.get(f"{entry}.{name}")):
            content = _unpacked(FOLDER / f"{entry}.{name}.xz")
            if content is not None and hashlib.sha256(content).hexdigest() == digest:
                return content
            tell(f"{entry}.{name}.xz of the package is damaged, or Python has no lzma: kernels are compiled")
            return None
    return None


@lru_cache(maxsize=1)
def platforms_here() -> tuple[str, ...]:
    """Platforms whose object code runs on this machine, the fastest first."""
    kind = NAMES.get(platform.machine().lower())
    if kind is None or sys.maxsize < 2**32:
        return ()
    import llvmlite.binding as llvm

    features = llvm.get_host_cpu_features()
    return tuple(
        name
        for name, target in PLATFORMS.items()
        if name.startswith(f"{sys.platform}-{kind}") and all(features.get(need) for need in target.needs)
    )


@lru_cache(maxsize=1)
def _index() -> dict[str, str]:
    """Digests of object code by file; empty where it is of other sources, or settings of numba ask for other code."""
    if object_code.settings_of_numba():
        return {}
    try:
        index: dict[str, Any] = json.loads((FOLDER / INDEX).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return dict(index["objects"]) if index.get("sources") == sources_digest() else {}


def sources() -> list[bytes]:
    """The bytes of every file that object code of the kernels is made from, with the ends of lines of one system."""
    paths = (Path(str(module.__file__)) for module in (*bind.MODULES, bind, compilers, object_code))
    return [path.read_bytes().replace(b"\r\n", b"\n") for path in paths]


@lru_cache(maxsize=1)
def sources_digest() -> str:
    """The digest of all that the object code of the kernels is made from."""
    return hashlib.sha256(b"".join(hashlib.sha256(source).digest() for source in sources())).hexdigest()


def _unpacked(file: Path) -> bytes | None:
    try:
        from lzma import LZMAError, decompress
    except ImportError:  # Python may have been built without it
        return None
    try:
        return decompress(file.read_bytes())
    except (OSError, LZMAError):
        return None


def why_not() -> str:
    """Why the kernels are compiled on this machine, for a line that says so."""
    if names := object_code.settings_of_numba():
        return f"{names[0][0]} asks for code of its own"
    if not platforms_here():
        return f"none comes with the package for {sys.platform} on this processor ({platform.machine()})"
    return "that of the package is not of its sources" if not _index() else "that of the package cannot be read"
