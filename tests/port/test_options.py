"""PortOptions: every kind of port takes them, in a thread or in an event loop."""

from __future__ import annotations

import inspect
from typing import Any

import pytest

import yarpy
from yarpy.nameserver.local import LocalNames
from yarpy.port.assembly import open_hub
from yarpy.port.options import PortOptions


def ignore(message: object) -> None:
    pass


KINDS: dict[str, tuple[Any, tuple[Any, ...]]] = {
    "Port": (yarpy.Port, ("/kind",)),
    "BufferedPort": (yarpy.BufferedPort, ("/kind",)),
    "RpcServer": (yarpy.RpcServer, ("/kind", ignore)),
    "RpcClient": (yarpy.RpcClient, ()),
}


def test_they_are_those_of_whoever_opens() -> None:
    known = inspect.signature(open_hub).parameters
    assert set(PortOptions.__annotations__) <= set(known)


@pytest.mark.parametrize("kind", KINDS)
def test_every_port_takes_them(kind: str) -> None:
    made, arguments = KINDS[kind]
    events: list[object] = []
    options: PortOptions = {
        "names": LocalNames(),
        "tcp_port": 0,
        "port_type": "yarp/image",
        "limit": 1 << 20,
        "on_connection": events.append,
        "timeout": 20.0,
        "gate": None,
    }
    assert set(options) == set(PortOptions.__annotations__)
    with made(*arguments, **options) as port:
        assert port._hub.limit == 1 << 20
        assert port._hub.callbacks.program.on_connection == events.append


@pytest.mark.parametrize("kind", KINDS)
def test_a_word_that_is_none_of_them_is_named(kind: str) -> None:
    made, arguments = KINDS[kind]
    with pytest.raises(TypeError, match="colour"):
        made(*arguments, colour="red")


@pytest.mark.parametrize(
    ("odd", "why"),
    [
        ({"carrier": "udp"}, 'takes no "carrier": a carrier is chosen for each connection'),
        ({"carier": "udp"}, 'takes no "carier": a carrier is chosen for each connection'),
        ({"limits": 5}, 'takes no "limits": did you mean "limit"?'),
        ({"strict": True}, 'takes no "strict": a BufferedPort may be strict'),
        ({"zzz": 5}, 'takes no "zzz"$'),
        ({"on_connection": 5}, "on_connection is a function of one argument, not 5"),
        ({"callback": 5}, "calls a function of one argument with its messages, not 5"),
    ],
)
def test_what_no_port_takes(odd: dict[str, Any], why: str) -> None:
    with pytest.raises(TypeError, match=why.replace("?", r"\?")):
        yarpy.Port("/kind", names=LocalNames(), **odd)


@pytest.mark.parametrize("handler", [None, 5])
def test_a_handler_is_a_function(handler: Any) -> None:
    with pytest.raises(TypeError, match="the handler of /kind is a function of one argument"):
        yarpy.RpcServer("/kind", handler, names=LocalNames())


def test_a_carrier_is_a_text() -> None:
    names, odd = LocalNames(), {"carrier": 5}
    with yarpy.Port("/a", names=names) as a, yarpy.Port("/b", names=names):
        with pytest.raises(TypeError, match='a carrier is a text such as "tcp", not 5'):
            a.connect("/b", **odd)  # type: ignore[arg-type]
        with pytest.raises(TypeError, match="a time limit is a number of seconds or None"):
            a.connect("/b", timeout="1")  # type: ignore[arg-type]
