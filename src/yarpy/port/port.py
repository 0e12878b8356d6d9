"""Port and BufferedPort: the things with a name that programs read from and write to.

Rules: opening registers, closing gives the name back; they are context managers and iterate over
what comes in. Everything is safe to call from any thread. What is read goes through a mailbox, the
reading policy; what is written goes straight to the links.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, Final, TypeVarTuple

from yarpy.contact import parse_contact
from yarpy.data.stamp import Stamp
from yarpy.errors import LinkClosed, PortClosed, Timeout, YarpError
from yarpy.link.outbound import Outbound, Rest
from yarpy.link.readiness import wait_for_any
from yarpy.names.base import NameClient
from yarpy.port import probe
from yarpy.port.assembly import open_hub
from yarpy.port.base import BasePort
from yarpy.port.connection import ConnectionEvent
from yarpy.port.hub import Hub
from yarpy.port.mailbox import Callback, Fifo, Latest, Mailbox, Rendezvous
from yarpy.port.reader import Reader
from yarpy.transports.lease import freeze
from yarpy.wire.message import CALL, Message, Packet
from yarpy.wire.stream import DEFAULT_LIMIT

if TYPE_CHECKING:
    from numpy.typing import DTypeLike, NDArray

Args = TypeVarTuple("Args")

# Seconds between two looks whether one of several slow readers takes something.
_SHORTEST: Final = 0.0002
_LONGEST: Final = 0.02


class MessagePort(BasePort):
    """A port that is read from and written to. Subclasses choose the mailbox of its hub."""

    def __init__(self, hub: Hub, spin: bool = False) -> None:
        super().__init__(hub)
        self._mailbox = hub.mailbox
        self._reader = Reader(hub, spin)

    def read(self, timeout: float | None = None) -> Message:
        """The next message, waiting for one if needed.

        Raises Timeout after `timeout` seconds, PortClosed if the port is closed or interrupted.
        """
        return self._reader.read(timeout)

    def poll(self) -> Message | None:
        """A message that is already there, or None."""
        return self._reader.poll()

    @property
    def waiting(self) -> int:
        """Messages that came and were not read yet."""
        return self._mailbox.waiting

    def __iter__(self) -> Iterator[Message]:
        """Messages until the port is closed or interrupted."""
        try:
            while True:
                yield self.read()
        except PortClosed:
            return

    def prepare(self, shape: int | tuple[int, ...], dtype: DTypeLike = "u1") -> NDArray[Any]:
        """A new numpy array of that shape and type, to be filled and written.

        It lies in memory that programs on this computer share, so nothing is copied for those that
        are connected by `memory`: not when it is written, nor when it is read. It may be written as
        it is, or as Image(array), Vector(array) ... What it holds at first is undefined. Writing it
        makes it read-only, since others look at it then; prepare another one for the next message.
        Its memory is used again once nobody holds the array or looks at the message.
        """
        self._check_open()
        return self._hub.preparing.array(self._hub.name, shape, dtype)

    def write(
        self,
        value: object,
        stamp: Stamp | str | None = None,
        *,
        wait: bool = False,
        timeout: float | None = None,
    ) -> int:
        """Send `value` to every connected port; returns how many connections took it.

        When it returns, the message is in the system's hands (in a burst: about to be, at the
        latest 0.2 ms later) and `value` may be changed, unless a connection is `local`: there the
        reader gets `value` itself. Up to 256 messages per connection may be on their way
        unacknowledged; beyond that a writer waits for its slowest reader, after the others have got
        the message. With `timeout` it waits that many seconds at most: for a connection over which
        the message has not begun to leave by then it is a drop. With `wait` it returns when every
        reader that acknowledges has taken this message, and counts those. Readers that dialled this
        port are waited for 10 s, then disconnected. `stamp` travels as the envelope. A connection
        that breaks is dropped, counted, and made again in the background.

        Raises PortClosed; TypeError, ValueError or OverflowError for what cannot be sent.
        """
        hub = self._hub
        if hub.closing or hub.interrupted:
            self._check_open()
        envelope = envelope_of(stamp) if stamp is not None else b""
        packet = Packet(value, envelope)
        if hub.preparing.begun:
            freeze(value, packet.blocks)
        outputs = hub.outputs
        if not outputs:
            hub.count_unconnected()
            return 0
        if hub.monitoring.output is not None:
            passed = hub.monitoring.output.send(packet)
            if passed is None:
                for link in outputs:
                    link.counter.drops += 1
                return 0
            packet = passed
        return self._send_all(packet, outputs, wait, timeout)

    @property
    def links(self) -> tuple[Outbound, ...]:
        """The connections out of it, for `Audience`."""
        hub = self._hub
        if hub.closing or hub.interrupted:
            self._check_open()
        return hub.outputs

    def is_yarp4(self, target: str) -> bool:
        """Whether a port that this one is connected to is of C++ YARP 4. Raises LinkClosed,
        Timeout, RemoteProtocolError, NoNameServer."""
        contact = self._hub.registration.locate(parse_contact(target))
        return contact is not None and probe.is_yarp4(contact, secret_=self._hub.key)

    def send(self, packet: Packet, links: tuple[Outbound, ...]) -> int:
        """Send a packet over some of the connections; as `write`."""
        output = self._hub.monitoring.output
        if output is not None:
            passed = output.send(packet)
            if passed is None:
                for link in links:
                    link.counter.drops += 1
                return 0
            packet = passed
        return self._send_all(packet, links, False, None)

    def _send_all(
        self, packet: Packet, outputs: tuple[Outbound, ...], wait: bool, timeout: float | None
    ) -> int:
        deadline = None if timeout is None else time.monotonic() + timeout
        if len(outputs) == 1:
            link, took = outputs[0], []
            try:
                if link.active and not link.log and link.send(packet, deadline):
                    took = [link]
            except YarpError as error:
                self._lose(link, error)
        else:
            took = self._send_to_several(packet, outputs, deadline)
        if wait:
            took = [link for link in took if self._attempt(link, _is_taken, deadline)]
        return len(took)

    def _send_to_several(
        self, packet: Packet, outputs: tuple[Outbound, ...], deadline: float | None
    ) -> list[Outbound]:
        """The connections that took it. Who is slow is waited for when the others have it."""
        copies = deadline is not None
        took: list[Outbound] = []
        whole = Rest(packet)
        todo = [(link, whole) for link in outputs]
        pause, ready, before = _SHORTEST, False, -1
        try:
            while todo:
                slow: list[tuple[Outbound, Rest]] = []
                for link, rest in todo:
                    begun = self._attempt(link, Outbound.begin, rest, copies)
                    if isinstance(begun, Rest):
                        slow.append((link, begun))
                    elif begun:
                        took.append(link)
                if len(slow) == len(todo):
                    sent = sum(link.driver.bytes_out for link, _ in slow)
                    if sent != before:
                        pause, before = _SHORTEST, sent
                    elif ready:  # something else is in the way
                        time.sleep(pause)
                        pause = min(2 * pause, _LONGEST)
                    left = _LONGEST if deadline is None else deadline - time.monotonic()
                    ready = wait_for_any((link for link, _ in slow), max(0.0, min(left, _LONGEST)))
                todo = slow
                if len(todo) == 1 or (deadline is not None and time.monotonic() >= deadline):
                    break
            while todo:
                link, rest = todo.pop(0)
                if self._attempt(link, Outbound.finish, rest, deadline):
                    took.append(link)
        finally:
            for link, _ in todo:  # this writer was interrupted
                link.sender.leave()
        return took

    def _attempt(
        self, link: Outbound, act: Callable[[Outbound, *Args], bool | Rest], *arguments: *Args
    ) -> bool | Rest:
        """What `act` gives; False where the connection takes no messages, or no more."""
        if not link.active or link.log:
            return False
        try:
            return act(link, *arguments)
        except YarpError as error:
            self._lose(link, error)
        return False

    def _lose(self, link: Outbound, error: YarpError) -> None:
        """A connection has failed: it is made again if that is because its peer went away."""
        self._hub.drop_output(link, str(error), lost=isinstance(error, LinkClosed))

    def flush(self, timeout: float | None = None) -> bool:
        """Wait until every message was sent and, where readers acknowledge, taken; False if that
        takes more than `timeout` seconds, or a connection breaks."""
        done = True
        deadline = None if timeout is None else time.monotonic() + timeout
        for link in self._hub.outputs:
            try:
                link.wait_acknowledged(_left(deadline))
            except YarpError:
                done = False
        return done


class Port(MessagePort):
    """A plain port: every message is read once, and its sender waits until it was.

    A question that was read and is left unanswered is closed by the next `read` of that thread.

    name: begins with `/`; `...` asks the name server for one; "" opens an unregistered port.
    names: a name client, None for the default (see `yarpy.NameServer`, `yarpy.LocalNames`).
    tcp_port: the number to listen on, 0 to let the name server or the system choose.
    port_type: what the port says it takes or sends, for those who look it up (`yarp/image`).
    callback: called with each message in its connection's thread, instead of `read`.
    spin: readers ask the socket again and again instead of sleeping: the lowest latency, one core.
    limit: the largest message accepted, in bytes.
    Raises AddressError (unusable name, or in use), NoNameServer.
    """

    def __init__(
        self,
        name: str,
        *,
        names: NameClient | None = None,
        tcp_port: int = 0,
        port_type: str = "",
        callback: Callable[[Message], None] | None = None,
        spin: bool = False,
        limit: int = DEFAULT_LIMIT,
        on_connection: Callable[[ConnectionEvent], None] | None = None,
    ) -> None:
        mailbox = Rendezvous() if callback is None else Callback(callback)
        super().__init__(
            open_hub(
                name,
                mailbox,
                names,
                tcp_port=tcp_port,
                port_type=port_type,
                limit=limit,
                on_connection=on_connection,
            ),
            spin,
        )

    def ask(self, value: object, timeout: float | None = None) -> list[Message]:
        """Ask every connected port, one after the other; the answers of those that give one.

        `RpcClient` asks one and says what went wrong: here a connection that breaks, or over which
        no answer came within `timeout` seconds, is dropped, counted and logged. Raises PortClosed.
        """
        self._check_open()
        packet = Packet(value, key=CALL)
        answers = []
        for link in self._hub.outputs:
            if link.log or link.carrier.delivery.lossy:
                continue  # somebody looks on
            try:
                answer = link.call(packet, timeout)
            except YarpError as error:
                self._hub.drop_output(link, str(error), lost=isinstance(error, LinkClosed))
                continue
            if answer is not None:
                answers.append(answer)
        return answers


class BufferedPort(MessagePort):
    """A port between loops that run at their own pace.

    Reading gives the newest message, older ones are dropped and counted; with `strict` every
    message comes, in order. Writing hands each connection its message and returns, and what was
    written may be changed; a connection that still sends the one before drops this one, which costs
    nothing then, and counts it; with `strict` the writer waits instead. `callback`
    gets every message in its connection's thread. Other parameters as `Port`.
    """

    def __init__(
        self,
        name: str,
        *,
        strict: bool = False,
        names: NameClient | None = None,
        tcp_port: int = 0,
        port_type: str = "",
        callback: Callable[[Message], None] | None = None,
        spin: bool = False,
        limit: int = DEFAULT_LIMIT,
        on_connection: Callable[[ConnectionEvent], None] | None = None,
    ) -> None:
        mailbox: Mailbox
        mailbox = Callback(callback) if callback is not None else Fifo() if strict else Latest()
        self.strict = strict
        hub = open_hub(
            name,
            mailbox,
            names,
            tcp_port=tcp_port,
            port_type=port_type,
            limit=limit,
            on_connection=on_connection,
        )
        super().__init__(hub, spin)

    def read_strictly(self, strict: bool = True) -> None:
        """From now on every message comes, in order; or the newest only. What has come is kept.

        To be called before anybody reads. Does nothing for a port with a callback.
        """
        if isinstance(self._mailbox, Fifo if strict else Latest | Callback):
            return
        if not isinstance(self._mailbox, Callback):
            self._reader.exchange(Fifo() if strict else Latest())
            self._mailbox = self._hub.mailbox

    def _send_all(
        self, packet: Packet, outputs: tuple[Outbound, ...], wait: bool, timeout: float | None
    ) -> int:
        if self.strict or wait:
            return super()._send_all(packet, outputs, wait, timeout)
        sent = 0
        for link in outputs:
            if link.broken:
                link.counter.drops += 1
                self._hub.drop_output(link, link.reason, lost=True)
            elif self._attempt(link, Outbound.try_send, packet):
                sent += 1
        return sent


def _is_taken(link: Outbound, deadline: float | None) -> bool:
    """Wait until everything was acknowledged; False if `deadline` comes first."""
    try:
        link.wait_acknowledged(_left(deadline))
    except Timeout:
        if deadline is None:
            raise
        return False
    return True


def _left(deadline: float | None) -> float | None:
    """Seconds until `deadline`."""
    return None if deadline is None else max(0.0, deadline - time.monotonic())


def envelope_of(stamp: Stamp | str | bytes) -> bytes:
    """The envelope's bytes: a Stamp's text, or any one-line text up to its first control
    character. Raises TypeError for anything else."""
    if isinstance(stamp, Stamp):
        return stamp.to_text().encode()
    if not isinstance(stamp, str | bytes):
        raise TypeError(
            f"a stamp is a yarpy.Stamp or a line of text, not {stamp!r}; a message is one "
            "object, several go into a list: write([1, 2])"
        )
    if isinstance(stamp, str):
        if stamp.isascii() and stamp.isprintable():
            return stamp.encode()
        stamp = stamp.encode()
    data = stamp
    for index, byte in enumerate(data):
        if byte < 0x20 or byte >= 0x80:
            return data[:index]
    return data
