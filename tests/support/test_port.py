"""Port numbers that are free, and stay apart."""

import os
import socket
import sys

import pytest
from support.port import addresses, free_block, free_port


def test_blocks_do_not_overlap() -> None:
    first, second = free_block(20), free_block(20)
    assert abs(first - second) >= 20


def test_port_can_be_bound_for_tcp_and_udp() -> None:
    number = free_port()
    for kind in (socket.SOCK_STREAM, socket.SOCK_DGRAM):
        with socket.socket(socket.AF_INET, kind) as bound:
            bound.bind(("127.0.0.1", number))


@pytest.mark.skipif(sys.platform != "linux", reason="needs Linux' /proc")
def test_where_a_program_listens() -> None:
    with socket.create_server(("127.0.0.3", 0)), socket.socket(type=socket.SOCK_DGRAM) as datagrams:
        datagrams.bind(("127.0.0.4", 0))
        assert "127.0.0.3" in addresses(os.getpid(), "tcp")
        assert "127.0.0.4" in addresses(os.getpid(), "udp")
    assert "127.0.0.3" not in addresses(os.getpid(), "tcp")
