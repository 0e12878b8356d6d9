"""Port numbers that are free, and stay apart."""

import socket

from support.port import free_block, free_port


def test_blocks_do_not_overlap() -> None:
    first, second = free_block(20), free_block(20)
    assert abs(first - second) >= 20


def test_port_can_be_bound_for_tcp_and_udp() -> None:
    number = free_port()
    for kind in (socket.SOCK_STREAM, socket.SOCK_DGRAM):
        with socket.socket(socket.AF_INET, kind) as bound:
            bound.bind(("127.0.0.1", number))
