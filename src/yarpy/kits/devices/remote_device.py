"""The base of the clients of a device with two ports: one answers, one sends what is measured.

Rules: a subclass names the ports, learns what it has to know before measurements come, and decodes
them.
"""

from __future__ import annotations

from contextlib import ExitStack
from typing import ClassVar, Final, Generic, TypeVar

from yarpy.kits.devices.closeable import Closeable, local_prefix, prefix
from yarpy.kits.devices.latest_message import LatestMessage
from yarpy.names.base import NameClient
from yarpy.port.rpc import RpcClient
from yarpy.wire.message import Message

T = TypeVar("T")

#: Seconds to wait for an answer.
TIMEOUT: Final = 10.0


class RemoteDevice(Closeable, Generic[T]):
    """The device whose ports begin with `remote`.

    local: prefix of the client's own ports; generated if empty.
    carrier: for the measurements.
    timeout: measurements older than this many seconds are ignored; None for those of FRESH.
    names: a name client, None for the default.
    Raises UnknownName, LinkClosed, RemoteProtocolError (another device); later Timeout,
    LocalProtocolError (it refuses).
    """

    #: its port behind the prefix, and the client's: for questions; for measurements
    RPC: ClassVar[tuple[str, str]] = "/rpc:i", "/rpc:o"
    DATA: ClassVar[tuple[str, str]] = "", ""
    #: seconds for which a measurement counts
    FRESH: ClassVar[float] = 0.5

    def __init__(
        self,
        remote: str,
        local: str = "",
        *,
        carrier: str = "tcp",
        timeout: float | None = None,
        names: NameClient | None = None,
    ) -> None:
        self.remote = prefix(remote)
        near = local_prefix(local, self.remote)
        (asked, asking), (source, sink) = self.RPC, self.DATA
        fresh = self.FRESH if timeout is None else timeout
        with ExitStack() as resources:
            self._rpc = resources.enter_context(
                RpcClient(self.remote + asked, name=near + asking, names=names)
            )
            self._learn()
            self._latest: LatestMessage[T] = resources.enter_context(
                LatestMessage(
                    self.remote + source, near + sink, carrier, fresh, names, self._decode
                )
            )
            self._resources = resources.pop_all()

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.remote}>"

    def _learn(self) -> None:
        """Ask what has to be known before measurements come."""

    def _decode(self, message: Message) -> T:
        """Return what a message measures. Raises DecodeError."""
        raise NotImplementedError
