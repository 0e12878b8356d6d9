"""Every member of an interface goes from a client to a device, and back.

check_every_member(Odometry2D, names)
"""

from functools import partial
from typing import Annotated, Any, get_args, get_origin

from support.wait import HANG, wait_until

import yarpy
from yarpy.kits.devices.network.model import Interface, Member
from yarpy.kits.thrift.kind import kind_of
from yarpy.kits.thrift.structure import default_of, same
from yarpy.nameserver.local import LocalNames


def value(annotation: Any) -> Any:
    """The first value of its kind."""
    try:
        kind = kind_of(annotation, {})[0]
    except TypeError:
        return _plain(annotation)
    made = default_of(kind)()
    return _plain(annotation) if made is None or isinstance(made, yarpy.Sound) else made


def _plain(annotation: Any) -> Any:
    """Something of a class with an encoding of its own."""
    while get_origin(annotation) is Annotated:
        annotation = get_args(annotation)[0]
    if annotation is yarpy.Sound:
        return yarpy.Sound([[1, 2], [3, 4]], 8000)
    if annotation is yarpy.Image:
        import numpy as np

        return yarpy.Image(np.zeros((2, 3, 3), "u1"))
    return annotation([[1.0]])


class Recorder:
    """Has every member of an interface, and remembers how they were called."""

    def __init__(self, interface: type[Interface]) -> None:
        self.told: list[tuple[str, tuple[Any, ...]]] = []
        for each in interface.members.values():
            setattr(self, each.name, self._member(each))

    def _member(self, each: Member) -> Any:
        def member(*arguments: Any) -> Any:
            self.told.append((each.name, arguments))
            found = tuple(value(annotation) for annotation in each.results)
            return found[0] if len(found) == 1 else found or None

        return member


def arguments(each: Member) -> tuple[Any, ...]:
    names = [*each.signature.parameters.values()][1:]
    return tuple(value(parameter.annotation) for parameter in names)


def check_every_member(interface: type[Interface], names: LocalNames) -> None:
    """Call each, in the forms of YARP 3.9 and 3.12."""
    for newer in (False, True):
        device = Recorder(interface)
        with (
            interface.serve("/device", device, 0.01, newer=newer, names=names),
            interface.connect("/device", timeout=HANG, names=names) as client,
        ):
            for each in interface.members.values():
                assert each.doc, f"{each.name} has no docstring"
                given = arguments(each)
                found = getattr(client, each.name)(*given)
                wanted = tuple(value(annotation) for annotation in each.results)
                assert same(found, wanted[0] if len(wanted) == 1 else wanted or None), each.name
                call = each.name, given
                wait_until(partial(_was_told, device, call))


def _was_told(device: Recorder, call: tuple[str, tuple[Any, ...]]) -> bool:
    return any(name == call[0] and same([*call[1]], [*given]) for name, given in device.told)
