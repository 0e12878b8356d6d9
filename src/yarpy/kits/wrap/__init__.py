"""Decorators over many middlewares: hints say what, decorators where, the caller which side.

from yarpy import wrap

class Eyes:
    @wrap.on("/eyes/left")
    def look(self) -> numpy.ndarray: ...

wrap.publish(eyes.look)               # in one program: eyes.look() runs, and sends
frame = wrap.listen(eyes.look)()      # in another: the same method gives what was sent
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar, Unpack

from yarpy.errors import RemoteError
from yarpy.kits.wrap.decorator import Handle, Stream, activate, last, on, stream
from yarpy.kits.wrap.method import Changes
from yarpy.kits.wrap.middleware import Received
from yarpy.kits.wrap.setting import configure
from yarpy.kits.wrap.value.array import Image

R = TypeVar("R")

__all__ = [
    "Handle",
    "Image",
    "Received",
    "RemoteError",
    "Stream",
    "call",
    "configure",
    "exchange",
    "last",
    "listen",
    "off",
    "on",
    "publish",
    "receive",
    "relay",
    "serve",
    "stream",
]


def publish(method: Callable[..., R], **changes: Unpack[Changes]) -> Handle[R]:
    """From now on a call of this method runs it, and sends what it returns.

    `changes` are options of the decorator (`topic`, `middleware`, `qos` ...) for this object; a
    list has one for each decorator. Raises what the middleware raises: AddressError for a name that
    is taken, NoNameServer ...
    """
    return activate("publish", method, dict(changes))


def listen(method: Callable[..., R], **changes: Unpack[Changes]) -> Handle[R]:
    """From now on a call of this method returns what its publisher sends.

    A call takes `timeout=` in seconds, and raises Timeout after that. Its other arguments are the
    publisher's business. `changes` as for `publish`.
    """
    return activate("listen", method, dict(changes))


def serve(method: Callable[..., R], **changes: Unpack[Changes]) -> Handle[R]:
    """Run this method for whoever calls it from elsewhere, in the background."""
    return activate("serve", method, dict(changes))


def call(method: Callable[..., R], **changes: Unpack[Changes]) -> Handle[R]:
    """From now on a call of this method asks its server, with the arguments of the call.

    Raises RemoteError for what the method raises there, LinkClosed if the server goes away
    meanwhile, Timeout, UnknownName.
    """
    return activate("call", method, dict(changes))


def relay(method: Callable[..., R], **changes: Unpack[Changes]) -> Handle[R]:
    """From now on a call waits for values, runs the method with these as its first arguments, and
    sends what it returns. `source=` of the decorator says where the values come from."""
    return activate("relay", method, dict(changes))


def exchange(method: Callable[..., R], **changes: Unpack[Changes]) -> Handle[R]:
    """From now on a call runs the method, sends what it returns, and returns what comes from
    `source=`."""
    return activate("exchange", method, dict(changes))


def receive(method: Callable[..., R], **changes: Unpack[Changes]) -> Handle[R]:
    """From now on a call waits for values and runs the method with these as its first arguments;
    nothing is sent."""
    return activate("receive", method, dict(changes))


def off(method: Callable[..., R], **changes: Unpack[Changes]) -> Handle[R]:
    """From now on a call does nothing and returns None."""
    return activate("off", method, dict(changes))
