"""Carrier strings, parsed once, and what of them travels."""

from __future__ import annotations

import doctest

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yarpy import route
from yarpy.errors import RemoteProtocolError
from yarpy.log import readable
from yarpy.route import Route, masked, parse_carrier


def test_examples_in_the_docstrings() -> None:
    found = doctest.testmod(route)
    assert found.attempted >= 10
    assert found.failed == 0


@pytest.mark.parametrize(
    ("text", "base", "tokens"),
    [
        ("tcp", "tcp", ()),
        ("", "tcp", ()),
        ("+log.in", "tcp", ("log.in",)),
        ("tcp+a.b", "tcp", ("a.b",)),
        ("tcp+", "tcp", ("",)),
        (
            "tcp+recv.x+tc.2+virtual+(ex (/a -10) (/b +10))+file.my.lua",
            "tcp",
            ("recv.x", "tc.2", "virtual", "(ex (/a -10) (/b +10))", "file.my.lua"),
        ),
        ("tcp+(note a+log.in b)+c", "tcp", ("(note a+log.in b)", "c")),
        # parentheses that do not pair up are ordinary characters
        ("mjpeg+user.a(b+password.x", "mjpeg", ("user.a(b", "password.x")),
        ("tcp+a)b+c.(d+e)+f", "tcp", ("a)b", "c.(d+e)", "f")),
    ],
)
def test_additions_stand_between_plus_signs_outside_parentheses(
    text: str, base: str, tokens: tuple[str, ...]
) -> None:
    spec = parse_carrier(text)
    assert (spec.base, spec.tokens, spec.whole) == (base, tokens, text)


@pytest.mark.parametrize(
    ("carrier", "send", "recv"),
    [
        ("tcp", (), ()),
        ("tcp+recv.a", (), (("a", ()),)),
        ("tcp+send.a+x.1+recv.b+y", (("a", ("x.1",)),), (("b", ("y",)),)),
        ("udp+z+recv.a+recv.b+k.v", (), (("a", ()), ("b", ("k.v",)))),
        ("tcp+send.a+(recv.b c)", (("a", ("(recv.b c)",)),), ()),
    ],
)
def test_monitors_at_either_end(carrier: str, send: object, recv: object) -> None:
    spec = parse_carrier(carrier)
    assert (spec.send, spec.recv) == (send, recv)


def test_values_of_a_carrier() -> None:
    assert parse_carrier("tcp+log.in").log == "in"
    assert parse_carrier("tcp+logger.in").log is None
    assert parse_carrier("tcp+log").log is None
    assert parse_carrier("tcp+log.in+log.out").log == "in"
    assert parse_carrier("tcp+send.x+(note a+log.in b)").log is None
    assert parse_carrier("tcp+a.b.c+d.e").value("a") == "b.c"
    assert parse_carrier("tcp+a.b.c+d.e").value("c") is None


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("mjpeg+password.a.b+path.x", "mjpeg+password.***+path.x"),
        ("mjpeg+password.a b+path.x", "mjpeg+password.***+path.x"),
        ("mjpeg+password.(a+b)+path.x", "mjpeg+password.***+path.x"),
        ("mjpeg+password.a(b+path.x", "mjpeg+password.***+path.x"),
        ("mjpeg+passwords.a", "mjpeg+passwords.a"),
    ],
)
def test_password_is_not_shown(text: str, shown: str) -> None:
    spec = parse_carrier(text)
    assert (spec.text, str(spec), spec.whole) == (shown, shown, text)
    assert repr(spec) == f"CarrierSpec({shown!r})"
    assert Route("/a", "/b", text).carrier == shown
    assert text == shown or text not in f"{Route('/a', '/b', text)!r} {Route('/a', '/b', text)}"


def test_text_is_masked_up_to_the_end_of_the_carrier() -> None:
    assert masked('no "mjpeg+password.a:b://cam" here') == 'no "mjpeg+password.***://cam" here'
    assert masked("nothing to hide") == "nothing to hide"


SPECIFIERS = [
    # source, carrier, what travels, what arrives
    ("/w", "tcp", "/w", "tcp"),
    ("/w", "tcp+log", "/w (log)", "tcp+log"),
    ("/w", "tcp+a.1+b.2", "/w (a 1) (b 2)", "tcp+a.1+b.2"),
    ("/w", "tcp+recv.priority+tc.0.5", "/w (recv priority) (tc 0 5)", "tcp+recv.priority+tc.0"),
    ("/w", "udp+file.my.lua", "/w (file my lua)", "udp+file.my"),
    ("/w", "mjpeg+password.x", "/w (password x)", "mjpeg+password.***"),
    ("", "tcp", "", "tcp"),
]


@pytest.mark.parametrize(("source", "carrier", "text", "arrives"), SPECIFIERS)
def test_specifiers(source: str, carrier: str, text: str, arrives: str) -> None:
    sent = Route(source, "/r", carrier)
    assert sent.specifier == text
    there = Route("", "/r", sent.spec.base)
    there.introduce(text)
    assert (there.source, there.carrier) == (source, arrives)


@pytest.mark.parametrize(
    ("text", "source", "carrier"),
    [
        ("/my port (recv x)", "/my", "text+port+recv.x"),
        ("/w (open", "/w", "text"),
        ("/w () x", "/w", "text+x"),
        ("/w  (a  b)", "/w", "text+a.b"),
    ],
)
def test_odd_specifiers(text: str, source: str, carrier: str) -> None:
    there = Route("", "/r", "text")
    there.introduce(text)
    assert (there.source, there.carrier) == (source, carrier)


@given(st.text(max_size=60))
def test_any_specifier_is_read(text: str) -> None:
    there = Route("", "/r", "tcp")
    try:
        there.introduce(text)
    except RemoteProtocolError:
        assert readable(text) != text
    assert there.spec.base == "tcp"
    assert " " not in there.source


@given(st.text(alphabet="tcp+.()ab ", max_size=40))
def test_any_text_is_a_carrier_and_nothing_of_it_is_lost(text: str) -> None:
    spec = parse_carrier(text)
    assert spec.whole == text
    assert spec.text == text
    assert "+".join((spec.base, *spec.tokens)).endswith(text)
    assert parse_carrier(spec.plus("k.v").whole).value("k") == "v" or "(" in text


def test_route_says_who_talks_to_whom() -> None:
    assert str(Route("/a", "/b", "udp")) == "/a -> /b (udp)"
    assert Route("/a", "/b", "udp") == Route("/a", "/b", parse_carrier("udp"))
    assert Route("/a", "/b", "udp") != Route("/a", "/b", "tcp")
