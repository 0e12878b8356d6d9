"""The name server: a port whose messages are commands of the name service.

Rules: written against the port's hub and the pure rooms of `names`; what to connect or break is
done by a few worker threads, in order for each pair of ports, so that no command waits for a port.
"""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable
from pathlib import Path
from queue import SimpleQueue
from typing import TYPE_CHECKING, Final, Self

from yarpy.config.configuration import ROOT, Server, default_port
from yarpy.contact import Contact
from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text
from yarpy.data.value import Vocab
from yarpy.errors import DecodeError, LinkClosed, Timeout, YarpError
from yarpy.link.inbound import Inbound
from yarpy.log import logger
from yarpy.names.address import is_loopback, local_addresses
from yarpy.names.default import DEFAULT, client_of, secret
from yarpy.names.ros_master import RosMaster
from yarpy.nameserver.collector import Collector
from yarpy.nameserver.command import NameService
from yarpy.nameserver.folder import Folder
from yarpy.nameserver.page import NamePage
from yarpy.nameserver.reply import Reply, old
from yarpy.nameserver.right import is_old_style, needed
from yarpy.nameserver.store import NameStore
from yarpy.nameserver.topology import Action, Topology
from yarpy.port import identity, probe
from yarpy.port.assembly import open_hub
from yarpy.port.choosing import MEMORY
from yarpy.port.connecting import joined
from yarpy.port.hub import Hub
from yarpy.port.mailbox import Mailbox
from yarpy.registry import carriers
from yarpy.transports.bind import listening_host
from yarpy.transports.tcp import is_taken
from yarpy.wire.message import JSON, Lines, Malformed, Message, Packet, Refused

if TYPE_CHECKING:
    from yarpy.names.discovery import Responder
    from yarpy.nameserver.database import Database
    from yarpy.nameserver.ros_delegate import RosDelegate
    from yarpy.nameserver.zenoh_delegate import ZenohDelegate

log = logger("yarpy.name_server")

WORKERS: Final = 4
BUSY: Final = 1.0  # seconds for a port that lives to say its name
GROUP: Final = "224.2.1.1"
MAX_EVENTS: Final = 10_000
MAX_COMMAND: Final = 1 << 20  # bytes of one command
MAX_UNFINISHED: Final = 1 << 24  # bytes of all that have begun to come


class _Desk(Mailbox):
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


class NameServer:
    """A YARP name server in this process. Port 0 takes any free number.

    Used as a context manager it is this process's default server while open; `environment` is what
    a child process needs to use it too. C++ YARP programs can use it like their own.

    host: the address to tell others; the server listens on all. portdb, subdb: SQLite files for
    registrations and for subscriptions; without, nothing survives the server. discoverable: answer
    multicast searches (`yarpy detect`). web: a directory whose files browsers see at `/web/`. ros:
    the address of a ROS master, which is told of topics and services, and asked for names. zenoh:
    a router of Zenoh, "" for the usual one, where names are told and asked for, too.
    Raises AddressError if the port number is taken, or there is no such directory; NoNameServer if
    there is no such router.
    """

    def __init__(
        self,
        port: int = 0,
        host: str = "127.0.0.1",
        *,
        name: str = ROOT,
        portdb: str | Path | None = None,
        subdb: str | Path | None = None,
        cautious: bool = False,
        discoverable: bool = False,
        web: str | Path | None = None,
        ros: str = "",
        zenoh: str | None = None,
    ) -> None:
        folder = Folder(web) if web is not None else None
        desk = _Desk()
        self._hub = open_hub(
            name,
            desk,
            None,
            tcp_port=port,
            host=host,
            limit=MAX_COMMAND,
            input_limit=MAX_UNFINISHED,
            register=False,
            directory=True,
        )
        self.host = host
        self.port = self._hub.port
        self.client = client_of(Server(host, self.port))
        self.name = name
        self.service = NameService(
            NameStore(host, self.port, is_taken=self._is_taken),
            Topology(time.time),
            self._is_alive,
        )
        self._pages = NamePage(name, self._contacts, self.service.verbs, folder)
        self._database: Database | None = None
        self._responder: Responder | None = None
        self._collector: Collector | None = None
        self._ros: RosDelegate | None = None
        self._zenoh: ZenohDelegate | None = None
        self._queues: list[SimpleQueue[Action | None]] = [SimpleQueue() for _ in range(WORKERS)]
        self._events: SimpleQueue[Bottle | None] = SimpleQueue()
        self.on_command: Callable[[str, str], None] | None = None
        try:
            if portdb is not None or subdb is not None:
                self._open_database(portdb, subdb, cautious)
            self._register_self()
            if ros:
                self._join_ros(ros)
            if zenoh is not None:
                self._join_zenoh(zenoh)
            for queue in self._queues:
                self._start(lambda queue=queue: self._work(queue), "wiring")  # type: ignore[misc]
            self._start(self._tell, "events")
            self._collector = Collector(self.service, self._obey, name)
            if discoverable:
                self._open_responder()
        except BaseException:
            self.close()
            raise
        self._hub.callbacks.lines_for_people = self._page
        self._hub.callbacks.on_page = self._pages
        desk.open(self._answer)

    @property
    def address(self) -> str:
        """`host:port`."""
        return self._hub.contact.address

    @property
    def environment(self) -> dict[str, str]:
        """Variables for a child process that is to use this server: `{**os.environ, **these}`."""
        return {"YARPY_SERVER": self.address}

    @property
    def hub(self) -> Hub:
        """The server's port: its connections and counters."""
        return self._hub

    # -- commands ---------------------------------------------------------------------------------

    def _is_taken(self, host: str, number: int) -> bool:
        """Whether an unregistered program on this computer listens there, such as a port that
        outlived the previous server. (C++ lends the number, and the new port cannot open.)"""
        return self._is_here(host) and is_taken(number)

    def _is_alive(self, contact: Contact) -> bool:
        """Whether the port of that name is there; one that is silent may be stopped or busy, and a
        host that cannot be reached may come back."""
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
            elif alive and self._ros is not None:
                self._ros.announced(name)

    def _refusal(self, link: Inbound, words: Bottle) -> str:
        """Why the peer may not give such a command; "" if it may."""
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
            if self._ros is not None and event[0] == Vocab("del"):
                self._ros.gone(str(event[1]))
            if self._zenoh is not None and event[0] in (Vocab("add"), Vocab("del")):
                self._zenoh.changed(str(event[1]))
            if self._hub.outputs and self._events.qsize() < MAX_EVENTS:
                self._events.put(event)
        for action in reply.actions:
            self._queues[hash((action.source, action.destination)) % WORKERS].put(action)

    def _register_self(self) -> None:
        answer = self.service.answer
        answer(Bottle(["register", self.name, "tcp", self.host, self.port]))
        known = carriers.names()
        answer(Bottle(["set", self.name, "offers", *known]))
        answer(Bottle(["set", self.name, "accepts", *known]))
        bound = listening_host()
        answer(Bottle(["set", self.name, "ips", *([bound] if bound else local_addresses())]))
        answer(Bottle(["set", self.name, "process", os.getpid()]))
        answer(Bottle(["register", "fallback", "mcast", GROUP, default_port(os.environ)]))
        answer(Bottle(["set", self.name, "nameserver", "true"]))

    def _join_ros(self, uri: str) -> None:
        from yarpy.nameserver.ros_delegate import RosDelegate

        self._ros = RosDelegate(RosMaster(uri), self.service)
        self.service.elsewhere = self._ros.query

    def _join_zenoh(self, where: str) -> None:
        from yarpy.names.zenoh import ZenohNames
        from yarpy.nameserver.zenoh_delegate import ZenohDelegate

        names = ZenohNames(where, self.name)
        names.open()
        delegate = self._zenoh = ZenohDelegate(names, self.service, self._obey, self.host)
        before = self.service.elsewhere
        self.service.elsewhere = lambda name: (before and before(name)) or delegate.query(name)
        for contact in self._contacts():  # of a database
            if contact.name != self.name and contact.carrier != "mcast":
                delegate.changed(contact.name)

    def _open_database(
        self, portdb: str | Path | None, subdb: str | Path | None, cautious: bool
    ) -> None:
        from yarpy.nameserver.database import Database

        self._database = Database(portdb or ":memory:", subdb or ":memory:", cautious=cautious)
        self._database.load(self.service)
        self._database.start()

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
            for link in self._hub.outputs:
                try:
                    link.send(packet)
                except YarpError as error:
                    self._hub.drop_output(link, str(error))

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
        if self._ros is not None:
            self._ros.close()
            self._ros = None
        if self._zenoh is not None:
            self._zenoh.close()
            self._zenoh = None
        self._hub.close()
        for queue in self._queues:
            queue.put(None)
        self._events.put(None)
        if self._collector is not None:
            self._collector.close()
            self._collector = None
        if self._responder is not None:
            self._responder.close()
            self._responder = None
        if self._database is not None:
            self._database.close()
            self._database = None

    def serve(self) -> None:
        """Wait until the process is interrupted."""
        threading.Event().wait()

    def __enter__(self) -> Self:
        DEFAULT.push(self.client)
        return self

    def __exit__(self, *details: object) -> None:
        DEFAULT.pop(self.client)
        self.close()

    def __repr__(self) -> str:
        return f"<NameServer {self.name} at {self.address}>"
