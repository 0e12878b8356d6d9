"""Driver: pumps a protocol's generators against a transport.

Rules: the only place where bytes go from one to the other, and where foreign errors become ours.
One thread at a time uses a driver; the link decides which. No protocol is known here.
"""

from __future__ import annotations

import errno
import time
from collections.abc import Callable
from typing import Any, Final, TypeVar

from yarpy.contact import host_zid
from yarpy.errors import LinkClosed, LocalProtocolError, RemoteProtocolError, Timeout, YarpError
from yarpy.link.admission import Admission
from yarpy.link.cores import cores
from yarpy.link.intake import Intake
from yarpy.transports.base import ObjectTransport, Transport
from yarpy.transports.datagram import open_mcast, open_udp
from yarpy.transports.inproc import open_inproc
from yarpy.transports.tcp import CONNECT_TIMEOUT, dial
from yarpy.transports.unix import open_unix
from yarpy.wire.effects import HEAR, Claim, Group, May, Open, Switch, Within
from yarpy.wire.framing import REFUSED, refused
from yarpy.wire.steps import Steps
from yarpy.wire.stream import DEFAULT_LIMIT, Buffer, ByteStream, ObjectStream

T = TypeVar("T")

# Waking a sleeping thread takes some 30 us. When the last wait was about that short, the driver
# polls for the next bytes for a while before it sleeps; each time in vain makes it poll less often.
SOON: Final = 200e-6
LOOKING: Final = 120e-6
FIRST_PENALTY: Final = 32
LAST_PENALTY: Final = 512
# C++ hangs up before it comes to the meeting place of the two ends.
LATE: Final = 0.5  # seconds for it to come after that


class Driver:
    """A transport and the stream in front of it."""

    def __init__(
        self,
        transport: Transport,
        limit: int = DEFAULT_LIMIT,
        group: Callable[[str], tuple[str, int]] | None = None,
    ) -> None:
        self.transport = transport
        self._objects = transport if isinstance(transport, ObjectTransport) else None
        self.stream = ByteStream(limit) if self._objects is None else ObjectStream()
        self.stream.lend = getattr(transport, "lend", None)
        self.admission = Admission()  # what the peer may do with our port
        self.silence = ""  # why nobody can hear what our port writes: it never writes
        # Whether polling may beat sleeping.
        self.eager = cores() > 1 and getattr(transport, "eager", True)
        self._looks = False  # poll for the next bytes instead of sleeping
        self._skip = 0  # waits to pass before polling is tried again
        self._penalty = FIRST_PENALTY
        self.bytes_in = 0
        self.bytes_out = 0
        self.aside = (
            0  # of these bytes, what did not go through the transport; the window resets it
        )
        self._group = group

    def run(
        self, steps: Steps[T], deadline: float | None = None, intake: Intake | None = None
    ) -> T:
        """Run `steps` to its end, waiting for bytes as needed; what it wrote is sent.

        `deadline` is a time of `time.monotonic`. `intake`: they read a message, which must come
        along once it has begun. Raises Timeout, LinkClosed, or what the steps raise.
        """
        answer: Any = None
        before = self.bytes_in - self.stream.waiting
        try:
            while True:
                effect = steps.send(answer)
                if effect is None:
                    self.flush()
                    try:
                        if intake is not None and self.bytes_in > before:
                            intake.advance(self.bytes_in - before)
                            if deadline is None:
                                self.transport.limit_waiting(intake.silence, sends=False)
                        self.fill(deadline)
                    except Timeout as error:
                        if intake is not None and deadline is None:
                            intake.wait()
                        told = self.tell_late(steps, error)
                        if told is error:
                            raise
                        raise told from error
                    answer = None
                elif isinstance(effect, Within):
                    deadline = _sooner(deadline, effect.seconds)
                    answer = None
                else:
                    answer = self._perform(effect, deadline)
        except StopIteration as stop:
            self.flush()
            value: T = stop.value
            return value
        except LinkClosed as error:
            if intake is not None and intake.reason:
                raise RemoteProtocolError(intake.reason) from error
            raise
        finally:
            if deadline is not None:
                self.transport.limit_waiting(None)
            if intake is not None:
                if intake.since and deadline is None:
                    self.transport.limit_waiting(None, sends=False)
                intake.since = 0.0

    def tell_late(self, steps: Steps[Any], error: Timeout) -> YarpError:
        """Let a protocol that waits say goodbye to a peer that was too slow; the error that it ends
        with, nearly always `error` itself."""
        told: YarpError = error
        try:
            steps.throw(error)
        except StopIteration:
            pass
        except YarpError as other:
            told = other
        try:
            self.flush()
        except YarpError:
            pass  # nobody listens
        return told

    def flush(self, deadline: float | None = None) -> None:
        """Send what the protocol wrote.

        `deadline` is a time of `time.monotonic`; 0.0: no waiting. Raises Timeout when it has come:
        what is left by then stays in the stream, and leaves with the next flush.
        """
        stream = self.stream
        output = stream.output
        if not output:
            return
        stream.output = []
        left: list[Buffer] = []
        try:
            if deadline is None:
                self.transport.send(output)
            else:
                left = self.transport.try_send(output)
                if left and deadline:
                    left = self._send_until(left, deadline)
        except OSError as error:
            raise link_error(error) from error
        if self._objects is None:
            for piece in output:
                self.bytes_out += len(piece)
            for piece in left:
                self.bytes_out -= len(piece)
            if stream.aside:
                self.bytes_out += stream.aside
                self.aside += stream.aside
                stream.aside = 0
        else:
            for piece in output:
                self.bytes_out += getattr(piece, "size", 0)
        if left:
            stream.put_back(left)
            raise Timeout("the peer does not read what is sent")

    def _send_until(self, left: list[Buffer], deadline: float) -> list[Buffer]:
        """What of it could not be sent by then."""
        transport = self.transport
        while left and (wait := deadline - time.monotonic()) > 0:
            if not transport.wait_writable(wait):
                break
            left = transport.try_send(left)
        return left

    def fill(self, deadline: float | None = None) -> None:
        """Wait for more bytes, or the end, and put them into the stream."""
        try:
            if deadline is not None:
                left = deadline - time.monotonic()
                if left <= 0:
                    raise BlockingIOError
                self.transport.limit_waiting(left)
            if self._objects is not None:
                self._fill_objects(self._objects)
                return
            buffer = self.stream.get_buffer()
            count = self._look(buffer) if self._looks else -1
            if count < 0 and self._skip:
                self._skip -= 1
                count = self.transport.recv_into(buffer)
            elif count < 0:
                count = self._sleep(buffer)
        except OSError as error:
            if isinstance(error, YarpError):
                raise
            if isinstance(error, BlockingIOError | TimeoutError) or is_dead(error):
                raise link_error(error, "the peer is silent") from error
            count = 0  # a reset is an end: the stream reports a message that it cut off
        if count:
            self.stream.buffer_updated(count)
            self.bytes_in += count
        else:
            self.stream.feed_eof()

    def _sleep(self, buffer: memoryview) -> int:
        """Let the kernel wake us. If the wait was short, polling would have been faster."""
        started = time.perf_counter()
        count = self.transport.recv_into(buffer)
        if self.eager and time.perf_counter() - started < SOON:
            self._looks = True
        return count

    def _look(self, buffer: memoryview) -> int:
        """Poll until bytes come; -1 when that takes longer than going to sleep would."""
        look = self.transport.try_recv_into
        count = look(buffer)
        if count >= 0:
            return count  # which says nothing about whether it pays to poll
        until = time.perf_counter() + LOOKING
        while True:
            for _ in range(8):
                count = look(buffer)
                if count >= 0:
                    if self._penalty > FIRST_PENALTY:
                        self._penalty -= 1
                    return count
            if time.perf_counter() > until:
                break
        self._looks = False
        self._skip = self._penalty
        self._penalty = min(2 * self._penalty, LAST_PENALTY)
        return -1

    def try_fill(self) -> bool:
        """Take bytes that are there already; False if there are none."""
        if self._objects is not None:
            try:
                self._fill_objects(self._objects, wait=False)
            except BlockingIOError:
                return False
            return True
        try:
            count = self.transport.try_recv_into(self.stream.get_buffer())
        except OSError:
            count = 0
        if count < 0:
            return False
        if count:
            self.stream.buffer_updated(count)
            self.bytes_in += count
        else:
            self.stream.feed_eof()
        return True

    def _fill_objects(self, pipe: ObjectTransport, wait: bool = True) -> None:
        item = pipe.receive(wait)
        assert isinstance(self.stream, ObjectStream)
        if item is None:
            self.stream.feed_eof()
        else:
            self.stream.feed_object(item[0])
            self.bytes_in += getattr(item[0], "size", 0)

    def _watch(self) -> Callable[[], None]:
        """What to call while the two ends look for each other elsewhere. It raises
        RemoteProtocolError once the peer refuses over the connection on which they have met."""
        stream, hung_up = self.stream, 0.0

        def look() -> None:
            nonlocal hung_up
            if not hung_up and self.try_fill():
                if stream.waiting:
                    line = _first_line(stream)
                    error = RemoteProtocolError(f'the peer answers "{line[:80]}"')
                    raise refused(line.encode()) or error
                hung_up = time.monotonic()
            if hung_up and time.monotonic() - hung_up > LATE:
                raise RemoteProtocolError("the peer hung up; it does not take this carrier")

        return look

    def judge(self, effect: May | Claim) -> str | bool | None:
        """Answer what a protocol asks about its peer's rights."""
        if isinstance(effect, May):
            if effect.right == HEAR:
                return self.judge(May("read", effect.asking)) or self.silence
            if effect.asking:
                return "" if self.admission.allows(effect.right) else REFUSED
            return self.admission.refusal(effect.right)
        if not self.admission.takes_tokens:
            return None
        admission = self.admission.showing(effect.token)
        if admission is None:
            return False
        self.admission = admission
        return True

    def _perform(self, effect: object, deadline: float | None) -> Any:
        transport = self.transport
        if isinstance(effect, Switch):
            self.flush()
            handle = effect.handle
            try:
                handle.ready(self._watch())
            except BaseException:
                handle.close()
                raise
            transport.close()
            self.transport, self.stream = handle, effect.stream
            self.bytes_in = self.bytes_out = 0  # on this one
            self._objects = handle if isinstance(handle, ObjectTransport) else None
            return None
        if isinstance(effect, May | Claim):
            return self.judge(effect)
        if isinstance(effect, Group):
            if self._group is None:
                raise LocalProtocolError("this connection cannot choose a multicast group")
            return self._group(transport.local[0])
        if isinstance(effect, Open):
            local, remote = transport.local, transport.remote
            if host_zid(remote[0]):
                raise LocalProtocolError(
                    "the port is reached through Zenoh, which carries streams of bytes: take tcp"
                )
            host = getattr(transport, "host", None)  # of TLS
            if effect.kind == "tcp":
                left = CONNECT_TIMEOUT if deadline is None else deadline - time.monotonic()
                if host:
                    from yarpy.transports.tls import dial_tls

                    return dial_tls(host, remote[1], max(left, 0.001))
                return dial(*remote, max(left, 0.001))
            if host is not None and effect.kind in ("udp", "mcast"):
                raise LocalProtocolError("TLS protects no datagrams: take tls, or fast_tcp+tls")
            if effect.kind == "udp":
                return open_udp(effect.listen, local, remote, effect.port)
            if effect.kind == "mcast":
                return open_mcast(effect.listen, local, remote, effect.group, effect.port)
            if effect.kind == "unix":
                return open_unix(effect.listen, local, remote)
            if effect.kind == "memory":
                from yarpy.transports.memory import open_memory

                return open_memory(effect.listen, effect.port, effect.group)
            if effect.kind == "shmem":
                from yarpy.transports.shmem import open_shmem

                return open_shmem(effect.listen, local, remote, effect.port)
            if effect.kind in ("mpi", "bcast"):
                return _open_mpi(effect, transport)
            if effect.kind == "inproc":
                return open_inproc(effect.listen, local, remote)
        raise LocalProtocolError(f"{effect} is not something a connection can do")


def _open_mpi(effect: Open, transport: Transport) -> Any:
    if hasattr(transport, "host"):
        raise LocalProtocolError(f"TLS protects nothing that {effect.kind} sends: take tls")
    from yarpy.transports.mpi_bcast import open_mpi

    return open_mpi(effect.kind, effect.listen, getattr(transport, "sock", None), effect.group)


def _sooner(deadline: float | None, seconds: float | None) -> float | None:
    """The earlier of a deadline and one in so many seconds; None: there is no such."""
    own = None if seconds is None else time.monotonic() + seconds
    return own if deadline is None else deadline if own is None else min(deadline, own)


def _first_line(stream: ByteStream) -> str:
    """What a peer has said, for people."""
    start = bytes(stream.buffer[stream.head : stream.head + 1000])
    text = start.partition(b"\n")[0].decode("utf-8", "replace")
    return "".join(c for c in text if c.isprintable())


def is_dead(error: OSError) -> bool:
    """Whether the peer's host gives no answer any more (`transports/peer_timeout.py`)."""
    return error.errno in (errno.ETIMEDOUT, errno.EHOSTUNREACH, errno.ENETUNREACH)


def link_error(error: OSError, late: str = "the peer does not read what is sent") -> YarpError:
    """Our error for what the operating system says about a connection; `late`: when it says that
    the time is over."""
    if isinstance(error, YarpError):
        return error
    if is_dead(error):
        return LinkClosed(f"the peer's host does not answer any more ({error.strerror})")
    if isinstance(error, BlockingIOError | TimeoutError):
        return Timeout(late)
    return LinkClosed(f"the peer is gone ({error.strerror or error})")
