"""Inboxes: what is kept, who waits, and what goes."""

from __future__ import annotations

import asyncio
import threading
from typing import Any

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits.wrap import inbox as module
from yarpy.kits.wrap.inbox import Inbox, pump
from yarpy.kits.wrap.middleware import Received


def filled(keep: Any, count: int) -> Inbox:
    inbox = Inbox(keep)
    for number in range(count):
        inbox.put(Received(number))
    return inbox


@pytest.mark.parametrize(("keep", "kept"), [("latest", [4]), (2, [3, 4]), ("all", [0, 1, 2, 3, 4])])
def test_what_is_kept(keep: Any, kept: list[int]) -> None:
    inbox = filled(keep, 5)
    assert [inbox.take(0).value for _ in kept] == kept
    assert inbox.drops == 5 - len(kept)
    assert inbox.poll() is None
    with pytest.raises(yarpy.Timeout, match="within 0 s"):
        inbox.take(0)


def test_errors_take_their_turn() -> None:
    inbox = Inbox("all")
    inbox.put(yarpy.DecodeError("odd"))
    inbox.put(Received(1))
    with pytest.raises(yarpy.DecodeError):
        inbox.take(0)
    assert inbox.take(0).value == 1


def test_sender_waits_for_room(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "FULL", 2)
    inbox = filled("all", 2)
    thread = threading.Thread(target=inbox.put, args=(Received(2),), daemon=True)
    thread.start()
    assert [inbox.take(HANG).value for _ in range(3)] == [0, 1, 2]
    thread.join(HANG)


def test_closing_ends_waiting() -> None:
    inbox = Inbox("latest")
    threading.Timer(0.05, inbox.close).start()
    with pytest.raises(yarpy.PortClosed):
        inbox.take(HANG)
    with pytest.raises(yarpy.PortClosed):
        inbox.put(Received(1))


def test_event_loop_waits_too() -> None:
    inbox = Inbox("latest")

    async def main() -> None:
        with pytest.raises(yarpy.Timeout):
            await inbox.take_async(0.01)
        threading.Timer(0.02, inbox.put, (Received("there"),)).start()
        assert (await inbox.take_async(HANG)).value == "there"
        threading.Timer(0.02, inbox.close).start()
        with pytest.raises(yarpy.PortClosed):
            await inbox.take_async(HANG)

    asyncio.run(main())
    assert not inbox._wakers


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
    inbox = Inbox("all")
    thread = pump(Heard(1, yarpy.DecodeError("odd"), 2), inbox, "test")
    assert inbox.take(HANG).value == 1
    with pytest.raises(yarpy.DecodeError):
        inbox.take(HANG)
    assert inbox.take(HANG).value == 2
    thread.join(HANG)
    wait_until(lambda: not thread.is_alive())
