"""Crowd: many greetings over datagrams leave room for those who really send."""

from __future__ import annotations

import contextlib
import socket
import threading
from types import SimpleNamespace
from typing import Any

import pytest
from support.wait import HANG, wait_until

from yarpy.carriers.base import Delivery
from yarpy.errors import RemoteProtocolError
from yarpy.link.begin.admission import Peer
from yarpy.link.counter import Counter
from yarpy.nameserver.local import LocalNames
from yarpy.port.answer import crowd
from yarpy.port.connect.reconnect import RECONNECTOR
from yarpy.port.inputs import Inputs
from yarpy.port.port import BufferedPort, Port
from yarpy.wire import framing

UDP = framing.number(framing.BASE)
MCAST = framing.number(framing.BASE + 1)
GROUP = bytes((224, 1, 200, 9, 40, 0))


def greet(port: int, number: int, host: str = "127.0.0.1") -> bytes:
    """What a stranger is answered, who greets and goes."""
    carrier, more = ((UDP, b""), (MCAST, GROUP))[number % 2]
    with socket.create_connection(("127.0.0.1", port), 10, (host, 0)) as sock:
        sock.sendall(carrier + framing.encode_name(f"/stranger/{number}") + more)
        sock.shutdown(socket.SHUT_WR)
        with sock.makefile("rb") as file:
            return file.read()


def test_300_greetings_leave_room_for_a_sender(names: LocalNames) -> None:
    came: list[int] = []
    all_here = threading.Event()

    def take(message: Any) -> None:
        came.append(message.value[0])
        if len(came) == 150:
            all_here.set()

    with (
        BufferedPort("/in", names=names, callback=take) as port,
        Port("/out", names=names) as out,
    ):
        for number in range(0, 600, 2):
            assert greet(port.contact.port, number)
        assert len(port.inputs) <= crowd.MOST
        out.connect("/in", "udp")
        for number in range(150):
            out.write([number])
        assert all_here.wait(HANG)
        assert came == list(range(150))
        assert [link.carrier for link in out.outputs] == ["udp"]


def test_greetings_do_not_pile_up(names: LocalNames, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each leaves a thread and a socket behind when its TCP connection is gone."""
    monkeypatch.setattr(crowd, "MOST", 5)
    with Port("/in", names=names) as port, Port("/out", names=names) as out:
        for number in range(8):
            greet(port.contact.port, number)
            assert len(port.inputs) <= 5
        wait_until(lambda: len(port.inputs) == 5)
        out.connect("/in")  # other carriers are as welcome as ever
        out.connect("/in", "udp")
        wait_until(lambda: port.inputs[-1].carrier == "udp" and port.inputs[-1].source == "/out")


def test_one_computer_does_not_take_all(names: LocalNames, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(crowd, "MOST", 8)
    monkeypatch.setattr(
        "yarpy.link.begin.admission.same_computer", lambda remote, local: remote == "127.0.0.1"
    )
    with Port("/in", names=names) as port, Port("/out", names=names) as out:
        out.connect("/in", "udp")
        for number in range(4):
            assert greet(port.contact.port, 2 * number, "127.0.0.2")
        wait_until(lambda: len(port.inputs) == 3)
        assert "/out" in [link.source for link in port.inputs]


def test_who_finds_no_place_is_told_before_it_sends(
    names: LocalNames, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(crowd, "MOST", 1)
    with contextlib.ExitStack() as stack:
        port, first, second = (
            stack.enter_context(Port(name, names=names)) for name in ("/in", "/first", "/second")
        )
        first.connect("/in", "udp")
        first.write(["hello"])
        assert port.read(timeout=HANG).value == ["hello"]
        answer = greet(port.contact.port, 0)
        assert answer.startswith(b"* there are too many inputs over datagrams")
        with pytest.raises(RemoteProtocolError, match="too many inputs over datagrams"):
            second.connect("/in", "udp")
        second.connect("/in", "tcp")
        [link] = second._hub.outputs.links
        link.route.spec = link.route.spec.over("udp")  # as if it had been one that broke
        second._hub.outputs.drop(link, "it broke", lost=True)
        link.close(quit_=False)
        wait_until(lambda: "dialled again now and then" in caplog.text)
        assert "too many inputs over datagrams" in caplog.text
        RECONNECTOR.give_up(second._hub, "/in")


def test_whose_first_message_is_still_looked_at_keeps_its_place(
    names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It was as one that had sent nothing for a while, until the callback had ended."""
    monkeypatch.setattr(crowd, "MOST", 1)
    begun, over = threading.Event(), threading.Event()

    def look(message: Any) -> None:
        begun.set()
        over.wait(HANG)

    with (
        Port("/in", names=names, callback=look) as port,
        Port("/first", names=names) as first,
    ):
        first.connect("/in", "udp")
        first.write(["hello"])
        assert begun.wait(HANG)
        assert greet(port.contact.port, 0).startswith(b"* there are too many inputs")
        over.set()


def link(**given: Any) -> Any:
    """An input over datagrams of this computer."""
    facts = {"vouched": False, "closing": False, "address": "127.0.0.1", "here": True, **given}
    peer = Peer(facts.pop("address"), facts.pop("here"))
    counter = Counter(messages=facts.pop("messages", 0))
    receiver = SimpleNamespace(heard=facts.pop("last", 0.0))
    return SimpleNamespace(
        carrier=SimpleNamespace(delivery=Delivery(connectionless=True)),
        driver=SimpleNamespace(admission=SimpleNamespace(peer=peer)),
        counter=counter,
        receiver=receiver,
        **facts,
    )


def test_who_leaves(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(crowd, "MOST", 4)
    monkeypatch.setattr(crowd.time, "perf_counter", lambda: 100.0)
    here = Peer("127.0.0.1", True)
    busy, idle = link(messages=5, last=95.0), link(messages=5, last=80.0)
    asked, new, going = link(vouched=True), link(), link(closing=True)
    assert crowd.room([busy, idle, asked], here) == ("", None)
    why, leaves = crowd.room([busy, asked, going, new, idle], here)
    assert "tcp" in why and leaves is new
    assert crowd.room([busy, asked, idle, new], here)[1] is idle
    assert crowd.room([busy, asked, going, busy], here)[1] is None
    far = Peer("10.0.0.9", False)
    theirs = link(address="10.0.0.9", here=False)
    assert crowd.room([new, theirs], far)[1] is theirs
    assert crowd.room([new], far) == ("", None)


def test_who_was_given_a_place_finds_one(
    names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Others that greet at the same time may have it by the time it is needed."""
    monkeypatch.setattr(crowd, "MOST", 2)
    with Port("/in", names=names) as port, Port("/out", names=names) as out:
        assert greet(port.contact.port, 0) and greet(port.contact.port, 2)
        wait_until(lambda: len(port.inputs) == 2)
        replace = Inputs._replace

        def late(inputs: Inputs, idle: Any) -> bool:
            found = replace(inputs, idle)
            monkeypatch.setattr(Inputs, "_replace", replace)
            assert found and greet(port.contact.port, 4)
            wait_until(lambda: "/stranger/4" in [link.source for link in port.inputs])
            return found

        monkeypatch.setattr(Inputs, "_replace", late)
        out.connect("/in", "udp")
        wait_until(lambda: "/out" in [link.source for link in port.inputs])
        assert len(port.inputs) == 2
