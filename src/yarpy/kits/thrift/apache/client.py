"""The client of a service at a server of Apache Thrift.

Rules: as the client of YARP's wire, with the same errors; besides, an exception that the method
declares is raised as it is, and a TApplicationException is a Fault, which is a RemoteProtocolError.
A result that an answer lacks is one.
"""

from __future__ import annotations

from typing import Any

from yarpy.errors import (
    AddressError,
    DecodeError,
    LinkClosed,
    LocalProtocolError,
    Timeout,
    YarpError,
)
from yarpy.kits.thrift.apache import encode
from yarpy.kits.thrift.apache.decode import READERS, fields
from yarpy.kits.thrift.apache.message import Asked, Returned, fault_of
from yarpy.kits.thrift.apache.protocol import (
    CALL,
    EXCEPTION,
    MISSING_RESULT,
    ONEWAY,
    Fault,
)
from yarpy.kits.thrift.method import Method
from yarpy.route import parse_carrier

CARRIER = "thrift"


def spelling(target: str, carrier: str) -> str:
    """Return the protocol that a connection to `target` will have: `binary`, `compact`; "" where it
    is of YARP. AddressError for a server over HTTP whose path stands behind its number, where ports
    have their names."""
    named = carrier or (target.partition("://")[0] if "://" in target else "")
    if not named.lstrip("/").startswith(CARRIER):
        return ""
    spec = parse_carrier(named.lstrip("/"))
    if spec.base != CARRIER:
        return ""
    place, _, path = target.rpartition("://")[2].partition("/")
    if "http" in spec.tokens and "://" in target and path:
        raise AddressError(f'"{target}": say the path as {named}+path.{path}://{place}')
    return "compact" if "compact" in spec.tokens else "binary"


def question(thrift: str, method: Method, values: tuple[Any, ...]) -> Asked:
    """Return the call of a method. TypeError, OverflowError for what cannot be sent."""
    parts = zip(method.numbers, method.parts, values, strict=True)
    writer = encode.WRITERS[thrift]()
    encode.fields(
        writer,
        [(number, part.kind, value, f"{method.name}.{part.name}") for number, part, value in parts],
    )
    kind = ONEWAY if method.oneway else CALL
    return Asked(thrift, kind, method.name, bytes(writer.out))


def result(method: Method, message: Any) -> Any:
    """Return the result in an answer; raise the exception in it, or a Fault. DecodeError."""
    if not isinstance(message, Returned):
        raise Fault(MISSING_RESULT, f"{method.name}: the server gives no answer")
    if message.head.name != method.name:
        raise DecodeError(f"an answer to {message.head.name[:60]!r}, where {method.name} was asked")
    if message.head.kind == EXCEPTION:
        fault = fault_of(message)
        raise Fault(fault.kind, f"the server refuses {method.name}: {fault.text}")
    kinds = dict(method.throws.items()) | ({} if method.result is None else {0: method.result})
    reader = READERS[message.thrift](message.payload, message.at)
    found = fields(reader, kinds, f"the result of {method.name}")
    if 0 in found:
        return found[0]
    for error in found.values():
        raise error
    if method.result is not None:
        raise Fault(MISSING_RESULT, f"the server refuses {method.name}: it gives no result")
    return None


class _Client:
    def __init__(self, port: Any, timeout: float | None, thrift: str) -> None:
        self._port = port
        self.timeout = timeout
        self._thrift = thrift

    def _told(self, method: Method, error: YarpError) -> YarpError:
        """An error of the port, with the name of the method."""
        if isinstance(error, Timeout):
            return Timeout(f"{method.name}: no answer within {self.timeout} s")
        if method.name in str(error) or not isinstance(error, (DecodeError, LinkClosed)):
            return error
        return type(error)(f"{method.name}: {error}")

    def __repr__(self) -> str:
        return f"<client of {type(self).__name__}>"


class Sync(_Client):
    """The base of clients that wait."""

    def _call(self, method: Method, values: tuple[Any, ...]) -> Any:
        asked = question(self._thrift, method, values)
        try:
            if method.oneway:
                return self._port.tell(asked)
            return result(method, self._port.ask(asked, self.timeout))
        except YarpError as error:
            said = self._told(method, error)
            if said is error:
                raise
            raise said from error

    def remote_version(self) -> None:
        """Raise LocalProtocolError: Apache's protocols have no question for it."""
        raise LocalProtocolError("servers of Apache Thrift tell no version")

    def close(self) -> None:
        """End the connection."""
        self._port.close()


class Async(_Client):
    """The base of clients in an event loop."""

    async def _call(self, method: Method, values: tuple[Any, ...]) -> Any:
        asked = question(self._thrift, method, values)
        try:
            if method.oneway:
                return await self._port.tell(asked)
            return result(method, await self._port.ask(asked, self.timeout))
        except YarpError as error:
            said = self._told(method, error)
            if said is error:
                raise
            raise said from error

    async def remote_version(self) -> None:
        """As that of the other client."""
        raise LocalProtocolError("servers of Apache Thrift tell no version")

    async def close(self) -> None:
        """End the connection."""
        await self._port.close()

    async def __aenter__(self) -> Any:
        await self._port.open()
        return self

    async def __aexit__(self, *error: object) -> None:
        await self.close()
