"""The words of verdicts: their order, what a dependant inherits, and the theorems that go with them."""

import importlib
import math
import pkgutil
from fractions import Fraction
from itertools import pairwise

import pytest
import sympy

from singimpact.certificates import STRONGEST_FIRST as claims_checker_STRONGEST_FIRST, Refused, check_words
from singimpact.documents import Mark
from singimpact.impact_oscillator import ImpactOscillator
from singimpact.paper import (
    CLAIMS,
    COLOURS,
    IN_MODEL,
    KINDS,
    MODULO,
    PROVED,
    STRENGTH,
    STRONGEST_FIRST,
    Check,
    Claim,
    Statement,
    Trial,
    VerdictTable,
    as_svg,
    colour_of,
    effective,
    every,
    run,
    sample,
    told,
    trials,
)

STABLE, TAKENS = "the stable manifold theorem", "Takens' theorem"


def claim(name, kind="proved", rests_on=(), modulo=(), right=1):
    """A claim about 1, or one that is corrected to 1."""
    trials = [Trial(model, "x", "1", "2", "1", False, True) for model in ("one", "two")]
    return Claim(
        name, "0", f"claim {name}", Statement(f"x = {right}", right),
        lambda value: Check(value == 1, kind, "compared", {"x": "1"}, modulo), (0,),
        None if right == 1 else lambda: Statement("x = 1", 1), rests_on, lambda *_: trials,
    )  # fmt: skip


def verdicts(*claims):
    return {verdict.id: verdict for verdict in run(claims)}


def test_the_order():
    words = (
        "proved", "proved modulo", "proved in the model", "certified", "argued", "formal", "supported", "cited", "open",
        "error",
    )  # fmt: skip
    assert words == STRONGEST_FIRST == claims_checker_STRONGEST_FIRST
    assert all(STRENGTH[strong] > STRENGTH[weak] for strong, weak in pairwise(words))
    assert set(KINDS) == {*words, "corrected"} - {IN_MODEL}


@pytest.mark.parametrize("own", [word for word in STRONGEST_FIRST if word != IN_MODEL])
@pytest.mark.parametrize("below", STRONGEST_FIRST)
def test_a_claim_is_worth_the_weaker_word(own, below):
    worth = effective(own, False, [below, "proved"])
    assert worth in (own, below)
    assert STRENGTH[worth] == min(STRENGTH[own], STRENGTH[below])


@pytest.mark.parametrize(
    ("own", "worth"), [("proved", IN_MODEL), (MODULO, IN_MODEL), ("certified", "certified"), ("supported", "supported")]
)
def test_only_proofs_are_proofs_in_the_model(own, worth):
    assert effective(own, True, []) == worth


def test_a_theorem_makes_a_proof_one_modulo_it_and_leaves_the_rest():
    assert every([("hyperbolic", True)], modulo=(STABLE,)).kind == MODULO
    for kind in ("certified", "supported", "cited"):
        check = every([("hyperbolic", True)], kind, modulo=(STABLE,))
        assert (check.kind, check.modulo) == (kind, (STABLE,))


@pytest.mark.parametrize(
    ("kind", "modulo"), [(MODULO, ()), ("proved", ("",)), ("proved", STABLE), (IN_MODEL, ()), ("corrected", ())]
)
def test_a_check_without_a_meaning_is_refused(kind, modulo):
    with pytest.raises(ValueError, match=r"theorem|no argument"):
        Check(True, kind, "", modulo=modulo)


def test_dependants_inherit_theorems():
    found = verdicts(
        claim("manifold", modulo=(STABLE,)),
        claim("foliation", rests_on=("manifold",)),
        claim("both", rests_on=("foliation",), modulo=(TAKENS, STABLE)),
        claim("apart"),
    )
    assert found["manifold"].in_words == f"proved modulo {STABLE}"
    assert (found["foliation"].kind, found["foliation"].effective, found["foliation"].modulo) == ("proved", MODULO, ())
    assert found["foliation"].effective_modulo == (STABLE,)
    assert found["foliation"].in_words == f"proved modulo {STABLE}"
    assert found["both"].in_words == f"proved modulo {TAKENS} and {STABLE}"
    assert found["apart"].in_words == found["apart"].worth == "proved"
    assert all(found[name].as_dict()["effective_modulo"] == list(found[name].effective_modulo) for name in found)


def test_numbers_below_are_told_as_numbers():
    found = verdicts(
        claim("measured", "supported"),
        claim("manifold", modulo=(STABLE,), rests_on=("measured",)),
        claim("chain", modulo=(STABLE,)),
        claim("above", "certified", rests_on=("chain",)),
        claim("far", rests_on=("above",)),
    )
    assert found["manifold"].in_words == f"proved modulo {STABLE} (supported)"
    assert found["manifold"].worth == "supported"
    assert found["above"].in_words == f"certified, modulo {STABLE}"
    assert found["far"].in_words == f"proved (certified, modulo {STABLE})"


def test_a_correction_is_worth_what_its_argument_is():
    found = verdicts(claim("fixed", modulo=(STABLE,), right=2), claim("above", rests_on=("fixed",)))
    assert (found["fixed"].kind, found["fixed"].corrected_kind, found["fixed"].strength) == (
        "corrected",
        MODULO,
        MODULO,
    )
    assert found["fixed"].in_words == f"corrected (proved modulo {STABLE})"
    assert found["above"].worth == f"proved modulo {STABLE}"
    mark = Mark(found["fixed"].kind, found["fixed"].worth, found["fixed"].printed)
    assert mark.text == f"corrected, proved modulo {STABLE}"


def test_the_table_tells_the_theorems():
    claims = [claim("manifold", modulo=(STABLE,)), claim("fixed", modulo=(TAKENS,), right=2)]
    text = VerdictTable(claims, run(claims)).text()
    assert f"proved modulo {STABLE}" in text
    assert "1 proved modulo a theorem, 1 corrected" in text
    assert f"x = 1   [proved modulo {TAKENS}]" in text


def test_colours_go_with_the_first_words():
    assert len(set(COLOURS.values())) == len(COLOURS) >= 8
    assert colour_of(f"proved modulo {STABLE}") == COLOURS[MODULO]
    assert colour_of(f"proved in the model, modulo {STABLE}") == COLOURS[IN_MODEL]
    assert colour_of(f"corrected (proved modulo {STABLE})") == COLOURS["corrected"]
    assert set(STRONGEST_FIRST) - set(COLOURS) == {"open"}
    assert f"[proved modulo {STABLE}]" in as_svg(CLAIMS, {"e:yeq": f"proved modulo {STABLE}"})


def test_words():
    assert told(IN_MODEL, (STABLE,)) == f"proved in the model, modulo {STABLE}"
    assert told(MODULO, ("A", "B", "C")) == "proved modulo A, B and C"


def written(**changes):
    """The words of a file of `verify --certificates` with some fields changed."""
    return {
        "verdict": MODULO, "effective": MODULO, "corrected_kind": None,
        "modulo": [STABLE], "effective_modulo": [STABLE, TAKENS], "in_model": False, "certificates": [],
    } | changes  # fmt: skip


def test_the_second_program_reads_the_words():
    check_words(written())
    check_words(written(verdict="corrected", corrected_kind="proved", modulo=[]))
    check_words(written(in_model=True, effective=IN_MODEL))


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"effective": "proved"}, "proved, but modulo"),
        ({"verdict": "proved"}, "proved, but modulo"),
        ({"verdict": "proved", "modulo": [], "effective_modulo": []}, "proved modulo no theorem"),
        ({"effective_modulo": [TAKENS]}, "missing"),
        ({"verdict": "supported", "modulo": []}, "stronger"),
        ({"verdict": "certified", "effective": IN_MODEL}, "stronger"),
        ({"verdict": "certain"}, "no verdict"),
        ({"effective": "certain"}, "no effective verdict"),
        ({"modulo": [""], "effective_modulo": [""]}, "no name"),
        ({"in_model": True}, "about the model"),
    ],
)
def test_the_second_program_refuses_words_that_disagree(changes, why):
    with pytest.raises(Refused, match=why):
        check_words(written(**changes))


def test_a_sample_names_its_point_and_nine_digits():
    names = sympy.symbols("a:h")
    total = sum(n * letter for n, letter in enumerate(names, 1))
    told = sample(total, sympy.sqrt(2) * names[1] * names[2])
    assert told == {"at": "h = 1, all else 0", "stated": "8", "derived": "0"}
    assert sample(1 + total, total + sympy.sqrt(2))["derived"] == "1.41421356"
    # where all letters are 0 or 1 the two are equal
    told = sample(sympy.prod(names), sympy.prod(names) ** 2)
    at = "a = 3/5, b = 7/4, c = 2/9, d = 11/6, e = 5/13, f = 17/8, g = 1/7, h = 19/12"
    value = math.prod(Fraction(part.partition(" = ")[2]) for part in at.split(", "))
    assert told == {"at": at, "stated": str(value), "derived": str(value**2)}
    assert sample(names[0] * 0 + 1, sympy.Integer(2))["at"] == "every point"


def _broken(*_args, **_options):
    raise ArithmeticError("no flight today")


def _checked(claim):
    return claim.verify(claim.corrected().value if claim.corrected else claim.printed.value)


@pytest.mark.slow
def test_an_integrator_that_fails_makes_no_theorem_wrong(monkeypatch):
    """A claim whose word stands for an exact argument needs no true orbit: where every one raises, it still holds."""
    claims = [CLAIMS[name] for name in CLAIMS]
    with monkeypatch.context() as patched:
        flights = ("impact_map", "first_hit", "flight", "orbit", "iterate", "chatter_limit", "derivative", "launch")
        for name in flights:
            patched.setattr(ImpactOscillator, name, _broken)
        for item in pkgutil.iter_modules(trials.__path__, f"{trials.__name__}."):
            module = importlib.import_module(item.name)
            for name in {*flights, "scipy_flow", "closed_flow", "path"} & {*vars(module)}:
                patched.setattr(module, name, _broken)
            for value in vars(module).values():
                if hasattr(value, "cache_clear"):
                    value.cache_clear()  # trials that another test has run
        stopped, apart = [], 0
        for claim in claims:
            try:
                check = _checked(claim)
            except ArithmeticError:
                stopped.append(claim)
                continue
            assert check.holds
            apart += "a trial apart from the argument FAILS: ArithmeticError: no flight today" in check.evidence
    assert apart >= 15
    assert "s3-takens" in {claim.id for claim in stopped}
    assert not [claim.id for claim in stopped if _checked(claim).kind in (PROVED, MODULO)]
