"""Files are whole or absent, and a place that cannot be written is refused in one line."""

import os

import pytest

from singimpact import InputError
from singimpact.store import folder, require_writable, write_text, written


def test_a_file_appears_whole(tmp_path):
    write_text(tmp_path / "a.txt", "one\n")
    write_text(tmp_path / "a.txt", "two\n")
    assert (tmp_path / "a.txt").read_text() == "two\n"
    assert len(list(tmp_path.iterdir())) == 1


def test_what_was_there_survives_a_failure(tmp_path):
    write_text(tmp_path / "a.txt", "one\n")
    with pytest.raises(ZeroDivisionError), written(tmp_path / "a.txt") as draft:
        draft.write_text(str(1 / 0))
    assert (tmp_path / "a.txt").read_text() == "one\n"
    assert len(list(tmp_path.iterdir())) == 1


def test_permissions_are_the_usual_ones(tmp_path):
    write_text(tmp_path / "a.txt", "one\n")
    (tmp_path / "b.txt").write_text("one\n")
    modes = [os.stat(tmp_path / name).st_mode for name in ("a.txt", "b.txt")]
    assert modes[0] == modes[1]


@pytest.mark.parametrize("place", ["absent/a.txt", ".", "file/a.txt", "a" * 400, "nul\0byte"])
def test_a_place_that_cannot_be_written(place, tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match="output = "):
        require_writable(os.path.join(tmp_path, place))
    assert [item.name for item in tmp_path.iterdir()] == ["file"]


def test_a_link_stays_a_link(tmp_path):
    (tmp_path / "link").symlink_to(tmp_path / "a.txt")
    write_text(tmp_path / "link", "one\n")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "a.txt").read_text() == "one\n"


def test_a_device_stays_a_device():
    write_text(os.devnull, "one\n")
    assert not os.path.isfile(os.devnull)


def test_a_folder_is_made(tmp_path):
    assert folder(tmp_path / "a" / "b").is_dir()
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match="output = "):
        folder(tmp_path / "file")


def test_output_through_a_link_goes_to_the_file_that_it_names(tmp_path):
    target, link = tmp_path / "real.txt", tmp_path / "link.txt"
    target.write_text("old")
    link.symlink_to(target)
    write_text(link, "new")
    assert link.is_symlink()
    assert target.read_text() == "new"
