"""Claims that the paper does not have: verdicts, mutants, and that the paper's 147 stay apart."""

import json

import pytest
from false_certificates import accepts

import singimpact as si
from singimpact.paper import CLAIMS, INDEX, imported_by, run, select
from singimpact.paper.claims import BEYOND
from singimpact.paper.claims.beyond import BEYOND as FILES

KINDS = {
    "b:cascade-launch": "proved",
    "b:cascade-contraction": "proved",
    "b:resting-window": "certified",
    "b:grazing-exponent": "argued",
    "b:never-rests": "certified",
    "b:cascade-contraction-r": "proved",
    "b:homoclinic": "certified",
    "b:horseshoe": "certified",
    "b:ratio-bound": "proved",
    "b:order-ray": "proved",
    "b:order-saddle": "proved",
    "b:order-expansion": "proved",
    "b:order-exponents": "proved",
    "b:order-parity": "proved",
    "b:order-sides": "proved",
    "b:gauge": "proved",
    "b:gauge-nonlinear": "proved",
    "b:gamma-tangency": "certified",
    "b:gamma-swan": "certified",
    "b:gamma-interval": "certified",
    "b:gamma-nonlinear": "certified",
    "b:first-order": "proved",
    "b:first-order-foot": "proved modulo",
    "b:holder-bounds": "proved",
    "b:holder": "proved modulo",
    "b:holder-count": "proved modulo",
    "b:foot-monotone": "proved in the model",
    "b:foot": "certified",
    "b:foot-limit": "argued",
    "b:border-order": "argued",
    "b:three-one": "argued",
    "b:three-rest": "argued",
    "b:three-events": "argued",
    "b:three-elastic": "argued",
    "b:loops-map": "proved modulo",
    "b:loops": "proved modulo",
    "b:loops-law": "proved modulo",
    "b:onset-none": "proved",
    "b:onset-hop": "proved",
    "b:events-front": "proved",
    "b:events-critical": "proved",
    "b:events-eliminated": "proved",
    "b:events-families": "proved",
    "b:events-values": "proved",
    "b:events-two": "proved",
    "b:events-first": "argued",
    "b:hertz-adiabatic": "proved",
    "b:hertz": "formal",
    "b:hertz-sides": "formal",
    "b:hertz-next": "formal",
    "b:hertz-chatter": "formal",
}
OWN = {"proved in the model": "proved"}  # the kind of a verifier whose argument is about the universal model

SECONDS = (  # those of enclosures and of true orbits
    "b:homoclinic", "b:horseshoe",
    "b:hertz-next",
    "b:gamma-nonlinear", "b:gamma-swan", "b:cascade-contraction", "b:cascade-contraction-r", "b:ratio-bound",
    "b:order-exponents", "b:first-order-foot",
)  # fmt: skip
EACH = [pytest.param(name, marks=pytest.mark.slow) if name in SECONDS else name for name in BEYOND]


@pytest.fixture(scope="module")
def verdicts():
    """name -> verdict, decided once."""
    return lambda name: run(select([name]), cached=True)[-1]


def test_order_is_that_of_the_files():
    assert list(dict.fromkeys(entry.file for entry in BEYOND.values())) == list(FILES)
    assert [claim.id for claim in map(CLAIMS.__getitem__, BEYOND)] == list(BEYOND)


def test_the_claims_of_the_paper_stay_apart():
    assert len(si.claims) == len(CLAIMS) == len(INDEX) == 147
    assert not set(BEYOND) & set(INDEX)
    assert not set(BEYOND) & {entry.id for entry in select()}
    assert si.claims["b:cascade-launch"].section == "beyond"
    assert all(name.startswith("b:") for name in BEYOND)


@pytest.mark.parametrize("name", EACH)
def test_each_has_its_verdict(name, verdicts):
    verdict = verdicts(name)
    assert verdict.effective == KINDS[name], verdict.evidence
    assert verdict.kind == OWN.get(KINDS[name], KINDS[name])
    if verdict.kind in ("proved", "proved modulo"):
        assert verdict.certificates
        assert all(accepts(json.loads(json.dumps(each))) for each in verdict.certificates)


@pytest.mark.parametrize("name", EACH)
def test_verifier_rejects_every_mutant(name):
    claim = CLAIMS[name]
    assert claim.mutants
    for mutant in claim.mutants:
        assert not claim.verify(mutant).holds, f"{name} accepts {mutant}"


@pytest.mark.slow
def test_contraction_for_all_r_rests_on_positive_coefficients(verdicts):
    kinds = [certificate["kind"] for certificate in verdicts("b:cascade-contraction").certificates]
    assert "positive" in kinds


def test_contraction_at_numbers():
    """lambda^2 mu of certified fixed points, beside the formula."""
    for r in ("0.01", "0.3", "0.5", "0.8", "0.99"):
        at = si.fixed_points.tangency(r, digits=40)
        root, mu = at.lambda_.value, at.mu.value
        assert float(abs(root**2 * mu - (1 - (1 - root**3) / (1 + 2 * root) ** 2))) < 1e-15
        assert float(abs(root**2 * mu - type(root)(r) ** 2 / root**3)) < 1e-14
        assert root**2 * mu < 1


def test_key_holds_what_a_file_imports():
    assert {"cascade", "section4a_multipliers", "section4a_blowup"} <= set(imported_by("cascade"))


@pytest.mark.slow
def test_from_the_command_line(singimpact):
    shown = json.loads(singimpact("verify", "--beyond", "--json").stdout)["claims"]
    assert {each["id"]: each["effective"] for each in shown if each["id"] in KINDS} == KINDS
    falls = json.loads(singimpact("claims", "show", "b:hertz", "--json").stdout)["falls_with_it"]
    assert sorted(falls) == ["b:hertz-chatter", "b:hertz-next", "b:hertz-sides"]


def test_the_two_routes_to_a_linear_sheet_differ_for_another_stiffness():
    from fractions import Fraction

    from singimpact.paper.claims.beyond import gauge

    jet = {1: Fraction(3, 2), 2: Fraction(-1, 3)}
    right, wrong = (gauge._of_the_ball(jet, Fraction(1, 5), square) for square in (Fraction(3, 2), Fraction(8, 5)))
    assert any(value != 0 for value in (right - wrong).terms.values())
