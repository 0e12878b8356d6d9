"""The name store: which port is where, with which properties, and what was lent to it.

Rules: pure; no sockets, no files, no clock. Names, fields and properties are one table, as in C++
yarpserver: the keys `carrier`, `host`, `socket` and `type` *are* the address.
Property values are a multiset and come back sorted by their bytes. `*` is an ordinary name, not a
wildcard. Whatever the network can make grow has a limit (`Limits`); AddressError beyond it.
"""

from __future__ import annotations

from bisect import bisect_left, insort
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial

from yarpy.contact import Contact
from yarpy.errors import AddressError
from yarpy.log import readable
from yarpy.nameserver.pool import Pool

TEMPORARY = "/tmp/port/"
ADDRESS_KEYS = ("carrier", "host", "socket")
NOWHERE = Contact("tcp", "", "localhost", 10000)  # what a missing field of an address reads as


@dataclass(frozen=True, slots=True)
class Limits:
    """The most that strangers may store."""

    names: int = 100_000
    name_bytes: int = 1000
    values_per_name: int = 2000
    text_per_name: int = 65_536  # characters of keys and values
    total_text: int = 256 << 20
    subscriptions: int = 100_000
    numbers_per_peer: int = 4000  # of the 10 000 port numbers that all share


class Registration:
    """One port: its fields (key -> sorted values) and the contact they amount to."""

    __slots__ = ("_contact", "fields", "name", "size")

    def __init__(self, name: str) -> None:
        self.name = name
        self.fields: dict[str, list[str]] = {}
        self.size = len(name)  # characters kept for this name
        self._contact: Contact | None = None

    @property
    def contact(self) -> Contact:
        if self._contact is None:
            carrier = self.fields.get("carrier", [NOWHERE.carrier])[0]
            host, number = (self.fields.get(key, [""])[0] for key in ("host", "socket"))
            port = _number(number) if number else NOWHERE.port
            self._contact = Contact(carrier, self.name, host or NOWHERE.host, port)
        return self._contact

    def assign(self, key: str, values: list[str]) -> None:
        self.size += self.growth(key, values)
        if values:
            self.fields[key] = values
        else:
            self.fields.pop(key, None)
        if key in ADDRESS_KEYS:
            self._contact = None

    def growth(self, key: str, values: list[str]) -> int:
        """Return by how many characters `assign` would make this registration larger."""
        old = self.fields.get(key)
        return _size(key, values) - (_size(key, old) if old else 0)


def _size(key: str, values: list[str]) -> int:
    return len(key) + sum(map(len, values)) if values else 0


def _number(text: str) -> int:
    """The port number a text stands for; 0 for any other text."""
    try:
        number = int(text) if len(text) < 12 else 0
    except ValueError:
        return 0
    return number if 0 <= number <= 65535 else 0


def _bytes(text: str) -> bytes:
    try:
        return text.encode("utf-8", "surrogateescape")
    except UnicodeEncodeError:
        raise AddressError("a name or property holds characters that are not text") from None


def _group(counter: int) -> str:
    return f"224.1.{counter // 255 + 1}.{counter % 255 + 1}"


class NameStore:
    """All registrations. `host` and `port` are the server's own address.

    Port numbers go out from port + 2 to port + 9999, one at a time for the whole network; none for
    which `is_taken(host, number)` says that an unregistered program has it. `on_change(kind, key)`
    is called for everything a database must write: kinds `port` (a name), `regid`, `tmpid`,
    `mcastCursor` (a value of that pool).
    """

    def __init__(
        self,
        host: str = "127.0.0.1",
        port: int = 10000,
        limits: Limits | None = None,
        is_taken: Callable[[str, int], bool] = lambda host, number: False,
    ) -> None:
        self.host = host
        self._is_taken = is_taken
        self.port = port
        self.limits = limits if limits is not None else Limits()
        last = min(port + 9999, 65535)
        self.numbers = Pool("port numbers", port + 2, last, recycle=False, remember=True)
        self.temporary = Pool(
            "temporary names", 1, self.limits.names, lambda counter: f"{TEMPORARY}{counter}"
        )
        self.groups = Pool("multicast groups", 2, 255 * 255 - 1, _group)
        self._ports: dict[str, Registration] = {}
        self._sorted: list[tuple[bytes, str]] = []
        self._size = 0
        # How many registrations claim (host, number): numbers given by clients are not lent by us,
        # but lending the same number again for the same host would make somebody's listen fail.
        self._addresses: Counter[tuple[str, int]] = Counter()
        self._borrowers: dict[str, str] = {}  # name -> the address for which its number went out
        self._borrowed: Counter[str] = Counter()  # how many numbers each address has
        self._on_change: Callable[[str, str], None] | None = None

    @property
    def pools(self) -> dict[str, Pool]:
        """The pools under the names they have in a database."""
        return {"regid": self.numbers, "tmpid": self.temporary, "mcastCursor": self.groups}

    def watch(self, on_change: Callable[[str, str], None] | None) -> None:
        """Call `on_change(kind, key)` for every change from now on."""
        self._on_change = on_change
        for kind, pool in self.pools.items():
            pool.on_change = None if on_change is None else partial(on_change, kind)

    # --- looking

    def __contains__(self, name: str) -> bool:
        return name in self._ports

    def __len__(self) -> int:
        return len(self._ports)

    def registration(self, name: str) -> Registration | None:
        """Return what is known of a name: another object whenever it is registered anew."""
        return self._ports.get(name)

    def query(self, name: str, network: str | None = None) -> Contact | None:
        """Return the address of `name`, or None. With `network`, the first of its `ips` beginning
        like that."""
        port = self._ports.get(name)
        if port is None:
            return None
        contact = port.contact
        if network is not None:
            for address in port.fields.get("ips", ()):
                if address.startswith(network):
                    return Contact(contact.carrier, name, address, contact.port)
        return contact

    def contacts(self, prefix: str = "") -> Iterator[Contact]:
        """All ports, or those at or below `prefix`, by ascending bytes of the name.

        `/tmp` and `/tmp/` both match `/tmp/port/1`; `/tm` does not.
        """
        return (port.contact for port in self.registrations(prefix))

    def registrations(self, prefix: str = "") -> Iterator[Registration]:
        if not prefix:
            for _, name in self._sorted:
                yield self._ports[name]
            return
        start = _bytes(prefix)
        below = start if start.endswith(b"/") else start + b"/"
        for place in range(bisect_left(self._sorted, (start,)), len(self._sorted)):
            key, name = self._sorted[place]
            if not key.startswith(start):
                break
            if key == start or key.startswith(below):
                yield self._ports[name]

    def having(self, key: str, value: str) -> Iterator[Contact]:
        """The ports one of whose values of `key` is `value`."""
        for port in self.registrations():
            if value in port.fields.get(key, ()):
                yield port.contact

    def values(self, name: str, key: str) -> list[str] | None:
        """The values of a property, sorted by bytes; None if there is no such port."""
        port = self._ports.get(name)
        return None if port is None else list(port.fields.get(key, ()))

    # --- changing

    def register(
        self,
        name: str = "",
        carrier: str = "",
        host: str = "",
        port: int = 0,
        type_: str = "",
        peer: str = "",
    ) -> Contact:
        """Put a port in; a port that had the name is unregistered first (the newest wins).

        name: `...` asks for /tmp/port/N, `=suffix` for /tmp/port/N=suffix. carrier, host: "" or
        `...` mean tcp and `peer`, the address the request came from. port: 0 or less asks for a
        number (0 for a topic: the server's own). Returns the complete contact. Raises AddressError
        when something has run out or is beyond a limit.
        """
        carrier = "tcp" if carrier in ("", "...") else carrier
        host = "" if host == "..." else host
        type_ = "" if type_ == "*" else type_
        self._check(name, carrier, host, type_)
        if port > 65535:
            raise AddressError(f"port number {port} is beyond 65535")
        if name not in self._ports and len(self._ports) >= self.limits.names:
            raise AddressError(
                f"this server keeps at most {self.limits.names} names; unregister what is dead"
            )
        self.unregister(name)
        if name == "..." or name.startswith("="):
            suffix = name if name.startswith("=") else ""
            base = self.temporary.take(None, lambda value: value + suffix in self._ports)
            name = base + suffix
        contact = self._complete(name, carrier, host, port, peer)
        entry = Registration(name)
        for key, value in (
            ("carrier", contact.carrier),
            ("host", contact.host),
            ("socket", str(contact.port)),
            ("type", type_),
        ):
            if value:
                entry.assign(key, [value])
        self._insert(entry)
        return contact

    def unregister(self, name: str) -> list[Registration]:
        """Take a port out with all that it owns. Returns what went: the owned ones first."""
        order: list[Registration] = []
        self._collect(name, order, set())
        for port in order:
            self._remove(port)
        return order

    def assign(self, name: str, key: str, values: Iterable[str]) -> list[str] | None:
        """Replace the values of a property; returns them sorted, None if there is no such port.

        Raises AddressError beyond a limit; the old values then stay.
        """
        port = self._ports.get(name)
        if port is None:
            return None
        new = sorted(values, key=_bytes)
        self._check(key)
        limits = self.limits
        count = sum(map(len, port.fields.values())) - len(port.fields.get(key, ())) + len(new)
        growth = port.growth(key, new)
        if count > limits.values_per_name:
            raise AddressError(f"a name has at most {limits.values_per_name} property values")
        if growth > 0 and port.size + growth > limits.text_per_name:
            raise AddressError(
                f"a name has at most {limits.text_per_name} characters of properties"
            )
        if growth > 0 and self._size + growth > limits.total_text:
            raise AddressError("the memory of this server for properties is full")
        self._claim(port, -1)
        port.assign(key, new)
        self._claim(port, +1)
        self._size += growth
        self._changed("port", name)
        return list(new)

    def restore(self, ports: Mapping[str, Mapping[str, list[str]]]) -> None:
        """Fill an empty store with what a database remembers."""
        for name, fields in ports.items():
            entry = Registration(name)
            for key, values in fields.items():
                entry.assign(key, sorted(values, key=_bytes))
            self._insert(entry)

    # --- inside

    def _check(self, *words: str) -> None:
        for word in words:
            if len(_bytes(word)) > self.limits.name_bytes:
                raise AddressError(f"a name is at most {self.limits.name_bytes} bytes long")
            if readable(word) != word:
                shown = readable(word[:80])
                raise AddressError(f'a name has no control characters (name given: "{shown}")')

    def _complete(self, name: str, carrier: str, host: str, port: int, peer: str) -> Contact:
        """Allocate what the request left open; when that fails nothing stays allocated."""
        try:
            if not host:
                if carrier == "topic":
                    host = self.host
                elif carrier == "mcast":
                    host = self.groups.take(name)
                else:
                    host = peer or NOWHERE.host
            if port <= 0:
                if carrier == "topic" and port == 0:
                    port = self.port
                else:
                    port = self._lend(name, host, peer)
        except AddressError:
            self._give_back(Contact(carrier, name, host, 0))
            raise
        return Contact(carrier, name, host, port)

    def _lend(self, name: str, host: str, peer: str) -> int:
        """A port number for `name` that goes out to `peer`."""
        most = self.limits.numbers_per_peer
        if peer and self._borrowed[peer] >= most:
            raise AddressError(
                f"{peer} has {most} port numbers, as many as one computer gets; unregister what is "
                "dead, for example with `yarpy clean`"
            )
        number = self.numbers.take(name, lambda n: self._is_used(host, int(n)))
        if peer:
            self._borrowers[name] = peer
            self._borrowed[peer] += 1
        return int(number)

    def _is_used(self, host: str, number: int) -> bool:
        return self._addresses[host, number] > 0 or self._is_taken(host, number)

    def _give_back(self, contact: Contact) -> None:
        # What was lent comes back, whatever `set NAME socket N` made of the address since. The
        # address itself counts only where a database did not say who has what.
        peer = self._borrowers.pop(contact.name, None)
        if peer is not None:
            self._borrowed[peer] -= 1
            if not self._borrowed[peer]:
                del self._borrowed[peer]
        numbers, groups = self.numbers, self.groups
        numbers.release(numbers.lent(contact.name) or str(contact.port), contact.name)
        groups.release(groups.lent(contact.name) or contact.host, contact.name)
        if contact.name.startswith(TEMPORARY):
            self.temporary.release(contact.name.partition("=")[0], None)

    def _insert(self, port: Registration) -> None:
        self._ports[port.name] = port
        insort(self._sorted, (_bytes(port.name), port.name))
        self._claim(port, +1)
        self._size += port.size
        self._changed("port", port.name)

    def _remove(self, port: Registration) -> None:
        del self._ports[port.name]
        del self._sorted[bisect_left(self._sorted, (_bytes(port.name), port.name))]
        self._claim(port, -1)
        self._size -= port.size
        self._give_back(port.contact)
        self._changed("port", port.name)

    def _claim(self, port: Registration, step: int) -> None:
        address = port.contact.host, port.contact.port
        self._addresses[address] += step
        if self._addresses[address] <= 0:
            del self._addresses[address]

    def _collect(self, name: str, order: list[Registration], seen: set[str]) -> None:
        """`name` and what it owns, owned ones first; iterative, chains may be long or circular."""
        stack: list[tuple[str, bool]] = [(name, False)]
        while stack:
            current, done = stack.pop()
            port = self._ports.get(current)
            if port is None:
                continue
            if done:
                order.append(port)
            elif current not in seen:
                seen.add(current)
                stack.append((current, True))
                stack.extend((owned, False) for owned in reversed(port.fields.get("owns", ())))

    def _changed(self, kind: str, key: str) -> None:
        if self._on_change is not None:
            self._on_change(kind, key)
