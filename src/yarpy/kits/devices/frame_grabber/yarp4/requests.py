"""Requests to a camera of YARP 4: those of YARP 3, as calls of its functions.

Rules: `request` takes and gives what the port of a camera of YARP 3 does, so that the client has
one way to ask. What is not done is a LocalProtocolError that says which function was refused.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.errors import LocalProtocolError
from yarpy.kits.devices.declared import Status
from yarpy.kits.devices.frame_grabber.firewire import BY_WORD
from yarpy.kits.devices.frame_grabber.firewire import FUNCTIONS as FIREWIRE
from yarpy.kits.devices.frame_grabber.yarp4.functions import FrameGrabberMsgs
from yarpy.kits.devices.frame_grabber.yarp4.table import BY_WORDS, FUNCTIONS
from yarpy.kits.devices.status import reason
from yarpy.kits.thrift.client import client_class
from yarpy.port.rpc import RpcClient


class FunctionRequests:
    """Calls functions of the camera `remote` over `port`."""

    def __init__(self, remote: str, port: RpcClient, timeout: float) -> None:
        self.remote = remote
        self._client = client_class(FrameGrabberMsgs)(port, timeout)

    def is_there(self) -> bool:
        """Return whether the other side has these functions: it says that it is of YARP 4."""
        version = self._client.remote_version()
        return version is not None and version[1] >= 4

    def request(self, words: Sequence[Any]) -> list[Any]:
        """The reply to a request of YARP 3."""
        if words[0] == "fgfw":
            return self._register(BY_WORD[words[1]], words[2:])
        group, verb, item = (str.__str__(word) for word in words[:3])
        name = BY_WORDS.get((group, verb, item))
        if name is None:
            raise LocalProtocolError(
                f'"{self.remote}" is of YARP 4, which does not know {Bottle(words).to_text()}'
            )
        row = FUNCTIONS[name]
        found = self._call(name, row.asked(words[3:]))
        if verb == "set":
            return [Vocab(group), Vocab("set"), 1] if group == "visr" else [Vocab("nak")]
        fields = [getattr(found, field) for field in found._attributes[1:]]
        head = [Vocab(group), Vocab(item), Vocab("is"), 0]
        return [*head[: row.behind], *row.told(fields)]

    def _register(self, name: str, arguments: Sequence[Any]) -> list[Any]:
        """The reply to a request of cameras at FireWire."""
        function = FIREWIRE[name]
        found = self._call(name, [bool(e) if function.truth else e for e in arguments])
        if isinstance(found, Status):
            return [1]
        return [int(getattr(found, field)) for field in found._attributes[1:]]

    def _call(self, name: str, arguments: Sequence[Any]) -> Any:
        """Return what a function returns. Raises LocalProtocolError."""
        found = getattr(self._client, f"{name}RPC")(*arguments)
        status = found if isinstance(found, Status) else found.status
        if status.code != "ok":
            shown = ", ".join(map(str, arguments))
            raise LocalProtocolError(
                f'"{self.remote}" refuses {name}({shown[:80]}): {reason(status.code)}'
            )
        return found
