"""The ports that a recorder wants: found in the network, connected, and connected again.

Rules: one thread looks twice a second; each connection is made in a thread of its own, so that a
silent program keeps nobody waiting. What cannot be connected is tried again, less and less often,
and at once when its address changes. With a pattern or `every`, ports that only ask or answer
(rpc) are left alone: a recorder among those that they ask would have to answer.
"""

from __future__ import annotations

import os
import re
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Final

from yarpy.config.configuration import ROOT, namespaces
from yarpy.contact import Contact, check_name, parse_contact
from yarpy.data.bottle import Property
from yarpy.errors import LocalProtocolError, NoNameServer, YarpError
from yarpy.names.base import NameClient
from yarpy.names.default import DEFAULT
from yarpy.network.asking import admin
from yarpy.network.connection import disconnect
from yarpy.network.remote import connect
from yarpy.network.sampling import can_answer
from yarpy.network.traffic import pairs
from yarpy.platform.folders import conf_directory
from yarpy.port.base import BasePort

PAUSE: Final = 0.5  # seconds between looks
TIMEOUT: Final = 3.0  # seconds for a port to answer
LONGEST: Final = 10.0  # seconds until what could not be connected is tried again
LEAVING: Final = 2.0  # seconds for all ports to send what they have written, at the end
AT_ONCE: Final = 8  # connections that are being made


@dataclass(frozen=True)
class PortSelection:
    """A choice of ports: `names`, those that contain a match of `pattern`, or `every` one; not
    those that contain a match of `exclude`, unless they are named. Raises LocalProtocolError for
    what is no regular expression, AddressError for what can never be the name of a port."""

    names: tuple[str, ...] = ()
    every: bool = False
    pattern: str = ""
    exclude: str = ""
    _found: re.Pattern[str] | None = field(init=False, repr=False, compare=False, default=None)
    _left: re.Pattern[str] | None = field(init=False, repr=False, compare=False, default=None)

    def __post_init__(self) -> None:
        for name in self.names:
            if not parse_contact(name).host and ":/" not in name:  # a carrier, a ROS topic
                check_name(name)
        object.__setattr__(self, "_found", compiled(self.pattern))
        object.__setattr__(self, "_left", compiled(self.exclude))

    @property
    def searching(self) -> bool:
        """Return whether ports are to be found that are not named."""
        return self.every or self._found is not None

    def matches(self, name: str) -> bool:
        """Return whether a port that is not named is wanted."""
        if self._left is not None and self._left.search(name):
            return False
        return self.every or (self._found is not None and bool(self._found.search(name)))


def compiled(pattern: str) -> re.Pattern[str] | None:
    """Return a regular expression, None for "". Raises LocalProtocolError."""
    try:
        return re.compile(pattern) if pattern else None
    except re.error as error:
        raise LocalProtocolError(
            f'"{pattern}" is no regular expression: {error}; all below /icub: ^/icub/'
        ) from error


class _Try:
    """A port that is to be connected, and what is known of it."""

    __slots__ = ("address", "after", "dialled", "pause", "running", "unfit")

    def __init__(self) -> None:
        self.address = ""
        self.after = 0.0  # as of time.monotonic
        self.pause = PAUSE
        self.running = False
        self.dialled = False  # it may have a connection that has not begun at our end
        self.unfit = False  # it only asks or answers


class Subscriptions:
    """Keeps `port` connected with what is wanted, until it is closed.

    tell: called with a line for people when something is in the way, once for each reason.
    """

    def __init__(
        self,
        port: BasePort,
        wanted: PortSelection,
        carrier: str = "",
        names: NameClient | None = None,
        tell: Callable[[str], object] = lambda line: None,
    ) -> None:
        self._port = port
        self._wanted = wanted
        self._carrier = carrier
        self._names = names
        self._tell = tell
        self._tries: dict[str, _Try] = {}
        self._told: dict[str, str] = {}
        self._process = os.getpid()
        self._closing = threading.Event()
        self._room = threading.BoundedSemaphore(AT_ONCE)
        self._thread = threading.Thread(
            target=self._run, name=f"yarpy record {port.name}", daemon=True
        )
        self._thread.start()

    @property
    def waiting(self) -> list[str]:
        """Return the named ports that are not connected."""
        there = self._connected()
        return [name for name in self._wanted.names if name not in there]

    def close(self, timeout: float | None = None) -> None:
        """Look no more, and have every port that is connected send what it has written, and end.

        timeout: seconds for a look that has begun, None: until it is over. As many, and LEAVING at
        most, are for the ports: of one that does not answer comes what is here already.
        """
        self._closing.set()
        self._thread.join(timeout)
        if os.getpid() != self._process:
            return  # the connections are those of the parent, who goes on
        until = time.monotonic() + (LEAVING if timeout is None else min(timeout, LEAVING))
        dialled = {name for name, known in [*self._tries.items()] if known.dialled}
        for name in sorted(self._connected() | dialled):
            left = until - time.monotonic()
            if left <= 0:
                return
            with suppress(YarpError):
                disconnect(name, self._port.name, names=self._names, timeout=min(left, LEAVING / 2))

    def _run(self) -> None:
        while not self._closing.is_set():
            try:
                self._look()
                self._once("", "")
            except NoNameServer as error:
                self._once("", f"no name server answers, what is connected is recorded: {error}")
            except YarpError as error:
                self._once("", str(error))
            self._closing.wait(PAUSE)

    def _connected(self) -> set[str]:
        return {link.source for link in self._port.inputs}

    def _look(self) -> None:
        names = self._names or DEFAULT.current()
        listed = {one.name: one for one in names.list() if can_answer(one)}
        there = self._connected()
        for name in self._wanted.names:
            if name not in there:
                self._attempt(name, listed.get(name), named=True)
        if self._wanted.searching:
            # A name server is a port, too; it sends its clients what they have asked for.
            others = {self._port.name, ROOT, *namespaces(os.environ, conf_directory(os.environ))}
            for name, contact in listed.items():
                if name not in there and name not in others and self._wanted.matches(name):
                    self._attempt(name, contact, named=False)
        for name in [name for name in self._tries if name not in listed]:
            if name not in self._wanted.names:
                del self._tries[name]

    def _attempt(self, name: str, contact: Contact | None, named: bool) -> None:
        """Connect a port, if it is time to."""
        known = self._tries.setdefault(name, _Try())
        address = "" if contact is None else contact.address
        if address != known.address:
            known.address, known.after, known.pause, known.unfit = address, 0.0, PAUSE, False
        if contact is None:
            self._once(name, f"{name} is not there yet: it is recorded when it comes")
            return
        if known.running or known.unfit or time.monotonic() < known.after:
            return
        if not self._room.acquire(timeout=PAUSE):
            return
        known.running = True
        threading.Thread(
            target=self._connect, args=(name, known, named), name=f"yarpy dial {name}", daemon=True
        ).start()

    def _connect(self, name: str, known: _Try, named: bool) -> None:
        try:
            if not named and not can_be_heard(name, self._names):
                known.unfit = True
            elif not self._closing.is_set():
                known.dialled = True
                connect(name, self._port.name, self._carrier, names=self._names)
                self._once(name, "")
                known.pause = PAUSE
        except YarpError as error:
            if not self._port.closed:
                self._once(name, f"{name} cannot be recorded yet: {error}")
            known.pause = min(2 * known.pause, LONGEST)
        finally:
            known.after = time.monotonic() + known.pause
            known.running = False
            self._room.release()

    def _once(self, name: str, line: str) -> None:
        """Tell a reason that was not told before."""
        if self._told.get(name, "") != line:
            self._told[name] = line
            if line:
                self._tell(line)


def can_be_heard(name: str, names: NameClient | None = None) -> bool:
    """Return whether a port sends to whoever is connected, as far as it says. Raises as `admin`."""
    told = Property.from_bottle(admin(name, "prop", "get", name, names=names, timeout=TIMEOUT))
    port = told.get("port")
    if not isinstance(port, dict):
        port = Property.from_bottle(pairs(port)) if isinstance(port, list) else {}
    return not port.get("is_rpc") and port.get("is_output", 1) != 0
