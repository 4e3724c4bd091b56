"""Coq accepts the certificates of claims as `derivations/certificates/emit.py` writes them, and no forged ones."""

import copy
import importlib.util
import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = [pytest.mark.slow, pytest.mark.skipif(shutil.which("coqc") is None, reason="needs coqc")]
EMIT = Path(__file__).parents[3] / "derivations" / "certificates" / "emit.py"
CLAIMS = ["s4b-M", "s5-positive", "t:t2-eigenvalue-limit", "s4-Dh-form", "s3-slope-r", "s4-root-places", "t:t2-fixed",
          "s4b-rays"]  # fmt: skip


@pytest.fixture(scope="module")
def emit():
    spec = importlib.util.spec_from_file_location("emit", EMIT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def compiled(folder, name):
    return subprocess.run(["coqc", "-Q", ".", "Claims", name], cwd=folder, capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def certificates(tmp_path_factory):
    """Claim -> its file, as the command writes it."""
    folder = tmp_path_factory.mktemp("certificates")
    command = [sys.executable, "-m", "singimpact", "verify", *CLAIMS, "--certificates", str(folder)]
    subprocess.run(command, check=True, capture_output=True)
    contents = [json.loads(path.read_text()) for path in folder.glob("*.json")]
    return folder, {content["id"]: content for content in contents if content["id"] in CLAIMS}


@pytest.fixture(scope="module")
def lemmas(emit, tmp_path_factory):
    folder = tmp_path_factory.mktemp("coq")
    shutil.copy(emit.LEMMAS, folder)
    done = compiled(folder, emit.LEMMAS.name)
    assert done.returncode == 0, done.stderr
    return folder


def test_every_kind_but_one_is_among_them(emit, certificates):
    _, contents = certificates
    kinds = {data["kind"] for content in contents.values() for data in content["certificates"]}
    assert kinds == set(emit.KINDS)


def test_a_folder_of_certificates_becomes_a_project(emit, certificates, tmp_path):
    folder, contents = certificates
    names = emit.emitted(folder, tmp_path)
    assert names[0] == "certificates.v"
    assert len(names) > len(contents)  # what they rest on has certificates too
    assert (tmp_path / "_CoqProject").read_text().splitlines() == ["-Q . Claims", *names]
    assert all((tmp_path / name).read_text().count("Qed.") >= 1 for name in names)


@pytest.mark.parametrize("name", CLAIMS)
def test_coq_accepts_them(name, emit, certificates, lemmas):
    _, contents = certificates
    file = f"{''.join(filter(str.isalnum, name))}.v"
    (lemmas / file).write_text(emit.claim_file(contents[name]) + "Print Assumptions certificate_0.\n")
    done = compiled(lemmas, file)
    assert done.returncode == 0, done.stderr
    assert "certificate" not in done.stdout.partition("Axioms:")[2]


def add_one(polynomial):
    """A polynomial with another constant term, or with one where it had none."""
    length = len(polynomial[0][0]) if polynomial else 0
    return [term for term in polynomial if any(term[0])] + [[[0] * length, "8/7"]]


def twice(polynomial):
    return [[powers, f"{2 * value}" if isinstance(value, int) else "5/11"] for powers, value in polynomial]


def flip(data):
    data["sign"] = -data["sign"]


def right_side(data):
    data["right"]["outer"][0] = twice(data["right"]["outer"][0])


FORGED = {
    "positive": flip,
    "definite": flip,
    "identity": lambda data: data["left"].__setitem__(0, twice(data["left"][0])),
    "composed": right_side,
    "value": lambda data: data.update(value=[add_one(data["numerator"]), [[[0] * len(data["variables"]), 1]]]),
    "chain": lambda data: data.update(polynomial=twice(data["polynomial"][:1]) + data["polynomial"][1:]),
    "motion": lambda data: data.update(height=twice(data["height"])),
    "flight": lambda data: data.update(rise=twice(data["rise"])),
}


@pytest.mark.parametrize("kind", FORGED)
def test_a_forged_one_is_refused(kind, emit, certificates, lemmas):
    _, contents = certificates
    content, data = next((c, d) for c in contents.values() for d in c["certificates"] if d["kind"] == kind)
    forged = copy.deepcopy(data)
    FORGED[kind](forged)
    assert forged != data
    file = f"forged_{kind}.v"
    (lemmas / file).write_text(emit.claim_file(content | {"certificates": [forged]}))
    done = compiled(lemmas, file)
    assert done.returncode != 0
    assert "Syntax error" not in done.stderr
