"""The pages of measured figures are of this code: the sources that they name are those of a commit not long ago."""

from __future__ import annotations

import re
import subprocess

import pytest

from singimpact.bench import COMMAND, STRESS_ABOUT, STRESS_COMMAND, digest_of, recorded, stress_page, timed_digest

MOST = 60  # commits between the measurement and now
PAGES = {"benchmarks.md": COMMAND, "stress.md": STRESS_COMMAND}


def git(clone, *words):
    told = subprocess.run(["git", "-C", clone, *words], capture_output=True, text=True)
    if told.returncode:
        pytest.skip(f"the history of the clone is needed: git {words[0]} says {told.stderr.strip()}")
    return told.stdout


def digest_at(clone, commit):
    """The digest of the timed sources of a commit."""
    names = {}
    for line in git(clone, "ls-tree", "-r", commit, "singimpact/").splitlines():
        about, _, path = line.partition("\t")
        names[path.removeprefix("singimpact/")] = about.split()[2]
    return digest_of(names)


def recent(clone):
    """The last commits, down to the last release."""
    released = git(clone, "tag", "--list", "v*", "--merged", "HEAD", "--sort=-creatordate").split()
    since = git(clone, "rev-list", f"{released[0]}~..HEAD").split() if released else []
    commits = git(clone, "rev-list", f"--max-count={MOST}", "HEAD").split()
    return [commit for commit in commits if not released or commit in since]


def test_a_digest_is_the_same_on_disk_and_in_a_commit(clone):
    if not git(clone, "status", "--porcelain", "singimpact"):
        assert digest_at(clone, "HEAD") == timed_digest()
    assert digest_at(clone, "HEAD") != digest_at(clone, git(clone, "rev-list", "HEAD").split()[-1])


@pytest.mark.parametrize("name", PAGES)
def test_a_page_is_not_older_than_the_last_release_or_sixty_commits(name, clone):
    text = (clone / "docs" / name).read_text(encoding="utf-8")
    assert text.startswith(f"<!-- written by `{PAGES[name]}` from sources ")
    assert recorded(text) in {digest_at(clone, commit) for commit in recent(clone)}


def test_the_page_of_stress_is_what_its_command_writes(clone):
    text = (clone / "docs" / "stress.md").read_text(encoding="utf-8")
    assert text.partition("\n")[2].startswith(STRESS_ABOUT)
    assert stress_page("x").partition("\n")[2] == f"{STRESS_ABOUT}\n\nx"


def test_the_page_of_run_times_names_the_commit_that_was_measured(clone):
    text = (clone / "docs" / "benchmarks.md").read_text(encoding="utf-8")
    (commit,) = re.findall(r"^Measured at commit `([0-9a-f]{40})`\.$", text, re.MULTILINE)
    if commit in git(clone, "rev-list", "HEAD").split():
        assert digest_at(clone, commit) == recorded(text)
