"""The bouncing mass of an orbit as a GIF, a page and a film."""

import re
import shutil
from base64 import b64decode
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

import singimpact as si
from singimpact.inputs import InputError


@pytest.fixture(scope="module")
def orbit():
    return si.linear(2, "0.7", "0.5").orbit("1.2", "0.3", impacts=60)


def blue(picture):
    """Rows of the left panel in which the mass stands."""
    pixels = np.asarray(picture.convert("RGB")).astype(int)[:, : picture.width // 5]
    mass = (np.abs(pixels - [0, 114, 178]) < 12).all(axis=2)
    return np.flatnonzero(mass.any(axis=1))


def test_the_mass_is_where_the_orbit_is(orbit, tmp_path):
    begin, end = 3.0, 9.0
    si.animate(orbit, (begin, end), frames=41).save(tmp_path / "bounce.gif")
    with Image.open(tmp_path / "bounce.gif") as film:
        assert film.n_frames == 41
        feet = []
        for at in range(film.n_frames):
            film.seek(at)
            feet.append(blue(film).max())
    heights = orbit.sample(np.linspace(begin, end, 41)).x
    fit = np.polyfit(heights, feet, 1)
    assert fit[0] < 0  # rows count downwards
    assert np.abs(np.polyval(fit, heights) - feet).max() < 1.5  # pixels


def test_a_page_holds_the_film(orbit, tmp_path):
    si.animate(orbit, frames=5).save(tmp_path / "bounce.html")
    (data,) = re.findall(r"data:image/gif;base64,([^\"]+)", (tmp_path / "bounce.html").read_text())
    assert Image.open(BytesIO(b64decode(data))).n_frames == 5
    assert data[:40] in si.animate(orbit, frames=5)._repr_html_()


def test_a_film(orbit, tmp_path):
    if shutil.which("ffmpeg") is None:
        with pytest.raises(InputError, match=r"bounce.mp4 needs the program ffmpeg, .*: install it, or give .gif"):
            si.animate(orbit, frames=5).save(tmp_path / "bounce.mp4")
        assert list(tmp_path.iterdir()) == []
        return
    film = si.animate(orbit, frames=5)
    film.save(tmp_path / "first.mp4")
    film.save(tmp_path / "bounce.gif")
    film.save(tmp_path / "bounce.mp4")
    content = (tmp_path / "bounce.mp4").read_bytes()
    assert b"ftyp" in content[:16]
    assert len(content) == len((tmp_path / "first.mp4").read_bytes())  # the mass is in it after a GIF too


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (lambda orbit: si.animate(orbit, (5, 1)), "between = (5, 1) is not accepted: give two numbers low < high"),
        (lambda orbit: si.animate(orbit, 3), "between = 3 is not accepted: give two numbers low < high"),
        (lambda orbit: si.animate(orbit, (0, 2)), "between = (0, 2) is not accepted: give two times from 1.2 to"),
        (lambda orbit: si.animate(orbit, frames=1), "frames = 1 is not accepted: give a whole number from 2 to 10000"),
        (lambda _: si.animate(3), "orbit = 'int' is not accepted: give an orbit of `osc.orbit`"),
        (lambda orbit: si.animate(orbit).save("x.avi"), "a file name ending in .gif, .html or .mp4"),
        (lambda orbit: si.plot(orbit.section(), sheet=True), "give an orbit, or a diagram and branches over it"),
    ],
)
def test_refusals(orbit, call, told):
    with pytest.raises(InputError) as caught:
        call(orbit)
    assert told in str(caught.value)


def test_sheets_of_an_orbit_and_of_a_diagram_with_branches(orbit):
    labels = [axes.get_xlabel() for axes in si.plot(orbit, sheet=True)]
    assert labels[:3] == ["time $t$", "displacement $x$", "time $t$"]
    assert labels[3:] == ["time before its end"] * ("complete" in orbit.kind)
    osc = si.linear("2.8", "0.1", "0.8", amplitude=-1)
    diagram = osc.bifurcation("clearance", (0, "0.2"), points=3)
    above, below = si.plot([diagram, osc.periodic(1, 1)[0].branch("clearance", (0, "0.2"))], sheet=True)
    assert above.get_ylabel().startswith("velocity")
    assert below.get_ylabel().startswith("phase")
    assert len(above.lines) > len(si.plot(diagram, sheet=True)[0].lines)
