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
    """The folder that the command writes, and claim -> content of its file."""
    folder = tmp_path_factory.mktemp("certificates")
    command = [sys.executable, "-m", "singimpact", "verify", "--certificates", str(folder)]
    subprocess.run(command, check=True, capture_output=True)
    contents = [json.loads(path.read_text()) for path in sorted(folder.glob("*.json"))]
    return folder, {content["id"]: content for content in contents}


@pytest.fixture(scope="module")
def lemmas(emit, tmp_path_factory):
    folder = tmp_path_factory.mktemp("coq")
    shutil.copy(emit.LEMMAS, folder)
    done = compiled(folder, emit.LEMMAS.name)
    assert done.returncode == 0, done.stderr
    return folder


def test_a_folder_of_certificates_becomes_a_project(emit, certificates, tmp_path, capsys):
    folder, contents = certificates
    names = emit.emitted(folder, tmp_path)
    assert names[0] == "certificates.v"
    assert (tmp_path / "_CoqProject").read_text().splitlines() == ["-Q . Claims", *names]
    texts = [(tmp_path / name).read_text() for name in names[1:]]
    certificates_ = [data for content in contents.values() for data in content["certificates"]]
    left_out = [data["says"] for data in certificates_ if data["kind"] not in emit.KINDS]
    assert {data["kind"] for data in certificates_} == {*emit.KINDS, "count"}
    assert len(left_out) == 1
    assert left_out[0] in capsys.readouterr().out
    assert sum(text.count("Qed.") for text in texts) == len(certificates_) - 1


@pytest.mark.parametrize("half", [0, 1])
def test_coq_accepts_all_of_them(half, emit, certificates, lemmas):
    """As modules of one file, since loading the reals takes longer than most proofs."""
    _, contents = certificates
    modules = [
        emit.claim_file(content).replace(emit.HEAD, "") for content in contents.values() if content["certificates"]
    ]
    assert len(modules) == 114
    chosen = list(enumerate(modules))[half::2]
    text = "\n".join([emit.HEAD, *(f"Module C{n}.\n{module}\nEnd C{n}." for n, module in chosen)])
    printed = "".join(f"Print Assumptions C{n}.certificate_0.\n" for n, _ in chosen[:10])
    (lemmas / f"half{half}.v").write_text(f"{text}\n{printed}")
    done = compiled(lemmas, f"half{half}.v")
    assert done.returncode == 0, done.stderr
    assert "certificate" not in done.stdout.partition("Axioms:")[2]


def add_one(polynomial):
    """A polynomial with another constant term, or with one where it had none."""
    return [term for term in polynomial if any(term[0])] + [[[0] * len(polynomial[0][0]), "8/7"]]


def twice(polynomial):
    return [[powers, f"{2 * value}" if isinstance(value, int) else "5/11"] for powers, value in polynomial]


def flip(data):
    data["sign"] = -data["sign"]


def right_side(data):
    data["right"]["outer"][0] = twice(data["right"]["outer"][0]) or [[[0] * len(data["variables"]), 1]]


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


def shape(data):
    """The kind, and of a composition whether it has an order, a relation, and denominators: each has its own proof."""
    if data["kind"] != "composed":
        return data["kind"]
    pairs = [
        pair for side in (data["left"], data["right"]) for pair in (side["outer"], *(q for _, q in side["images"]))
    ]
    polynomial = all(len(below) == 1 and not any(below[0][0]) for _, below in pairs)
    return f"composed, {data['order'] is None}, {data['relation'] is None}, {polynomial}"


def test_forged_ones_are_refused(emit, certificates, lemmas):
    """One of each shape: what passes unchanged, above, fails with another number or sign."""
    _, contents = certificates
    first = {}
    for content in contents.values():
        for data in content["certificates"]:
            if data["kind"] in FORGED:
                first.setdefault(shape(data), (content, data))
    assert len(first) == len(FORGED) + 6  # seven shapes of compositions
    for n, (name, (content, data)) in enumerate(first.items()):
        forged = copy.deepcopy(data)
        FORGED[data["kind"]](forged)
        assert forged != data
        (lemmas / f"forged{n}.v").write_text(emit.claim_file(content | {"certificates": [forged]}))
        done = compiled(lemmas, f"forged{n}.v")
        assert done.returncode != 0, name
        assert "Syntax error" not in done.stderr, name
