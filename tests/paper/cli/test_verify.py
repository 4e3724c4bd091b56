"""`singimpact verify`: the table at any width, the JSON, the exit codes, the misprints."""

import json
import shlex
import subprocess
import sys

import pytest
from fakes import CLAIMS, VERDICTS, FakeVerdict, claims_room

from singimpact.paper import VerdictTable, verify


@pytest.fixture(autouse=True)
def room(monkeypatch):
    monkeypatch.setitem(sys.modules, "singimpact.paper.claims", claims_room())


TABLE = VerdictTable(CLAIMS, list(VERDICTS.values()))


def test_one_screen(singimpact, tmp_path):
    lines = singimpact("verify").stdout.splitlines()
    assert lines[0].startswith("3 claims: 2 proved, 1 corrected; ")
    assert "  p:odd  for a = −b/2, read a = b/2" in lines
    assert "verify --all" in lines[-2]
    program, *asked = shlex.split(lines[-1].partition(": ")[2])
    assert program == "singimpact"
    assert asked[0] == "orbit"
    assert singimpact(*asked[:-1], tmp_path / "orbit.png").exit_code == 0
    assert (tmp_path / "orbit.png").stat().st_size > 10_000


def test_what_ends_in_error_is_on_the_screen():
    failed = [*VERDICTS.values(), FakeVerdict("e:new", "error", "error", evidence="timed out after 10 s")]
    assert "  e:new  timed out after 10 s" in VerdictTable([*CLAIMS, CLAIMS[0]], failed).screen().splitlines()


def test_a_page_with_formulas(singimpact, tmp_path):
    assert singimpact("verify", "-o", tmp_path / "verify.html").exit_code == 0
    page = (tmp_path / "verify.html").read_text()
    assert page.count("<math ") == 4
    assert "<mfrac>" in page


def test_all_claims(singimpact):
    result = singimpact("verify", "--all")
    assert result.exit_code == 0
    assert [line.split()[0] for line in result.stdout.splitlines()[:4]] == ["id", "e:meq", "e:qdef", "p:odd"]
    assert "Misprinted: 1" in result.stdout
    assert result.stderr == ""


def test_named_claims(singimpact):
    assert "p:odd" not in singimpact("verify", "e:meq", "e:qdef").stdout


def test_json_alone_on_standard_output(singimpact):
    claims = json.loads(singimpact("verify", "--json").stdout)["claims"]
    assert [claim["verdict"] for claim in claims] == ["proved", "proved", "corrected"]
    assert claims[2]["witness"] == {"a": "1", "b": 2}


def test_error_is_exit_code_one(singimpact, monkeypatch):
    failed = VERDICTS | {"e:meq": FakeVerdict("e:meq", "error", "error", evidence="timed out after 10 s")}
    monkeypatch.setitem(sys.modules, "singimpact.paper.claims", claims_room(failed))
    result = singimpact("verify")
    assert result.exit_code == 1
    assert "timed out after 10 s" in result.stdout


def test_file_instead_of_standard_output(singimpact, tmp_path):
    result = singimpact("verify", "--json", "-o", tmp_path / "verdicts.json")
    assert result.stdout == ""
    assert len(json.loads((tmp_path / "verdicts.json").read_text())["claims"]) == 3


def test_a_full_disk_is_one_line(singimpact, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("singimpact.cli.claim_commands.emit", full)
    result = singimpact("verify")
    assert result.exit_code == 1
    assert result.stderr == "singimpact: the system refused: [Errno 28] No space left on device\n"


@pytest.mark.parametrize("width", [20, 40, 60, 80, 96, 120, 200])
def test_table_fits_and_loses_no_word(width):
    text = TABLE.text(width)
    assert max(map(len, text.splitlines())) <= max(width, 40)
    for claim in CLAIMS:
        assert set(claim.title.split()) <= set(text.split())


def test_pipe_has_one_line_a_claim():
    lines = TABLE.text().splitlines()
    assert "linear in r" in lines[1]
    assert lines[1].endswith("0.12") or lines[1].endswith("0.13")


def test_worth_of_a_verdict_is_told():
    assert "proved (supported)" in TABLE.text()
    assert "corrected (proved)" in TABLE.text()


def test_misprint_has_printed_corrected_and_witness():
    text = TABLE.text()
    assert r"printed    a = -\frac{b}{2}" in text
    assert r"corrected  a = \frac{b}{2}   [proved]" in text
    assert "witness    a = 1, b = 2" in text


def test_twin_in_python():
    found = verify("e:meq")
    assert [verdict.id for verdict in found] == ["e:meq"]
    assert found.exit_code == 0
    assert str(found).startswith("id ")


def test_progress_line_only_on_a_terminal(clone):
    show = "from singimpact.progress import ProgressLine\nwith ProgressLine(0) as line: line.show(1, 2, 'e:meq')"
    piped = subprocess.run([sys.executable, "-c", show], cwd=clone, capture_output=True, text=True, check=True)
    assert piped.stdout + piped.stderr == ""


@pytest.mark.skipif(sys.platform == "win32", reason="no pseudo-terminals")
def test_progress_line_on_a_terminal(clone):
    import os
    import pty

    show = "from singimpact.progress import ProgressLine\nwith ProgressLine(0) as line: line.show(1, 2, 'e:meq')"
    reader, writer = pty.openpty()
    environment = os.environ | {"TERM": "xterm", "COLUMNS": "80"}
    subprocess.run([sys.executable, "-c", show], cwd=clone, stderr=writer, check=True, env=environment)
    os.close(writer)
    told = os.read(reader, 65536).decode()
    os.close(reader)
    assert "e:meq" in told
    assert "1/2" in told
