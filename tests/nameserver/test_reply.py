"""Replies in both styles and for every kind of connection."""

import pytest

from yarpy.contact import Contact
from yarpy.data.bottle import Bottle
from yarpy.names.registration_line import END
from yarpy.nameserver.reply import (
    Reply,
    broken,
    every,
    fail,
    found,
    ok,
    old,
    port_bottle,
    properties,
    unquoted,
    value_of,
)

X = Contact("tcp", "/x", "h", 21102)
LINE = "registration name /x ip h port 21102 type tcp"
NESTED = '(name "/x") (ip h) (port_number 21102) (carrier tcp)'


def test_old_style_on_every_connection() -> None:
    reply = found(X, nested=False)
    assert reply == Reply((LINE, END))
    assert reply.text_lines() == (LINE, END)
    assert reply.to_bytes() == f"{LINE}\r\n{END}\r\n".encode()
    assert reply.message() == [f"{LINE}\r\n{END}\r\n"], "one string, for binary readers"
    assert reply.first() == Bottle.from_text(LINE), "what JSON is made of"
    assert old(()).first() == ["***", "end", "of", "message"]


def test_bottle_style_on_every_connection() -> None:
    reply = found(X, nested=True)
    assert reply.lines == ()
    assert reply.text_lines() == (f"port {NESTED}",)
    assert reply.to_bytes() == f"port {NESTED}\r\n".encode()
    assert reply.message() is reply.first() is reply.bottle
    assert ok().to_bytes() == b"[ok]\r\n"
    assert fail().to_bytes() == b"[fail]\r\n"
    assert fail("too many").to_bytes() == b'[fail] "too many"\r\n'


def test_ports() -> None:
    assert found(None, nested=False).lines == (END,)
    assert found(None, nested=True).text_lines() == ('port (error -2 "port not known")',)
    assert every([X, X], nested=False).lines == (LINE, LINE, END)
    assert every([X], nested=True).text_lines() == (f"ports (port {NESTED})",)
    assert every([], nested=True).text_lines() == ("ports",)
    assert broken(port_bottle(X)) == ["port", "name /x", "ip h", "port_number 21102", "carrier tcp"]


def test_properties() -> None:
    assert properties("/x", "k", ["1 2", "a"], nested=False).lines[0] == (
        "port /x property k = 1 2 a"
    )
    assert properties("/x", "", [], nested=False).lines == ("port /x property  =", END)
    assert properties("/x", "k", None, nested=False).lines == (END,)
    assert properties("/x", "k", None, nested=True).text_lines() == ("",)
    assert properties("/x", "k", ["", "1 2", "12"], nested=True).bottle == ["1 2", 12]


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("12", 12),
        ("2.5", 2.5),
        ("true", True),
        ("[voc]", "voc"),
        ("(1 2)", [1, 2]),
        ("1 2", "1 2"),
        ("word", "word"),
        ("a\\b", "a\\b"),
        ('x"y', 'x"y'),
        ("", ""),
        ("(" * 500 + ")" * 500, "(" * 500 + ")" * 500),
    ],
)
def test_stored_text_as_a_value(text: str, value: object) -> None:
    assert value_of(text) == value


def test_quotes_are_taken_out() -> None:
    assert unquoted(["a b", 'say "hi"', 3]) == "a b say \\hi\\ 3"


def test_bytes_that_are_no_text_survive() -> None:
    raw = b"/caf\xe9".decode("utf-8", "surrogateescape")
    assert (
        found(Contact("tcp", raw, "h", 1), nested=False)
        .to_bytes()
        .startswith(b"registration name /caf\xe9 ip")
    )
