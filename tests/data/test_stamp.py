import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.vectors import rows

from yarpy.data.bottle import Bottle
from yarpy.data.stamp import Stamp
from yarpy.errors import DecodeError, Truncated


def test_golden():
    (row,) = (row for row in rows("types") if row["type"] == "stamp")
    stamp = Stamp(**row["params"])
    message = bytes.fromhex(row["binary"])
    assert stamp.to_bytes() == message and stamp.to_wire() == (message,)
    assert Stamp.from_bytes(message) == stamp == Stamp.from_wire(memoryview(message))
    assert stamp.to_text().encode() + b"\r\n" == bytes.fromhex(row["text_hex"])
    for size in range(len(message)):
        with pytest.raises(Truncated) as caught:
            Stamp.from_bytes(message[:size])
        assert caught.value.need == 28


@pytest.mark.parametrize(
    ("text", "stamp"),
    [
        ("7 1234.5", Stamp(7, 1234.5)),
        (b"7 1700000000.12346\r\n", Stamp(7, 1700000000.12346)),
        ("-1 0", Stamp()),
        ("3 1e-05", Stamp(3, 1e-05)),
        ("3 5 frame", Stamp(3, 5.0)),
        ("  3\t-.5", Stamp(3, -0.5)),
        ("2147483647 1", Stamp(2147483647, 1.0)),
        ("-2147483648 1", Stamp(-2147483648, 1.0)),
        ("3 inf", Stamp(3, float("inf"))),
    ],
)
def test_text(text, stamp):
    assert Stamp.from_text(text) == stamp == Stamp.parse(text)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "7",
        "a 1",
        "7 x",
        "1.5 2",
        "2147483648 1",
        "9" * 5000 + " 1",
        b"\xff\xfe 1",
        "1 _1",
    ],
)
def test_no_stamp(text):
    with pytest.raises(DecodeError):
        Stamp.from_text(text)


def test_fifteen_digits():
    assert Stamp(7, 1700000000.123456789).to_text() == "7 1700000000.12346"
    assert Stamp(0, 0.1).to_text() == "0 0.1"


def test_header_with_frame_is_read():
    message = Bottle([7, 1234.5, "frame"]).to_bytes()
    assert Stamp.from_bytes(message) == Stamp(7, 1234.5)


@pytest.mark.parametrize("items", [[7, 8], [7.0, 1.0], ["a", 1.0, 2, 3], [1, 2.0, 3, 4]])
def test_other_messages(items):
    with pytest.raises(DecodeError):
        Stamp.from_bytes(Bottle(items).to_bytes() + bytes(28))


def test_next_counts_and_wraps():
    assert Stamp().next(5.0) == Stamp(0, 5.0)
    assert Stamp(7, 1.0).next(2.0) == Stamp(8, 2.0)
    assert Stamp(2147483647, 1.0).next(2.0) == Stamp(0, 2.0)
    assert Stamp(-9, 1.0).next(2.0) == Stamp(0, 2.0)
    assert not Stamp().valid and Stamp(0, 0.0).valid


@given(st.integers(-(2**31), 2**31 - 1), st.floats(-1e300, 1e300))
def test_round_trip(count, time):
    stamp = Stamp(count, time)
    assert Stamp.from_bytes(stamp.to_bytes()) == stamp
    again = Stamp.from_text(stamp.to_text())
    assert again.count == count and again.to_text() == stamp.to_text()


@given(st.text(max_size=20) | st.binary(max_size=20))
def test_any_text(text):
    try:
        Stamp.from_text(text)
    except DecodeError:
        pass


@pytest.mark.parametrize("count", [2**31, -(2**31) - 1, 2**40])
def test_what_no_reader_takes_is_not_spelled(count):
    """A message would arrive without its stamp, and nobody would say so."""
    for spell in (Stamp(count, 1.0).to_text, Stamp(count, 1.0).to_bytes):
        with pytest.raises(OverflowError, match=r"32 bits.*Stamp\.next"):
            spell()


def test_the_largest_counts_are_spelled():
    for count in (2**31 - 1, -(2**31)):
        stamp = Stamp(count, 1.0)
        assert Stamp.from_text(stamp.to_text()) == stamp == Stamp.from_bytes(stamp.to_bytes())
