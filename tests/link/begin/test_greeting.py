"""Greetings: what a protocol asks for besides bytes, and the move to another transport."""

from __future__ import annotations

import socket
import threading
import time

import pytest
from support.port import free_port
from support.transport import ScriptTransport, scripted
from support.wait import HANG

from yarpy.errors import LocalProtocolError, RemoteProtocolError, Timeout
from yarpy.link.begin.greeting import Greeting, driver_of
from yarpy.link.byte_driver import ByteDriver
from yarpy.link.object_driver import ObjectDriver
from yarpy.transports.datagram import DatagramTransport
from yarpy.transports.inproc import InprocTransport
from yarpy.wire.effects import Group, May, Open, Switch
from yarpy.wire.lending_stream import LendingStream
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream, DatagramStream, ObjectStream


def test_each_transport_gets_its_driver() -> None:
    class Lender(ScriptTransport):
        lends = True

    of_bytes = driver_of(ScriptTransport(), limit=7)
    assert type(of_bytes) is ByteDriver and of_bytes.stream.limit == 7
    of_objects = driver_of(InprocTransport(("", 1), ("", 2)))
    assert type(of_objects) is ObjectDriver and type(of_objects.stream) is ObjectStream
    lender = driver_of(Lender(), limit=9)
    assert type(lender.stream) is LendingStream and lender.stream.limit == 9


def test_moving_to_another_place() -> None:
    """What was written goes out by the old way first; the old transport is closed."""
    driver, old = scripted(b"", open_ended=True)
    greeting = Greeting(driver)
    new = ScriptTransport([b"there"])
    fresh = ByteStream()

    def steps() -> Steps[bytes]:
        driver.stream.write(b"I move")
        yield Switch(new, fresh)
        return bytes((yield from fresh.read_exact(5)))

    assert greeting.run(steps()) == b"there"
    assert old.said == b"I move"
    assert old.closed
    assert greeting.driver.transport is new
    assert greeting.driver.stream is fresh


def test_udp_is_opened_on_request() -> None:
    driver, _ = scripted(open_ended=True)
    greeting = Greeting(driver)

    def steps() -> Steps[int]:
        handle = yield Open("udp", listen=True)
        yield Switch(handle, DatagramStream())
        return int(handle.port)

    number = greeting.run(steps())
    assert isinstance(greeting.driver.transport, DatagramTransport)
    assert 0 < number < 65536
    greeting.driver.transport.close()


def test_peer_is_dialled_once_more() -> None:
    """By somebody who wants to ask again, with what is left of the time."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        driver, old = scripted(open_ended=True)
        greeting = Greeting(driver)
        old.remote = listener.getsockname()

        def steps() -> Steps[bytes]:
            again = yield Open("tcp", listen=False)
            fresh = ByteStream()
            yield Switch(again, fresh)
            fresh.write(b"me again")
            return bytes((yield from fresh.read_exact(2)))

        def serve() -> None:
            sock, _ = listener.accept()
            assert sock.recv(8, socket.MSG_WAITALL) == b"me again"
            sock.sendall(b"ok")
            sock.close()

        thread = threading.Thread(target=serve, daemon=True)
        thread.start()
        assert greeting.run(steps(), time.monotonic() + 10) == b"ok"
        assert old.closed
        thread.join(HANG)
        greeting.driver.transport.close()


def test_peer_that_cannot_be_dialled_once_more() -> None:
    driver, transport = scripted(open_ended=True)
    greeting = Greeting(driver)
    transport.remote = ("127.0.0.1", free_port())

    def steps() -> Steps[None]:
        yield Open("tcp", listen=False)

    with pytest.raises(ConnectionRefusedError):
        greeting.run(steps(), time.monotonic() + 10)
    assert driver.transport is transport  # for whoever opened it to close


def test_group_is_asked_for() -> None:
    transport = ScriptTransport()

    def group() -> tuple[str, int]:
        return "224.1.1.3", 21604

    def steps() -> Steps[tuple[str, int]]:
        found: tuple[str, int] = yield Group()
        return found

    assert Greeting(driver_of(transport), group).run(steps()) == ("224.1.1.3", 21604)
    with pytest.raises(LocalProtocolError, match="multicast"):
        Greeting(driver_of(transport)).run(steps())


def test_what_cannot_be_done() -> None:
    driver, _ = scripted()
    greeting = Greeting(driver)

    def steps() -> Steps[None]:
        yield Open("carrier pigeon", listen=False)

    with pytest.raises(LocalProtocolError, match="pigeon"):
        greeting.run(steps())


def test_a_protocol_tells_its_peer_what_cannot_be_done() -> None:
    driver, transport = scripted()
    greeting = Greeting(driver)

    def steps() -> Steps[None]:
        try:
            yield Open("carrier pigeon", listen=False)
        except LocalProtocolError:
            driver.stream.write(b"no pigeons")
            raise RemoteProtocolError("asks for pigeons") from None

    with pytest.raises(RemoteProtocolError, match="pigeons"):
        greeting.run(steps())
    driver.flush()
    assert transport.said == b"no pigeons"


def test_a_protocol_that_does_without_it_goes_on() -> None:
    driver, _ = scripted()

    def steps() -> Steps[str]:
        try:
            yield Open("carrier pigeon", listen=False)
        except LocalProtocolError:
            return "on foot"
        return "by air"

    assert Greeting(driver).run(steps()) == "on foot"


def test_what_is_known_of_the_peer_goes_along() -> None:
    driver, _ = scripted(open_ended=True)
    driver.silence = "it never writes"
    admission = driver.admission
    greeting = Greeting(driver)

    def steps() -> Steps[object]:
        yield Switch(ScriptTransport(), ByteStream())
        return (yield May("hear"))

    assert greeting.run(steps()) == "it never writes"
    assert greeting.driver is not driver and greeting.driver.admission is admission


@pytest.mark.parametrize("answers", [True, False])
def test_a_protocol_hears_that_its_peer_is_too_slow(answers: bool) -> None:
    """It may say goodbye, and what it raises then is what counts."""
    driver, transport = scripted(open_ended=True)

    def steps() -> Steps[None]:
        try:
            yield None
        except Timeout:
            driver.stream.write(b"too late")
            if answers:
                raise RemoteProtocolError("it says nothing") from None

    with pytest.raises(RemoteProtocolError if answers else Timeout):
        Greeting(driver).run(steps(), time.monotonic() + 0.05)
    assert transport.said == b"too late"


def test_nobody_comes_to_the_other_place() -> None:
    driver, old = scripted(open_ended=True)
    new = ScriptTransport()

    def nobody(look: object) -> None:
        raise TimeoutError("nobody came")

    new.ready = nobody  # type: ignore[assignment]
    greeting = Greeting(driver)

    def steps() -> Steps[None]:
        yield Switch(new, ByteStream())

    with pytest.raises(TimeoutError):
        greeting.run(steps())
    assert new.closed and not old.closed and greeting.driver is driver


def test_a_peer_that_refuses_meanwhile_is_heard() -> None:
    driver, _ = scripted(b"* no room here\r\n", open_ended=True)
    new = ScriptTransport()

    def waits(look: object) -> None:
        assert callable(look)
        look()

    new.ready = waits  # type: ignore[assignment]

    def steps() -> Steps[None]:
        yield Switch(new, ByteStream())

    with pytest.raises(RemoteProtocolError, match="no room here"):
        Greeting(driver).run(steps())
