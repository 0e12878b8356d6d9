"""Failure: how the exception of a server's handler travels as an answer.

    [fail] "ZeroDivisionError: division by zero" (raised ZeroDivisionError)

Rules: it begins as every failure of YARP does, so that a client of C++ sees one, with its reason;
the list behind these two marks an exception. A failure without the mark is the answer that a
handler chose to give, and stays a value.
"""

from __future__ import annotations

from typing import Final

from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.errors import RemoteError

_RAISED: Final = "raised"


def raised(kind: str, text: str) -> Bottle:
    """Return the answer for an exception of that kind, with that text.

    >>> print(raised("ValueError", "too far"))
    [fail] "ValueError: too far" (raised ValueError)
    """
    return Bottle([Vocab("fail"), f"{kind}: {text}", mark(kind)])


def answer_of(error: BaseException) -> Bottle:
    """Return the answer of a server whose handler has raised `error`. That of a server which the
    handler has asked in turn goes on as it is."""
    if isinstance(error, RemoteError) and error.type:
        return raised(error.type, error.text)
    return raised(type(error).__name__, str(error))


def mark(kind: str) -> list[str]:
    """Return what marks an exception of that kind."""
    return [_RAISED, kind]


def marked(value: object) -> str:
    """Return the kind of exception that a mark tells of; "" for what is none."""
    if isinstance(value, list) and len(value) == 2 and value[0] == _RAISED:
        return str(value[1])
    return ""


def error_of(answer: object) -> RemoteError | None:
    """Return the exception that an answer stands for; None for any other answer."""
    if not isinstance(answer, list) or len(answer) != 3 or answer[0] != Vocab("fail"):
        return None
    kind = marked(answer[2])
    if not kind or not isinstance(answer[1], str):
        return None
    return RemoteError(answer[1].removeprefix(f"{kind}: "), kind)
