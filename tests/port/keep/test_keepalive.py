"""Keepalive: datagram connections whose other end has died are found, living ones are let alone."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Iterator

import pytest
from support.process import Process
from support.wait import HANG, wait_until

import yarpy
from yarpy.errors import LinkClosed
from yarpy.nameserver.local import LocalNames
from yarpy.port.connect.reconnect import RECONNECTOR
from yarpy.port.keep import keepalive
from yarpy.port.keep.keepalive import Keepalive, Link
from yarpy.port.port import BufferedPort, Port
from yarpy.wire.message import Packet

OTHER = """
import time, yarpy
def show(message):
    print("got", message.value[0], flush=True)
with yarpy.BufferedPort("/keepalive/other", callback=show) as port:
    print("ready", flush=True)
    for count in range(10**9):
        port.write([count])
        time.sleep(0.02)
"""


def start(server: yarpy.NameServer) -> Process:
    """A program with a port that writes and prints what it reads."""
    process = Process([sys.executable, "-c", OTHER], env={**os.environ, **server.environment})
    process.wait_line("ready", timeout=HANG)
    return process


@pytest.mark.parametrize("carrier", ["udp", "mcast"])
def test_a_killed_sender_is_asked_again_when_it_is_back(carrier: str) -> None:
    with yarpy.NameServer() as server, yarpy.BufferedPort("/keepalive/in") as reader:
        other = start(server)
        reader.listen_to("/keepalive/other", carrier)
        for _ in range(2):
            assert reader.read(timeout=HANG).value[0] >= 0
            other.kill()
            other = start(server)
            while reader.poll() is not None:  # from before
                pass
        assert reader.read(timeout=HANG).value[0] >= 0
        assert [link.carrier for link in reader.inputs] == [carrier]
        other.stop()


def test_a_killed_member_of_a_group_is_connected_again() -> None:
    with yarpy.NameServer() as server, yarpy.Port("/keepalive/out") as writer:
        other = start(server)
        writer.connect("/keepalive/other", "mcast")
        for turn in range(2):
            deadline = time.monotonic() + HANG
            while f"got {turn}\n" not in other.stdout:
                assert time.monotonic() < deadline, f"turn {turn}"
                writer.write([turn])
                time.sleep(0.02)
            other.kill()
            other = start(server)
        other.stop()


class Judge:
    """Looks as often as a test wants, without waiting in between."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(keepalive, "SOON", 0.0)
        monkeypatch.setattr(RECONNECTOR._keepalive, "look", lambda hubs: None)
        self.dead: list[Link] = []
        self.keepalive = Keepalive(lambda hub, link: self.dead.append(link))

    def __call__(self, *ports: Port | BufferedPort) -> int:
        """How many connections are found dead in four looks."""
        self.dead.clear()
        for _ in range(4):
            self.look(*ports)
        return len(set(self.dead))

    def look(self, *ports: Port | BufferedPort) -> None:
        """Look once, and wait for the answers."""
        self.keepalive.look([port._hub for port in ports])
        wait_until(lambda: not self.keepalive.questions.under_way)


@pytest.fixture
def judge(monkeypatch: pytest.MonkeyPatch) -> Iterator[Judge]:
    judge = Judge(monkeypatch)
    yield judge
    judge.keepalive.forget()


@pytest.mark.parametrize("carrier", ["udp", "mcast", "tcp"])
def test_silence_is_no_death(carrier: str, names: LocalNames, judge: Judge) -> None:
    with Port("/out", names=names) as out, BufferedPort("/in", names=names) as in_:
        out.connect("/in", carrier)
        assert in_.wait_for_inputs(timeout=HANG)
        assert judge(out, in_) == 0


def test_connected_by_address_is_connected(names: LocalNames, judge: Judge) -> None:
    with Port("/out", names=names) as out, BufferedPort("/in", names=names) as in_:
        out.connect(f"/{in_.address}", "mcast")
        assert in_.wait_for_inputs(timeout=HANG)
        assert judge(out, in_) == 0


def test_a_nameless_sender_is_not_judged(names: LocalNames, judge: Judge) -> None:
    with Port("", names=names) as out, BufferedPort("/in", names=names) as in_:
        out.connect("/in", "udp")
        assert in_.wait_for_inputs(timeout=HANG)
        assert judge(in_) == 0


@pytest.mark.parametrize("carrier", ["udp", "mcast"])
def test_lease_of_a_sender_whom_nobody_can_ask(
    carrier: str, names: LocalNames, judge: Judge, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A greeting costs its sender nothing: a name that nobody knows must not cost us for ever."""
    with Port("", names=names) as out, BufferedPort("/in", names=names) as in_:
        out.connect("/in", carrier)
        assert in_.wait_for_inputs(timeout=HANG)
        [link] = out._hub.outputs.links
        monkeypatch.setattr(keepalive, "LEASE", 1e-9)
        for count in range(5):
            link.send(Packet([count]))
            wait_until(lambda: in_.inputs[0].stats.messages == count + 1)  # noqa: B023
            judge.look(in_)
        assert len(in_.inputs) == 1, "it lives by its traffic"
        judge(in_)
        wait_until(lambda: not in_.inputs)
        assert not judge.dead, "nobody is asked to send again"
        assert in_.stats.past.inputs.messages == 5


def test_sender_who_can_be_asked_needs_no_traffic(
    names: LocalNames, judge: Judge, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(keepalive, "LEASE", 1e-9)
    with Port("/out", names=names) as out, BufferedPort("/in", names=names) as in_:
        out.connect("/in", "udp")
        assert in_.wait_for_inputs(timeout=HANG)
        assert judge(in_) == 0
        out.write(["still here"])
        assert in_.read(timeout=HANG).value == ["still here"]


@pytest.mark.parametrize("carrier", ["udp", "mcast"])
def test_who_does_not_know_us_any_more_is_dead(
    carrier: str, names: LocalNames, judge: Judge
) -> None:
    with Port("/out", names=names) as out, BufferedPort("/in", names=names) as in_:
        out.connect("/in", carrier)
        assert in_.wait_for_inputs(timeout=HANG)
        outputs, out._hub.outputs.links = (
            out._hub.outputs.links,
            (),
        )  # as if it had been started afresh
        assert judge(in_) == 1
        out._hub.outputs.links = outputs
        assert judge(in_) == 0, "one good answer, and it counts from the beginning"


def test_who_sends_needs_no_question(names: LocalNames, judge: Judge) -> None:
    with Port("/out", names=names) as out, BufferedPort("/in", names=names) as in_:
        out.connect("/in", "udp")
        assert in_.wait_for_inputs(timeout=HANG)
        outputs, out._hub.outputs.links = out._hub.outputs.links, ()
        [link] = outputs
        for count in range(5):
            link.send(Packet([count]))
            wait_until(lambda: in_.inputs[0].stats.messages == count + 1)  # noqa: B023
            judge.look(in_)
        assert not judge.dead
        out._hub.outputs.links = outputs


@pytest.mark.parametrize("carrier", ["udp", "mcast", "fast_tcp"])
def test_a_receiver_that_does_not_acknowledge_is_asked_what_came(
    carrier: str, names: LocalNames, judge: Judge
) -> None:
    with Port("/out", names=names) as out, BufferedPort("/in", names=names) as in_:
        out.connect("/in", carrier)
        assert in_.wait_for_inputs(timeout=HANG)
        for count in range(10):
            out.write([count])
        wait_until(lambda: in_.inputs[0].stats.messages == 10)
        assert judge(out) == 0
        [link] = out._hub.outputs.links
        assert link.sender.confirmation.witness
        assert link.snapshot()["unacknowledged"] == 0
        out.write(["more"])
        assert link.snapshot()["unacknowledged"] == 1
        assert link.snapshot()["messages"] == 11


def test_datagrams_that_did_not_come_are_drops(names: LocalNames, judge: Judge) -> None:
    with Port("/out", names=names) as out, BufferedPort("/in", names=names) as in_:
        out.connect("/in", "udp")
        assert in_.wait_for_inputs(timeout=HANG)
        [link] = out._hub.outputs.links
        link.send(Packet([0]))
        wait_until(lambda: in_.inputs[0].stats.messages == 1)
        assert judge(out) == 0
        really = link.driver.transport.send
        link.driver.transport.send = lambda buffers: None  # type: ignore[method-assign]
        for count in range(5):
            link.send(Packet([count]))
        link.driver.transport.send = really  # type: ignore[method-assign]
        judge(out)
        link.send(Packet([6]))
        judge(out)
        link.send(Packet([7]))
        stats = out.stats.outputs[0]
        assert (stats.messages, stats.drops) == (3, 5)
        out.disconnect("/in")
        past = out.stats.past.outputs
        assert (past.messages, past.drops, past.unconfirmed) == (3, 5, 0)


@pytest.mark.parametrize("carrier", ["udp", "mcast"])
def test_the_end_of_the_other_program_is_noticed_at_once(
    carrier: str, judge: Judge, monkeypatch: pytest.MonkeyPatch
) -> None:
    with yarpy.NameServer() as server, yarpy.BufferedPort("/keepalive/in") as reader:
        other = start(server)
        reader.listen_to("/keepalive/other", carrier)
        assert reader.read(timeout=HANG)
        assert judge(reader) == 0
        time.sleep(0.1)
        monkeypatch.setattr(keepalive, "SOON", 60.0)  # no question is due for long
        judge.look(reader)
        assert not judge.dead
        other.kill()
        wait_until(lambda: judge(reader) == 1)


def test_silent_connections_end_with_what_they_watch(names: LocalNames, judge: Judge) -> None:
    with Port("/out", names=names) as out, BufferedPort("/in", names=names) as in_:
        out.connect("/in", "mcast")
        assert in_.wait_for_inputs(timeout=HANG)
        assert judge(out) == 0
        [sign] = judge.keepalive._signs.values()
        line = sign.line
        assert line is not None
        out.disconnect("/in")
        judge(out)
        assert line.sock.fileno() < 0


def test_a_host_that_cannot_be_reached_may_come_back(
    names: LocalNames, judge: Judge, monkeypatch: pytest.MonkeyPatch
) -> None:
    def connection(*arguments: object, **options: object) -> None:
        raise LinkClosed("No route to host")

    with Port("/out", names=names) as out, BufferedPort("/in", names=names) as in_:
        out.connect("/in", "mcast")
        assert in_.wait_for_inputs(timeout=HANG)
        monkeypatch.setattr(keepalive.probe, "connection", connection)
        assert judge(out) == 0
        monkeypatch.setattr(keepalive, "GONE", 0.0)
        assert judge(out) == 1, "a host that stays away is dead"
