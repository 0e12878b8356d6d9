"""Try to break whatever reads bytes of strangers: `python tests/fuzz/run.py SECONDS [TARGET...]`.

Rules: all targets in turn, with inputs that a number makes (`--seed`), so that a run can be done
again. What raises something else than its refusals, takes too long or much memory, is put into
`tests/fuzz/corpus/TARGET/`, where the tests try it from then on. Where the system cannot tell the
memory of one input, that of the whole process is measured. The exit code is 1 if there was
something.
"""

from __future__ import annotations

import argparse
import faulthandler
import gc
import hashlib
import logging
import os
import random
import resource
import sys
import time
import traceback
from contextlib import suppress
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from fuzz.target import TARGETS, Target

CORPUS = Path(__file__).parent / "corpus"
TURN = 200  # inputs of one target before the next has its turn
HANGS = 30  # seconds after which the process ends, showing where it is
LARGE = 640 << 20  # bytes that an input takes; a JPEG may take YARPY_MAX_PICTURE twice
MEMORY = 1 << 30  # bytes of the process
_NUMBERS = (0, 1, 2, 0x7F, 0xFF, 0x7FFF, 0xFFFF, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 1 << 20)

_CLEAR_PEAK = None
with suppress(OSError):
    _CLEAR_PEAK = os.open("/proc/self/clear_refs", os.O_WRONLY)


def made(chance: random.Random, target: Target) -> bytes:
    """An input: pieces of the grammar in a row, or a seed that was changed."""
    if target.pieces and (not target.seeds or chance.random() < 0.7):
        size = int(chance.paretovariate(0.8) * 4) % 300
        data = bytearray(b"".join(chance.choices(target.pieces, k=size)))
        if chance.random() < 0.7:
            return bytes(data)
    else:
        data = bytearray(chance.choice(target.seeds))
    for _ in range(min(int(chance.paretovariate(1.0)), 20)):
        _change(chance, data, target)
    return bytes(data)


def _change(chance: random.Random, data: bytearray, target: Target) -> None:
    at = chance.randrange(len(data) + 1)
    kind = chance.randrange(8)
    if kind == 0 and at < len(data):
        data[at] ^= 1 << chance.randrange(8)
    elif kind == 1 and at < len(data):
        data[at] = chance.randrange(256)
    elif kind == 2:
        data[at : at + 4] = chance.choice(_NUMBERS).to_bytes(4, "little")
    elif kind == 3:
        data[at : at + 4] = chance.choice(_NUMBERS).to_bytes(4, "big")
    elif kind == 4:
        del data[at : at + chance.randrange(1, 20)]
    elif kind == 5:
        data[at:at] = chance.randbytes(chance.randrange(1, 9))
    elif kind == 6:
        piece = data[at : at + chance.randrange(1, 30)]
        data[at:at] = piece * chance.choice((1, 2, 10, 100))
    else:
        other = chance.choice(target.seeds) if target.seeds else chance.choice(target.pieces)
        cut = chance.randrange(len(other) + 1)
        data[at:] = other[cut:]


def tried(target: Target, data: bytes) -> tuple[str, float]:
    """What is wrong ("" for nothing), and the seconds that it took."""
    problem = ""
    before = _new_peak()
    start = time.thread_time()
    try:
        target.read(data)
    except target.refusals:
        pass
    except Exception:
        problem = traceback.format_exc()
    took = time.thread_time() - start
    if took > target.slow and not problem:
        problem = f"{took:.1f} s for {len(data)} bytes"
    grown = _peak() - before
    if grown > LARGE and not problem:
        problem = f"{grown >> 20} MiB for {len(data)} bytes"
    return problem, took


def _new_peak() -> int:
    """Measure the peak of memory anew from now on, where the system can. Return what is taken."""
    if _CLEAR_PEAK is not None:
        os.write(_CLEAR_PEAK, b"5")  # the peak is what is taken now
    return _peak()


def _peak() -> int:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss << 10


def main() -> int:
    asked = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    asked.add_argument("seconds", type=float)
    asked.add_argument("targets", nargs="*", help=f"of {', '.join(TARGETS)}")
    asked.add_argument("--seed", type=int, default=time.time_ns() & 0xFFFFFFFF)
    options = asked.parse_args()
    targets = {name: TARGETS[name] for name in options.targets or TARGETS}
    print(f"--seed {options.seed}, {len(targets)} targets")
    logging.disable(logging.CRITICAL)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)  # libraries in C say there what they think of it
    chance = random.Random(options.seed)
    count, slowest, spent = dict.fromkeys(targets, 0), dict.fromkeys(targets, 0.0), {}
    found: dict[tuple[str, str], str] = {}
    resource.setrlimit(resource.RLIMIT_AS, (4 * MEMORY, 4 * MEMORY))
    end, highest = time.monotonic() + options.seconds, 0
    while time.monotonic() < end:
        for name, target in targets.items():
            faulthandler.dump_traceback_later(HANGS + TURN, exit=True, file=sys.stdout)
            start = time.monotonic()
            for _ in range(TURN):
                data = made(chance, target)
                problem, took = tried(target, data)
                count[name] += 1
                highest = max(highest, _peak())
                slowest[name] = max(slowest[name], took)
                kind = (name, problem.rstrip().rpartition("\n")[2][:60])
                if problem and kind not in found:
                    found[kind] = problem
                    _keep(name, data)
                    print(f"\n{name}: {data[:200]!r}\n{problem}", flush=True)
            spent[name] = spent.get(name, 0.0) + time.monotonic() - start
    faulthandler.cancel_dump_traceback_later()
    gc.collect()
    for name in targets:
        rate = count[name] / max(spent.get(name, 0), 1e-9)
        print(f"{name:24}{count[name]:10} inputs {rate:9.0f}/s  slowest {slowest[name]:.3f} s")
    peak = max(highest, _peak())
    total = sum(count.values())
    print(
        f"{total} inputs, {total / options.seconds:.0f}/s, {peak >> 20} MiB, {len(found)} findings"
    )
    if peak > MEMORY:
        print(f"more than {MEMORY >> 20} MiB were taken")
    return 1 if found or peak > MEMORY else 0


def _keep(name: str, data: bytes) -> None:
    folder = CORPUS / name.replace(" ", "_")
    folder.mkdir(parents=True, exist_ok=True)
    (folder / hashlib.sha256(data).hexdigest()[:12]).write_bytes(data)


if __name__ == "__main__":
    sys.exit(main())
