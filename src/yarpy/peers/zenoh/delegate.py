"""Beside names on Zenoh: `yarpy server --zenoh` tells them what is registered here, and asks them.

Rules: so programs of C++ YARP take part, which know a name server alone. Who asks here for a name
that nobody registered here is told where its port is; a port that cannot be dialled from this
computer is told as a number of this one, which leads there (`tunnel/gateway.py`). The
other way round, those who cannot dial a port that was registered here reach it through this server,
if the rules of this computer (access.toml) let everybody do everything there.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from queue import SimpleQueue
from typing import Final

from yarpy.config import access_file
from yarpy.contact import Contact
from yarpy.data.bottle import Bottle
from yarpy.errors import NoNameServer, YarpError
from yarpy.link.begin.admission import peer_of
from yarpy.log import logger
from yarpy.names.address import is_local
from yarpy.nameserver.command import NameService
from yarpy.nameserver.delegate import DelegateContext
from yarpy.peers.zenoh.address import host_zid
from yarpy.peers.zenoh.names import ZenohNames
from yarpy.peers.zenoh.tunnel.gateway import Gateway, bring
from yarpy.peers.zenoh.tunnel.pipe import ZenohPipe

log = logger("yarpy.name_server")

BACKOFF: Final = 2.0  # seconds for which a router that is away is asked for no names


class ZenohDelegate:
    """Stands between `names` and what `service` knows. `obey` carries out a command there, `host`
    is the address of this server."""

    def __init__(
        self, names: ZenohNames, service: NameService, obey: Callable[[Bottle], None], host: str
    ) -> None:
        self.names = names
        self.about = f"names on Zenoh, at {names.place()}"
        self._service = service
        self._obey = obey
        self._host = host
        self._gateway = Gateway()
        self._away = 0.0  # until when no names are asked for
        self._told: dict[str, Contact] = {}
        self._work: SimpleQueue[str | None] = SimpleQueue()
        names.on_lost = self._lose
        self._thread = threading.Thread(target=self._run, name="yarpy server zenoh", daemon=True)
        self._thread.start()

    def registered(self, name: str) -> None:
        """Tell of it, in a thread of its own."""
        self._work.put(name)

    def announced(self, name: str) -> None:
        """Do nothing: it was told of when it was registered."""

    def unregistered(self, name: str) -> None:
        """Take back what was told."""
        self._work.put(name)

    def query(self, name: str) -> Contact | None:
        """Return the address of a port that tells itself; None if there is none, or no router."""
        if not name.startswith("/") or time.monotonic() < self._away:
            return None
        try:
            contact = self.names.query(name)
            if contact is None or not host_zid(contact.host):
                return contact
            number = self._gateway.number(contact.host, contact.port)
            return Contact(contact.carrier, name, self._host, number)
        except NoNameServer as error:
            self._away = time.monotonic() + BACKOFF
            log.warning("%s", error)
        except (YarpError, OSError) as error:
            log.info("%s: %s", name, error)
        return None

    def close(self) -> None:
        """Tell of nothing any more."""
        self._work.put(None)
        self._thread.join(BACKOFF)
        self._gateway.close()
        self.names.close()

    def _lose(self, name: str) -> None:
        """Another program tells of a port of that name: what was registered here is older."""
        self._told.pop(name, None)
        self._obey(Bottle(["unregister", name]))

    # -- the thread -------------------------------------------------------------------------------

    def _run(self) -> None:
        while (name := self._work.get()) is not None:
            try:
                self._tell(name)
            except (YarpError, OSError) as error:
                log.warning("%s is not told on Zenoh: %s", name, error)

    def _tell(self, name: str) -> None:
        with self._service.lock:
            contact = self._service.store.query(name)
        if contact == self._told.get(name):
            return
        if contact is None:
            del self._told[name]
            self.names.unregister(name)
            return
        self._told[name] = contact
        self.names.adopt(contact, lambda pipe: self._bring(pipe, contact), is_local(contact.host))

    def _bring(self, pipe: ZenohPipe, contact: Contact) -> None:
        """Pass on somebody's connection. The port sees this computer at the other end, so its rules
        are applied here: who may not do everything there stays outside."""
        admission = access_file.gate(contact.name).admit(peer_of(pipe.remote[0], ""))
        if not admission.everything:
            log.warning(
                "%s: %s is not let in through Zenoh, as no rule allows it everything there",
                contact.name,
                admission.peer,
            )
            pipe.close()
            return
        bring(pipe, contact.host, contact.port)


def open_delegate(place: str, context: DelegateContext) -> ZenohDelegate:
    """Tell and ask names on Zenoh at `place`, as in YARPY_ZENOH. Raises NoNameServer."""
    names = ZenohNames(place, context.name)
    names.open()
    return ZenohDelegate(names, context.service, context.obey, context.host)
