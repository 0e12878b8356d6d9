"""Topics at a broker of ZeroMQ: a way in and a way out, in frames.

    frames:  topic, then what `wrap/value/payload.py` makes of a value; of a frame, its header and
             its buffers
    asked:   TOPIC?, reply topic, number, question; without a question only the way back is tried
    answer:  reply topic, number, answer

Rules: any thread may send. A way out learns from the broker who has subscribed. ZeroMQ subscribes
to prefixes; here a topic is the whole first frame. pyzmq is imported when it is needed.
"""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Sequence
from contextlib import suppress
from typing import Any, Final

from yarpy import fork
from yarpy.errors import (
    LinkClosed,
    LocalProtocolError,
    PortClosed,
    Timeout,
    UnknownName,
    UnknownPlugin,
)
from yarpy.kits.wrap.value.tree import Buffer
from yarpy.limit import ZMQ_MESSAGE

_LONGEST: Final = 0.1  # seconds until a socket that is being waited for can be closed
_FINDING: Final = 5.0  # seconds until a server is found, for calls without a timeout
_TRYING: Final = 0.05  # seconds from one try of the way back to the next

_contexts: dict[int, Any] = {}
_lock = fork.lock()  # of the contexts


def context() -> Any:
    """The context of this process: a forked one cannot use its parent's. Raises UnknownPlugin."""
    try:
        import zmq
    except ImportError as error:
        raise UnknownPlugin("zeromq needs pyzmq: pip install 'yarpy[zmq]'") from error
    with _lock:
        found = _contexts.get(os.getpid())
        if found is None:
            found = _contexts[os.getpid()] = zmq.Context()
        return found


class _Owned:
    """A socket that one thread at a time uses, as `with owned:`, and any may close. Where a signal
    handler does so above a frame that uses it, that frame closes it, at its end; none may use it
    there, in the middle of another one's frames."""

    def __init__(self, socket: Any, linger: int | None = None) -> None:
        self.closed = False
        self._socket = socket
        self._linger = linger
        self._lock = threading.RLock()
        self._used = False

    def __enter__(self) -> None:
        self._lock.acquire()
        if self.closed or self._used:
            closed = self.closed
            self._lock.release()
            if closed:
                raise PortClosed("this was closed")
            raise LocalProtocolError("this is being used by the frame beneath a signal handler")
        self._used = True

    def __exit__(self, *details: object) -> None:
        self._used = False
        if self.closed:
            self._socket.close(linger=self._linger)
        self._lock.release()

    def close(self) -> None:
        """Close it, or have it closed; more than once does no harm."""
        self.closed = True
        with self._lock:
            if not self._used:
                self._socket.close(linger=self._linger)


class Out:
    """Sends to a topic at the broker, `address` of its XSUB."""

    def __init__(self, topic: str, address: str) -> None:
        import zmq

        self.messages = 0
        self.joined = 0  # how often somebody has subscribed
        self._topic = topic.encode()
        self._socket = context().socket(zmq.XPUB)  # a PUB that tells who has subscribed
        self._socket.setsockopt(zmq.LINGER, 1000)
        self._socket.setsockopt(zmq.XPUB_VERBOSER, 1)
        self._socket.connect(address)
        self._wanted: set[bytes] = set()
        self._owned = _Owned(self._socket)

    def send(self, parts: Sequence[Buffer]) -> int:
        """Send frames; whether anybody has subscribed, as far as that is known. PortClosed."""
        with self._owned:
            self._hear()
            self._socket.send_multipart([self._topic, *parts], copy=False)
            self.messages += 1
            return int(self._heard)

    def wait(self, timeout: float | None) -> bool:
        """Wait until somebody has subscribed; False if time is over. Raises PortClosed."""
        deadline = None if timeout is None else time.monotonic() + timeout
        while True:
            with self._owned:
                self._hear()
                if self._heard:
                    return True
                left = _LONGEST if deadline is None else deadline - time.monotonic()
                if left <= 0:
                    return False
                self._socket.poll(1000 * min(left, _LONGEST))

    @property
    def heard(self) -> bool:
        """Return whether somebody has subscribed."""
        with suppress(PortClosed), self._owned:
            self._hear()
        return self._heard

    @property
    def _heard(self) -> bool:
        return any(self._topic.startswith(prefix) for prefix in self._wanted)

    def _hear(self) -> None:
        while self._socket.poll(0):
            data = self._socket.recv()
            if data[:1] == b"\1":
                self._wanted.add(data[1:])
                self.joined += 1
            elif data[:1] == b"\0":
                self._wanted.discard(data[1:])

    def close(self) -> None:
        self._owned.close()


class In:
    """Takes from a topic at the broker, `address` of its XPUB. With `newest`, the newest alone."""

    def __init__(self, topic: str, address: str, newest: bool = False, keep: int = 0) -> None:
        import zmq

        self.messages = self.drops = 0
        self.topic = topic
        self._newest = newest
        self._topic = topic.encode()
        self._socket = context().socket(zmq.SUB)
        self._socket.setsockopt(zmq.MAXMSGSIZE, ZMQ_MESSAGE)
        self._socket.setsockopt(zmq.RCVHWM, keep)
        self._socket.setsockopt(zmq.SUBSCRIBE, self._topic)
        self._socket.connect(address)
        self._owned = _Owned(self._socket, linger=0)

    def receive(self, timeout: float | None) -> list[bytes]:
        """The frames behind the topic. Raises Timeout, PortClosed."""
        deadline = None if timeout is None else time.monotonic() + timeout
        while True:
            with self._owned:
                left = _LONGEST if deadline is None else max(deadline - time.monotonic(), 0.0)
                found = self._take(min(left, _LONGEST))
                if found is not None:
                    return found
            if deadline is not None and time.monotonic() >= deadline:
                raise Timeout(f'nothing came from "{self.topic}" within {timeout:.3g} s')

    def _take(self, wait: float) -> list[bytes] | None:
        found: list[bytes] | None = None
        while self._socket.poll(0 if found is not None else 1000 * wait):
            frames = self._socket.recv_multipart()
            if frames[0] != self._topic:
                continue  # of a topic that begins alike
            self.messages += 1
            if found is not None:
                self.drops += 1
            found = frames[1:]
            if not self._newest:
                break
        return found

    def close(self) -> None:
        self._owned.close()


class Caller:
    """Asks whoever has subscribed to `TOPIC?`; the answer comes to a topic of the caller's own.

    A server's socket drops answers until it has heard who wants them, and a question must not be
    asked twice: so a new server is first asked for nothing, until such an answer comes.
    """

    def __init__(self, topic: str, sub_address: str, pub_address: str) -> None:
        self.topic = topic
        self._reply_to = f"{topic}!{os.urandom(8).hex()}"
        self._out = Out(f"{topic}?", sub_address)
        self._in = In(self._reply_to, pub_address)
        self._number = 0
        self._met = 0  # `joined` of the servers whose answers are known to come

    def ask(self, parts: Sequence[Buffer], timeout: float | None) -> list[bytes]:
        """The answer's frames. Raises UnknownName when nobody serves, Timeout, LinkClosed when the
        server goes away."""
        deadline = None if timeout is None else time.monotonic() + timeout
        if not self._out.wait(_FINDING if timeout is None else timeout):
            raise UnknownName(f'nobody serves "{self.topic}" at the broker')
        if self._met != (joined := self._out.joined):
            mark = self._mark()
            while self._exchange(mark, [], time.monotonic() + _TRYING) is None:
                if deadline is not None and time.monotonic() >= deadline:
                    raise self._late(timeout)
            self._met = joined
        answer = self._exchange(self._mark(), parts, deadline)
        if answer is None:
            raise self._late(timeout)
        return answer

    def _mark(self) -> bytes:
        self._number += 1
        return str(self._number).encode()

    def _exchange(
        self, mark: bytes, parts: Sequence[Buffer], deadline: float | None
    ) -> list[bytes] | None:
        """Return the answer; None when time is over."""
        self._out.send([self._reply_to.encode(), mark, *parts])
        while True:
            left = _LONGEST if deadline is None else deadline - time.monotonic()
            if left <= 0:
                return None
            try:
                answer = self._in.receive(min(left, _LONGEST))
            except Timeout:
                if not self._out.heard:
                    raise LinkClosed(f'"{self.topic}" went away during the call') from None
                continue
            if answer and answer[0] == mark:  # not the late answer to an earlier question
                return answer[1:]

    def _late(self, timeout: float | None) -> Timeout:
        return Timeout(f'"{self.topic}" did not answer within {timeout or 0:.3g} s')

    def close(self) -> None:
        self._out.close()
        self._in.close()


class Answerer:
    """Answers what comes to `TOPIC?`, in a thread of its own."""

    def __init__(self, topic: str, sub_address: str, pub_address: str, answer: Any) -> None:
        import zmq

        self._in = In(f"{topic}?", pub_address)
        self._answer = answer
        self._prefix = f"{topic}!".encode()
        # One socket for all callers; which of them have subscribed, the broker knows.
        self._socket = context().socket(zmq.PUB)
        self._socket.setsockopt(zmq.LINGER, 1000)
        self._socket.connect(sub_address)
        self._thread = threading.Thread(target=self._run, name=f"yarpy serve {topic}", daemon=True)
        self._thread.start()

    def _run(self) -> None:
        while True:
            try:
                frames = self._in.receive(None)
            except PortClosed:
                break
            if len(frames) < 2 or not frames[0].startswith(self._prefix):
                continue
            answer = self._answer(frames[2:]) if frames[2:] else ()
            self._socket.send_multipart([*frames[:2], *answer], copy=False)
        self._socket.close()

    def close(self) -> None:
        self._in.close()
        if self._thread is not threading.current_thread():
            self._thread.join(5.0)


def parse_place(place: str) -> tuple[str, int]:
    """Host and number of a broker: "host", "host:5555". Raises ValueError."""
    from yarpy.peers.zmq.broker import PORT

    host, _, number = place.partition(":")
    try:
        return host or "127.0.0.1", int(number or PORT)
    except ValueError:
        raise ValueError(f'"{place}" is no place of a broker: HOST, or HOST:PORT') from None
