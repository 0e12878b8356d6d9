"""Forms: what is read is what was written, whatever a stranger makes of it."""

import pytest

from yarpy.errors import DecodeError
from yarpy.kits.record.form.form import CDR_HEAD, Converted, Form, restored

PROTO = Form("protobuf 6", "protobuf", "X", "protobuf", b"")
CDR = Form("cdr body", "cdr", "X", "ros2msg", b"")
DOUBLES = bytes(range(16))
FRONT = b"\x10\x05" + b"\x32\x10"  # a number, and the head of field 6
ROWS = [
    (Converted(PROTO, FRONT, DOUBLES, b"head"), "protobuf 6", b"head" + DOUBLES),
    (Converted(PROTO, b"", b"", b"whole"), "protobuf", b"whole"),
    (Converted(CDR, CDR_HEAD.pack(0, 1, 0, 0, 0, 2), DOUBLES, b"h"), "cdr body", b"h" + DOUBLES),
    (Converted(CDR, CDR_HEAD.pack(0, 1, 0, 0, 0, 2) + DOUBLES, b"", b"h"), "cdr", b"h"),
]


@pytest.mark.parametrize("envelope", [None, b"", b"free text"])
@pytest.mark.parametrize(("converted", "name", "payload"), ROWS)
def test_there_and_back(converted: Converted, name: str, payload: bytes, envelope: bytes) -> None:
    data = b"".join(converted.parts(envelope))
    parts, text = restored(name, memoryview(data), envelope is not None)
    assert b"".join(parts) == payload
    assert text == (envelope or b"").decode()


@pytest.mark.parametrize(("converted", "name", "payload"), ROWS)
def test_what_is_cut_off(converted: Converted, name: str, payload: bytes) -> None:
    data = memoryview(b"".join(converted.parts(b"text")))
    for end in range(len(data)):
        try:
            parts, _ = restored(name, data[:end], True)
        except DecodeError:
            continue
        assert len(b"".join(parts)) <= len(payload) + len(b"text")


@pytest.mark.parametrize("name", ["", "json", "protobuf x", "protobuf 99999"])
def test_unknown_forms(name: str) -> None:
    with pytest.raises(DecodeError):
        restored(name, memoryview(b"\xc2\x3e\0"), False)


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("protobuf", b"\x10\x05"),  # no bytes of YARP
        ("protobuf", b"\x0b"),  # an unknown kind of field
        ("protobuf", b"\xff" * 11),
        ("protobuf", b"\x32\x7f"),
        ("cdr", CDR_HEAD.pack(0, 1, 0, 0, 0, 0xFFFFFFFF)),
    ],
)
def test_lies(name: str, data: bytes) -> None:
    with pytest.raises(DecodeError):
        restored(name, memoryview(data), False)


def test_an_envelope_that_is_longer_than_its_message() -> None:
    data = b"".join(Converted(PROTO, b"", b"", b"abc").parts(b""))[:-4] + b"\xff\0\0\0"
    with pytest.raises(DecodeError, match="longer than its message"):
        restored("protobuf", memoryview(data), True)
