"""The client of a YARP name server, ours or that of C++.

Rules: safe to use from any thread (`idle_lines.py`). Old style
commands go over `NAME_SERVER` lines, several over one connection. What C++ answers with a Bottle
(`bot ...`, `subscribe`, `topic` ...) goes over `CONNACK`, where the end of a reply can be seen. A
connection that turns out to be dead (the server was restarted) is replaced once before NoNameServer
is raised; every command may be repeated without harm.
"""

from __future__ import annotations

import contextlib
import math
import os
import socket
import time
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Any, Final, Literal, TypeVar

from yarpy import scope
from yarpy.config.configuration import namespaces
from yarpy.contact import Contact
from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text
from yarpy.errors import (
    AccessRefused,
    AddressError,
    LinkClosed,
    NoNameServer,
    PortClosed,
    RemoteProtocolError,
    Timeout,
    YarpError,
)
from yarpy.names.base import Contacts, Strings, Values
from yarpy.names.idle_lines import IdleLines
from yarpy.names.line import Gone, Line, LineSocket, acknowledged, old_style
from yarpy.names.registration_line import END, parse_registration
from yarpy.transports.peer_timeout import notice_death
from yarpy.transports.tcp import connected
from yarpy.transports.tls_setting import required
from yarpy.wire.framing import refused

TIMEOUT: Final = 5.0  # seconds for a command
WHO = 1.0  # seconds to find out what listens there when it does not answer
SHARE: Final = 0.8  # of the time of a call, for the answer; the rest is for finding that out
FAIR: Final = 0.1  # seconds in which a server that is there answers; less says nothing of it

_FAILED = ("[fail]", "fail")
_BOTTLE_VERBS = frozenset({"announce", "subscribe", "unsubscribe", "topic", "untopic", "type"})

Prepare = Callable[[socket.socket], None]
_T = TypeVar("_T")


class YarpNameClient:
    """A `NameClient` that asks the name server at `host`:`port`.

    timeout: seconds for a whole command; less, where the call under way has less left.
    own_host: what to register when `register` is given no host (`YARP_IP`); normally "", and
    the server takes the address it sees.
    prepare: called with each new connection before anything else (the handshake of auth.conf).
    """

    allocates = True

    def __init__(
        self,
        host: str = "",
        port: int = 0,
        timeout: float = TIMEOUT,
        *,
        own_host: str = "",
        prepare: Prepare | None = None,
    ) -> None:
        if not (host and port):
            raise TypeError(
                "which name server? YarpNameClient(host, port) asks that one; ports that are given "
                "no `names` ask the one that `yarpy where` shows"
            )
        self.host = host
        self.port = port
        self.timeout = timeout
        self.own_host = own_host
        self._prepare = prepare
        self._idle = IdleLines()

    # --- the NameClient

    def register(
        self,
        name: str,
        carrier: str | None = None,
        host: str | None = None,
        port: int | None = None,
        port_type: str | None = None,
    ) -> Contact:
        words: list[str | int] = ["register", name]
        extra = (carrier, host or self.own_host or None, port or None, port_type or None)
        if any(item is not None for item in extra):
            words += [carrier or "...", extra[1] or "..."]
            words.append(port or -1)  # what C++ sends for "any"
            if port_type:
                words.append(port_type)
        try:
            lines = self.command(*words)
        except AccessRefused as error:
            raise AddressError(f'"{name}" is not registered: {error}') from error
        contact = parse_registration(lines[0]) if lines else None
        if contact is None:
            if not lines:  # a name server gives at least a reason
                raise self._ordinary()
            reason = lines[0].removeprefix("error ")
            raise AddressError(f'the name server at {self.address} refused "{name}": {reason}')
        return contact

    def unregister(self, name: str) -> None:
        self.command("unregister", name)

    def query(self, name: str) -> Contact | None:
        if "acked" in self._idle.kinds:  # one connection less to make
            words = ["query", name]
            lines = [*map(plain_text, self.request(words))]
        else:
            lines = self.command("query", name)
        return parse_registration(lines[0]) if lines else None

    def announce(self, name: str, ok: bool = True) -> None:
        self.command("announce", name, *([] if ok else [0]))

    def set(self, name: str, key: str, *values: str | int | float) -> Strings:
        return list(map(plain_text, self.request(["bot", "set", name, key, *values])))

    def get(self, name: str, key: str) -> Strings:
        return list(map(plain_text, self.request(["bot", "get", name, key])))

    def introduce(self, name: str, properties: Mapping[str, Values]) -> None:
        # One after the other, each would wait for the server to wake up.
        quoted = _text(name)
        texts = [
            f"bot set {quoted} {_text(key)} {_text(*values)}" for key, values in properties.items()
        ]
        texts.append(f"announce {quoted}")
        for lines in self._ask("acked", lambda line: acknowledged(line, *texts)):
            if lines and lines[0].startswith(_FAILED):
                self._succeeded(_bottle(lines))

    def list(self, prefix: str | None = None) -> Contacts:
        lines = self.command("list", prefix) if prefix else self.command("list")
        contacts = [contact for contact in map(parse_registration, lines) if contact is not None]
        if not contacts and not prefix:  # a name server lists at least itself
            raise self._ordinary()
        return contacts

    def close(self) -> None:
        self._idle.close()

    def __enter__(self) -> YarpNameClient:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()

    # --- any command

    def command(self, *words: str | int | float) -> Strings:
        """The lines of an old style reply, without the end line; none for `announce`.

        Raises AddressError for a command whose reply is a Bottle (use `request`): its end line
        would never come; AccessRefused.
        """
        verb = str(words[0]) if words else ""
        if not words or verb == "bot" or (verb in _BOTTLE_VERBS and verb != "announce"):
            raise AddressError(f'"{verb or "nothing"}" is answered with a Bottle: use request()')
        text = Bottle(words).to_text()
        lines = self._ask("lines", lambda line: old_style(line, text))
        self._admitted(lines[0].removeprefix("error ") if lines else "")
        return lines

    def request(self, command: Sequence[Any]) -> Bottle:
        """Ask anything and get one Bottle: `bot ...`, `subscribe`, `topic`, `type` ...

        An old style reply comes as a Bottle of its lines, without the end line.
        """
        text = Bottle(command).to_text()
        reply = _bottle(self._ask("acked", lambda line: acknowledged(line, text))[0])
        self._succeeded(reply)
        return reply

    def connect(self) -> socket.socket:
        """A bare connection to the server, on which nothing is said, nor TLS begun: it ends when
        the server does.

        Raises NoNameServer.
        """
        return self._open("lines", bare=True).connection

    @property
    def proves_key(self) -> bool:
        """Return whether each connection begins with a proof (auth.conf)."""
        return self._prepare is not None

    def alive(self) -> bool:
        """Return whether something listens at the server's address."""
        try:
            line = self._open("lines")
        except NoNameServer:
            return False
        line.close()
        return True

    # --- inside

    def _admitted(self, said: str) -> None:
        """Raise AccessRefused if that is what the server said."""
        if (error := refused(said.encode())) is not None:
            raise AccessRefused(f"the name server at {self.address} says: {error}")

    def _succeeded(self, reply: Bottle) -> None:
        """Raise AccessRefused if that is what a Bottle says."""
        if len(reply) == 2 and reply[0] == "fail":
            self._admitted(plain_text(reply[1]))

    @property
    def address(self) -> str:
        """Host and number of the server, as they are written."""
        return Contact(host=self.host, port=self.port).address

    def _ask(self, kind: Literal["lines", "acked"], talk: Callable[[Line], _T]) -> _T:
        seconds = self._time_limit()
        until = time.monotonic() + seconds
        try:
            line = self._idle.borrow(kind)
            if line is not None:
                try:
                    return self._talk(line, talk, until)
                except Gone:
                    pass  # perhaps the server was restarted: try once more on a new connection
            try:
                return self._talk(self._open(kind, until), talk, until)
            except Gone as error:
                raise self._nobody(f"hung up: {error}") from error
        except TimeoutError as error:
            if isinstance(error, YarpError):  # the time was over before anybody was asked
                raise
            if seconds < FAIR:
                raise self._late() from error
            raise self._silent(seconds) from error
        except NoNameServer as error:
            if seconds < FAIR and isinstance(error.__cause__, TimeoutError):
                raise self._late() from error
            raise

    def _time_limit(self) -> float:
        """The seconds for a command. Raises Timeout if the call under way has none left."""
        whole = scope.left()
        return self.timeout if whole == math.inf else min(self.timeout, SHARE * whole)

    def _talk(self, line: Line, talk: Callable[[Line], _T], until: float) -> _T:
        line.until = until
        try:
            with scope.waking(line.wake):
                reply = talk(line)
        except BaseException:
            line.close()
            raise
        self._idle.give_back(line)
        return reply

    def _open(
        self, kind: Literal["lines", "acked"], until: float | None = None, bare: bool = False
    ) -> Line:
        if until is None:
            until = time.monotonic() + self._time_limit()
        try:
            connection = connected(self.host, self.port, until - time.monotonic(), LineSocket)
        except (Timeout, PortClosed):
            raise
        except (OSError, AddressError) as error:
            raise self._nobody(str(error)) from error
        line = Line(connection, kind)
        line.until = until
        try:
            with scope.waking(line.wake):
                self._greet(line, bare)
        except (Timeout, PortClosed):
            line.close()
            raise
        except (Gone, OSError, LinkClosed, RemoteProtocolError) as error:
            line.close()
            raise self._nobody(str(error)) from error
        except BaseException:
            line.close()
            raise
        return line

    def _greet(self, line: Line, bare: bool) -> None:
        """Say what comes before any command; with `bare` not in TLS."""
        connection = line.connection
        connection.settimeout(max(0.001, line.until - time.monotonic()))
        with contextlib.suppress(OSError):
            connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        notice_death(connection)
        if required() and not bare:
            line.connection = connection = _in_tls(connection, self.host)
        if self._prepare is not None:
            self._prepare(connection)
        if line.kind == "acked":
            line.send(b"CONNACK admin\r\n")
            line.line()  # "Welcome admin"

    def _late(self) -> Timeout:
        return Timeout(f"the time was over before the name server at {self.address} answered")

    def _silent(self, seconds: float) -> NoNameServer:
        """The error for a server that accepts but was silent: perhaps it is no name server."""
        found: str | None = None
        with contextlib.suppress(Gone, OSError, YarpError):
            line = self._open("acked", time.monotonic() + scope.left(WHO))
            try:
                line.send(b"*\r\n")
                found = line.line()  # This is /name at tcp://host:port/
            finally:
                line.close()
        if found is not None and found.startswith("This is /"):
            name = found.split()[2]
            if name not in namespaces(os.environ):
                return self._ordinary(name)
            why = f"was silent for {seconds:.2g} s: its computer is busy, or it is; try again"
            return NoNameServer(f"the name server at {self.address} is there, but {why}")
        try:
            connected(self.host, self.port, scope.left(WHO)).close()
        except (OSError, YarpError):  # it has gone meanwhile
            return self._nobody(f"did not answer within {seconds:.2g} s")
        return NoNameServer(
            f"what listens at {self.address} did not answer within {seconds:.2g} s, nor say who it "
            "is: a name server that was stopped (`fg`, or kill -CONT, lets it go on) or that hangs "
            "(end it, and start `yarpy server`), or another program (say where the server is with "
            "YARPY_SERVER=HOST:PORT or `yarpy conf HOST PORT`)"
        )

    def _ordinary(self, name: str = "") -> NoNameServer:
        return NoNameServer(
            f"what listens at {self.address} is an ordinary port{name and ', ' + name}, not a name "
            "server; correct YARPY_SERVER, or the file of `yarpy conf`"
        )

    def _nobody(self, reason: str) -> NoNameServer:
        return NoNameServer(
            f"no name server answers at {self.address} ({reason}): start one with `yarpy server`, "
            "or say where it is with YARPY_SERVER=HOST:PORT or `yarpy conf HOST PORT`, "
            "or look for one with `yarpy detect --write`"
        )


@lru_cache(maxsize=64, typed=True)
def _text(*words: str | int | float) -> str:
    """Words as a command has them. What all ports of a program say is spelled once."""
    return Bottle(words).to_text()


def _bottle(lines: list[str]) -> Bottle:
    """The one Bottle that a reply is, or a Bottle of its old style lines."""
    return Bottle(lines[:-1]) if lines[-1:] == [END] else Bottle.from_text("\n".join(lines))


def _in_tls(connection: socket.socket, host: str) -> socket.socket:
    """The same connection in TLS. Raises RemoteProtocolError."""
    from yarpy.transports.tls import client_context, explained

    try:
        return client_context().wrap_socket(connection, server_hostname=host)
    except TimeoutError:
        raise
    except OSError as error:
        raise RemoteProtocolError(explained(error)) from error
