"""What a shell is told when a person presses tab."""

import os
import subprocess
import sys

import pytest


def completed(words, count):
    env = os.environ | {"_SINGIMPACT_COMPLETE": "bash_complete", "COMP_WORDS": words, "COMP_CWORD": str(count)}
    done = subprocess.run([sys.executable, "-m", "singimpact"], env=env, capture_output=True, text=True, check=True)
    return {line.partition(",")[2] for line in done.stdout.split()}


@pytest.mark.parametrize(
    ("words", "count", "wanted"),
    [("singimpact fi", 1, {"figure", "fixed-points"}), ("singimpact map --ta", 2, {"--tau"})],
)
def test_commands_and_options_are_completed(words, count, wanted):
    assert completed(words, count) == wanted
