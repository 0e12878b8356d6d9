"""The driver of objects: they go as they are, and none is lost."""

from __future__ import annotations

import time
from collections.abc import Sequence

import pytest

from yarpy.errors import LinkClosed, Timeout
from yarpy.link.driver import SHORT
from yarpy.link.object_driver import ObjectDriver
from yarpy.transports.base import ObjectTransport
from yarpy.wire.stream import ObjectStream


class Table(ObjectTransport):
    """Objects on a table: what is to come lies there, and what was sent is put there."""

    def __init__(self, *coming: object) -> None:
        self.coming = list(coming)
        self.sent: list[object] = []
        self.waits: list[float | None] = []

    def receive(self, wait: bool = True) -> tuple[object] | None:
        if not self.coming:
            if wait and self.waits:
                time.sleep(self.waits[-1] or 0.0)
            raise BlockingIOError("nothing has come")
        item = self.coming.pop(0)
        if isinstance(item, OSError):
            raise item
        return None if item is None else (item,)

    def send(self, buffers: Sequence[object]) -> None:
        if self.coming and isinstance(self.coming[0], OSError):
            raise self.coming.pop(0)  # type: ignore[misc]
        self.sent += buffers

    def limit_waiting(self, seconds: float | None, sends: bool = True) -> None:
        self.waits.append(seconds)


class Sized:
    size = 40


def driver_on(*coming: object) -> tuple[ObjectDriver, Table]:
    table = Table(*coming)
    return ObjectDriver(table, ObjectStream()), table


def test_objects_go_as_they_are() -> None:
    driver, table = driver_on()
    item = Sized()
    assert driver.push() and driver.send()  # nothing to send
    driver.stream.output += [item, "plain"]  # type: ignore[list-item]
    assert not driver.push()
    assert driver.send()
    assert table.sent == [item, "plain"] and driver.bytes_out == 40
    assert driver.push()


def test_objects_come_as_they_are() -> None:
    item = Sized()
    driver, _ = driver_on(item, "plain")
    driver.fill()
    assert driver.try_fill() and not driver.try_fill()
    stream = driver.stream
    assert isinstance(stream, ObjectStream)
    assert stream.items == [item, "plain"] and driver.bytes_in == 40


def test_an_object_that_a_signal_cut_off_is_taken_next_time() -> None:
    driver, _ = driver_on("later")
    driver._item = ("first",)  # it has come, and an exception left it there
    stream = driver.stream
    assert isinstance(stream, ObjectStream)
    driver.fill()
    assert stream.items == ["first"]


@pytest.mark.parametrize("end", [None, ConnectionResetError(104, "reset")])
def test_end(end: object) -> None:
    driver, _ = driver_on(end)
    driver.fill()
    stream = driver.stream
    assert isinstance(stream, ObjectStream)
    with pytest.raises(LinkClosed):
        next(stream.read_object())


def test_silence_and_a_failing_send() -> None:
    driver, table = driver_on()
    with pytest.raises(Timeout):
        driver.fill(time.monotonic() + 0.05)
    assert table.waits
    with pytest.raises(Timeout):
        driver.fill(time.monotonic() - 1)
    table.coming.append(BrokenPipeError(32, "Broken pipe"))
    driver.stream.output += ["x"]  # type: ignore[list-item]
    with pytest.raises(LinkClosed):
        driver.send()


def test_a_wait_ends_at_its_deadline_and_not_before(monkeypatch: pytest.MonkeyPatch) -> None:
    """Long waits are made of two, since the system is late by a part of each."""
    now = [100.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])

    class Asleep(Table):
        def receive(self, wait: bool = True) -> tuple[object] | None:
            if wait:
                now[0] += self.waits[-1] or 0.0
            raise BlockingIOError("nothing has come")

    table = Asleep()
    with pytest.raises(Timeout):
        ObjectDriver(table, ObjectStream()).fill(100.0 + 2 * SHORT)
    assert table.waits[:2] == [1.75 * SHORT, 0.25 * SHORT] and now[0] == 100.0 + 2 * SHORT
