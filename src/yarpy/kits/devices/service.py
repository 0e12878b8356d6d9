"""Services of devices whose answers have a status in front, in the form that the asker reads.

Rules: who has asked for the version is of YARP 4, or of yarpy, and gets the status of 4.0. So does
who is known to be of YARP 4 otherwise, by `speaks_yarp4` or by the fractions that it has sent.
Everybody else gets that of 3.12, whose programs do not ask, or what `before` makes.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from yarpy.data.value import Buffer
from yarpy.kits.devices.status import older
from yarpy.kits.thrift.payload import VERSION, Payload
from yarpy.kits.thrift.service import Service

#: Askers that are remembered.
_MANY: Final = 100


class DeviceService(Service):
    """The base of such a service, behind its interface. `before`: makes the answers of versions
    before 4.0."""

    before: Callable[[Buffer], Buffer] = staticmethod(older)

    def speaks_yarp4(self, source: str) -> None:
        """Note that the client `source` is of YARP 4."""
        self._note(source, True)
        self._know(source)

    def knows(self, source: str) -> bool:
        """Return whether the client `source` gets the status of 4.0."""
        return source in self.__dict__.get("_known", ()) or self._is_yarp4(source)

    def _know(self, source: str) -> None:
        known: frozenset[str] = self.__dict__.get("_known", frozenset())
        self._known = known | {source} if len(known) < _MANY else frozenset((source,))

    def __call__(self, message: Any) -> Any:
        """Answer a message."""
        answer = super().__call__(message)
        if VERSION.encode() in bytes(message.to_bytes()[:60]):
            self._know(message.source)
        elif isinstance(answer, Payload) and not self.knows(message.source):
            return Payload(self.before(answer.data))
        return answer
