"""Registration: a port's name, where it listens, and what the name service knows of the two.

Rules: a name belongs to the living port that has it. Nothing stays registered of a port that could
not be opened. A name service that does not answer is an error when a port opens, and none when it
closes.
"""

from __future__ import annotations

import errno
import os
import threading
from collections.abc import Callable
from typing import Final

from yarpy.config import access_file
from yarpy.config.configuration import port_name
from yarpy.contact import Contact, check_name
from yarpy.errors import AddressError, LinkClosed, NoNameServer, Timeout, YarpError
from yarpy.link.begin.accept_loop import LOOP
from yarpy.log import logger
from yarpy.names.address import is_local, local_addresses, outward_address
from yarpy.names.base import NameClient, Values, introduce
from yarpy.names.default import DEFAULT, secret
from yarpy.names.fallback_client import SeveralNames
from yarpy.port.connect.probe import who
from yarpy.registry import carriers
from yarpy.route import Declared
from yarpy.scope import Scope, moment, outside, remaining
from yarpy.transports.bind import SETTING, listening_host

log = logger("yarpy.port")

BUSY: Final = 3.0  # seconds for a port that lives to say so
AGAIN: Final = 10.0  # seconds at most for a thread that is just telling the name once more
FORGETTING: Final = 1.0  # seconds to take out the name of a port that could not be opened

_TAKEN: Final = (
    '"{}" was taken by another program at the same moment: close that one, or choose another name'
)


class Registration:
    """The name and address under which others find a port. `names` None: the default service;
    `register` False: no name service; `renamed`: the environment was asked for another name
    already. `port` is the number of the listening socket, `contact` where that is found.

    Raises AddressError (name unusable), NoNameServer.
    """

    def __init__(
        self,
        name: str,
        names: NameClient | None,
        port_type: str,
        register: bool,
        renamed: bool = False,
    ) -> None:
        self.type = port_type
        self.declared = Declared(type=port_type)
        self.port = 0
        self.answered = True  # the name service, when the port last asked it for something
        self.contact: Contact
        self.group_name = ""  # the temporary name of our multicast group
        self.key = secret()
        access_file.current()  # a broken file is told before anybody hears of the port
        self.registered = register and bool(name)
        if name and not name.startswith(("...", "=")):
            name = check_name(name if renamed else port_name(name, os.environ))
        self.name = name
        self._has_name = False  # in the name service
        self.again = threading.RLock()  # held while a server that came back is told of us
        self.names = names
        if self.registered and names is None:
            self.names = DEFAULT.current()

    def open(self, port: int, host: str, listen: Callable[[int], int]) -> None:
        """Listen on `port`, 0 for any free one, and register.

        `listen` opens the socket: it returns the number it got, or raises OSError. Raises
        AddressError (name or number in use), NoNameServer.
        """
        if not 0 <= port < 65536:
            raise AddressError(
                f'"{self.name}" cannot listen on TCP port {port}: choose a number below 65536, or '
                "0 for any free one"
            )
        names = self.names if self.registered else None
        bound = listening_host()
        if names is not None and names.allocates and not port:
            self._refuse_taken(names)
            contact = self._register(names)
            self.name = contact.name
            try:
                self.port = listen(contact.port)
            except OSError:
                # Somebody who never asked the name server listens on that number; or a program
                # that has taken the name at the same moment.
                self._refuse_rival(contact)
                self.port = self._listen(listen, 0)
                contact = self._register(names, "tcp", contact.host, self.port)
            if bound and contact.host != bound:  # where the name server sees us nobody listens
                contact = self._register(names, "tcp", bound, self.port)
        else:
            if names is not None:
                self._refuse_taken(names)
            self.port = self._listen(listen, port)
            where = host or bound or ("127.0.0.1" if names is not None else outward_address())
            if names is not None:
                contact = self._register(names, "tcp", where, self.port)
            else:
                self.name = self.name or f"/{where}_{self.port}"
                contact = Contact("tcp", self.name, where, self.port)
        self.contact = contact
        self.name = contact.name

    def _register(
        self,
        names: NameClient,
        carrier: str | None = None,
        host: str | None = None,
        port: int | None = None,
    ) -> Contact:
        """Register. A signal may cut this when the service has the name already and we do not know
        that yet; `forget` then takes it out."""
        had = self._has_name
        self._has_name = True
        try:
            return names.register(self.name, carrier, host, port, self.type or None)
        except YarpError:
            self._has_name = had
            raise

    def _listen(self, listen: Callable[[int], int], port: int) -> int:
        try:
            return listen(port)
        except OSError as error:
            bound = listening_host()
            where = f" of {SETTING}={bound}" if bound else ""
            advice = "choose another number, or 0 for any free one"
            if error.errno in (errno.EMFILE, errno.ENFILE):
                advice = "this program has too many files and connections open (ulimit -n)"
            elif bound:
                advice += f", and an address of this computer for {SETTING}"
            raise AddressError(
                f'"{self.name}" cannot listen on TCP port {port}{where} ({error.strerror}); '
                f"{advice}"
            ) from error

    def tell(self) -> None:
        """The port is open: tell the name service what we are, and that we listen. Raises
        AddressError if another program has taken the name at the same moment."""
        names = self.names if self.registered else None
        if names is None:
            return
        self.describe(names)
        if names.allocates and not self._is_ours(names):
            raise AddressError(_TAKEN.format(self.name))

    def _is_ours(self, names: NameClient) -> bool:
        """Return whether the name leads to us: of programs that found it free at the same moment
        the last to register has it."""
        found = names.query(self.name)
        return found is None or found.port == self.port

    def _refuse_taken(self, names: NameClient) -> None:
        """A name belongs to the living port that has it, on whichever computer."""
        if not self.name.startswith("/"):
            return
        try:
            known = names.query(self.name)
        except NoNameServer:
            if isinstance(names, SeveralNames):
                return  # all but the first may be away, and registering asks that one
            raise
        if known is None or known.carrier != "tcp":
            return
        try:
            found = who(known, BUSY, self.key)
        except LinkClosed:
            return  # nobody listens there
        except Timeout as error:
            raise AddressError(
                f'"{self.name}" belongs to a program at {known.address} that does not answer just '
                "now, perhaps stopped or busy: end it, or take its name out by `yarpy name "
                f"unregister {self.name}`, or choose another name"
            ) from error
        ours = is_local(known.host) and any(one.name == self.name for one in LOOP.listening)
        if found == self.name and ours:
            raise AddressError(
                f'"{self.name}" is in use by this program itself: close() that port first, or '
                "choose another name"
            )
        if found == self.name:
            raise AddressError(
                f'"{self.name}" is in use by a port at {known.address}: close that program, or '
                "choose another name"
            )

    def _refuse_rival(self, contact: Contact) -> None:
        """Raise AddressError if a port of our name listens where we should."""
        try:
            found = who(contact, BUSY, self.key)
        except (LinkClosed, Timeout):
            return
        if found == self.name:
            self._has_name = False
            raise AddressError(_TAKEN.format(self.name))

    def describe(self, names: NameClient) -> None:
        """Tell a name service what we are, and that we listen."""
        known: Values = carriers.offered()
        bound = listening_host()
        told: dict[str, Values] = {
            "offers": known,
            "accepts": known,
            "ips": [bound] if bound else local_addresses(),
            "process": [os.getpid()],
        }
        if self.declared.graph:
            told[self.declared.graph] = ["own"]  # no name server has to tell the graph of us
        introduce(names, self.name, told)

    def service(self) -> NameClient | None:
        """The name service to look others up with, None if there is none."""
        if self.names is None:
            try:
                self.names = DEFAULT.current()
            except NoNameServer:
                return None
        return self.names

    def locate(self, wanted: Contact) -> Contact | None:
        """Return the address of a destination; None if no name service knows. Raises NoNameServer
        if none answers."""
        if wanted.placed:
            return wanted
        names = self.service() if wanted.name.startswith("/") else None
        return None if names is None else names.query(wanted.name)

    def group(self) -> tuple[str, int]:
        """The multicast group of this port: one for all its connections."""
        names = self.service()
        if names is None:
            return "224.3.1.1", 11000  # what C++ falls back to without a name server
        contact = names.query(self.group_name) if self.group_name else None
        if contact is None:
            contact = names.register("...", "mcast", None, None if names.allocates else self.port)
            self.group_name = contact.name
            if self.registered:
                names.set(self.name, "owns", contact.name)
        return contact.host, contact.port

    def forget(self) -> None:
        """Opening failed: leave no name behind. It may have failed because its time was over, so
        this has some of its own."""
        # A name that the service chooses, and that never reached us, is one that nobody looks for.
        if self._has_name and self.names is not None and self.name.startswith("/"):
            try:
                with outside(), Scope(moment(FORGETTING)):
                    if not self.port or self._is_ours(self.names):
                        self.names.unregister(self.name)
            except YarpError:
                pass  # nobody to tell; a name server forgets names where nobody listens

    def give_back(self) -> None:
        """The port closes. What somebody else has registered under its name meanwhile stays."""
        if not self.registered or self.names is None:
            return
        waited = self.again.acquire(timeout=min(remaining(), AGAIN))
        try:
            if self.group_name:
                self.names.unregister(self.group_name)
            if self._is_ours(self.names):
                self.names.unregister(self.name)
        finally:
            if waited:
                self.again.release()
