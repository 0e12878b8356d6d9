"""What the system knows about a connection."""

from __future__ import annotations

import socket
import sys

import pytest
from support.wait import wait_until

from yarpy.transports.tcp_info import tcp_info


@pytest.mark.skipif(sys.platform != "linux", reason="Linux alone tells")
def test_bytes_are_counted_where_they_are() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        near = socket.create_connection(listener.getsockname())
        far, _ = listener.accept()
    with near, far:
        before = tcp_info(near)
        assert before is not None
        near.sendall(bytes(1000))
        wait_until(lambda: (tcp_info(near) or before).confirmed == before.confirmed + 1000)
        far.sendall(bytes(300))
        wait_until(lambda: (tcp_info(near) or before).came == 300)
        near.setblocking(False)
        with pytest.raises(BlockingIOError):
            while True:
                near.send(bytes(1 << 20))

        def stuck() -> bool:
            info = tcp_info(near)
            return info is not None and info.unsent > 0 and not info.on_the_way

        wait_until(stuck)


def test_nothing_is_known_of_other_sockets() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sock:
        assert tcp_info(sock) is None
