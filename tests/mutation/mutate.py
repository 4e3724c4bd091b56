"""Change one place of the program at a time and see whether a test fails: `python tests/mutation/mutate.py`.

Mutants are drawn by a seed over the files below, and the survivors of earlier runs, in `known.json`, are tried again.
Each is applied in a copy of the checkout.  The doctests of its file are tried first, then the tests that run its line,
the quickest before the others (`--lines` keeps which they are), then all tests that guard it; the first failure ends
the trial.  A mutant that no test notices is printed with its line.  Results are kept in a file, so that an interrupted
run goes on.  The exit code is 1 when more than 5 % survive, or one survives that `explained.json` does not explain.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

from single_changes import Mutant, mutants_of

ROOT = Path(__file__).parents[2]
KNOWN = Path(__file__).with_name("known.json")
EXPLAINED = Path(__file__).with_name("explained.json")
CLAIMS = [
    "tests/paper/claims/test_statements_read_back.py",
    "tests/paper/claims/test_claims.py",
    "tests/paper/sections/test_derivations.py",
]
# files -> the tests that guard them, the quickest first; doctests of the file itself come before
GUARDS = {
    "singimpact/theory/impact_sheet.py": ["tests/tool/theory", *CLAIMS],
    "singimpact/theory/multipliers.py": ["tests/tool/theory", *CLAIMS],
    "singimpact/theory/fixed_points.py": ["tests/tool/theory", "tests/tool/algebra"],
    "singimpact/theory/gamma_series.py": ["tests/tool/theory", "tests/tool/dynamics"],
    "singimpact/theory/completion.py": ["tests/tool/theory", "tests/tool/dynamics"],
    "singimpact/contact/contact.py": ["tests/tool/contact", "tests/tool/theory"],
    "singimpact/contact/points.py": ["tests/tool/contact", "tests/tool/surface"],
    "singimpact/paper/routes/fold.py": ["tests/paper/routes", *CLAIMS],
    "singimpact/paper/routes/swan.py": ["tests/paper/routes", *CLAIMS],
    "singimpact/paper/routes/unfolding.py": ["tests/paper/routes", *CLAIMS],
    "singimpact/paper/claims/sections/section4b.py": CLAIMS,
    "singimpact/paper/claims/sections/section5.py": CLAIMS,
    "singimpact/paper/claims/verifiers.py": CLAIMS,
    "singimpact/certificates/claims_proofs.py": [
        "tests/tool/algebra",
        "tests/tool/fuzzing/test_certificates_fuzzed.py",
    ],
    "singimpact/dynamics/chatter.py": ["tests/tool/dynamics"],
    "singimpact/dynamics/remaining.py": ["tests/tool/dynamics"],
    "singimpact/flights/kernels/roots.py": ["tests/tool/flights"],
    "singimpact/flights/kernels/steps.py": ["tests/tool/flights"],
    "singimpact/flights/no_return/barrier.py": ["tests/tool/flights"],
}
KNOWN_ALONE = {
    "singimpact/flights/no_return/polynomial.py": ["tests/tool/flights"],
    "singimpact/paper/claims/sections/section4a_arc.py": CLAIMS,
    "singimpact/paper/claims/sections/section6.py": CLAIMS,
}
"""Files that have survivors of earlier runs, and no mutants of a seed."""
SECONDS = 400.0  # a mutant may make a loop endless: a trial that takes longer counts as noticed
NEAR = 20.0  # seconds of tests that run the line of a mutant, before all tests that guard its file
Lines = dict[str, dict[str, list[tuple[str, float]]]]  # file, line: tests with their seconds


def guards_of(file: str) -> list[str]:
    """The tests that guard a file."""
    return GUARDS.get(file) or KNOWN_ALONE[file]


def drawn(count: int, seed: int) -> list[Mutant]:
    """So many mutants over the files that are there, each file alike, none twice."""
    pools = {file: mutants_of(file, (ROOT / file).read_text()) for file in GUARDS if (ROOT / file).exists()}
    for file, pool in pools.items():
        random.Random(f"{seed} {file}").shuffle(pool)  # a file that is edited changes its own mutants alone
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


def reason(mutant: Mutant) -> str:
    """Why a mutant survives: file, its line of code, what becomes of a part of it; or that nobody has said."""
    line = (ROOT / mutant.file).read_text().splitlines()[mutant.line - 1].strip()
    place = {"file": mutant.file, "line": line, "was": mutant.was, "text": mutant.text}
    told = json.loads(EXPLAINED.read_text()) if EXPLAINED.exists() else []
    return next((each["because"] for each in told if place.items() <= each.items()), "NOT EXPLAINED")


def lines_run(copy: Path, files: list[str]) -> Lines:
    """Which tests of the guards run which lines of the files; the tests must pass as they are."""
    with tempfile.TemporaryDirectory() as place:
        kept = Path(place) / "lines.json"
        told = {"MUTATION_FILES": json.dumps(files), "MUTATION_LINES": str(kept)}
        targets = sorted({each for file in files for each in [file, *guards_of(file)] if (copy / each).exists()})
        done = _tests(copy, ["-p", "lines_run", *targets], told)
        if done.returncode:
            raise SystemExit("\n".join(["the tests fail before anything is changed", *done.stdout.splitlines()[-20:]]))
        found: Lines = json.loads(kept.read_text())
        return found


def nearest(mutant: Mutant, lines: Lines) -> list[str]:
    """The quickest tests that run the line of a mutant, as many as fit into some seconds."""
    chosen, spent = list[str](), 0.0
    for test, seconds in sorted(lines.get(mutant.file, {}).get(str(mutant.line), []), key=lambda each: each[1]):
        spent += seconds
        if spent > NEAR and chosen:
            break
        chosen.append(test)
    return chosen


def noticed(mutant: Mutant, copy: Path, lines: Lines) -> str:
    """The test that fails with a mutant, or "" when none does."""
    path = copy / mutant.file
    whole = path.read_text()
    path.write_text(mutant.applied(whole))
    near = nearest(mutant, lines)
    guards = [[each] for each in guards_of(mutant.file) if (copy / each).exists()]
    try:
        for targets in ([mutant.file], *([near] if near else []), *guards):
            try:
                done = _tests(copy, ["-x", *targets])
            except subprocess.TimeoutExpired:
                return f"{targets[0]} (no end within {SECONDS:.0f} s)"
            if done.returncode not in (0, 5):  # 5: no tests there
                failed = [line for line in done.stdout.splitlines() if line.startswith(("FAILED", "ERROR"))]
                return failed[0].split(" - ")[0] if failed else targets[0]
        return ""
    finally:
        path.write_text(whole)


def _tests(copy: Path, given: list[str], told: dict[str, str] | None = None) -> subprocess.CompletedProcess[str]:
    """A run of tests in the copy."""
    # not those of a run of tests that this one may be a part of, nor of what counts its lines
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("SLIPCOVER", "PYTEST"))}
    places = os.pathsep.join([str(copy), str(Path(__file__).parent)])
    environment |= {"PYTHONPATH": places, "PYTHONDONTWRITEBYTECODE": "1"} | (told or {})
    command = [sys.executable, "-m", "pytest", "-q", "-n", "0", "-p", "no:cacheprovider", *given]
    seconds = None if told else SECONDS
    return subprocess.run(
        command, cwd=copy, env=environment, capture_output=True, text=True, timeout=seconds, check=False
    )


def main() -> int:
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background job would ignore it in its tests
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--count", type=int, default=150, help="how many mutants are drawn")
    options.add_argument("--seed", type=int, default=20261121)
    options.add_argument("--only", default="", help="a part of the names of files")
    options.add_argument("--results", type=Path, default=ROOT / "build" / "mutants.json", help="results, to go on from")
    options.add_argument(
        "--lines", type=Path, default=ROOT / "build" / "lines.json", help="the tests that run each line"
    )
    options.add_argument("--list", action="store_true", help="print the mutants and try none")
    asked = options.parse_args()
    chosen = [each for each in [*known(), *drawn(asked.count, asked.seed)] if asked.only in each.file]
    if asked.list:
        print(*chosen, sep="\n")
        return 0
    for kept in (asked.results, asked.lines):
        kept.parent.mkdir(parents=True, exist_ok=True)
    results = json.loads(asked.results.read_text()) if asked.results.exists() else {}
    with tempfile.TemporaryDirectory() as place:
        copy = Path(place) / "checkout"
        shutil.copytree(ROOT, copy, ignore=shutil.ignore_patterns(".git", "__pycache__", "build", "*.egg-info"))
        if not asked.lines.exists():
            asked.lines.write_text(json.dumps(lines_run(copy, sorted({each.file for each in chosen}))))
        lines = json.loads(asked.lines.read_text())
        for number, mutant in enumerate(chosen, 1):
            if str(mutant) in results:
                continue
            began = time.monotonic()
            results[str(mutant)] = noticed(mutant, copy, lines)
            asked.results.write_text(json.dumps(results, indent=1) + "\n")
            told = results[str(mutant)] or "SURVIVES"
            print(f"{number}/{len(chosen)} {mutant}: {told} ({time.monotonic() - began:.0f} s)", flush=True)
    survivors = {str(mutant): reason(mutant) for mutant in chosen if not results[str(mutant)]}
    print(f"{len(chosen)} mutants, {len(survivors)} survive ({100 * len(survivors) / max(1, len(chosen)):.1f} %)")
    print(*(f"{mutant}: {why}" for mutant, why in survivors.items()), sep="\n")
    return int(len(survivors) > 0.05 * len(chosen) or "NOT EXPLAINED" in survivors.values())


if __name__ == "__main__":
    sys.exit(main())
