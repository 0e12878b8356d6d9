"""Names of C++ that mean nothing in Python: they can be imported, and say why when called.

    class Wire(Absent, members="yarp", why="yarpidl_thrift makes Python"): ...

Rules: calling is a NotImplementedError that says what to do instead. `refused` tells such members
from the others: compat/README.md counts them by themselves.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar

F = TypeVar("F", bound=Callable[..., Any])

_REFUSES = "_yarp_refuses"


def refuses(function: F) -> F:
    """Mark a function that raises NotImplementedError whatever it is given."""
    setattr(function, _REFUSES, True)
    return function


def refused(member: Any) -> bool:
    """Return whether a member of a class was marked by `refuses`."""
    return bool(getattr(member, _REFUSES, False))


def refusal(name: str, why: str) -> Callable[..., NoReturn]:
    """Return a function that says that there is no `name`, and why."""

    @refuses
    def refuse(*arguments: Any, **options: Any) -> NoReturn:
        raise NotImplementedError(f"{name} means nothing in Python: {why}")

    refuse.__name__ = name.rpartition(".")[2]
    refuse.__doc__ = f"Refuse: {why}."
    return refuse


class Absent:
    """The base of classes whose objects cannot be made here. `members`: those of C++."""

    _why = ""

    def __init_subclass__(cls, members: str = "", why: str = "") -> None:
        super().__init_subclass__()
        if why:
            cls._why = why
            for member in members.split():
                setattr(cls, member, refusal(f"{cls.__name__}.{member}", why))

    def __init__(self, *arguments: Any) -> None:
        raise NotImplementedError(f"{type(self).__name__} means nothing in Python: {self._why}")

    if TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any: ...
