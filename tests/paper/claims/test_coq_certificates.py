"""Coq accepts the certificates of claims as `singimpact verify --coq DIR` writes them, and no forged ones."""

import copy
import json
import random
import re
import shutil
import subprocess
import sys
from fractions import Fraction

import pytest

from singimpact.certificates import Refused, check_certificate, number
from singimpact.documents import KINDS, LEMMAS, Writer, coq_file
from singimpact.paper import verify

pytestmark = [pytest.mark.slow, pytest.mark.skipif(shutil.which("coqc") is None, reason="needs coqc")]


def compiled(folder, name):
    return subprocess.run(["coqc", "-Q", ".", "Claims", name], cwd=folder, capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """The folder that the commands write, of the paper's claims and of those beyond it."""
    folder = tmp_path_factory.mktemp("coq")
    for words in ([], ["--beyond"]):
        command = [sys.executable, "-m", "singimpact", "verify", *words, "--coq", str(folder / "".join(words))]
        subprocess.run(command, check=True, capture_output=True)
    for path in (folder / "--beyond").iterdir():
        if not (folder / path.name).exists():
            path.rename(folder / path.name)
    assert compiled(folder, LEMMAS.name).returncode == 0
    return folder


@pytest.fixture(scope="module")
def certificates(tmp_path_factory):
    """All of them, of the paper's claims."""
    folder = tmp_path_factory.mktemp("certificates")
    paths = verify().save_certificates(folder)
    return [data for path in paths for data in json.loads(path.read_text())["certificates"]]


def test_a_folder_becomes_a_project(written, certificates):
    names = (written / "_CoqProject").read_text().splitlines()
    assert names[:2] == ["-Q . Claims", "certificates.v"]
    assert {data["kind"] for data in certificates} == set(KINDS)
    texts = [(written / name).read_text() for name in names[2:]]
    assert len(texts) >= 139
    assert sum(text.count("Qed.") for text in texts) == len(certificates)


def heads_and_modules(written):
    """What the files begin with, and the file of each claim without it, the longest first."""
    heads, modules = set(), []
    for path in sorted(written.glob("claim_*.v"), key=lambda path: -path.stat().st_size):
        head, rest = re.fullmatch(r"(?:\(\*.*?\*\)\n)\n(From Coq.*?\]\)\.\n)(.*)", path.read_text(), re.DOTALL).groups()
        heads.add(head)
        modules.append((path.stem, rest))
    assert len(heads) == 1
    return heads.pop(), modules


@pytest.mark.parametrize("half", [0, 1])
def test_coq_accepts_all_of_them(half, written):
    """As modules of one file, since loading the reals takes longer than most proofs."""
    head, modules = heads_and_modules(written)
    assert len(modules) >= 170
    chosen = modules[half::2]
    text = "\n".join([head, *(f"Module {name}.\n{module}\nEnd {name}." for name, module in chosen)])
    printed = "".join(f"Print Assumptions {name}.certificate_0.\n" for name, _ in chosen[-10:])
    (written / f"half{half}.v").write_text(f"{text}\n{printed}")
    done = compiled(written, f"half{half}.v")
    assert done.returncode == 0, done.stderr
    assert "certificate" not in done.stdout.partition("Axioms:")[2]


def twice(polynomial):
    return [[powers, f"{2 * value}" if isinstance(value, int) else "5/11"] for powers, value in polynomial]


def flip(data):
    data["sign"] = -data["sign"]


def right_side(data):
    data["right"]["outer"][0] = twice(data["right"]["outer"][0]) or [[[0] * len(data["variables"]), 1]]


def wider(data):
    """On a box that reaches beyond where the sign was proved."""
    (low, high), *rest = data["box"]
    data["box"] = [[low if low == "-oo" else f"{low}" if "/" in low else str(int(low) - 900), high], *rest]


FORGED = {
    "positive": flip,
    "definite": flip,
    "identity": lambda data: data["left"].__setitem__(0, twice(data["left"][0])),
    "composed": right_side,
    "value": lambda data: data.update(
        value=[[[[0] * len(data["variables"]), "8/7"]], [[[0] * len(data["variables"]), 1]]]
    ),
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


def is_false(data):
    """Whether the statement of a forged certificate is wrong: the second program decides, or a point of the box."""
    try:
        check_certificate({name: part for name, part in data.items() if name != "says"})
    except Refused:
        if data["kind"] != "positive":
            return True
    else:
        return False
    rng, w = random.Random(1), Writer(data["variables"])
    product = w.read(data["numerator"]) * w.read(data["denominator"])
    for _ in range(40):
        value = product
        for index, (low, high) in enumerate(data["box"]):
            ends = [-99 if low == "-oo" else Fraction(low), 99 if high == "oo" else Fraction(high)]
            place = ends[0] + (ends[1] - ends[0]) * Fraction(rng.randint(1, 999), 1000)
            value = w.at(value, index, number(str(place)))
        if w.terms(value).get((0,) * len(w.names), 0) * data["sign"] <= 0:
            return True
    return False


WAYS = {
    "positive": [FORGED["positive"], wider],
    "composed": [
        FORGED["composed"],
        lambda data: data["left"]["outer"].__setitem__(1, twice(data["left"]["outer"][1])),
    ],
}


def theorem(name, data):
    """A statement of one certificate with its proof, given up where the proof fails."""
    found = coq_file({"id": "one", "title": "one", "certificates": [data]})
    return found[found.index("Theorem") :].replace("certificate_0", name) + "Abort All.\n"


def test_a_hundred_forged_ones_are_refused(written, certificates):
    """Another number, sign, factor or interval, in each shape; the first of each passes unchanged in the same run."""
    head, _ = heads_and_modules(written)
    names, shapes, lines = [], {}, [head, "Set Default Timeout 20.\n"]
    for data in sorted(certificates, key=lambda data: len(str(data))):
        for way in WAYS.get(data["kind"], [FORGED[data["kind"]]]):
            forged = copy.deepcopy(data)
            way(forged)
            known = shapes.setdefault((shape(data), way), [])
            if len(known) < 7 and is_false(forged):
                known.append(f"forged{len(names)}")
                names.append(known[-1])
                lines += [theorem(f"true{len(names)}", data)] if len(known) == 1 else []
                lines += [theorem(names[-1], forged)]
    assert len(names) >= 100
    assert len({name for name, _ in shapes}) == len(FORGED) + 6  # seven shapes of compositions
    kept = [f"true{n}" for n in range(1, len(names) + 1)]
    lines += [f"Locate {name}.\n" for name in (*names, *kept)]
    command = ["coqtop", "-q", "-Q", ".", "Claims"]
    done = subprocess.run(command, input="".join(lines), cwd=written, capture_output=True, text=True, check=False)
    assert not re.findall(r"Syntax error|The reference \w+ was not found", done.stdout + done.stderr)
    assert done.stdout.count("No object of basename forged") == len(names)
    assert len(re.findall(r"^(?:Coq < )*Constant Top\.true", done.stdout, re.MULTILINE)) == len(shapes)
