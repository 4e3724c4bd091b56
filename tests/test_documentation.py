"""The documentation builds without a warning, offline, and says of each command and figure what there is now."""

import re
import subprocess
import sys

import pytest

from singimpact.cli.group import COMMANDS


@pytest.fixture(scope="module")
def site(request, tmp_path_factory):
    pytest.importorskip("sphinx", reason="needs the extra docs")
    place = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-b", "html", "docs", str(place)]
    done = subprocess.run(command, cwd=request.config.rootpath, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    return place


@pytest.mark.slow
def test_pages_are_there(site):
    pages = ["index", "tutorial", "gallery", "how_to", "reference", "conventions", "trust", "stress", "benchmarks"]
    ideas = ["index", "impact_surface", "regular", "tangency", "swan", "unfolding", "one_structure"]
    ideas += ["branches", "manifolds"]
    computed = ["errata", "claims", "commands", "figures"]
    pages += ["changelog", "citation", "bibliography"]
    pages += [f"explanation/{name}" for name in ideas] + [f"computed/{name}" for name in computed]
    assert [page for page in pages if (site / f"{page}.html").stat().st_size < 3000] == []


@pytest.mark.slow
def test_every_command_and_figure_is_there(site):
    told = (site / "computed" / "commands.html").read_text()
    assert [name for name in COMMANDS if f"singimpact {name}" not in told] == []
    assert len(list((site / "_images").glob("figure[0-9]*.png"))) == 17


@pytest.mark.slow
def test_every_task_of_the_list_is_a_section(site):
    told = (site / "how_to.html").read_text()
    links = re.findall(r'href="#([\w-]+)"', told.partition("<h2>")[0])
    assert len(set(links)) > 20
    assert [link for link in links if f'id="{link}"' not in told] == []


@pytest.mark.slow
def test_public_names_are_in_the_reference(site):
    import singimpact as si

    told = (site / "reference.html").read_text()
    missing = [name for name in si._HOMES if not re.search(rf'id="[\w.]*\b{name}"', told)]
    assert missing == []


@pytest.mark.slow
def test_pages_ask_no_other_machine_for_anything(site):
    page = (site / "explanation" / "tangency.html").read_text()
    assert not re.findall(r'(?:src|href)="https?://[^"]*\.(?:js|css)', page)


@pytest.mark.slow
def test_a_wrong_reference_is_a_warning(tmp_path):
    """The build that CI trusts does fail when something is wrong."""
    pytest.importorskip("sphinx", reason="needs the extra docs")
    (tmp_path / "conf.py").write_text('extensions = ["myst_parser"]\n')
    (tmp_path / "index.md").write_text("# A page\n\n[nowhere](missing.md)\n")
    command = [sys.executable, "-m", "sphinx", "-W", "-q", "-b", "html", str(tmp_path), str(tmp_path / "out")]
    assert subprocess.run(command, capture_output=True, check=False).returncode != 0
