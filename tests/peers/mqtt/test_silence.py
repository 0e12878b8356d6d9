"""A broker that dies, falls silent or is cut off, as a port's program learns of it."""

from __future__ import annotations

import signal
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from support.broker import Broker
from support.wait import HANG, wait_until

import yarpy
from yarpy.peers.mqtt import packet as mqtt
from yarpy.port.answer import ping

EVERY = 30.0  # seconds between two pings


class FakeBroker:
    """Takes clients and their subscriptions, hands on nothing, and answers pings while `answers`.
    `cut` closes all connections; `reset` with an error for the peer."""

    def __init__(self) -> None:
        self.answers = True
        self.pings = 0
        self.clients: list[socket.socket] = []
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = self._listener.getsockname()[1]
        self._threads: list[threading.Thread] = []
        self._start(self._accept)

    def _start(self, run: Callable[..., None], *args: object) -> None:
        thread = threading.Thread(target=run, args=args, daemon=True)
        self._threads.append(thread)
        thread.start()

    def topic(self, name: str, added: str = "") -> str:
        return f"mqtt{added}://127.0.0.1:{self.port}/{name}"

    def _accept(self) -> None:
        while True:
            try:
                client, _ = self._listener.accept()
            except OSError:
                return
            self.clients.append(client)
            self._start(self._serve, client)

    def _serve(self, client: socket.socket) -> None:
        try:
            with client.makefile("rb") as file:
                while first := file.read(1):
                    size, shift = 0, 0
                    while True:
                        (digit,) = file.read(1)
                        size |= (digit & 0x7F) << shift
                        shift += 7
                        if digit < 0x80:
                            break
                    client.sendall(self._answer(first[0], file.read(size)))
        except (OSError, ValueError):
            pass  # the connection is over

    def _answer(self, first: int, body: bytes) -> bytes:
        kind = first & 0xF0
        if kind == mqtt.CONNECT:
            version_5 = body[6] == mqtt.V5
            return mqtt.packet(mqtt.CONNACK, b"\0\0\0" if version_5 else b"\0\0")
        if kind == mqtt.SUBSCRIBE:
            version_5 = len(body) > 6 and body[2:4] == b"\0\0"
            return mqtt.packet(mqtt.SUBACK, body[:2] + (b"\0\0" if version_5 else b"\0"))
        if kind == mqtt.PINGREQ:
            self.pings += 1
            return mqtt.packet(mqtt.PINGRESP) if self.answers else b""
        return b""

    def cut(self) -> None:
        for client in self.clients:
            with suppress(OSError):  # they have hung up
                client.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        # Closing alone would wake no thread that waits inside: it would take one more client later.
        with suppress(OSError):  # on Windows closing it wakes, and this is refused
            self._listener.shutdown(socket.SHUT_RDWR)
            self._threads[0].join(HANG)
        self._listener.close()
        self.cut()
        for thread in self._threads:
            thread.join(HANG)
        for client in self.clients:
            client.close()


@pytest.fixture
def fake() -> Iterator[FakeBroker]:
    found = FakeBroker()
    yield found
    found.close()


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Any:
    found = SimpleNamespace(now=0.0)
    monkeypatch.setattr(ping, "time", SimpleNamespace(monotonic=lambda: found.now))
    return found


def opened(names: yarpy.LocalNames, added: str) -> tuple[Any, Callable[[Any], Any], Any]:
    """A port that publishes (or subscribes) and its connections, and what tells of their end."""
    events: list[Any] = []
    kind = yarpy.BufferedPort if added == "+sub" else yarpy.Port
    port = kind("/p", names=names, on_connection=events.append)
    links = (lambda p: p._hub.inputs.links) if added == "+sub" else (lambda p: p._hub.outputs.links)
    return port, links, events


def later(clock: Any, pings: ping.Pings, *hubs: Any) -> bool:
    """Half a minute passes."""
    clock.now += EVERY + 1
    pings.look(hubs)
    return True


@pytest.mark.parametrize("added", ["", "+sub", "+qos.1"])
def test_a_broker_that_does_not_answer_is_told_and_left(
    fake: FakeBroker, names: yarpy.LocalNames, clock: Any, caplog: Any, added: str
) -> None:
    port, links, events = opened(names, added)
    with port:
        port.connect(fake.topic("x", added))
        (link,) = links(port)
        pings = ping.Pings()
        pings.look([port._hub])
        for _ in range(3):  # it answers: an hour of silence is none
            before = fake.pings
            clock.now += EVERY + 1
            pings.look([port._hub])
            wait_until(lambda: fake.pings > before)  # noqa: B023
            turn = pings._turns[link]
            wait_until(lambda: ping._is_there(link, turn.heard))  # noqa: B023
        assert links(port) == (link,)
        fake.answers = False
        wait_until(lambda: later(clock, pings, port._hub) and link not in links(port))
        wait_until(lambda: any("has not answered" in str(event) for event in events))
    assert "it has not answered for" in caplog.text


def test_a_broker_that_acknowledges_nothing_holds_no_writer(
    fake: FakeBroker, names: yarpy.LocalNames, clock: Any
) -> None:
    """No ping may come between messages and their acknowledgements."""
    fake.answers = False
    written: list[int] = []
    with yarpy.Port("/p", names=names) as port:
        port.connect(fake.topic("x", "+qos.1"))
        (link,) = port._hub.outputs.links
        pings = ping.Pings()
        pings.look([port._hub])

        def write() -> None:
            while link in port._hub.outputs.links:
                written.append(port.write([1]))

        def waits() -> bool:
            before = len(written)
            time.sleep(0.2)
            return link.sender.window.open > 0 and len(written) == before

        writing = threading.Thread(target=write, daemon=True)
        writing.start()
        wait_until(waits)
        wait_until(lambda: later(clock, pings, port._hub) and link not in port._hub.outputs.links)
        writing.join(HANG)
        assert not writing.is_alive()


@pytest.mark.parametrize("added", ["", "+sub", "+qos.1"])
def test_a_broker_that_dies_is_told(fake: FakeBroker, names: yarpy.LocalNames, added: str) -> None:
    port, links, events = opened(names, added)
    with port:
        port.connect(fake.topic("x", added))
        (link,) = links(port)
        fake.cut()
        wait_until(lambda: link not in links(port))
        wait_until(lambda: any(not event.created for event in events))


def test_who_asks_at_a_broker_that_says_nothing_has_a_time_limit(
    fake: FakeBroker, names: yarpy.LocalNames
) -> None:
    with yarpy.RpcClient(name="/ask", names=names) as client:
        client.connect(fake.topic("x", "+rpc"))
        with pytest.raises(yarpy.Timeout, match="did not reply"):
            client.call(1, timeout=0.2)


def test_a_greeting_that_is_not_answered(names: yarpy.LocalNames) -> None:
    """A half-open broker: its computer takes connections, and nobody speaks."""
    with socket.create_server(("127.0.0.1", 0)) as mute, yarpy.Port("/p", names=names) as port:
        with pytest.raises(yarpy.YarpError):
            port.connect(f"mqtt://127.0.0.1:{mute.getsockname()[1]}/x", timeout=0.5)
        assert not port.outputs


@pytest.mark.peer("mosquitto")
@pytest.mark.parametrize("how", ["killed", "stopped"])
def test_mosquitto(
    tmp_path: Path, names: yarpy.LocalNames, how: str, clock: Any, caplog: Any
) -> None:
    broker = Broker(tmp_path)
    events: list[Any] = []
    try:
        with (
            yarpy.Port("/out", names=names, on_connection=events.append) as out,
            yarpy.BufferedPort("/in", names=names, on_connection=events.append) as reader,
        ):
            reader.connect(broker.topic("x", "+sub"))
            out.connect(broker.topic("x"))
            out.write([1])
            first = reader.read(timeout=HANG)
            assert first is not None and first.value == [1]
            links = (*out._hub.outputs.links, *reader._hub.inputs.links)
            hubs = [out._hub, reader._hub]
            pings = ping.Pings()
            pings.look(hubs)
            if how == "killed":
                broker.process.kill()
            else:
                broker.process.signal(signal.SIGSTOP)
                wait_until(
                    lambda: (
                        later(clock, pings, *hubs)
                        and not {*out._hub.outputs.links, *reader._hub.inputs.links} & {*links}
                    )
                )
            wait_until(lambda: not {*out._hub.outputs.links, *reader._hub.inputs.links} & {*links})
            wait_until(lambda: sum(not event.created for event in events) >= 2)
            if how == "stopped":
                assert caplog.text.count("it has not answered for") >= 2
                broker.process.signal(signal.SIGCONT)
    finally:
        broker.process.signal(signal.SIGCONT)
        broker.stop()
