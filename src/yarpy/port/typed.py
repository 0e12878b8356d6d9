"""Ports for one type of message: `Port[Image]`, `BufferedPort[Observation]`, `RpcClient[Arm]`.

Rules: for type checkers they are generic classes. When a program runs, `Port[Image]` is a subclass
of Port that knows its type, made once, so that its messages are read as that and nothing else. What
is written is checked by type checkers alone: a message may be made of more than its type, as an
array where an Image is read.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any, Final, TypeVar


def of_type(cls: type[Any], type_: Any) -> type[Any]:
    """Return the class of such ports for messages of that type. Raises TypeError for a class that
    has one."""
    if type_ is Any or isinstance(type_, TypeVar):
        return cls
    if cls._type is not None:
        raise TypeError(f"{cls.__name__} has its type already")
    try:
        return _kept(cls, type_)
    except TypeError:  # a type that cannot be a key, as Annotated[int, []]
        return _made(cls, type_)


def _made(cls: Any, type_: Any) -> type[Any]:
    said = type_.__name__ if isinstance(type_, type) else str(type_)
    names = {
        "__module__": cls.__module__,
        "__qualname__": f"{cls.__qualname__}[{said}]",
        "__doc__": cls.__doc__,
        "_type": type_,
    }
    return type(f"{cls.__name__}[{said}]", (cls,), names)


_kept: Final[Callable[..., type[Any]]] = lru_cache(maxsize=256)(_made)
