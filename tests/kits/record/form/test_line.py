"""Lines of a log as Foxglove shows them."""

import pytest
from support.recordings import payload_of

from yarpy.kits.record.form.form import restored
from yarpy.kits.record.form.line import line
from yarpy.kits.record.form.protobuf import fields_of

TEXT = '(level WARNING) (systemtime 12.5) (component yarp.dev) (message "a joint is hot")'


def test_a_line() -> None:
    payload = payload_of(["[/log/lab/demo/7]", TEXT])
    found = line(payload, 5, "/log/lab/demo/7")
    assert found is not None
    data = memoryview(b"".join(found.parts(None)))
    assert restored("protobuf", data, False) == ((payload,), "")
    fields = fields_of(data)
    assert (bytes(fields[3]), bytes(fields[4])) == (b"a joint is hot", b"yarp.dev")
    assert data[: 2 + len(fields[1]) + 2].tobytes().endswith(b"\x10\x03")  # a warning
    assert bytes(fields[1]) == b"\x08\x0c\x10\x80\xca\xb5\xee\x01"  # 12.5 s


def test_where_it_was_said() -> None:
    text = '(level INFO) (filename "a.cpp") (line 12) (message hello)'
    found = line(payload_of(["[/log/x/y/1]", text]), 5, "/log")
    assert found is not None
    assert b"\x2a\x05a.cpp\x35\x0c\0\0\0" in found.front
    assert b"[/log" not in found.front and b"/log/x/y/1" in found.front


@pytest.mark.parametrize(
    "value", [["a", "b"], ["[/x]", "no level"], ["[/x]"], ["[/x]", 1], "word", [1, 2]]
)
def test_what_is_none(value: object) -> None:
    assert line(payload_of(value), 5, "/a") is None
