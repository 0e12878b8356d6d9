"""Hints: those that can be sent, and errors that name what cannot."""

from __future__ import annotations

import threading
import typing
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pytest

import yarpy
from yarpy.kits.wrap.value.array import Array
from yarpy.kits.wrap.value.hint import shape_of
from yarpy.kits.wrap.value.shape import ANY, Scalar, Several, Table

T = typing.TypeVar("T")
N = typing.TypeVar("N", bound=int)
Metres = typing.NewType("Metres", float)


@dataclass
class Holder:
    lock: threading.Thread


@dataclass
class Endless:
    next: typing.Optional[Endless]  # noqa: UP045


def test_kinds() -> None:
    assert shape_of(typing.Any) is ANY and shape_of(T) is ANY and shape_of(object) is ANY
    assert isinstance(shape_of(N), Scalar) and shape_of(Metres).name == "float"
    assert isinstance(shape_of(Sequence[int]), Several)
    assert isinstance(shape_of(Mapping[str, int]), Table)
    assert isinstance(shape_of(np.ndarray), Array)
    assert shape_of(typing.Optional[int]).name == "None or int"  # noqa: UP045
    assert shape_of(yarpy.Image).name == "Image"


@pytest.mark.parametrize(
    "hint",
    [
        threading.Thread,
        Callable[[], None],
        Iterator[int],
        list[threading.Thread],
        type,
        print,
        dict[str, threading.Thread],
        tuple[int, threading.Thread],
        type | None,
    ],
)
def test_what_cannot_be_sent(hint: object) -> None:
    with pytest.raises(TypeError, match="cannot be sent"):
        shape_of(hint)


def test_field_that_cannot_be_sent_is_named() -> None:
    with pytest.raises(TypeError, match=r"lock of Holder: threading.Thread cannot be sent"):
        shape_of(Holder)


def test_type_without_an_end() -> None:
    with pytest.raises(TypeError, match="holds itself"):
        shape_of(Endless)
