"""The functions of an interface as a service of Thrift: what travels for a call, both ways.

Rules: made once for each interface, when it is first served or connected. An answer is the status,
then the results; `StatusMethod` reads the status of any version. Which form an asker gets is the
business of `DeviceService`.
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable
from functools import cached_property
from typing import Any, ClassVar, Final

from yarpy.data.value import Buffer
from yarpy.data.walker import Walker
from yarpy.kits.devices.declared import Status
from yarpy.kits.devices.network.model import Interface, Member, Oldest
from yarpy.kits.devices.service import DeviceService
from yarpy.kits.devices.status import newest
from yarpy.kits.thrift.kind import Nested
from yarpy.kits.thrift.method import Method, method
from yarpy.kits.thrift.structure import Struct, new

#: the tag of a number
_NUMBER: Final = b"\1\0\0\0"

_KNOWN: Final[dict[type[Interface], type[Functions]]] = {}


class Functions(DeviceService):
    """The base of these services. A server hands in the one who does what is asked."""

    #: the classes of answers by the names of members; None where there is no status
    _answers: ClassVar[dict[str, type[Any] | None]] = {}

    #: answers a message in words (`network.words`), or returns None: it is not in words
    said: Callable[[Any], Any] | None = None

    def __init__(self, perform: Any) -> None:
        self._perform = perform

    def __call__(self, message: Any) -> Any:
        """Answer a message."""
        found = None if self.said is None else self.said(message)
        return super().__call__(message) if found is None else found


class StatusEnd:
    """Finds the end of an answer, which YARP 3.12 begins with a number where it is a status alone;
    see `yarpy.data.walker.Walker`."""

    def __init__(self, limit: int) -> None:
        self.done = False
        self._walker = Walker(limit)

    def advance(self, view: Buffer) -> int:
        """The least number of bytes that the answer has; its length, once `done`."""
        if len(view) < 8:
            return 8
        if bytes(view[:4]) == _NUMBER:
            self.done = True
            return 8
        need = self._walker.advance(view)
        self.done = self._walker.done
        return need


class StatusMethod(Method):
    """A function whose answer has a status in front."""

    @property
    def ending(self) -> Any:
        """The function that finds the end of its answers, which need be no Bottles."""
        return StatusEnd

    #: what servers before YARP 3.10 say otherwise
    oldest: Oldest | None = None

    @cached_property
    def asks_floats(self) -> bool:
        """True if the server has to be known first, and has to know that yarpy asks."""
        return self.oldest is not None or super().asks_floats

    def read_answer(self, data: Buffer) -> Any:
        """The status and the results. DecodeError."""
        data = newest(data, self.result is not Status)
        return super().read_answer(self.oldest.read(self.name, data) if self.oldest else data)


def functions_of(interface: type[Interface]) -> type[Functions]:
    """Return the service of an interface."""
    found = _KNOWN.get(interface)
    if found is None:
        found = _KNOWN[interface] = _made(interface)
    return found


def answer_class(each: Member) -> type[Any]:
    """Return the class of answers of a member that has a status."""
    if not each.results and not each.boxed:
        return Status
    names = {f"value{at}": kind for at, kind in enumerate(each.results)}
    space = {
        "__module__": __name__,
        "__annotations__": {"status": Nested[Status], **names},
        "status": new(Status),
    }
    return type(each.function, (Struct,), space)


def _made(interface: type[Interface]) -> type[Functions]:
    answers: dict[str, type[Any] | None] = {}
    space: dict[str, Any] = {"__module__": interface.__module__, "__doc__": interface.__doc__}
    for each in interface.members.values():
        if not each.function:
            continue
        answer = answers[each.name] = answer_class(each) if each.status else None
        returned = answer if each.status else (each.results or (None,))[0]
        space[each.function] = _function(each, returned)
    space["_answers"] = answers
    space["_namespace"] = vars(sys.modules[interface.__module__])
    made: type[Functions] = type(interface.__name__, (Functions,), space)
    for name, known in made._methods.items():
        function = vars(made)[name]
        if answers[function.member] is not None:
            made._methods[name] = found = StatusMethod(name, function, known._names)
            found.oldest = interface.OLDEST
        if interface.members[function.member].whole:
            made._methods[name].words = [name]
    return made


def _function(each: Member, returned: Any) -> Any:
    def function(self: Functions, *arguments: Any) -> Any:
        return self._perform(each, self._answers[each.name], arguments)

    marked: Any = function
    marked.__name__ = each.function
    marked.__doc__ = each.doc
    marked.__signature__ = each.signature.replace(
        return_annotation=inspect.Signature.empty if returned is None else returned
    )
    marked.member = each.name
    return method(marked)
