"""Views that follow from an interface of `yarpy.devices`: the names of C++, arguments and results.

    class IMap2D(Mirror, of=("Map2D",)): ...

Rules: a method takes what its member takes, then where the results go, and returns whether it went
well; without places for the results it returns them, as the bindings of C++ do. A method of C++
with several forms is told by how many arguments there are. Objects go over as their messages; a
word is a vocab's number.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Annotated, Any, get_args, get_origin

import yarpy
from yarp._log import say
from yarp._memory import encoded
from yarp._numbers import StdVector, store
from yarp._portable import PortReader, PortWriter
from yarp._view import FAILURES, View
from yarpy.kits import devices, thrift
from yarpy.kits.devices.interfaces import interfaces

Member = Any  # of `Interface.members`


class Mirror(View):
    """The base of these views. `of`: the interfaces that they show."""

    def __init_subclass__(cls, of: Sequence[str] = (), **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        known = interfaces()
        forms: dict[str, list[Member]] = {}
        for name in of:
            for each in known[name].members.values():
                if each.cpp:
                    forms.setdefault(each.cpp, []).append(each)
        for name, members in forms.items():
            if name not in vars(cls):
                setattr(cls, name, _method(name, members))


def _method(name: str, members: list[Member]) -> Callable[..., Any]:
    def method(self: Mirror, *arguments: Any) -> Any:
        for each in members:
            takes = _takes(each)
            if len(arguments) == len(takes) + len(each.results) and each.results:
                return _call(self, each, takes, arguments, arguments[len(takes) :])
        for each in members:
            takes = _takes(each)
            least = sum(1 for one in takes if one.default is one.empty)
            if least <= len(arguments) <= len(takes):
                return _call(self, each, takes, arguments, None)
        raise TypeError(f"{name} of {type(self).__name__} does not take {len(arguments)} arguments")

    method.__name__ = name
    method.__doc__ = members[0].doc
    return method


def _takes(each: Member) -> list[Any]:
    return [*each.signature.parameters.values()][1:]


def _call(
    self: Mirror,
    each: Member,
    takes: list[Any],
    arguments: tuple[Any, ...],
    places: tuple[Any, ...] | None,
) -> Any:
    given = [_incoming(one.annotation, value) for one, value in zip(takes, arguments, strict=False)]
    try:
        found = getattr(self._board, each.name)(*given)
    except (*FAILURES, devices.Refused, TypeError) as error:
        say("ERROR", f"|yarp.dev.{type(self).__name__}| {each.cpp}: {error}")
        return _nothing(each) if places is None and each.results else False
    if not each.results:
        return True
    results = (found,) if len(each.results) == 1 else found
    if places is None:
        made = [_outgoing(kind, one) for kind, one in zip(each.results, results, strict=True)]
        return made[0] if len(made) == 1 else tuple(made)
    for place, kind, one in zip(places, each.results, results, strict=True):
        _fill(place, kind, one)
    return True


def _plain(annotation: Any) -> Any:
    """The class behind an annotation."""
    while get_origin(annotation) is Annotated:
        annotation = get_args(annotation)[0]
    return annotation


def _element(annotation: Any) -> Any:
    """The class of a list's elements; None if it is no list."""
    return _plain(get_args(annotation)[0]) if get_origin(annotation) is list else None


def _incoming(annotation: Any, value: Any) -> Any:
    """An argument as the device wants it."""
    if isinstance(value, PortWriter):
        kind, sent = _plain(annotation), value._outgoing()
        if isinstance(kind, type) and issubclass(kind, thrift.Struct):
            return kind.from_wire(b"".join(bytes(each) for each in sent.to_wire()))
        return sent
    if annotation == thrift.vocab and isinstance(value, int):
        return yarpy.Vocab.from_code(value)
    return value


def _fill(place: Any, annotation: Any, value: Any) -> None:
    """Put a result where it goes."""
    if isinstance(place, PortReader):
        place._take(yarpy.Message("D", encoded(value)))
    elif _element(annotation) is not None:
        of = getattr(place, "_of", None)
        items = [each if of is None else _made(of, each) for each in value]
        if isinstance(place, StdVector):
            place._items[:] = items
        else:
            store(place, items)
    else:
        store(place, [_outgoing(annotation, value)])


def _made(of: Any, value: Any) -> Any:
    return of._from(yarpy.Message("D", encoded(value)))


def _outgoing(annotation: Any, value: Any) -> Any:
    """A result as the bindings have it."""
    from yarp._struct import STRUCTS, vector_of

    if annotation == thrift.vocab:
        return yarpy.Vocab(value).code
    if isinstance(value, thrift.Struct):
        of = STRUCTS.get(type(value).__name__)
        return value if of is None else _made(of, value)
    element = _element(annotation)
    if element is not None:
        of = STRUCTS.get(element.__name__)
        return value if of is None else vector_of(of, [_made(of, each) for each in value])
    return value


def _nothing(each: Member) -> Any:
    """Return what the bindings return where there is no result."""
    made = [_outgoing(kind, _default(kind)) for kind in each.results]
    return made[0] if len(made) == 1 else tuple(made)


def _default(annotation: Any) -> Any:
    return [] if _element(annotation) is not None else _plain(annotation)()


class ILocalization2D(Mirror, of=("Localization2D",)):
    """Where a robot is in a map."""


class IMap2D(Mirror, of=("Map2D",)):
    """Maps, and what has a name in them."""


class IOdometry2D(Mirror, of=("Odometry2D",)):
    """How a base has moved."""


class ILLM(Mirror, of=("LanguageModel",)):
    """A language model in a conversation."""


class ISimulatedWorld(Mirror, of=("World",)):
    """The objects of a simulator."""


class ISpeechSynthesizer(Mirror, of=("SpeechSynthesizer",)):
    """Somebody who speaks."""


class ISpeechTranscription(Mirror, of=("SpeechTranscription",)):
    """Somebody who understands."""


class IRGBDSensor(Mirror, of=("DepthCamera",)):
    """A camera that measures distances."""

    RGBD_SENSOR_NOT_READY, RGBD_SENSOR_OK_STANDBY, RGBD_SENSOR_OK_IN_USE = range(3)
    RGB_SENSOR_ERROR, DEPTH_SENSOR_ERROR, RGBD_SENSOR_GENERIC_ERROR, RGBD_SENSOR_TIMEOUT = range(
        3, 7
    )

    def getImages(
        self, colorFrame: Any, depthFrame: Any, colorStamp: Any = None, depthStamp: Any = None
    ) -> bool:
        """Read both pictures; they come with no stamps."""
        return bool(self.getRgbImage(colorFrame) and self.getDepthImage(depthFrame))

    def getRgbImage(self, rgbImage: Any, timeStamp: Any = None) -> bool:
        """Read the newest picture; it comes with no stamp."""
        return self._tell(lambda: _fill(rgbImage, yarpy.Image, self._board.colour()))

    def getDepthImage(self, depthImage: Any, timeStamp: Any = None) -> bool:
        """Read the newest distances, in metres; they come with no stamp."""
        return self._tell(lambda: _fill(depthImage, yarpy.Image, self._board.depth()))
