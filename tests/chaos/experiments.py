"""What is done to programs, and what is measured: each experiment gives rows of the table.

Rules: a row is what was done, how often, and what came of it in figures; an experiment raises where
something that is promised does not hold. `scale` is 1 for the long form.
"""

from __future__ import annotations

import os
import resource
import signal
import socket
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

from chaos import network
from chaos.stage import Program, Stage

import yarpy
from yarpy.names.client import YarpNameClient

HERTZ = 500.0


@dataclass(frozen=True)
class Row:
    what: str
    times: str
    result: str


def milliseconds(values: list[float]) -> str:
    ordered = sorted(values)
    last = ordered[min(len(ordered) - 1, int(0.99 * len(ordered)))]
    return f"back after {statistics.median(ordered) * 1000:.0f} ms, 99 %: {last * 1000:.0f} ms"


def balance(written: int, delivered: int, drops: int) -> str:
    """What became of messages. Dropped are all that nobody confirmed; some may have come."""
    left = written - delivered - drops
    rest = f"{left} uncounted" if left >= 0 else f"of which {-left} came all the same"
    return f"{written} written, {delivered} delivered, {drops} counted as dropped, {rest}"


def kill_receiver(carrier: str, count: int) -> Row:
    """SIGKILL to the reading program, which is started anew at once."""
    back, delivered = [], 0
    with Stage() as stage:
        reader = stage.read("/in")
        writer = stage.write("/out", "/in", carrier, HERTZ)
        for _ in range(count):
            _wait_for_numbers(reader)
            reader.kill()
            delivered += len(reader.numbers)
            reader = stage.read("/in")
            _wait_for_numbers(reader)
            back.append(max(0.0, reader.times[0] - reader.ready_at))
        counts = writer.end()
        delivered += len(reader.numbers)
    told = balance(counts["written"], delivered, counts["drops"])
    return Row(f"receiver killed, {carrier}", f"{count}", f"{milliseconds(back)}; {told}")


def kill_sender(carrier: str, count: int) -> Row:
    """SIGKILL to the writing program; the reader asks for the connection when it is back."""
    back = []
    with Stage() as stage:
        reader = stage.read("/in")
        writer = stage.write("/out", "/in", carrier, HERTZ)
        for _ in range(count):
            _wait_for_numbers(reader)
            writer.kill()
            time.sleep(0.1)
            before = len(reader.said)
            writer = stage.write("/out", "", carrier, HERTZ)
            reader.wait_for(lambda: len(reader.said) > before)  # noqa: B023
            back.append(max(0.0, reader.said[before][0] - writer.ready_at))
        writer.kill()
    return Row(f"sender killed, {carrier}", f"{count}", milliseconds(back))


def stop_one_of_two(seconds: float) -> Row:
    """SIGSTOP to one of two receivers of a port that writes in the background."""
    with Stage() as stage:
        stopped, other = stage.read("/stopped"), stage.read("/other")
        with yarpy.BufferedPort("/out", names=_names(stage)) as out:
            out.connect("/stopped")
            out.connect("/other")
            for halt in (False, True):
                if halt:
                    stopped.process.send_signal(signal.SIGSTOP)
                before, until = len(other.times), time.monotonic() + seconds
                while time.monotonic() < until:
                    out.write([1])
                    time.sleep(1 / HERTZ)
                got = other.times[before:]
                gap = max(b - a for a, b in pairwise(got))
            stopped.process.send_signal(signal.SIGCONT)
    _check(len(got) > seconds * HERTZ / 20, "the other receiver starves")
    return Row(
        "one of two receivers stopped",
        f"{seconds:g} s",
        f"the other gets {len(got) / seconds:.0f} messages/s; longest gap {gap * 1000:.0f} ms",
    )


def slow_reader(seconds: float) -> Row:
    """A receiver that takes 100 ms for each message, beside one that takes none."""
    with Stage() as stage:
        stage.read("/slow", 0.1)
        other = stage.read("/other")
        with yarpy.BufferedPort("/out", names=_names(stage)) as out:
            out.connect("/slow")
            out.connect("/other")
            until, number, longest = time.monotonic() + seconds, 0, 0.0
            while time.monotonic() < until:
                started = time.monotonic()
                out.write([number])
                longest = max(longest, time.monotonic() - started)
                number += 1
                time.sleep(1 / HERTZ)
            dropped = sum(line["drops"] for line in out.stats["outputs"])
        time.sleep(0.2)
    return Row(
        "a receiver that takes 100 ms for a message",
        f"{seconds:g} s",
        f"of {number} written the other gets {len(other.numbers)}, {dropped} are counted as "
        f"dropped; longest `write` {longest * 1000:.0f} ms",
    )


def silent_peers(count: int) -> Row:
    """Connections that never say a word, while somebody asks."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(hard, max(soft, 3 * count)), hard))
    try:
        with Stage() as stage:
            names = _names(stage)
            with (
                yarpy.RpcServer("/server", lambda message: ["pong"], names=names) as server,
                yarpy.RpcClient("/server", names=names) as client,
            ):
                before = _memory()
                address = ("127.0.0.1", server.contact.port)
                silent = [socket.create_connection(address) for _ in range(count)]
                pings = []
                for _ in range(200):
                    started = time.perf_counter()
                    client.call("ping", timeout=10.0)
                    pings.append(time.perf_counter() - started)
                grown = _memory() - before
                for sock in silent:
                    sock.close()
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
    pings.sort()
    return Row(
        "peers that connect and are silent",
        f"{count}",
        f"calls of others take {pings[100] * 1000:.1f} ms, 99 %: {pings[197] * 1000:.1f} ms; "
        f"{grown:.0f} MB of memory",
    )


def clock_jump(seconds: float) -> Row:
    """The wall clock of the sender leaps an hour back or forth every second."""
    with Stage() as stage:
        reader = stage.read("/in")
        writer = stage.write("/out", "/in", "tcp", HERTZ, "jump")
        time.sleep(seconds)
        counts = writer.end()
        reader.wait_for(lambda: len(reader.numbers) + counts["drops"] >= counts["written"])
        got = reader.numbers
    _check(got == [*range(len(got))], "messages out of order or lost")
    return Row(
        "wall clock set an hour back and forth",
        f"{seconds:.0f}",
        f"{counts['written']} written, {len(got)} delivered in order",
    )


def cut_link(carrier: str, seconds: float) -> Row:
    """The network between two hosts goes away and comes back."""
    with network.link() as line, Stage(network.HERE) as stage:
        reader = stage.read("/in", before=line.inside)
        writer = stage.write("/out", "/in", carrier, HERTZ)
        _wait_for_numbers(reader)
        line.cut()
        time.sleep(seconds)
        before = len(reader.said)
        line.mend()
        mended = time.monotonic()
        reader.wait_for(lambda: len(reader.said) > before)
        back = reader.said[before][0] - mended
        _wait_for_numbers(reader)
        counts = writer.end()
        time.sleep(0.5)
        got = reader.numbers
    told = balance(counts["written"], len(got), counts["drops"])
    return Row(f"link cut, {carrier}", f"{seconds:g} s", f"back after {back:.1f} s; {told}")


def full_disk(count: int) -> Row:
    """The name server cannot write its database any more."""
    with network.small_disk() as disk:
        database = disk / "ports.db"
        with yarpy.NameServer(portdb=database) as server:
            with yarpy.Port("/before"):
                network.fill(disk)
                for number in range(count):
                    with yarpy.Port(f"/while/full/{number}") as port:
                        _check(server.client.query(port.name) is not None, "a name is not known")
                _check(server.client.query("/before") is not None, "an older name is forgotten")
                (disk / "filler").unlink()
            with yarpy.Port("/after") as port:
                _check(server.client.query(port.name) is not None, "no name after it either")
    return Row(
        "full disk under the name server",
        f"{count} ports",
        "all are registered and found; those of before and after too",
    )


def all_of(scale: float) -> list[Callable[[], Row]]:
    """The experiments, so long that they take about ten minutes at scale 1."""

    def some(count: int) -> int:
        return max(2, round(count * scale))

    kills = {"tcp": 60, "fast_tcp": 60, "udp": 30, "mcast": 30}
    return [
        *(lambda c=c, n=n: kill_receiver(c, some(n)) for c, n in kills.items()),  # type: ignore[misc]
        *(lambda c=c, n=n: kill_sender(c, some(n)) for c, n in kills.items()),  # type: ignore[misc]
        lambda: stop_one_of_two(max(1.5, 20 * scale)),
        lambda: slow_reader(max(1.5, 20 * scale)),
        lambda: silent_peers(some(2000)),
        lambda: clock_jump(max(3.0, 20 * scale)),
        lambda: cut_link("tcp", max(2.0, 10 * scale)),
        lambda: cut_link("udp", max(2.0, 10 * scale)),
        lambda: full_disk(some(100)),
    ]


def _names(stage: Stage) -> YarpNameClient:
    return YarpNameClient("127.0.0.1", stage.server.port)


def _wait_for_numbers(reader: Program, count: int = 20) -> None:
    goal = len(reader.said) + count
    reader.wait_for(lambda: len(reader.said) >= goal)


def _check(holds: bool, what: str) -> None:
    if not holds:
        raise AssertionError(what)


def _memory() -> float:
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6
