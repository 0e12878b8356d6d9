"""The tree of errors: as drawn at the top of its file, and catchable the usual ways."""

from __future__ import annotations

import re

import pytest

import yarpy
from yarpy import errors

TREE = [
    # ours, what else it is
    ("AddressError", ValueError),
    ("UnknownName", LookupError),
    ("WrongPort", errors.UnknownName),
    ("UnknownType", LookupError),
    ("UnknownPlugin", LookupError),
    ("MissingFile", FileNotFoundError),
    ("NoNameServer", ConnectionError),
    ("PortClosed", RuntimeError),
    ("LinkClosed", ConnectionError),
    ("Timeout", TimeoutError),
    ("RemoteError", errors.YarpError),
    ("DecodeError", ValueError),
    ("Truncated", errors.DecodeError),
    ("LocalProtocolError", errors.YarpError),
    ("NotAllowed", errors.LocalProtocolError),
    ("RemoteProtocolError", errors.YarpError),
    ("AccessRefused", errors.RemoteProtocolError),
    ("LoginRefused", errors.AccessRefused),
]


@pytest.mark.parametrize(("name", "kind"), TREE)
def test_each_is_ours_and_one_of_pythons(name: str, kind: type[Exception]) -> None:
    error = getattr(errors, name)
    assert issubclass(error, errors.YarpError)
    assert issubclass(error, kind)
    assert getattr(yarpy, name) is error
    assert error.__doc__
    with pytest.raises(kind):
        raise error("what happened; what to do")


def test_drawing_is_complete() -> None:
    drawn = dict(re.findall(r"^\s*\|?\s*[|`]-- (\w+)(?: \((\w+)\))?", errors.__doc__ or "", re.M))
    defined = {
        name
        for name, value in vars(errors).items()
        if isinstance(value, type) and issubclass(value, errors.YarpError)
    } - {"YarpError"}
    assert set(drawn) == defined == {name for name, _ in TREE}
    for name, base in drawn.items():
        if base:
            assert base in [kind.__name__ for kind in getattr(errors, name).__mro__]


def test_truncated_knows_what_is_needed() -> None:
    assert errors.Truncated("short", need=12).need == 12
    assert errors.Truncated("short").need == 0
