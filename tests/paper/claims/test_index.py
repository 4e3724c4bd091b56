"""The index of the claims agrees with their files, and serves without building a claim."""

import subprocess
import sys

import pytest

from singimpact.paper import CLAIMS, INDEX, Statement, claims_in
from singimpact.paper.claims import index
from singimpact.paper.claims.sections import SECTIONS

FILES = SECTIONS | index.beyond.BEYOND


@pytest.mark.parametrize("file", FILES)
def test_words_and_encodings_of_a_file_agree(file):
    for name, claim in claims_in(file).items():
        entry = (INDEX | index.BEYOND)[name]
        assert entry.title
        assert entry.printed
        assert set(entry.rests_on) <= set(INDEX | index.BEYOND)
        encoded = FILES[file]("CLAIMS")[name].corrected
        derived = encoded is not None and isinstance(encoded(), Statement)
        assert (encoded is None or derived) == (entry.corrected is None), f"{name}: words of the correction"
        assert claim.corrected is None or claim.corrected().latex


def test_no_claim_stands_in_two_files():
    names = [name for file in FILES.values() for name in file("CLAIMS")]
    assert sorted(names) == sorted(INDEX | index.BEYOND)


def test_order_is_that_of_the_paper():
    assert list(dict.fromkeys(entry.file for entry in INDEX.values())) == list(SECTIONS)
    assert list(CLAIMS) == list(INDEX)
    assert [claim.id for claim in CLAIMS.values()] == list(INDEX)


def test_an_index_that_is_out_of_date_is_named(monkeypatch):
    claims_in.cache_clear()
    monkeypatch.setitem(index.INDEX, "e:yeq", index.Entry("e:yeq", "section3", "another file", "1=1"))
    with pytest.raises(RuntimeError, match=r"section3\.toml and section3\.py do not agree: only one of them has e:yeq"):
        CLAIMS["e:yeq"]
    claims_in.cache_clear()


BUILT = "import sys; print(*sorted(m for m in sys.modules if m.startswith('singimpact.paper.claims.sections.')))"


@pytest.mark.parametrize(
    ("statement", "files"),
    [
        ("import singimpact.paper.claims", []),
        ("import singimpact as si; si.claims; list(si.claims); len(si.claims)", []),
        ("import singimpact as si; si.claims['s3-DG']", ["section2_trials", "section3"]),
    ],
)
def test_what_is_not_asked_for_is_not_built(statement, files, clone):
    command = [sys.executable, "-c", f"{statement}; {BUILT}"]
    found = subprocess.run(command, cwd=clone, capture_output=True, text=True, check=True).stdout.split()
    assert [name.rpartition(".")[2] for name in found] == files


LOADED = "print('sympy' in sys.modules, file=sys.stderr)"
COMMAND = "import sys\nfrom singimpact.cli import main\ntry:\n    main({})\nexcept SystemExit:\n    pass\n"


@pytest.mark.parametrize(
    "program",
    [
        COMMAND.format(["claims", "list"]),
        COMMAND.format(["claims", "graph"]),
        COMMAND.format(["verify", "e:meq"]),
        "import sys, singimpact.paper.sections.errata\n",
    ],
)
def test_kept_verdicts_are_shown_without_sympy(program, clone, tmp_path, monkeypatch):
    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path))  # a test of a changed copy may write over a verdict elsewhere
    for _ in range(2):  # the first run keeps the verdicts
        command = [sys.executable, "-c", program + LOADED]
        found = subprocess.run(command, cwd=clone, capture_output=True, text=True, check=True)
    assert found.stderr.split()[-1] == "False"
