"""Many peers with unfinished messages: together they hold no more than the port's limit, and who
sends something meanwhile gets through."""

from __future__ import annotations

import time
from contextlib import ExitStack

import pytest
from support.wait import HANG, wait_until

from yarpy.link.begin.handshake import greet
from yarpy.link.driver import Driver
from yarpy.link.receive import budget
from yarpy.link.receive.incoming import Incoming
from yarpy.nameserver.local import LocalNames
from yarpy.port.port import Port
from yarpy.route import Route
from yarpy.wire import framing
from yarpy.wire.datagram import split
from yarpy.wire.message import Packet

LIMIT = 1 << 20
LONG_AGO = time.monotonic() - 1000.0
PART = 600_000  # bytes that each sends of its message
WHOLE = b"".join(map(bytes, framing.encode(Packet(bytes(1 << 24)))))[:PART]
COMMAND = b"\0\0\0\0~D\0\1"
PAYLOAD = WHOLE[WHOLE.index(COMMAND) + len(COMMAND) :]
PARTS = {
    "tcp": [WHOLE],
    "text": [b"d\r\n(" + b"1 " * (PART // 2)],
    "unix_stream": [COMMAND, PAYLOAD],
    "websocket": [b"\x82\xff" + (1 << 25).to_bytes(8, "big") + bytes(4) + COMMAND, PAYLOAD],
    "udp": [*split([WHOLE])],
}


def begun(port: Port) -> list[Incoming]:
    """Return the messages that have begun to come."""
    links = port._hub.inputs.links
    return [link.receiver.incoming for link in links if link.receiver.incoming.since]


@pytest.mark.parametrize("carrier", PARTS)
def test_unfinished_messages_share_a_limit(
    carrier: str, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setenv(budget.SETTING, str(LIMIT))
    names = LocalNames()
    with Port("/port", names=names) as port, Port("/out", names=names) as out, ExitStack() as stack:
        for number in range(6):
            driver, _ = greet(
                port.contact, Route(f"/slow/{number}", "/port", carrier), timeout=HANG
            )
            stack.callback(driver.transport.close)
            driver.transport.send(PARTS[carrier])
            wait_until(lambda: any(one.since > LONG_AGO for one in begun(port)))
            for one in begun(port):  # before the next one, however long each takes here
                one.since = min(one.since, LONG_AGO - number)
        wait_until(lambda: caplog.text.count(budget.SETTING) >= 4)
        wait_until(lambda: len(port.inputs) <= 2)
        picture = bytes(range(256)) * (LIMIT // 256)
        out.connect("/port", "tcp")
        out.write(picture)
        assert port.read(timeout=HANG).as_(bytes) == picture
        assert port.stats.past.inputs.drops >= 4


def test_large_message_gets_through_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(budget.SETTING, str(LIMIT))
    names = LocalNames()
    with Port("/port", names=names) as port, Port("/out", names=names) as out:
        out.connect("/port", "tcp")
        for _ in range(3):
            out.write(bytes(8 * LIMIT))
            assert len(port.read(timeout=HANG).as_(bytes)) == 8 * LIMIT


def test_nothing_is_held_once_they_have_gone(monkeypatch: pytest.MonkeyPatch) -> None:
    total = budget.port_budget()._whole
    assert total is not None
    before = total.total
    with Port("/port", names=LocalNames()) as port:
        drivers: list[Driver] = []
        for number in range(3):
            driver, _ = greet(port.contact, Route(f"/slow/{number}", "/port", "fast_tcp"))
            driver.transport.send([WHOLE])
            drivers.append(driver)
        wait_until(lambda: total.total >= before + 3 * PART)
        for driver in drivers:
            driver.transport.close()
        wait_until(lambda: total.total == before)
