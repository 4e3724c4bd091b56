"""The files of `verify --certificates`: accepted by the program that stands alone, and refused when changed."""

import ast
import contextlib
import json
import random
import subprocess
import sys
from pathlib import Path

import false_certificates as false
import pytest
from tampering import bumped, changed, leaves

from singimpact.algebra.checking import accepts
from singimpact.algebra.sentences import sentence
from singimpact.certificates import claims_checker
from singimpact.inputs import InputError
from singimpact.paper.claims.verdicts import verify

PROGRAM = Path(claims_checker.__file__)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("certificates")
    verify().save_certificates(place)
    return place


def judged(*paths):
    command = [sys.executable, "-I", str(PROGRAM), *map(str, paths)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def holds(certificate):
    try:
        claims_checker.check_certificate(certificate)
    except claims_checker.Refused:
        return False
    return True


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
            assert not holds(changed(certificate, path, bumped)), (certificate["says"], path)


def test_another_sentence_is_refused(folder):
    for certificate in all_of(folder)[:40]:
        assert not holds(certificate | {"says": certificate["says"] + " "})
        assert not holds({key: part for key, part in certificate.items() if key != "says"})


FALSE = {
    f"{name}, {n}": certificate
    for n, table in enumerate((false.WEAKENED, false.IN_IDENTITIES, false.IN_MOTIONS, false.IN_PLAIN))
    for name, (_, _, certificate) in table.items()
}


@pytest.mark.parametrize("name", FALSE)
def test_a_false_certificate_is_refused(name):
    certificate = FALSE[name]
    with contextlib.suppress(KeyError, TypeError, ValueError, IndexError):
        certificate = {"says": sentence(certificate)} | certificate
    assert not holds(json.loads(json.dumps(certificate)))


@pytest.mark.slow
def test_the_two_checkers_agree_on_damaged_certificates(folder):
    """The sentence is renewed, so that the mathematics decides: a change may be another true statement."""
    rng, both = random.Random(7), 0
    for certificate in all_of(folder):
        places = list(leaves(certificate))
        for path in rng.sample(places, min(6, len(places))):
            damaged = changed(certificate, path, bumped)
            try:
                damaged["says"] = sentence(damaged)
            except (KeyError, TypeError, ValueError, IndexError, ZeroDivisionError):
                continue
            assert holds(damaged) == accepts(damaged), (certificate["says"], path)
            both += accepts(damaged)
    assert both > 5


def test_the_program_stands_alone():
    tree = ast.parse(PROGRAM.read_text(encoding="utf-8"))
    named = {node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    named |= {name.name for node in ast.walk(tree) if isinstance(node, ast.Import) for name in node.names}
    assert {name.partition(".")[0] for name in named} <= set(sys.stdlib_module_names) | {"flint"}


def test_a_folder_that_cannot_be_made_is_refused(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot be written"):
        verify("e:yeq").save_certificates(tmp_path / "file")


def test_the_command_writes_them(tmp_path):
    command = [sys.executable, "-m", "singimpact", "verify", "e:acc", "--certificates", str(tmp_path / "made")]
    subprocess.run(command, capture_output=True, check=True)
    assert sorted(path.name for path in (tmp_path / "made").iterdir()) == ["e_acc.json", "e_yeq.json"]
    assert judged(*(tmp_path / "made").iterdir()).returncode == 0
