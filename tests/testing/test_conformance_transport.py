"""The suite for transports, on those of the core."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from support.system import NO_UNIX_SOCKETS

from yarpy import registry
from yarpy.testing import TransportConformance
from yarpy.transports.shared import sealed, sysv
from yarpy.transports.tcp import TcpTransport


@pytest.mark.skipif(bool(NO_UNIX_SOCKETS), reason=NO_UNIX_SOCKETS)
class TestUnix(TransportConformance):
    opener = registry.transports.load("unix")


class TestInproc(TransportConformance):
    opener = registry.transports.load("inproc")


@pytest.mark.skipif(not sealed.available(), reason="this system shares no sealed memory")
class TestMemory(TransportConformance):
    opener = registry.transports.load("memory")


@pytest.mark.skipif(not sysv.available(), reason="no memory of System V here")
class TestShmem(TransportConformance):
    opener = registry.transports.load("shmem")
    listens_first = True

    @pytest.fixture(autouse=True)
    def directory(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        """Where the mutexes lie."""
        monkeypatch.setenv("TMPDIR", str(tmp_path))


class TestTcp(TransportConformance):
    opener = registry.transports.load("tcp")

    @contextmanager
    def pair(self) -> Iterator[tuple[Any, Any]]:
        with socket.create_server(("127.0.0.1", 0)) as server:
            one = TcpTransport(socket.create_connection(server.getsockname(), self.timeout))
            other = TcpTransport(server.accept()[0])
        try:
            yield one, other
        finally:
            one.close()
            other.close()


class Mute(TcpTransport):
    """Sends nothing."""

    def send(self, buffers: Any) -> None:
        pass


def test_a_transport_that_is_wrong_is_caught() -> None:
    class Suite(TestTcp):
        timeout = 0.2

        @contextmanager
        def pair(self) -> Iterator[tuple[Any, Any]]:
            with super().pair() as (one, other):
                one.__class__ = Mute
                yield one, other

    with pytest.raises((AssertionError, BlockingIOError)):
        Suite().test_bytes_arrive_in_order()
