"""The two ends of a pipe in one session: what each hears, and how it is left."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from support.port import free_port

from yarpy.peers.zenoh.router import open_router
from yarpy.peers.zenoh.transport import close
from yarpy.peers.zenoh.tunnel.line import ZenohLine
from yarpy.peers.zenoh.tunnel.pipe import WAKE

pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[zenoh]"')


@pytest.fixture
def session() -> Iterator[Any]:
    opened = open_router([f"tcp/127.0.0.1:{free_port()}"])
    yield opened
    close(opened)


def test_what_each_end_hears(session: Any) -> None:
    told = session.declare_subscriber("@yarp/ctl/b/2")
    near, far = ZenohLine(session, "a/1", "b/2"), ZenohLine(session, "b/2", "a/1")
    near.put(b"data")
    assert far.recv() == b"data"
    assert far.try_recv() is None
    near.prefer("INTERACTIVE_LOW")
    near.put(b"urgent")
    assert far.recv() == b"urgent"
    near.tell(b"taken")
    assert told.recv().payload.to_bytes() == b"taken"
    near.wake()
    assert near.recv() == bytes([WAKE]), "who waits is woken"
    assert far.try_recv() is None, "and nobody else"
    far.close()
    near.close()


def test_it_says_that_it_is_left(session: Any) -> None:
    line, left = ZenohLine(session, "a/1", "b/2"), []
    line.left = lambda: left.append(True)
    line.close()
    line.close()
    assert left[0]
