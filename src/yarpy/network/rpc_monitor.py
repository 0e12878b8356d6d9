"""rpc_monitor: send copies of an RPC client's requests and replies to an observing port.

Attach it at the caller's end (`tcp+send.rpc_monitor`); parameter `monitor`: the port to write to
(default `/monitor`). It gets Bottles as from C++ YARP, over a connection from `CLIENT/monitor`:

    time CLIENT SERVER command client       RpcMonitor (word) (whole question) ()
    time CLIENT SERVER reply   "rpc client" RpcMonitor ()     ()               (reply)

With the parameter `interface`, a file `camera` or `camera.thrift` that the program itself names, it
tells what the monitors of such an interface tell in C++ YARP (`yarp.monitor`):

    time CLIENT SERVER command client       Camera (set_speed) (1.5) ()
    time CLIENT SERVER reply   "rpc client" Camera (set_speed) ()    (ok)

Rules: a monitor that owns a port, so it lives in this layer. A separate thread sends the copies;
when the observer is 1000 behind, further ones are dropped and counted, and the client never waits.
`get` says how many.
"""

from __future__ import annotations

import queue
import time
from pathlib import Path
from typing import Protocol

from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text
from yarpy.data.value import Buffer
from yarpy.errors import DecodeError, LocalProtocolError, YarpError
from yarpy.monitors.base import Place
from yarpy.port.assembly import open_hub
from yarpy.port.mailbox import Latest
from yarpy.port.port import MessagePort
from yarpy.threads import Thread
from yarpy.wire.message import Message

_BEHIND = 1000  # copies


class RpcMonitor:
    """Copies requests and replies to the observer."""

    def __init__(self, place: Place) -> None:
        if not place.sending:
            raise LocalProtocolError('"rpc_monitor" works at the caller\'s end: +send.rpc_monitor')
        self._place = place
        self._interface = _interface(place)
        self._last = "RpcMonitor", ""  # the service and the method of the last question
        self._sent = self._drops = 0
        self._copies: queue.Queue[Bottle | None] = queue.Queue(_BEHIND)
        hub = open_hub(f"{place.source}/monitor", Latest(), place.names, register=False)
        self._port = MessagePort(hub)
        try:
            self._port.connect(place.text("monitor", "/monitor"))
        except YarpError:
            self._port.close()
            raise
        self._thread = Thread(target=self._run, name=f"yarpy {hub.name}", daemon=True)
        self._thread.start()

    def update(self, message: Message) -> None:
        question = _bottle(message)
        if self._interface is None:
            word = plain_text(question[0]) if question else ""
            self._tell("command", "client", "RpcMonitor", [word], question, [])
            return
        found = self._interface.request(message.to_bytes())
        service, method, arguments = found or ("RpcMonitor", "[unknown]", question)
        self._last = service, method
        self._tell("command", "client", service, [method], arguments, [])

    def update_reply(self, message: Message) -> None:
        service, method = self._last
        self._tell("reply", "rpc client", service, [method] if method else [], [], _bottle(message))

    def _tell(self, *said: object) -> None:
        ends = self._place.source, self._place.target
        try:
            self._copies.put_nowait(Bottle([time.time(), *ends, *said]))
        except queue.Full:
            self._drops += 1

    def _run(self) -> None:
        while (copy := self._copies.get()) is not None:
            try:
                if self._port.write(copy):
                    self._sent += 1
                    continue
            except YarpError:
                pass  # closed meanwhile
            self._drops += 1

    def parameters(self) -> dict[str, object]:
        return {"sent": self._sent, "drops": self._drops}

    def close(self) -> None:
        try:
            self._copies.put_nowait(None)  # after all copies
        except queue.Full:
            pass
        self._thread.join(1.0)
        self._port.close()


class Interface(Protocol):
    """Knows the questions of a typed connection."""

    def request(self, data: Buffer) -> tuple[str, str, Bottle] | None:
        """Return the service, the method and the arguments; None for what is unknown."""


def _interface(place: Place) -> Interface | None:
    """The interface that the parameters name. LocalProtocolError if there is none, or if it was
    requested over the network: then the file could be any."""
    name = place.text("interface")
    if not name:
        return None
    if place.foreign:
        raise LocalProtocolError('"interface" of rpc_monitor is for the program that owns the port')
    from yarpy import registry

    language = Path(name).suffix.removeprefix(".") or "thrift"
    if language not in registry.interfaces.names():
        raise LocalProtocolError(f'rpc_monitor: "{name}" is no file of an interface')
    file = name if Path(name).suffix else f"{name}.{language}"
    found = next((path for path in place.look(file, []) if path.is_file()), None)
    if found is None:
        raise LocalProtocolError(f'rpc_monitor: no file "{file}"')
    try:
        interface: Interface = registry.interfaces.load(language)(found)
    except DecodeError as error:
        raise LocalProtocolError(f"rpc_monitor: {error}") from None
    return interface


def _bottle(message: Message) -> Bottle:
    """The content of a message; only Bottles are copied."""
    try:
        return message.as_(Bottle)
    except DecodeError:
        return Bottle(["[unknown]"])
