"""The types that type checkers see of a decorated method: the method, whose calls may also have a
`timeout`.

Rules: Protocols and aliases only; when a program runs, a decorated function is a function.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Concatenate, ParamSpec, Protocol, TypeVar, overload

P = ParamSpec("P")
Q = ParamSpec("Q")
R = TypeVar("R")
Result = TypeVar("Result", covariant=True)
F = TypeVar("F")


class Call(Protocol[P, Result]):
    """A decorated method of an object, or a decorated function."""

    @overload
    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> Result: ...
    @overload
    def __call__(self, *args: Any, timeout: float | None, **kwargs: Any) -> Result: ...


class Decorated(Call[P, Result], Protocol[P, Result]):
    """A decorated function, which may be a method of a class."""

    @overload
    def __get__(self, instance: None, owner: Any = None) -> Decorated[P, Result]: ...
    @overload
    def __get__(
        self: Decorated[Concatenate[Any, Q], R], instance: object, owner: Any = None
    ) -> Call[Q, R]: ...


class Decorator(Protocol):
    """The result of `wrap.on`; a static or class method stays what it is."""

    @overload
    def __call__(self, func: Callable[P, R], /) -> Decorated[P, R]: ...
    @overload
    def __call__(self, func: F, /) -> F: ...
