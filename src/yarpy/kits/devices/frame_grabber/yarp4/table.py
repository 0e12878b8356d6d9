"""The functions of a camera of YARP 4: which request of YARP 3 each one stands for.

    getRgbResolution()          [visr] [get] [res]                 320 240
    setFeature1(0, 0.5)         [fgc] [set] [feat] 0 0.5

Rules: just a table, which server and client read from opposite sides, and what makes the arguments
and the results of one from those of the other. The names of functions end in RPC on the wire.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Final

from yarpy.data.bottle import Bottle, Property
from yarpy.data.sig.image import Image
from yarpy.data.value import Vocab
from yarpy.data.writer import dict_elements
from yarpy.kits.devices.frame_grabber.yarp4.functions import Configuration, Corner

Elements = Sequence[Any]


@dataclass(frozen=True, slots=True)
class Row:
    """`words` begin the request. `behind`: elements of the reply in front of the result.

    `ask` and `asked` turn arguments into elements of the request and back, `tell` and `told` those
    of the reply into the fields of the result and back.
    """

    words: tuple[str, str, str]
    behind: int = 3
    ask: Callable[[Elements], Elements] = list
    asked: Callable[[Elements], Elements] = list
    tell: Callable[[Elements], Elements] = list
    told: Callable[[Elements], Elements] = list


def _corners(arguments: Elements) -> Elements:
    kind, corners = arguments
    return [kind, Bottle(number for corner in corners for number in (corner.x, corner.y))]


def _points(elements: Elements) -> Elements:
    kind, numbers = elements
    return [kind, [Corner(x, y) for x, y in zip(numbers[::2], numbers[1::2], strict=True)]]


def _image(elements: Elements) -> Elements:
    return [Image.from_wire(Bottle(elements[0]).to_bytes())]


def _elements(fields: Elements) -> Elements:
    return [Bottle.from_bytes(b"".join(fields[0].to_wire()))]


def _configurations(elements: Elements) -> Elements:
    rows = zip(*(elements[start + 1 :: 4] for start in range(4)), strict=False)
    return [[Configuration(w, h, float(rate), Vocab(code).code) for w, h, rate, code in rows]]


def _modes(fields: Elements) -> Elements:
    listed: list[Any] = [len(fields[0])]
    for each in fields[0]:
        listed += (each.width, each.height, each.rate, Vocab.from_code(each.code))
    return listed


def _truth(elements: Elements) -> Elements:
    return [elements[0] == 1]


def _number(fields: Elements) -> Elements:
    return [int(fields[0])]


def _numbers(arguments: Elements) -> Elements:
    return [int(each) if isinstance(each, bool) else each for each in arguments]


def _parameters(elements: Elements) -> Elements:
    return [Property.from_bottle(elements[0])]


def _pairs(fields: Elements) -> Elements:
    return [dict_elements(fields[0])]


def _has(question: str) -> Row:
    return Row(("fgc", "has", question), 4, tell=_truth, told=_number)


FUNCTIONS: Final = {
    "getWidth": Row(("fgi", "get", "w")),
    "getHeight": Row(("fgi", "get", "h")),
    "getImage": Row(("fgi", "get", "imgr"), tell=_image, told=_elements),
    "getImageCrop": Row(
        ("fgi", "get", "crop"), ask=_corners, asked=_points, tell=_image, told=_elements
    ),
    "getRgbWidth": Row(("visr", "get", "w")),
    "getRgbHeight": Row(("visr", "get", "h")),
    "getRgbResolution": Row(("visr", "get", "res")),
    "setRgbResolution": Row(("visr", "set", "res")),
    "getRgbFOV": Row(("visr", "get", "fov")),
    "setRgbFOV": Row(("visr", "set", "fov")),
    "getRgbSupportedConfigurations": Row(
        ("visr", "get", "conf"), tell=_configurations, told=_modes
    ),
    "getRgbIntrinsicParam": Row(("visr", "get", "intp"), tell=_parameters, told=_pairs),
    "getRgbMirroring": Row(("visr", "get", "mirr"), tell=_truth, told=_number),
    "setRgbMirroring": Row(("visr", "set", "mirr"), ask=_numbers, asked=_truth),
    "getCameraDescription": Row(("fgc", "get", "camd")),
    "hasFeature": _has("feat"),
    "hasOnOff": _has("onof"),
    "hasAuto": _has("auto"),
    "hasManual": _has("man"),
    "hasOnePush": _has("onep"),
    "getFeature1": Row(("fgc", "get", "feat")),
    "setFeature1": Row(("fgc", "set", "feat")),
    "getFeature2": Row(("fgc", "get", "fea2")),
    "setFeature2": Row(("fgc", "set", "fea2")),
    "getActive": Row(("fgc", "get", "actv"), tell=_truth, told=_number),
    "setActive": Row(
        ("fgc", "set", "actv"), ask=_numbers, asked=lambda given: [given[0], given[1] == 1]
    ),
    "getMode": Row(("fgc", "get", "mode")),
    "setMode": Row(("fgc", "set", "mode")),
    "setOnePush": Row(("fgc", "set", "onep")),
}
BY_WORDS: Final = {row.words: name for name, row in FUNCTIONS.items()}
