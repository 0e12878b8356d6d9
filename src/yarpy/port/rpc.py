"""Remote procedure calls: RpcServer answers, RpcClient asks."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.errors import DecodeError, LinkClosed, LocalProtocolError, YarpError
from yarpy.link.outbound import Outbound
from yarpy.log import logger
from yarpy.names.base import NameClient
from yarpy.names.node_name import CLIENT, SERVER
from yarpy.port import connecting
from yarpy.port.assembly import open_hub
from yarpy.port.base import BasePort
from yarpy.port.connection import ConnectionEvent, PortConnection
from yarpy.port.mailbox import Callback, Mailbox
from yarpy.port.part import Part
from yarpy.route import Route
from yarpy.wire.message import CALL, UNSENDABLE, Malformed, Message, Packet
from yarpy.wire.stream import DEFAULT_LIMIT

log = logger("yarpy.port")

Handler = Callable[[Message], object]


class RpcServer(BasePort):
    """Answers every message with what `handler(message)` returns; None is an empty answer.

    The handler runs in the connection's thread, so calls of different clients run side by side;
    with `lock` one at a time. What it raises is answered as `[fail] "reason"` and logged. It may
    also call `message.reply(...)` itself. If it has a method `page`, that is what browsers see, as
    of `on_page`. Without `register` no name service hears of it; `part` is what it does in the
    graph of another system. Other parameters as `Port`.
    """

    def __init__(
        self,
        name: str,
        handler: Handler,
        *,
        names: NameClient | None = None,
        tcp_port: int = 0,
        port_type: str = "",
        lock: bool = False,
        limit: int = DEFAULT_LIMIT,
        on_connection: Callable[[ConnectionEvent], None] | None = None,
        register: bool = True,
        part: Part | None = None,
    ) -> None:
        self._handler = handler
        self._opened = threading.Event()  # a client may be there before this constructor is done
        try:
            super().__init__(
                open_hub(
                    name,
                    Callback(self._answer, lock),
                    names,
                    tcp_port=tcp_port,
                    port_type=port_type,
                    admits_outputs=False,
                    limit=limit,
                    on_connection=on_connection,
                    register=register,
                    category=SERVER,
                    part=part,
                )
            )
            page = getattr(handler, "page", None)
            if page is not None:
                self.on_page(page)
        finally:
            self._opened.set()

    def _answer(self, message: Message) -> None:
        if not self._opened.is_set():
            self._opened.wait()
        try:
            reply = self._handler(message)
        except DecodeError as error:
            log.warning("%s: message from %s: %s", self.name, message.source, error)
            reply = Malformed(str(error))
        except Exception as error:
            log.exception("%s: the handler failed on %r", self.name, message)
            reply = Bottle([Vocab("fail"), f"{type(error).__name__}: {error}"])
        answer = Bottle() if reply is None else reply
        self._forward(message, answer)
        # A handler that has answered by `message.reply` returns None: there is nothing left to say.
        if message.answer is not None and (reply is not None or message.wants_reply):
            try:
                message.reply(answer)
            except UNSENDABLE as error:
                log.error("%s: the answer of the handler: %s", self.name, error)
                message.reply(Bottle([Vocab("fail"), str(error)]))

    def _forward(self, message: Message, answer: object) -> None:
        """Tell connected loggers (`+log.in`) what was asked and answered."""
        for link in self._hub.outputs:
            if not link.log:
                continue
            request = message.value
            if message.wants_reply:
                record: Any = Bottle([Vocab("rpc"), _as_list(request), _as_list(answer)])
            else:
                record = request
            try:
                link.send(Packet(record))
            except YarpError as error:
                self._hub.drop_output(link, str(error))


def _as_list(value: object) -> Bottle:
    return Bottle(value) if isinstance(value, (list, tuple)) else Bottle([value])


class RpcClient(BasePort):
    """Asks the server called `target`: `RpcClient("/server").call("add", 1, 2)`.

    name: the client's own name, for servers that want to know and for `yarpy connect`; without one
    it is not registered. A client with a name may be made without a target and connected later. A
    server that was restarted is found again by the next call. Other parameters as `Port`.
    Raises UnknownName, LinkClosed when the server is not there.
    """

    def __init__(
        self,
        target: str = "",
        *,
        name: str = "",
        carrier: str = "tcp",
        names: NameClient | None = None,
        tcp_port: int = 0,
        limit: int = DEFAULT_LIMIT,
        on_connection: Callable[[ConnectionEvent], None] | None = None,
        timeout: float | None = None,
    ) -> None:
        mailbox: Mailbox = Callback(lambda message: None)
        super().__init__(
            open_hub(
                name,
                mailbox,
                names,
                tcp_port=tcp_port,
                rpc=True,
                category=CLIENT,
                limit=limit,
                on_connection=on_connection,
            )
        )
        self._target = ""
        self._carrier = carrier
        self._last: Route | None = None  # of the last call; the next has to reach the same port
        if target:
            try:
                carrier = _over(target, carrier)
                connecting.connect(self._hub, target, carrier, None, patience=timeout)
                self._target, self._carrier = target, carrier
            except YarpError:
                self.close()
                raise

    def connect(
        self, target: str, carrier: str = "tcp", timeout: float | None = None
    ) -> PortConnection:
        """Choose the server to ask; see Port.connect."""
        carrier = _over(target, carrier)
        made = super().connect(target, carrier, timeout)
        self._last = None
        self._target, self._carrier = target, carrier
        return made

    def call(self, *args: object, timeout: float | None = None) -> Any:
        """Ask, and return the answer's value.

        One argument that is a list, dict or message object is the question itself; otherwise the
        arguments are its elements. Raises Timeout after `timeout` seconds (10 ms accuracy),
        LinkClosed when the server is gone, WrongPort when another port listens where it was,
        LocalProtocolError when no server is connected.
        """
        message = self.ask(
            args[0] if len(args) == 1 and _is_message(args[0]) else Bottle(args), timeout
        )
        return Bottle() if message is None else message.value

    def ask(self, question: object, timeout: float | None = None) -> Message | None:
        """As `call` with one argument, but returns the whole Message; None if there is no reply."""
        self._check_open()
        link = self._link(timeout)
        packet = Packet(question, key=CALL)
        output = self._hub.monitoring.output
        if output is not None:
            passed = output.send(packet)
            if passed is None:
                link.counter.drops += 1
                return None
            packet = passed
        try:
            return link.call(packet, timeout)
        except LinkClosed as error:
            self._hub.drop_output(link, str(error))
            # Not asked again: the server may have done what it was told before it went away.
            raise LinkClosed(f'"{link.route.target}" went away during the call') from error
        except YarpError as error:
            if link.broken:
                self._hub.drop_output(link, str(error))
            raise

    def tell(self, statement: object) -> None:
        """Send it without waiting for an answer; errors as of `call`."""
        self._check_open()
        link = self._link()
        try:
            link.send(Packet(statement))
        except LinkClosed as error:
            self._hub.drop_output(link, str(error))
            raise

    def _link(self, patience: float | None = None) -> Outbound:
        """The connection to the server: the one there is, if it lives, else a new one. `patience`:
        the seconds for which it may be silent."""
        for link in self._hub.outputs:
            if link.carrier.delivery.lossy:
                continue  # somebody looks on
            self._last = link.route
            if not link.ended():
                return link
            # The server was restarted, or the last call did not end well.
            self._hub.drop_output(link, "the server hung up")
        last = self._last
        target, carrier = self._target, self._carrier
        if last is not None:
            target, carrier = last.target, "" if last.spec.chosen else last.spec.whole
        if target:
            connecting.connect(self._hub, target, carrier, None, last, patience)
            for link in self._hub.outputs:
                if not link.carrier.delivery.lossy:
                    return link
            raise LinkClosed(f'"{target}" went away at once')
        raise LocalProtocolError(
            f'"{self.name}" is not connected to a server: connect("/server"), or from outside '
            f"`yarpy connect {self.name} /server`"
        )


def _over(target: str, carrier: str) -> str:
    """The carrier to ask over: tcp, unless the target says another one."""
    return "" if carrier == "tcp" and ":/" in target else carrier


def _is_message(value: object) -> bool:
    """Whether an only argument is the whole question rather than its one element."""
    return not isinstance(value, (str, int, float, bytes, bool))
