"""The documentation builds without a warning, offline, and says of each command and figure what there is now.

In a browser no page scrolls sideways, and the search finds what is looked for.
"""

import functools
import http.server
import inspect
import re
import subprocess
import sys
import threading

import pytest

from singimpact.cli import COMMANDS


@pytest.fixture(scope="module")
def site(request, tmp_path_factory):
    pytest.importorskip("sphinx", reason="needs the extra docs")
    place = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-b", "html", "docs", str(place)]
    done = subprocess.run(command, cwd=request.config.rootpath, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    words = [line for line in done.stderr.splitlines() if not line.startswith("singimpact: ")]  # of what takes long
    assert words == []
    return place


@pytest.mark.slow
def test_pages_are_there(site, clone):
    pages = ["index", "install", "tutorial", "notebooks", "computed/gallery/index", "how_to", "reference"]
    pages += ["conventions", "trust", "stress", "benchmarks"]
    ideas = ["index", "impact_surface", "regular", "tangency", "swan", "unfolding", "one_structure"]
    ideas += ["fates", "branches", "gamma_proved", "manifolds", "grazing_exponent"]
    computed = ["errata", "claims", "commands", "figures"]
    pages += ["changelog", "citation", "bibliography", "faq", "models", "stability"]
    pages += [f"reference/{path.stem}" for path in (clone / "docs" / "reference").glob("*.md")]
    pages += [f"computed/notebooks/{path.stem}" for path in (clone / "notebooks").glob("*.ipynb")]
    pages += [f"explanation/{name}" for name in ideas] + [f"computed/{name}" for name in computed]
    assert [page for page in pages if (site / f"{page}.html").stat().st_size < 3000] == []


@pytest.mark.slow
def test_every_command_and_figure_is_there(site):
    told = (site / "computed" / "commands.html").read_text()
    assert [name for name in COMMANDS if f"singimpact {name}" not in told] == []
    assert len(list((site / "_images").glob("figure[0-9]*.png"))) == 17


def scripts(clone):
    return sorted((clone / "docs" / "gallery").glob("*/plot_*.py"))


def links(page, ending):
    """The files with an ending to which a page of the site links."""
    found = re.findall(rf'href="([^"#:]+{re.escape(ending)})"', page.read_text())
    return [(page.parent / link).resolve() for link in found]


@pytest.mark.slow
def test_each_case_of_the_gallery_has_a_picture_a_script_and_a_notebook(site, clone):
    assert len(scripts(clone)) >= 20
    index = (site / "computed" / "gallery" / "index.html").read_text()
    for script in scripts(clone):
        page = site / "computed" / "gallery" / script.parent.name / f"{script.stem}.html"
        assert f'href="{script.parent.name}/{page.name}"' in index
        assert re.search(rf'src="[^"]*sphx_glr_{script.stem}_(thumb|001)\.(png|gif)"', index), script
        assert len(re.findall(rf'src="[^"]*sphx_glr_{script.stem}_\d+\.(?:png|gif)"', page.read_text())) == 1, script
        for ending in (".py", ".ipynb"):
            (file,) = links(page, ending)
            assert file.name == f"{script.stem}{ending}"
            assert file.is_file()


def test_a_case_of_the_gallery_is_short_and_ends_with_a_caption(clone):
    for script in scripts(clone):
        words, code, caption = re.fullmatch(r'"""(.*?)"""\n(.*?)# %%\n(.*)', script.read_text(), re.DOTALL).groups()
        title, line, sentences = words.strip().split("\n", 2)
        assert len(title) == len(line), script
        assert sentences.strip().endswith(".")
        assert caption.strip().endswith("."), script
        lines = [line for line in code.splitlines() if line and not line.startswith(("import ", "from "))]
        assert len(lines) <= 20, script


@pytest.mark.slow
@pytest.mark.usefixtures("site")
def test_a_script_leaves_no_file_beside_it(clone):
    files = [path for path in (clone / "docs" / "gallery").rglob("*") if path.is_file() and path.suffix != ".pyc"]
    assert {path.name for path in files} - {path.name for path in scripts(clone)} == {".gitignore", "README.rst"}


@pytest.mark.slow
def test_an_entry_of_the_reference_links_its_examples(site):
    models, series = ((site / "reference" / f"{name}.html").read_text() for name in ("models", "theory"))
    for name, page, case in [
        ("singimpact.studies.basins", models, "2_attractors/plot_basins"),
        ("singimpact.impact_oscillator.ImpactOscillator.basins", models, "2_attractors/plot_basins"),
        ("singimpact.impact_oscillator.ImpactOscillator.orbit", models, "1_motion/plot_orbit"),
        ("singimpact.theory.formulas.chatter_limit", series, "4_graze/plot_series"),
    ]:
        entry = page.partition(f'id="{name}"')[2].partition('<dt class="sig')[0]
        assert "Examples with this function" in entry
        assert f"computed/gallery/{case}.html" in entry
    entry = series.partition('id="singimpact.theory.formulas.chatter_limit"')[2].partition('<dt class="sig')[0]
    assert "plot_chatter_limit" not in entry  # the method of a model is another function


@pytest.mark.slow
def test_notebooks_are_pages_with_their_pictures_to_download(site, clone):
    for notebook in (clone / "notebooks").glob("*.ipynb"):
        page = site / "computed" / "notebooks" / f"{notebook.stem}.html"
        (file,) = links(page, ".ipynb")
        assert file.read_bytes() == notebook.read_bytes()
        assert re.search(rf'src="[^"]*{notebook.stem}_\d+_\d+\.png"', page.read_text())


@pytest.mark.slow
def test_an_error_in_a_script_ends_the_build(tmp_path):
    pytest.importorskip("sphinx_gallery", reason="needs the extra docs")
    (tmp_path / "gallery").mkdir()
    (tmp_path / "conf.py").write_text(
        'extensions = ["sphinx_gallery.gen_gallery"]\n'
        'sphinx_gallery_conf = {"examples_dirs": "gallery", "gallery_dirs": "cases"}\nexclude_patterns = ["gallery"]\n'
    )
    (tmp_path / "index.rst").write_text("A page\n======\n\n.. toctree::\n\n   cases/index\n")
    (tmp_path / "gallery" / "README.rst").write_text("Cases\n=====\n")
    script = tmp_path / "gallery" / "plot_a.py"
    command = [sys.executable, "-m", "sphinx", "-W", "-q", "-b", "html", str(tmp_path), str(tmp_path / "out")]
    for line, ends in [("assert 1 + 1 == 3", True), ("assert 1 + 1 == 2", False)]:
        script.write_text(f'"""\nA case\n======\n"""\n\n{line}\n')
        assert (subprocess.run(command, capture_output=True, check=False).returncode != 0) is ends


@pytest.mark.slow
def test_six_named_models_are_live_pages(site):
    live = sorted(path.stem for path in (site / "explore").glob("*.html"))
    assert len(live) == 6
    for name in live:
        assert (site / "explore" / f"{name}.html").stat().st_size < 400_000
        assert f'<iframe src="../explore/{name}.html"' in (site / "models" / f"{name}.html").read_text()
    assert re.search(r'<iframe src="explore/(\w+).html"', (site / "index.html").read_text())[1] in live


@pytest.mark.slow
def test_every_task_of_the_list_is_a_section(site):
    told = (site / "how_to.html").read_text()
    links = re.findall(r'href="#([\w-]+)"', told.partition("<h2>")[0])
    assert len(set(links)) > 20
    assert [link for link in links if f'id="{link}"' not in told] == []


@pytest.mark.slow
def test_public_names_are_in_the_reference(site):
    import singimpact as si

    told = "".join(page.read_text() for page in (site / "reference").glob("*.html"))
    things = [name for name in si._HOMES if not inspect.ismodule(getattr(si, name))]
    missing = [name for name in things if not re.search(rf'id="[\w.]*\b{name}"', told)]
    assert missing == []


@pytest.mark.slow
def test_each_claim_has_its_formula_and_each_section_is_a_node(site):
    from singimpact.paper import INDEX

    told = (site / "computed" / "claims.html").read_text()
    graph = (site / "computed" / "graph.html").read_text()
    anchors = {name: "at-" + re.sub(r"[^\w]+", "-", name).strip("-") for name in INDEX}
    assert len(set(anchors.values())) == len(INDEX) == 147
    assert [name for name, at in anchors.items() if f'id="{at}"' not in told] == []
    assert told.count('class="math notranslate') >= 147 + 40
    sections = {entry.section for entry in INDEX.values()}
    assert len(re.findall(r"<a href=\"#at-[^>]*onclick", graph)) == graph.count("<details") == len(sections)
    linked = re.findall(r'href="claims\.html#([\w-]+)"', graph)
    assert set(anchors.values()) == set(linked)


@pytest.mark.slow
def test_a_click_on_a_section_opens_its_claims(address, browser):
    browser.get(f"{address}/computed/graph.html")
    opened = "return [...document.querySelectorAll('details')].map((each) => each.open)"
    assert not any(browser.execute_script(opened))
    browser.execute_script("document.querySelectorAll('.section-graph a')[2].dispatchEvent(new MouseEvent('click'))")
    assert [n for n, is_open in enumerate(browser.execute_script(opened)) if is_open] == [2]


class Quiet(http.server.SimpleHTTPRequestHandler):
    """A server that writes no line for each request."""

    def log_message(self, *_):
        pass


@pytest.fixture(scope="module")
def address(site):
    """Of the site on this machine: over file:// a browser refuses the texts that the search reads."""
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=str(site))) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}"
        server.shutdown()


def set_width(browser, width):
    size = {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)


SET = """const done = arguments[0], math = window.MathJax && MathJax.startup && MathJax.startup.promise;
Promise.resolve(math).then(() => document.fonts.ready).then(() => done());"""
# furo cuts off what is wider than the box of a page's text, so that box counts too; widths are rounded to whole pixels
WIDER = """return [document.documentElement, ...document.querySelectorAll(".main, .content")]
  .filter((node) => node.scrollWidth > node.clientWidth + 1).map((node) => [node.className, node.scrollWidth]);"""


def wider_than_the_screen(browser, address, width):
    set_width(browser, width)
    browser.get(address)
    browser.execute_async_script(SET)
    return browser.execute_script(WIDER)


@pytest.mark.slow
@pytest.mark.parametrize("width", [1440, 390])
def test_no_page_scrolls_sideways(width, site, address, browser):
    pages = sorted(path.relative_to(site).as_posix() for path in site.rglob("*.html") if "_static" not in path.parts)
    assert len(pages) > 35
    found = {page: wider_than_the_screen(browser, f"{address}/{page}", width) for page in pages}
    assert {page: boxes for page, boxes in found.items() if boxes} == {}


@pytest.mark.slow
def test_a_page_that_scrolls_sideways_is_seen(address, browser):
    wider_than_the_screen(browser, f"{address}/trust.html", 390)
    wide = "document.querySelector('article p').style.width = '600px';"
    browser.execute_script(wide)
    assert browser.execute_script(WIDER)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "pages"),
    [("lyapunov", {"how_to.html", "reference/dynamics.html"}), ("basin", {"how_to.html"}),
     ("grazing_map", {"reference/theory.html"}), ("cluster", {"how_to.html"})],
)  # fmt: skip
def test_search_finds_the_page(words, pages, address, browser):
    from selenium.webdriver.support.ui import WebDriverWait

    browser.get(f"{address}/search.html?q={words}")
    ended = "return document.querySelector('#search-results .search-summary')?.textContent || ''"
    WebDriverWait(browser, 30).until(lambda each: re.search(r"\d+ pages?|did not match", each.execute_script(ended)))
    links = browser.execute_script("return [...document.querySelectorAll('#search-results li a')].map((a) => a.href)")
    assert pages <= {link.partition("#")[0].partition("?")[0].removeprefix(f"{address}/") for link in links}


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
