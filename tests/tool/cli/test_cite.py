"""`singimpact cite` and the version, from one place."""

import json
import re

from click.testing import CliRunner

import singimpact
from singimpact.cli.claim_commands import cite_command


def test_what_to_cite():
    text = CliRunner().invoke(cite_command, []).output
    assert singimpact.__version__ in text
    assert "Chillingworth" in text
    assert json.loads(CliRunner().invoke(cite_command, ["--json"]).output)["bibtex"].startswith("@software")


def test_citation_file_has_this_version(clone):
    (found,) = re.findall(r"^version: (.*)$", (clone / "CITATION.cff").read_text(), re.MULTILINE)
    assert found == singimpact.__version__
