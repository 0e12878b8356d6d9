"""ByteDriver: moves bytes between a stream and a transport that carries bytes.

Rules: one call into the system where one is enough. Waking a sleeping thread takes some 30 us: when
the last wait was about that short, the driver polls for the next bytes for a while before it
sleeps. Polling in vain makes it poll less often, unless it had paid for that before: questions that
come a hundred at a time are answered awake, whatever happened between them.

What a call into the system returns is taken from a `map` by a `for` into an attribute: that is one
step for Python, which looks for signals only behind calls. (Compiled, other ways of unpacking hide
what the call raises.) So an exception out of a signal handler finds
bytes either not moved or noted.

Deadlines are waited for by poll: a receive timeout of the kernel (SO_RCVTIMEO) begins anew behind
each signal, so that a program with a timer would wait for ever.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from itertools import repeat
from typing import Final

from yarpy.link.cores import cores
from yarpy.link.driver import Driver, is_foreign, link_error
from yarpy.link.ending import NOW
from yarpy.transports.base import Transport
from yarpy.transports.socket_transport import MSG_DONTWAIT, SocketTransport
from yarpy.wire.aside_stream import AsideStream
from yarpy.wire.frame_stream import FrameStream
from yarpy.wire.stream import BUFFER_SIZE, Buffer, ByteStream

SOON: Final = 200e-6
LOOKING: Final = 120e-6
FIRST_PENALTY: Final = 32
LAST_PENALTY: Final = 512
PAYING: Final = 8  # polls that found bytes save what one in vain costs
# Of so many pieces, with so many bytes together, one is made before they are sent.
FEW: Final = 8
LITTLE: Final = 1 << 11
NONE: Final = -1
_WHOLE: Final = repeat(0)  # arguments of the system's calls, for ever
_NO_WAITING: Final = repeat(MSG_DONTWAIT)


class ByteDriver(Driver):
    """A transport of bytes and the stream in front of it."""

    def __init__(self, transport: Transport, stream: ByteStream) -> None:
        super().__init__(transport, stream)
        self._beside = stream if isinstance(stream, AsideStream) else None
        kind = type(stream)
        self._plain = (  # its calls may be spelled out
            kind.get_buffer is ByteStream.get_buffer
            and kind.buffer_updated is ByteStream.buffer_updated
        )
        if isinstance(stream, FrameStream):
            self.whole = False  # what is inside the frames is found in many steps
        system = transport if isinstance(transport, SocketTransport) else None
        self._recv = None if system is None else system.recv_call
        self._send = system.send_call if system is not None and MSG_DONTWAIT else None
        self._arms = self._recv is None or not MSG_DONTWAIT
        # Whether polling may beat sleeping.
        self.eager = cores() > 1 and transport.eager
        self._looks = False  # poll for the next bytes instead of sleeping
        self._skip = 0  # waits to pass before polling is tried again
        self._penalty = FIRST_PENALTY
        self._paid = 0  # polls that found bytes since the last one in vain
        self._aimed: memoryview | None = None  # a buffer, and what takes bytes into it
        self._tries: Iterator[int] = iter(())
        self._came = NONE  # bytes that the system has put into the stream's buffer; 0: the end
        self._taken = 0  # bytes of the output that the system has taken

    # -- sending ----------------------------------------------------------------------------------

    def push(self) -> bool:
        if self._taken:
            self._account()
        output = self.stream.output
        if not output:
            return True
        if self._send is None:
            return False
        if len(output) > 1:
            if len(output) > FEW or sum(map(len, output)) > LITTLE:
                return False
            output[:] = (b"".join(output),)
        size = len(output[0])
        send = self._send
        try:
            for self._taken in map(send, output, _NO_WAITING):
                pass
        except BlockingIOError:
            return False
        except OSError as error:
            if is_foreign(error):
                raise
            self.transport.failed(error)
            raise link_error(error) from error
        if self._taken == size:  # as `_account`, spelled out
            self.bytes_out += size
            del output[0]
            self._taken = 0
            if self._beside is not None:
                self._pass_by()
        else:
            self._account()
        return not self.stream.output

    def _account(self) -> None:
        """Take what `push` has sent from the stream. From the first assignment to the end, Python
        looks for no signals."""
        output, sent = self.stream.output, self._taken
        rest = [memoryview(output[0])[sent:]] if sent < len(output[0]) else []
        output[:1] = rest
        self.bytes_out += sent
        self._taken = 0

    def _pass_by(self) -> None:
        """Count what lies aside: the words that tell of it have left, or leave."""
        beside = self._beside
        assert beside is not None
        self.bytes_out += beside.aside
        self.aside += beside.aside
        beside.aside = 0

    def send(self, until: float | None = None) -> bool:
        stream = self.stream
        output = stream.output
        if not output:
            return True
        stream.output = []
        try:
            left = self.transport.try_send(output)
            if left and until != NOW:
                left = self._send_rest(left, until)
        except OSError as error:
            if is_foreign(error):
                raise
            self.transport.failed(error)
            raise link_error(error) from error
        for piece in output:
            self.bytes_out += len(piece)
        for piece in left:
            self.bytes_out -= len(piece)
        if self._beside is not None:
            self._pass_by()
        if left:
            stream.put_back(left)
            return False
        return True

    def _send_rest(self, left: list[Buffer], until: float | None) -> list[Buffer]:
        """Send buffers as the peer takes them; return what could not be sent by then."""
        transport = self.transport
        while left and (wait := self.ending.slice(until)):
            if transport.wait_writable(wait):
                left = transport.try_send(left)
        return left

    # -- receiving --------------------------------------------------------------------------------

    def fill(self, deadline: float | None = None) -> None:
        stream, plain = self.stream, self._plain
        try:
            if self._came >= 0:
                pass
            elif deadline is not None and not (
                self._limit(deadline) if self._arms else time.monotonic() < deadline
            ):
                raise BlockingIOError
            else:
                # `get_buffer` for nearly every message, spelled out, as is `buffer_updated` below.
                if plain and stream.head == stream.tail and stream.mark < 0 and stream.big is None:
                    stream.head = stream.tail = 0
                    buffer = stream.view
                else:
                    buffer = stream.get_buffer()
                if not (self._looks and (self._try(buffer) or self._look(buffer))):
                    receive = self._recv or self.transport.recv_into
                    if deadline is not None and not self._arms:
                        self._await(buffer, deadline)
                    elif self._skip:
                        self._skip -= 1
                        for self._came in map(receive, (buffer,)):  # the kernel wakes us
                            pass
                    else:
                        started = time.perf_counter()
                        for self._came in map(receive, (buffer,)):
                            pass
                        # If the wait was short, polling would have been faster.
                        if self.eager and time.perf_counter() - started < SOON:
                            self._looks = True
        except OSError as error:
            if self._waits_on(error, deadline):
                self.fill(deadline)
                return
            self._came = 0  # the stream reports a message that was cut off
        count = self._came
        if count < 0:
            return  # a signal handler that closed the port has landed it
        # From here, or inside of `buffer_updated`, to the end Python looks for no signals.
        if count and plain and stream.big is None:
            stream.tail += count
            self.bytes_in += count
        elif count:
            stream.buffer_updated(count)
            self.bytes_in += count
        else:
            stream.feed_eof()
        self._came = NONE

    def _await(self, buffer: memoryview, deadline: float) -> None:
        """Wait until bytes come, or the end, and take them. Raises BlockingIOError when it is too
        late for that."""
        started = time.perf_counter()
        while True:
            left = deadline - time.monotonic()
            if self.transport.wait_readable(max(0.0, left)) and self._try(buffer):
                break
            if left <= 0.0:
                raise BlockingIOError
        if self._skip:
            self._skip -= 1
        elif self.eager and time.perf_counter() - started < SOON:
            self._looks = True

    def try_fill(self) -> bool:
        try:
            if self._came < 0 and not self._try(self.stream.get_buffer()):
                return False
        except OSError as error:
            if is_foreign(error):
                raise
            self.transport.failed(error)
            self._came = 0
        self._land()
        return True

    def _land(self) -> None:
        """Count what has come into the stream's buffer, as `fill` does."""
        count = self._came
        if count < 0:
            return
        if count:
            self.stream.buffer_updated(count)
            self.bytes_in += count
        else:
            self.stream.feed_eof()
        self._came = NONE

    def _try(self, buffer: memoryview) -> bool:
        """Take bytes that are there already, or the end; return whether there was either."""
        receive = self._recv
        if receive is not None and MSG_DONTWAIT:
            tries = self._tries if buffer is self._aimed else self._aim(receive, buffer)
            try:
                for self._came in tries:
                    break
            except BlockingIOError:
                return False
            return True
        receive = self.transport.try_recv_into
        for self._came in map(receive, (buffer,)):
            pass
        return self._came >= 0

    def _aim(self, receive: Callable[..., int], buffer: memoryview) -> Iterator[int]:
        """Return what takes bytes that are there into this buffer, each time that the next number
        is asked for. That of a stream's first buffer is kept: making it takes a while."""
        tries = map(receive, repeat(buffer), _WHOLE, _NO_WAITING)
        if self._plain and len(buffer) == BUFFER_SIZE:
            self._tries, self._aimed = tries, buffer
        return tries

    def _look(self, buffer: memoryview) -> bool:
        """Poll until bytes come; return False when that takes longer than going to sleep would."""
        until = time.perf_counter() + LOOKING
        while True:
            for _ in range(8):
                if self._try(buffer):
                    self._paid += 1
                    return True
            if time.perf_counter() > until:
                break
        self._looks = False
        self._skip = FIRST_PENALTY if self._paid >= PAYING else self._penalty
        self._penalty = min(2 * self._skip, LAST_PENALTY)
        self._paid = 0
        return False
