"""Messages as XML-RPC and back: C++'s letters, Python's codec as the judge of ours, bad XML."""

from __future__ import annotations

import time
import xmlrpc.client
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.label import spelled
from support.steps import measured

from yarpy.data import xmlrpc as ours
from yarpy.data.bottle import Bottle, Property
from yarpy.data.value import Int8, Int16, Int64, Vocab
from yarpy.errors import DecodeError

VALUES = [
    # a value, its XML as C++ writes it, what Python reads
    (1, "<value><i4>1</i4></value>", 1),
    (-(2**31), "<value><i4>-2147483648</i4></value>", -(2**31)),
    (2.5, "<value><double>2.500000</double></value>", 2.5),
    (1e30, f"<value><double>{1e30:f}</double></value>", 1e30),
    ("two words", "<value>two words</value>", "two words"),
    ("<&>'\"", "<value>&lt;&amp;&gt;&apos;&quot;</value>", "<&>'\""),
    ("", "<value></value>", ""),
    (Vocab("send"), "<value>[send]</value>", "[send]"),
    (
        [1, [2, "x"]],
        "<value><array><data><value><i4>1</i4></value><value><array><data><value><i4>2</i4></value>"
        "<value>x</value></data></array></value></data></array></value>",
        [1, [2, "x"]],
    ),
    (["list", "dict", 2], None, ["dict", 2]),
    (["list", ["k", 1], ["l", 2]], None, [["k", 1], ["l", 2]]),
    (
        ["dict", ["a", 1], ["b", "x"]],
        "<value><struct><member><name>a</name><value><i4>1</i4></value></member>"
        "<member><name>b</name><value>x</value></member></struct></value>",
        {"a": 1, "b": "x"},
    ),
    ([["a", 1], ["b", 2]], None, {"a": 1, "b": 2}),
    ([[1, 2], [3, 4]], None, {"1": 2, "3": 4}),
    # what C++ leaves out or spoils
    (2**40, "<value><i8>1099511627776</i8></value>", 2**40),
    (True, "<value><boolean>1</boolean></value>", True),
    (b"\0\xff", "<value><base64>AP8=</base64></value>", b"\0\xff"),
    ([], "<value><array><data></data></array></value>", []),
    (0.123456789, "<value><double>0.123456789</double></value>", 0.123456789),
    (1e-20, "<value><double>1e-20</double></value>", 1e-20),
    ("\0\x1b", "<value>\ufffd\ufffd</value>", "\ufffd\ufffd"),
    ("\udcff", "<value>\ufffd</value>", "\ufffd"),
]


@pytest.mark.parametrize(("value", "text", "python"), VALUES, ids=spelled)
def test_values_are_written(value: Any, text: str | None, python: Any) -> None:
    data = ours.encode_answer(["before", value])
    if text is not None:
        assert text in data.decode()
    (found,), _ = xmlrpc.client.loads(data, use_builtin_types=True)
    assert found == ["before", python]


def test_answers() -> None:
    for value, python in (
        ([], ""),
        ([5], 5),
        (5, 5),
        ("x", "x"),
        ([[1, 2.5, "x"]], [1, 2.5, "x"]),
        ([1, 2], [1, 2]),
        (["dict", ["a", 1]], {"a": 1}),
        ({"a": 1}, {"a": 1}),
        (Property({"a": {"b": 2}}), {"a": {"b": 2}}),
        (np.array([1.5, 2.5]), [1.5, 2.5]),
    ):
        assert xmlrpc.client.loads(ours.encode_answer(value))[0] == (python,)
    assert ours.encode_answer(["foo", 1]) == (
        b'<?xml version="1.0"?>\r\n<methodResponse><params><param>\r\n\t'
        b"<value><array><data><value>foo</value><value><i4>1</i4></value></data></array></value>"
        b"\r\n</param></params></methodResponse>\r\n"
    )
    ros = [1, "", [[]]]
    assert xmlrpc.client.loads(ours.encode_answer(ros, terse=True))[0] == ([1, "", []],)


def test_nothing_and_faults() -> None:
    assert ours.decode_answer(ours.encode_nothing()) is None
    with pytest.raises(xmlrpc.client.Fault, match="wrong <here>"):
        xmlrpc.client.loads(ours.encode_fault(7, "wrong <here>"))
    assert ours.decode_answer(ours.encode_fault(7, "x y")) == [
        "dict",
        ["faultCode", 7],
        ["faultString", "x y"],
    ]


CALLS = [
    (["one"], "one", ()),
    (["one", 1, "x"], "one", (1, "x")),
    ([Vocab("help")], "help", ()),
    (["one", [1, 2]], "one", (1, 2)),
    (["one", [[1, 2]]], "one", ({"1": 2},)),
    (["one", ["a", 1], ["b", 2]], "one", ({"a": 1, "b": 2},)),
    (["one", 1, ["a", "b"]], "one", (1, ["a", "b"])),
    (["one", ["dict", ["a", 1]]], "one", ({"a": 1},)),
    (["a<b>"], "a<b>", ()),
    ("one", "one", ()),
]


@pytest.mark.parametrize(("message", "name", "arguments"), CALLS, ids=spelled)
def test_calls_are_written(message: Any, name: str, arguments: tuple[Any, ...]) -> None:
    assert xmlrpc.client.loads(ours.encode_call(message)) == (arguments, name)


READ = [
    # arguments of Python, the message
    ((1, 2.5, "x y"), [1, 2.5, "x y"]),
    (("[send]", "[a b"), [Vocab("send"), "[a b"]),
    (({"b": "x", "a": 1},), [["dict", ["a", 1], ["b", "x"]]]),
    (([1, [2]],), [[1, [2]]]),
    ((["list", 1],), [["list", "list", 1]]),
    ((["dict", 1],), [["list", "dict", 1]]),
    (("list", "dict"), ["list", "dict"]),
    (([[1, 2], [3, 4]],), [[[1, 2], [3, 4]]]),
    ((True, False), [True, False]),
    ((b"\0\1",), [b"\0\1"]),
    ((xmlrpc.client.DateTime("20260102T03:04:05"),), ["2026-01-02T03:04:05"]),
    (([1, None, 2], {"k": None}), [[1, 2], ["dict", ["k"]]]),
    (([],), [[]]),
]


@pytest.mark.parametrize(("arguments", "message"), READ, ids=spelled)
def test_calls_are_read(arguments: tuple[Any, ...], message: list[Any]) -> None:
    text = xmlrpc.client.dumps(arguments, "go", allow_none=True)
    found = ours.decode_call(text.encode())
    assert found == ["go", *message]
    assert Bottle.from_bytes(found.to_bytes()) == found


def test_long_integers_are_read() -> None:
    assert ours.decode_call(call(b"<i8>1099511627776</i8>")) == ["m", 2**40]


def test_method_names_are_text() -> None:
    def name(text: str) -> Bottle:
        return ours.decode_call(xmlrpc.client.dumps((), text).encode())

    assert name("[set]") == [Vocab("set")]
    assert name("get encs") == ["get", "encs"]
    assert name("system.listMethods") == ["system.listMethods"]


def test_answers_are_read() -> None:
    def read(value: Any) -> Bottle | None:
        text = xmlrpc.client.dumps((value,), methodresponse=True, allow_none=True)
        return ours.decode_answer(text.encode())

    assert read("hello world") == ["hello world"]
    assert read("42") == ["42"]
    assert read([1, [2, "x"]]) == [1, [2, "x"]]
    assert read({"a": 1}) == ["dict", ["a", 1]]
    assert read([]) == []


# ------------------------------------------------------------------------------------------ bad XML

BOMB = (
    b'<?xml version="1.0"?><!DOCTYPE lolz [<!ENTITY a "aaaaaaaaaa">'
    + b"".join(b'<!ENTITY a%d "%s">' % (n, b"&a;" * 10) for n in range(9))
    + b"]><methodCall><methodName>&a8;</methodName></methodCall>"
)
OUTSIDE = (
    b'<!DOCTYPE x [<!ENTITY f SYSTEM "file:///etc/passwd">]>'
    b"<methodCall><methodName>&f;</methodName></methodCall>"
)


def call(value: bytes) -> bytes:
    return (
        b"<methodCall><methodName>m</methodName><params><param><value>%s</value></param></params>"
        b"</methodCall>" % value
    )


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"<nonsense>",
        b"<nonsense/>",
        b"not xml",
        b"\xff\xfe",
        BOMB,
        OUTSIDE,
        b"<!DOCTYPE x><methodCall><methodName>m</methodName></methodCall>",
        b"<methodResponse><params></params></methodResponse>",
        call(b"<i4>one</i4>"),
        call(b"<i4>" + b"9" * 5000 + b"</i4>"),
        call(b"<i8>9223372036854775808</i8>"),
        call(b"<double>x</double>"),
        call(b"<boolean>7</boolean>"),
        call(b"<base64>abcde</base64>"),
        call(b"<dateTime.iso8601>soon</dateTime.iso8601>"),
        call(b"<struct><member><value>x</value></member></struct>"),
        call(b"</value>"),
        call(b"<array><data><value>" * 3000 + b"</value></data></array>" * 3000),
    ],
)
def test_bad_calls(data: bytes) -> None:
    with measured() as peak, pytest.raises(DecodeError):
        ours.decode_call(data)
    assert peak.bytes < 20_000_000


def test_too_deep_to_be_written() -> None:
    value: Any = []
    for _ in range(200):
        value = [value]
    with pytest.raises(DecodeError, match="deep"):
        ours.encode_answer([1, value])


@given(st.binary(max_size=200))
def test_whatever_comes(data: bytes) -> None:
    for text in (data, call(data), b"<methodResponse>" + data + b"</methodResponse>"):
        for decode in (ours.decode_call, ours.decode_answer):
            try:
                decode(text)
            except DecodeError:
                pass


scalars = st.one_of(
    st.integers(-(2**63), 2**63 - 1),
    st.floats(allow_nan=False, allow_infinity=False),
    st.text(st.characters(codec="utf-8", exclude_characters="\r", min_codepoint=32)).filter(
        lambda text: not text.startswith("[")
    ),
    st.booleans(),
    st.binary(),
)


@given(st.lists(scalars, max_size=5))
def test_scalars_come_back(values: list[Any]) -> None:
    answer = ours.decode_answer(ours.encode_answer(["x", "y", *values]))
    clean = [v.replace("\ufffe", "\ufffd").replace("\uffff", "\ufffd") if isinstance(v, str) else v
              for v in values]  # fmt: skip
    assert answer == ["x", "y", *clean]


def test_numbers_of_every_width_are_written_at_once() -> None:
    """`Int8(1) in range(...)` would walk through all the range: a minute for each."""
    start = time.thread_time()
    text = ours.encode_call(["say", Int8(-1), Int16(2), Int64(3), Int64(1 << 40)])
    assert time.thread_time() - start < 5
    for part in (b"<i4>-1</i4>", b"<i4>2</i4>", b"<i4>3</i4>", b"<i8>1099511627776</i8>"):
        assert part in text
