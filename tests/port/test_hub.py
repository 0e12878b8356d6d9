"""A port's connections: opening and closing it, who displaces whom."""

from __future__ import annotations

import contextlib
import os
import socket
import threading
from types import SimpleNamespace

import pytest
from support import held
from support.moments import moments
from support.port import free_port
from support.wait import HANG, wait_until

from yarpy import network
from yarpy.contact import Contact
from yarpy.data.bottle import Bottle
from yarpy.errors import (
    LinkClosed,
    NoNameServer,
    PortClosed,
    UnknownName,
    YarpError,
)
from yarpy.nameserver.local import LocalNames
from yarpy.port.connect import probe
from yarpy.port.hub import Actions, Hub
from yarpy.port.keep.registration import Registration
from yarpy.port.mailbox import Latest
from yarpy.port.port import Port

# ---------------------------------------------------------------------------------- opening


def test_open_port_is_registered_and_says_what_it_is(names: LocalNames) -> None:
    with Port("/here", names=names, port_type="bottle") as port:
        contact = names.query("/here")
        assert contact == Contact("tcp", "/here", "127.0.0.1", port.contact.port)
        assert "tcp" in names.get("/here", "offers")
        assert "tcp" in names.get("/here", "accepts")
        assert names.get("/here", "process") == [str(os.getpid())]
        assert names.get("/here", "ips")
    assert names.query("/here") is None


def test_hub_knows_nobody_who_acts_on_it() -> None:
    """What commands, administration and reconnecting do is handed in."""
    told: list[str] = []
    reconnect = SimpleNamespace(
        watch=lambda hub: told.append(f"watch {hub.name}"),
        forget=lambda hub: told.append(f"forget {hub.name}"),
        input_lost=lambda hub, route: None,
        give_up=lambda hub, name, incoming: False,
    )
    actions = Actions(
        administer=lambda hub, message: Bottle(["as", "you", "like"]),
        obey=lambda hub, link, message: [f"{hub.name} heard {message.key}"],
        close_output=lambda hub, link: None,
        reconnect=reconnect,  # type: ignore[arg-type]
    )
    registration = Registration("/here", None, "", register=False)
    hub = Hub(registration, Latest(), actions)
    hub.open(0, "")
    try:
        contact = Contact("tcp", "/here", "127.0.0.1", hub.port)
        assert probe.ask(contact, ["whatever"]) == ["as", "you", "like"]
        assert probe.describe(contact)[0] == "/here heard *"
    finally:
        hub.close()
    assert told == ["watch /here", "forget /here"]


# ---------------------------------------------------------------------------------- closing


def test_closing_tells_senders_and_receivers(names: LocalNames) -> None:
    with (
        Port("/out", names=names) as out,
        Port("/middle", names=names) as middle,
        Port("/in", names=names) as in_,
    ):
        out.connect("/middle")
        middle.connect("/in")
        assert in_.wait_for_inputs(timeout=HANG)
        middle.close()
        middle.close()
        wait_until(lambda: not out.outputs and not in_.inputs)
        assert names.query("/middle") is None
        assert out.write([1]) == 0
        with pytest.raises(UnknownName):
            out.connect("/middle")


def test_closing_frees_the_number_and_its_threads(names: LocalNames) -> None:
    before = held.threads()
    for _ in range(5):
        number = free_port()  # which nobody else is given meanwhile
        with (
            Port("/in", names=names, tcp_port=number) as in_,
            Port("/out", names=names) as out,
        ):
            out.connect("/in")
            out.write([1])
            in_.read(timeout=HANG)
        with socket.socket() as sock:
            sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            sock.bind(("", number))
    wait_until(lambda: len(held.threads() - before) <= 1)


def test_error_for_a_peer_that_is_not_there(names: LocalNames) -> None:
    names.register("/gone", "tcp", "127.0.0.1", free_port())
    with Port("/out", names=names) as out:
        with pytest.raises(LinkClosed, match='"/out" cannot connect to "/gone" over tcp'):
            out.connect("/gone")
        with pytest.raises(YarpError):
            out.connect("/127.0.0.1:1")
        assert out.outputs == []


def test_snapshot_tells_all(names: LocalNames) -> None:
    with Port("/in", names=names) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        out.write([1])
        in_.read(timeout=HANG)
        stats = in_.stats
        assert stats.name == "/in"
        assert stats.inputs[0].source == "/out"
        assert stats.inputs[0].messages == 1
        assert stats.outputs == []
        assert stats.waiting == 0
        assert out.stats.outputs[0].target == "/in"


class Frozen(LocalNames):
    """A name service that at some time does not answer any more."""

    frozen = False
    asked = 0  # by the test's own thread, in vain

    def query(self, name: str) -> Contact | None:
        if self.frozen:
            self.asked += threading.current_thread() is threading.main_thread()
            raise NoNameServer("it does not answer within 10 s")
        return super().query(name)


def test_closing_waits_once_for_a_name_service_that_does_not_answer() -> None:
    """It used to wait for each connection: minutes, with a dozen of them."""
    names = Frozen()
    with contextlib.ExitStack() as stack:
        for number in range(3):
            stack.enter_context(Port(f"/out{number}", names=names))
        here = Port("/here", names=names)
        for number in range(3):
            network.connect(f"/out{number}", "/here", names=names)
        wait_until(lambda: len(here.inputs) == 3)
        names.frozen = True
        here.close()
        assert names.asked == 1
        names.frozen = False


def test_closed_port_cannot_be_resumed(names: LocalNames) -> None:
    """Its readers would wait for ever."""
    port = Port("/here", names=names)
    port.close()
    with pytest.raises(PortClosed):
        port.resume()


def test_closed_while_it_is_resumed(names: LocalNames) -> None:
    """By a signal handler, at any moment: nobody reads or writes any more."""
    for moment in moments():
        port = Port("/in", names=names)
        port.interrupt()
        with moment.interrupts(port.close), contextlib.suppress(PortClosed):
            port.resume()
        if moment.came:
            with pytest.raises(PortClosed):
                port._hub.inputs.mailbox.take(5)
        port.close()
