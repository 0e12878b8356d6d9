"""Services of devices in one line a function, as their `.thrift` file says them.

    class Info(Answer):             class LampMsgs(Service):
        text: str = ""                  getInfoRPC = function(Info)
                                        setLevelRPC = function(Status, level=float)

Rules: who serves it defines the functions in a subclass. Beside each module that declares one lies
its `functions.thrift`, for programs in other languages; tests hold one against the other.
"""

from __future__ import annotations

from inspect import Parameter, Signature
from typing import Any

from yarpy.kits.thrift.kind import Nested, vocab
from yarpy.kits.thrift.method import method
from yarpy.kits.thrift.structure import Struct, new


class Status(Struct):
    """The outcome of a call: ok, or err1 (failed) ... err7, miss."""

    code: vocab = ""


class Answer(Struct):
    """The base of answers: the status in front, the fields of a subclass behind."""

    status: Nested[Status] = new(Status)


def function(result: Any, /, **arguments: Any) -> Any:
    """Return a function of a service, with these arguments: their names and types."""

    def declared(self: Any, *given: Any) -> Any:
        raise NotImplementedError

    of_it = ("self", Parameter.empty), *arguments.items()
    declared.__signature__ = Signature(  # type: ignore[attr-defined]
        [Parameter(name, Parameter.POSITIONAL_OR_KEYWORD, annotation=kind) for name, kind in of_it],
        return_annotation=result,
    )
    return method(declared)
