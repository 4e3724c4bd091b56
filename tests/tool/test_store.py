"""Files are whole or absent, and a place that cannot be written is refused in one line."""

import os

import pytest

from singimpact import InputError, cache
from singimpact.store import cache_folder, folder, passing_folder, require_writable, write_text, written


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


@pytest.fixture
def place(tmp_path, monkeypatch):
    from singimpact import store

    monkeypatch.setenv("SINGIMPACT_CACHE", str(tmp_path / "cache"))
    store._tell_once.cache_clear()
    return tmp_path / "cache"


def test_folders_of_the_cache_are_made_for_their_user_alone(place):
    before = os.umask(0)
    try:
        cache.keep(place / "curves" / "entry", b"42")
    finally:
        os.umask(before)
    assert cache.recall(place / "curves" / "entry") == b"42"
    assert [(path.stat().st_mode & 0o777) for path in (place, place / "curves")] == [0o700, 0o700]


@pytest.mark.parametrize("mode", [0o777, 0o775, 0o702])
def test_a_cache_that_others_can_write_is_not_used(place, mode, capsys):
    place.mkdir()
    place.chmod(mode)
    assert cache_folder() == cache_folder() == passing_folder()
    told = capsys.readouterr().err.splitlines()
    assert len(told) == 1
    assert "others can write it" in told[0]


def test_a_cache_of_another_user_is_not_used(place, monkeypatch, capsys):
    place.mkdir(mode=0o700)
    monkeypatch.setattr(os, "getuid", lambda: place.stat().st_uid + 1)
    assert cache_folder() == passing_folder()
    assert "belongs to another user" in capsys.readouterr().err


def test_an_entry_in_a_folder_that_others_can_write_is_neither_read_nor_written(place):
    place.mkdir(mode=0o755)
    place.chmod(0o755)
    cache.keep(place / "curves" / "entry", b"42")
    (place / "curves").chmod(0o777)
    assert cache.recall(place / "curves" / "entry") is None
    cache.keep(place / "curves" / "entry", b"43")
    (place / "curves").chmod(0o700)
    assert cache.recall(place / "curves" / "entry") == b"42"


def test_links_in_the_cache_are_not_followed(place, tmp_path):
    mine = tmp_path / "mine.txt"
    mine.write_text("mine")
    entry = place / "curves" / "entry"
    cache.keep(place / "curves" / "other", b"1")
    entry.symlink_to(mine)
    assert cache.recall(entry) is None
    cache.keep(entry, b"42")
    assert mine.read_text() == "mine"
    assert not entry.is_symlink()
    assert cache.recall(entry) == b"42"


def test_a_tilde_in_the_name_of_the_cache_is_the_users_folder(tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("SINGIMPACT_CACHE", "~/kept")
    assert cache_folder() == tmp_path / "kept"


@pytest.mark.skipif(os.name != "posix" or os.uname().sysname != "Linux", reason="the folder is the system's to name")
def test_without_a_name_the_cache_is_where_the_system_keeps_them(tmp_path, monkeypatch):
    monkeypatch.delenv("SINGIMPACT_CACHE")
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    assert cache_folder() == tmp_path / ".cache" / "singimpact"
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "x"))
    assert cache_folder() == tmp_path / "x" / "singimpact"
