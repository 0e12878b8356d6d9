"""The thread that waits for what comes over DDS."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from typing import Any

import pytest
from support.wait import HANG, wait_until

from yarpy.peers.ros2.dds.participant import POOL
from yarpy.peers.ros2.dds.pump import Pump


def test_what_comes_is_taken_and_defects_do_not_end_it(
    here: None, own: str, caplog: pytest.LogCaptureFixture
) -> None:
    from cyclonedds import pub, sub, topic

    from yarpy.peers.ros2.message.library import default_library

    part = POOL.take(0)
    kind = part.class_of(default_library().message("std_msgs/String"))
    made: Any = topic.Topic(part.dds, f"rt{own}", kind)
    reader: Any = sub.DataReader(part.dds, made)
    writer = pub.DataWriter(part.dds, made)
    pump = Pump(part.dds)
    came: list[int] = []
    wrong = threading.Event()

    def take() -> Callable[[], None] | None:
        found = reader.take(N=10)
        if wrong.is_set():
            wrong.clear()
            raise ValueError("of the test")
        return (lambda: came.append(len(found))) if found else None

    def write() -> None:
        sample = kind.__new__(kind)
        sample.body = bytes.fromhex("0001000002000000610000")
        writer.write(sample)

    pump.add(reader, take)
    try:
        write()
        wait_until(lambda: came)
        wrong.set()
        with caplog.at_level(logging.ERROR):
            write()
            wait_until(lambda: not wrong.is_set(), HANG)
        before = sum(came)
        write()
        wait_until(lambda: sum(came) > before)
        assert "is lost" in caplog.text
        pump.remove(reader)
        pump.remove(reader)
    finally:
        pump.close()
        pump.close()
        POOL.leave(part)
    assert pump._thread is not None and not pump._thread.is_alive()
