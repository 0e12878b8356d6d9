"""Refusals for people become errors for programs."""

from __future__ import annotations

import pytest
from support.wait import wait_until

from yarpy.errors import (
    LinkClosed,
    LocalProtocolError,
    LoginRefused,
    UnknownName,
    UnknownPlugin,
    YarpError,
)
from yarpy.nameserver.local import LocalNames
from yarpy.port import wiring
from yarpy.port.buffered import BufferedPort
from yarpy.port.command import Refused
from yarpy.port.port import Port


def refusal(text: str, cause: Exception | None = None) -> Refused:
    error = Refused(text)
    error.__cause__ = cause
    return error


CASES = [
    (refusal("Do not know how to connect to /in"), UnknownName, "is registered"),
    (refusal("Cannot connect to /in"), LinkClosed, "no answer"),
    (refusal("Cannot connect to /in", LinkClosed("nobody answers")), LinkClosed, "nobody answers"),
    (refusal("Cannot connect to x://in", UnknownPlugin("no carrier")), UnknownPlugin, "no carrier"),
    (refusal("Not admitted to x", LoginRefused("who?")), LoginRefused, 'admitted to "/in": who?'),
    (refusal("Outputs not allowed"), LocalProtocolError, "Outputs not allowed"),
    (refusal("RPC output already connected"), LocalProtocolError, "already connected"),
]


@pytest.mark.parametrize(("error", "kind", "words"), CASES)
def test_error_that_fits(
    error: Refused, kind: type[YarpError], words: str, names: LocalNames
) -> None:
    with Port("/out", names=names) as out:
        found = wiring.explained(out._hub, "/in", "tcp", error)
        assert type(found) is kind
        assert words in str(found)


def test_nearest_name_is_suggested(names: LocalNames) -> None:
    with Port("/camera/left", names=names), Port("/camera/right", names=names):
        assert 'did you mean "/camera/left"' in str(wiring.unknown("/camera/lef", names))
        assert "is its program running" in str(wiring.unknown("/something", names))
    assert "is its program running" in str(wiring.unknown("/x", None))


def test_own_multicast_group_does_not_count_as_a_name(names: LocalNames) -> None:
    with pytest.raises(UnknownName), Port("/out", names=names) as out:
        out.connect("/nobody", "mcast")


@pytest.mark.parametrize("end", ["", "/", "/in"])
def test_carrier_in_front_of_an_address_counts(names: LocalNames, end: str) -> None:
    with Port("/in", names=names) as in_, Port("/out", names=names) as out:
        out.connect(f"text://{in_.address}{end}")
        assert [link.carrier for link in out.outputs] == ["text"]


def test_unknown_carrier_in_front_of_an_address(names: LocalNames) -> None:
    with Port("/out", names=names) as out, pytest.raises(UnknownPlugin, match="texxt"):
        out.connect("texxt://127.0.0.1:10002/")


def test_what_pulls_is_ended_by_who_has_made_it(names: LocalNames) -> None:
    """A port that watches a camera has an input from it, and ends it in the words it began with."""
    with Port("/camera", names=names) as camera, BufferedPort("/view", names=names) as view:
        for target in ("/camera", f"/{camera.address}", f"mjpeg://{camera.address}/"):
            view.connect(target, "mjpeg")
            assert view.inputs
            assert view.disconnect(target)
            wait_until(lambda: not view.inputs and not camera.outputs)
            assert not view.disconnect(target)
