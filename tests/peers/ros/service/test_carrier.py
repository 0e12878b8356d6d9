"""rossrv: the captures of C++ YARP and rospy in both roles, failures, the conformance suite."""

from __future__ import annotations

import struct
from typing import Any

import pytest
from support.capture import load_capture
from support.ros_link import ADD, AddTwoInts, Int32, accept, header, taken_header

from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.errors import AccessRefused, LocalProtocolError, RemoteProtocolError
from yarpy.link.begin.handshake import asked_carrier
from yarpy.peers.ros.service.carrier import RosSrv
from yarpy.route import UNDECLARED, Declared, Route, parse_carrier
from yarpy.testing import CarrierConformance, End
from yarpy.wire.effects import May
from yarpy.wire.message import QUIT, Message, Packet
from yarpy.wire.stream import ByteStream

PIECES = [0, 1]
SERVED = Declared("/yarp_add", "/add_two_ints", "rospy_tutorials/AddTwoInts", AddTwoInts)


class TestRosSrv(CarrierConformance):
    carrier = RosSrv
    names_sender = False
    carries_envelopes = False

    def of_size(self, size: int) -> Any:
        return ["put", bytes(size)]  # a blob alone is a body


def asked(end: End, carrier: RosSrv, body: bytes) -> Message:
    end.begin(carrier.decode(end.stream))
    end.feed(struct.pack("<I", len(body)) + body)
    message = end.result
    assert isinstance(message, Message)
    return message


def dialled(declared: Declared, answer: bytes, piece: int = 0) -> tuple[End, RosSrv]:
    """An end that has dialled a server who answers so."""
    end, talk = End(piece), RosSrv(Route("/me", "/s", "rossrv", declared=declared))
    end.begin(talk.greet(end.stream))
    end.feed(answer)
    assert end.done
    end.take()
    return end, talk


# ------------------------------------------------------------------------------------ the captures


@pytest.mark.parametrize("piece", PIECES)
@pytest.mark.parametrize("name", ["ros_yarp_srv_tcpros_2", "ros_yarp_srv_tcpros_3"])
def test_a_server_answers_rospy_as_cpp_does(name: str, piece: int) -> None:
    """C++ answers with the checksum of the request alone, which is a defect."""
    steps = load_capture(name).steps
    end, carrier = accept(steps[0].data, SERVED, piece)
    assert carrier.route.source == "/py_cli"
    fields, _ = taken_header(end)
    assert (fields["md5sum"], fields["type"]) == (ADD, "rospy_tutorials/AddTwoInts")
    for question, answer in zip(steps[2::2], steps[3::2], strict=True):
        end.begin(carrier.decode(end.stream))
        end.feed(question.data)
        carrier.encode_reply(end.stream, [sum(end.result.value)])
        assert end.take() == answer.data
    end.begin(carrier.decode(end.stream))
    assert end.done is name.endswith("2")  # not persistent: it is over
    assert end.result is None or end.result.key == QUIT


def test_nothing_is_awaited_behind_a_goodbye() -> None:
    """Which is never answered: who closes would wait in vain."""
    end, talk = End(0), RosSrv(Route("/me", "/s", "rossrv"))
    talk.encode_quit(end.stream)
    assert end.take() == b""
    end.begin(talk.expect_ack(end.stream))
    assert end.done


@pytest.mark.parametrize("piece", PIECES)
def test_a_probe_gets_a_header_and_no_more(piece: int) -> None:
    end, carrier = accept(load_capture("ros_yarp_srv_tcpros").steps[0].data, SERVED, piece)
    fields, rest = taken_header(end)
    assert fields["type"] == "rospy_tutorials/AddTwoInts"
    assert "probe" not in fields and not rest
    end.begin(carrier.decode(end.stream))
    assert end.result.key == QUIT
    assert carrier.route.source == "probe"  # not shown as a connection


@pytest.mark.parametrize("piece", PIECES)
def test_a_client_asks_rospy_as_cpp_does(piece: int) -> None:
    steps = load_capture("ros_ros_srv_tcpros").steps
    declared = Declared("", "/add_two_ints", "rospy_tutorials/AddTwoInts", AddTwoInts)
    end, carrier = dialled(declared, steps[1].data, piece)
    for question, answer in zip(steps[2::2], steps[3::2], strict=True):
        numbers = struct.unpack("<qq", question.data[4:])
        carrier.encode(end.stream, Packet([*numbers], key="d"))
        assert end.take() == question.data
        end.begin(carrier.expect_reply(end.stream))
        end.feed(answer.data)
        assert end.result.value == sum(numbers)
        end.begin(carrier.expect_ack(end.stream))
        assert end.done


def test_rospy_refuses_another_checksum() -> None:
    answer = load_capture("ros_ros_srv_bad_md5_tcpros").steps[1].data
    with pytest.raises(
        RemoteProtocolError, match=r"refuses the connection: .*md5sums do not match"
    ):
        dialled(SERVED, answer)


# ---------------------------------------------------------------------------------------- failures

CALLED = {"callerid": "/c", "md5sum": ADD, "service": "/add_two_ints", "persistent": "1"}


def test_a_failure_travels_as_its_reason() -> None:
    end, server = accept(header(**CALLED), SERVED)
    end.take()
    asked(end, server, bytes(16))
    server.encode_reply(end.stream, Bottle([Vocab("fail"), "too warm"]))
    data = end.take()
    assert data == b"\0\x08\0\0\0too warm"
    other, client = dialled(SERVED, header(md5sum=ADD, type="rospy_tutorials/AddTwoInts"))
    other.begin(client.expect_reply(other.stream))
    other.feed(data)
    assert other.result.value == [Vocab("fail"), "too warm"]


def test_no_answer_is_a_failure_where_the_type_wants_one() -> None:
    end, server = accept(header(**CALLED), SERVED)
    end.take()
    asked(end, server, bytes(16))
    server.encode_reply(end.stream, Bottle())
    assert b"the service gave no answer" in end.take()
    asked(end, server, bytes(16))
    with pytest.raises(ValueError, match="AddTwoIntsResponse is expected here"):
        server.encode_reply(end.stream, ["no", "numbers"])
    server.encode_ack(end.stream, 1)
    assert end.take() == bytes(5)


def test_the_reason_of_a_failure_has_an_end() -> None:
    other, client = dialled(SERVED, header(md5sum=ADD, type="rospy_tutorials/AddTwoInts"))
    with pytest.raises(RemoteProtocolError, match="bytes is announced"):
        other.begin(client.expect_reply(other.stream))
        other.feed(b"\0" + struct.pack("<I", 1 << 20))


@pytest.mark.parametrize(
    ("fields", "problem"),
    [
        ({**CALLED, "md5sum": "f" * 32}, "both sides need the same definition"),
        ({**CALLED, "service": "/other"}, "the service here is /add_two_ints, not /other"),
        ({"callerid": "/c", "service": "/add_two_ints"}, "needs the field 'md5sum'"),
        ({"md5sum": "*", "service": "/add_two_ints"}, "needs the field 'callerid'"),
    ],
)
def test_clients_that_do_not_fit_are_told(fields: dict[str, str], problem: str) -> None:
    with pytest.raises(RemoteProtocolError, match=problem):
        accept(header(**fields), SERVED)


def test_a_topic_cannot_be_called() -> None:
    with pytest.raises(RemoteProtocolError, match="is a topic"):
        accept(header(**CALLED), Declared("/n", "", "", Int32))


def test_an_unknown_type_is_bytes() -> None:
    """Whoever calls a port without a type, by a type of his own."""
    end, server = accept(header(**CALLED), UNDECLARED)
    end.take()
    assert asked(end, server, b"\1\2").value == [b"\1\2"]
    server.encode_reply(end.stream, [b"\3"])
    assert end.take() == b"\1\1\0\0\0\3"


def test_a_service_is_known_by_what_the_server_says() -> None:
    answer = header(
        md5sum="*", type="strange/Half", message_definition="int16 n\n---\nstring half\n"
    )
    end, client = dialled(Declared("/me", "/s"), answer)
    client.encode(end.stream, Packet([7], key="d"))
    assert end.take() == b"\2\0\0\0\7\0"
    end.begin(client.expect_reply(end.stream))
    end.feed(b"\1\7\0\0\0\3\0\0\x003.5")
    assert end.result.value == "3.5"


def test_what_does_not_fit_the_request_is_the_callers_error() -> None:
    end, client = dialled(SERVED, header(md5sum=ADD, type="rospy_tutorials/AddTwoInts"))
    with pytest.raises(ValueError, match="AddTwoIntsRequest is expected here"):
        client.encode(end.stream, Packet(["a", 1], key="d"))
    assert end.take() == b""


def test_who_may_not_write_is_told() -> None:
    stream = ByteStream()
    carrier = RosSrv(Route("", "/port"), CALLED)
    steps = carrier.welcome(stream, b"")
    assert next(steps) == May("write")
    with pytest.raises(AccessRefused, match="not you"):
        steps.send("not you")
    assert b"error=not you" in b"".join(map(bytes, stream.take_output()))


@pytest.mark.parametrize("text", ["rossrv+service./s", "tcpros+topic./t"])
def test_an_addition_that_it_does_not_know_is_refused(text: str) -> None:
    assert asked_carrier(parse_carrier(f"{text}+package.p+raw.1"))
    with pytest.raises(LocalProtocolError, match=r'knows no "\+bla", but \+(service|topic).NAME'):
        asked_carrier(parse_carrier(f"{text}+bla"))
