"""The function calls of one small message:  python bench/calls.py [--carrier tcp] [--rows 20]

Everything happens in one process on one core, over the loopback. One way: a thread writes a message
and reads it, so that the table has both sides, and the acknowledgement. Question and reply: the
thread that asks, then the one that answers.

Rules: calls and each function's own time are what cProfile sees; what that costs makes the time of
small functions too long. What a message takes when nobody looks on is printed above. Of a compiled
core the calls that stay inside of it do not show.
"""

import argparse
import cProfile
import os
import pstats
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from workload import NUMBER

import yarpy
from yarpy.link.begin.handshake import find_carrier
from yarpy.route import parse_carrier

SOURCE = Path(yarpy.__file__).parent
ROUNDS = 9
START, STOP = -1, -2  # questions that begin and end a profile of the thread that answers
BUILT_IN = "~"  # what pstats calls the file of a function in C
IN_C = "functions in C"


@dataclass(frozen=True)
class Row:
    """A function: how often it was called for a message, and its own time, in microseconds."""

    name: str
    room: str
    calls: float
    own: float


class Bench:
    """How often everything is done, and how many functions are shown."""

    def __init__(self, options: argparse.Namespace) -> None:
        self.carrier: str = options.carrier
        self.messages: int = options.messages
        self.rows: int = options.rows

    def one_way(self) -> None:
        """A message from its writer to its reader."""
        names = yarpy.LocalNames()
        inlet = yarpy.BufferedPort("/in", names=names)
        outlet = yarpy.Port("/out", names=names)
        with inlet, outlet:
            outlet.connect("/in", self.carrier)

            def exchange(index: int) -> None:
                outlet.write([index, NUMBER])
                assert inlet.read().value[0] == index

            self.time(exchange, "A message one way")
            self.show(self.profile(exchange), "Both sides")

    def rpc(self) -> None:
        """A question and its reply."""
        profile = cProfile.Profile()

        def answer(message: yarpy.Message) -> object:
            question = message.value
            if question[0] == START:
                profile.enable()
            elif question[0] == STOP:
                profile.disable()
            return question

        names = yarpy.LocalNames()
        server = yarpy.RpcServer("/server", answer, names=names)
        client = yarpy.RpcClient("/server", carrier=self.carrier, names=names)
        with server, client:

            def exchange(index: int) -> None:
                assert client.call(index, NUMBER)[0] == index

            self.time(exchange, "A question and its reply")
            self.show(self.profile(exchange), "The side that asks")
            client.call(START, NUMBER)
            self.repeat(exchange)
            client.call(STOP, NUMBER)
            self.show(profile, "The side that answers")

    def repeat(self, exchange: Callable[[int], None]) -> None:
        for index in range(self.messages):
            exchange(index)

    def profile(self, exchange: Callable[[int], None]) -> cProfile.Profile:
        """What this thread does."""
        profile = cProfile.Profile()
        profile.enable()
        self.repeat(exchange)
        profile.disable()
        return profile

    def time(self, exchange: Callable[[int], None], title: str) -> None:
        """The processor time of one exchange, of all threads: the best round, for whatever else
        runs on the machine only adds to it."""
        self.repeat(exchange)
        samples = []
        for _ in range(ROUNDS):
            before = time.process_time()
            self.repeat(exchange)
            samples.append((time.process_time() - before) / self.messages * 1e6)
        print(f"{title} takes {min(samples):.1f} us of processor time.\n")

    def show(self, profile: cProfile.Profile, title: str) -> None:
        """The sums of each room, and the functions that take most."""
        rows = []
        for (file, line, name), (_, calls, own, _, _) in pstats.Stats(profile).stats.items():
            if 2 * calls >= self.messages:  # not what happens now and then
                room, short = where(file, line, name)
                rows.append(Row(short, room, calls / self.messages, own / self.messages * 1e6))
        rooms = [summed(room, rows) for room in {row.room for row in rows}]
        built_in = sum(row.calls for row in rows if row.room == IN_C)
        python = sum(row.calls for row in rows) - built_in
        print(f"{title}: {python:.0f} calls of Python functions, {built_in:.0f} of C\n")
        table("room", rooms)
        table("function", rows, self.rows)


def where(file: str, line: int, name: str) -> tuple[str, str]:
    """The room of a function, and where people find it."""
    if file == BUILT_IN:
        return IN_C, name.strip("<>").replace("built-in method ", "").replace("method ", "")
    path = Path(file)
    if not path.is_relative_to(SOURCE):
        return "others", f"{path.name}:{line} {name}"
    inside = path.relative_to(SOURCE)
    return inside.parts[0], f"{inside}:{line} {name}"


def summed(room: str, rows: Sequence[Row]) -> Row:
    """All functions of a room together."""
    own = [row for row in rows if row.room == room]
    return Row(room, room, sum(row.calls for row in own), sum(row.own for row in own))


def table(head: str, rows: Sequence[Row], most: int | None = None) -> None:
    """The rows that take most, as a table."""
    print(f"| {head} | calls | own time, us |\n|---|--:|--:|")
    for row in sorted(rows, key=lambda row: -row.own)[:most]:
        print(f"| {row.name} | {row.calls:.1f} | {row.own:.2f} |")
    print()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--carrier", default="tcp")
    parser.add_argument("--messages", type=int, default=2000, help="of each round")
    parser.add_argument("--rows", type=int, default=20, help="functions to show")
    bench = Bench(parser.parse_args())
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    bench.one_way()
    if find_carrier(parse_carrier(bench.carrier)).replies:
        bench.rpc()


if __name__ == "__main__":
    main()
