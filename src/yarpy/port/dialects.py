"""Dialects: writing to each reader of a port in its version of YARP, 3 or 4.

Rules: a new reader is asked for its version once, in a thread of its own; until it has answered,
only the others get messages: one of the wrong version can end its connection for good.
Readers over text, where both are alike, are not asked. A reader that does not answer is of YARP 3.
"""

from __future__ import annotations

from collections.abc import Callable

from yarpy.data.stamp import Stamp
from yarpy.errors import YarpError
from yarpy.link.send.outbound import Outbound
from yarpy.log import logger
from yarpy.port.port import MessagePort, envelope_of
from yarpy.threads import Thread
from yarpy.wire.message import Packet

log = logger("yarpy.port")

Make = Callable[[], object]


class _Reader:
    """One reader. `yarp4`: it is of YARP 4; None while it is being asked."""

    def __init__(self, yarp4: bool | None) -> None:
        self.yarp4 = yarp4


class Dialects:
    """The readers of `port`, each with its version."""

    def __init__(self, port: MessagePort) -> None:
        self._port = port
        self._readers: dict[Outbound, _Reader] = {}

    def __bool__(self) -> bool:
        """Return whether the version of any reader is known."""
        self._look()
        return any(reader.yarp4 is not None for reader in self._readers.values())

    def write(self, older: Make, newer: Make, stamp: Stamp | None = None) -> int:
        """Write what `older` makes to readers of YARP 3, and what `newer` makes to those of YARP 4;
        returns how many connections took it. Raises as `Port.write`."""
        self._look()
        envelope = b"" if stamp is None else envelope_of(stamp)
        taken = 0
        for yarp4, make in ((False, older), (True, newer)):
            group = tuple(link for link, one in self._readers.items() if one.yarp4 is yarp4)
            if group:
                taken += self._port._send(Packet(make(), envelope), group)
        return taken

    def is_yarp4(self, target: str) -> bool:
        """Return whether the reader `target` is of YARP 4; False if there is none. For who asks
        something from another port of the same program, which cannot be asked while it waits."""
        for link in self._port._links:
            if link.route.target == target:
                reader = self._readers.get(link)
                if reader is None or reader.yarp4 is None:
                    reader = _Reader(None)
                    self._ask(link, reader)
                return bool(reader.yarp4)
        return False

    def _look(self) -> None:
        links, known = self._port._links, self._readers
        if links or known:
            self._readers = {link: known.get(link) or self._reader(link) for link in links}

    def _reader(self, link: Outbound) -> _Reader:
        carrier = link.carrier
        if carrier.spelling != "binary" or carrier.delivery.broadcast or carrier.reaches.foreign:
            return _Reader(False)
        found = _Reader(None)
        name = f"yarpy which YARP {link.route.target}"
        Thread(target=self._ask, args=(link, found), name=name, daemon=True).start()
        return found

    def _ask(self, link: Outbound, reader: _Reader) -> None:
        try:
            reader.yarp4 = self._port._is_yarp4(link.route.target)
        except (YarpError, OSError) as error:
            log.info("%s: which YARP is %s? %s", self._port.name, link.route.target, error)
            reader.yarp4 = False
