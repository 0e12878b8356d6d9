"""What sides of ROS connections say and make of it; the dialogues are in test_tcpros.py and
test_rossrv.py."""

from typing import Any

import pytest
from support.ros_link import ADD, STRING, AddTwoInts, String

from yarpy.errors import DecodeError, RemoteProtocolError, YarpError
from yarpy.limit import ROS_PEER_FIELDS
from yarpy.peers.ros import greeting as ros_greeting
from yarpy.peers.ros.greeting import answer_header, message_kind, mismatch, own_header, service_kind
from yarpy.peers.ros.header import encode_header, parse_header
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
    }


@pytest.mark.parametrize("asked", [{}, {"type": "*"}, {"type": "std_msgs/String"}], ids=str)
def test_a_port_without_a_type_names_none_that_it_was_not_told(asked: dict[str, str]) -> None:
    """A C++ program looks up whatever type is named to it, and exits where it cannot find `*`."""
    answer = answer_header(Route("", "/talk", declared=Declared("/talk")), asked, None)
    assert answer == {"callerid": "/talk", **asked}


def test_a_client_of_roscpp_gets_the_type_that_it_needs() -> None:
    route = Route("", "/add", declared=Declared("/add"))
    asked = {"service": "/add", "md5sum": ADD, "callerid": "/cpp", "persistent": "0"}
    assert answer_header(route, asked, None) == {**asked, "callerid": "/add", "type": "*"}


def test_the_type_that_is_declared_is_named() -> None:
    route = Route("", "/t", declared=Declared("/n", type="std_msgs/String"))
    assert answer_header(route, {"type": "*"}, None)["type"] == "std_msgs/String"


def test_a_stranger_describes_only_so_much() -> None:
    """Each field costs far more than its text, once a value is read."""
    text = "".join(f"int8[] a{n}\n" for n in range(ROS_PEER_FIELDS))
    kind = message_kind({"type": "p/M", "message_definition": text})
    assert kind is not None and len(kind._names) == ROS_PEER_FIELDS
    fields = {"type": "p/M", "message_definition": f"{text}int8 one_more\n"}
    with pytest.raises(DecodeError, match="p/M: more than 400 fields, with those of the messages"):
        message_kind(fields)
    inner = f"M m\nint8 x\n{'=' * 80}\nMSG: p/M\n{text}"
    with pytest.raises(DecodeError, match="p/N: more than 400 fields"):
        message_kind({"type": "p/N", "message_definition": inner})
    with pytest.raises(DecodeError, match="p/SRequest: more than 400"):
        service_kind({"type": "p/S", "message_definition": f"{text}int8 one_more\n---\n"})


def test_definitions_of_old_packages_whose_comments_are_latin_1() -> None:
    raw = "# Größe\nint32 a # \xb0C\nstring S=\xb0\n---\nbool ok # f\xfcr\n".encode("latin-1")
    text = raw.decode("utf-8", "surrogateescape")
    kind = message_kind({"type": "old/T", "message_definition": text.partition("---")[0]})
    assert kind is not None and "\xb0C" in (kind.__doc__ or "")
    assert kind.from_ros(b"".join(kind(a=3).to_ros())).a == 3
    assert service_kind({"type": "old/S", "message_definition": text}) is not None
    fields = own_header(Route("/t", "/p", declared=Declared("/n", "/t", "", kind)), "topic", kind)
    assert (
        parse_header(encode_header(fields)[4:])["message_definition"].encode(
            "utf-8", "surrogateescape"
        )
        == raw.partition(b"---")[0]
    )


@pytest.mark.parametrize("name", ["p\udcff/T", "p/T\udcff", "\udcff"], ids=ascii)
def test_names_of_types_that_are_not_utf_8(name: str) -> None:
    for kind in (message_kind, service_kind):
        with pytest.raises(YarpError):
            kind({"type": name, "message_definition": "int32 a\n---\n"})
