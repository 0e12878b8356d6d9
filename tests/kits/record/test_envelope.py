"""Envelopes come back to the letter."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

import yarpy
from yarpy.errors import DecodeError
from yarpy.kits.record.envelope import LENGTH, envelope_of, fields_of, stamp_text

NOW = 1_795_000_000_000_000_000


def kept(envelope: str) -> tuple[str, str]:
    """What a recording makes of an envelope: its form, and the text that is played."""
    form, sequence, sent = fields_of(envelope, NOW, 5)
    text = envelope.encode("utf-8", "surrogateescape")
    data = LENGTH.pack(len(text)) + text + b"payload" if form == "text" else b"payload"
    again, payload = envelope_of(form, sequence, sent, memoryview(data))
    assert payload == b"payload"
    return form, again


@pytest.mark.parametrize(
    ("envelope", "form", "sequence", "sent"),
    [
        ("", "none", 5, NOW),
        ("7 1234.5", "stamp", 7, 1234_500_000_000),
        ("7 1234", "stamp", 7, 1234_000_000_000),
        ("0 0.000000001", "stamp", 0, 1),
        ("7 1234.50", "text", 7, 1234_500_000_000),
        ("07 1", "text", 7, 1_000_000_000),
        ("7 1e-05", "text", 7, 10_000),
        ("7 1.5 frame", "text", 7, 1_500_000_000),
        ("-1 0", "text", 5, NOW),
        ("7 nan", "text", 5, NOW),
        ("7 inf", "text", 5, NOW),
        ("7 -1", "text", 5, NOW),
        ("7 99999999999", "text", 5, NOW),
        ("hello", "text", 5, NOW),
    ],
)
def test_forms(envelope: str, form: str, sequence: int, sent: int) -> None:
    assert fields_of(envelope, NOW, 5) == (form, sequence, sent)
    assert kept(envelope) == (form, envelope)


@given(st.integers(0, 2**31 - 1), st.floats(0, 1.8e10))
def test_every_stamp_comes_back(count: int, time: float) -> None:
    text = yarpy.Stamp(count, time).to_text()
    assert kept(text)[1] == text


@given(st.text(st.characters(codec="utf-8"), max_size=30))
def test_every_text_comes_back(text: str) -> None:
    assert kept(text)[1] == text


def test_stamps_as_they_are_written() -> None:
    assert stamp_text(3, 10_000_000_000) == "3 10"
    assert stamp_text(3, 10_010_000_000) == "3 10.01"


@pytest.mark.parametrize("data", [b"", b"\1\0\0", b"\5\0\0\0four"])
def test_an_envelope_that_is_cut_off(data: bytes) -> None:
    with pytest.raises(DecodeError, match="envelope"):
        envelope_of("text", 0, 0, memoryview(data))
