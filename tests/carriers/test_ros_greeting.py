"""What sides of ROS connections say and make of it; the dialogues are in test_tcpros.py and
test_rossrv.py."""

from typing import Any

import pytest
from support.ros_link import ADD, STRING, AddTwoInts, String

from yarpy.carriers import ros_greeting
from yarpy.carriers.ros_greeting import (
    MAX_FIELDS,
    answer_header,
    message_kind,
    mismatch,
    own_header,
    service_kind,
)
from yarpy.errors import DecodeError, RemoteProtocolError
from yarpy.route import Declared, Route


@pytest.mark.parametrize(
    ("kind", "md5sum", "name"), [(String, STRING, "std_msgs/String"), (AddTwoInts, ADD, "")]
)
def test_a_type_is_told_with_its_checksum_and_text(kind: Any, md5sum: str, name: str) -> None:
    declared = Declared("/n", "/t", "", kind)
    fields = own_header(Route("/t-@/n", "/p", declared=declared), "topic", kind)
    assert (fields["md5sum"], fields["type"]) == (md5sum, name or AddTwoInts.name)
    assert fields["message_definition"] == ros_greeting.full_text(kind)
    assert ros_greeting.is_service(kind) is (kind is AddTwoInts)


@pytest.mark.parametrize(
    ("port", "node"), [("/t+@/n", "/n"), ("/w", "/w"), ("/t@/a~std_msgs/String", "/a~std_msgs/S")]
)
def test_the_name_of_the_node(port: str, node: str) -> None:
    assert ros_greeting.own_name(Route(port, "/p"), port).startswith(node)


def test_checksums_are_compared_where_both_sides_have_one() -> None:
    assert mismatch({"md5sum": "*"}, String) == ""
    assert mismatch({"md5sum": "f" * 32}, None) == ""
    assert mismatch({}, String) == ""
    assert "another version of it" in mismatch(
        {"md5sum": "f" * 32, "type": "std_msgs/String"}, String
    )
    assert "not std_msgs/String" in mismatch({"md5sum": "f" * 32, "type": "a/B"}, String)


def test_a_checksum_that_is_not_that_of_its_text_is_refused() -> None:
    fields = {"type": "a/B", "message_definition": "int32 n\n", "md5sum": STRING}
    with pytest.raises(RemoteProtocolError, match="the peer has a/B with the md5sum 992"):
        message_kind(fields)
    assert message_kind({**fields, "md5sum": "*"}) is not None
    assert message_kind({"type": "*", "md5sum": "*"}) is None


def test_an_answer_repeats_what_was_asked() -> None:
    route = Route("", "/t+@/n", declared=Declared("/n"))
    fields = {"callerid": "/them", "md5sum": "*", "x": "1", "probe": "1", "error": "no"}
    assert answer_header(route, fields, None) == {
        "callerid": "/n",
        "md5sum": "*",
        "x": "1",
        "type": "*",
    }


def test_a_stranger_describes_only_so_much() -> None:
    """Each field costs far more than its text, once a value is read."""
    text = "".join(f"int8[] a{n}\n" for n in range(MAX_FIELDS))
    kind = message_kind({"type": "p/M", "message_definition": text})
    assert kind is not None and len(kind._names) == MAX_FIELDS
    fields = {"type": "p/M", "message_definition": f"{text}int8 one_more\n"}
    with pytest.raises(DecodeError, match="p/M: more than 400 fields, with those of the messages"):
        message_kind(fields)
    inner = f"M m\nint8 x\n{'=' * 80}\nMSG: p/M\n{text}"
    with pytest.raises(DecodeError, match="p/N: more than 400 fields"):
        message_kind({"type": "p/N", "message_definition": inner})
    with pytest.raises(DecodeError, match="p/SRequest: more than 400"):
        service_kind({"type": "p/S", "message_definition": f"{text}int8 one_more\n---\n"})
