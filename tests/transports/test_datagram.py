"""UDP and multicast sockets: borders, wakers, and what the kernel lost."""

from __future__ import annotations

import contextlib
import socket
import sys
import threading

import pytest
from support.port import free_port
from support.wait import HANG, runs, wait_until

from yarpy.transports.datagram import DatagramTransport, open_mcast, open_udp
from yarpy.transports.pace import Pace

HOME = ("127.0.0.1", 0)


def receive(end: DatagramTransport) -> bytes:
    room = memoryview(bytearray(65536))
    return bytes(room[: end.recv_into(room)])


def pair() -> tuple[DatagramTransport, DatagramTransport]:
    listening = open_udp(True, HOME, HOME, 0)
    listening.limit_waiting(HANG)
    return open_udp(False, HOME, HOME, listening.port), listening


def test_each_send_is_a_datagram() -> None:
    near, far = pair()
    near.send([b"one", b"two" * 1000])
    near.send([b"three"])
    assert [receive(far) for _ in range(3)] == [b"one", b"two" * 1000, b"three"]
    near.close()
    far.close()


def test_sender_keeps_the_number_of_its_tcp_port() -> None:
    """The peer may have noted it; if it is taken any other does."""
    number = free_port()
    first = open_udp(False, ("127.0.0.1", number), HOME, 9)
    assert first.port == number
    second = open_udp(False, ("127.0.0.1", number), HOME, 9)
    assert second.port != number
    first.close()
    second.close()


def test_large_message_does_not_overrun_a_receiver_with_the_usual_buffer() -> None:
    """One that has read what came whenever the sender lets time pass for it."""
    near, far = pair()
    far.sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 212_992 // 2)  # Linux doubles it
    far.limit_waiting(HANG)
    got: list[int] = []
    sent = 0

    class Counting(Pace):
        def wait(self, size: int) -> None:
            nonlocal sent
            super().wait(size)
            sent += 1

    def read() -> None:
        room = memoryview(bytearray(65536))
        with contextlib.suppress(BlockingIOError):  # nothing more comes
            while len(got) < 30:
                got.append(far.recv_into(room))

    near._pace = Counting(sleep=lambda seconds: wait_until(lambda: len(got) == sent))
    reader = threading.Thread(target=read)
    reader.start()
    near.send([bytes(60_000)] * 30)
    reader.join()
    assert got == [60_000] * 30
    near.close()
    far.close()


def test_receiver_cannot_send() -> None:
    near, far = pair()
    with pytest.raises(OSError, match="only receives"):
        far.send([b"x"])
    assert not far.ended()
    near.close()
    far.close()


def test_sender_hears_that_nobody_listens_any_more() -> None:
    near, far = pair()
    near.send([b"x"])
    assert not near.ended()
    far.close()
    near.send([b"lost"])
    wait_until(near.ended)
    with pytest.raises(ConnectionRefusedError):
        wait_until(lambda: near.send([b"lost"]))
    near.close()


def test_empty_datagram_is_not_an_end() -> None:
    """Anybody can send one."""
    near, far = pair()
    near.send([b"", b"", b"after"])
    assert receive(far) == b"after"
    room = memoryview(bytearray(10))
    near.send([b""])
    assert far.try_recv_into(room) == -1
    near.close()
    far.close()


@pytest.mark.skipif(sys.platform != "linux", reason="127.0.0.2 is an address of this computer")
def test_what_another_computer_sends_is_nobodys() -> None:
    """Who may write was decided about the one that has greeted."""
    near, far = pair()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
        stranger.bind(("127.0.0.2", 0))
        for _ in range(3):
            stranger.sendto(b"forged", ("127.0.0.1", far.port))
        room = memoryview(bytearray(100))
        assert far.try_recv_into(room) == -1
        stranger.sendto(b"forged", ("127.0.0.1", far.port))
        near.send([b"true"])
        assert receive(far) == b"true"
        stranger.sendto(b"forged", ("127.0.0.1", far.port))
        near.send([b"last"])
        far.interrupt()
        assert receive(far) == b"last"
        assert receive(far) == b""
    near.close()
    far.close()


@pytest.mark.skipif(sys.platform != "linux", reason="127.0.0.2 is an address of this computer")
def test_what_another_computer_sends_to_a_group_is_nobodys() -> None:
    number = free_port()
    member = open_mcast(True, HOME, HOME, GROUP, number)
    stranger = open_mcast(False, ("127.0.0.2", 0), HOME, GROUP, number)
    sender = open_mcast(False, HOME, HOME, GROUP, number)
    for end, said in ((stranger, b"forged"), (sender, b"true"), (stranger, b"forged")):
        end.send([said])
    assert receive(member) == b"true"
    assert member.try_recv_into(memoryview(bytearray(100))) == -1
    for end in (member, stranger, sender):
        end.close()


def test_trying_does_not_wait() -> None:
    near, far = pair()
    room = memoryview(bytearray(10))
    assert far.try_recv_into(room) == -1
    near.send([b"abc"])
    wait_until(lambda: far.try_recv_into(room) == 3)
    near.close()
    far.close()


def woken(end: DatagramTransport) -> int:
    """What a receiver that waits returns when it is interrupted."""
    found: list[int] = []
    thread = threading.Thread(
        target=lambda: found.append(end.recv_into(memoryview(bytearray(10)))), daemon=True
    )
    thread.start()
    ident = thread.ident
    assert ident is not None
    wait_until(lambda: runs("DatagramTransport.recv_into", ident))
    end.interrupt()
    thread.join(HANG)
    assert found, "the receiver still waits"
    return found[0]


def test_interrupt_wakes_a_receiver() -> None:
    near, far = pair()
    far.limit_waiting(None)
    assert woken(far) == 0
    near.close()
    far.close()


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux counts them")
def test_what_the_kernel_drops_is_counted() -> None:
    near, far = pair()
    far.sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    for _ in range(200):
        near.send([b"x" * 500])
    room = memoryview(bytearray(1000))
    got = 0
    while far.try_recv_into(room) > 0:
        got += 1
    near.send([b"the next one tells"])
    far.recv_into(room)
    assert got < 200
    assert far.dropped == 200 - got
    near.close()
    far.close()


# ---------------------------------------------------------------------------------- multicast

GROUP = "224.1.200.7"


def test_group_reaches_every_member_and_the_port_stays_shared() -> None:
    number = free_port()
    members = [open_mcast(True, HOME, HOME, GROUP, number) for _ in range(2)]
    sender = open_mcast(False, HOME, HOME, GROUP, number)
    sender.send([b"to all"])
    for member in members:
        found: list[bytes] = []
        thread = threading.Thread(target=lambda m=member, f=found: f.append(receive(m)))
        thread.start()
        thread.join(HANG)
        assert found == [b"to all"]
    for end in (*members, sender):
        end.close()


def test_member_leaves_without_troubling_the_group() -> None:
    number = free_port()
    leaving, staying = (open_mcast(True, HOME, HOME, GROUP, number) for _ in range(2))
    assert woken(leaving) == 0
    room = memoryview(bytearray(10))
    assert staying.try_recv_into(room) == -1
    leaving.close()
    staying.close()


@pytest.mark.skipif(sys.platform == "win32", reason="no receiving without waiting on Windows")
def test_what_has_come_before_the_end_is_read() -> None:
    near, far = pair()
    near.send([b"one", b"two"])
    far.interrupt()
    assert [receive(far) for _ in range(3)] == [b"one", b"two", b""]
    near.close()
    far.close()


@pytest.mark.skipif(sys.platform == "win32", reason="no receiving without waiting on Windows")
def test_sender_who_goes_on_after_the_end_is_not_followed_for_ever() -> None:
    near, far = pair()
    far._woken = True  # as by an interrupt whose waker found no room
    got = 0
    while True:
        near.send([b"x" * 60_000])
        if not receive(far):
            break
        got += 1
    assert 0 < got < 200
    near.close()
    far.close()


def test_what_a_group_had_sent_before_the_end_is_counted() -> None:
    number = free_port()
    member = open_mcast(True, HOME, HOME, GROUP, number)
    sender = open_mcast(False, HOME, HOME, GROUP, number)
    sender.send([b"one", b"two"])
    member.interrupt()
    assert receive(member) == b""
    assert member.dropped == 2
    member.close()
    sender.close()
