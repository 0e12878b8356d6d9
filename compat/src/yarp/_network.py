"""Network: connections, names, and whether there is a name server.

Rules: nothing has to be begun or ended; `init` and `fini` are there for the programs that say so.
What goes wrong is False, and said on standard error unless `quiet`.
"""

from __future__ import annotations

import os
from typing import Any

import yarpy
from yarp import _names
from yarp._contact import Contact, ContactStyle
from yarp._log import say
from yarp._name_server import (
    detect_name_server,
    query_bypass,
    register_carrier,
    set_name_server_contact,
    set_name_server_name,
    write_to_name_server,
)
from yarp._qos import get_connection_qos, set_connection_qos
from yarp._value import Value
from yarpy.data.text import plain_text


class NetworkBase:
    """The methods of `Network` and `NetworkBase`; all of them static."""

    @staticmethod
    def initMinimum(clockType: int = 0, custom: Any = None) -> None:
        """Nothing to do."""

    @staticmethod
    def finiMinimum() -> None:
        """Nothing to do."""

    @staticmethod
    def autoInitMinimum(clockType: int = 0, custom: Any = None) -> None:
        """Nothing to do."""

    @staticmethod
    def yarpClockInit(clockType: int = 0, custom: Any = None) -> None:
        """Nothing to do: time is that of the system."""

    @staticmethod
    def isNetworkInitialized() -> bool:
        return True

    @staticmethod
    def initialized() -> bool:
        return True

    # -- connections --------------------------------------------------------------------------

    @staticmethod
    def connect(src: str, dest: str, carrier: Any = "", quiet: bool = True) -> bool:
        """Connect two ports; a ContactStyle may say how, also that the name server shall do it."""
        style = carrier if isinstance(carrier, ContactStyle) else None
        name = style.carrier if style is not None else carrier
        if style is not None and style.persistent:
            return _persist(["subscribe", src, _decorated(dest, name), *_kind(style)])
        try:
            yarpy.connect(src, dest, name or "", names=_names.names())
        except yarpy.YarpError as error:
            return _failed(error, style.quiet if style is not None else quiet)
        return True

    @staticmethod
    def disconnect(src: str, dest: str, carrier: Any = "", quiet: bool = True) -> bool:
        """End a connection; False if there was none."""
        if isinstance(carrier, ContactStyle) and carrier.persistent:
            return _persist(["unsubscribe", src, dest])
        try:
            return yarpy.disconnect(src, dest, names=_names.names())
        except yarpy.YarpError as error:
            return _failed(error, quiet)

    @staticmethod
    def disconnectInput(src: str, dest: str, silent: bool = False) -> int:
        """End a connection by asking the receiver; 0 if that went well."""
        try:
            reply = yarpy.admin(src, yarpy.Vocab("del"), dest, names=_names.names())
        except yarpy.YarpError as error:
            _failed(error, silent)
            return -1
        return 0 if reply and reply[0] == 0 else -1

    @staticmethod
    def isConnected(src: str, dest: str, carrier: Any = "", quiet: bool = True) -> bool:
        """Return whether two ports are connected, over this carrier if one is named."""
        name = carrier.carrier if isinstance(carrier, ContactStyle) else carrier
        try:
            return yarpy.is_connected(
                src, dest, name if isinstance(name, str) else "", names=_names.names()
            )
        except yarpy.YarpError:
            return False

    @staticmethod
    def exists(port: str, quiet: Any = True, checkVer: bool = True) -> bool:
        """Return whether a port of that name is there and answers."""
        try:
            return yarpy.exists(port, names=_names.names())
        except yarpy.YarpError:
            return False

    @staticmethod
    def sync(port: str, quiet: bool = True) -> bool:
        """Wait until a port is there."""
        try:
            return yarpy.wait_for(port, names=_names.names())
        except yarpy.YarpError as error:
            return _failed(error, quiet)

    @staticmethod
    def waitPort(target: str, quiet: bool = False) -> bool:
        """The same as `sync`."""
        return NetworkBase.sync(target, quiet)

    @staticmethod
    def waitConnection(source: str, destination: str, quiet: bool = False) -> bool:
        """Wait until two ports are connected."""
        try:
            return yarpy.wait_for(source, destination, names=_names.names())
        except yarpy.YarpError as error:
            return _failed(error, quiet)

    @staticmethod
    def poll(target: str, silent: bool = False) -> int:
        """Print what a port says of itself; 0 if it answers."""
        try:
            for line in yarpy.ping(target, names=_names.names()):
                print(line)
        except yarpy.YarpError as error:
            _failed(error, silent)
            return 1
        return 0

    @staticmethod
    def write(
        contact: Contact | str,
        cmd: Any,
        reply: Any,
        admin: Any = False,
        quiet: bool = False,
        timeout: float = -1,
    ) -> bool:
        """Ask a port without having one; a ContactStyle may say how."""
        style = admin if isinstance(admin, ContactStyle) else None
        if style is not None:
            admin, quiet, timeout = style.admin, style.quiet, style.timeout
        name = contact if isinstance(contact, str) else contact.getRegName()
        limit = timeout if timeout > 0 else 10.0
        try:
            if admin:
                found: Any = yarpy.admin(name, *cmd._native, names=_names.names(), timeout=limit)
                reply._native[:] = found
                return True
            with yarpy.RpcClient(name, names=_names.names()) as client:
                answer = client.ask(cmd._outgoing(), limit)
                if answer is not None:
                    reply._take(answer)
        except yarpy.YarpError as error:
            return _failed(error, quiet)
        return True

    @staticmethod
    def sendMessage(port: str, writer: Any, silent: bool = False) -> bool:
        """Send one message to a port without having one."""
        try:
            with yarpy.Port("", names=_names.names()) as out:
                out.connect(port)
                out.write(writer._outgoing())
                out.flush(10.0)
        except yarpy.YarpError as error:
            return _failed(error, silent)
        return True

    # -- names --------------------------------------------------------------------------------

    @staticmethod
    def checkNetwork(timeout: float = -1.0) -> bool:
        """Return whether there is a name server that answers."""
        try:
            yarpy.query("/root", names=_names.names())
        except yarpy.YarpError:
            return False
        return True

    setConnectionQos = staticmethod(set_connection_qos)
    getConnectionQos = staticmethod(get_connection_qos)

    setNameServerName = staticmethod(set_name_server_name)
    setNameServerContact = staticmethod(set_name_server_contact)
    writeToNameServer = staticmethod(write_to_name_server)
    detectNameServer = staticmethod(detect_name_server)
    queryBypass = staticmethod(query_bypass)
    registerCarrier = staticmethod(register_carrier)

    @staticmethod
    def queryName(name: str) -> Contact:
        """Where a port is; not valid if nobody knows."""
        try:
            return Contact._of(yarpy.query(name, names=_names.names()))
        except yarpy.YarpError:
            return Contact()

    @staticmethod
    def registerName(name: str) -> Contact:
        """Let the name server set an address aside for a name."""
        return NetworkBase.registerContact(Contact(name))

    @staticmethod
    def registerContact(contact: Contact) -> Contact:
        """Give the name server a name and its address."""
        client = _client()
        try:
            return Contact._of(
                client.register(
                    contact.getName(),
                    contact.getCarrier() or None,
                    contact.getHost() or None,
                    contact.getPort() if contact.isValid() else None,
                )
            )
        except yarpy.YarpError as error:
            _failed(error, False)
            return Contact()

    @staticmethod
    def unregisterName(name: str) -> Contact:
        """Take a name off the name server."""
        try:
            _client().unregister(name)
        except yarpy.YarpError as error:
            _failed(error, False)
        return Contact(name)

    @staticmethod
    def unregisterContact(contact: Contact) -> Contact:
        """Take the name of a contact off the name server."""
        return NetworkBase.unregisterName(contact.getName())

    @staticmethod
    def setProperty(name: str, key: str, value: Value) -> bool:
        """Let the name server note something about a port."""
        try:
            _client().set(name, key, value.toString())
        except yarpy.YarpError as error:
            return _failed(error, False)
        return True

    @staticmethod
    def getProperty(name: str, key: str) -> Value:
        """Return what the name server has noted about a port."""
        try:
            found = _client().get(name, key)
        except yarpy.YarpError:
            return Value.getNullValue()
        words = [Value.makeValue(plain_text(word))._native for word in found]
        return Value._of(words[0]) if len(words) == 1 else Value.getNullValue()

    @staticmethod
    def setLocalMode(flag: bool) -> bool:
        """Find ports inside this program alone, with no name server."""
        _names.be_local(flag)
        return True

    @staticmethod
    def getLocalMode() -> bool:
        return _names.names() is not None

    @staticmethod
    def getQueryBypass() -> None:
        """Nothing stands in for the name server."""

    @staticmethod
    def getNameServerName() -> str:
        """The namespace in use."""
        from yarpy.config.configuration import configuration

        try:
            return configuration(os.environ).namespace
        except yarpy.YarpError:
            return "/root"

    @staticmethod
    def getNameServerContact() -> Contact:
        """Where the name server is."""
        return NetworkBase.queryName(NetworkBase.getNameServerName())

    @staticmethod
    def isValidPortName(portName: str) -> bool:
        return portName.startswith("/") and len(portName) > 1 and "@" not in portName

    # -- surroundings -------------------------------------------------------------------------

    @staticmethod
    def getEnvironment(key: str, found: Any = None) -> str:
        return os.environ.get(key, "")

    @staticmethod
    def setEnvironment(key: str, val: str) -> None:
        os.environ[key] = val

    @staticmethod
    def unsetEnvironment(key: str) -> None:
        os.environ.pop(key, None)

    @staticmethod
    def getDirectorySeparator() -> str:
        return os.sep

    @staticmethod
    def getPathSeparator() -> str:
        return os.pathsep

    @staticmethod
    def getConfigFile(fname: str) -> str:
        """Where a configuration file of this user is."""
        from yarpy.platform.folders import conf_directory

        return str(conf_directory(os.environ) / fname)

    @staticmethod
    def getDefaultPortRange() -> int:
        from yarpy.config.configuration import default_port

        return default_port(os.environ)

    @staticmethod
    def setVerbosity(verbosity: int) -> None:
        """Print more of what goes on, or less."""
        import logging

        level = (
            logging.DEBUG if verbosity > 0 else logging.WARNING if verbosity < 0 else logging.INFO
        )
        logging.getLogger("yarpy").setLevel(level)

    @staticmethod
    def assertion(shouldBeTrue: bool) -> None:
        if not shouldBeTrue:
            raise AssertionError("Network.assertion")

    @staticmethod
    def localNetworkAllocation() -> bool:
        return False

    @staticmethod
    def lock() -> None:
        """Nothing to do: everything may be called from any thread."""

    unlock = lock


class Network(NetworkBase):
    """`Network.init()`, or an object of this class, at the beginning of a program."""

    @staticmethod
    def init() -> None:
        """Nothing to do."""

    @staticmethod
    def fini() -> None:
        """Nothing to do: every port is closed by its own `close`."""


def _client() -> Any:
    local = _names.names()
    if local is not None:
        return local
    from yarpy.names.default import DEFAULT

    return DEFAULT.current()


def _kind(style: ContactStyle) -> list[str]:
    kinds = {
        ContactStyle.END_WITH_FROM_PORT: ["from"],
        ContactStyle.END_WITH_TO_PORT: ["to"],
    }
    return kinds.get(style.persistenceType, [])


def _decorated(name: str, carrier: str) -> str:
    return f"{carrier}:/{name}" if carrier else name


def _persist(command: list[str]) -> bool:
    from yarpy.network.asking import ask_server

    try:
        ask_server(_names.names(), command)
    except yarpy.YarpError as error:
        return _failed(error, False)
    return True


def _failed(error: Exception, quiet: bool) -> bool:
    if not quiet:
        say("ERROR", str(error))
    return False
