"""A look at what a port sends."""

from __future__ import annotations

import socket
import threading
import time

from support.wait import HANG, wait_until

import yarpy
from yarpy.contact import Contact
from yarpy.kits.doctor.peek import peek


def test_a_message_and_its_stamp() -> None:
    with yarpy.BufferedPort("/a", names=yarpy.LocalNames()) as port:
        over = threading.Event()

        def talk() -> None:
            while not over.wait(0.005):
                port.write(yarpy.Vector([1.0, 2.0]), yarpy.Stamp(3, 1e9))

        thread = threading.Thread(target=talk)
        thread.start()
        seen = peek(port.contact, 5)
        over.set()
        thread.join()
        assert (seen.kind, seen.stamp, seen.error) == ("Vector", yarpy.Stamp(3, 1e9), "")
        assert seen.size == 24
        assert abs(seen.time - time.time()) < 60
        wait_until(lambda: port.write([1]) is not None and not port.outputs)


def test_nothing_and_nobody() -> None:
    with yarpy.BufferedPort("/a", names=yarpy.LocalNames()) as port:
        assert peek(port.contact, 0.05).kind == ""
    assert "nobody answers" in peek(Contact("tcp", "/a", "127.0.0.1", 1), 0.5).error


def test_who_sends_nonsense_is_left() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:

        def answer() -> None:
            with server.accept()[0] as peer:
                peer.sendall(b"nonsense" * 100)
                peer.settimeout(5)
                while peer.recv(100):
                    pass

        thread = threading.Thread(target=answer)
        thread.start()
        seen = peek(Contact("tcp", "/a", "127.0.0.1", server.getsockname()[1]), 0.2)
        assert seen.kind == ""
        thread.join(HANG)
