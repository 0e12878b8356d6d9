"""The contract of transports: what one that says nothing of itself answers."""

import pytest

from yarpy.transports.base import Answerable, ObjectTransport, Transport


class Kept(ObjectTransport):
    """Keeps what it is to send."""

    def __init__(self) -> None:
        self.sent: list[object] = []

    def send(self, buffers: object) -> None:
        self.sent.append(buffers)


def test_a_transport_that_says_nothing_can_do_nothing_special() -> None:
    transport = Transport()
    assert (transport.local, transport.remote, transport.port) == (("", 0), ("", 0), 0)
    assert (transport.peer_names, transport.secure, transport.lends) == ((), False, False)
    assert transport.borrow(1, 0) is None and transport.taken(1, 1) is None
    assert transport.wait_readable(0.0) and transport.wait_writable(0.0)
    assert not transport.limit_silence(1.0) and transport.tos() == 0
    transport.ready()
    transport.limit_unsent(1)
    transport.spare_slow_reader()
    transport.set_dscp(0x28)
    transport.failed(OSError())


def test_what_every_transport_must_do_itself_is_told() -> None:
    transport = Answerable()
    with pytest.raises(NotImplementedError):
        transport.recv_into(memoryview(bytearray(1)))
    with pytest.raises(NotImplementedError):
        transport.try_recv_into(memoryview(bytearray(1)))
    for call in (transport.ended, transport.interrupt, transport.close, transport.peek):
        with pytest.raises(NotImplementedError):
            call()
    for send in (transport.send, transport.try_send):
        with pytest.raises(NotImplementedError):
            send([b""])
    with pytest.raises(NotImplementedError):
        transport.limit_waiting(1.0)


def test_a_transport_of_objects_has_no_bytes() -> None:
    transport = Kept()
    with pytest.raises(TypeError, match="objects, not bytes"):
        transport.recv_into(memoryview(bytearray(1)))
    assert transport.try_recv_into(memoryview(bytearray(1))) == -1
    assert transport.try_send([b"a", b"b"]) == [] and transport.sent == [[b"a", b"b"]]
    assert transport.unread() == []
    with pytest.raises(NotImplementedError):
        transport.receive()
