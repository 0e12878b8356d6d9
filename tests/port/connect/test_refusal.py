"""Refusals: errors to lines and back."""

from __future__ import annotations

import doctest

import pytest

from yarpy import errors
from yarpy.errors import (
    AccessRefused,
    AddressError,
    LinkClosed,
    LocalProtocolError,
    LoginRefused,
    NoNameServer,
    NotAllowed,
    PortClosed,
    RemoteProtocolError,
    UnknownName,
    UnknownPlugin,
    YarpError,
)
from yarpy.port.connect import refusal


def test_examples_in_the_docstrings() -> None:
    found = doctest.testmod(refusal, extraglobs=vars(errors))
    assert found.attempted == 2
    assert found.failed == 0


ROWS = [
    # our error, its line, what the line means from outside
    (UnknownName("x"), "Do not know how to connect to tcp://b", UnknownName),
    (AddressError("x"), "Do not know how to connect to tcp://b", UnknownName),
    (LoginRefused("who?"), "Not admitted to tcp://b: who?", LoginRefused),
    (AccessRefused("Access refused: x"), "No access to tcp://b: Access refused: x", AccessRefused),
    (NotAllowed("Outputs not allowed"), "Outputs not allowed", NotAllowed),
    (LocalProtocolError("no"), "Cannot connect to tcp://b: no", LinkClosed),
    (RemoteProtocolError("no"), "Cannot connect to tcp://b: no", LinkClosed),
    (LinkClosed("nobody"), "Cannot connect to tcp://b: nobody", LinkClosed),
    (UnknownPlugin("no x"), "Cannot connect to tcp://b: no x", LinkClosed),
    (NoNameServer("no"), "Cannot connect to tcp://b: no", LinkClosed),
    (PortClosed("no"), "Cannot connect to tcp://b: no", LinkClosed),
]


@pytest.mark.parametrize(("error", "line", "kind"), ROWS)
def test_rows(error: YarpError, line: str, kind: type[YarpError]) -> None:
    assert refusal.line(error, "tcp://b") == line
    meant = refusal.error(line, "this")
    assert type(meant) is kind
    assert str(meant) == f"this was refused: {line}"


@pytest.mark.parametrize("kind", [AddressError, UnknownName, LinkClosed])
def test_targets_that_are_no_ports_get_the_reason(kind: type[YarpError]) -> None:
    line = refusal.line(kind("no QoS"), "ros2+qos.fast://a")
    assert line.endswith(" connect to ros2+qos.fast://a: no QoS")


@pytest.mark.parametrize("line", ["RPC output already connected", "", "something else"])
def test_other_lines_are_reasons_of_a_port(line: str) -> None:
    assert type(refusal.error(line, "this")) is NotAllowed


def test_a_port_refuses_the_request_itself() -> None:
    assert type(refusal.error("Access refused: x may not ...", "this")) is AccessRefused


def test_lines_of_cpp_have_no_reason() -> None:
    assert type(refusal.error("Cannot connect to tcp://b", "this")) is LinkClosed
