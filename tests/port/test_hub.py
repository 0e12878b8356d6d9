"""A port's connections: opening and closing it, who displaces whom, keys, groups, strangers."""

from __future__ import annotations

import contextlib
import logging
import os
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from support.port import free_port
from support.wait import wait_until

from yarpy import network
from yarpy.contact import Contact
from yarpy.errors import (
    AddressError,
    LinkClosed,
    NoNameServer,
    PortClosed,
    UnknownName,
    YarpError,
)
from yarpy.names.client import YarpNameClient
from yarpy.names.local import LocalNames
from yarpy.names.several import SeveralNames
from yarpy.port.port import Port
from yarpy.port.probe import is_alive
from yarpy.services.name_server import NameServer
from yarpy.wire import framing

# ---------------------------------------------------------------------------------- opening


def test_open_port_is_registered_and_says_what_it_is(names: LocalNames) -> None:
    with Port("/here", names=names, type_="bottle") as port:
        contact = names.query("/here")
        assert contact == Contact("tcp", "/here", "127.0.0.1", port.contact.port)
        assert "tcp" in names.get("/here", "offers")
        assert "tcp" in names.get("/here", "accepts")
        assert names.get("/here", "process") == [str(os.getpid())]
        assert names.get("/here", "ips")
    assert names.query("/here") is None


@pytest.mark.parametrize(
    ("name", "problem"),
    [
        ("here", "must start with"),
        ("/a b", "blanks"),
        ("/here/", "must not end"),
        ("/here:10", "address"),
        ("/" + "x" * 1000, "longer"),
        ("/a\nb", "blanks"),
        ("/a\x01b", "control"),
    ],
)
def test_names_that_cannot_be(name: str, problem: str, names: LocalNames) -> None:
    with pytest.raises(AddressError, match=problem):
        Port(name, names=names)


def test_name_in_use_is_refused_with_who_has_it(names: LocalNames) -> None:
    with Port("/here", names=names) as port:
        with pytest.raises(AddressError, match=f'"/here" is in use by a port at {port.address}'):
            Port("/here", names=names)
        assert names.query("/here") == port.contact
    with Port("/here", names=names):
        pass


def test_name_of_a_port_that_died_is_taken_over(names: LocalNames) -> None:
    names.register("/here", "tcp", "127.0.0.1", free_port())
    with Port("/here", names=names) as port:
        assert names.query("/here") == port.contact


def test_name_of_something_else_that_listens_there_is_taken_over(names: LocalNames) -> None:
    """A leftover registration whose number now belongs to another program."""
    with Port("/other", names=names) as other:
        names.register("/here", "tcp", "127.0.0.1", other.contact.port)
        with Port("/here", names=names) as port:
            assert names.query("/here") == port.contact


def test_chosen_number(names: LocalNames) -> None:
    number = free_port()
    with Port("/here", names=names, port=number) as port:
        assert port.contact.port == number
        with pytest.raises(AddressError, match=f"cannot listen on TCP port {number}"):
            Port("/there", names=names, port=number)
    assert names.query("/there") is None


def test_no_name_server(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_SERVER", f"127.0.0.1:{free_port()}")
    started = time.monotonic()
    with pytest.raises(NoNameServer):
        Port("/here")
    assert time.monotonic() - started < 5


def test_name_server_hands_out_names_and_numbers() -> None:
    with NameServer() as server, Port("...") as first, Port("...") as second:
        assert first.name.startswith("/tmp/port/")
        assert first.name != second.name
        assert first.contact.port != second.contact.port
        assert server.service.store.query(first.name) == first.contact


def test_number_that_somebody_took_meanwhile() -> None:
    """The name server cannot know who else listens; the port finds another number and says so."""
    with NameServer() as server, socket.socket() as squatter:
        contact = server.client.register("/probe")
        server.client.unregister("/probe")
        squatter.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        squatter.bind(("", contact.port))
        squatter.listen()
        with Port("/here") as port, Port("/out") as out:
            assert port.contact.port != contact.port
            known = server.client.query("/here")
            assert known is not None
            assert known.port == port.contact.port
            out.connect("/here")
            out.write([1])
            assert port.read(timeout=5).value == [1]


def test_name_server_that_has_no_numbers_left() -> None:
    """The port says so and is not there; whoever has a number keeps it, or brings one."""
    with NameServer() as server, Port("/first") as first:
        server.service.store.numbers.last = server.service.store.numbers.counter
        with pytest.raises(AddressError, match=r'refused "/second": .*ran out of port numbers'):
            Port("/second")
        assert server.client.query("/second") is None
        with Port("/third", port=free_port()) as third, Port("/first2", port=free_port()) as out:
            out.connect("/third")
            out.write([1])
            assert third.read(timeout=5).value == [1]
        assert server.client.query("/first") == first.contact


# ---------------------------------------------------------------------------------- closing


def test_closing_tells_senders_and_receivers(names: LocalNames) -> None:
    with (
        Port("/out", names=names) as out,
        Port("/middle", names=names) as middle,
        Port("/in", names=names) as in_,
    ):
        out.connect("/middle")
        middle.connect("/in")
        assert in_.wait_for_inputs(timeout=5)
        middle.close()
        middle.close()
        assert out.outputs == []
        wait_until(lambda: not in_.inputs)
        assert names.query("/middle") is None
        assert out.write([1]) == 0
        with pytest.raises(UnknownName):
            out.connect("/middle")


def test_closing_frees_the_number_and_its_threads(names: LocalNames) -> None:
    before = threading.active_count()
    for _ in range(5):
        with Port("/in", names=names) as in_, Port("/out", names=names) as out:
            out.connect("/in")
            out.write([1])
            in_.read(timeout=5)
            number = in_.contact.port
        with socket.socket() as sock:
            sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            sock.bind(("", number))
    wait_until(lambda: threading.active_count() <= before + 1)


def test_name_that_went_to_somebody_else_is_not_given_back(names: LocalNames) -> None:
    port = Port("/here", names=names)
    names.register("/here", "tcp", "127.0.0.1", 9)
    port.close()
    known = names.query("/here")
    assert known is not None
    assert known.port == 9


def test_closing_does_not_wait_for_strangers(names: LocalNames) -> None:
    port = Port("/here", names=names)
    with socket.create_connection(("127.0.0.1", port.contact.port)) as sock:
        sock.sendall(b"CONNECT /nobody\r\n")
        assert sock.recv(100) == b"Welcome /nobody\r\n"
        started = time.monotonic()
        port.close()
        assert time.monotonic() - started < 3


# ---------------------------------------------------------------------------------- displacing


def test_new_connection_of_the_same_sender_replaces_the_old(names: LocalNames) -> None:
    with Port("/in", names=names) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        for carrier in ("fast_tcp", "udp", "text_ack", "tcp"):
            out.connect("/in", carrier)
            assert [o.carrier for o in out.outputs] == [carrier]
            wait_until(lambda c=carrier: [i.carrier for i in in_.inputs] == [c])
            out.write([carrier])
            assert in_.read(timeout=5).value == [carrier]


def test_unrooted_names_do_not_displace(names: LocalNames) -> None:
    with Port("/in", names=names) as in_:
        socks = [socket.create_connection(("127.0.0.1", in_.contact.port)) for _ in range(3)]
        for sock in socks:
            sock.sendall(b"CONNECT visitor\r\n")
        wait_until(lambda: len(in_.inputs) == 3)
        for sock in socks:
            sock.close()
        wait_until(lambda: not in_.inputs)


def test_sender_that_is_busy_does_not_hold_its_successor_up(names: LocalNames) -> None:
    """The old connection waits for a reader; the new one takes its place all the same."""
    with Port("/in", names=names) as in_:
        first = socket.create_connection(("127.0.0.1", in_.contact.port))
        first.sendall(b"CONNECT /same\r\nD\r\n1\r\n")
        wait_until(lambda: in_.waiting == 1)
        started = time.monotonic()
        second = socket.create_connection(("127.0.0.1", in_.contact.port))
        second.sendall(b"CONNECT /same\r\nD\r\n2\r\n")
        assert in_.read(timeout=5).value == [1]
        assert in_.read(timeout=5).value == [2]
        assert time.monotonic() - started < 4
        for sock in (first, second):
            sock.close()


# ---------------------------------------------------------------------------------- keys


@pytest.fixture
def key(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A configuration directory with a key in it."""
    monkeypatch.setenv("YARP_CONFIG_HOME", str(tmp_path))
    (tmp_path / "auth.conf").write_text("[AUTH]\nkey secret word\n")
    return tmp_path


def test_ports_and_tools_with_the_same_key_find_each_other(key: Path) -> None:
    with NameServer(), Port("/in") as in_, Port("/out") as out:
        out.connect("/in")
        out.write([1])
        assert in_.read(timeout=5).value == [1]
        assert network.exists("/in")
        assert network.is_connected("/out", "/in")
        assert network.ping("/in")[0].startswith("This is /in at ")
        assert network.disconnect("/out", "/in")


def test_who_does_not_know_the_key_stays_out(
    key: Path, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    other = tmp_path / "other"
    other.mkdir()
    code = """
import sys, yarpy
names = yarpy.LocalNames()
with yarpy.Port("", names=names) as port:
    try:
        port.connect(sys.argv[1])
    except yarpy.YarpError as error:
        print(type(error).__name__, error)
"""
    names = LocalNames()
    with Port("/in", names=names) as in_:
        for word in ("[AUTH]\nkey another\n", None):
            if word:
                (other / "auth.conf").write_text(word)
            else:
                (other / "auth.conf").unlink()
            done = subprocess.run(
                [sys.executable, "-c", code, f"/127.0.0.1:{in_.contact.port}"],
                capture_output=True,
                text=True,
                timeout=20,
                env={**os.environ, "YARP_CONFIG_HOME": str(other)},
            )
            assert "auth.conf" in done.stdout, done.stdout + done.stderr
        wait_until(lambda: "refused" in caplog.text)
        assert in_.inputs == []


def test_person_cannot_get_in_either(key: Path) -> None:
    with (
        Port("/in", names=LocalNames()) as in_,
        socket.create_connection(("127.0.0.1", in_.contact.port)) as sock,
    ):
        sock.settimeout(5)
        sock.sendall(b"CONNECT me and some more words to fill the forty bytes\r\n")
        assert len(sock.recv(40)) == 40  # the port speaks first
        assert sock.recv(40) == b""


# ---------------------------------------------------------------------------------- groups


def test_multicast_connections_share_a_group_and_one_sends(names: LocalNames) -> None:
    with (
        Port("/out", names=names) as out,
        Port("/a", names=names) as first,
        Port("/b", names=names) as second,
    ):
        out.connect("/a", "mcast")
        out.connect("/b", "mcast")
        # Nothing in the protocol tells the sender when a receiver has joined.
        assert first.wait_for_inputs(timeout=5)
        assert second.wait_for_inputs(timeout=5)
        assert [link.active for link in out._hub.outputs] == [True, False]
        assert out.write([1]) == 1
        assert first.read(timeout=5).value == second.read(timeout=5).value == [1]
        out.disconnect("/a")  # another one is elected
        assert out.write([2]) == 1
        assert second.read(timeout=5).value == [2]
        wait_until(lambda: not first.inputs)


def test_group_comes_from_the_name_server_and_goes_back() -> None:
    with NameServer() as server, Port("/in") as in_:
        with Port("/out") as out:
            out.connect("/in", "mcast")
            owned = server.client.get("/out", "owns")
            assert len(owned) == 1
            contact = server.client.query(owned[0])
            assert contact is not None
            assert contact.carrier == "mcast"
            assert contact.host.startswith("224.")
            assert in_.wait_for_inputs(timeout=5)
            out.write([1])
            assert in_.read(timeout=5).value == [1]
        assert server.client.query(owned[0]) is None


# ---------------------------------------------------------------------------------- strangers


def test_garbage_first_then_a_good_connection(
    names: LocalNames, caplog: pytest.LogCaptureFixture
) -> None:
    with Port("/in", names=names) as in_:
        with socket.create_connection(("127.0.0.1", in_.contact.port)) as sock:
            sock.sendall(b"what is this?\r\n")
            with sock.makefile("rb") as lines:
                assert lines.readline() == b"* Error. Protocol not found.\r\n"
        with socket.create_connection(("127.0.0.1", in_.contact.port)) as sock:
            sock.sendall(b"CONNECT test\r\nd\r\nhello 1\r\n")
            assert in_.read(timeout=5).value == ["hello", 1]
        wait_until(lambda: "refused" in caplog.text)
    (line,) = [r for r in caplog.records if r.levelno >= logging.WARNING]
    assert "refused" in line.getMessage()
    assert "127.0.0.1:" in line.getMessage()


def test_unknown_carrier_code(names: LocalNames) -> None:
    with (
        Port("/in", names=names) as in_,
        socket.create_connection(("127.0.0.1", in_.contact.port)) as sock,
    ):
        sock.settimeout(5)
        sock.sendall(framing.number(framing.BASE + 5))
        assert sock.recv(28) == b"* Error. Protocol not found."
        assert in_.inputs == []


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
        in_.read(timeout=5)
        stats = in_.stats
        assert stats["name"] == "/in"
        assert stats["inputs"][0]["source"] == "/out"
        assert stats["inputs"][0]["messages"] == 1
        assert stats["outputs"] == []
        assert stats["waiting"] == 0
        assert out.stats["outputs"][0]["target"] == "/in"


def test_port_opens_though_one_of_several_name_services_is_away() -> None:
    first = LocalNames()
    names = SeveralNames([first, YarpNameClient("127.0.0.1", free_port())])
    with Port("/here", names=names) as port:
        assert first.query("/here") == port.contact
    assert first.query("/here") is None


class Dying(LocalNames):
    """A name service that fails at one of its calls, after it has done what it should."""

    def __init__(self, call: str) -> None:
        super().__init__()
        self.call = call
        self.while_registering = lambda number: None  # what happens before we know that we are in

    def register(
        self,
        name: str,
        carrier: str | None = None,
        host: str | None = None,
        port: int | None = None,
        type_: str | None = None,
    ) -> Contact:
        contact = super().register(name, carrier, host, port, type_)
        self.while_registering(contact.port)
        self._die("register")
        return contact

    def set(self, name: str, key: str, *values: str | int | float) -> list[str]:
        self._die("set")
        return super().set(name, key, *values)

    def _die(self, call: str) -> None:
        if call == self.call:
            raise NoNameServer("it died")


@pytest.mark.parametrize("call", ["register", "set"])
def test_port_that_cannot_be_opened_leaves_nothing_behind(call: str) -> None:
    names = Dying(call)
    for _ in range(2):
        with pytest.raises(NoNameServer):
            Port("/here", names=names)  # not: the name is in use
    assert [thread for thread in threading.enumerate() if thread.name == "yarpy /here"] == []
    if call == "set":
        assert names.query("/here") is None


def test_port_can_be_asked_before_it_knows_that_it_is_registered(
    caplog: pytest.LogCaptureFixture,
) -> None:
    names = Dying("")
    asking: list[threading.Thread] = []
    found: list[bool] = []

    def ask(number: int) -> None:
        contact = Contact("tcp", "/here", "127.0.0.1", number)
        thread = threading.Thread(target=lambda: found.append(is_alive(contact)))
        thread.start()
        asking.append(thread)
        time.sleep(0.05)  # while the service thinks

    names.while_registering = ask
    with Port("/here", names=names):
        asking[0].join(10)
        assert found == [True]
    assert "defect" not in caplog.text


@pytest.mark.parametrize("number", [-1, 65536])
def test_number_that_no_port_can_have(number: int, names: LocalNames) -> None:
    with pytest.raises(AddressError, match="below 65536"):
        Port("/here", names=names, port=number)


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
    port.resume()
    with pytest.raises(PortClosed):
        port.read(timeout=5)
