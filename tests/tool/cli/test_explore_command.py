"""explore: a page in a file, its curves as JSON, a browser, a line for a mistake."""

import json
import webbrowser

import pytest

LINEAR = ["--omega", "2", "--clearance", "0.9", "--restitution", "1/2", "--points", "2"]


def test_page_in_a_file(singimpact, tmp_path):
    model = tmp_path / "model.toml"
    model.write_text('f = "x"\ng = "cos(2*t)"\nclearance = "0.9"\nrestitution = "1/2"\n')
    done = singimpact("explore", model, "--points", "2", "--html", tmp_path / "page.html")
    assert (done.exit_code, done.output) == (0, "")
    assert "<title>x&#x27;&#x27; + x = cos(2*t), x ≥ c</title>" in (tmp_path / "page.html").read_text()


def test_curves_as_json(singimpact):
    told = json.loads(singimpact("explore", *LINEAR, "--json").output)
    assert told["swan"]["kind"] == "negative"
    assert len(told["frames"]) == 2
    assert set(told["frames"][0]["curves"]) == {"Z", "H", "P", "jumps", "gamma"}


def test_two_walls(singimpact):
    told = json.loads(singimpact("explore", *LINEAR, "--upper", "1.2", "--json").output)
    assert set(told["frames"][0]["curves"]) == {"Z", "H", "P", "jumps", "gamma", "cut", "cut-launches"}
    assert "The upper wall stays at x = 1.2" in told["text"]


def test_a_range_without_a_swan_says_so(singimpact):
    told = json.loads(singimpact("explore", *LINEAR, "--json", "--between", "2", "3").output)
    assert (told["swan"], told["text"]) == (None, "No swan lies between c = 2 and c = 3.")


@pytest.mark.parametrize("opens", [True, False])
def test_window(singimpact, monkeypatch, opens):
    asked = []
    monkeypatch.setattr(webbrowser, "open", lambda place: asked.append(place) or opens)
    done = singimpact("explore", *LINEAR)
    assert asked[0].startswith("file:")
    assert done.exit_code == 0  # the page is written
    assert opens or "--html FILE" in done.stderr


@pytest.mark.parametrize(
    ("given", "told"),
    [
        (["model.toml", "--model", "other.toml"], "two models"),
        ([*LINEAR, "--html", "a.html", "-o", "b.html"], "two files"),
        ([*LINEAR, "--json", "--between", "3", "2"], "between"),
        ([*LINEAR, "--html", "/no/such/folder/page.html"], "/no/such/folder"),
    ],
)
def test_refusals(singimpact, given, told):
    refused = singimpact("explore", *given)
    assert (refused.exit_code, refused.stderr.count("\n")) == (2, 1)
    assert told in refused.stderr
