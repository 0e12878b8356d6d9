"""Cameras at FireWire (IIDC, which C++ calls DC1394): their registers, in both protocols.

    class Eye:
        firewire = Registers()                    # an object with the members of `Registers`

    [fgfw] [DR2n]           69                    YARP 3: the number of the video mode
    [fgfw] [DR2o] 70        1                     1: it was done, 0: the camera did not accept it
    setVideoModeDC1394RPC   [ok]                  YARP 4

Rules: just a table, and what carries out its rows. Numbers are those of libdc1394; masks have a bit
for each. An object needs to have only what its camera has.

Source: FrameGrabberControlsDC1394_Responder of YARP 3.x, which takes its own word for the value of
whatever is set; here it is what the client sent.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Final, NamedTuple, Protocol

from yarpy.kits.devices.access import Access
from yarpy.kits.devices.kind import whole
from yarpy.kits.devices.refusal import Refused


class Registers(Protocol):
    """Everything a camera at FireWire can have. For reading; classes need not inherit it."""

    video_modes: int  # a mask: which there are
    video_mode: int
    frame_rates: int  # a mask
    frame_rate: int
    iso_speed: int
    color_coding: int
    window: tuple[int, int, int, int]  # of format 7: width, height, left, top
    largest_window: tuple[int, int, int, int, int, int]  # size, its steps, steps of left and top
    beta_mode: bool  # 1394b, not 1394a
    transmission: bool
    bytes_per_packet: int

    def color_codings(self, video_mode: int) -> int:
        """A mask of those of a video mode."""

    def switch_broadcast(self, on: bool) -> object:
        """Let commands be for all cameras of the bus."""

    def switch_power(self, on: bool) -> object:
        """Turn the camera on or off."""

    def switch_capture(self, on: bool) -> object:
        """Begin or end to take pictures."""

    def restore(self) -> object:
        """Let all registers be as the factory left them."""

    def reset(self) -> object:
        """Begin again, as if it had been turned on."""


class Function(NamedTuple):
    """A function: its word in YARP 3, what it does (`get`, `set`, `call`) with which member, how
    many numbers it takes and gives, and whether these are true or false, or masks."""

    word: str
    does: str
    member: str
    takes: int = 0
    gives: int = 0
    truth: bool = False
    mask: bool = False


def _get(word: str, member: str, gives: int = 1, **facts: bool) -> Function:
    return Function(word, "get", member, 0, gives, **facts)


def _set(word: str, member: str, takes: int = 1, truth: bool = False) -> Function:
    return Function(word, "set", member, takes, 0, truth)


def _call(word: str, member: str, takes: int = 0) -> Function:
    return Function(word, "call", member, takes, 0, truth=True)


#: By the names of C++, which are those of YARP 4 without RPC at the end.
FUNCTIONS: Final = {
    "getVideoModeMaskDC1394": _get("DR2m", "video_modes", mask=True),
    "getVideoModeDC1394": _get("DR2n", "video_mode"),
    "setVideoModeDC1394": _set("DR2o", "video_mode"),
    "getFPSMaskDC1394": _get("DR2p", "frame_rates", mask=True),
    "getFPSDC1394": _get("DR2q", "frame_rate"),
    "setFPSDC1394": _set("DR2r", "frame_rate"),
    "getISOSpeedDC1394": _get("DR2s", "iso_speed"),
    "setISOSpeedDC1394": _set("DR2t", "iso_speed"),
    "getColorCodingMaskDC1394": Function("DR2u", "call", "color_codings", 1, 1, mask=True),
    "getColorCodingDC1394": _get("DR2v", "color_coding"),
    "setColorCodingDC1394": _set("DR2w", "color_coding"),
    "getFormat7MaxWindowDC1394": _get("DR2z", "largest_window", 6),
    "getFormat7WindowDC1394": _get("DR2A", "window", 4),
    "setFormat7WindowDC1394": _set("DR2B", "window", 4),
    "setOperationModeDC1394": _set("DR2C", "beta_mode", truth=True),
    "getOperationModeDC1394": _get("DR2D", "beta_mode", truth=True),
    "setTransmissionDC1394": _set("DR2E", "transmission", truth=True),
    "getTransmissionDC1394": _get("DR2F", "transmission", truth=True),
    "setBroadcastDC1394": _call("DR2I", "switch_broadcast", 1),
    "setDefaultsDC1394": _call("DR2J", "restore"),
    "setResetDC1394": _call("DR2K", "reset"),
    "setPowerDC1394": _call("DR2L", "switch_power", 1),
    "setCaptureDC1394": _call("DR2M", "switch_capture", 1),
    "setBytesPerPacketDC1394": _set("DR2N", "bytes_per_packet"),
    "getBytesPerPacketDC1394": _get("DR2O", "bytes_per_packet"),
}
BY_WORD: Final = {function.word: name for name, function in FUNCTIONS.items()}


def apply(registers: Any, function: Function, arguments: Sequence[Any]) -> list[int]:
    """Carry out a function with an object; the numbers that it gives. Raises Refused."""
    if len(arguments) < function.takes:
        raise Refused("the request is incomplete")
    given = [int(e) if isinstance(e, bool) else whole(e) for e in arguments[: function.takes]]
    if function.truth:
        given = [bool(each) for each in given]
    member = function.member
    # A remote camera's members are asked for by reading them, which could take long.
    if not (hasattr(type(registers), member) or hasattr(registers, member)):
        raise Refused(f"the camera has no {member}")
    if function.does == "set":
        setattr(registers, member, given[0] if function.takes == 1 else tuple(given))
        return []
    found = getattr(registers, member)
    if function.does == "call":
        found = found(*given)
    if not function.gives:
        return []
    values = [*found] if isinstance(found, (tuple, list)) else [found]
    if len(values) != function.gives:
        raise ValueError(f"{member} is {len(values)} numbers, not {function.gives}")
    return [_signed(int(value)) for value in values]


def answer(camera: Access, function: Function, arguments: Sequence[Any]) -> list[int]:
    """Carry out a function with a camera that has `firewire`. Raises Refused."""
    return camera.use("firewire", lambda registers: apply(registers, function, arguments))


def _signed(value: int) -> int:
    """As an int32 has it: masks may have the highest bit."""
    value &= 0xFFFFFFFF
    return value - (1 << 32) if value >> 31 else value


class _Register:
    """A register of a remote camera. Reading it asks the camera, assigning to it sets it there."""

    def __init__(self, getter: str, setter: str = "") -> None:
        self._getter, self._setter = getter, setter

    def __get__(self, owner: Any, kind: type) -> Any:
        return self if owner is None else owner.do(self._getter)

    def __set__(self, owner: Any, value: Any) -> None:
        if not self._setter:
            raise AttributeError("it can only be read")
        owner.do(self._setter, *(value if isinstance(value, (tuple, list)) else [value]))


class RemoteRegisters:
    """The registers of a remote camera: the members of `Registers`. `ask` takes a function's name
    and numbers, and returns those of the answer."""

    def __init__(self, ask: Callable[[str, Sequence[int]], Sequence[int]]) -> None:
        self._ask = ask

    def do(self, name: str, *arguments: int) -> Any:
        """Return what a function gives: a number, several, or None."""
        function = FUNCTIONS[name]
        found: list[Any] = [*self._ask(name, arguments)][: function.gives]
        if function.mask:
            found = [value & 0xFFFFFFFF for value in found]
        if function.truth:
            found = [bool(value) for value in found]
        if function.gives > 1:
            return tuple(found)
        return found[0] if found else None

    video_modes = _Register("getVideoModeMaskDC1394")
    video_mode = _Register("getVideoModeDC1394", "setVideoModeDC1394")
    frame_rates = _Register("getFPSMaskDC1394")
    frame_rate = _Register("getFPSDC1394", "setFPSDC1394")
    iso_speed = _Register("getISOSpeedDC1394", "setISOSpeedDC1394")
    color_coding = _Register("getColorCodingDC1394", "setColorCodingDC1394")
    window = _Register("getFormat7WindowDC1394", "setFormat7WindowDC1394")
    largest_window = _Register("getFormat7MaxWindowDC1394")
    beta_mode = _Register("getOperationModeDC1394", "setOperationModeDC1394")
    transmission = _Register("getTransmissionDC1394", "setTransmissionDC1394")
    bytes_per_packet = _Register("getBytesPerPacketDC1394", "setBytesPerPacketDC1394")

    def color_codings(self, video_mode: int) -> int:
        """A mask of those of a video mode."""
        return int(self.do("getColorCodingMaskDC1394", video_mode))

    def switch_broadcast(self, on: bool) -> None:
        """Let commands be for all cameras of the bus."""
        self.do("setBroadcastDC1394", int(on))

    def switch_power(self, on: bool) -> None:
        """Turn the camera on or off."""
        self.do("setPowerDC1394", int(on))

    def switch_capture(self, on: bool) -> None:
        """Begin or end to take pictures."""
        self.do("setCaptureDC1394", int(on))

    def restore(self) -> None:
        """Let all registers be as the factory left them."""
        self.do("setDefaultsDC1394")

    def reset(self) -> None:
        """Begin again, as if it had been turned on."""
        self.do("setResetDC1394")
