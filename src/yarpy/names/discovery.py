"""Finding a name server by multicast (`yarp detect`), and being found.

Rules: the datagram codec is pure. A server is asked by the name of its namespace and answers to
the whole group with the first line of its reply. Every member of the group receives everything, so
a malformed datagram is skipped silently.

    offset 0   uint32 LE   CRC-32 of the bytes from 8 on
    offset 4   int32 LE    number of the packet in its message; always 0 here
    offset 8   one line of text ended by LF
"""

from __future__ import annotations

import contextlib
import selectors
import socket
import struct
import threading
import time
import zlib
from collections.abc import Callable, Iterable

from yarpy.contact import Contact
from yarpy.errors import DecodeError
from yarpy.limit import DISCOVERY_DATAGRAM
from yarpy.names.registration_line import PREFIX, parse_registration
from yarpy.threads import Thread

GROUP = "224.2.1.1"
MOST = 100  # servers that are told of

_HEADER = struct.Struct("<Ii")


# --- the datagram


def encode_datagram(line: str) -> bytes:
    """A line of text as a datagram; the LF is added here."""
    body = line.encode("utf-8", "surrogateescape") + b"\n"
    return _HEADER.pack(zlib.crc32(body), 0) + body


def decode_datagram(datagram: bytes | memoryview) -> str:
    """The line in a datagram, without its end. Raises DecodeError for all that is not one."""
    if len(datagram) < _HEADER.size + 1:
        raise DecodeError(f"a discovery datagram of only {len(datagram)} bytes")
    crc, number = _HEADER.unpack_from(datagram)
    body = bytes(datagram[_HEADER.size :])
    if number != 0:
        raise DecodeError(f"packet number {number} in a discovery datagram")
    if crc != zlib.crc32(body):
        raise DecodeError("wrong checksum of a discovery datagram")
    line, end, _ = body.partition(b"\n")
    if not end:
        raise DecodeError("no end of line in a discovery datagram")
    return line.rstrip(b"\r").decode("utf-8", "surrogateescape")


# --- asking


def search(
    namespace: str = "/root",
    port: int = 10000,
    *,
    timeout: float = 0.5,
    tries: int = 3,
    group: str = GROUP,
) -> Contact | None:
    """Ask the group which server has `namespace`; None when none answers.

    port: `YARP_PORT_RANGE` or 10000, whatever port the server itself listens on.
    timeout: seconds to wait after each of `tries` questions.
    """
    question = encode_datagram(f"{PREFIX}query {namespace}")
    with _group_socket(group, port) as listener, _sender() as sender:
        for _ in range(tries):
            with contextlib.suppress(OSError):  # there may be a route a moment later
                sender.sendto(question, (group, port))
            deadline = time.monotonic() + timeout
            while (left := deadline - time.monotonic()) > 0:
                listener.settimeout(left)
                try:
                    contact = parse_registration(decode_datagram(listener.recv(DISCOVERY_DATAGRAM)))
                except (DecodeError, OSError):
                    continue  # others talk in this group too, and our own question comes back
                if contact is not None and contact.name == namespace:
                    return contact
    return None


def search_all(
    namespaces: Iterable[str], port: int = 10000, *, timeout: float = 0.5, group: str = GROUP
) -> list[Contact]:
    """Every server that answers for one of `namespaces`, which is its contact's name. Raises
    OSError when this computer has no multicast."""
    asked = set(namespaces)
    found: list[Contact] = []
    with _group_socket(group, port) as listener, _sender() as sender:
        for namespace in sorted(asked):
            with contextlib.suppress(OSError):
                sender.sendto(encode_datagram(f"{PREFIX}query {namespace}"), (group, port))
        deadline = time.monotonic() + timeout
        while (left := deadline - time.monotonic()) > 0 and len(found) < MOST:
            listener.settimeout(left)
            try:
                contact = parse_registration(decode_datagram(listener.recv(DISCOVERY_DATAGRAM)))
            except (DecodeError, OSError):
                continue  # as above
            if contact is not None and contact.name in asked and contact not in found:
                found.append(contact)
    return found


# --- answering

Answer = Callable[[str], str | None]


class Responder:
    """Answers questions of the group in a thread of its own, from `start` to `close`.

    `answer` gets a command such as `query /root` and gives the first line of the reply, or None
    to stay silent. It is called in the responder's thread.
    """

    def __init__(self, answer: Answer, port: int = 10000, *, group: str = GROUP) -> None:
        self.answer = answer
        self.port = port
        self.group = group
        self._wake: socket.socket | None = None
        self._thread: threading.Thread | None = None

    def start(self) -> None:
        """Join the group. Raises OSError when this computer has no multicast."""
        listener = _group_socket(self.group, self.port)
        listener.setblocking(False)  # what made it readable may be a broken datagram
        self._wake, sleeper = socket.socketpair()
        self._thread = Thread(
            target=self._run, args=(listener, sleeper), name=f"discovery:{self.port}", daemon=True
        )
        self._thread.start()

    def close(self) -> None:
        """Leave the group and end the thread."""
        if self._thread is None or self._wake is None:
            return
        self._wake.close()
        self._thread.join(2.0)
        self._thread = self._wake = None

    def __enter__(self) -> Responder:
        self.start()
        return self

    def __exit__(self, *details: object) -> None:
        self.close()

    def _run(self, listener: socket.socket, sleeper: socket.socket) -> None:
        with listener, sleeper, _sender() as sender, selectors.DefaultSelector() as selector:
            selector.register(listener, selectors.EVENT_READ)
            selector.register(sleeper, selectors.EVENT_READ)
            while all(key.fileobj is listener for key, _ in selector.select()):
                try:
                    reply = respond(listener.recv(DISCOVERY_DATAGRAM), self.answer)
                    if reply is not None:
                        sender.sendto(reply, (self.group, self.port))
                except OSError:
                    continue  # a lost answer: the client asks again


def respond(datagram: bytes, answer: Answer) -> bytes | None:
    """The datagram to send back, or None for what is not a question to a name server."""
    try:
        line = decode_datagram(datagram)
    except DecodeError:
        return None
    if not line.startswith(PREFIX):
        return None
    reply = answer(line.removeprefix(PREFIX))
    if reply is None:
        return None
    return encode_datagram(reply.replace("\n", " ").replace("\r", " "))


# --- sockets


def _group_socket(group: str, port: int) -> socket.socket:
    """A socket in the group, bound to the group's own address where the system allows."""
    listener = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        if hasattr(socket, "SO_REUSEPORT") and not hasattr(socket, "SO_DOMAIN"):
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)  # the BSDs need it
        try:
            listener.bind((group, port))
        except OSError:
            listener.bind(("", port))
        member = socket.inet_aton(group)
        try:
            listener.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, member + b"\0\0\0\0")
        except OSError:  # no default route: loopback at least
            listener.setsockopt(
                socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, member + socket.inet_aton("127.0.0.1")
            )
    except OSError:
        listener.close()
        raise
    return listener


def _sender() -> socket.socket:
    sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_LOOP, 1)
    return sender
