"""Collector: removes names from the name service when their ports are dead.

Rules: a name goes only if its address actively refuses connections, seen `STRIKES` times in a row,
a round apart at least: who has just registered may not listen yet, and many may complain of that
at once; whoever registers it anew begins anew, also at the same address;
a silent host may come back, and what never was a YARP port (no `process` property: a camera, a
robot of another make) is not ours to judge. Ports of this host are left alone while their process
lives; others are probed a few at a time. Of a host that is silent a few ports are tried in a round,
those first that were not silent before, so that thousands of names that somebody gave it delay
nobody's. A number that we handed out and that nobody listens on comes back after `LEASE`, unless
somebody ever did.
"""

from __future__ import annotations

import socket
import threading
import time
from collections import Counter
from collections.abc import Callable
from math import inf
from typing import Final

from yarpy.contact import Contact
from yarpy.data.bottle import Bottle
from yarpy.limit import number_in
from yarpy.log import logger
from yarpy.names.address import local_addresses
from yarpy.nameserver.command import NameService
from yarpy.nameserver.reply import Reply
from yarpy.nameserver.store import Registration
from yarpy.platform.process import lives

log = logger("yarpy.name_server")

INTERVAL: Final = 2.0  # seconds between rounds
STRIKES: Final = 2
PER_SECOND: Final = 25  # connections tried to ports elsewhere
TIMEOUT: Final = 0.5  # seconds for one try
MOST_SILENT: Final = 3  # tries in vain of one host in a round
LEASE: Final = 300.0  # seconds in which a port has to listen on the number that it asked for


class Collector:
    """Watches the names of `service`; `follow` takes the replies to the removal of one."""

    def __init__(
        self,
        service: NameService,
        follow: Callable[[Reply], None],
        own_name: str,
        interval: float = INTERVAL,
        lease: float = LEASE,
    ) -> None:
        self._service = service
        self._follow = follow
        self._own_name = own_name
        self._interval = interval
        self._lease = lease
        self._lent: dict[Registration, float] = {}  # when it is due; inf: it was taken up
        self._strikes: dict[Registration, tuple[int, float]] = {}  # how many, and when the last was
        self._silences: dict[str, int] = {}  # how often each name's port was silent in a row
        self._suspects: set[str] = set()  # reported as unreachable
        self._wake = threading.Event()
        self._closed = False
        self._thread = threading.Thread(target=self._run, name="yarpy collector", daemon=True)
        self._thread.start()

    def suspect(self, name: str) -> None:
        """`name` is reported not to answer: look at it soon."""
        self._suspects.add(name)
        self._wake.set()

    def close(self) -> None:
        """Stop watching."""
        self._closed = True
        self._wake.set()
        self._thread.join(2.0)

    def _run(self) -> None:
        while not self._closed:
            self._wake.wait(self._interval)
            self._wake.clear()
            if not self._closed:
                try:
                    self.look()
                except Exception:
                    log.exception("a round of looking for dead ports failed; the next one comes")

    def look(self) -> None:
        """One round over all names."""
        suspects, self._suspects = self._suspects, set()
        here = set(local_addresses())
        ports, before = self._ports(), self._silences
        self._silences = {one.name: before[one.name] for one, _ in ports if one.name in before}
        self._strikes = {one: self._strikes[one] for one, _ in ports if one in self._strikes}
        silent: Counter[str] = Counter()
        for port, process in sorted(ports, key=lambda port: before.get(port[0].name, 0)):
            if self._closed:
                return
            contact = port.contact
            local = contact.host in here
            if silent[contact.host] >= MOST_SILENT:
                continue
            if contact.name not in suspects:
                if local and process and lives(process):
                    continue
                if not local:
                    time.sleep(1 / PER_SECOND)
            refuses = _refuses(contact)
            if refuses is None:
                silent[contact.host] += 1
                self._silences[contact.name] = self._silences.get(contact.name, 0) + 1
            else:
                self._silences.pop(contact.name, None)
            self._judge(port, bool(refuses))
        self._end_leases()

    def _end_leases(self) -> None:
        """Take back numbers that nobody listens on. Of a host that is silent one is tried."""
        now, silent = time.monotonic(), set[str]()
        self._lent = {one: self._lent.get(one, now + self._lease) for one in self._borrowers()}
        for port, due in self._lent.items():
            if due > now:
                continue
            if self._closed:
                return
            if port.contact.host not in silent and _listens(port.contact, silent):
                self._lent[port] = inf
            else:
                self._remove(port)

    def _borrowers(self) -> list[Registration]:
        """Ports that have a number of ours, and did not say any more."""
        store = self._service.store
        with self._service.lock:
            return [
                port
                for port in store.registrations()
                if port.contact.carrier == "tcp"
                and store.numbers.lent(port.name)
                and not store.values(port.name, "process")
            ]

    def _ports(self) -> list[tuple[Registration, int]]:
        """Registered YARP ports with their process ids."""
        found = []
        with self._service.lock:
            for port in self._service.store.registrations():
                if port.name == self._own_name or port.contact.carrier != "tcp":
                    continue
                process = self._service.store.values(port.name, "process")
                if process:
                    found.append((port, number_in(process[0]) or 0))
        return found

    def _judge(self, port: Registration, refuses: bool) -> None:
        if not refuses:
            self._strikes.pop(port, None)
            return
        now = time.monotonic()
        strikes, last = self._strikes.get(port, (0, -inf))
        if now - last >= self._interval:
            strikes, last = strikes + 1, now
            self._strikes[port] = strikes, last
        if strikes < STRIKES:
            self._suspects.add(port.name)
            return
        self._remove(port)

    def _remove(self, port: Registration) -> None:
        with self._service.lock:
            if self._service.store.registration(port.name) is not port:
                return  # registered anew meanwhile
            reply = self._service.answer(Bottle(["unregister", port.name]))
        self._follow(reply)


def _listens(contact: Contact, silent: set[str]) -> bool:
    """Return whether somebody listens there; hosts that do not even refuse go into `silent`."""
    try:
        socket.create_connection((contact.host, contact.port), TIMEOUT).close()
    except ConnectionRefusedError:
        return False
    except (OSError, UnicodeError):
        silent.add(contact.host)
        return False
    return True


def _refuses(contact: Contact) -> bool | None:
    """Return whether the host itself says that nothing listens there. None: it is silent, which
    proves nothing."""
    try:
        socket.create_connection((contact.host, contact.port), TIMEOUT).close()
    except ConnectionRefusedError:
        return True
    except (OSError, UnicodeError):  # UnicodeError: no host can have such a name
        return None
    return False
