"""The driver of bytes: what left and came, whoever interrupts."""

from __future__ import annotations

import socket
import threading
import time

import pytest
from support.build import replaces_a_method
from support.transport import ScriptTransport, scripted
from support.wait import HANG

from yarpy.errors import Timeout
from yarpy.link.begin.greeting import driver_of
from yarpy.link.byte_driver import FIRST_PENALTY, LAST_PENALTY, ByteDriver
from yarpy.transports.socket_transport import SocketTransport
from yarpy.wire.aside_stream import AsideStream
from yarpy.wire.stream import ByteStream


def test_flush_by_a_deadline_leaves_the_rest_for_the_next() -> None:
    near, far = socket.socketpair()
    driver = driver_of(SocketTransport(near))
    data = bytes(range(256)) * 20_000
    driver.stream.write(data)
    for deadline in (0.0, time.monotonic() + 0.05):
        with pytest.raises(Timeout):
            driver.flush(deadline)
    assert 0 < driver.bytes_out < len(data)
    assert driver.stream.pending
    driver.stream.write(b"the end")
    thread = threading.Thread(target=driver.flush, args=(time.monotonic() + 30,))
    thread.start()
    found = bytearray()
    while len(found) < len(data) + 7:
        found += far.recv(1 << 20)
    thread.join(HANG)
    assert bytes(found) == data + b"the end"
    assert driver.bytes_out == len(found)
    assert not driver.stream.pending
    near.close()
    far.close()


def test_what_a_signal_handler_has_landed_is_not_landed_again() -> None:
    """It closes the port, and looks for acknowledgements, over a frame that has just received."""
    driver, _ = scripted(b"xy", open_ended=True)
    assert driver.try_fill()
    driver._land()  # the frame beneath goes on
    assert (driver.bytes_in, driver.stream.waiting) == (2, 2)


def test_what_goes_another_way_is_counted_when_its_reference_leaves() -> None:
    stream = AsideStream()
    driver = ByteDriver(ScriptTransport(), stream)
    stream.write(b"look there")
    stream.aside += 1000
    assert not driver.push()
    assert driver.send()
    assert (driver.bytes_out, driver.aside, stream.aside) == (1010, 1000, 0)


@replaces_a_method
def test_who_is_asked_a_hundred_times_in_a_row_is_awake_also_after_long_silence(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    driver = ByteDriver(ScriptTransport(), ByteStream())
    there = False
    monkeypatch.setattr(driver, "_try", lambda buffer: there)
    buffer = driver.stream.get_buffer()
    for _ in range(6):  # nobody asks
        assert not driver._look(buffer)
    assert driver._skip == LAST_PENALTY
    there = True
    assert all(driver._look(buffer) for _ in range(100))
    there = False
    assert not driver._look(buffer)
    assert driver._skip == FIRST_PENALTY
    assert not driver._look(buffer)
    assert driver._skip == 2 * FIRST_PENALTY  # in vain again, and nothing has paid for it
