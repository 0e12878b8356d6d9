"""Connections of an application: made as soon as both ports are there, and made again.

Rules: one thread looks at the names that are registered, a few others make connections, so that a
port that does not answer holds up no other. What is there is looked at one connection at a time, so
that watching many costs no more than watching few; a port whose address has changed, and whatever
was touched by a program that has just started, is looked at at once.
"""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import Final

from yarpy.errors import UnknownName, YarpError
from yarpy.kits.launch.application.application import Connection
from yarpy.kits.launch.document.advice import advice
from yarpy.kits.launch.document.problem import NOWHERE
from yarpy.names.base import NameClient
from yarpy.names.default import DEFAULT
from yarpy.network import asking, connection

_QUICK: Final = 0.2  # seconds between looks while something is missing
_SLOW: Final = 1.0
_HURRY: Final = 10.0  # seconds after a change in which looks are quick
_EACH: Final = 0.5  # seconds between two connections that are looked at again
_LEAST: Final = 3.0  # seconds until the same one is
_WORKERS: Final = 4


class Link:
    """A connection and how it is doing: `waiting`, `connected`, `refused`, or `off` while somebody
    wants it to be."""

    def __init__(self, wanted: Connection) -> None:
        self.wanted = wanted
        self.state = "waiting"
        self.detail = ""
        self.made = 0
        """The number of times that it was made."""
        self.busy = False
        self.ends: tuple[str, str] | None = None
        self.looked = 0.0
        self.advised: tuple[str, int] = ("", 0)
        """The port that it waits for and how many there are, when a name like it was looked for."""

    @property
    def settled(self) -> bool:
        """Return whether it is as it should be."""
        return self.state in ("connected", "off")


class Connections:
    """Keeps connections from `start` to `close`."""

    def __init__(self, wanted: Sequence[Connection], names: NameClient | None = None) -> None:
        self.links = [Link(one) for one in wanted]
        self._names = names
        self._over = threading.Event()
        self._wake = threading.Event()
        self._hurry = time.monotonic() + _HURRY
        self._pool = ThreadPoolExecutor(_WORKERS, "yarpy connections")
        self._thread = threading.Thread(
            target=self._run, name="yarpy keep connections", daemon=True
        )

    def start(self) -> None:
        """Begin, if there is anything to keep."""
        if self.links and not self._thread.is_alive():
            self._thread.start()

    def rest(self) -> None:
        """Make no connection until it is taken up."""
        for link in self.links:
            link.state, link.detail = "off", "not made yet"

    def find(self, source: str, target: str) -> Link:
        """Return a connection. Raises UnknownName."""
        for link in self.links:
            if (link.wanted.source, link.wanted.target) == (source, target):
                return link
        raise UnknownName(f"the application has no connection {source} -> {target}")

    def let_go(self, source: str, target: str) -> None:
        """End a connection, and do not make it again. Raises UnknownName, a YarpError."""
        link = self.find(source, target)
        link.state, link.detail = "off", "by hand"
        self._end(link.wanted)

    def take_up(self, source: str, target: str) -> None:
        """Keep a connection that was let go. Raises UnknownName."""
        link = self.find(source, target)
        if link.state == "off":
            link.state, link.detail, link.ends = "waiting", "", None
        self.touch()

    def replace(self, wanted: Sequence[Connection]) -> None:
        """Keep these from now on: what stays is not touched, what is not among them ends."""
        before = {replace(link.wanted, where=NOWHERE): link for link in self.links}
        bare = [replace(one, where=NOWHERE) for one in wanted]
        self.links = [
            before.pop(key) if key in before else Link(one)
            for key, one in zip(bare, wanted, strict=True)
        ]
        for link in before.values():
            link.state = "off"
            with contextlib.suppress(YarpError):  # one of its ports has gone
                self._end(link.wanted)
        self.touch()
        if not self._over.is_set():
            self.start()

    def _end(self, wanted: Connection) -> None:
        if connection.is_connected(wanted.source, wanted.target, names=self._names):
            connection.disconnect(wanted.source, wanted.target, names=self._names)

    def touch(self) -> None:
        """A program has started or ended: look at everything again soon."""
        self._hurry = time.monotonic() + _HURRY
        self._wake.set()

    def close(self) -> None:
        """Stop keeping; end connections between ports that both belong to others."""
        self._over.set()
        self._wake.set()
        if self._thread.is_alive():
            self._thread.join()
        self._pool.shutdown()
        for link in self.links:
            wanted = link.wanted
            if link.made and wanted.source_external and wanted.target_external:
                if wanted.persist:
                    continue
                try:
                    connection.disconnect(wanted.source, wanted.target, names=self._names)
                except YarpError:
                    pass  # one of them is gone

    def _run(self) -> None:
        next_look = 0.0
        while not self._over.is_set():
            self._wake.clear()
            places = self._places()
            now = time.monotonic()
            for link in self.links:
                self._consider(link, places, now)
            if now >= next_look:
                settled = [one for one in self.links if one.state == "connected" and not one.busy]
                oldest = min(settled, key=lambda one: one.looked, default=None)
                if oldest is not None and now - oldest.looked > _LEAST:
                    self._look(oldest)
                next_look = now + _EACH
            missing = not all(one.settled for one in self.links)
            period = _QUICK if missing and now < self._hurry else _SLOW
            self._wake.wait(period)
            self._over.wait(0.02)  # several programs may have started at once

    def _consider(self, link: Link, places: dict[str, str] | None, now: float) -> None:
        if link.busy or places is None or link.state == "off":
            return
        ends = []
        for name in (link.wanted.source, link.wanted.target):
            plain = name.startswith("/") and ":" not in name
            if plain and name not in places:
                self._await(link, name, places, now)
                return
            ends.append(places.get(name, name))
        both = ends[0], ends[1]
        again = link.state != "connected" and now - link.looked > _SLOW
        if both != link.ends or again:
            link.ends = both
            self._look(link)

    def _await(self, link: Link, name: str, places: dict[str, str], now: float) -> None:
        """Say which port is not there; once it has had the time to come, also which one is."""
        link.state, link.ends = "waiting", None
        if now < self._hurry:
            link.advised, link.detail = ("", 0), f"for {name}"
        elif link.advised != (name, len(places)):
            link.advised = name, len(places)
            link.detail = f"for {name}{advice(name, [*places])}"

    def _look(self, link: Link) -> None:
        link.busy = True
        link.looked = time.monotonic()
        try:
            self._pool.submit(self._make, link)
        except RuntimeError:
            link.busy = False  # the pool was closed

    def _make(self, link: Link) -> None:
        wanted = link.wanted
        source, target, names = wanted.source, wanted.target, self._names
        try:
            if self._over.is_set():
                return
            if not connection.is_connected(source, target, names=names):
                if link.state == "off":
                    return
                link.state = "waiting"
                connection.join(source, target, wanted.carrier, names=names)
                link.made += 1
                self._dress(wanted)
            if link.state == "off":  # meanwhile
                self._end(wanted)
            else:
                link.state, link.detail = "connected", ""
        except Exception as error:
            kind = "" if isinstance(error, YarpError) else f"{type(error).__name__}: "
            if link.state != "off":
                link.state, link.detail = "refused", f"{kind}{error}"
        finally:
            link.busy = False

    def _dress(self, wanted: Connection) -> None:
        """Set its priorities, and have the server remember it."""
        from yarpy.kits.launch.application.quality import read
        from yarpy.network import qos

        if wanted.persist:
            there = f"{wanted.carrier or 'tcp'}:/{wanted.target}"
            asking.ask_server(self._names, ["subscribe", wanted.source, there])
        if wanted.source_qos or wanted.target_qos:
            qos.grant(
                wanted.source,
                wanted.target,
                sender=read(wanted.source_qos) if wanted.source_qos else None,
                receiver=read(wanted.target_qos) if wanted.target_qos else None,
                names=self._names,
            )

    def _places(self) -> dict[str, str] | None:
        """Return the addresses of all ports, None if no name server answers."""
        try:
            found = (self._names or DEFAULT.current()).list()
        except YarpError as error:
            for link in self.links:
                if not link.settled:
                    link.detail = str(error)
            return None
        return {one.name: one.address for one in found}
