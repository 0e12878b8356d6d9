"""Sampling: ask the ports of a network how they are doing, once or again and again.

    sampler = Sampler()
    snapshot = sampler.look()            # now; again later, with rates in between
    sampler.close()

Rules: only the administrative side of ports is asked, in parallel, each with a time limit; so C++
ports answer too, with what they know. A Sampler keeps one connection to each port, which makes a
look cheap for both (a fraction of a millisecond); a port that was silent is left alone for a while.
An answer has a size limit. What is asked changes nothing.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import Final

from yarpy.contact import Contact
from yarpy.data.bottle import Bottle, Property
from yarpy.data.text import plain_text
from yarpy.data.value import Vocab
from yarpy.errors import (
    AccessRefused,
    LinkClosed,
    Timeout,
    UnknownName,
    WrongPort,
    YarpError,
)
from yarpy.limit import SAMPLE_ANSWER, SAMPLE_ITEMS
from yarpy.link.begin.handshake import greet
from yarpy.link.ending import moment
from yarpy.link.send.outbound import Outbound
from yarpy.names.base import NameClient
from yarpy.names.default import DEFAULT, secret
from yarpy.network import qos
from yarpy.network.asking import confirmed, query
from yarpy.network.traffic import (
    End,
    Flow,
    PortState,
    Snapshot,
    State,
    pairs,
    read,
    read_port,
    side_of,
)
from yarpy.port.connect import probe
from yarpy.qos import tos_of
from yarpy.route import Route
from yarpy.wire.message import ADMIN, Packet

AT_ONCE: Final = 16  # ports asked at the same time
TIMEOUT: Final = 1.0  # seconds for a port's answer
REST: Final = 5.0  # seconds for which a port that did not answer is left alone

Told = tuple[str, str, str, End]  # side, source, target, counters


class Line:
    """One connection to the administrative side of a port, dialled when made.

    `urgent`: its packets and those of the answers come before all others, for whoever has to be
    heard where a link is full; it is a word of its own for the port. Raises LinkClosed, Timeout,
    RemoteProtocolError.
    """

    def __init__(self, contact: Contact, timeout: float = TIMEOUT, urgent: str = "") -> None:
        self.contact = contact
        route = Route(urgent or "admin", contact.name or f"/{contact.address}", "tcp")
        driver, carrier = greet(contact, route, key=secret(), limit=SAMPLE_ANSWER, timeout=timeout)
        self._link = Outbound(driver, carrier)
        if urgent and sys.platform != "win32":  # which marks no packets for a program
            level = tos_of("CRIT")
            try:
                driver.transport.set_dscp(level)
                self.ask("prop", "set", urgent, ["qos", [["tos", level]]], timeout=timeout)
            except BaseException:
                self.close()
                raise

    def ask(self, *words: object, timeout: float = TIMEOUT) -> Bottle:
        """The answer to an administrative question. Raises LinkClosed, Timeout, DecodeError."""
        reply = self._link.call(Packet(list(words), key=ADMIN), moment(timeout))
        return Bottle() if reply is None else reply.as_(Bottle)

    def close(self) -> None:
        """Hang up."""
        self._link.driver.transport.close()


class Sampler:
    """Asks ports again and again. `only`: the names that matter, None for all that are registered.
    `urgent`: as for a Line.

    Not for several threads at once.
    """

    def __init__(
        self,
        names: NameClient | None = None,
        only: Iterable[str] | None = None,
        timeout: float = TIMEOUT,
        urgent: str = "",
    ) -> None:
        self._urgent = urgent
        self._names = names
        self._only = None if only is None else list(dict.fromkeys(only))
        self._timeout = timeout
        self._lines: dict[str, Line] = {}
        self._known: dict[str, PortState] = {}
        self._resting: dict[str, float] = {}  # until when, of time.monotonic
        self._counted: dict[tuple[str, str], tuple[float, int, int]] = {}

    def look(self) -> Snapshot:
        """Ask all ports. Raises NoNameServer."""
        contacts = self._contacts()
        for name in self._known.keys() - {one.name for one in contacts}:
            self._forget(name)
        snapshot = Snapshot(time.time())
        with ThreadPoolExecutor(AT_ONCE) as pool:
            for state, told in pool.map(self._ask, contacts):
                snapshot.ports[state.name] = state
                snapshot.add(state.name, told)
        snapshot.unite()
        snapshot.flows = {key: snapshot.flows[key] for key in sorted(snapshot.flows)}
        self._count(snapshot)
        return snapshot

    def ask(self, port: str, *words: object) -> Bottle:
        """The answer of a port to any administrative question. Raises UnknownName, WrongPort,
        LinkClosed, Timeout."""
        line = self._lines.get(port)
        if line is not None:
            try:
                return line.ask(*words, timeout=self._timeout)
            except LinkClosed:
                self._lines.pop(port).close()
        line = Line(confirmed(port, self._names, timeout=self._timeout), self._timeout,
                    self._urgent)  # fmt: skip
        self._lines[port] = line
        return line.ask(*words, timeout=self._timeout)

    def extend(self, names: Iterable[str]) -> None:
        """Ask these from now on as well, where not all are asked anyway."""
        if self._only is not None:
            self._only = list(dict.fromkeys([*self._only, *names]))

    def close(self) -> None:
        """Hang up everywhere."""
        for name in list(self._lines):
            self._forget(name)

    def __enter__(self) -> Sampler:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()

    def _contacts(self) -> list[Contact]:
        names = self._names or DEFAULT.current()
        if self._only is None:
            found = [one for one in names.list() if one.name.startswith("/")]
        else:
            queried = (query(name, names) for name in self._only)
            found = [replace(one, name=one.label) for one in queried if one is not None]
        return list({one.name: one for one in found}.values())

    def _ask(self, contact: Contact) -> tuple[PortState, list[Told]]:
        """One port. Whatever it does costs it its place in this look, and no more."""
        state = self._known.get(contact.name)
        if state is None or state.contact != contact:
            self._forget(contact.name)
            state = self._known[contact.name] = PortState(contact.name, contact)
        state = replace(state)  # the one of the last look stays as it was
        self._known[contact.name] = state
        if not can_answer(contact) or self._resting.get(contact.name, 0.0) > time.monotonic():
            return state, []
        started = time.perf_counter()
        try:
            told = self._ask_again(state)
        except (YarpError, OSError) as error:
            self._forget(contact.name, keep=True)
            state.state, state.error = state_of(error), str(error)
            if state.state in ("silent", "unreachable"):
                self._resting[contact.name] = time.monotonic() + REST
            return state, []
        state.state, state.error = "answers", ""
        state.answer_time = time.perf_counter() - started
        return state, told

    def _ask_again(self, state: PortState) -> list[Told]:
        """Over the connection that we have, or a new one if that has ended meanwhile."""
        line = self._lines.get(state.name)
        if line is not None:
            try:
                return ends_of(line, state, self._timeout)
            except LinkClosed:
                line.close()
        self._lines[state.name] = line = Line(state.contact, self._timeout, self._urgent)
        reply = line.ask("prop", "get", state.name, timeout=self._timeout)
        if reply and reply[0] == Vocab("fail"):  # as to any name that is not its own
            raise WrongPort(f'another port than "{state.name}" listens at {state.contact.address}')
        read_port(state, reply)
        return ends_of(line, state, self._timeout)

    def _forget(self, name: str, keep: bool = False) -> None:
        line = self._lines.pop(name, None)
        if line is not None:
            line.close()
        if not keep:
            self._known.pop(name, None)
            self._resting.pop(name, None)

    def _count(self, snapshot: Snapshot) -> None:
        """Rates between this look and the one before."""
        now = time.monotonic()
        before, self._counted = self._counted, {}
        for key, flow in snapshot.flows.items():
            messages, size = flow.measured("messages"), flow.measured("bytes")
            flow.rate = flow.measured("rate")
            if messages is None or size is None or not flow.target:
                continue  # to nobody: grows by all that a connection had, when that one ends
            self._counted[key] = now, messages, size
            if key in before and now > before[key][0]:
                passed = now - before[key][0]
                flow.rate = max(messages - before[key][1], 0) / passed
                flow.speed = max(size - before[key][2], 0) / passed
            elif flow.rate:
                flow.speed = size / max(messages, 1) * flow.rate


def can_answer(contact: Contact) -> bool:
    """Return whether a registration is a port that can be asked."""
    return contact.carrier == "tcp" and contact.name.startswith("/") and bool(contact.port)


def state_of(error: BaseException) -> State:
    """Return the state of a port that an error in asking it stands for."""
    if isinstance(error, AccessRefused):
        return "denied"
    if isinstance(error, Timeout) and type(error.__cause__) is TimeoutError:
        return "unreachable"
    if probe.is_refused(error):
        return "refused"
    if isinstance(error, LinkClosed) and isinstance(error.__cause__, OSError):
        return "unreachable"
    return "silent" if isinstance(error, Timeout) else "other"


def ends_of(line: Line, state: PortState, timeout: float = TIMEOUT) -> list[Told]:
    """The connections of one port. Raises as `Line.ask`."""
    if state.ours is not False:
        reply = line.ask("stat", timeout=timeout)
        refused = bool(reply) and reply[0] == Vocab("fail")
        state.ours = not refused
        if not refused:
            told = [Property.from_bottle(pairs(item)) for item in reply[:SAMPLE_ITEMS]]
            return [(side_of(one), *read(one)) for one in told]
    return list(_ask_each(line, state.name, timeout))


def _ask_each(line: Line, port: str, timeout: float) -> Iterator[Told]:
    """The connections of a port that has no counters."""
    until = time.monotonic() + 3 * timeout  # for all of them
    for side in ("out", "in"):
        for name in map(plain_text, line.ask("list", side, timeout=timeout)[:SAMPLE_ITEMS]):
            if not name.startswith("/"):
                continue
            if time.monotonic() > until:
                raise Timeout(f'"{port}" takes too long to tell of its connections')
            listed = line.ask("list", side, name, timeout=timeout)
            granted = qos.read(line.ask("prop", "get", name, timeout=timeout))
            ends = (port, name) if side == "out" else (name, port)
            yield side, *ends, End(plain_text(listed.find("carrier", "")), qos=granted)


# --- once


def flows(names: NameClient | None = None) -> list[Flow]:
    """Every connection between registered ports, by source and target.

    Raises NoNameServer.
    """
    with Sampler(names) as sampler:
        return list(sampler.look().flows.values())


def flow(source: str, target: str, names: NameClient | None = None) -> Flow:
    """The connection `source` -> `target`, asked of these two ports.

    Raises UnknownName when neither knows of it, NoNameServer.
    """
    with Sampler(names, dict.fromkeys((source, target))) as sampler:
        found = sampler.look().flows.get((source, target))
    if found is None:
        raise UnknownName(
            f'neither "{source}" nor "{target}" has a connection from the first to the second; '
            f"`yarpy ping {source}` lists those it has"
        )
    return found


def ends(contact: Contact) -> list[tuple[str, str, End]]:
    """The connections of one port, source and target first; none if it does not answer."""
    if not can_answer(contact):
        return []
    try:
        line = Line(contact)
    except (YarpError, OSError):
        return []
    try:
        told = ends_of(line, PortState(contact.name, contact))
        return [(source, target, end) for _, source, target, end in told if target]
    except (YarpError, OSError):
        return []
    finally:
        line.close()


__all__ = ["Line", "Sampler", "ends", "flow", "flows"]
