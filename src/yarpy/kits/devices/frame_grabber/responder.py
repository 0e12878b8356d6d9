"""The answers of a camera on its ports.

    [fgi] [get] [imgr]              [fgi] [imgr] [is] (an image as a list)
    [visr] [get] [res]              [visr] [res] [is] 320 240
    [fgc] [set] [feat] 0 0.5        [nak]       (it was done: C++ says nothing then)

Rules: the first word is the group, the second the action. One reply for every request; `[nak]` for
an unknown group, `[fail]` for a request that fails, mostly followed by the reason.

Source: FrameGrabberOf_Responder, RgbVisualParams_Responder and FrameGrabberControls_Responder of
YARP 3.x.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from reprlib import repr as shown
from typing import Any, Final

from yarpy.data.bottle import Bottle, Property
from yarpy.data.sig.image import Image
from yarpy.data.value import Vocab
from yarpy.data.writer import dict_elements
from yarpy.kits.devices.access import Access
from yarpy.kits.devices.frame_grabber import firewire
from yarpy.kits.devices.frame_grabber.interface import FEATURES
from yarpy.kits.devices.kind import items, number, whole, word
from yarpy.kits.devices.refusal import Refused
from yarpy.log import logger

log = logger("yarpy.devices")

BUSES: Final = ("unknown", "firewire", "usb")  # the index is the number
MODES: Final = ("unknown", "manual", "auto")

_IS: Final = Vocab("is")
_FAIL: Final = Vocab("fail")
_NAK: Final = Vocab("nak")

Request = Sequence[Any]


class FrameGrabberResponder:
    """Answers requests to one camera; `grab` returns its next image, or raises Refused."""

    def __init__(self, camera: Access, grab: Callable[[], Image], name: str) -> None:
        self._camera = camera
        self._grab = grab
        self._name = name
        self.size: tuple[int, int] | None = None  # of the last image, if known

    def answer(self, request: Request) -> Bottle:
        """The reply to a request."""
        group = word(request[0]) if request else ""
        known = (*("fgi", "fgir", "visr", "fgc"), *(["fgfw"] if self.at_firewire else []))
        if group not in known:
            return Bottle([_NAK])
        try:
            return self.carry_out(group, request)
        except Refused as refusal:
            log.info("%s: %s: %s", self._name, shown([*request]), refusal)
            return Bottle([_FAIL]) if group == "visr" else Bottle([_FAIL, str(refusal)])
        except Exception as error:
            log.exception("%s: %s", self._name, shown([*request]))
            return Bottle([_FAIL, str(error)])

    def carry_out(self, group: str, request: Request) -> Bottle:
        """The reply to a request for one of the groups. Raises Refused."""
        if group == "fgfw":
            return self._registers(request)
        groups = {"fgi": self._images, "fgir": self._images, "visr": self._lens, "fgc": self._knobs}
        verb, item = (word(e) for e in [*request[1:3], "", ""][:2])
        return Bottle(groups[group](group, verb, item, request[3:]))

    # -- registers of FireWire ------------------------------------------------------------------

    @property
    def at_firewire(self) -> bool:
        """Return whether the camera has registers of FireWire."""
        return self._camera.has("firewire")

    def register(self, name: str, arguments: Request) -> list[int]:
        """Carry out a function of FireWire. Raises Refused."""
        return firewire.answer(self._camera, firewire.FUNCTIONS[name], arguments)

    def _registers(self, request: Request) -> Bottle:
        name = firewire.BY_WORD.get(word(request[1]) if len(request) > 1 else "")
        if name is None:
            raise Refused("it is no function of cameras at FireWire")
        if firewire.FUNCTIONS[name].gives:
            return Bottle(self.register(name, request[2:]))
        try:
            self.register(name, request[2:])
        except Refused as refusal:
            log.info("%s: %s: %s", self._name, name, refusal)
            return Bottle([0])
        return Bottle([1])

    # -- images -------------------------------------------------------------------------------

    def _images(self, group: str, verb: str, item: str, rest: Request) -> list[Any]:
        if verb != "get":
            raise Refused("images can only be read")
        if item in ("w", "h"):
            return [Vocab(group), Vocab(item), _IS, self._size()[item == "h"]]
        if item == "imgr":
            image = self._image(group)
        elif item == "crop":
            image = self._cropped(group, rest)
        else:
            raise Refused(f"{item!r} is not a property of an image")
        return [Vocab(group), Vocab(item), _IS, Bottle.from_bytes(b"".join(image.to_wire()))]

    def _image(self, group: str) -> Image:
        image = self._grab()
        self.size = image.width, image.height
        wanted = "mono" if group == "fgir" else "rgb"
        if group == "fgir" and image.code != "mono":
            raise Refused("this camera has no raw images")
        try:
            return image.converted(wanted)
        except ValueError as error:
            raise Refused(str(error)) from error

    def _cropped(self, group: str, rest: Request) -> Image:
        if len(rest) != 2:
            raise Refused("a part of an image is [crop] 0 (left top right bottom)")
        if whole(rest[0]) != 0:
            raise Refused("only rectangles (kind 0) can be cropped")
        corners = [whole(element) for element in items(rest[1])]
        if len(corners) != 4:
            raise Refused(f"a rectangle has 2 corners, not {len(corners) / 2:g}")
        image = self._image(group)
        (left, right), (top, bottom) = sorted(corners[::2]), sorted(corners[1::2])
        if left < 0 or top < 0 or right >= image.width or bottom >= image.height:
            raise Refused(f"that is not within {image.width} x {image.height}")
        part = image.array[top : bottom + 1, left : right + 1]
        return Image(part, image.code)

    def _size(self) -> tuple[int, int]:
        """Width and height: the camera's own value, else its images'."""
        if self._camera.has("resolution"):
            width, height = self._camera.use("resolution", lambda found: map(int, found))
            return width, height
        if self.size is None:
            image = self._grab()
            self.size = image.width, image.height
        return self.size

    # -- the lens -----------------------------------------------------------------------------

    def _lens(self, group: str, verb: str, item: str, rest: Request) -> list[Any]:
        if verb == "set":
            return [Vocab("visr"), Vocab("set"), int(self._turn(item, rest))]
        if verb != "get":
            raise Refused(f"{verb!r} is neither get nor set")
        return [Vocab("visr"), Vocab(item), _IS, *self._seen(item)]

    def _seen(self, item: str) -> list[Any]:
        use = self._camera.use
        match item:
            case "w" | "h":
                return [self._size()[item == "h"]]
            case "res":
                return [*self._size()]
            case "fov":
                return use("field_of_view", lambda found: [float(angle) for angle in found])
            case "mirr":
                return [use("mirror", lambda found: int(bool(found)))]
            case "intp":
                return [use("intrinsics", lambda found: dict_elements(Property(found)))]
            case "conf":
                return use("resolutions", _configurations)
        raise Refused(f"{item!r} is not a property of a lens")

    def _turn(self, item: str, rest: Request) -> bool:
        """Change a setting; returns whether the camera accepted it."""
        values: Any
        match item:
            case "res":
                member, values = "resolution", tuple(whole(value) for value in _first(rest, 2))
                if min(values) < 1:
                    return False
            case "fov":
                member, values = "field_of_view", tuple(number(value) for value in _first(rest, 2))
            case "mirr":
                member, values = "mirror", _truth(_first(rest, 1)[0])
            case _:
                raise Refused(f"{item!r} is not a property of a lens that can be set")
        try:
            self._camera.store(member, values)
        except Refused as refusal:
            log.info("%s: %s", self._name, refusal)
            return False
        if member == "resolution":
            self.size = None
        return True

    # -- features -----------------------------------------------------------------------------

    def _knobs(self, group: str, verb: str, item: str, rest: Request) -> list[Any]:
        if (verb, item) == ("get", "camd"):
            bus, what = self._camera.use("description", lambda found: (found[0], str(found[1])))
            known = BUSES.index(bus) if bus in BUSES else 0
            return [Vocab("fgc"), Vocab("camd"), _IS, known, what]
        feature = _feature(rest)
        if verb == "has":
            known = int(self._has(item, feature))
            return [Vocab("fgc"), Vocab("has"), Vocab("feat"), Vocab(item).code, known]
        if verb == "get":
            return [Vocab("fgc"), Vocab(item), _IS, *self._value(item, feature)]
        if verb != "set":
            raise Refused(f"{verb!r} is not has, get or set")
        self._adjust(item, feature, rest[1:])
        return [_NAK]

    def _has(self, item: str, feature: str) -> bool:
        member = {
            "feat": "features",
            "onof": "feature_switches",
            "auto": "feature_modes",
            "man": "feature_modes",
            "onep": "features",
        }.get(item)
        if member is None:
            raise Refused(f"{item!r} is not a property of a feature")
        if not self._camera.has(member) or (item == "onep" and not self._camera.has("one_push")):
            return False
        return self._camera.use(member, lambda found: feature in found)

    def _value(self, item: str, feature: str) -> list[Any]:
        match item:
            case "feat" | "fea2":
                value = self._camera.use("features", _entry(feature))
                values = [*value] if isinstance(value, (list, tuple)) else [value]
                if len(values) != (1 if item == "feat" else 2):
                    raise Refused(f"{feature} has {len(values)} values")
                return [float(each) for each in values]
            case "actv":
                return [int(bool(self._camera.use("feature_switches", _entry(feature))))]
            case "mode":
                mode = self._camera.use("feature_modes", _entry(feature))
                return [MODES.index(mode) if mode in MODES else MODES.index("unknown")]
        raise Refused(f"{item!r} is not a property of a feature")

    def _adjust(self, item: str, feature: str, rest: Request) -> None:
        value: Any
        match item:
            case "feat":
                member, value = "features", number(_first(rest, 1)[0])
            case "fea2":
                member, value = "features", tuple(number(each) for each in _first(rest, 2))
            case "actv":
                member, value = "feature_switches", _truth(_first(rest, 1)[0])
            case "mode":
                mode = whole(_first(rest, 1)[0])
                if mode not in (1, 2):
                    raise Refused(f"a mode is 1 (manual) or 2 (auto), not {mode}")
                member, value = "feature_modes", MODES[mode]
            case "onep":
                self._camera.ask("one_push", feature)
                return
            case _:
                raise Refused(f"{item!r} is not a property of a feature")

        def put(found: Any) -> None:
            _entry(feature)(found)
            found[feature] = value

        self._camera.use(member, put)


def _configurations(found: Any) -> list[Any]:
    listed: list[Any] = []
    for width, height, rate, code in found:
        listed += (int(width), int(height), float(rate), Vocab(code))
    return [len(listed) // 4, *listed]


def _entry(feature: str) -> Callable[[Mapping[str, Any]], Any]:
    def fetch(found: Mapping[str, Any]) -> Any:
        if feature not in found:
            raise Refused(f"this camera has no {feature.replace('_', ' ')}")
        return found[feature]

    return fetch


def _feature(rest: Request) -> str:
    index = whole(_first(rest, 1)[0])
    if not 0 <= index < len(FEATURES):
        raise Refused(f"there are features 0 to {len(FEATURES) - 1}, not {index}")
    return FEATURES[index]


def _first(rest: Request, count: int) -> Request:
    if len(rest) < count:
        raise Refused("the request is incomplete")
    return rest[:count]


def _truth(element: object) -> bool:
    return element if isinstance(element, bool) else bool(whole(element))
