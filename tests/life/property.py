"""Random programs against an oracle: nothing hangs, and what was sent was delivered or counted.

    python tests/life/property.py SECONDS [--seed FIRST]
    python tests/life/property.py SECONDS --only SEED    one program, in a process of its own
    python tests/life/property.py --once SEED     one program, in this process, told in full

Rules: programs are functions of their seeds (`property_program`), and run one after the other in a
process (`property_world`) that is replaced when one went wrong, hung or died. Seeds that fail are
appended to seeds.txt beside this file, and run first from then on, also by `make test`.
"""

from __future__ import annotations

import argparse
import faulthandler
import json
import os
import random
import re
import selectors
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path
from typing import IO, Final

SEEDS: Final = Path(__file__).with_name("seeds.txt")
#: A callback of the program that a signal has ended: the port says that it has failed, and why.
FAILED_BY_SIGNAL: Final = re.compile(
    rb"callback failed[^\n]*\n(?:(?!callback failed).)*?property_world\.Interruption", re.DOTALL
)
#: A line of the log that the signal has ended: Python's logging says so, and goes on.
LOG_BY_SIGNAL: Final = re.compile(
    rb"--- Logging error ---\n(?:(?!--- Logging error).)*?property_world\.Interruption\n"
    rb"Call stack:.*?\nArguments: [^\n]*\n",
    re.DOTALL,
)
PATIENCE: Final = 90.0  # seconds for one program, all its limits together
BATCH: Final = 40  # programs of one process


def child(first: int, count: int) -> int:
    """Run programs in this process; a line of JSON for each."""
    from property_program import random_program
    from property_world import World, descriptors, live

    import yarpy

    with yarpy.RpcServer("/warm", lambda message: message.value, names=yarpy.LocalNames()):
        descriptors()  # what a process has once, it has from now on

    def tell(world: World) -> None:
        line = {
            "seed": world.program.seed,
            "wrong": world.wrong,
            "operations": world.operations,
            "seconds": time.monotonic() - started,
        }
        print(json.dumps(line), flush=True)

    def give_up(world: World) -> None:
        tell(world)
        os._exit(1)

    for seed in range(first, first + count):
        faulthandler.dump_traceback_later(PATIENCE - 10, exit=True)
        # Threads of every other program take turns a hundred times as often as usual.
        sys.setswitchinterval(0.005 if seed % 2 else 5e-5)
        started = time.monotonic()
        world = live(random_program(seed), give_up)
        tell(world)
        if world.wrong:
            return 1
    return 0


class Run:
    """Processes with programs until the time is over; what came of them."""

    def __init__(self, seconds: float, first: int) -> None:
        self.until = time.monotonic() + seconds
        self.next = first
        self.programs = 0
        self.operations: Counter[str] = Counter()
        self.failed: dict[int, str] = {}

    def known(self) -> list[int]:
        """The seeds that failed once."""
        if not SEEDS.exists():
            return []
        lines = SEEDS.read_text().splitlines()
        return [int(line.split()[0]) for line in lines if line and not line.startswith("#")]

    def run(self, known: bool) -> None:
        for seed in self.known() if known else []:
            if time.monotonic() < self.until:
                self.batch(seed, 1)
        while time.monotonic() < self.until:
            self.next = self.batch(self.next, BATCH)

    def batch(self, first: int, count: int) -> int:
        """Run programs in one process; the seed that comes next."""
        command = [
            sys.executable,
            "-X",
            "dev",
            "-W",
            "ignore",
            __file__,
            "--child",
            f"{first}",
            f"{count}",
        ]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        assert process.stdout is not None and process.stderr is not None
        pipes: dict[IO[bytes], bytearray] = {
            process.stdout: bytearray(),
            process.stderr: bytearray(),
        }
        reported = first - 1
        quiet = time.monotonic()
        with selectors.DefaultSelector() as selector:
            for pipe in pipes:
                selector.register(pipe, selectors.EVENT_READ)
            while selector.get_map() and time.monotonic() < self.until:
                for key, _ in selector.select(1.0):
                    data = os.read(key.fd, 1 << 16)
                    if not data:
                        selector.unregister(key.fileobj)
                    for pipe in pipes:
                        if pipe.fileno() == key.fd:
                            pipes[pipe] += data
                out = pipes[process.stdout]
                while b"\n" in out:
                    line, _, rest = bytes(out).partition(b"\n")
                    out[:] = rest
                    reported = self.report(json.loads(line), bytes(pipes[process.stderr]))
                    pipes[process.stderr].clear()
                    quiet = time.monotonic()
                if time.monotonic() > quiet + PATIENCE:
                    break
        over = time.monotonic() >= self.until
        hung = process.poll() is None and not over and bool(selector.get_map())
        process.kill() if over or hung else None
        process.wait()
        errors = bytes(pipes[process.stderr]).decode(errors="replace")
        for pipe in pipes:
            pipe.close()
        if not over and reported < first + count - 1 and reported not in self.failed:
            reported += 1
            self.programs += 1
            self.fail(reported, f"the process {'hangs' if hung else 'dies'}\n{errors}")
        return max(reported, first) + 1

    def report(self, line: dict[str, object], errors: bytes) -> int:
        """One program is done; its seed."""
        seed, wrong = line["seed"], list(line["wrong"])  # type: ignore[call-overload]
        assert isinstance(seed, int)
        self.programs += 1
        self.operations.update(line["operations"])  # type: ignore[arg-type]
        errors = LOG_BY_SIGNAL.sub(b"", FAILED_BY_SIGNAL.sub(b"", errors))
        # A signal may also meet the interpreter at its own work, which goes on, and says so.
        if errors.count(b"Traceback") > errors.count(b"Exception ignored in"):
            wrong.append("a traceback")
        if wrong:
            wrong.append(errors.decode(errors="replace"))
            self.fail(seed, "\n".join(wrong))
        return seed

    def fail(self, seed: int, text: str) -> None:
        self.failed[seed] = text
        print(f"seed {seed} FAILS: {text}\n", flush=True)
        if seed not in self.known():
            first = next((line for line in text.splitlines() if line.strip()), "")
            with SEEDS.open("a") as file:
                file.write(f"{seed}  {first[:150]}\n")


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("seconds", nargs="?", type=float, default=20.0)
    parser.add_argument("--seed", type=int)
    parser.add_argument("--only", type=int)
    parser.add_argument("--once", type=int)
    parser.add_argument("--child", type=int, nargs=2, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.child:
        return child(*options.child)
    if options.once is not None:
        from property_program import random_program

        print(random_program(options.once), flush=True)
        return child(options.once, 1)
    if options.only is not None:
        only = Run(options.seconds, options.only)
        only.batch(options.only, 1)
        return 1 if only.failed or not only.programs else 0
    first = random.randrange(1 << 30) if options.seed is None else options.seed
    run = Run(options.seconds, first)
    run.run(known=options.seed is None)
    operations = sum(run.operations.values())
    print(f"seeds from {first}: {run.programs} programs, {operations} operations")
    print("  " + ", ".join(f"{name} {times}" for name, times in sorted(run.operations.items())))
    print(f"  {len(run.failed)} failed: {sorted(run.failed)}" if run.failed else "  none failed")
    return 1 if run.failed else 0


if __name__ == "__main__":
    sys.exit(main())
