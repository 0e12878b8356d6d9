"""A port's name and number: taken, refused, handed out, given back."""

from __future__ import annotations

import contextlib
import errno
import socket
import threading
import time

import pytest
from support.lasted import lasted
from support.port import free_port
from support.wait import HANG, wait_until

from yarpy import scope
from yarpy.contact import Contact
from yarpy.errors import AddressError, NoNameServer, Timeout
from yarpy.link.begin.accept_loop import LOOP, AcceptLoop
from yarpy.names.client import YarpNameClient
from yarpy.names.fallback_client import SeveralNames
from yarpy.nameserver.local import LocalNames
from yarpy.nameserver.server import NameServer
from yarpy.port.connect.probe import is_alive
from yarpy.port.keep import registration
from yarpy.port.port import Port


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


def test_name_in_use_is_refused_with_who_has_it(
    names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    with Port("/here", names=names) as port:
        with pytest.raises(AddressError, match='"/here" is in use by this program itself: close'):
            Port("/here", names=names)
        monkeypatch.setattr(registration, "LOOP", AcceptLoop())  # as another program sees it
        with pytest.raises(AddressError, match=f'"/here" is in use by a port at {port.address}'):
            Port("/here", names=names)
        monkeypatch.undo()
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


def test_name_of_a_program_that_is_busy_stays_its_own(
    names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The system takes the connection, the program is stopped: that is no death."""
    monkeypatch.setattr(registration, "BUSY", 0.3)
    with socket.create_server(("127.0.0.1", 0)) as stopped:
        known = names.register("/here", "tcp", "127.0.0.1", stopped.getsockname()[1])
        with pytest.raises(AddressError, match=r"does not answer just now.*unregister /here"):
            Port("/here", names=names)
        assert names.query("/here") == known


def test_chosen_number(names: LocalNames) -> None:
    number = free_port()
    with Port("/here", names=names, tcp_port=number) as port:
        assert port.contact.port == number
        with pytest.raises(AddressError, match=f"cannot listen on TCP port {number}"):
            Port("/there", names=names, tcp_port=number)
    assert names.query("/there") is None


def test_no_file_descriptor_is_left(monkeypatch: pytest.MonkeyPatch, names: LocalNames) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise OSError(errno.EMFILE, "Too many open files")

    monkeypatch.setattr("yarpy.link.begin.acceptor.TcpListener", refuse)
    with pytest.raises(AddressError, match=r"Too many open files\); this program.*ulimit -n"):
        Port("/here", names=names)
    assert names.query("/here") is None


def test_no_name_server(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_SERVER", f"127.0.0.1:{free_port()}")
    started = time.monotonic()
    with pytest.raises(NoNameServer):
        Port("/here")
    assert lasted(started) < 5


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
            assert port.read(timeout=HANG).value == [1]


def test_name_server_that_has_no_numbers_left() -> None:
    """The port says so and is not there; whoever has a number keeps it, or brings one."""
    with NameServer() as server, Port("/first") as first:
        server.service.store.numbers.last = server.service.store.numbers.counter
        with pytest.raises(AddressError, match=r'refused "/second": .*ran out of port numbers'):
            Port("/second")
        assert server.client.query("/second") is None
        with (
            Port("/third", tcp_port=free_port()) as third,
            Port("/first2", tcp_port=free_port()) as out,
        ):
            out.connect("/third")
            out.write([1])
            assert third.read(timeout=HANG).value == [1]
        assert server.client.query("/first") == first.contact


def test_name_that_went_to_somebody_else_is_not_given_back(names: LocalNames) -> None:
    port = Port("/here", names=names)
    names.register("/here", "tcp", "127.0.0.1", 9)
    port.close()
    known = names.query("/here")
    assert known is not None
    assert known.port == 9


def test_multicast_connections_share_a_group_and_one_sends(names: LocalNames) -> None:
    with (
        Port("/out", names=names) as out,
        Port("/a", names=names) as first,
        Port("/b", names=names) as second,
    ):
        out.connect("/a", "mcast")
        out.connect("/b", "mcast")
        # Nothing in the protocol tells the sender when a receiver has joined.
        assert first.wait_for_inputs(timeout=HANG)
        assert second.wait_for_inputs(timeout=HANG)
        assert [link.active for link in out._hub.outputs.links] == [True, False]
        assert out.write([1]) == 1
        assert first.read(timeout=HANG).value == second.read(timeout=HANG).value == [1]
        out.disconnect("/a")  # another one is elected
        assert out.write([2]) == 1
        assert second.read(timeout=HANG).value == [2]
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
            assert in_.wait_for_inputs(timeout=HANG)
            out.write([1])
            assert in_.read(timeout=HANG).value == [1]
        assert server.client.query(owned[0]) is None


def test_port_opens_though_one_of_several_name_services_is_away() -> None:
    first = LocalNames()
    names = SeveralNames([first, YarpNameClient("127.0.0.1", free_port())])
    with Port("/here", names=names) as port:
        assert first.query("/here") == port.contact
    assert first.query("/here") is None


@pytest.mark.parametrize("call", ["register", "set"])
def test_port_that_cannot_be_opened_leaves_nothing_behind(call: str) -> None:
    names = Dying(call)
    for _ in range(2):
        with pytest.raises(NoNameServer):
            Port("/here", names=names)  # not: the name is in use
    assert "/here" not in [one.name for one in LOOP.listening]
    if call == "set":
        assert names.query("/here") is None


class Cut(LocalNames):
    """A name service whose answer to `register` is cut by Ctrl-C."""

    def register(
        self,
        name: str,
        carrier: str | None = None,
        host: str | None = None,
        port: int | None = None,
        type_: str | None = None,
    ) -> Contact:
        super().register(name, carrier, host, port, type_)
        raise KeyboardInterrupt


def test_port_whose_registering_was_cut_leaves_no_name_behind() -> None:
    names = Cut()
    with pytest.raises(KeyboardInterrupt):
        Port("/here", names=names)
    assert names.query("/here") is None


class Late(LocalNames):
    """A name service that takes more time to hear what a port is than that has for opening."""

    def set(self, name: str, key: str, *values: str | int | float) -> list[str]:
        while scope.remaining():
            pass
        raise Timeout("the time is over")

    def unregister(self, name: str) -> None:
        scope.left()  # as what asks a server does
        super().unregister(name)


def test_port_whose_time_to_open_is_over_leaves_no_name_behind() -> None:
    names = Late()
    with pytest.raises(Timeout):
        Port("/here", names=names, timeout=0.05)
    assert names.query("/here") is None


class Busy(LocalNames):
    """A name service that has to be waited for."""

    def unregister(self, name: str) -> None:
        scope.left()
        super().unregister(name)


def test_port_that_had_no_time_left_to_close_gives_its_name_back(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("YARPY_LINGER", "0")
    names = Busy()
    Port("/here", names=names).close()
    assert names.query("/here") is None


@pytest.mark.parametrize("number", [-1, 65536])
def test_number_that_no_port_can_have(number: int, names: LocalNames) -> None:
    with pytest.raises(AddressError, match="below 65536"):
        Port("/here", names=names, tcp_port=number)


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
        asking[0].join(HANG)
        assert found == [True]
    assert "defect" not in caplog.text


def test_of_two_programs_that_take_a_name_at_the_same_moment_one_has_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Both have found it free."""
    both = threading.Barrier(2)
    refuse = registration.Registration._refuse_taken

    def found_free(self: registration.Registration, names: YarpNameClient) -> None:
        refuse(self, names)
        both.wait(HANG)

    monkeypatch.setattr(registration.Registration, "_refuse_taken", found_free)
    number = free_port()
    with NameServer(number), contextlib.closing(YarpNameClient("127.0.0.1", number)) as service:
        opened: list[Port] = []
        refused: list[str] = []

        def take() -> None:
            try:
                opened.append(Port("/same", names=service))
            except AddressError as error:
                refused.append(str(error))

        threads = [threading.Thread(target=take) for _ in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(HANG)
        [port] = opened
        assert "by another program at the same moment" in refused[0]
        known = service.query("/same")
        assert known is not None and known.port == port.contact.port
        port.close()
