"""The master of ROS 1, and the nodes that it knows: calls over XML-RPC.

    master = RosMaster("http://localhost:11311/")
    master.call("registerSubscriber", "/me", "/chatter", "std_msgs/String", "http://here:1234/")

Rules: a call takes `timeout` seconds at most, and has a connection of its own. What does not
answer, or answers unlike a master, is an error that says who was asked and what to do.
"""

from __future__ import annotations

import os
import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from yarpy.carriers.web.xmlrpc import XmlRpc
from yarpy.contact import Contact
from yarpy.data import xmlrpc
from yarpy.errors import (
    AddressError,
    DecodeError,
    LinkClosed,
    LocalProtocolError,
    NoNameServer,
    RemoteProtocolError,
    Timeout,
)
from yarpy.limit import ROS_MASTER_ANSWER
from yarpy.link.begin import handshake
from yarpy.log import readable
from yarpy.names.address import is_loopback, outward_address
from yarpy.route import Route
from yarpy.transports.bind import listening_host

DEFAULT_URI: Final = "http://127.0.0.1:11311/"
TIMEOUT: Final = 5.0  # seconds for a call
VARIABLE: Final = "ROS_MASTER_URI"


@dataclass(frozen=True, slots=True)
class Uri:
    """The address of a server of XML-RPC, or of a service."""

    host: str
    port: int
    path: str = "/"

    @property
    def contact(self) -> Contact:
        """The address alone."""
        return Contact("xmlrpc", "", self.host, self.port)


def parse_uri(text: str, scheme: str = "http") -> Uri:
    """Read `http://host:port/`. Raises AddressError.

    >>> parse_uri("http://robot:11311")
    Uri(host='robot', port=11311, path='/')
    >>> parse_uri("rosrpc://[::1]:4711", "rosrpc").host
    '::1'
    """
    front, _, path = text.removeprefix(f"{scheme}://").partition("/")
    host, colon, number = front.rpartition(":")
    digits = number.isascii() and number.isdigit() and len(number) < 6
    if not (text.startswith(f"{scheme}://") and colon and host and digits) or int(number) > 65535:
        raise AddressError(f'"{readable(text[:80])}" is no address like {scheme}://host:port/')
    return Uri(host.strip("[]"), int(number), f"/{path}")


class RosMaster:
    """A client of the master, which knows who publishes, subscribes and serves, and the parameters.

    `uri` as in ROS_MASTER_URI. Raises AddressError for one that cannot be.
    """

    def __init__(self, uri: str, timeout: float = TIMEOUT) -> None:
        where = parse_uri(uri)
        self.uri = uri_of(where.host, where.port)
        self.timeout = timeout
        self._where = where

    def call(self, method: str, *arguments: Any, timeout: float | None = None) -> Any:
        """The value of an answer. `arguments` begin with the name of who asks.

        Raises NoNameServer (nobody answers there), RemoteProtocolError (what answers is no master),
        LocalProtocolError (the master refuses, and says why).
        """
        seconds = self.timeout if timeout is None else timeout
        try:
            return call(self._where, method, *arguments, timeout=seconds)
        except (LinkClosed, Timeout) as error:
            raise NoNameServer(
                f"no ROS master answers at {self.uri} ({error}): start one with `roscore`, or "
                f"correct {VARIABLE}, or the file of `yarpy detect --ros`"
            ) from error

    def answers(self) -> bool:
        """Return whether the master answers."""
        try:
            self.call("getPid", "/yarpy")
        except (NoNameServer, RemoteProtocolError, LocalProtocolError):
            return False
        return True

    def state(self) -> tuple[list[Any], list[Any], list[Any]]:
        """Topics with their publishers, topics with their subscribers, services with providers, as
        lists of [name, nodes]. Raises as `call`."""
        found = self.call("getSystemState", "/yarpy")
        try:
            publishers, subscribers, services = found
            for name, nodes in (*publishers, *subscribers, *services):
                if not isinstance(name, str) or not all(isinstance(node, str) for node in nodes):
                    raise TypeError(name)
        except (TypeError, ValueError) as error:
            raise self._no_master(found) from error
        return publishers, subscribers, services

    def node(self, name: str) -> Uri | None:
        """Return the address of a node; None if the master knows none of that name. Raises as
        `call`."""
        return self._look_up("lookupNode", name, "http")

    def service(self, name: str, timeout: float | None = None) -> Uri | None:
        """Return the address of a service; None if there is none. Raises as `call`."""
        return self._look_up("lookupService", name, "rosrpc", timeout)

    def _look_up(
        self, method: str, name: str, scheme: str, timeout: float | None = None
    ) -> Uri | None:
        try:
            found = self.call(method, "/yarpy", name, timeout=timeout)
        except LocalProtocolError:
            return None
        try:
            return parse_uri(found, scheme)
        except (AddressError, AttributeError, TypeError) as error:
            raise self._no_master(found) from error

    def _no_master(self, answer: object) -> RemoteProtocolError:
        shown = readable(repr(answer)[:80])
        return RemoteProtocolError(f"what answers at {self.uri} is no ROS master: it says {shown}")

    def __repr__(self) -> str:
        return f"RosMaster({self.uri!r})"


def call(where: Uri, method: str, *arguments: Any, timeout: float = TIMEOUT) -> Any:
    """Call a master or node; the value of its answer.

    Raises LinkClosed, Timeout, RemoteProtocolError (no answer as of ROS), LocalProtocolError (it
    refuses).
    """
    route = Route("", "", f"xmlrpc+path.{where.path.removeprefix('/')}", where.port, where.host)
    carrier, place = XmlRpc(route), uri_of(where.host, where.port)
    driver = handshake.call(where.contact, timeout, ROS_MASTER_ANSWER)
    try:
        carrier.post(driver.stream, xmlrpc.encode_plain_call(method, arguments))
        body = driver.run(carrier.read_response(driver.stream), time.monotonic() + timeout)
    except Timeout as error:
        raise Timeout(f"it did not answer within {timeout:g} s") from error
    except RemoteProtocolError as error:
        raise _no_part(place, str(error)) from error
    finally:
        driver.transport.close()
    try:
        answer = xmlrpc.decode_plain_answer(body)
    except (DecodeError, TypeError, ValueError) as error:
        raise _no_part(place, str(error)) from error
    if not isinstance(answer, list) or len(answer) != 3:
        raise _no_part(place, f"it says {repr(answer)[:80]}")
    code, text, value = answer
    if code != 1:
        raise LocalProtocolError(f"{place} refuses {method}: {readable(str(text)[:300])}")
    return value


def _no_part(place: str, why: str) -> RemoteProtocolError:
    return RemoteProtocolError(
        f"what answers at {place} is no part of ROS: {readable(why[:120])}; is the address right?"
    )


def uri_of(host: str, port: int, scheme: str = "http") -> str:
    """The address of a server, as ROS writes it.

    >>> uri_of("::1", 80)
    'http://[::1]:80/'
    """
    return f"{scheme}://{Contact(host=host, port=port).address}/"


def advertised_host(environment: Mapping[str, str] = os.environ) -> str:
    """The host under which nodes of this computer are known: ROS_HOSTNAME, ROS_IP, or the address
    that leads outward; but of one that no other computer reaches, the loopback."""
    bound = listening_host()
    if is_loopback(bound):
        return bound
    for variable in ("ROS_HOSTNAME", "ROS_IP"):
        if environment.get(variable):
            return environment[variable]
    if bound:
        return bound
    chosen = environment.get("YARP_IP", "")
    found = chosen if chosen.count(".") == 3 else outward_address()
    return "127.0.0.1" if is_loopback(found) else found
