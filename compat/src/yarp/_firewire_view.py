"""IFrameGrabberControlsDC1394: the registers of a camera at FireWire.

Rules: the methods are those of the table of `yarpy.kits.devices.frame_grabber.firewire`; what the
camera does not have is 0, or False. Numbers and masks are those of libdc1394.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from yarp._numbers import store
from yarp._view import View
from yarpy.kits.devices.frame_grabber.firewire import FUNCTIONS, Function, apply
from yarpy.kits.devices.refusal import Refused


class IFrameGrabberControlsDC1394(View):
    """Video modes, speeds and windows of a camera at FireWire."""

    def _does(self, function: Function, arguments: tuple[Any, ...]) -> list[int] | None:
        """Return what a function gives, None if the camera refuses; the log says why."""
        found: list[int] = []

        def act() -> None:
            try:
                found.extend(apply(self._board.firewire, function, arguments))
            except Refused as refusal:
                raise AttributeError(str(refusal)) from None

        return found if self._tell(act) else None


def _method(name: str, function: Function) -> Callable[..., Any]:
    def number(self: IFrameGrabberControlsDC1394, *arguments: int) -> int:
        found = self._does(function, arguments) or [0]
        return found[0] & 0xFFFFFFFF

    def truth(self: IFrameGrabberControlsDC1394) -> bool:
        return self._does(function, ()) == [1]

    def window(self: IFrameGrabberControlsDC1394, *places: Any) -> bool:
        found = self._does(function, ())
        for place, value in zip(places, found or (), strict=False):
            store(place, [value])
        return found is not None

    def change(self: IFrameGrabberControlsDC1394, *arguments: Any) -> bool:
        return self._does(function, arguments) is not None

    made: Callable[..., Any] = number
    if not function.gives:
        made = change
    elif function.gives > 1:
        made = window
    elif function.truth:
        made = truth
    made.__name__ = name
    made.__doc__ = f"`{function.member}` of the camera."
    return made


for _name, _function in FUNCTIONS.items():
    setattr(IFrameGrabberControlsDC1394, _name, _method(_name, _function))
