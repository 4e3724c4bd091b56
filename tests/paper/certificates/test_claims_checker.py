"""The files of `verify --certificates`: accepted by the program that stands alone, and refused when changed."""

import ast
import json
import random
import subprocess
import sys
from pathlib import Path

import false_certificates as false
import pytest
from false_certificates import accepts
from tampering import bumped, changed, leaves

from singimpact.certificates import claims_checker
from singimpact.inputs import InputError
from singimpact.paper import verify

PROGRAM = Path(claims_checker.__file__)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("certificates")
    verify().save_certificates(place)
    return place


def judged(*paths):
    command = [sys.executable, "-I", str(PROGRAM), *map(str, paths)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def all_of(folder):
    found = [json.loads(path.read_text(encoding="utf-8")) for path in sorted(folder.iterdir())]
    texts = dict.fromkeys(json.dumps(part) for claim in found for part in claim["certificates"])
    return [json.loads(text) for text in texts]


@pytest.mark.slow
def test_every_file_holds_in_a_process_of_its_own(folder):
    paths = sorted(folder.iterdir())
    done = judged(*paths)
    assert done.returncode == 0, done.stdout
    assert len(done.stdout.splitlines()) == len(paths) == 147
    assert sum("certificates hold" in line for line in done.stdout.splitlines()) > 100


def test_a_file_says_what_its_claim_is(folder):
    told = json.loads((folder / "s3-dvdt.json").read_text(encoding="utf-8"))
    assert told["schema"] == claims_checker.SCHEMA
    assert (told["id"], told["verdict"], told["corrected_kind"]) == ("s3-dvdt", "corrected", "proved")
    assert {"printed", "corrected", "rests_on", "effective", "digest"} <= set(told)


def test_a_changed_file_is_refused(folder, tmp_path):
    told = json.loads((folder / "e_acc.json").read_text(encoding="utf-8"))
    (tmp_path / "e_yeq.json").write_text((folder / "e_yeq.json").read_text(encoding="utf-8"))  # it rests on that
    damaged = changed(told, ("certificates", 0, "order"), bumped)
    (tmp_path / "one.json").write_text(json.dumps(damaged))
    renewed = damaged | {"digest": claims_checker.digest_of(damaged)}
    (tmp_path / "two.json").write_text(json.dumps(renewed))
    (tmp_path / "three.json").write_text("{")
    done = judged(*(tmp_path / f"{name}.json" for name in ("one", "two", "three")))
    assert done.returncode == 1
    assert [line.partition(": ")[2].split(":")[0] for line in done.stdout.splitlines()] == ["refused"] * 3
    assert "the file was changed" in done.stdout.splitlines()[0]
    assert "certificate 0" in done.stdout.splitlines()[1]


@pytest.mark.slow
def test_each_changed_number_is_refused(folder):
    """With the digest renewed: the certificate itself is refused."""
    rng = random.Random(20)
    for certificate in all_of(folder):
        places = list(leaves(certificate))
        for path in rng.sample(places, min(8, len(places))):
            assert not accepts(changed(certificate, path, bumped)), (certificate["says"], path)


def test_another_sentence_is_refused(folder):
    for certificate in all_of(folder)[:40]:
        assert not accepts(certificate | {"says": certificate["says"] + " "})


@pytest.mark.parametrize("name", false.EVERY)
def test_a_false_certificate_is_refused(name):
    _, _, certificate = false.EVERY[name]
    assert not accepts(json.loads(json.dumps(certificate)))


def test_a_certificate_without_its_sentence_is_refused_in_a_file(folder, tmp_path):
    told = json.loads((folder / "e_yeq.json").read_text(encoding="utf-8"))
    del told["certificates"][0]["says"]
    (tmp_path / "e_yeq.json").write_text(json.dumps(told | {"digest": claims_checker.digest_of(told)}))
    assert "refused: certificate 0: it says nothing" in judged(tmp_path / "e_yeq.json").stdout


def test_every_proved_claim_has_a_certificate_of_its_own(folder):
    for path in folder.iterdir():
        told = json.loads(path.read_text(encoding="utf-8"))
        proved = (told["corrected_kind"] or told["verdict"]) in ("proved", "proved modulo")
        assert told["certificates"] or not proved, told["id"]


def test_the_list_has_the_words_of_each_claim(folder):
    stated = json.loads(claims_checker.STATED.read_text(encoding="utf-8"))["claims"]
    for path in folder.iterdir():
        told = json.loads(path.read_text(encoding="utf-8"))
        assert stated[told["id"]] == claims_checker.statement_of(told)


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"printed": "1=2"}, "are not those of the list"),
        ({"title": "1 is 2"}, "are not those of the list"),
        ({"verdict": "supported", "effective": "supported"}, "are not those of the list"),
        ({"id": "one-is-two"}, "is no claim of the list"),
        ({"corrected": "1=2"}, "does not go with the verdict"),
        ({"proves": "anything"}, "is unknown"),
        ({"rests_on": {}, "certificates": []}, "without a certificate and without other files"),
        ({"rests_on": {"e:yeq": "0" * 64}}, "is another one"),
        ({"rests_on": {"e:none": "0" * 64}}, "No such file"),
        ({"rests_on": {"../e:yeq": "0" * 64}}, "is no claim"),
    ],
)
def test_words_that_are_not_those_of_the_claim_are_refused(changes, why, folder, tmp_path):
    """With a digest made anew, and the file that it rests on beside it."""
    told = json.loads((folder / "e_acc.json").read_text(encoding="utf-8")) | changes
    (tmp_path / "e_yeq.json").write_text((folder / "e_yeq.json").read_text(encoding="utf-8"))
    (tmp_path / "e_acc.json").write_text(json.dumps(told | {"digest": claims_checker.digest_of(told)}))
    assert judged(tmp_path / "e_yeq.json").returncode == 0
    done = judged(tmp_path / "e_acc.json", tmp_path / "e_yeq.json")
    assert done.returncode == 1
    assert why in done.stdout.splitlines()[0]
    assert "refused" not in done.stdout.splitlines()[1]


@pytest.mark.parametrize("text", ["[]", "null", "[" * 5000 + "]" * 5000, '{"schema": NaN}', "\xff", "9" * 10**5])
def test_what_is_no_claim_is_refused_in_one_line(text, tmp_path):
    (tmp_path / "claim.json").write_text(text, encoding="latin-1")
    done = judged(tmp_path / "claim.json")
    assert (done.returncode, done.stderr, done.stdout.count("\n")) == (1, "", 1)


ONE, X, TWO_X = [[[0], 1]], [[[1], 1]], [[[1], 2]]


@pytest.mark.parametrize(
    "certificate",
    [
        {"kind": "identity", "variables": ["x"], "left": [TWO_X, [[[0], 2]]], "right": [X, ONE], "relation": None,
         "says": "(2*x)/(2) = x"},
        {"kind": "composed", "variables": ["x"], "weights": [0], "order": None, "relation": None,
         "left": {"outer": [TWO_X, [[[0], 2]]], "images": [[0, [X, ONE]]]}, "right": {"outer": [X, ONE], "images": []},
         "says": "[(2*x)/(2) at x = x] = x"},
    ],
)  # fmt: skip
def test_a_statement_that_says_nothing_is_refused(certificate):
    with pytest.raises(claims_checker.Refused, match="X = X"):
        claims_checker.check_certificate(certificate)


def test_the_program_stands_alone():
    beside = PROGRAM.with_name("claims_proofs.py")
    nodes = [node for path in (PROGRAM, beside) for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))]
    named = {node.module for node in nodes if isinstance(node, ast.ImportFrom)}
    named |= {name.name for node in nodes if isinstance(node, ast.Import) for name in node.names}
    assert {name.partition(".")[0] for name in named} <= set(sys.stdlib_module_names) | {"flint", "claims_proofs"}
    assert all(node.level < 2 for node in nodes if isinstance(node, ast.ImportFrom))


def test_a_folder_that_cannot_be_made_is_refused(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot be written"):
        verify("e:yeq").save_certificates(tmp_path / "file")


def test_the_command_writes_them(tmp_path):
    command = [sys.executable, "-m", "singimpact", "verify", "e:acc", "--certificates", str(tmp_path / "made")]
    subprocess.run(command, capture_output=True, check=True)
    assert sorted(path.name for path in (tmp_path / "made").iterdir()) == ["e_acc.json", "e_yeq.json"]
    assert judged(*(tmp_path / "made").iterdir()).returncode == 0
