"""Port and BufferedPort: the things with a name that programs read from and write to.

Rules: opening registers, closing gives the name back; they are context managers and iterate over
what comes in. Everything is safe to call from any thread. What is read goes through a mailbox, the
reading policy; what is written goes straight to the links.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar, Generic, Unpack

from yarpy.contact import parse_contact
from yarpy.data.stamp import Stamp
from yarpy.errors import LinkClosed, PortClosed, YarpError
from yarpy.link.ending import moment
from yarpy.link.send.fan_out import begin, finish, offer_to
from yarpy.link.send.outbound import Outbound
from yarpy.port.assembly import open_hub
from yarpy.port.base import BasePort
from yarpy.port.connect import probe
from yarpy.port.hub import Hub
from yarpy.port.mailbox import Callback, Fifo, Latest, Mailbox, Rendezvous
from yarpy.port.options import PortOptions
from yarpy.port.reader import Reader
from yarpy.port.typed import of_type
from yarpy.scope import ASKING, apart
from yarpy.transports.shared.shared_array import freeze
from yarpy.wire.message import CALL, Message, Packet, T

if TYPE_CHECKING:
    from numpy.typing import DTypeLike, NDArray


class MessagePort(BasePort, Generic[T]):
    """A port that is read from and written to. Subclasses choose the mailbox of its hub.

    `Port[Image]` is for messages of one type: `message.value` is an Image, or a DecodeError says
    what came instead.
    """

    _type: ClassVar[Any] = None  # that of its messages; None: any

    if not TYPE_CHECKING:

        def __class_getitem__(cls, type_):
            return of_type(cls, type_)

    def __init__(self, hub: Hub, spin: bool = False) -> None:
        super().__init__(hub)
        self._mailbox = hub.inputs.mailbox
        self._reader = Reader(hub, spin)

    def read(self, timeout: float | None = None) -> Message[T]:
        """The next message, waiting for one if needed.

        Raises Timeout after `timeout` seconds, PortClosed if the port is closed or interrupted.
        """
        if self._type is None:
            return self._reader.read(timeout)
        return self._reader.read(timeout).typed(self._type)

    def poll(self) -> Message[T] | None:
        """A message that is already there, or None."""
        message: Message[T] | None = self._reader.poll()
        if message is None or self._type is None:
            return message
        return message.typed(self._type)

    @property
    def waiting(self) -> int:
        """Messages that came and were not read yet. Raises PortClosed."""
        self._check_not_closed()
        return self._mailbox.waiting

    def __iter__(self) -> Iterator[Message[T]]:
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
        value: T,
        stamp: Stamp | str | None = None,
        *,
        wait: bool = False,
        timeout: float | None = None,
    ) -> int:
        """Send `value` to every connected port; returns how many connections took it.

        When it returns, the message is in the system's hands (in a burst: about to be, at the
        latest 0.2 ms later) and `value` may be changed, unless a connection is `local`: there the
        reader gets `value` itself. Messages of a burst may be on their way unacknowledged to a
        reader: 256 of them, 64 KiB and 5 ms at most; then a writer waits for its slowest reader,
        after the others have got the message. With `timeout` it waits that many seconds at most:
        for a connection over which the message has not begun to leave by then it is a drop. With
        `wait` it returns when every reader that acknowledges has taken this message, and counts
        those. Readers that dialled this port are waited for 10 s, then disconnected. `stamp`
        travels as the envelope. A connection that breaks is dropped, counted, and made again in the
        background.

        Raises PortClosed; TypeError, ValueError or OverflowError for what cannot be sent.
        """
        hub = self._hub
        if hub.life.closing or hub.life.interrupted:
            self._check_open()
        envelope = envelope_of(stamp) if stamp is not None else b""
        packet = Packet(value, envelope)
        if hub.preparing.begun:
            freeze(value, packet.blocks)
        outputs = hub.outputs.links
        if not outputs:
            hub.outputs.count_unconnected(value)
            return 0
        if hub.monitoring.output is not None:
            passed = hub.monitoring.output.send(packet)
            if passed is None:
                for link in outputs:
                    link.counter.drops += 1
                return 0
            packet = passed
        if len(outputs) == 1 and not wait:  # as nearly always
            link, until = outputs[0], None if timeout is None else time.monotonic() + timeout
            try:
                if link.active and not link.log:
                    return int(link.box.offer(packet, until) is True)
            except PortClosed:
                raise
            except YarpError as error:
                self._lose(link, error)
            return 0
        return self._send_all(packet, outputs, wait, moment(timeout))

    def _begin_write(
        self, value: T, stamp: Stamp | str | None = None, timeout: float | None = None
    ) -> int | Callable[[], int]:
        """As `write`, without waiting, for event loops. Where it takes waiting, or monitors look at
        the message, return what does the rest, once, in another thread."""
        hub = self._hub
        if hub.life.closing or hub.life.interrupted:
            self._check_open()
        outputs, until = hub.outputs.links, moment(timeout)
        if hub.monitoring.output is not None or any(link.sender.chain for link in outputs):
            return partial(self.write, value, stamp, timeout=timeout)
        packet = Packet(value, envelope_of(stamp) if stamp is not None else b"")
        if hub.preparing.begun:
            freeze(value, packet.blocks)
        if not outputs:
            hub.outputs.count_unconnected(value)
            return 0
        took, slow = begin(outputs, packet, self._lose)

        def rest() -> int:
            finish(slow, took, until, self._lose)
            return len(took)

        return rest if slow else len(took)

    def _drop(self) -> int:
        """Count a message whose time was over before it could begin to leave; return 0."""
        self._check_open()
        for link in self._hub.outputs.links:
            link.counter.drops += 1
        return 0

    @property
    def _links(self) -> tuple[Outbound, ...]:
        """The connections out of it, for `Dialects`."""
        hub = self._hub
        if hub.life.closing or hub.life.interrupted:
            self._check_open()
        return hub.outputs.links

    @apart
    def _is_yarp4(self, target: str, timeout: float | None = None) -> bool:
        """Return whether a port that this one is connected to is of C++ YARP 4. Raises LinkClosed,
        Timeout, RemoteProtocolError, NoNameServer, PortClosed."""
        hub = self._hub
        with hub.life.calls.scope(ASKING if timeout is None else timeout):
            contact = hub.registration.locate(parse_contact(target))
            return contact is not None and probe.introduce(contact, secret_=hub.key).yarp4

    def _send(self, packet: Packet, links: tuple[Outbound, ...]) -> int:
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
        self, packet: Packet, outputs: tuple[Outbound, ...], wait: bool, until: float | None
    ) -> int:
        took = offer_to(outputs, packet, until, self._lose, wait)
        if wait:
            took = [link for link in took if self._is_taken(link, until)]
        return len(took)

    def _is_taken(self, link: Outbound, until: float | None) -> bool:
        """Wait until everything was acknowledged; return False if `until` comes first."""
        try:
            return link.wait_acknowledged(until)
        except PortClosed:
            raise
        except YarpError as error:
            self._lose(link, error)
        return False

    def _lose(self, link: Outbound, error: YarpError) -> None:
        """Forget a connection that has failed: it is made again if its peer went away."""
        self._hub.outputs.drop(link, str(error), lost=isinstance(error, LinkClosed))

    def flush(self, timeout: float | None = None) -> bool:
        """Wait until every message was sent and, where readers acknowledge, taken; False if that
        takes more than `timeout` seconds, or a connection breaks. Raises PortClosed."""
        self._check_not_closed()
        done, until = True, moment(timeout)
        for link in self._hub.outputs.links:
            try:
                done = link.wait_acknowledged(until) and done
            except PortClosed:
                raise
            except YarpError:
                done = False
        return done


class Port(MessagePort[T]):
    """A plain port: every message is read once, and its sender waits until it was.

    A question that was read and is left unanswered is closed by the next `read` of that thread.

    `Port[Image](name)` is for messages of that type alone: any class, dataclass or hint that
    `message.as_` knows.
    name: begins with `/`; `...` asks the name server for one; "" opens an unregistered port.
    callback: called with each message in its connection's thread, instead of `read`.
    spin: readers ask the socket again and again instead of sleeping: the lowest latency, one core.
    options: of every kind of port:
    names: a name client, None for the default (see `yarpy.NameServer`, `yarpy.LocalNames`).
    tcp_port: the number to listen on, 0 to let the name server or the system choose.
    port_type: what the port says it takes or sends, for those who look it up (`yarp/image`).
    limit: the largest message accepted, in bytes.
    on_connection: called with an event when a connection comes or goes.
    timeout: seconds for opening it, else 5.
    Raises AddressError (unusable name, or in use), NoNameServer.
    """

    def __init__(
        self,
        name: str,
        *,
        callback: Callable[[Message[T]], object] | None = None,
        spin: bool = False,
        **options: Unpack[PortOptions],
    ) -> None:
        mailbox = Rendezvous() if callback is None else Callback(callback, type_=self._type)
        super().__init__(open_hub(name, mailbox, **options), spin)

    def ask(self, value: object, timeout: float | None = None) -> list[Message]:
        """Ask every connected port, one after the other; the answers of those that give one.

        `RpcClient` asks one and says what went wrong: here a connection that breaks, or over which
        no answer came within `timeout` seconds, is dropped, counted and logged. Raises PortClosed.
        """
        self._check_open()
        packet, until = Packet(value, key=CALL), moment(timeout)
        answers = []
        for link in self._hub.outputs.links:
            if link.log or link.carrier.delivery.lossy:
                continue  # somebody looks on
            try:
                answer = link.call(packet, until)
            except PortClosed:
                raise
            except YarpError as error:
                self._lose(link, error)
                continue
            if answer is not None:
                answers.append(answer)
        return answers


class BufferedPort(MessagePort[T]):
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
        callback: Callable[[Message[T]], object] | None = None,
        spin: bool = False,
        **options: Unpack[PortOptions],
    ) -> None:
        mailbox: Mailbox
        if callback is not None:
            mailbox = Callback(callback, type_=self._type)
        else:
            mailbox = Fifo() if strict else Latest()
        super().__init__(open_hub(name, mailbox, **options), spin)
        self.strict = strict

    @property
    def strict(self) -> bool:
        """Return whether writers wait for slow readers, instead of leaving messages out."""
        return not self._hub.outputs.newest

    @strict.setter
    def strict(self, strict: bool) -> None:
        self._hub.outputs.newest = not strict

    def read_strictly(self, strict: bool = True) -> None:
        """From now on every message comes, in order; or the newest only. What has come is kept.

        To be called before anybody reads. Does nothing for a port with a callback.
        """
        if isinstance(self._mailbox, Fifo if strict else Latest | Callback):
            return
        if not isinstance(self._mailbox, Callback):
            self._reader.exchange(Fifo() if strict else Latest())
            self._mailbox = self._hub.inputs.mailbox


def envelope_of(stamp: Stamp | str | bytes) -> bytes:
    """The envelope's bytes: a Stamp's text, or any one-line text up to its first control
    character. Raises TypeError for anything else."""
    if isinstance(stamp, Stamp):
        return stamp.to_text().encode()
    if isinstance(stamp, str):
        if stamp.isascii() and stamp.isprintable():
            return stamp.encode()
        stamp = stamp.encode()
    if not isinstance(stamp, bytes):
        raise TypeError(
            f"a stamp is a yarpy.Stamp or a line of text, not {stamp!r}; a message is one "
            "object, several go into a list: write([1, 2])"
        )
    data = stamp
    for index, byte in enumerate(data):
        if byte < 0x20 or byte >= 0x80:
            return data[:index]
    return data
