"""A port that tells whoever reads it, also late, what was put into it.

test_log_forwarding.py has the log of a program.
"""

import threading
from functools import partial

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.link.send.outbound import Outbound
from yarpy.nameserver.local import LocalNames
from yarpy.port.assembly import open_hub
from yarpy.port.hub import Hub
from yarpy.port.keep import log_sender as module
from yarpy.port.keep.log_sender import LogSender
from yarpy.wire.message import Packet


def test_all_lines_come_in_order_and_the_end_waits_for_them() -> None:
    names = LocalNames()
    sender = LogSender(
        partial(open_hub, names=names), "/log", lambda lost: Packet(-lost), "/logger", 10_000
    )
    with yarpy.BufferedPort("/logger", strict=True, names=names) as logger:
        assert sender.ident is None
        sender.open()
        assert logger.wait_for_inputs(timeout=HANG)
        sender.put([Packet(number) for number in range(5000)])
        sender.close(HANG)
        assert [logger.read(HANG).value for _ in range(5000)] == [*range(5000)]
    assert names.query("/log") is None


def test_a_reader_that_is_behind_gets_what_came_meanwhile_and_is_told_what_is_missing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A program of which a thousand lines are kept lost all that came beyond in a burst."""
    monkeypatch.setattr(module, "AHEAD", 5000)
    names, waits, goes_on = LocalNames(), threading.Event(), threading.Event()
    sender = LogSender(
        partial(open_hub, names=names), "/log", lambda lost: Packet(-lost), "/logger", 10
    )
    send = sender._send

    def held_up(hub: Hub, link: Outbound, lines: list[Packet]) -> int:
        if lines:
            waits.set()
            assert goes_on.wait(HANG)
        return send(hub, link, lines)

    monkeypatch.setattr(sender, "_send", held_up)
    with yarpy.BufferedPort("/logger", strict=True, names=names) as logger:
        sender.open()
        wait_until(lambda: sender._wanted is not None)  # it knows who reads
        sender.put([Packet(1)])
        assert waits.wait(HANG)
        sender.put([Packet(number) for number in range(2, 4002)])
        sender.put([Packet(number) for number in range(4002, 6002)])  # 6000 wait: too many
        goes_on.set()
        sender.close(HANG)
        found = [logger.read(HANG).value for _ in range(5002)]
        assert found == [1, -1000, *range(1002, 6002)]
    assert [packet.value for packet in sender._lines] == [*range(5992, 6002)]


def test_where_nobody_reads_few_lines_are_kept_and_no_thread_is_woken() -> None:
    names = LocalNames()
    sender = LogSender(partial(open_hub, names=names), "/log", Packet, "", 10)
    sender.open()
    wait_until(lambda: sender._hub is not None and sender._news._lock.locked())  # it sleeps
    for number in range(100):
        sender.put([Packet(number)])
    assert sender._news._lock.locked() and len(sender._lines) == 10
    with yarpy.BufferedPort("/late", strict=True, names=names) as late:
        late.listen_to("/log", timeout=HANG)
        assert [late.read(HANG).value for _ in range(10)] == [*range(90, 100)]
    sender.close(HANG)


def test_nobody_has_to_be_there() -> None:
    names = LocalNames()
    sender = LogSender(partial(open_hub, names=names), "/log", Packet, "/nobody", 2)
    sender.put([Packet(1), Packet(2), Packet(3)])
    wait_until(lambda: names.query("/log"))
    sender.close()
    assert names.query("/log") is None
