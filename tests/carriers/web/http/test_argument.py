"""Arguments of URLs and forms: which count, and what they may add to a message."""

from __future__ import annotations

import pytest

from yarpy.carriers.web.http.argument import number_of, read_fields, substitute
from yarpy.data import codec
from yarpy.errors import DecodeError
from yarpy.limit import HTTP_FIELDS


def test_fields() -> None:
    assert read_fields("a=1&b=&=c&d&e=x%3Dy&a=2&f+g=%C3%BC") == {
        "a": "2",
        "e": "x=y",
        "f g": "\u00fc",
    }
    with pytest.raises(DecodeError):
        read_fields("&" * HTTP_FIELDS)


def test_substitution() -> None:
    assert substitute("$a$b $ $c.", {"a": "1", "b": "$a"}) == "1$a  ."


def test_arguments_in_quotes_stay_one_text() -> None:
    said = 'C:\\new "$b"\n\r\0 \\'
    assert codec.decode_text(substitute('say "$a" "$b" $b', {"a": said, "b": "1 2"})) == [
        "say",
        said,
        "1 2",
        1,
        2,
    ]
    assert substitute('"$a', {"a": '"'}) == '""'
    with pytest.raises(DecodeError, match="expand to more than"):
        substitute('"$a"', {"a": '"' * 600_000})


def test_numbers_have_bounds() -> None:
    assert number_of("rate", {"rate": "2.5"}, 1, 10) == 2.5
    assert number_of("rate", {}, 1, 10) == 0.0
    for text in ("0", "11", "nan", "many", ""):
        with pytest.raises(ValueError, match="rate must be a number from 1 to 10"):
            number_of("rate", {"rate": text}, 1, 10)
