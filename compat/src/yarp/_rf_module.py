"""RFModule: a program that is configured, updated again and again, asked, and closed.

Rules: it is driven by yarpy.Module. Subclasses need not call its `__init__`.
"""

from __future__ import annotations

import threading
from typing import Any, Final, Self

import yarpy
from yarp._bottle import Bottle
from yarp._connection import ConnectionReader
from yarp._log import say
from yarp._portable import PortReader
from yarp._resource_finder import ResourceFinder
from yarpy.data.text import plain_text

UNKNOWN: Final = "command not recognized"
QUIT: Final = ("quit", "exit", "bye")


class RFModule:
    """Subclasses define `configure`, `updateModule`, `getPeriod`, `respond`, `interruptModule` and
    `close`."""

    _driver: _Driver
    _name: str
    _thread: threading.Thread | None

    def __new__(cls, *args: object, **values: object) -> Self:
        self = super().__new__(cls)
        self._driver = _Driver(self)
        self._name = ""
        self._thread = None
        return self

    # -- for subclasses -----------------------------------------------------------------------

    def configure(self, rf: ResourceFinder) -> bool:
        """Open ports, read options; False: give up."""
        return True

    def updateModule(self) -> bool:
        """One step; False: done."""
        return False

    def getPeriod(self) -> float:
        """Seconds from one step to the next."""
        return 1.0

    def respond(self, command: Bottle, reply: Bottle) -> bool:
        """Answer a command by filling `reply`; False: not known."""
        return self._respond_basically(command, reply)

    def interruptModule(self) -> bool:
        """Called when the module is to end."""
        return True

    def close(self) -> bool:
        """Called at the end."""
        return True

    # -- running ------------------------------------------------------------------------------

    def runModule(self, rf: ResourceFinder | None = None) -> int:
        """Configure, update until something ends it, close; 0, or 1 if it was not configured.
        Without an argument it is configured already."""
        return self._driver.run_with(rf)

    def runModuleThreaded(self, rf: ResourceFinder | None = None) -> int:
        """The same in a thread of its own; see `joinModule`."""
        if rf is not None and not self.configure(rf):
            say("ERROR", "|yarp.os.RFModule| RFModule failed to open.")
            return 1
        self._thread = threading.Thread(target=self.runModule, name="yarp module", daemon=True)
        self._thread.start()
        return 0

    def joinModule(self, seconds: float = -1) -> bool:
        """Wait until the thread of `runModuleThreaded` has ended."""
        if self._thread is None:
            return True
        self._thread.join(None if seconds < 0 else seconds)
        return not self._thread.is_alive()

    def stopModule(self, wait: bool = False) -> None:
        """Ask it to end."""
        self._driver.stop()
        if wait and self._thread is not threading.current_thread():
            self.joinModule()

    def isStopping(self) -> bool:
        return self._driver.stopping

    # -- commands -----------------------------------------------------------------------------

    def attach(self, source: Any) -> bool:
        """Answer what comes to a port: `respond`, and quit."""
        source.setReader(_Responder(self))
        return True

    attach_rpc_server = attach

    def attachTerminal(self) -> bool:
        """Answer what is typed, too."""
        threading.Thread(target=self._listen, name="yarp terminal", daemon=True).start()
        return True

    def detachTerminal(self) -> bool:
        return True

    def _listen(self) -> None:
        import sys

        for line in sys.stdin:
            reply = Bottle()
            self.safeRespond(Bottle(line), reply)
            print(reply.toString())
            if self.isStopping():
                return

    def safeRespond(self, command: Bottle, reply: Bottle) -> bool:
        """Answer as `respond` does, or else the words that every module knows."""
        return bool(self.respond(command, reply)) or self._respond_basically(command, reply)

    def _respond_basically(self, command: Bottle, reply: Bottle) -> bool:
        if plain_text(command._native[0]) in QUIT if command.size() else False:
            reply._native[:] = [yarpy.Vocab("bye")]
            threading.Thread(target=self.stopModule, name="yarp module stop", daemon=True).start()
            return True
        reply.addString(UNKNOWN)
        return False

    def setName(self, name: str) -> None:
        self._name = name

    def getName(self, subName: str = "") -> str:
        """The name, and what follows it."""
        if subName and not subName.startswith("/"):
            say("WARNING", "|yarp.os.RFModule| SubName in getName() does not begin with a slash")
            subName = f"/{subName}"
        return self._name + subName

    def getThreadKey(self) -> int:
        return threading.get_ident()


class _Driver(yarpy.Module):
    """Runs an RFModule."""

    def __init__(self, module: RFModule) -> None:
        self._module = module
        self._given: ResourceFinder | None = None

    def run_with(self, rf: ResourceFinder | None) -> int:
        self._given = rf
        return self.run()

    @property
    def period(self) -> float:  # type: ignore[override]
        return self._module.getPeriod()

    def configure(self, resources: yarpy.ResourceFinder) -> bool:
        if self._given is None:
            return True
        if self._module.configure(self._given):
            return True
        say("ERROR", "|yarp.os.RFModule| RFModule failed to open.")
        return False

    def update(self) -> bool:
        return bool(self._module.updateModule())

    def interrupt(self) -> None:
        self._module.interruptModule()

    def close(self) -> None:
        self._module.close()


class _Responder(PortReader):
    """The reader that `attach` gives a port."""

    def __init__(self, module: RFModule) -> None:
        self._module = module

    def read(self, reader: ConnectionReader) -> bool:
        command, reply = Bottle(), Bottle()
        if not command.read(reader):
            return False
        self._module.safeRespond(command, reply)
        writer = reader.getWriter()
        if writer is not None and reply.size():
            reply.write(writer)
        return True
