"""The text of .msg and .srv files: declarations, comments, oddities, and what is refused."""

import pytest

from yarpy.errors import DecodeError
from yarpy.peers.ros.message.parse import parse_message, parse_service, peer_type_name, type_name


def fields(text: str) -> list[tuple[str, str, bool, int | None]]:
    parsed = parse_message(text, "pkg/Type")
    return [(item.name, item.base, item.is_list, item.length) for item in parsed.fields]


def test_fields() -> None:
    text = (
        "int32 a\n\n  float64[]   b # many\nOther[3] c\nother_pkg/Thing d\nstring\te\nuint8[16] f"
    )
    assert fields(text) == [
        ("a", "int32", False, None),
        ("b", "float64", True, None),
        ("c", "pkg/Other", True, 3),
        ("d", "other_pkg/Thing", False, None),
        ("e", "string", False, None),
        ("f", "uint8", True, 16),
    ]


def test_header_is_that_of_std_msgs() -> None:
    names = [item[1] for item in fields("Header header\nstd_msgs/Header other\nHeader[] more")]
    assert names == ["std_msgs/Header", "std_msgs/Header", "pkg/Header"]  # as genmsg has it


def test_byte_and_char_keep_their_spelling() -> None:
    parsed = parse_message("byte a\nchar[4] b", "pkg/Type")
    assert [item.spelled for item in parsed.fields] == ["byte", "char[4]"]
    assert [item.builtin for item in parsed.fields] == ["int8", "uint8"]


def test_constants() -> None:
    text = (
        "int32 A=-3 # three\nuint8 B = 255\nfloat32 C= 1.5e3\nbool D=True\nbool E=0\n"
        "string F =  a 'b' # c = d \nchar G=65\nbyte H=-128\nstring EMPTY=\nint32 a_field"
    )
    parsed = parse_message(text, "pkg/Type")
    assert [(item.name, item.value) for item in parsed.constants] == [
        ("A", -3),
        ("B", 255),
        ("C", 1500.0),
        ("D", True),
        ("E", False),
        ("F", "a 'b' # c = d"),
        ("G", 65),
        ("H", -128),
        ("EMPTY", ""),
    ]
    assert parsed.constants[0].doc == "three"
    assert [item.name for item in parsed.fields] == ["a_field"]


def test_comments_become_documentation() -> None:
    text = (
        "# A pose.\n#\n# In a frame.\n\n# Where it is,\n# in metres\nPoint position\n\n# lost\n\n"
        "float64 w # real part\n# at the end\n"
    )
    parsed = parse_message(text, "pkg/Pose")
    assert parsed.doc == "A pose.\n\nIn a frame.\n\nWhere it is,\nin metres"
    assert [item.doc for item in parsed.fields] == ["", "real part"]
    assert parse_message("int8 a\n# of b\nint8 b # too", "p/T").fields[1].doc == "of b\ntoo"


def test_comments_behind_declarations_go_on_below_themselves() -> None:
    """As those of actionlib_msgs/GoalStatus."""
    text = (
        "int8 ONE=1 # the first\n           #   of them\nint8 TWO=2 # the second\n\n"
        "   # above\nint8 a\nstring S=x # y\n  # not of S\nint8 b # last\n  # of all\n# free\n"
    )
    parsed = parse_message(text, "p/T")
    assert [each.doc for each in parsed.constants] == ["the first\nof them", "the second", ""]
    assert [each.doc for each in parsed.fields] == ["above", "not of S\nlast\nof all"]


def test_banners_of_rosmsg_show_are_skipped() -> None:
    assert fields("[pkg/Type]:\nint32 a") == [("a", "int32", False, None)]


def test_services() -> None:
    request, response = parse_service("int64 a\nint64 b\n---\nint64 sum\n", "pkg/Add")
    assert (request.name, response.name) == ("pkg/AddRequest", "pkg/AddResponse")
    assert [item.name for item in request.fields] == ["a", "b"]
    assert [item.name for item in response.fields] == ["sum"]
    request, response = parse_service("---", "pkg/Nothing")
    assert (request.fields, response.fields) == ((), ())


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("int32", "line 1: a type and a name"),
        ("int32 a b", "a type and a name"),
        ("\nint32 1a", "line 2: '1a' is no name"),
        ("int32 _a", "is no name of a field"),
        ("int32 ä", "is no name"),
        ("int32[ a", "is no type"),
        ("int32[2][3] a", "is no type"),
        ("int32[-1] a", "is no type"),
        ("int32[99999999999] a", "is no type"),
        ("a/b/c d", "is no type"),
        ("../etc/passwd d", "is no type"),
        ("int8 A=128", "'128' is no value of a int8"),
        ("uint8 A=-1", "is no value"),
        ("int32 A=1.5", "is no value"),
        ("bool A=maybe", "is no value"),
        ("bool A=" + "(" * 300, "is no value"),
        ("float32 A=", "is no value"),
        ("int32 A=" + "9" * 5000, "is no value"),
        ("time A=3", "a constant is a number"),
        ("int32[] A=3", "a constant is a number"),
        ("int32 =3", "is no name of a constant"),
        ("int32 a\nfloat32 a", "two declarations of 'a'"),
        ("int32 A=1\nfloat32 A", "two declarations of 'A'"),
        ("#" * (1 << 21), "more than"),
    ],
)
def test_what_is_wrong_is_told(text: str, said: str) -> None:
    with pytest.raises(DecodeError) as caught:
        parse_message(text, "pkg/Type")
    assert said in str(caught.value)
    assert str(caught.value).startswith("pkg/Type")


def test_lines_of_responses_count_from_the_top() -> None:
    with pytest.raises(DecodeError, match="pkg/AddResponse, line 4"):
        parse_service("int64 a\nint64 b\n---\nint64", "pkg/Add")


def test_names_of_types() -> None:
    assert type_name("std_msgs/String") == "std_msgs/String"
    assert type_name("std_msgs/msg/String") == "std_msgs/String"
    assert type_name("std_srvs/srv/Empty") == "std_srvs/Empty"
    assert type_name("Header") == "std_msgs/Header"
    for wrong in ("String", "", "/", "a//b", "../a/b", "a/b/c", "a/b\n", "a/b.msg", "1a/b"):
        with pytest.raises(DecodeError, match="is no type of ROS"):
            type_name(wrong)


def test_names_of_types_of_peers() -> None:
    assert peer_type_name("AddTwoInts") == "AddTwoInts"
    assert peer_type_name("std_msgs/msg/String") == "std_msgs/String"
    with pytest.raises(DecodeError):
        peer_type_name("../a")


@pytest.mark.parametrize("text", ["{[]:1}", "{[],{}}", "{[]:[]}", "{{}}", "(" * 300, "1+x", "f()"])
def test_values_that_are_none(text: str) -> None:
    with pytest.raises(DecodeError, match="is no value of a bool"):
        parse_message(f"bool A={text}", "p/T")


def test_comments_that_are_not_utf_8() -> None:
    """Old packages have comments in Latin-1; their bytes come as surrogates. What travels keeps
    its bytes: the checksum is that of the text as it is."""
    raw = "# Größe\nint32 a # \xb0C\nstring S=\xb0".encode("latin-1")
    text = raw.decode("utf-8", "surrogateescape")
    found = parse_message(text, "p/T")
    assert (found.doc, found.fields[0].doc) == ("Größe", "\xb0C")
    assert found.text.encode("utf-8", "surrogateescape") == raw
    assert found.constants[0].value.encode("utf-8", "surrogateescape") == b"\xb0"
    assert parse_message("# Größe\nint32 a", "p/T").doc == "Größe"
