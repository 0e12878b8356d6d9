"""Contact and ContactStyle: where a port is, and how something is to be connected."""

from __future__ import annotations

from typing import Any

import yarpy
from yarp._nested_contact import NestedContact


class Contact:
    """A name, a carrier, a host and a port number. `Contact("/name")`, `Contact("host", 10000)`."""

    def __init__(
        self, name: str = "", carrier: Any = "", hostname: str = "", port: int = -1
    ) -> None:
        if isinstance(carrier, int):
            name, hostname, port, carrier = "", name, carrier, ""
        self._name, self._host, self._port = name, hostname, port
        self._carrier: str = carrier
        self._timeout = -1.0
        self._nested = NestedContact()

    @classmethod
    def _of(cls, contact: yarpy.Contact | None) -> Contact:
        if contact is None:
            return cls()
        return cls(contact.name, contact.carrier, contact.host, contact.port or -1)

    def getName(self) -> str:
        return self._name

    def getRegName(self) -> str:
        return self._name or f"{self._carrier or 'tcp'}://{self._host}:{self._port}"

    def getHost(self) -> str:
        return self._host

    def getPort(self) -> int:
        return self._port

    def getCarrier(self) -> str:
        return self._carrier

    def isValid(self) -> bool:
        """Return whether it says where to connect to."""
        return self._port >= 0

    def setName(self, name: str) -> None:
        self._name = name

    def setHost(self, hostname: str) -> None:
        self._host = hostname

    def setPort(self, port: int) -> None:
        self._port = port

    def setCarrier(self, carrier: str) -> None:
        self._carrier = carrier

    def setSocket(self, carrier: str, hostname: str, port: int) -> None:
        self._carrier, self._host, self._port = carrier, hostname, port

    def setTimeout(self, timeout: float) -> None:
        self._timeout = timeout

    def getTimeout(self) -> float:
        return self._timeout

    def hasTimeout(self) -> bool:
        return self._timeout > 0

    def getNested(self) -> NestedContact:
        """Return what `setNestedContact` was given: a topic and its node."""
        return self._nested

    def setNestedContact(self, nestedContact: NestedContact) -> None:
        self._nested = nestedContact

    def toURI(self, includeCarrier: bool = True) -> str:
        """`tcp://host:port/name`."""
        start = f"{self._carrier}:/" if includeCarrier and self._carrier else ""
        host = f"/{self._host}" if self.isValid() else ""
        port = f":{self._port}" if self.isValid() else ""
        return f"{start}{host}{port}/" if host else start + self._name

    def toString(self) -> str:
        """The name with the carrier, or else the address."""
        if self._name:
            return f"{self._carrier}:/{self._name}" if self._carrier else self._name
        return self.toURI()

    toString_c = toString

    @staticmethod
    def fromString(txt: str) -> Contact:
        """Read `carrier://host:port/name`."""
        try:
            from yarpy.contact import parse_contact

            return Contact._of(parse_contact(txt))
        except yarpy.AddressError:
            return Contact()

    @staticmethod
    def fromConfig(config: Any) -> Contact:
        """Read `carrier`, `ip`, `port_number` of a Property."""
        return Contact(
            config.find("name").asString(),
            config.find("carrier").asString(),
            config.find("ip").asString(),
            config.find("port_number").asInt32() if config.check("port_number") else -1,
        )

    @staticmethod
    def convertHostToIp(name: str) -> str:
        """The address of a host, or its name if it has none."""
        import socket

        try:
            return socket.gethostbyname(name)
        except OSError:
            return name


class ContactStyle:
    """How to connect or to ask."""

    OPENENDED = 0
    END_WITH_FROM_PORT = 1
    END_WITH_TO_PORT = 2
    NO_PERSISTENCE = 3

    def __init__(self) -> None:
        self.admin = False
        self.quiet = False
        self.verboseOnSuccess = True
        self.timeout = -1.0
        self.carrier = ""
        self.expectReply = True
        #: whether the name server is to make the connection, whenever both ports are there
        self.persistent = False
        self.persistenceType = self.OPENENDED
