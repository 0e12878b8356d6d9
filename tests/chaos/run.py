"""Chaos: kills, stops and lies, and the table of docs/reliability.md.

make chaos                              ten minutes
python tests/chaos/run.py 0.05          a twentieth of it
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from chaos.experiments import Row, all_of
from chaos.network import Missing


def table(scale: float) -> int:
    failed = 0
    print("| what was done | how often, how long | what came of it |\n|---|---|---|", flush=True)
    for experiment in all_of(scale):
        try:
            row = experiment()
        except Missing as missing:
            print(f"left out: {missing}", file=sys.stderr, flush=True)
            continue
        except AssertionError as error:
            row = Row("**failed**", "", str(error))
            failed += 1
        print(f"| {row.what} | {row.times} | {row.result} |", flush=True)
    return failed


if __name__ == "__main__":
    sys.exit(1 if table(float(sys.argv[1]) if len(sys.argv) > 1 else 1.0) else 0)
