"""The functions of a camera of YARP 4: carries them out as requests of YARP 3.

    getRgbResolution()        a Size: [ok] 320 240
    setFeature1(1, 0.5)       a Status: [ok]; [err5] if the camera cannot, and the log says why

Rules: `table` says which request each function stands for; the others are of cameras at
FireWire; other cameras answer them with [err2]. An answer always has all its fields: C++ reads
them first.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, ClassVar

from yarpy.data.sig.image import Image
from yarpy.data.value import Vocab
from yarpy.kits.devices.declared import Status
from yarpy.kits.devices.frame_grabber.responder import FrameGrabberResponder
from yarpy.kits.devices.frame_grabber.yarp4.functions import FrameGrabberMsgs, Picture
from yarpy.kits.devices.frame_grabber.yarp4.table import FUNCTIONS, Row
from yarpy.kits.devices.refusal import Refused
from yarpy.log import logger

log = logger("yarpy.devices")


class Functions(FrameGrabberMsgs):
    """Answers the functions with one camera, called `name` in the log."""

    _only_yarp4: ClassVar[bool] = True

    def __init__(self, responder: FrameGrabberResponder, name: str) -> None:
        self._responder = responder
        self._name = name

    def _does(self, name: str, row: Row | None, arguments: Sequence[Any]) -> Any:
        fields: Sequence[Any] = ()
        code = "ok"
        try:
            if row is not None:
                fields = self._fields(row, arguments)
            elif self._responder.at_firewire:
                fields = self._responder.register(name, arguments)
            else:
                code = "err2"
        except Refused as refusal:
            log.info("%s: %s: %s", self._name, name, refusal)
            code = "err5"
        except Exception:
            log.exception("%s: %s", self._name, name)
            code = "err5"
        result: Any = self._methods[f"{name}RPC"].result
        if result is Status:
            return Status(code)
        if result is Picture and not fields:
            fields = [blank()]
        return result(Status(code), *fields)

    def _fields(self, row: Row, arguments: Sequence[Any]) -> Sequence[Any]:
        group, verb, item = row.words
        request = [Vocab(group), Vocab(verb), Vocab(item), *row.ask(arguments)]
        reply = self._responder.carry_out(group, request)
        if verb == "set":
            if group == "visr" and reply[2:] != [1]:
                raise Refused(f"the camera does not accept {item}")
            return ()
        return row.tell(reply[row.behind :])


def blank() -> Image:
    """In place of an image that there is not."""
    import numpy as np

    return Image(np.zeros((1, 1, 3), np.uint8))


def _function(name: str, row: Row | None) -> Callable[..., Any]:
    def function(self: Functions, *arguments: Any) -> Any:
        return self._does(name, row, arguments)

    return function


for _name in FrameGrabberMsgs._methods:
    _stem = _name.removesuffix("RPC")
    setattr(Functions, _name, _function(_stem, FUNCTIONS.get(_stem)))
