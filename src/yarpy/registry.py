"""Name -> plug-in: the one place where carriers, types, monitors and commands are looked up.

Rules: a plug-in of another package is an entry point (groups `yarpy.carriers`, `yarpy.transports`,
`yarpy.types`, `yarpy.monitors`, `yarpy.commands`, `yarpy.findings`, `yarpy.middlewares`,
`yarpy.devices` ...), one of ours a row of `shipped.py`. Nothing registers itself by being imported.
A lookup loads only what it needs, and to ask for the facts of a row loads nothing; a plug-in that
fails to load is an error that names its distribution.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator, Mapping
from importlib import import_module
from typing import Any, Final, Generic, TypeVar

from yarpy import fork
from yarpy.errors import UnknownPlugin
from yarpy.facts import MAGIC_SIZE, Call, CarrierRow, GraphRow, Row, TransportRow
from yarpy.installed import entry_points
from yarpy.shipped import CARRIERS, ELSEWHERE, GRAPHS, SHIPPED, TRANSPORTS
from yarpy.threads import undisturbed

R = TypeVar("R", bound=Row)


class Registry(Generic[R]):
    """Plug-ins of one kind by name. `kind` is `carriers`, `types`, `monitors` or `commands`."""

    def __init__(self, kind: str, shipped: Mapping[str, R]) -> None:
        self.kind = kind
        self._shipped = dict(shipped)
        self._loaded: dict[str, Any] = {}
        self._foreign: dict[str, Any] | None = None
        self._lock = fork.lock()  # two acceptors may meet an unknown protocol at once

    def add(self, name: str, plugin: Any) -> None:
        """Add a plug-in by hand (a test, a notebook); it wins over installed ones."""
        with self._lock:
            self._loaded[name] = plugin

    def remove(self, name: str) -> None:
        """Undo `add`; an installed plug-in of that name can be found again."""
        with self._lock:
            self._loaded.pop(name, None)

    def names(self) -> list[str]:
        """Every name that `load` would find, ours first."""
        with self._lock:
            return list(dict.fromkeys([*self._shipped, *self._entries(), *self._loaded]))

    def load(self, name: str) -> Any:
        """The plug-in called `name`. Raises UnknownPlugin with the nearest match."""
        try:
            return self._loaded[name]
        except KeyError:
            pass
        with self._lock:
            if name in self._shipped:
                plugin = _resolve(self._shipped[name])
            else:
                entry = self._entries().get(name)
                if entry is None:
                    raise UnknownPlugin(self._advice(name))
                plugin = self._load_entry(entry)
            self._loaded[name] = plugin
            return plugin

    def row(self, name: str) -> R | None:
        """Return what is known of a shipped plug-in without importing it; None for any other."""
        return self._shipped.get(name)

    def owner(self, name: str) -> str:
        """Return the distribution that brings a plug-in, "" for yarpy, or if nobody knows."""
        entry = None if name in self._shipped else self._entries().get(name)
        return entry.dist.name if entry is not None and entry.dist is not None else ""

    def __iter__(self) -> Iterator[Any]:
        """Every plug-in that loads; asking for one of the others by name says why."""
        for name in self.names():
            try:
                yield self.load(name)
            except UnknownPlugin:
                continue

    def _entries(self) -> dict[str, Any]:
        if self._foreign is None:
            self._foreign = {
                entry.name: entry
                for entry in entry_points(group=f"yarpy.{self.kind}")
                if entry.name not in self._shipped
            }
        return self._foreign

    def _load_entry(self, entry: Any) -> Any:
        try:
            return entry.load()
        except Exception as error:
            owner = entry.dist.name if entry.dist is not None else "an installed package"
            raise UnknownPlugin(
                f'"{entry.name}" of {owner} is installed but cannot be loaded '
                f"({type(error).__name__}: {error}); repair or uninstall {owner}"
            ) from error

    def _advice(self, name: str) -> str:
        from difflib import get_close_matches

        known = self.names()
        near = get_close_matches(name, known, n=1)
        singular = self.kind.removesuffix("s")
        if near:
            return f'no {singular} "{name}": did you mean "{near[0]}"?'
        return (
            f'no {singular} "{name}": known are {", ".join(known) or "none"}; '
            f"others come with a package that has the entry point group yarpy.{self.kind}"
        )


class CarrierRegistry(Registry[CarrierRow]):
    """The carriers: what they are can be asked before they are imported."""

    def __init__(self, shipped: Mapping[str, CarrierRow] = CARRIERS) -> None:
        super().__init__("carriers", shipped)
        self._facts: dict[str, CarrierRow] = {}

    def add(self, name: str, plugin: Any) -> None:
        super().add(name, plugin)
        self._facts.pop(name, None)

    def remove(self, name: str) -> None:
        super().remove(name)
        self._facts.pop(name, None)

    def facts(self, name: str) -> CarrierRow:
        """Return the facts of a carrier: of the row if it ships with yarpy, else of its class. One
        that nobody knows is as `tcp`."""
        row = self._shipped.get(name) or ELSEWHERE.get(name) or self._facts.get(name)
        if row is None and (name in self._loaded or name in self._entries()):
            try:
                row = self._facts[name] = CarrierRow.of(name, self.load(name))
            except (UnknownPlugin, AttributeError):
                pass  # whoever loads it is told
        return row or CarrierRow(name)

    def offered(self) -> list[str]:
        """Return the names of the carriers of which this system has the transport, and of those of
        other packages."""
        return [name for name in self.names() if not self.lacks(name)]

    def lacks(self, name: str) -> str:
        """Return why this system has not got the transport of a carrier, "" if it has."""
        row = self._shipped.get(name)
        transport = None if row is None else TRANSPORTS.get(row.over or "tcp")
        return "" if transport is None else transport.lacks

    def subprotocol(self, offered: Iterable[str]) -> str | None:
        """Return the name of the carrier that may come in a WebSocket with one of these
        subprotocols, or None."""
        wanted = set(offered)
        return next(
            (name for name in self.names() if wanted and self.facts(name).subprotocol in wanted),
            None,
        )

    def beginning(self, first: bytes) -> Iterator[Any]:
        """Yield every carrier that a connection with these first eight bytes may be of, ours first;
        nothing else is imported. Strangers are asked where ours are not certain."""
        certain = False
        for name in [*self._shipped, *(one for one in self._loaded if one not in self._shipped)]:
            plugin = self._loaded.get(name)
            if plugin is None and self._shipped[name].may_begin(first):
                try:
                    plugin = self.load(name)
                except UnknownPlugin:  # asking for it by name says why
                    continue
            if plugin is not None:
                certain = certain or plugin.recognises(first) >= MAGIC_SIZE
                yield plugin
        if not certain:
            for name in self._entries():
                if name not in self._loaded:
                    try:
                        yield self.load(name)
                    except UnknownPlugin:
                        continue


class TransportRegistry(Registry[TransportRow]):
    """The transports: which one leads where can be asked before they are imported."""

    def __init__(self, shipped: Mapping[str, TransportRow] = TRANSPORTS) -> None:
        super().__init__("transports", shipped)
        self._plain = shipped["tcp"]
        self._named = [row for row in shipped.values() if row.hosts]
        self._facts: dict[str, TransportRow] = {}

    def facts(self, name: str) -> TransportRow:
        """Return the facts of a transport: of the row if it ships with yarpy, else of its class.
        Raises UnknownPlugin."""
        row = self._shipped.get(name) or self._facts.get(name)
        if row is None:
            row = self._facts[name] = TransportRow.of(name, self.load(name))
        return row

    def of_host(self, host: str) -> TransportRow:
        """Return the facts of the transport that leads to a host: of `tcp`, unless the host ends as
        those of another one do. An IP address is looked up nowhere."""
        if not ("." in host and host[-1].isalpha()) or ":" in host:
            return self._plain
        for row in self._named:
            if host.endswith(row.hosts) and host != row.hosts:
                return row
        for name in dict.fromkeys([*self._entries(), *self._loaded]):
            if name not in self._shipped:
                try:
                    row = self.facts(name)
                except (UnknownPlugin, AttributeError):  # whoever asks for it by name is told
                    continue
                if row.hosts and host.endswith(row.hosts) and host != row.hosts:
                    return row
        return self._plain


class GraphRegistry(Registry[GraphRow]):
    """The graphs of other systems: what their nodes call each other with is known before one is
    imported."""

    def __init__(self, shipped: Mapping[str, GraphRow] = GRAPHS) -> None:
        super().__init__("graphs", shipped)
        self._ours = _calls((name, row.calls) for name, row in shipped.items())
        self._others: dict[str, tuple[str, Call]] | None = None

    def add(self, name: str, plugin: Any) -> None:
        super().add(name, plugin)
        self._others = None

    def remove(self, name: str) -> None:
        super().remove(name)
        self._others = None

    def call(self, request: str) -> tuple[str, Call] | None:
        """Return the graph whose nodes call each other so, and the call, by its name or its word,
        of which four letters count; None for any other request."""
        found = self._ours.get(request) or self._ours.get(request[:4])
        if found is None:
            if self._others is None:
                self._others = _calls(self._strangers())
            found = self._others.get(request) or self._others.get(request[:4])
        return found

    def _strangers(self) -> Iterator[tuple[str, tuple[Call, ...]]]:
        for name in self.names():
            if name not in self._shipped:
                try:
                    yield name, self.load(name).calls
                except (UnknownPlugin, AttributeError):  # whoever asks for it by name is told
                    continue


def _calls(graphs: Iterable[tuple[str, tuple[Call, ...]]]) -> dict[str, tuple[str, Call]]:
    """Return calls with their graphs, by their names and words."""
    return {
        said: (name, call)
        for name, calls in graphs
        for call in calls
        for said in (call.name, call.word)
        if said
    }


def _resolve(row: Row) -> Any:
    module, _, attribute = row.target.partition(":")
    try:
        load = _import_apart if row.home == "core" else import_module
        return getattr(load(module), attribute)
    except ImportError as error:  # a library that it needs; the others do without
        raise UnknownPlugin(
            f'"{row.name}" cannot be loaded ({error}): install what is missing, as `{row.advice}` '
            "does"
        ) from error


def _import_apart(module: str) -> Any:
    """Import a module of ours where no signal handler can raise in the middle, as by Ctrl-C: not in
    the main thread. There, Python would keep the module locked for ever."""
    if module in sys.modules:
        return import_module(module)
    began = False

    def load() -> Any:
        nonlocal began
        began = True
        return import_module(module)

    try:
        return undisturbed(load, f"yarpy import {module}")
    except RuntimeError:
        if began:
            raise
        return import_module(module)  # there can be no more threads


carriers: Final = CarrierRegistry()
transports: Final = TransportRegistry()
types: Final = Registry("types", SHIPPED["types"])
monitors: Final = Registry("monitors", SHIPPED["monitors"])
commands: Final = Registry("commands", SHIPPED["commands"])
findings: Final = Registry("findings", SHIPPED["findings"])
graphs: Final = GraphRegistry()
clients: Final = Registry("clients", SHIPPED["clients"])
middlewares: Final = Registry("middlewares", SHIPPED["middlewares"])
names: Final = Registry("names", SHIPPED["names"])
listings: Final = Registry("listings", SHIPPED["listings"])
delegates: Final = Registry("delegates", SHIPPED["delegates"])
idls: Final = Registry("idls", SHIPPED["idls"])
checks: Final = Registry("checks", SHIPPED["checks"])
applications: Final = Registry("applications", SHIPPED["applications"])
idl_commands: Final = Registry("idl_commands", SHIPPED["idl_commands"])
contents: Final = Registry("contents", SHIPPED["contents"])
encodings: Final = Registry("encodings", SHIPPED["encodings"])
interfaces: Final = Registry("interfaces", SHIPPED["interfaces"])
devices: Final = Registry("devices", SHIPPED["devices"])
robots: Final = Registry("robots", SHIPPED["robots"])
