"""Change one place of the program at a time and see whether a test fails: `python tests/mutation/mutate.py`.

Mutants are drawn by a seed over the files below, and the survivors of earlier runs, in `known.json`, are tried again.
Each is applied in a copy of the checkout; doctests of its file run first, then the tests that guard it, and the first
failure ends the trial.  A mutant that no test notices is printed with its line.  Results are kept in a file, so that
an interrupted run goes on.  The exit code is 1 when more than 5 % survive.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

from single_changes import Mutant, mutants_of

ROOT = Path(__file__).parents[2]
KNOWN = Path(__file__).with_name("known.json")
CLAIMS = ["tests/paper/claims/test_claims.py", "tests/paper/sections/test_derivations.py"]
# files -> the tests that guard them, the quickest first; doctests of the file itself come before
GUARDS = {
    "singimpact/theory/sheet.py": ["tests/theory", *CLAIMS],
    "singimpact/theory/homogeneous.py": ["tests/theory", *CLAIMS],
    "singimpact/theory/fixed_points.py": ["tests/theory", "tests/algebra"],
    "singimpact/theory/invariant_curve.py": ["tests/theory", "tests/dynamics"],
    "singimpact/theory/completion.py": ["tests/theory", "tests/dynamics"],
    "singimpact/contact/contact.py": ["tests/contact", "tests/theory"],
    "singimpact/contact/points.py": ["tests/contact", "tests/surface"],
    "singimpact/paper/routes/fold.py": ["tests/paper/routes", *CLAIMS],
    "singimpact/paper/routes/swan.py": ["tests/paper/routes", *CLAIMS],
    "singimpact/paper/routes/unfolding.py": ["tests/paper/routes", *CLAIMS],
    "singimpact/paper/claims/sections/section4b.py": CLAIMS,
    "singimpact/paper/claims/sections/section5.py": CLAIMS,
    "singimpact/paper/claims/verifiers.py": CLAIMS,
    "singimpact/algebra/checking.py": ["tests/algebra", "tests/fuzzing/test_certificates_fuzzed.py"],
    "singimpact/algebra/plain.py": ["tests/algebra", "tests/fuzzing/test_certificates_fuzzed.py"],
    "singimpact/dynamics/chatter.py": ["tests/dynamics"],
    "singimpact/dynamics/remaining.py": ["tests/dynamics"],
    "singimpact/flights/kernels/roots.py": ["tests/flights"],
    "singimpact/flights/kernels/steps.py": ["tests/flights"],
    "singimpact/flights/no_return/barrier.py": ["tests/flights"],
}
SECONDS = 600.0  # a mutant may make a loop endless: a trial that takes longer counts as noticed


def drawn(count: int, seed: int) -> list[Mutant]:
    """So many mutants over the files that are there, each file alike, none twice."""
    rng = random.Random(seed)
    pools = {file: mutants_of(file, (ROOT / file).read_text()) for file in GUARDS if (ROOT / file).exists()}
    for pool in pools.values():
        rng.shuffle(pool)
    chosen: list[Mutant] = []
    while len(chosen) < count and any(pools.values()):
        chosen += [pool.pop() for pool in pools.values() if pool]
    return sorted(chosen[:count], key=str)


def known() -> list[Mutant]:
    """Survivors of earlier runs whose place is still there: file, the line of code, what becomes of it."""
    found = []
    for each in json.loads(KNOWN.read_text()) if KNOWN.exists() else []:
        source = (ROOT / each["file"]).read_text() if (ROOT / each["file"]).exists() else ""
        if source.count(each["was"]) == 1:
            start = source.index(each["was"])
            line = source[:start].count("\n") + 1
            found.append(Mutant(each["file"], line, start, start + len(each["was"]), each["was"], each["text"]))
        else:
            print(f"not tried, {each['was']!r} is not once in {each['file']}")
    return found


def noticed(mutant: Mutant, copy: Path) -> str:
    """The test that fails with a mutant, or "" when none does."""
    path = copy / mutant.file
    whole = path.read_text()
    path.write_text(mutant.applied(whole))
    # not those of a run of tests that this one may be a part of, nor of what counts its lines
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("SLIPCOVER", "PYTEST"))}
    environment |= {"PYTHONPATH": str(copy), "PYTHONDONTWRITEBYTECODE": "1"}
    try:
        for target in [mutant.file, *GUARDS[mutant.file]]:
            if not (copy / target).exists():
                continue
            command = [sys.executable, "-m", "pytest", "-x", "-q", "-n", "0", "-p", "no:cacheprovider", target]
            try:
                done = subprocess.run(
                    command, cwd=copy, env=environment, capture_output=True, text=True, timeout=SECONDS, check=False
                )
            except subprocess.TimeoutExpired:
                return f"{target} (no end within {SECONDS:.0f} s)"
            if done.returncode not in (0, 5):  # 5: no tests there
                failed = [line for line in done.stdout.splitlines() if line.startswith(("FAILED", "ERROR"))]
                return failed[0].split(" - ")[0] if failed else target
        return ""
    finally:
        path.write_text(whole)


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--count", type=int, default=150, help="how many mutants are drawn")
    options.add_argument("--seed", type=int, default=20261121)
    options.add_argument("--only", default="", help="a part of the names of files")
    options.add_argument("--results", type=Path, default=ROOT / "mutants.json", help="results, to go on from")
    options.add_argument("--list", action="store_true", help="print the mutants and try none")
    asked = options.parse_args()
    chosen = [each for each in [*known(), *drawn(asked.count, asked.seed)] if asked.only in each.file]
    if asked.list:
        print(*chosen, sep="\n")
        return 0
    results = json.loads(asked.results.read_text()) if asked.results.exists() else {}
    with tempfile.TemporaryDirectory() as place:
        copy = Path(place) / "checkout"
        shutil.copytree(ROOT, copy, ignore=shutil.ignore_patterns(".git", "__pycache__", "build", "*.egg-info"))
        for number, mutant in enumerate(chosen, 1):
            if str(mutant) in results:
                continue
            began = time.monotonic()
            results[str(mutant)] = noticed(mutant, copy)
            asked.results.write_text(json.dumps(results, indent=1) + "\n")
            told = results[str(mutant)] or "SURVIVES"
            print(f"{number}/{len(chosen)} {mutant}: {told} ({time.monotonic() - began:.0f} s)", flush=True)
    survivors = [str(mutant) for mutant in chosen if not results[str(mutant)]]
    print(f"{len(chosen)} mutants, {len(survivors)} survive ({100 * len(survivors) / max(1, len(chosen)):.1f} %)")
    print(*survivors, sep="\n")
    return int(len(survivors) > 0.05 * len(chosen))


if __name__ == "__main__":
    sys.exit(main())
