"""Findings about names: unknown, left behind, leading elsewhere, had by two programs."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Final

from yarpy.config.configuration import Server
from yarpy.contact import Contact
from yarpy.errors import YarpError
from yarpy.kits.doctor import process
from yarpy.kits.doctor.case import Case
from yarpy.kits.doctor.finding import Finding
from yarpy.limit import number_in
from yarpy.names.default import secret
from yarpy.network.traffic import PortState
from yarpy.platform.process import lives
from yarpy.port.connect import probe
from yarpy.port.connect.target import unknown

RANGE: Final = 1000  # numbers that a name server hands out
MOST: Final = 200  # listeners of this computer that are asked for their names
TIMEOUT: Final = 0.3  # seconds for each


def find(case: Case) -> Iterator[Finding]:
    """unknown-name, dead-name, other-port, duplicate-name."""
    if case.problem is not None:
        return
    for name in case.wanted:
        if name not in case.ports:
            yield from _unknown(case, name)
    for state in case.ports.values():
        if state.state == "refused":
            yield _dead(case, state)
        elif state.state == "other":
            yield _other(case, state)
    if case.wanted:
        yield from _duplicates(case)


def _unknown(case: Case, name: str) -> Iterator[Finding]:
    if case.names is None or any(_knows(case, name)):
        return
    yield Finding(
        "unknown-name",
        name,
        str(unknown(name, case.names)),
        f"start the program that opens it; `yarpy wait {name}` waits for it, `yarpy name list` "
        "lists the names that there are",
    )


def _knows(case: Case, name: str) -> Iterator[bool]:
    """Yield for each other server whether it knows the name: then the wrong server is asked."""
    for other in case.others:
        client = case.server_of(other)
        try:
            yield client.query(name) is not None
        except (YarpError, OSError):
            yield False
        finally:
            client.close()


def _dead(case: Case, state: PortState) -> Finding:
    pids = [pid for pid in map(number_in, case.property_of(state.name, "process")) if pid]
    pid = pids[0] if pids and case.is_here(state.name) else 0
    if pid and lives(pid) and process.state(pid) != "Z":
        gone = f"its program (process {pid}) lives and does not listen there any more"
    elif pid:
        gone = f"its program (process {pid}) has ended without giving the name back"
    else:
        gone = "its program has ended without giving the name back"
    return Finding(
        "dead-name",
        state.name,
        f'"{state.name}" is registered at {state.contact.address}, where nobody listens: {gone}',
        "start the program again, or take such names out: `yarpy clean`",
    )


def _other(case: Case, state: PortState) -> Finding:
    found = case.who(state.name)
    listens = f'the port "{found}"' if found else "something that is no port of YARP"
    return Finding(
        "other-port",
        state.name,
        f'"{state.name}" is registered at {state.contact.address}, where {listens} listens by now',
        f"start the program of {state.name} again, or take its name out: `yarpy name unregister "
        f"{state.name}`",
    )


def _duplicates(case: Case) -> Iterator[Finding]:
    """Programs of this computer that had the name before another one took it."""
    wanted = {name for name in case.wanted if name in case.ports}
    root = case.servers[0].port if case.servers else _root(case)
    taken = {state.contact.port for state in case.ports.values()}
    numbers = {
        one.local
        for one in process.sockets()
        if one.listens and root < one.local < root + RANGE and one.local not in taken
    }
    for number, name in _named(sorted(numbers)[:MOST]):
        if name in wanted and not _is_known_elsewhere(case, name, number, root):
            yield Finding(
                "duplicate-name",
                name,
                f'two ports call themselves "{name}": one at {case.ports[name].contact.address}, '
                f"which the name server knows, and one at 127.0.0.1:{number}{_owner(number)}, "
                "which it does not know (any more); whoever is connected to the one does not hear "
                "the other",
                "end one of the programs, or give one a name of its own: `--name`, or "
                "YARP_PORT_PREFIX",
                "warning",
            )


def _is_known_elsewhere(case: Case, name: str, number: int, root: int) -> bool:
    """Return whether another name server of this computer has that port, which then belongs to
    another network."""
    numbers = {
        one.local
        for one in process.sockets()
        if one.listens and abs(one.local - root) < RANGE and one.local != root
    }
    servers = {"/root", *(one.namespace for one in case.servers)}
    for place, server in _named(sorted(numbers)[:MOST]):
        if server not in servers:
            continue
        client = case.server_of(Server("127.0.0.1", place))
        try:
            found = client.query(name)
        except (YarpError, OSError):
            continue
        finally:
            client.close()
        if found is not None and found.port == number:
            return True
    return False


def _root(case: Case) -> int:
    """The lowest number in use, where no server is configured."""
    numbers = [one.port for one in case.contacts.values() if one.port]
    return min(numbers, default=1 << 16) - 1


def _owner(number: int) -> str:
    pid = process.listener(number)
    return f" (process {pid}: {process.command(pid)})" if pid else ""


def _named(numbers: list[int]) -> Iterator[tuple[int, str]]:
    def ask(number: int) -> str:
        try:
            return probe.who(Contact("tcp", "", "127.0.0.1", number), TIMEOUT, secret())
        except (YarpError, OSError):
            return ""

    with ThreadPoolExecutor(16) as pool:
        yield from zip(numbers, pool.map(ask, numbers), strict=True)
