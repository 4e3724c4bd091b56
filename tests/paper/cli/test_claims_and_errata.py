"""`singimpact claims`, `errata` and `fixed-points` on the real claims."""

import dataclasses
import json
import re
import shutil
from collections import Counter
from xml.etree import ElementTree

import pytest

import singimpact as si
from singimpact.paper import GRADES, REMARKS, Erratum, place_of


def test_list_and_show(singimpact):
    listed = json.loads(singimpact("claims", "list", "--json").stdout)["claims"]
    assert len(listed) == len(si.claims) == 147
    shown = json.loads(singimpact("claims", "show", "s3-dvdt", "--json").stdout)
    assert (shown["verdict"], shown["corrected_kind"]) == ("corrected", "proved")
    assert shown["mutants"] == 2
    assert "corrected" in singimpact("claims", "show", "s3-dvdt").stdout


def test_impact_is_what_rests_on_it(singimpact):
    falls = json.loads(singimpact("claims", "impact", "s3-DG", "--json").stdout)["falls"]
    assert {"s3-eigenvectors", "s3-slope-r", "t:t1"} <= set(falls)
    assert "e:yeq" not in falls
    assert "nothing rests on s7-loops" in singimpact("claims", "impact", "s7-loops").stdout


def test_graph_as_text_and_svg(singimpact):
    told = json.loads(singimpact("claims", "graph", "--json").stdout)
    assert told["s3-DG"] == ["s3-Dp", "s3-Dphi"]
    assert len(singimpact("claims", "graph").stdout.splitlines()) == 147
    from singimpact.paper import CLAIMS, as_svg

    picture = ElementTree.fromstring(as_svg(CLAIMS, {"e:yeq": "proved"}))
    names = [element.text for element in picture.iter() if element.tag.endswith("}text")]
    assert sorted(names) == sorted(CLAIMS)


@pytest.mark.parametrize("command", ["show", "impact"])
def test_unknown_id_is_one_line(singimpact, command):
    result = singimpact("claims", command, "e:mex")
    assert result.exit_code == 2
    assert result.stderr == "singimpact: unknown claim 'e:mex': the nearest known are e:meq, e:yeq\n"


@pytest.fixture(scope="module")
def errata():
    return si.errata()


def test_every_erratum_is_whole(errata):
    assert len(errata) > 30
    for entry in errata:
        told = entry.as_dict()
        assert told["printed"] != told["corrected"]
        assert told["corrected_kind"] in {"proved", "proved modulo", "certified", "supported"}
        assert told["witness"]
        assert told["evidence"]


def test_what_survives_is_told(errata):
    (entry,) = [entry for entry in errata if entry.verdict.id == "e:phinew"]
    assert entry.dependants["e:defq"] == "proved"
    assert "e:defq (proved)" in errata.text()


def test_effective_verdicts_are_told(errata):
    told = {entry.verdict.id: entry.as_dict()["effective"] for entry in errata}
    assert (told["s6p-AB"], told["t:t2-eigenvalue-limit"]) == ("proved", "proved modulo")
    for text in (errata.text(), errata.markdown(), errata.latex()):
        assert text.count("[proved]") + text.count("(proved)") >= 20
        assert "corrected_kind" not in text


def test_markdown_has_all_of_them(errata):
    text = errata.markdown()
    assert text.count("\n### ") == len(errata.remarks)
    assert [f"`{entry.verdict.id}`: " in text for entry in errata] == [True] * len(errata)


def test_each_misprint_has_one_remark_and_each_remark_a_misprint(errata):
    remarked = [name for remark in REMARKS for name in remark.claims]
    assert sorted(remarked) == sorted(entry.verdict.id for entry in errata)
    assert {remark.grade for remark in REMARKS} == set(GRADES)
    told = [entry.as_dict() for entry in errata]
    assert Counter(each["grade"] == "reading" for each in told) == {False: 29, True: 11}
    assert all(each["reason"] and each["survives"] and each["page"] for each in told)
    assert "40 statements fail as printed, in 33 remarks: 29 errors" in errata.text()


def test_a_misprint_without_a_remark_is_no_erratum(errata):
    entry = Erratum(dataclasses.replace(errata[0].verdict, id="e:meq"), {})
    with pytest.raises(LookupError, match="e:meq is corrected and has no remark"):
        entry.as_dict()


def test_every_claim_has_its_place_in_the_paper():
    places = {name: place_of(name) for name in si.claims}
    assert all(place.page in range(1, 25) for place in places.values())
    assert (places["e:meq"].numbers, str(places["t:t3"])) == ("(29)", "p. 18, Theorem 5.3")
    with pytest.raises(KeyError):
        place_of("b:cascade-launch")


def test_reasons_and_not_the_names_of_checks_are_printed(errata):
    for text in (errata.text(), errata.markdown(), errata.latex()):
        assert "fails:" not in text
        assert "positive for every k" not in text


def test_a_person_reads_what_is_printed_and_what_to_read_and_no_text_of_programs(errata):
    for text in (errata.latex(), errata.markdown()):
        body = text.partition("Letters" if text.startswith("#") else "itemize")[2]  # letters come before they are used
        listed, _, rest = body.partition("One by one")
        assert listed.count("(slip). For $") >= 6
        assert listed.count(" read $") >= len(errata.remarks)
        assert not re.search(r"\w\*\w|\*\*\d|= (True|False)|tfrac\{1\}\{32\}", rest)
    assert f"version {si.__version__}, " in errata.latex()


def test_witnesses_are_numbers_that_need_no_machine(errata):
    """Where letters are put into two expressions: few of them, and they are 1."""
    points = [entry.verdict.witness for entry in errata if set(entry.verdict.witness) >= {"at", "stated", "derived"}]
    assert len(points) >= 6
    for point in points:
        values = re.findall(r" = (\S+?)(?:,|$)", point["at"])
        assert set(values) == {"1"}, point
        assert len(values) <= 3, point
        assert len(point["stated"] + point["derived"]) <= 16, point


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("latexmk") is None, reason="needs latexmk")
def test_latex_compiles_without_overfull_lines(errata):
    from singimpact.documents import compiled

    made = compiled(errata.latex())
    assert max(made.overfull, default=0) <= 20
    assert "the list ends on page 2" in made.log
    assert ".pk" not in made.log  # every font is an outline font


def test_errata_from_the_command_line(singimpact, tmp_path):
    assert singimpact("errata", "-o", tmp_path / "errata.txt").exit_code == 0
    assert "s3-dvdt" in (tmp_path / "errata.txt").read_text()
    assert singimpact("errata", "--format", "pdf").stderr.startswith("singimpact: --format pdf goes to a file only")


def test_fixed_points(singimpact):
    found = json.loads(singimpact("fixed-points", "tangency", "--r", "0.7", "--digits", "60", "--json").stdout)
    assert found["m3"]["value"].startswith("1.30746092920422356235740160")
    assert float(found["m3"]["radius"]) < 2e-60
    assert "mu_minus_one" in singimpact("fixed-points", "swan", "--r", "1/2").stdout


@pytest.mark.parametrize(
    "arguments",
    [
        ("--r", "0"),
        ("--r", "1.2"),
        ("--r", "x"),
        ("--r", "1/2", "--digits", "0"),
        ("--r", "1/2", "--digits", "1000000000"),
    ],
)
def test_fixed_points_refuse_in_one_line(singimpact, arguments):
    result = singimpact("fixed-points", "tangency", *arguments)
    assert (result.exit_code, result.stdout, result.stderr.count("\n")) == (2, "", 1)


def test_constants_have_their_claims_and_laws(singimpact):
    rows = json.loads(singimpact("constants", "--r", "1/100", "--digits", "20", "--json").stdout)
    assert [(row["name"], row["order"]) for row in rows] == [
        *((name, order) for order in (1, 2, 3) for name in ("lambda", "mu")), ("X", 2), ("kappa_*", 3)
    ]  # fmt: skip
    assert {row["source"] for row in rows} <= set(si.claims.BEYOND)
    value = {(row["name"], row["order"]): float(row["value"]["value"]) for row in rows}
    assert all(float(row["value"]["radius"]) < 1e-18 for row in rows)
    assert value["lambda", 2] == pytest.approx((0.01 / 3) ** (1 / 3), rel=0.1)
    assert value["mu", 1] == pytest.approx(4 / value["lambda", 1], rel=0.3)
    assert value["kappa_*", 3] == pytest.approx(-56 / 57**1.5 - 225 * 19**0.5 / 13718 / 10, rel=0.01)
    assert "kappa_*" in singimpact("constants", "--r", "0.99").stdout


def test_constants_near_one_follow_their_laws(singimpact):
    rows = json.loads(singimpact("constants", "--r", "0.99", "--json").stdout)
    value = {(row["name"], row["order"]): float(row["value"]["value"]) for row in rows}
    for order in (1, 2, 3):
        assert value["lambda", order] == pytest.approx(1 - 0.03 / (2 * order + 3), abs=1e-4)
        assert value["mu", order] == pytest.approx(1.01, abs=1e-3)
    assert value["X", 2] * 0.01 ** (3 / 7) == pytest.approx(2.94103, rel=0.01)
    assert value["kappa_*", 3] + 2 / 3**1.5 == pytest.approx(0.2844281 * 0.01 ** (6 / 7), rel=0.01)


@pytest.mark.parametrize("wrong", ["1", "0", "0.999", "0.009", "pi/4", "x"])
def test_constants_of_no_such_restitution(wrong, singimpact):
    told = singimpact("constants", "--r", wrong)
    assert told.exit_code == 2
    assert "r = " in told.stderr
