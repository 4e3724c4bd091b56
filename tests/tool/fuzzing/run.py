"""Fuzz everything that takes text from a stranger: `python tests/tool/fuzzing/run.py --inputs 100000 --seed 1`.

Kinds in turn: expressions, model files, scene files, ids of claims, command lines.  Prints each fault with the input
that shows it and exits with 1 when there is one; `--show KIND NUMBER` prints one input again.
"""

from __future__ import annotations

import argparse
import multiprocessing
import sys
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[3])]
PORTION = 500


def main() -> int:
    """The command."""
    from inputs import made
    from trial import tried

    options = _options()
    if options.show:
        print(repr(made(options.show[0], options.seed, int(options.show[1]))))
        return 0
    start, faults, context = time.monotonic(), [], multiprocessing.get_context("spawn")
    parts = [range(at, min(at + PORTION, options.inputs)) for at in range(0, options.inputs, PORTION)]
    with ProcessPoolExecutor(options.workers, mp_context=context) as pool:
        for at, done in enumerate(as_completed(pool.submit(tried, options.seed, part) for part in parts), 1):
            faults += done.result()
            if at % 10 == 0:
                print(f"{at * PORTION} inputs, {len(faults)} faults, {time.monotonic() - start:.0f} s", file=sys.stderr)
    for kind, number, fault in sorted(faults, key=lambda each: each[1])[:100]:
        print(f"{kind} {number}: {fault}\n    {made(kind, options.seed, number)!r:.160}")
    told = ", ".join(f"{count} {kind}" for kind, count in Counter(kind for kind, _, _ in faults).items()) or "none"
    print(f"{options.inputs} inputs, seed {options.seed}, {time.monotonic() - start:.0f} s; faults: {told}")
    return 1 if faults else 0


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--inputs", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--show", nargs=2, metavar=("KIND", "NUMBER"))
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
