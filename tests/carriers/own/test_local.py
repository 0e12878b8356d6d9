"""local: references within one process; only the introduction is bytes."""

from __future__ import annotations

import pytest
from support.capture import load_capture

from yarpy.carriers.own.local import Local
from yarpy.errors import RemoteProtocolError
from yarpy.nameserver.local import LocalNames
from yarpy.port.port import Port
from yarpy.route import Route
from yarpy.testing import CarrierConformance, Dialogue, End
from yarpy.transports.tcp import dial


class TestLocal(CarrierConformance):
    carrier = Local


def test_golden_greeting() -> None:
    end = End()
    end.begin(Local(Route("/cap/out", "/cap/in", "local")).greet(end.stream))
    assert end.take() == load_capture("conn_local").steps[0].data


def test_object_itself_arrives() -> None:
    talk = Dialogue(Local)
    talk.greet()
    thing = [object()]
    message = talk.send(thing, "7 1.5")
    assert message.value is thing
    assert message.envelope == "7 1.5"
    reply = talk.reply(thing)
    assert reply is not None
    assert reply.value is thing


def test_stranger_is_refused_at_once() -> None:
    """In C++ a greeting from another process makes the port wait for ever."""
    with Port("/here", names=LocalNames()) as port:
        stranger = dial("127.0.0.1", port.contact.port, 5)
        stranger.limit_waiting(5)
        stranger.send([load_capture("conn_local").steps[0].data])
        assert stranger.recv_into(memoryview(bytearray(10))) == 0
        stranger.close()
        assert port.inputs == []


def test_error_tells_what_to_use_instead() -> None:
    from yarpy.transports.inproc import open_inproc

    with pytest.raises(RemoteProtocolError, match="unix_stream"):
        open_inproc(True, ("127.0.0.1", 1), ("127.0.0.1", 2))
