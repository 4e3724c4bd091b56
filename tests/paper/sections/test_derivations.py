"""Sections 2 to 5: what they show is derived, golden, judged, the same in every run, and fits the page."""

import json
import os
import re
import shutil
import subprocess
import sys

import pytest
import sympy

from singimpact import __version__
from singimpact.documents import as_data, as_files, as_latex, as_text, claims_of, compiled, equations_of
from singimpact.paper import CLAIMS, STRENGTH, a_symbol, m, mu_of_m, r_of_m, with_Q
from singimpact.paper.claims import BEYOND
from singimpact.paper.claims.beyond import every_order, foot, hertz
from singimpact.paper.routes import fold
from singimpact.theory import lambda_, leading_coefficient, mu_of_lambda, r_of_lambda

REFRESH = "python derivations/freeze.py writes it anew"
LABELS = [
    "e:yeq", "e3", "e:imp", "e:acc", "e:proj", "e:phi", "s2-xdot", "s2-det-phi", "s3-Dp", "s3-Dphi", "s3-DG",
    "s3-eigenvectors", "s3-slope", "s4-y-derivatives", "s4-chain-rule", "e:vtaylor", "e:degen", "e:swan", "s4-saddle",
    "e:pnew", "e:phinew", "s4-horizon-line", "s4-fold-eta", "s4-fold-form", "s4-psi", "e:pdef", "e:defq",
    "s4-next-sigma", "e:qdef", "e:hdef", "s4-Q1m", "s4-blowup", "e:fixm", "e:meq", "s4-r-of-m", "s4-Nr-1", "s4-Nr-2",
    "s4-Nr-3", "s4-Dh-form", "s4-gamma-leading", "s4-lambda-P", "s4-lambda-r", "s4-lambda-mu", "s4-lambda-gamma",
    "s4-lambda-DG", "fates-setting", "fates-polynomials", "fates-theorem", "fates-flights", "fates-first-hit",
    "fates-relation", "fates-drift", "fates-rising", "fates-factor", "fates-product", "fates-behind", "fates-shorter",
    "ratios-1", "ratios-rise-1", "s4b-continuous", "s4b-sector", "s4b-T2-bounds", "s4b-after",
    "s4b-rays", "s4b-last-ray", "s4b-M", "s4b-bounds", "s4b-ratio", "s4b-below-one", "s4b-end", "ratios-shorter-1",
    "s4b-cone", "s4b-order", "s4b-eps",
    "e:pdeg3", "s5-phi", "s5-hbar", "s5-f", "s5-g", "s5-fixed", "s5-r-of-m", "s5-jacobian", "s5-mu", "s5-lambda-P",
    "s5-lambda-r", "s5-gamma-leading", "ratios-2", "ratios-rise-2", "ratios-shorter-2", "s6-scaled", "s6-scaling",
    "s6-front", "s6-model", "s6-launch",
    "s6-impact", "s6-horizon", "s6-zero-set", "s6-E", "s6n-corr", "s6n-cusp", "s6-order", "s6p-AB", "s6p-BE", "s6p-eps",
    "s6p-gamma", "s6-shadow", "s6n-maps", "s6-GA", "s6n-chatter", "s6n-X", "s6-chords", "s6n-tangent",
    "s7-inner", "s7-preimage", "s7-rate", "b:gauge", "b-order-speeds", "b:order-ray",
    "b:order-expansion", "b-rising", "b:first-order", "b-chi", "b:first-order-foot", "b:holder-bounds",
    "b:hertz", "b:hertz-next",
    "b:loops-map",
    "b-loops-preimage", "b:foot", "b:foot-limit", "b:border-order", "b-border-hop",
    "b-border-landing", "b-border-bound", "b-three-hop", "b:three-one", "b:three-rest", "b:three-elastic",
    "b:three-events",
    "b:onset-hop", "b:events-front",
    "b:events-critical", "b:events-first", "b:cascade-contraction",
    "b:resting-window", "b:grazing-exponent",
]  # fmt: skip


def test_every_step_is_there_in_order(told):
    assert list(equations_of(told)) == LABELS


def test_every_claim_of_the_paper_occurs(told):
    shown = set(claims_of(told))
    assert shown & set(CLAIMS) == set(CLAIMS)
    assert shown - set(CLAIMS) <= set(BEYOND)


def test_what_is_beyond_the_paper_stands_by_itself(told):
    """In a section of its own; claims on orbits and on single models are named in words."""
    (section,) = [each for each in told if each.name == "beyond"]
    assert all(claim in BEYOND for claim in claims_of([section]))
    assert not [claim for other in told if other is not section for claim in claims_of([other]) if claim in BEYOND]
    words = " ".join(step.text for step in section.steps)
    named = {f"b:{name}" for name in re.findall(r"b:([a-z-]+)", words)}
    measured = {"b:holder", "b:holder-count", "b:loops", "b:loops-law"}
    assert named == measured | {"b:gamma-tangency", "b:gamma-swan", "b:gamma-interval", "b:gamma-nonlinear"}
    assert named <= set(BEYOND)


def test_every_equation_has_a_label_of_its_own(told):
    labels = [step.label for section in told for step in section.steps if step.equation]
    assert "" not in labels
    assert len(set(labels)) == len(labels)


def test_golden_equations(told, freeze):
    for path, content in freeze.golden(told).items():
        assert json.loads(path.read_text()) == json.loads(content), REFRESH


def test_golden_statements(freeze):
    ((path, content),) = freeze.statements().items()
    assert json.loads(path.read_text()) == json.loads(content), REFRESH


def test_the_folder_holds_what_is_derived_now(told, marks, freeze):
    files = freeze.derivations(told, marks)
    for path, content in files.items():
        assert path.read_bytes() == content, f"{path.name}: {REFRESH}"
    assert {path.name for path in freeze.HERE.glob("*.tex")} == {path.name for path in files}


def test_a_claim_with_the_name_of_a_label_stands_beside_it(told):
    for section in told:
        for step in section.steps:
            assert step.label not in CLAIMS or step.label in step.claims, step.label


def test_every_misprint_of_a_labelled_equation_is_quoted(told, marks):
    text = as_latex(told, marks)
    corrected = [claim for claim in claims_of(told) if marks[claim].verdict == "corrected"]
    assert {"e:phi", "e:phinew", "e:hdef", "e:vtaylor-t3"} <= set(corrected)
    for claim in corrected:
        assert rf"\printed{{{marks[claim].printed}}}" in text


def test_no_claim_ends_in_error(marks):
    assert {mark.verdict for mark in marks.values()} <= {*STRENGTH, "corrected"}


def test_effective_verdicts_are_shown(told, marks):
    text = as_latex(told, marks)
    assert r"\beside{s6p-AB}{corrected, proved}" in text
    assert r"\found{s6-sections}{proved in the model}" in text
    assert marks["s3-slope"].text == "proved modulo the theorem of Hirsch, Pugh and Shub"


def test_the_two_routes_show_one_theory():
    half = sympy.Rational(1, 2)
    for stated, derived in [
        (r_of_lambda(1), fold.r_of_m().subs(fold.m, lambda_ + half)),
        (mu_of_lambda(1), fold.N_r_at_fixed_points().subs(fold.m, lambda_ + half)),
        (
            a_symbol(1) * leading_coefficient(1),
            fold.gamma_leading().subs({fold.m: lambda_ + half, fold.k: a_symbol(1) / 6}),
        ),
        (r_of_lambda(2), r_of_m().subs(m, lambda_ - 1)),
        (mu_of_lambda(2), mu_of_m().subs(m, lambda_ - 1)),
    ]:
        assert sympy.cancel(stated - derived) == 0


def test_what_decides_a_lemma_exists(told, clone):
    """The claims that the proofs in section 4 name, and the files of Coq that these and those beyond the paper do."""
    (section,) = [each for each in told if each.name == "section4"]
    words = " ".join(step.text for step in section.steps)
    files = {name for each in told for step in each.steps for name in re.findall(r"[a-z]+\.v\b", step.text)}
    assert files == {path.name for path in (clone / "derivations" / "coq").glob("*.v")}
    named = re.findall(r"(?:by|and|,) (t:[\w-]+)", words)
    assert len(named) >= 8
    assert set(named) <= set(CLAIMS)


def test_a_document_has_a_title_with_the_version_an_abstract_and_contents(told, marks):
    whole, one = as_latex(told, marks), as_latex(told[2:3], marks)
    for text in (whole, one):
        assert f"The authors of singimpact, version {__version__}, " in text
        assert "Abstract" in text
    assert r"\tableofcontents" in whole
    assert r"\tableofcontents" not in one
    assert r"\textbf{Theorem.}" in one
    assert "[[" not in whole


def test_the_number_of_an_equation_in_the_paper_stands_beside_it(told, marks):
    assert marks["e:phi"].text == "corrected, proved, (9) in the paper"
    assert marks["t:t2-exists"].place == ""
    assert "(28) in the paper" in as_latex(told, marks)


def test_writing_Q_is_refused_where_it_does_not_fit():
    assert "r" not in {str(symbol) for symbol in with_Q(fold.N_r()).free_symbols}
    assert with_Q(sympy.Symbol("r")) == sympy.Symbol("r")


_PROGRAM = """
import json, sys
from singimpact.documents.rendering import as_text
from singimpact.documents.document_steps import Mark, claims_of
from singimpact.paper.sections.derivation_sections import sections
told = sections()
marks = {claim: Mark("proved", "proved") for claim in claims_of(told)}
sys.stdout.write("".join(as_text(told, marks, form) for form in ("latex", "markdown", "json")))
"""


@pytest.mark.slow
def test_same_bytes_under_two_hash_seeds(clone):
    texts = [
        subprocess.run(
            [sys.executable, "-c", _PROGRAM],
            env=os.environ | {"PYTHONHASHSEED": seed, "PYTHONPATH": str(clone)},
            capture_output=True,
            check=True,
        ).stdout
        for seed in ("0", "1")
    ]
    assert texts[0] == texts[1]
    assert len(texts[0]) > 20_000


@pytest.mark.slow
def test_the_whole_command_is_deterministic(clone):
    command = [sys.executable, "-m", "singimpact", "derive"]
    texts = [
        subprocess.run(
            command,
            env=os.environ | {"PYTHONHASHSEED": seed, "PYTHONPATH": str(clone)},
            capture_output=True,
            check=True,
        ).stdout
        for seed in ("0", "1")
    ]
    assert texts[0] == texts[1]


def test_no_word_escapes_its_dollars(told, marks):
    for section in told:
        for step in section.steps:
            assert step.text.count("$") % 2 == 0, step.text
    assert "\\$" not in as_text(told, marks, "latex")


def test_json_has_verdicts_and_what_is_printed(told, marks):
    steps = {step["label"]: step for section in told for step in as_data(section, marks)["steps"]}
    assert steps["e:phinew"]["claims"]["e:phinew"]["verdict"] == "corrected"
    assert steps["e:phinew"]["claims"]["e:phinew"]["effective"] == "proved"


@pytest.mark.slow
def test_master_and_single_document_compile_with_nothing_sticking_out(told, marks):
    assert shutil.which("latexmk"), "CI installs latexmk"
    files = {name: content.decode() for name, content in as_files(told, marks, "latex").items()}
    master = files.pop("derivations.tex")
    for done in (compiled(master, files), compiled(as_latex(told, marks))):
        assert done.pdf.startswith(b"%PDF")
        assert max(done.overfull, default=0) <= 20
        assert "undefined references" not in done.log


def test_constants_that_words_of_the_section_beyond_write_out():
    """Of gamma under Hertz's law, and of the foot X for r near 1."""
    q, j, u = sympy.symbols("q j u")
    first = 3 * (1 - q) / (2 * (3 + (2 + q) * j))
    second = q * (3 + (2 + q) * j) * (3 + (1 + 2 * q) * j) / (3 * (1 - q) * (3 + 2 * j + 2 * j * q - j * q**2))
    for own, written in ((hertz.FACTOR, first), (hertz.SECOND, second)):
        assert sympy.cancel(own.subs({hertz.q: q, every_order.j: j}) - written) == 0
        assert sympy.cancel(own.subs({hertz.q: q, every_order.j: j}) - 2 * written) != 0
    limit = foot.FORMULA.subs(sympy.Symbol("w"), u)
    assert sympy.expand(limit**7 - (14 * u / (3 * sympy.cbrt(144))) ** 3) == 0
