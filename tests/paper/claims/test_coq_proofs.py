"""The proofs by hand of `derivations/coq` are accepted by Coq, are about the package's forms, and fail when changed."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest
import sympy

from singimpact.theory import P, Q, lambda_

pytestmark = [pytest.mark.slow, pytest.mark.skipif(shutil.which("coqc") is None, reason="needs coqc")]
PROOFS = Path(__file__).parents[3] / "derivations" / "coq"
ORDER = [line for line in (PROOFS / "_CoqProject").read_text().splitlines() if line.endswith(".v")]
OF_THE_REALS = {"sig_not_dec", "sig_forall_dec", "functional_extensionality_dep", "classic"}


def compiled(folder, name):
    return subprocess.run(["coqc", "-Q", ".", "Contact", name], cwd=folder, capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def proofs(tmp_path_factory):
    """Where they are compiled, and what Coq printed."""
    folder, told = tmp_path_factory.mktemp("coq"), ""
    for name in ORDER:
        shutil.copy(PROOFS / name, folder)
        done = compiled(folder, name)
        assert done.returncode == 0, done.stderr
        told += done.stdout
    return folder, told


def test_nothing_is_assumed_but_the_axioms_of_the_reals(proofs):
    _, told = proofs
    texts = "".join((PROOFS / name).read_text() for name in ORDER)
    assert told.count("Axioms:") == 4
    assert {name.rpartition(".")[2] for name in re.findall(r"^(\S+)(?= :|$)", told, re.M)} - {"Axioms:"} <= OF_THE_REALS
    assert sorted(ORDER) == sorted(path.name for path in PROOFS.glob("*.v"))
    assert not re.search(r"\b(Axiom|Admitted|admit|Parameter)\b", texts)


def test_the_forms_are_those_of_the_package(proofs):
    def stated(factor):
        lines = [f"Goal forall l, P {j} l = {factor} * ({text(P(j))}) /\\ Q {j} l = {text(Q(j))}." for j in range(1, 6)]
        proof = "Proof. intro l. unfold P, Q, powers. split; rewrite ?S_INR; simpl; ring. Qed."
        head = "From Coq Require Import Reals.\nFrom Contact Require Import ratios.\nOpen Scope R_scope.\n"
        (folder / "forms.v").write_text(head + "\n".join(f"{line}\n{proof}" for line in lines))
        return compiled(folder, "forms.v").returncode == 0

    def text(form):
        return str(sympy.expand(form.subs(lambda_, sympy.Symbol("l")))).replace("**", "^")

    folder, _ = proofs
    assert stated(1)
    assert not stated(2)


@pytest.mark.parametrize(
    ("name", "right", "wrong"),
    [
        ("ratios.v", "derivable_pt_lim (D j) l (- Q j l)", "derivable_pt_lim (D j) l (Q j l)"),
        ("ratios.v", "P j 1 = Q j 1", "P j 1 = 2 * Q j 1"),
        ("ratios.v", "l ^ S j * P j l * Q j m < m", "l ^ j * P j l * Q j m < m"),
        ("fates.v", "0 < rest < s 0%nat /\\", "0 < rest < s 1%nat /\\"),
        ("fates.v", "Theorem impacts_before_the_contact_end : ~ l", "Theorem impacts_before_the_contact_end : l"),
        ("fates.v", "Hypothesis L1_below : L1 < 1.", "Hypothesis L1_below : L1 <= 1."),
        ("homogeneous.v", "chatter : lambda < l 0%nat", "chatter : lambda <= l 0%nat"),
        ("homogeneous.v", "Hypothesis r_inside : 0 < r < 1.", "Hypothesis r_inside : 0 < r <= 1."),
        ("homogeneous.v", "longer_flights_end : ~ l 0%nat < lambda", "longer_flights_end : ~ l 0%nat <= lambda"),
        ("behind.v", "t * sigma ^ j / 2 <= launch", "t * (sigma + t) ^ j / 2 <= launch"),
        ("behind.v", "flights_shorten n : t (S n) <= r * t n", "flights_shorten n : t (S n) <= r * r * t n"),
        ("motion.v", "derivable_pt_lim speed u (- (sigma + u) ^ j)", "derivable_pt_lim speed u ((sigma + u) ^ j)"),
        ("motion.v", "s ^ (j + 1) * ((1 - l) * Q j l).", "s ^ j * ((1 - l) * Q j l)."),
        ("order.v", "a x * a (y + w) <= a (x + w) * a y", "a (x + w) * a y <= a x * a (y + w)"),
        ("order.v", "e' n <= e n - (t' 0%nat - t 0%nat)", "e' n <= e n - 2 * (t' 0%nat - t 0%nat)"),
        ("order.v", "faster : 0 < t 0%nat < t' 0%nat", "faster : 0 < t 0%nat <= t' 0%nat"),
    ],
)
def test_a_wrong_statement_is_refused(name, right, wrong, proofs, tmp_path):
    source = (PROOFS / name).read_text()
    assert source.count(right) == 1
    for before in ORDER[: ORDER.index(name)]:
        shutil.copy((proofs[0] / before).with_suffix(".vo"), tmp_path)
    (tmp_path / name).write_text(source.replace(right, wrong))
    done = compiled(tmp_path, name)
    assert done.returncode != 0
    assert not re.search("Cannot find a physical path|Syntax error|not found in the current environment", done.stderr)
