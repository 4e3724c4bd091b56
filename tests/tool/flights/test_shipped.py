"""Object code of the kernels that comes with the package: of these sources, undamaged, and never another's."""

from __future__ import annotations

import hashlib
import json
import lzma
import platform
import subprocess
import sys

import numpy as np
import pytest

import singimpact as si
from singimpact.codegen import emitted, loaded
from singimpact.flights import (
    PLATFORMS,
    Emitted,
    KernelCompiler,
    machine_of,
    platforms_here,
    shipped_code,
    sources_digest,
    why_not,
)

SHIPPED = sys.modules[shipped_code.__module__]
ENTRIES = (*Emitted().entries, *Emitted(steps=True).entries)
CALLED = {"abort", "atan", "cos", "cosh", "exp", "expm1", "hypot", "log", "log1p", "memcpy", "memmove", "memset", "pow",
          "sin", "sincos", "sinh", "tan", "tanh"}  # fmt: skip
"""Functions of the system that object code may call; of Apple's with an underscore before."""


@pytest.fixture
def index():
    return json.loads((SHIPPED.FOLDER / "index.json").read_text())


@pytest.fixture
def asked_anew():
    """What is remembered of the index and the machine is forgotten, before and after."""
    remembered = (SHIPPED._index, platforms_here, sources_digest)
    for each in remembered:
        each.cache_clear()
    yield
    for each in remembered:
        each.cache_clear()


def test_it_is_of_these_sources(index):
    assert index["sources"] == sources_digest(), "the kernels were changed: python derivations/kernels.py"


def test_every_platform_has_every_entry_and_each_file_has_its_digest(index):
    wanted = {f"{entry}.{name}" for name, target in PLATFORMS.items() for entry in target.entries}
    assert set(index["objects"]) == wanted
    assert {path.name for path in SHIPPED.FOLDER.iterdir()} == {f"{name}.xz" for name in wanted} | {"index.json"}
    for name, digest in index["objects"].items():
        content = lzma.decompress((SHIPPED.FOLDER / f"{name}.xz").read_bytes())
        assert hashlib.sha256(content).hexdigest() == digest


def test_loops_over_states_are_made_for_registers_of_each_platform(index):
    """Counted in numba's texts: registers of 16, 32 and 64 bytes. Loops made for 64 take a sixth longer in 32."""
    assert index["widths"] == {"x86-64-v2": 2, "x86-64-v3": 4, "znver5": 8}


STARTS = {"linux-x86": b"\x7fELF\x02\x01", "linux-aarch64": b"\x7fELF\x02\x01", "win32": b"\x64\x86",
          "darwin": b"\xcf\xfa\xed\xfe"}  # fmt: skip


def test_each_file_is_object_code_of_its_platform(index):
    for name in index["objects"]:
        content = lzma.decompress((SHIPPED.FOLDER / f"{name}.xz").read_bytes())
        (start,) = [start for kind, start in STARTS.items() if name.partition(".")[2].startswith(kind)]
        assert content.startswith(start), name
        if start.startswith(b"\x7fELF"):
            assert int.from_bytes(content[18:20], "little") == (183 if "aarch64" in name else 62)


@pytest.mark.parametrize("entry", ENTRIES)
def test_it_calls_the_system_s_mathematics_and_nothing_else(entry):
    """Of the platforms whose format is read here; the others are made from the same text."""
    names = [name for name in PLATFORMS if name.startswith("linux") and entry in PLATFORMS[name].entries]
    assert names
    for name in names:
        content = lzma.decompress((SHIPPED.FOLDER / f"{entry}.{name}.xz").read_bytes())
        defined, undefined = symbols(content)
        assert entry in defined
        assert undefined <= CALLED


def symbols(content):
    """Global names that an ELF file defines, and those that it needs."""
    begin = int.from_bytes(content[40:48], "little")
    size, count = (int.from_bytes(content[at : at + 2], "little") for at in (58, 60))
    sections = [content[begin + size * at : begin + size * (at + 1)] for at in range(count)]
    whole = [[int.from_bytes(part[at : at + 8], "little") for at in (24, 32)] for part in sections]
    defined, undefined = set(), set()
    for section in sections:
        if int.from_bytes(section[4:8], "little") != 2:  # the table of symbols
            continue
        offset, length = (int.from_bytes(section[at : at + 8], "little") for at in (24, 32))
        texts = whole[int.from_bytes(section[40:44], "little")][0]
        for at in range(offset, offset + length, 24):
            name, info, home = int.from_bytes(content[at : at + 4], "little"), content[at + 4], content[at + 6 : at + 8]
            text = content[texts + name : content.index(b"\0", texts + name)].decode()
            if info >> 4 and text:
                (undefined if home == b"\0\0" else defined).add(text)
    return defined, undefined


@pytest.mark.usefixtures("asked_anew")
def test_code_of_other_sources_is_not_loaded(monkeypatch):
    assert shipped_code("linear_entry") is not None
    SHIPPED._index.cache_clear()
    monkeypatch.setattr(SHIPPED, "sources_digest", lambda: "0" * 64)
    assert shipped_code("linear_entry") is None
    assert "of its sources" in why_not()


@pytest.mark.usefixtures("asked_anew")
def test_damaged_code_is_named_and_not_loaded(tmp_path, monkeypatch, capsys):
    name = f"linear_entry.{platforms_here()[-1]}.xz"
    for damage in (lambda content: content[:-40], lambda _: lzma.compress(b"something else"), lambda _: b""):
        content = damage((SHIPPED.FOLDER / name).read_bytes())
        (tmp_path / "index.json").write_bytes((SHIPPED.FOLDER / "index.json").read_bytes())
        (tmp_path / name).write_bytes(content)
        with monkeypatch.context() as patch:
            patch.setattr(SHIPPED, "FOLDER", tmp_path)
            SHIPPED._index.cache_clear()
            assert shipped_code("linear_entry") is None
        assert name in capsys.readouterr().err


@pytest.mark.usefixtures("asked_anew")
@pytest.mark.parametrize(("place", "kind"), [("linux", "riscv64"), ("sunos5", "x86_64")])
def test_another_platform_compiles_and_says_why(place, kind, monkeypatch):
    monkeypatch.setattr(platform, "machine", lambda: kind)
    monkeypatch.setattr(sys, "platform", place)
    assert platforms_here() == ()
    assert shipped_code("linear_entry") is None
    assert place in why_not()


@pytest.mark.usefixtures("asked_anew")
def test_settings_of_numba_ask_for_code_of_their_own(monkeypatch):
    monkeypatch.setenv("NUMBA_CPU_NAME", "generic")
    assert shipped_code("linear_entry") is None
    assert "NUMBA_CPU_NAME" in why_not()


def test_a_python_without_lzma_compiles_and_says_why(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "lzma", None)
    assert shipped_code("linear_entry") is None
    assert "lzma" in capsys.readouterr().err


def test_a_processor_without_a_feature_gets_no_code_that_needs_it(monkeypatch):
    import llvmlite.binding as llvm

    features = dict(llvm.get_host_cpu_features())
    monkeypatch.setattr(llvm, "get_host_cpu_features", lambda: {**features, "avx512f": False})
    platforms_here.cache_clear()
    try:
        assert not [name for name in platforms_here() if name.endswith("v4")]
        monkeypatch.setattr(llvm, "get_host_cpu_features", dict)
        platforms_here.cache_clear()
        assert not [name for name in platforms_here() if PLATFORMS[name].needs]
    finally:
        platforms_here.cache_clear()


def states(count=2000):
    draw = np.random.default_rng(3)
    return draw.uniform(-5, 5, count), 10 ** draw.uniform(-4, 0.3, count)


@pytest.mark.slow
@pytest.mark.parametrize("steps", [False, True])
def test_compiled_on_this_machine_it_has_the_same_results(steps):
    """Bit by bit, on 2000 states, whatever the process has compiled before."""
    compiler = KernelCompiler(steps)
    model = si.ImpactOscillator("x + x**3/3", "cos(2*t)", 0, "0.8") if steps else si.linear("2.8", 0, "0.8")
    machine = machine_of(Emitted(steps=steps))
    tau, v = states()
    before = dict(machine._entries)
    machine._entries.clear()  # what the calls load is what they need
    machine._looked.clear()
    first, last = model.impact_map(tau, v), model.iterate(tau[:200], v[:200], 20)
    needed = sorted(machine._entries)
    assert needed
    try:
        for entry in needed:
            machine._entries[entry] = loaded(emitted(compiler.text(entry), entry), entry, 8)
        again, end = model.impact_map(tau, v), model.iterate(tau[:200], v[:200], 20)
    finally:
        machine._entries.update(before)
    for one, other in ((first, again), (last, end)):
        assert np.array_equal(one.tau, other.tau, equal_nan=True)
        assert np.array_equal(one.v, other.v, equal_nan=True)


@pytest.mark.slow
def test_every_level_of_a_platform_has_the_same_bits():
    """A batch in registers of 32 and of 64 bytes, from one wall and between two."""
    models = si.linear("2.8", 0, "0.8"), si.linear("2.8", "0.3", "0.8", upper=("1.3", "0.7"))
    machine = machine_of(Emitted())
    tau, v = states()
    before, ends = dict(machine._entries), []
    try:
        for name in platforms_here():
            content = lzma.decompress((SHIPPED.FOLDER / f"batch_entry.{name}.xz").read_bytes())
            machine._entries["batch_entry"] = loaded(content, "batch_entry", 8)
            ends.append([model.iterate(tau, v, 20) for model in models])
    finally:
        machine._entries.clear()
        machine._entries.update(before)
    for end in ends[1:]:
        for one, other in zip(end, ends[0], strict=True):
            assert np.array_equal(one.tau, other.tau, equal_nan=True)
            assert np.array_equal(one.v, other.v, equal_nan=True)


MOST = 2_000_000


def test_the_repository_grows_by_less_than_two_megabytes_a_release(clone):
    """All versions of these files since the last release."""

    def git(*words, given=None):
        done = subprocess.run(["git", "-C", clone, *words], capture_output=True, text=True, input=given, check=False)
        if done.returncode:
            pytest.skip(f"the history of the clone is needed: git {words[0]} says {done.stderr.strip()}")
        return done.stdout

    # a release is the commit that wrote the version of the package
    (released,) = git("log", "-1", "--format=%H", "-G^__version__ = ", "--", "singimpact/__init__.py").split()
    listed = git("rev-list", "--objects", f"{released}..HEAD", "--", "singimpact/generated/kernels")
    sizes = git("cat-file", "--batch-check=%(objecttype) %(objectsize)", given="".join(
        line.partition(" ")[0] + "\n" for line in listed.splitlines()
    ))  # fmt: skip
    blobs = [int(line.split()[1]) for line in sizes.splitlines() if line.startswith("blob")]
    assert sum(blobs) < MOST, "rewrite the commits that are not released, so that one has the object code"
