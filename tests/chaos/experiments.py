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
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise

import pytest
from chaos import network
from chaos.stage import PATIENCE, Program, Stage
from support.wait import wait_until

import yarpy
from yarpy.facts import MAGIC_SIZE
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


def balance(counts: dict[str, int], delivered: int, kills: int = 0) -> str:
    """What became of messages: every one is delivered, dropped or unconfirmed, no drop was
    delivered; but one in each killed program's hands."""
    written, drops, unconfirmed = (counts[key] for key in ("written", "drops", "unconfirmed"))
    lost = written - delivered
    told = (
        f"{written} written, {delivered} delivered, {drops} counted as dropped, {unconfirmed} as "
        f"unconfirmed"
    )
    _check(drops <= lost + kills, f"{told}: some of the dropped were delivered")
    _check(lost <= drops + unconfirmed + kills, f"{told}: some are counted nowhere")
    return f"{told}, of which {max(0, lost - drops)} were lost"


def kill_receiver(carrier: str, count: int) -> Row:
    """SIGKILL to the reading program, which is started anew at once."""
    back, delivered = [], 0
    with Stage() as stage:
        reader = stage.read("/chaos/in")
        writer = stage.write("/chaos/out", "/chaos/in", carrier, HERTZ)
        for _ in range(count):
            _wait_for_numbers(reader)
            reader.kill()
            delivered += len(reader.numbers)
            reader = stage.read("/chaos/in")
            _wait_for_numbers(reader)
            back.append(max(0.0, reader.times[0] - reader.ready_at))
        counts = writer.end()
        delivered += len(reader.numbers)
    told = balance(counts, delivered, count)
    return Row(f"receiver killed, {carrier}", f"{count}", f"{milliseconds(back)}; {told}")


def kill_sender(carrier: str, count: int) -> Row:
    """SIGKILL to the writing program; the reader asks for the connection when it is back."""
    back = []
    with Stage() as stage:
        reader = stage.read("/chaos/in")
        writer = stage.write("/chaos/out", "/chaos/in", carrier, HERTZ)
        for _ in range(count):
            _wait_for_numbers(reader)
            writer.kill()
            time.sleep(0.1)
            before = len(reader.said)
            writer = stage.write("/chaos/out", "", carrier, HERTZ)
            reader.wait_for(lambda: len(reader.said) > before)  # noqa: B023
            back.append(max(0.0, reader.said[before][0] - writer.ready_at))
        writer.kill()
    return Row(f"sender killed, {carrier}", f"{count}", milliseconds(back))


def stop_one_of_two(seconds: float) -> Row:
    """SIGSTOP to one of two receivers of a port that writes in the background."""
    with Stage() as stage:
        stopped, other = stage.read("/stopped"), stage.read("/other")
        with yarpy.BufferedPort("/chaos/out", names=_names(stage)) as out:
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
        with yarpy.BufferedPort("/chaos/out", names=_names(stage)) as out:
            out.connect("/slow")
            out.connect("/other")
            until, number, longest = time.monotonic() + seconds, 0, 0.0
            while time.monotonic() < until:
                started = time.monotonic()
                out.write([number])
                longest = max(longest, time.monotonic() - started)
                number += 1
                time.sleep(1 / HERTZ)
            dropped = sum(line.drops for line in out.stats.outputs)
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


def crowd(count: int, word: str, what: str) -> Row:
    """Many connections at once that never say a whole message, while somebody asks."""
    seconds = count / 1000
    with Stage() as stage:
        names = _names(stage)
        with (
            yarpy.RpcServer("/server", lambda message: ["pong"], names=names) as server,
            yarpy.RpcClient("/server", names=names) as client,
        ):
            before, files, threads = _memory(), _files(), threading.active_count()
            grown, pings = 0.0, []
            program = stage.crowd(server.contact.port, count, seconds, word)
            until = None
            while until is None or time.monotonic() < until:
                started = time.perf_counter()
                client.call("ping", timeout=10.0)
                pings.append(time.perf_counter() - started)
                grown = max(grown, _memory() - before)
                if until is None and program.numbers:
                    until = time.monotonic() + 1.0
                time.sleep(0.002)
            held, busy = _files() - files, threading.active_count() - threads
            _check(busy <= 3 or len(word) >= MAGIC_SIZE, f"{busy} threads for those without a word")
            _check(grown < 200, f"{grown:.0f} MB for {count} connections")
            program.kill()
            left = time.monotonic()
            # Idle connections to the name server stay, and both their ends are here.
            while _files() > files + 8 or threading.active_count() > threads + 5:
                _check(time.monotonic() < left + PATIENCE, "what they took is not given back")
                time.sleep(0.01)
            back = time.monotonic() - left
    pings.sort()
    return Row(
        what,
        f"{count} in {seconds:g} s",
        f"calls of others take {statistics.median(pings) * 1000:.1f} ms, 99 %: "
        f"{pings[int(0.99 * len(pings))] * 1000:.1f} ms, longest {pings[-1] * 1000:.0f} ms; "
        f"{held} connections and {busy} threads at the end, {grown:.0f} MB of memory; "
        f"all is back {back:.1f} s after they left",
    )


def clock_jump(seconds: float) -> Row:
    """The wall clock of the sender leaps an hour back or forth every second."""
    with Stage() as stage:
        reader = stage.read("/chaos/in")
        writer = stage.write("/chaos/out", "/chaos/in", "tcp", HERTZ, "jump")
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
        reader = stage.read("/chaos/in", before=line.inside)
        writer = stage.write("/chaos/out", "/chaos/in", carrier, HERTZ)
        _wait_for_numbers(reader)
        line.cut()
        time.sleep(seconds)
        before = len(reader.said)
        line.restore()
        restored = time.monotonic()
        reader.wait_for(lambda: len(reader.said) > before)
        back = reader.said[before][0] - restored
        _wait_for_numbers(reader)
        counts = writer.end()
        time.sleep(0.5)
        got = reader.numbers
    told = balance(counts, len(got))
    return Row(f"link cut, {carrier}", f"{seconds:g} s", f"back after {back:.1f} s; {told}")


@contextmanager
def _dead_after(seconds: float) -> Iterator[None]:
    """Programs and ports take a host for dead after so many seconds without an answer."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("YARPY_PEER_TIMEOUT", f"{seconds:g}")
        yield


def dead_reader(strict: bool, timeout: float) -> Row:
    """The host of a receiver is switched off; its name turns up on another host."""
    with (
        _dead_after(timeout),
        network.hosts(2) as (first, second),
        Stage(network.AT_HOME) as stage,
        yarpy.BufferedPort("/chaos/out", strict=strict, names=_names(stage)) as out,
    ):
        reader = stage.read("/chaos/in", before=first.inside)
        out.connect("/chaos/in")
        with _writing(out) as longest:
            _wait_for_numbers(reader)
            first.die()
            died = time.monotonic()
            wait_until(lambda: not out.outputs, timeout + 30)
            noticed = time.monotonic() - died
            _check(noticed < timeout + 5, f"it took {noticed:.1f} s to notice a dead host")
            _names(stage).unregister("/chaos/in")
            successor = stage.read("/chaos/in", before=second.inside)
            _wait_for_numbers(successor)
            back = successor.times[0] - successor.ready_at
    return Row(
        f"host of the receiver switched off, {'strict' if strict else 'newest'}",
        f"after {timeout:g} s",
        f"noticed after {noticed:.1f} s; the name on another host gets messages after "
        f"{max(0.0, back):.1f} s; longest `write` {longest[0]:.1f} s",
    )


def dead_writer(timeout: float) -> Row:
    """The host of a sender is switched off."""
    with (
        _dead_after(timeout),
        network.hosts(1) as (host,),
        Stage(network.AT_HOME) as stage,
        yarpy.BufferedPort("/chaos/in", strict=True, names=_names(stage)) as in_,
    ):
        stage.write("/chaos/out", "/chaos/in", "tcp", HERTZ, before=host.inside)
        for _ in range(20):
            in_.read(timeout=30)
        host.die()
        died = time.monotonic()
        wait_until(lambda: not in_.inputs, timeout + 30)
        noticed = time.monotonic() - died
    _check(noticed < timeout + 5, f"it took {noticed:.1f} s to notice a dead host")
    return Row(
        "host of the sender switched off", f"after {timeout:g} s", f"noticed after {noticed:.1f} s"
    )


def stopped_reader_on_a_dead_host(timeout: float) -> Row:
    """A receiver that is stopped may keep its writer waiting for as long as its host lives."""
    with (
        _dead_after(timeout),
        network.hosts(1) as (host,),
        Stage(network.AT_HOME) as stage,
        yarpy.Port("/chaos/out", names=_names(stage)) as out,
    ):
        reader = stage.read("/chaos/in", before=host.inside)
        out.connect("/chaos/in")
        with _writing(out, "x" * 100_000):
            _wait_for_numbers(reader)
            for line in host.programs():
                os.kill(line, signal.SIGSTOP)
            time.sleep(2 * timeout)
            _check(bool(out.outputs), "a stopped receiver was taken for a dead host")
            host.die()
            died = time.monotonic()
            wait_until(lambda: not out.outputs, 3 * timeout + 30)
            noticed = time.monotonic() - died
    return Row(
        "a stopped receiver, its host switched off later",
        f"after {2 * timeout:g} s",
        f"kept until then; noticed after {noticed:.1f} s",
    )


@contextmanager
def _writing(out: yarpy.Port | yarpy.BufferedPort, payload: str = "") -> Iterator[list[float]]:
    """Write numbers meanwhile; gives a list of what the longest `write` took, in seconds."""
    ended, longest = threading.Event(), [0.0]

    def write() -> None:
        number = 0
        while not ended.wait(1 / HERTZ):
            started = time.monotonic()
            out.write([number, payload])
            longest[0] = max(longest[0], time.monotonic() - started)
            number += 1

    thread = threading.Thread(target=write)
    thread.start()
    try:
        yield longest
    finally:
        ended.set()
        thread.join(PATIENCE)


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
        lambda: crowd(some(10_000), "x", "peers that connect and say one byte"),
        lambda: crowd(some(10_000), "GET / HT", "peers that begin to greet"),
        lambda: clock_jump(max(3.0, 20 * scale)),
        _between_hosts(lambda: cut_link("tcp", max(2.0, 10 * scale))),
        _between_hosts(lambda: cut_link("udp", max(2.0, 10 * scale))),
        _between_hosts(lambda: dead_reader(True, max(2.0, 25 * min(scale, 1.0)))),
        _between_hosts(lambda: dead_reader(False, max(2.0, 25 * min(scale, 1.0)))),
        _between_hosts(lambda: dead_writer(max(2.0, 25 * min(scale, 1.0)))),
        _between_hosts(lambda: stopped_reader_on_a_dead_host(max(2.0, 25 * min(scale, 1.0)))),
        lambda: full_disk(some(100)),
    ]


def _between_hosts(experiment: Callable[[], Row]) -> Callable[[], Row]:
    """Note for the tests that it takes network namespaces."""
    experiment.peers = ("namespaces",)  # type: ignore[attr-defined]
    return experiment


def _names(stage: Stage) -> YarpNameClient:
    return YarpNameClient("127.0.0.1", stage.server.port)


def _wait_for_numbers(reader: Program, count: int = 20) -> None:
    goal = len(reader.said) + count
    reader.wait_for(lambda: len(reader.said) >= goal)


def _check(holds: bool, what: str) -> None:
    if not holds:
        raise AssertionError(what)


def _files() -> int:
    return len(os.listdir("/proc/self/fd"))


def _memory() -> float:
    with open("/proc/self/statm", encoding="utf-8") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6
