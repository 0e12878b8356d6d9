"""Inboxes: what is kept, who waits, and what goes."""

from __future__ import annotations

import asyncio
import threading
from typing import Any

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits.wrap import receive_queue as module
from yarpy.kits.wrap.middleware import Received
from yarpy.kits.wrap.receive_queue import ReceiveQueue, pump


def filled(keep: Any, count: int) -> ReceiveQueue:
    queue = ReceiveQueue(keep)
    for number in range(count):
        queue.put(Received(number))
    return queue


@pytest.mark.parametrize(("keep", "kept"), [("latest", [4]), (2, [3, 4]), ("all", [0, 1, 2, 3, 4])])
def test_what_is_kept(keep: Any, kept: list[int]) -> None:
    queue = filled(keep, 5)
    assert [queue.take(0).value for _ in kept] == kept
    assert queue.drops == 5 - len(kept)
    assert queue.poll() is None
    with pytest.raises(yarpy.Timeout, match="within 0 s"):
        queue.take(0)


def test_errors_take_their_turn() -> None:
    queue = ReceiveQueue("all")
    queue.put(yarpy.DecodeError("odd"))
    queue.put(Received(1))
    with pytest.raises(yarpy.DecodeError):
        queue.take(0)
    assert queue.take(0).value == 1


def test_sender_waits_for_room(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "FULL", 2)
    queue = filled("all", 2)
    thread = threading.Thread(target=queue.put, args=(Received(2),), daemon=True)
    thread.start()
    assert [queue.take(HANG).value for _ in range(3)] == [0, 1, 2]
    thread.join(HANG)


def test_closing_ends_waiting() -> None:
    queue = ReceiveQueue("latest")
    threading.Timer(0.05, queue.close).start()
    with pytest.raises(yarpy.PortClosed):
        queue.take(HANG)
    with pytest.raises(yarpy.PortClosed):
        queue.put(Received(1))


def test_event_loop_waits_too() -> None:
    queue = ReceiveQueue("latest")

    async def main() -> None:
        with pytest.raises(yarpy.Timeout):
            await queue.take_async(0.01)
        threading.Timer(0.02, queue.put, (Received("there"),)).start()
        assert (await queue.take_async(HANG)).value == "there"
        threading.Timer(0.02, queue.close).start()
        with pytest.raises(yarpy.PortClosed):
            await queue.take_async(HANG)

    asyncio.run(main())
    assert not queue._wakers


class Heard:
    stats: dict[str, Any] = {}

    def __init__(self, *items: Any) -> None:
        self._items = list(items)

    def listen(self, timeout: float | None) -> Received:
        if not self._items:
            raise yarpy.PortClosed("the end")
        item = self._items.pop(0)
        if isinstance(item, Exception):
            raise item
        return Received(item)

    def close(self) -> None:
        pass


def test_pump_brings_values_and_errors_until_the_end() -> None:
    queue = ReceiveQueue("all")
    thread = pump(Heard(1, yarpy.DecodeError("odd"), 2), queue, "test")
    assert queue.take(HANG).value == 1
    with pytest.raises(yarpy.DecodeError):
        queue.take(HANG)
    assert queue.take(HANG).value == 2
    thread.join(HANG)
    wait_until(lambda: not thread.is_alive())
