"""Remote procedure calls: RpcServer answers, RpcClient asks."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, ClassVar, Generic, Unpack, cast

from yarpy import scope
from yarpy.data.bottle import Bottle
from yarpy.data.failure import answer_of, error_of, mark
from yarpy.data.value import Vocab
from yarpy.errors import (
    DecodeError,
    LinkClosed,
    LocalProtocolError,
    Timeout,
    YarpError,
)
from yarpy.link.ending import NEVER
from yarpy.link.send.outbound import Outbound
from yarpy.log import log_failure, logger
from yarpy.monitors.base import FAILURES
from yarpy.names.node_name import CLIENT, SERVER
from yarpy.port.assembly import open_hub
from yarpy.port.base import BasePort
from yarpy.port.connect import connecting
from yarpy.port.connection import PortConnection
from yarpy.port.graph import Role
from yarpy.port.mailbox import Callback, Mailbox
from yarpy.port.options import PortOptions
from yarpy.port.typed import of_type
from yarpy.route import Route
from yarpy.scope import CONNECTING, Flag, Scope, apart, moment
from yarpy.wire.message import CALL, Malformed, Message, Packet, T, is_unsent

log = logger("yarpy.port")

Handler = Callable[[Message], object]


class RpcServer(BasePort):
    """Answers every message with what `handler(message)` returns; None is an empty answer.

    The handler runs in the connection's thread, so calls of different clients run side by side;
    with `lock` one at a time. What it raises is logged, and raised as RemoteError by the client's
    `call`; a client of C++ gets `[fail] "TYPE: reason" (raised TYPE)`. It may also call
    `message.reply(...)` itself. If it has a method `page`, that is what browsers see, as of
    `on_page`. Without `register` no name service hears of it; `role` is what it does in the graph
    of another system. Other parameters as `Port`.
    """

    def __init__(
        self,
        name: str,
        handler: Handler,
        *,
        lock: bool = False,
        register: bool = True,
        role: Role | None = None,
        **options: Unpack[PortOptions],
    ) -> None:
        if isinstance(handler, type):
            raise TypeError(
                f"the handler of {name} is the class {handler.__name__}, not an object of it: "
                f"RpcServer({name!r}, {handler.__name__}())"
            )
        if not callable(handler):
            raise TypeError(
                f"the handler of {name} is a function of one argument that returns the answer, or "
                f"an object of a Thrift service; not {handler!r}"
            )
        self._handler = handler
        # A client may be there before this constructor is done, which frees it.
        opening = Flag()
        self._opening: Flag | None = opening
        try:
            super().__init__(
                open_hub(
                    name,
                    Callback(self._answer, lock),
                    admits_outputs=False,
                    register=register,
                    category=SERVER,
                    role=role,
                    **options,
                )
            )
            page = getattr(handler, "page", None)
            if page is not None:
                self.on_page(page)
        finally:
            self._opening = None
            opening.set()

    def _answer(self, message: Message) -> None:
        opening = self._opening
        if opening is not None:
            opening.wait()
        reply: object
        try:
            reply = self._handler(message)
        except DecodeError as error:
            log.warning("%s: message from %s: %s", self.name, message.source, error)
            reply = refusal = Malformed(str(error))
            refusal.append(mark(type(error).__name__))
        except FAILURES as error:
            log_failure(log, error, "%s: the handler failed on %r", self.name, message)
            reply = answer_of(error)
        answer = Bottle() if reply is None else reply
        if self._hub.outputs.links:
            self._forward(message, answer)
        # A handler that has answered by `message.reply` returns None: there is nothing left to say,
        # nor is there for one that was cancelled.
        way = message.answer
        if way is not None and (reply is not None or (way.right and not way.forsaken)):
            try:
                (way.give if way.right else message.reply)(answer)
            except Exception as error:
                if not is_unsent(error):
                    raise
                log.error("%s: the answer of the handler: %s", self.name, error)
                message.reply(answer_of(error))

    def _forward(self, message: Message, answer: object) -> None:
        """Tell connected loggers (`+log.in`) what was asked and answered."""
        for link in self._hub.outputs.links:
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
                self._hub.outputs.drop(link, str(error))


def _as_list(value: object) -> Bottle:
    return Bottle(value) if isinstance(value, (list, tuple)) else Bottle([value])


class RpcClient(BasePort, Generic[T]):
    """Asks the server called `target`: `RpcClient("/server").call("add", 1, 2)`.

    `RpcClient[Arm]("/arm/rpc").remote` has the methods of Arm, a service of a `.thrift` file.

    name: the client's own name, for servers that want to know and for `yarpy connect`; without one
    it is not registered. A client with a name may be made without a target and connected later. A
    server that was restarted is found again by the next call. `timeout` is that of every call that
    names none, and of opening and connecting, for which it is 5 s otherwise. Other parameters as
    `Port`. Raises UnknownName, LinkClosed when the server is not there.
    """

    _type: ClassVar[Any] = None  # the service

    if not TYPE_CHECKING:

        def __class_getitem__(cls, service):
            return of_type(cls, service)

    @apart
    def __init__(
        self,
        target: str = "",
        *,
        name: str = "",
        carrier: str = "",
        **options: Unpack[PortOptions],
    ) -> None:
        timeout = options.get("timeout")
        mailbox: Mailbox = Callback(lambda message: None)
        with Scope(moment(timeout)):
            super().__init__(open_hub(name, mailbox, rpc=True, category=CLIENT, **options))
            self._target = ""
            self._carrier = carrier
            self._timeout = timeout
            turn: Any = threading.RLock()
            self._turn = turn  # one question at a time
            self._asking: Callable[[], bool] = turn._is_owned  # this thread; see `link/ending.py`
            self._last: Route | None = None  # of the last call; the next has to reach the same port
            if target:
                try:
                    self.connect(target, carrier)
                except BaseException:
                    self.close()
                    raise

    def connect(
        self, target: str, carrier: str = "", timeout: float | None = None
    ) -> PortConnection:
        """Choose the server to ask, over tcp where no carrier is named; see Port.connect."""
        carrier = _over(target, carrier)
        made = super().connect(target, carrier, timeout)
        self._last = None
        self._target, self._carrier = target, carrier
        return made

    @property
    def remote(self) -> T:
        """The methods of the service that this client is for, each of which is a call with the
        client's `timeout`; errors as of the `connect` of a service. Raises TypeError for a client
        of no service."""
        return cast(T, methods_of(type(self), self, self._timeout))

    def call(self, *args: object, timeout: float | None = None) -> Any:
        """Ask, and return the answer's value.

        One argument that is a list, dict or message object is the question itself; otherwise the
        arguments are its elements. Without `timeout`, here or of the client, it waits until the
        answer comes, the connection ends, or the client is interrupted or closed.

        Raises RemoteError for what the server's handler raises; Timeout after `timeout` seconds;
        LinkClosed when the server goes away, and says whether it may have done what it was told: a
        question that never left is asked again by itself. WrongPort when another port listens where
        it was, LocalProtocolError when no server is connected, PortClosed.
        """
        hub = self._hub  # as `ask`, spelled out: a step less for every call
        if hub.life.closing or hub.life.interrupted:
            self._check_open()
        question = args[0] if len(args) == 1 and _is_message(args[0]) else Bottle(args)
        message = hub.life.calls.run(
            self._timeout if timeout is None else timeout, self._ask, Packet(question, key=CALL)
        )
        if message is None:
            return Bottle()
        value = message.value
        error = error_of(value) if type(value) is Bottle and len(value) == 3 else None
        if error is not None:
            raise error
        return value

    def ask(self, question: object, timeout: float | None = None) -> Message | None:
        """As `call` with one argument, but returns the whole Message, whatever it says; None if
        there is no reply."""
        hub = self._hub
        if hub.life.closing or hub.life.interrupted:
            self._check_open()
        seconds = self._timeout if timeout is None else timeout
        return hub.life.calls.run(seconds, self._ask, Packet(question, key=CALL))

    def _ask(self, call: Scope, packet: Packet) -> Message | None:
        self._take_turn()
        try:
            link = self._link()
            output = self._hub.monitoring.output
            if output is not None:
                passed = output.send(packet)
                if passed is None:
                    link.counter.drops += 1
                    return None
                packet = passed
            again = False
            while True:
                driver, until = link.driver, call.until
                before = driver.bytes_out
                try:
                    call.wake = driver.transport.interrupt
                    if call.ended or (until is not None and time.monotonic() >= until):
                        scope.left()  # which raises
                    reply = link.call(packet, until)
                    call.wake = None
                    return reply
                except LinkClosed as error:
                    left = self._left(link, before, error)
                    if left or again:
                        raise _lost(link.route.target, left) from error
                except YarpError as error:
                    if link.broken:
                        self._hub.outputs.drop(link, str(error))
                    raise
                again = True
                link = self._link()
        finally:
            self._turn.release()

    def tell(self, statement: object, timeout: float | None = None) -> None:
        """Send it without waiting for an answer; errors as of `call`. What never left is sent again
        by itself, too. A server that closes drops what it has not begun with: that something was
        done only an answer says."""
        self._check_open()
        seconds = self._timeout if timeout is None else timeout
        self._hub.life.calls.run(seconds, self._tell, Packet(statement))

    def _tell(self, call: Scope, packet: Packet) -> None:
        self._take_turn()
        try:
            again = False
            while True:
                link = self._link()
                before = link.driver.bytes_out
                try:
                    link.send(packet, call.until)
                    return
                except LinkClosed as error:
                    if self._left(link, before, error) or again:
                        raise
                again = True
        finally:
            self._turn.release()

    def _left(self, link: Outbound, before: int, error: LinkClosed) -> bool:
        """Leave a connection that has ended under a message; return whether a part of that may have
        left: `before`, so many bytes had. Raises what ends the call."""
        self._hub.outputs.drop(link, str(error))
        scope.check()
        return link.driver.bytes_out != before or link.carrier.spelling == "object"

    def _take_turn(self) -> None:
        """One question at a time: one that did not answer in time ends the connection, and those
        that wait here never knew that one."""
        turn = self._turn
        if self._asking():
            raise LocalProtocolError(
                f'"{self.name}" is asking already, in the frame beneath: a signal handler or a '
                "callback needs a client of its own"
            )
        try:
            taken = turn.acquire(False) or NEVER.acquire(turn)
        except BaseException:
            if self._asking():  # and only then a signal handler raised
                turn.release()
            raise
        if not taken:
            scope.check()
            raise Timeout(
                f'"{self._target}" was not asked: an earlier question of this client is still '
                "waiting for its answer"
            )

    def _link(self) -> Outbound:
        """The connection to the server: the one there is, if it lives, else a new one."""
        for link in self._hub.outputs.links:
            if link.carrier.delivery.lossy:
                continue  # somebody looks on
            self._last = link.route
            if not link.ended():
                return link
            # The server was restarted, or the last call did not end well.
            self._hub.outputs.drop(link, "the server hung up")
        last = self._last
        target, carrier = self._target, self._carrier
        if last is not None:
            target, carrier = last.target, "" if last.spec.chosen else last.spec.whole
        if target:
            with Scope(moment(CONNECTING)):
                connecting.connect(self._hub, target, carrier, last)
            for link in self._hub.outputs.links:
                if not link.carrier.delivery.lossy:
                    return link
            raise LinkClosed(f'"{target}" went away at once')
        raise LocalProtocolError(
            f'"{self.name}" is not connected to a server: connect("/server"), or from outside '
            f"`yarpy connect {self.name} /server`"
        )


def methods_of(cls: Any, client: object, timeout: float | None, waits: bool = False) -> Any:
    """Return the methods of the service that a class of clients is for, as calls of `client`."""
    remote = getattr(cls._type, "__remote__", None)
    if remote is None:
        raise TypeError(
            f"{cls.__name__} is not the client of a service: RpcClient[Arm](...) is, where Arm is "
            'of a module that `yarpy.idl.load("arm.thrift")` gives'
        )
    return remote(client, timeout, waits)


def _lost(server: str, asked: bool) -> LinkClosed:
    """Return the error for a server that went away, before or after the question left. That is not
    asked again: the server may have done what it was told before it went away."""
    if not asked:
        return LinkClosed(f'"{server}" went away before it was asked')
    return LinkClosed(
        f'"{server}" went away during the call: nobody knows whether it has done what it was told'
    )


def _over(target: str, carrier: str) -> str:
    """The carrier to ask over: tcp, unless the program or the target says another one."""
    return carrier or ("" if ":/" in str(target) else "tcp")


def _is_message(value: object) -> bool:
    """Return whether a single argument is the whole question rather than its one element."""
    return not isinstance(value, (str, int, float, bytes, bool))
