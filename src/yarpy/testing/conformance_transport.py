"""TransportConformance: what every transport must do, as tests to inherit.

    class TestMine(TransportConformance):
        opener = MyOpener

Rules: methods called `test_*` with plain asserts. Two ends meet through a TCP connection of this
computer, as those of a carrier that moves do; one that is dialled writes `pair` anew.
"""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from typing import Any, ClassVar

from yarpy.transports.base import ObjectTransport, Transport
from yarpy.transports.opener import MeetingPlace, Opener
from yarpy.transports.tcp import TcpTransport

SIZES = (1, 100, 4096, 65_536, 1_000_000)


class TransportConformance:
    """Subclass it and set `opener`.

    timeout: seconds for what must come. sizes: of what is sent, in bytes. listens_first: the end
    that was dialled opens first, and tells the other one its number; else it is the other way.
    """

    opener: ClassVar[type[Opener]]
    timeout: ClassVar[float] = 10.0
    sizes: ClassVar[tuple[int, ...]] = SIZES
    listens_first: ClassVar[bool] = False

    def pair(self) -> AbstractContextManager[tuple[Any, Any]]:
        """Return two ends that are connected; both are closed afterwards."""
        return _met(self.opener, self.timeout, self.listens_first)

    def test_has_every_member(self) -> None:
        with self.pair() as (one, other):
            assert isinstance(one, Transport) and isinstance(other, Transport)
            for end in (one, other):
                assert type(end).scheme, "a transport says its name in the registry"
                for name in ("local", "remote"):
                    host, port = getattr(end, name)
                    assert isinstance(host, str) and isinstance(port, int)

    def test_bytes_arrive_in_order(self) -> None:
        with self.pair() as (one, other):
            for size in self.sizes:
                data = bytes(index % 251 for index in range(size))
                _send(one, data)
                assert self._received(other, size) == data
                _send(other, data[:100])
                assert self._received(one, len(data[:100])) == data[:100]

    def test_says_when_there_is_nothing(self) -> None:
        with self.pair() as (one, other):
            if isinstance(other, ObjectTransport):
                _raises(BlockingIOError, lambda: other.receive(wait=False))
                return
            assert other.try_recv_into(memoryview(bytearray(10))) == -1
            assert not other.ended()
            one.send([b"x"])
            assert self._received(other, 1) == b"x"

    def test_waits_no_longer_than_it_is_told(self) -> None:
        with self.pair() as (_, other):
            other.limit_waiting(0.05)
            begun = time.monotonic()
            _raises(BlockingIOError, lambda: _receive(other))
            assert time.monotonic() - begun < self.timeout
            other.limit_waiting(None)

    def test_many_buffers_are_one_stream(self) -> None:
        with self.pair() as (one, other):
            if isinstance(one, ObjectTransport):
                return
            one.send([b"ab", b"", memoryview(b"cd"), bytearray(b"ef")])
            assert self._received(other, 6) == b"abcdef"

    def test_what_does_not_leave_is_given_back(self) -> None:
        with self.pair() as (one, other):
            if isinstance(one, ObjectTransport):
                return
            left: list[Any] = []
            piece, sent = bytes(65_536), 0
            while not left and sent < 1 << 28:
                left = one.try_send([piece])
                sent += len(piece) - sum(map(len, left))
            got = 0
            while got < sent:
                got += len(self._received(other, min(sent - got, 1 << 20)))
            assert one.wait_writable(self.timeout)

    def test_the_end_is_seen(self) -> None:
        with self.pair() as (one, other):
            one.interrupt()
            one.close()
            found = _until_the_end(other, self.timeout)
            assert found is True, found

    def test_interrupt_wakes_who_waits(self) -> None:
        with self.pair() as (_, other):
            woken = threading.Event()

            def wait() -> None:
                try:
                    _receive(other)
                except (OSError, TypeError):
                    pass
                woken.set()

            threading.Thread(target=wait, daemon=True).start()
            time.sleep(0.05)
            other.interrupt()
            assert woken.wait(self.timeout), "interrupt() leaves a thread waiting"

    def test_ends_twice_without_harm(self) -> None:
        with self.pair() as (one, other):
            for end in (one, other, one, other):
                end.interrupt()
                end.close()

    def _received(self, end: Any, size: int) -> bytes:
        end.limit_waiting(self.timeout)
        if isinstance(end, ObjectTransport):
            found = end.receive()
            return b"" if found is None else bytes(found[0])  # type: ignore[call-overload]
        data = bytearray(size)
        view = memoryview(data)
        while view:
            count = end.recv_into(view)
            assert count, "the end came too early"
            view = view[count:]
        return bytes(data)


def _send(end: Any, data: bytes) -> None:
    """Send from a thread of its own: more may be on its way than there is room for."""
    if isinstance(end, ObjectTransport):
        end.send([data])
    else:
        threading.Thread(target=end.send, args=([data],), daemon=True).start()


def _receive(end: Any) -> object:
    if isinstance(end, ObjectTransport):
        return end.receive()
    return end.recv_into(memoryview(bytearray(10)))


def _until_the_end(end: Any, timeout: float) -> object:
    end.limit_waiting(timeout)
    try:
        found = _receive(end)
    except BlockingIOError:
        return "the end is not told"
    except OSError:
        return True
    return True if not found else f"{found!r} came instead of the end"


@contextmanager
def _met(opener: type[Opener], timeout: float, listens_first: bool) -> Iterator[tuple[Any, Any]]:
    """Yield what two ends open that have greeted over TCP."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        dialled = TcpTransport(socket.create_connection(server.getsockname(), timeout))
        accepted = TcpTransport(server.accept()[0])
    ends: list[Any] = []
    try:
        number = 0
        for listen in (listens_first, not listens_first):
            through = accepted if listen else dialled
            end = opener.meet(MeetingPlace(through, listen, number, "/conformance", timeout))
            assert end is not None, "two programs of one computer do not meet"
            ends.append(end)
            number = end.port
        failed: list[BaseException] = []

        def ready(end: Any) -> None:
            try:
                end.ready()
            except BaseException as error:
                failed.append(error)

        threads = [threading.Thread(target=ready, args=(end,), daemon=True) for end in ends]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(timeout)
        assert not failed, repr(failed)
        yield ends[0], ends[1]
    finally:
        for end in (*ends, dialled, accepted):
            end.close()


def _raises(kind: type[Exception], call: Any) -> None:
    try:
        found = call()
    except kind:
        return
    raise AssertionError(f"{kind.__name__} was expected, and {found!r} came")
