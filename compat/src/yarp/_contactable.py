"""Contactable: what every port can do - be open under a name, have connections, call a reader.

Rules: a port of yarpy is made by `open`. Errors are False, and said on standard error.
A reader (`setReader`, `useCallback`) is called from a thread of the port, one message at a time.
"""

from __future__ import annotations

import atexit
import sys
import threading
import weakref
from collections.abc import Callable
from typing import Any, Final

import yarpy
from yarp import _names
from yarp._connection import ConnectionReader, Raw
from yarp._contact import Contact
from yarp._log import say
from yarp._memory import encoded
from yarp._property import Property
from yarp._type import Type

# Seconds for which closing waits for a reader that is at work. C++ waits as long as it takes.
PATIENCE: Final = 2.0

# Ports that a program leaves open are closed when it ends, as C++ does.
_open: weakref.WeakSet[Contactable] = weakref.WeakSet()


@atexit.register
def _close_all() -> None:
    for port in [*_open]:
        port.close()


class Contactable:
    """The common part of all ports. Subclasses make the port of yarpy in `_make`."""

    def __init__(self) -> None:
        self._port: Any = None
        self._name = ""
        self._envelope: str | None = None
        self._last: yarpy.Message | None = None  # read last: its envelope, its answer
        self._reader: Any = None
        self._pump: threading.Thread | None = None
        self._resumed = threading.Event()
        self._resumed.set()
        self._properties = Property()
        self._reporter: Any = None
        self._type = Type.anon()
        self._locals = 0  # connections over which objects go as they are

    def _make(self, name: str, tcp_port: int) -> Any:
        raise NotImplementedError

    def open(self, name: str | Contact, registerName: bool = True) -> bool:
        """Open the port; without a name, or with `...`, the name server chooses one. Where there is
        no name server, a port without a name opens unregistered."""
        number = 0
        if isinstance(name, Contact):
            number, name = max(name.getPort(), 0), name.getName()
        if not isinstance(name, str):
            raise TypeError(f"a port is opened by its name, not by {name!r}")
        unnamed, name = not name, name or "..."
        if not name.startswith(("/", "...", "=")):
            say("ERROR", f"|yarp.os.Port| Port name '{name}' needs to start with a '/' character")
            return False
        self.close()
        self._name = name
        try:
            self._port = self._make_somehow(name, number) if unnamed else self._make(name, number)
        except (yarpy.YarpError, OSError) as error:
            say("ERROR", f"|yarp.os.Port| Port {name} failed to open: {error}")
            return False
        self._name = self._port.name
        _open.add(self)
        self._start()
        return True

    def _make_somehow(self, name: str, tcp_port: int) -> Any:
        """A port for a program that does not care what it is called."""
        try:
            return self._make(name, tcp_port)
        except yarpy.NoNameServer:
            return self._make("", tcp_port)

    def close(self) -> None:
        """Close it; the name is given back."""
        port, self._port = self._port, None
        if port is not None:
            port.close()
        self._resumed.set()
        self._join()

    def interrupt(self) -> None:
        """Stop reading and writing, until `resume`."""
        self._resumed.clear()
        if self._port is not None:
            self._port.interrupt()

    def resume(self) -> None:
        """Undo `interrupt`."""
        if self._port is not None:
            self._port.resume()
        self._resumed.set()

    def __del__(self) -> None:
        port = getattr(self, "_port", None)
        if port is not None and not port.closed and not sys.is_finalizing():
            self._port = None
            # Closing waits for threads, perhaps for this one.
            threading.Thread(target=port.close, name="yarp close", daemon=True).start()

    # -- connections --------------------------------------------------------------------------

    def addOutput(self, name: str | Contact, carrier: str = "") -> bool:
        """Send what is written to another port, too."""
        target = name.getRegName() if isinstance(name, Contact) else name
        if self._port is None:
            return False
        try:
            self._port.connect(target, carrier or "tcp")
        except yarpy.YarpError as error:
            say("ERROR", f"|yarp.os.Port| {error}")
            return False
        return True

    def getName(self) -> str:
        """The name, "" before it was open."""
        return self._name

    def where(self) -> Contact:
        """Where the port listens."""
        return Contact._of(None if self._port is None else self._port.contact)

    def getInputCount(self) -> int:
        """How many ports write to it."""
        return 0 if self._port is None else len(self._port.inputs)

    def getOutputCount(self) -> int:
        """How many ports it writes to."""
        return 0 if self._port is None else len(self._port.outputs)

    def isWriting(self) -> bool:
        """False: when `write` returns, the message is in the hands of the system."""
        return False

    def getReport(self, reporter: Any) -> None:
        """Nothing to tell but what `setReporter` tells."""

    def setReporter(self, reporter: Any) -> None:
        """Call `reporter.report` when connections come and go."""
        self._reporter = reporter

    def _event(self, event: yarpy.ConnectionEvent) -> None:
        """A connection came or went."""
        if event.carrier == "local" and not event.incoming:
            self._locals += 1 if event.created else -1
        if self._reporter is not None:
            self._reporter.report(PortInfo(event))

    def _leaving(self, writer: Any) -> Any:
        """Return what is sent; a copy where the reader would get the object itself."""
        native = writer._outgoing()
        held = self._locals and not isinstance(native, Raw)
        return Raw(encoded(native)) if held else native

    def resetReporter(self) -> None:
        """Report no more."""
        self.setReporter(None)

    # -- envelopes ----------------------------------------------------------------------------

    def setEnvelope(self, envelope: Any) -> bool:
        """Send this beside each message from now on: a Stamp or a Bottle."""
        self._envelope = envelope._outgoing().to_text() or self._envelope
        return True

    def getEnvelope(self, envelope: Any) -> bool:
        """Take what came beside the last message; False if that is no such object."""
        return self._last is not None and bool(envelope._take_text(self._last.envelope))

    # -- readers ------------------------------------------------------------------------------

    def setReader(self, reader: Any) -> None:
        """Hand every message to `reader.read(connection)`."""
        self._stop()
        self._reader = reader
        self._start()

    def _start(self) -> None:
        if self._port is not None and self._reader is not None and self._pump is None:
            self._pump = threading.Thread(
                target=self._serve, args=(self._port,), name=f"yarp {self._name}", daemon=True
            )
            self._pump.start()

    def _stop(self) -> None:
        if self._pump is not None:
            self._reader = None
            port = self._port
            if port is not None:
                port.interrupt()
            self._join()
            if port is not None and self._resumed.is_set():
                port.resume()
        self._reader = None

    def _join(self) -> None:
        pump, self._pump = self._pump, None
        if pump is not None and pump is not threading.current_thread():
            pump.join(PATIENCE)
            if pump.is_alive():
                say(
                    "WARNING",
                    f"|yarp.os.Port| {self._name}: its reader is still at work, and is not waited "
                    "for any longer",
                )

    def _serve(self, port: Any) -> None:
        while not port.closed:
            self._resumed.wait()
            try:
                message = port.read()
            except yarpy.PortClosed:
                if self._reader is None:
                    return
                continue
            reader, self._last = self._reader, message
            if reader is None:
                return
            self._try(self._hand, reader, message)

    @staticmethod
    def _try(act: Callable[..., object], *arguments: Any) -> None:
        """Call what is of the program; what it raises is shown, and the port goes on."""
        try:
            act(*arguments)
        except Exception:
            import traceback

            traceback.print_exc()

    def _hand(self, reader: Any, message: yarpy.Message) -> None:
        connection = ConnectionReader(message, receiver=self._name)
        reader.read(connection)
        connection.flushWriter()

    # -- what is the same whether it is said or not -------------------------------------------

    def acquireProperties(self, readOnly: bool) -> Property:
        """Values that a program notes at its port."""
        return self._properties

    def releaseProperties(self, prop: Property) -> None:
        """Done with them."""

    def promiseType(self, typ: Type) -> None:
        """Say what the port carries. Readers are told by what is sent."""
        self._type = typ

    def getType(self) -> Type:
        """Return what was promised, or a type without a name."""
        return self._type

    def setInputMode(self, expectInput: bool) -> None:
        """Both directions work."""

    def setOutputMode(self, expectOutput: bool) -> None:
        """Both directions work."""

    def setRpcMode(self, expectRpc: bool) -> None:
        """Questions are told by what is sent."""

    def setReadOnly(self) -> None:
        self.setOutputMode(False)

    def setWriteOnly(self) -> None:
        self.setInputMode(False)

    def setRpcClient(self) -> None:
        self.setRpcMode(True)

    def setRpcServer(self) -> None:
        self.setRpcMode(True)

    def setAdminReader(self, reader: Any) -> None:
        """Let a reader answer administrative messages that the port does not know."""
        if self._port is not None:
            self._port.on_admin(lambda message: self._hand(reader, message))

    def setCallbackLock(self, mutex: Any = None) -> bool:
        """Messages are handed over one at a time anyway."""
        return True

    def removeCallbackLock(self) -> bool:
        return True

    def lockCallback(self) -> bool:
        return True

    def tryLockCallback(self) -> bool:
        return True

    def unlockCallback(self) -> None:
        """Nothing to do."""

    def includeNodeInName(self, flag: bool) -> None:
        """Names of nodes are part of names."""

    def setVerbosity(self, level: int) -> None:
        """Do nothing: what is printed is that of the whole program, see `Network.setVerbosity`."""

    def getVerbosity(self) -> int:
        return 1

    @staticmethod
    def _names() -> yarpy.NameClient | None:
        return _names.names()


class PortInfo:
    """The argument of a PortReport: a connection came or went."""

    PORTINFO_NULL = 0
    PORTINFO_CONNECTION = 1
    PORTINFO_MISC = 2

    def __init__(self, event: yarpy.ConnectionEvent) -> None:
        self.tag = self.PORTINFO_CONNECTION
        self.incoming = event.incoming
        self.created = event.created
        self.sourceName = event.source
        self.targetName = event.target
        self.carrierName = event.carrier
        self.portName = event.target if event.incoming else event.source
        self.message = str(event)


class PortReport:
    """Subclasses define `report`."""

    def report(self, info: PortInfo) -> None:
        """Called when a connection comes or goes."""
