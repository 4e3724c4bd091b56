"""Kept sections are those that are derived, and are read without sympy."""

import subprocess
import sys

from singimpact import cache
from singimpact.paper import kept_sections
from singimpact.paper.sections import derivation_sections

READ = """
import sys
from singimpact.paper.sections.stored_sections import kept_sections
print(len(kept_sections(["swan"])[1].steps), "sympy" in sys.modules)
"""


def test_kept_sections_are_those_derived_and_need_no_sympy(monkeypatch, tmp_path):
    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path))
    made = kept_sections(["swan"])
    assert made == derivation_sections.sections(["swan"])
    monkeypatch.setattr(derivation_sections, "sections", None)
    assert kept_sections(["swan"]) == made
    found = subprocess.run([sys.executable, "-c", READ], capture_output=True, text=True, check=True)
    assert found.stdout.split() == [str(len(made[1].steps)), "False"]


def test_sections_of_another_source_are_derived_again(monkeypatch, tmp_path):
    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path))
    kept_sections(["swan"])
    monkeypatch.setattr(cache, "source_digest", lambda *_: "another source")
    monkeypatch.setattr(derivation_sections, "sections", lambda _: [])
    assert kept_sections(["swan"]) == []


def test_a_damaged_entry_is_derived_again(monkeypatch, tmp_path, capsys):
    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path))
    made = kept_sections(["swan"])
    (entry,) = (tmp_path / "derivations").iterdir()
    entry.write_bytes(entry.read_bytes().replace(b"swan", b"duck"))
    assert kept_sections(["swan"]) == made
    assert "damaged" in capsys.readouterr().err
