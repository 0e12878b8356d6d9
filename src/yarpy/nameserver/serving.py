"""Serving: a port whose messages are commands of the name service, and what follows from them.

Rules: written against the port's hub and the pure rooms of `names`; what to connect or break is
done by a few worker threads, in order for each pair of ports, so that no command waits for a port.
"""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from queue import SimpleQueue
from typing import TYPE_CHECKING, Final

from yarpy.config.configuration import Server, default_port
from yarpy.contact import Contact
from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text
from yarpy.data.value import Vocab
from yarpy.errors import AddressError, DecodeError, LinkClosed, Timeout, YarpError
from yarpy.limit import SERVER_COMMAND, SERVER_EVENTS, SERVER_UNFINISHED
from yarpy.link.receive.inbound import Inbound
from yarpy.log import logger
from yarpy.names.address import is_loopback, local_addresses
from yarpy.names.default import client_of, secret
from yarpy.nameserver.collector import Collector
from yarpy.nameserver.command import NameService
from yarpy.nameserver.delegate import Delegate, DelegateContext
from yarpy.nameserver.folder import Folder
from yarpy.nameserver.page import NamePage
from yarpy.nameserver.reply import Reply, old
from yarpy.nameserver.right import is_old_style, needed
from yarpy.nameserver.store import NameStore
from yarpy.nameserver.survey import is_port
from yarpy.nameserver.topology import Action, Topology
from yarpy.nameserver.versions import OURS, Versions
from yarpy.port.answer.spelling import PROPERTY, YARP4
from yarpy.port.assembly import open_hub
from yarpy.port.connect import identity, probe
from yarpy.port.connect.choosing import MEMORY
from yarpy.port.connect.target import joined
from yarpy.port.mailbox import Mailbox
from yarpy.registry import carriers
from yarpy.transports.bind import listening_host
from yarpy.transports.tcp import is_taken
from yarpy.wire.message import JSON, Lines, Malformed, Message, Packet, Refused

if TYPE_CHECKING:
    from yarpy.names.discovery import Responder
    from yarpy.nameserver.database import Database

log = logger("yarpy.name_server")

WORKERS: Final = 4
BUSY: Final = 1.0  # seconds for a port that lives to say its name
GROUP: Final = "224.2.1.1"


def _opened(portdb: str | Path | None, subdb: str | Path | None, cautious: bool) -> Database | None:
    if portdb is None and subdb is None:
        return None
    from yarpy.nameserver.database import Database

    return Database(portdb or ":memory:", subdb or ":memory:", cautious=cautious)


class _CommandMailbox(Mailbox):
    """Answers commands in the thread of the connection that brings them; early clients wait."""

    def __init__(self) -> None:
        super().__init__()
        self._answer: Callable[[Inbound, Message], None] | None = None
        self._opened = threading.Event()

    def open(self, answer: Callable[[Inbound, Message], None]) -> None:
        """From now on `answer` gets what comes."""
        self._answer = answer
        self._opened.set()

    def put(self, link: Inbound, message: Message) -> None:
        self._opened.wait()
        if self._answer is not None and not self.stopped:
            self._answer(link, message)

    def interrupt(self) -> None:
        super().interrupt()
        self._opened.set()


class Serving:
    """A name server at work: its threads keep it, so that its handle (`NameServer`) is collected
    when a program has dropped it. Parameters and errors are those of the handle."""

    def __init__(
        self,
        port: int,
        host: str,
        *,
        name: str,
        portdb: str | Path | None,
        subdb: str | Path | None,
        cautious: bool,
        discoverable: bool,
        web: str | Path | None,
        beside: Mapping[str, str] | None,
    ) -> None:
        folder = Folder(web) if web is not None else None
        mailbox = _CommandMailbox()
        # Before anybody can call: it may be damaged.
        self._database = _opened(portdb, subdb, cautious)
        try:
            self.hub = open_hub(
                name,
                mailbox,
                None,
                tcp_port=port,
                host=host,
                limit=SERVER_COMMAND,
                input_limit=SERVER_UNFINISHED,
                register=False,
                directory=True,
            )
        except BaseException:
            if self._database is not None:
                self._database.close()
            raise
        self.host = host
        self.port = self.hub.port
        self.client = client_of(Server(host, self.port))
        self.name = name
        self.service = NameService(
            NameStore(host, self.port, is_taken=self._is_taken),
            Topology(time.time),
            self._is_alive,
        )
        self._pages = NamePage(name, self._contacts, self.service.verbs, folder)
        self._responder: Responder | None = None
        self._collector: Collector | None = None
        self._versions = Versions(self._is_of_yarp4)
        self.delegates: list[Delegate] = []
        self._queues: list[SimpleQueue[Action | None]] = [SimpleQueue() for _ in range(WORKERS)]
        self._events: SimpleQueue[Bottle | None] = SimpleQueue()
        self.on_command: Callable[[str, str], None] | None = None
        try:
            if self._database is not None:
                self._database.load(self.service)
                self._database.start()
            self._register_self()
            self.service.introduced = self._introduced
            self._open_delegates(beside or {})
            for queue in self._queues:
                self._start(lambda queue=queue: self._work(queue), "wiring")  # type: ignore[misc]
            self._start(self._tell, "events")
            self._collector = Collector(self.service, self._follow, name)
            if discoverable:
                self._open_responder()
        except BaseException:
            self.close()
            raise
        self.hub.callbacks.lines_for_people = self._page
        self.hub.callbacks.program.on_page = self._pages
        mailbox.open(self._answer)

    # -- commands ---------------------------------------------------------------------------------

    def _is_taken(self, host: str, number: int) -> bool:
        """Return whether an unregistered program on this computer listens there, such as a port
        that outlived the previous server. (C++ lends the number, and the new port cannot open.)"""
        return self._is_here(host) and is_taken(number)

    def _is_alive(self, contact: Contact) -> bool:
        """Return whether the port of that name is there; one that is silent may be stopped or busy,
        and a host that cannot be reached may come back."""
        if self._is_here(contact.host) and not is_taken(contact.port):
            return False
        try:
            return probe.who(contact, BUSY, secret()) == contact.name
        except Timeout:
            return True
        except (YarpError, OSError) as error:
            return not probe.is_refused(error)

    def _is_here(self, host: str) -> bool:
        return host == self.host or is_loopback(host)

    def _answer(self, link: Inbound, message: Message) -> None:
        try:
            peer = link.driver.transport.remote[0]
        except OSError as error:  # killed while its question was on the way
            raise LinkClosed(str(error)) from error
        if is_loopback(peer):
            peer = self.host  # a program of this host: others reach it as they reach us
        structured = message.text == JSON
        try:
            words = message.as_(Bottle)
        except DecodeError as error:
            if message.answer is not None:
                message.reply(Malformed(str(error)))
            return
        if why := self._refusal(link, words):
            self._refuse(message, why)
            return
        # as C++ says it behind a command that came by HTTP
        command = [*words, Bottle(["format", "json"])] if structured else words
        reply = self.service.answer(command, peer)
        if self._database is not None:
            self._database.settle()
        if self.on_command is not None:
            self.on_command(words.to_text(), peer)
        self._follow(reply)  # first, so that the events of one client keep their order
        if message.answer is not None:
            message.reply(
                reply.first()
                if structured
                else (reply.bottle if reply.bottle is not None else Lines(reply.lines))
            )
        if len(words) > 1 and words[0] == "announce":
            name, alive = plain_text(words[1]), len(words) < 3 or bool(words[2])
            if not alive and self._collector:
                self._collector.suspect(name)
            elif alive:
                for delegate in self.delegates:
                    delegate.announced(name)

    def _refusal(self, link: Inbound, words: Bottle) -> str:
        """Return why the peer may not give such a command; "" if it may."""
        admission = link.driver.admission
        if admission.open:
            return ""
        return next(filter(None, (admission.refusal(*one) for one in needed(words))), "")

    def _refuse(self, message: Message, why: str) -> None:
        if message.answer is None:
            return
        old_style = message.text != JSON and is_old_style(message.as_(Bottle))
        message.reply(Lines(old([f"error {why}"]).lines) if old_style else Refused(why))

    def _contacts(self) -> list[Contact]:
        """Every registration."""
        with self.service.lock:
            return list(self.service.store.contacts())

    def _page(self) -> list[str]:
        """Every port, for browsers without JavaScript."""
        return [*self.service.answer(Bottle(["list"])).lines[:-1]]

    def _obey(self, command: Bottle) -> None:
        """Carry out a command of our own."""
        self._follow(self.service.answer(command))

    def _follow(self, reply: Reply) -> None:
        """Publish the events of a command and start its actions."""
        for event in reply.events:
            for delegate in self.delegates:
                if event[0] == Vocab("add"):
                    delegate.registered(str(event[1]))
                elif event[0] == Vocab("del"):
                    delegate.unregistered(str(event[1]))
            if self.hub.outputs.links and self._events.qsize() < SERVER_EVENTS:
                self._events.put(event)
        for action in reply.actions:
            self._queues[hash((action.source, action.destination)) % WORKERS].put(action)

    def _introduced(self, contact: Contact) -> None:
        """A port says that it is there."""
        accepts = self.service.store.values(contact.name, "accepts") or ()
        if is_port(contact) and OURS not in accepts:
            self._versions.ask(contact)

    def _is_of_yarp4(self, contact: Contact) -> None:
        with self.service.lock, suppress(AddressError):
            if self.service.store.query(contact.name) == contact:
                self.service.store.assign(contact.name, PROPERTY, [YARP4])

    def _register_self(self) -> None:
        answer = self.service.answer
        answer(Bottle(["register", self.name, "tcp", self.host, self.port]))
        known = carriers.offered()
        answer(Bottle(["set", self.name, "offers", *known]))
        answer(Bottle(["set", self.name, "accepts", *known]))
        bound = listening_host()
        answer(Bottle(["set", self.name, "ips", *([bound] if bound else local_addresses())]))
        answer(Bottle(["set", self.name, "process", os.getpid()]))
        answer(Bottle(["register", "fallback", "mcast", GROUP, default_port(os.environ)]))
        answer(Bottle(["set", self.name, "nameserver", "true"]))

    def _open_delegates(self, beside: Mapping[str, str]) -> None:
        from yarpy import registry

        context = DelegateContext(self.service, self.name, self.host, self._obey)
        for system, place in beside.items():
            self.delegates.append(registry.delegates.load(system)(place, context))
        self.service.elsewhere = self._elsewhere if self.delegates else None
        for contact in self._contacts():  # of a database
            if contact.name != self.name and contact.carrier != "mcast":
                for delegate in self.delegates:
                    delegate.registered(contact.name)

    def _elsewhere(self, name: str) -> Contact | None:
        """Return where another system has a name."""
        found = (delegate.query(name) for delegate in self.delegates)
        return next((contact for contact in found if contact is not None), None)

    def _open_responder(self) -> None:
        from yarpy.names.discovery import Responder

        responder = Responder(self.service.answer_multicast, default_port(os.environ))
        try:
            responder.start()
            self._responder = responder
        except OSError as error:
            log.warning("the server cannot be found by multicast here: %s", error)

    # -- what follows from commands ---------------------------------------------------------------

    def _start(self, work: Callable[[], None], what: str) -> None:
        threading.Thread(target=work, name=f"yarpy {self.name} {what}", daemon=True).start()

    def _tell(self) -> None:
        """Send events to all that are connected to our output."""
        while (event := self._events.get()) is not None:
            packet = Packet(event)
            for link in self.hub.outputs.links:
                try:
                    link.send(packet)
                except YarpError as error:
                    self.hub.outputs.drop(link, str(error))

    def _work(self, queue: SimpleQueue[Action | None]) -> None:
        while (action := queue.get()) is not None:
            try:
                self._act(action)
            except (YarpError, OSError) as error:
                log.info("%s %s -> %s: %s", action.kind, action.source, action.destination, error)

    def _act(self, action: Action) -> None:
        """Do what `yarp connect` or `yarp disconnect` would do for a persistent connection."""
        contact = self.service.store.query(action.ask)
        if contact is None:
            return
        if action.kind == "disconnect":
            probe.ask(contact, [Vocab("del"), action.peer])
            return
        listed = probe.ask(contact, [Vocab("list"), Vocab("out"), action.destination])
        if not listed:
            self._confirm(contact)
            destination = self.service.store.query(action.destination)
            if destination is not None:
                self._confirm(destination)
            # Ports that know memory choose by themselves.
            accepts = self.service.store.values(action.source, "accepts") or ()
            way = action.carrier or ("" if MEMORY in accepts else "tcp")
            probe.ask(contact, [Vocab("add"), joined(action.destination, way)])

    def _confirm(self, contact: Contact) -> None:
        """Raise WrongPort if the port that listens there is not the one of that name."""
        store = self.service.store
        identity.confirm(contact, lambda name, key: store.values(name, key) or (), secret())

    # -- ending -----------------------------------------------------------------------------------

    def close(self) -> None:
        """Stop serving. Registered ports go on, and register again with the next server."""
        self._pages.close()
        self.client.close()
        while self.delegates:
            self.delegates.pop().close()
        self.hub.close()
        for queue in self._queues:
            queue.put(None)
        self._events.put(None)
        self._versions.close()
        if self._collector is not None:
            self._collector.close()
            self._collector = None
        if self._responder is not None:
            self._responder.close()
            self._responder = None
        if self._database is not None:
            self._database.close()
            self._database = None
