"""What is live: what is kept, and what a page is sent of it."""

from __future__ import annotations

import json

import pytest
from support.foxglove_client import Client
from support.wait import wait_until

import yarpy
from yarpy.errors import NoNameServer
from yarpy.kits.record.capture.queue import OVERHEAD
from yarpy.kits.record.capture.subscriptions import PortSelection
from yarpy.kits.record.recording import Recording
from yarpy.kits.record.view import ring as module
from yarpy.kits.record.view.ring import LiveSource, Ring
from yarpy.kits.record.view.server import View
from yarpy.wire.message import DATA, Message


def message(n: int, port: str = "/a") -> Message:
    found = Message(DATA, yarpy.Bottle([n]).to_bytes(), f"{n} {n}.5")
    found.source = port
    return found


def test_what_is_kept() -> None:
    size = OVERHEAD + len(yarpy.Bottle([1]).to_bytes())
    ring = Ring(memory=10 * size)
    assert ring.begin == ring.end == ring.begun and [*ring.messages()] == []
    for n in range(100):
        ring.put(message(n, "/a" if n % 2 else "/b"))
    found = [*ring.messages()]
    assert [one.value for one in found] == [[n] for n in range(90, 100)]
    assert ring.begin == found[0].received_ns and ring.end == found[-1].received_ns
    assert found[0].sent == 90.5 and ring.size == 10 * size
    assert [one.value[0] for one in ring.messages(["/b"])] == [90, 92, 94, 96, 98]
    assert {one.value[0] for one in ring.last(["/a", "/b", "/c"], ring.end)} == {98, 99}
    assert ring.ports["/a"].messages == 50 and len(ring.moments()[0]) == 10
    assert [*Recording([ring]).between(begin=found[3].received_ns)][-1].value == [99]


@pytest.mark.parametrize("envelope", ["1 inf", "1 nan", "1 1e300", "-3 5", "1 -7", "x"])
def test_times_that_strangers_make_up(envelope: str) -> None:
    ring = Ring()
    found = message(1)
    found.envelope = envelope
    ring.put(found)
    (kept,) = ring.messages()
    assert kept.sent_ns == kept.received_ns and kept.envelope == envelope


def test_what_is_old_goes(monkeypatch: pytest.MonkeyPatch) -> None:
    now = 1_000_000_000_000
    monkeypatch.setattr(module, "_SLACK", 5)
    monkeypatch.setattr("time.time_ns", lambda: now)
    ring = Ring(keep=1.0)
    for n in range(50):
        now += 100_000_000
        ring.put(message(n))
    assert [one.value[0] for one in ring.messages()] == [*range(39, 50)]
    # Somebody who reads slowly misses what has gone meanwhile.
    reading = ring.messages()
    assert next(reading).value == [39]
    now += 10_000_000_000
    for n in range(50, 70):
        ring.put(message(n))
    assert [one.value[0] for one in ring.messages()] == [*range(50, 70)]


def test_a_page_follows_and_looks_back() -> None:
    with (
        yarpy.NameServer() as server,
        yarpy.Port("/a", names=server.client) as port,
        LiveSource(PortSelection(("/a",)), names=server.client) as source,
        View(source, port=0) as view,
        Client(view.url) as client,
    ):
        port.wait_for_outputs()
        assert client.until("state")[1] == "playing"
        port.write([1])
        client.subscribe("/a", 7)
        assert json.loads(client.until("message")[3])["v"] == [1]
        port.write([2])
        _, _, second, payload = client.until("message")
        assert json.loads(payload)["v"] == [2]
        # It stands still, while the port goes on.
        client.control(True, name="stop")
        while client.until("state")[5] != "stop":
            pass
        for n in range(3, 6):
            port.write([n])
        wait_until(lambda: source.told()["ports"][0]["messages"] == 5)
        client.control(True, seek=second + 1, name="back")
        while client.until("state")[5] != "back":
            pass
        assert json.loads(client.until("message")[3])["v"] == [2]
        # And again what is now.
        client.control(False, seek=source.end + 1)
        assert json.loads(client.until("message")[3])["v"] == [5]
        port.write([6])
        assert json.loads(client.until("message")[3])["v"] == [6]
        told = source.told()
        assert told["live"] and [note["what"] for note in told["notes"]] in ([], ["connected"])


def test_without_a_name_server(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_SERVER", "127.0.0.1:1")
    with pytest.raises(NoNameServer):
        LiveSource(PortSelection(("/a",)))
