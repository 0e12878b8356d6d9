"""The grammars that read text of strangers, with what makes each of them work hardest.

Rules: `GRAMMARS` names a function of bytes and the shapes that are bad for it: a beginning, a piece
that is repeated, an end. Whoever adds a parser adds a line here.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from yarpy.carriers.web.http.argument import read_fields
from yarpy.carriers.web.http.intent import Request
from yarpy.carriers.web.http.login import parse_challenges
from yarpy.carriers.web.http.port_page import page
from yarpy.carriers.web.http.request import page_asked, read_intent
from yarpy.carriers.web.http.token import taken
from yarpy.config.configuration import parse_server
from yarpy.config.ini import parse_ini
from yarpy.contact import parse_contact
from yarpy.data import xmlrpc
from yarpy.data.bottle import Property
from yarpy.data.json import from_json
from yarpy.data.stamp import Stamp
from yarpy.data.text_reader import Balance, parse_text
from yarpy.errors import (
    AddressError,
    DecodeError,
    LocalProtocolError,
    RemoteProtocolError,
    UnknownType,
)
from yarpy.kits.thrift.file.include import text_interface
from yarpy.kits.thrift.generate.module import python
from yarpy.limit import HTTP_CHALLENGES
from yarpy.monitors.constraint import Constraint
from yarpy.names.discovery import respond
from yarpy.names.registration_line import parse_registration, plain
from yarpy.nameserver.command import NameService
from yarpy.nameserver.store import NameStore
from yarpy.nameserver.topology import Topology
from yarpy.peers.ros.master import parse_uri
from yarpy.peers.ros.message.catalogue import Catalogue
from yarpy.peers.ros.message.source import Standard
from yarpy.peers.ros2.message import parse as ros2_parse
from yarpy.peers.ros2.token import parse_token
from yarpy.route import Route, masked, parse_carrier
from yarpy.wire.framing import parse_command

#: what a parser may raise for a text that is none
REFUSALS = (DecodeError, UnknownType, AddressError, LocalProtocolError, RemoteProtocolError)

Shape = tuple[bytes, bytes, bytes]


@dataclass(frozen=True)
class Grammar:
    """`read` takes bytes; `shapes` are (beginning, repeated piece, end); `pieces` is what texts of
    the grammar are made of."""

    read: Callable[[bytes], Any]
    shapes: tuple[Shape, ...]
    pieces: tuple[bytes, ...] = ()

    def refuses(self, data: bytes) -> bool:
        """Whether it says that this is no text of its own, as it should for most of them."""
        try:
            self.read(data)
        except REFUSALS:
            return True
        return False


def spelled(shape: Shape, size: int) -> bytes:
    """A shape of about `size` bytes."""
    begin, piece, end = shape
    return begin + piece * (size // len(piece)) + end


def _of_text(read: Callable[[str], Any]) -> Callable[[bytes], Any]:
    return lambda data: read(data.decode("utf-8", "surrogateescape"))


def _get(data: bytes) -> object:
    return read_intent(Request("GET", "/" + data.decode("latin-1"), {}))


def _post(data: bytes) -> object:
    return read_intent(Request("POST", "/form", {}, data))


def _post_json(data: bytes) -> object:
    return read_intent(Request("POST", "/form", {"content-type": "application/json"}, data))


def _page_asked(data: bytes) -> object:
    return page_asked(Request("GET", "/" + data.decode("latin-1"), {}))


def _introduced(data: bytes) -> object:
    route = Route("", "/port")
    route.introduce("/a " + data.decode("latin-1"))
    return str(route)


def _page(data: bytes) -> object:
    return page("/port", [data.decode("utf-8", "surrogateescape")])


def _challenges(data: bytes) -> object:
    text = data.decode("latin-1")
    return [parse_challenges(text[at : at + HTTP_CHALLENGES]) for at in range(0, len(text), 8192)]


def _call(data: bytes) -> object:
    return xmlrpc.decode_call(
        b"<methodCall><methodName>say</methodName><params><param><value>"
        + data
        + b"</value></param></params></methodCall>"
    )


def _method(data: bytes) -> object:
    return xmlrpc.decode_call(b"<methodCall><methodName>" + data + b"</methodName></methodCall>")


def _answer(data: bytes) -> object:
    answer = (
        b"<methodResponse><params><param><value>"
        + data
        + b"</value></param></params></methodResponse>"
    )
    for each in (answer, b"<methodResponse><fault>" + data + b"</fault></methodResponse>", data):
        for decode in (xmlrpc.decode_answer, xmlrpc.decode_plain_answer):
            with suppress(*REFUSALS):
                decode(each)
    return xmlrpc.decode_answer(answer)


def _named(data: bytes) -> object:
    service = NameService(NameStore(), Topology(time.monotonic))
    text = data.decode("utf-8", "surrogateescape")
    respond(b"NAME_SERVER " + data[:60000], service.answer_multicast)
    return service.answer_text(text, "127.0.0.1").text_lines()


def _definition(data: bytes) -> object:
    """What a peer of ROS sends with its connection."""
    catalogue = Catalogue([Standard()])
    text = data.decode("utf-8", "surrogateescape")
    catalogue.message_of("p/Type", text)
    return catalogue.service_of("p/Do", text)


def _definition_2(data: bytes) -> object:
    """A file of ROS 2, as a message and as a service."""
    text = data.decode("utf-8", "surrogateescape")
    ros2_parse.parse_service(text, "p/Do")
    return ros2_parse.parse_message(text, "p/Type")


LINE = b" and words up to the end of the line, as in a file that people write\n"
_TEXT_PIECES = (
    *(b"1", b"0", b"0x", b"+", b"-", b".", b"e", b"inf", b"nan", b"null", b"true", b"a", b"[a]"),
    *(b'"', b"\\", b"(", b")", b"{", b"}", b"[", b"]", b" ", b",", b"\n", b"\xc3", b"\0", b"12 "),
)

_TOKEN = (
    b"@ros2_lv/0/abc/0/10/MS/%/%/listener/%chatter/std_msgs::msg::dds_::String_/"
    b"TypeHashNotSupported/::,10:,:,:,,"
)
_SEPARATOR = b"\n" + b"=" * 80 + b"\nMSG: "


def _thrift(data: bytes) -> object:
    return python(text_interface(data.decode("utf-8", "replace"), "f"))


GRAMMARS = {
    "thrift": Grammar(
        _thrift,
        (
            *(
                (b"", piece, b"")
                for piece in (b"/", b"*", b"#", b"//a\n", b"/**/", b"/**a*/", b"\n")
            ),
            *((b"struct A { ", piece, b" }") for piece in (b"1", b"i32 a, ", b"/** */", b"a.")),
            (b"typedef ", b"list<", b"i32"),
            (b"typedef list<", b"map<i32,", b"i32"),
            (b"const i32 A = ", b"1", b""),
            (b"const i32 A = ", b"[", b""),
            (b"const string A = '", b"\\n", b"'"),
            (b"const string A = '", b"a", b""),
            (b"service S { void ", b"a_", b"() }"),
            (b"service S { void f(", b"1: i32 a ", b") }"),
            (b"enum A { ", b"B, ", b"}"),
            (b"struct A { 1: i32 a (", b"a = 'b', ", b") }"),
            (b"", b"struct A {} ", b""),
            (b"/**", b" * a\n", b"*/ struct A {}"),
            (b"", b"/** a */ const i32 A = 1\n", b""),
            (b"typedef B A ", b"typedef A B ", b""),
            (b"/** x */" + b" " * 9000 + b"struct S {", b"i32 a\n", b"}"),
            (b"/** x */" + b"#\n" * 4500 + b"struct S {", b"i32 a\n", b"}"),
            (b'include "', b'\\"', b""),
            (b"", b"/* ", b""),
            (b"enum A { B } const list<A> C = [", b"A.B,", b"]"),
        ),
        (
            *(b"struct A { ", b"} ", b"1: i32 a = 3, ", b"list<", b"A> ", b"b, ", b"service S { "),
            *(b"void f(", b") ", b"oneway ", b"enum E { X } ", b"typedef E ", b"const E C = E.X "),
            *(b"{ 'a': 1 } ", b"[1, 2] ", b"/** a */ ", b"# b\n", b"(yarp.nested = 'true') "),
            *(b"(yarp.type = 'uint8_t') ", b"(yarp.name = 'a::B') ", b"i8 ", b"double ", b"map<"),
            *(b"string s = 'x' ", b", i32> ", b"set<", b"extends S ", b"_", b"\xff", b'"', b"\\"),
        ),
    ),
    "ros definition": Grammar(
        _definition,
        (
            *((b"", piece, b"") for piece in (b"#", b"\n", b"=", b"a", b"[", b"1", b" ", b"---\n")),
            *((b"int32", piece, b" a") for piece in (b"[", b"]", b"1", b"/", b"/a")),
            *((b"int32 A=", piece, b"") for piece in (b"1", b"(", b"-", b"1e", b" ")),
            (b"bool A=", b"(", b""),
            (b"", b"# a\n", b"int8 a"),
            (b"int8 a\n", b"# a\n", b"int8 b"),
            (b"string A=", b"a=", b""),
            (b"int8 a\n", _SEPARATOR + b"p/A\nint8 a\n", b""),
            (b"A a\n" + _SEPARATOR + b"p/A\n", b"int8 a\nA[] b\n", b""),
        ),
        (
            *(b"int32 ", b"string ", b"time ", b"Header ", b"float64[] ", b"uint8[4] ", b"A "),
            *(b"a", b"b", b"A=1", b"B = x # y", b"\n", b"# ", b"---\n", b" ", b"\xff", b"[", b"]"),
            _SEPARATOR + b"p/A\nint8 a\n",
            _SEPARATOR + b"p/B\nType t\n",
        ),
    ),
    "text": Grammar(
        parse_text,
        (
            *(
                (b"", digit, end)
                for digit in (b"0", b"1", b"+", b"-", b"x")
                for end in (b"g", b"e")
            ),
            (b"0x", b"1", b"."),
            (b"0x.", b"f", b"g"),
            (b"1.", b"1", b"e"),
            (b".", b"1", b"e"),
            (b"1e", b"1", b"."),
            *((b"{", digit, end) for digit in (b"0", b"1") for end in (b"g}", b"e}")),
            *((b"", piece, b"") for piece in (b"(", b")", b'"', b"\\", b"{", b"[", b" ", b"1 ")),
            (b"(" * 90, b"a ", b")" * 90),
            (b"", b"() ", b""),
            (b'"', b"\\n", b'"'),
        ),
        _TEXT_PIECES,
    ),
    "property": Grammar(
        Property.from_text, ((b"", b"(a 1) ", b""), (b"", b"(a ", b"")), _TEXT_PIECES
    ),
    "balance": Grammar(
        lambda text: Balance().feed(text),
        ((b"", b"(", b""), (b"", b'"', b""), (b"", b"\\", b"")),
    ),
    "json": Grammar(
        from_json,
        (
            *((b"", piece, b"") for piece in (b"1", b"[", b'{"a":', b" ", b'"', b"-", b"0", b"\\")),
            (b"1.", b"1", b"x"),
            (b"1e", b"1", b""),
            (b"[", b"1,", b"1]"),
            (b"[", b"[],", b"1]"),
            (b'"', b"\\ud800", b'"'),
            (b"{", b'"a":1,', b'"a":1}'),
        ),
        (
            *(b"1", b"-", b".", b"e9", b"0", b"[", b"]", b"{", b"}", b'"', b"\\u0041", b"\\ud800"),
            *(b",", b":", b" ", b"null", b"true", b"NaN", b"Infinity", b'"type":', b'"a"'),
            *(b"9" * 309,),
            *(b'"base64":', b'"blob"', b'"dict"', b'"list"'),
        ),
    ),
    "xmlrpc": Grammar(
        _call,
        (
            *((b"<i4>", piece, b"</i4>") for piece in (b"1", b" ", b"-")),
            *((b"<double>", piece, b"</double>") for piece in (b"1", b"1e", b"0", b".")),
            *((b"<biginteger>", piece, b"</biginteger>") for piece in (b"1",)),
            *((b"<bigdecimal>", piece, b"</bigdecimal>") for piece in (b"1", b"0.")),
            *((b"<base64>", piece, b"</base64>") for piece in (b"A", b"=", b"\n")),
            *(
                (b"", piece, b"")
                for piece in (b"&amp;", b"<a ", b"<array><data>", b"</value><value>")
            ),
            (b"<dateTime.iso8601>", b"1", b"</dateTime.iso8601>"),
            (b"<!--", b"-", b""),
            (b"<![CDATA[", b"]", b""),
            (b"[", b"1", b"e"),
            (b"<array><data>", b"<value>1</value>", b"</data></array>"),
        ),
        (
            *(b"<i4>", b"</i4>", b"<i8>", b"</i8>", b"<double>", b"</double>", b"1", b"nan", b"-"),
            *(b"<array>", b"</array>", b"<data>", b"</data>", b"<struct>", b"</struct>", b"[a]"),
            *(b"<member>", b"</member>", b"<name>", b"</name>", b"<value>", b"</value>", b"<nil/>"),
            *(b"<base64>", b"</base64>", b"<boolean>", b"</boolean>", b"&lt;", b"&#0;"),
            *(b"<string>",),
            *(b"</string>", b"<dateTime.iso8601>", b"</dateTime.iso8601>", b"\0", b"\xff"),
            *(b"9" * 20,),
        ),
    ),
    "xmlrpc answer": Grammar(
        _answer,
        (
            *((b"", piece, b"") for piece in (b"<value>", b"1", b"&amp;", b"<fault>")),
            (b"<array><data>", b"<value>1</value>", b"</data></array>"),
        ),
        (
            *(b"<i4>", b"</i4>", b"<array>", b"</array>", b"<data>", b"</data>", b"<value>"),
            *(b"</value>", b"<string>", b"</string>", b"1", b"<struct>", b"</struct>", b"<nil/>"),
            *(b"<member>", b"</member>", b"<name>", b"</name>", b"faultCode", b"faultString"),
        ),
    ),
    "ros 2 definition": Grammar(
        _definition_2,
        (
            *((b"", piece, b"") for piece in (b"#", b"\n", b"=", b"a", b"[", b"1", b" ", b"---\n")),
            *((b"int32", piece, b" a") for piece in (b"[", b"]", b"1", b"/", b"/a", b"<=", b"<")),
            *((b"int32[] a ", piece, b"") for piece in (b"[", b"1,", b"-", b"(", b"true", b" ")),
            *((b"string A=", piece, b"") for piece in (b"'", b'"', b"#", b"a=", b"\\")),
            (b"", b"# a\n", b"int8 a"),
            (b"int8 a\n", b"# a\n", b"int8 b"),
        ),
        (
            *(
                b"int32 ",
                b"string<=3 ",
                b"float64[] ",
                b"uint8[<=4] ",
                b"A ",
                b"p/msg/T ",
                b"byte ",
            ),
            *(
                b"a",
                b"b",
                b"A=1",
                b"B = 'x # y'",
                b"\n",
                b"# ",
                b"---\n",
                b" ",
                b"\xff",
                b"[",
                b"]",
            ),
            *(b"1.5", b"true", b"[1, 2]", b'"', b"wstring ", b"<="),
        ),
    ),
    "ros 2 token": Grammar(
        _of_text(parse_token),
        (
            *((b"@ros2_lv/", piece, b"") for piece in (b"0/", b"/", b"0", b"%/", b"NN/", b":,")),
            (_TOKEN, b"/a", b""),
            (_TOKEN, b"0", b""),
        ),
        (
            b"@ros2_lv",
            b"/0",
            b"/NN",
            b"/MP",
            b"/%",
            b"/a",
            b"/%chatter",
            b"/::,10:,:,:,,",
            b"/",
            b"x",
        ),
    ),
    "ros address": Grammar(
        _of_text(parse_uri),
        ((b"http://", b"a", b""), (b"http://a:", b"1", b""), (b"http://", b":", b"")),
        (b"http://", b"rosrpc://", b"a", b":", b"1", b"/", b"[", b"]", b"%"),
    ),
    "web token": Grammar(
        _of_text(taken),
        ((b"/?", b"token=", b""), (b"/?token=", b"%41", b""), (b"/?", b"a&", b"")),
        (b"/", b"?", b"token=", b"a", b"&", b"=", b"%41", b"%", b"#"),
    ),
    "xmlrpc method": Grammar(_method, ((b"", b"1", b"e"), (b"", b"(", b"")), _TEXT_PIECES),
    "stamp": Grammar(
        Stamp.from_text,
        ((b"", b" ", b"x"), (b"1", b" ", b"x"), (b"1 ", b"1", b"x"), (b"1 1.", b"1", b"e")),
        (b"1", b" ", b".", b"e", b"-", b"+", b"inf", b"nan", b"2147483647"),
    ),
    "contact": Grammar(
        _of_text(parse_contact),
        ((b"/", b"a", b":"), (b"/a:", b"1", b"x"), (b"/[", b"1:", b"]x"), (b"", b"://", b"")),
        (
            b"/",
            b":",
            b"a",
            b"1",
            b"[",
            b"]",
            b"%",
            b"://",
            b"tcp",
            b"+",
            b".",
            b"\xff",
            b"\0",
            b" ",
        ),
    ),
    "specifier": Grammar(
        _introduced,
        ((b"", b"(", b""), (b"", b"(a b) ", b""), (b"", b")", b""), (b"", b"a ", b"")),
        (b"(", b")", b" ", b"a", b"b", b"+", b".", b"\0"),
    ),
    "carrier": Grammar(
        _of_text(parse_carrier),
        ((b"", b"+", b""), (b"", b"(", b""), (b"(", b"+a", b")"), (b"", b"+send.x", b"")),
        (b"+", b".", b"(", b")", b"a", b"send.", b"recv.", b"log.", b"password.", b" ", b"\0"),
    ),
    "masked": Grammar(
        _of_text(masked),
        ((b"", b"+password.", b""), (b"+password.", b"a", b""), (b"+password.", b":", b"")),
        (b"+password.", b"+", b":/", b" ", b"a", b"."),
    ),
    "registration": Grammar(
        _of_text(parse_registration),
        (
            (b"registration name ", b" ip ", b""),
            (b"registration name a", b" ip x port 1", b""),
            (b"registration name a ip ", b"x", b""),
            (b"", b" ", b"x"),
        ),
        (b"registration name ", b" ip ", b" port ", b" type ", b"1", b"a", b"-", b"\n"),
    ),
    "plain": Grammar(_of_text(plain), ((b"", b'"', b""), (b"", b"\\", b""), (b"", b"a", b"\n"))),
    "ini": Grammar(
        _of_text(parse_ini),
        (
            *((b"", piece, b"") for piece in (b"${", b"$(", b"$", b"(" + LINE, b'"' + LINE, LINE)),
            (b"", b"[a b]" + LINE, b""),
            (b"", LINE[:-1] + b"\\\n", b""),
            (b"a " + b"x" * 100 + b"\n", b"b $a$a$a" + LINE, b""),
            (b"a b\n", b"a $a $a" + LINE, b""),
        ),
        (
            *(b"a", b" ", b"\n", b"[", b"]", b"${", b"$(", b"$a", b"\\", b'"', b"("),
            *(b"//", b"#", b"}"),
            *(b"a 1\n", b"[a b]\n", b"\\\n", b"=", b"1"),
        ),
    ),
    "server address": Grammar(
        _of_text(parse_server),
        ((b"[name]\n", b"a b\n", b""), (b"", b" ", b""), (b"", b"[name]\n", b"")),
        (b"[name]\n", b"host a\n", b"port 1\n", b" ", b"\n", b'"', b"1", b"//", b"yarp", b"ros"),
    ),
    "fields": Grammar(
        _of_text(read_fields),
        ((b"a=", b"%41", b""), (b"a=", b"%", b""), (b"a=", b"+", b""), (b"a=", b"%ff", b"")),
        (b"a", b"=", b"&", b"%41", b"%", b"+", b"%ff", b"\xff"),
    ),
    "get": Grammar(
        _get,
        (
            *((b"", piece, b"") for piece in (b"a", b"a.", b"a:", b"/", b"?", b"#", b"%", b"$")),
            (b"?req=", b"$a", b"&a=b"),
            (b"?req=", b"$", b""),
            (b"", b"a://", b""),
        ),
        (
            *(b"a", b":", b"://", b"/", b"?", b"#", b"%41", b"%", b"&", b"=", b"+"),
            *(b"req=", b"data="),
            *(b"cmd=", b"$a", b"a=1", b"format=json", b"d%0A", b"admin=1", b"r", b"*"),
        ),
    ),
    "post": Grammar(
        _post,
        (
            (b"req=", b"$a", b"&a=b"),
            (b"data=", b"$", b""),
            (b"cmd=", b"a", b""),
            (b"", b"%41", b""),
            (b"cmd=d%0A", b"1", b"e"),
        ),
        (b"req=", b"data=", b"cmd=", b"$a", b"a=b", b"&", b"=", b"%0A", b"d ", b"\0", b"\xff"),
    ),
    "post json": Grammar(
        _post_json,
        ((b'{"req": "', b"$a", b'", "a": "b"}'), (b"", b"1", b""), (b"", b"[", b"")),
        (b'{"req":', b'"$a"', b',"a":', b'"x"', b"}", b"[", b"]", b"1", b"true", b"null", b"1e999"),
    ),
    "page asked": Grammar(_page_asked, ((b"", b"a", b""), (b"", b"a.", b""), (b"?", b"%41", b""))),
    "port page": Grammar(
        _page,
        (
            (b"+ ", b"$", b""),
            (b"+ ", b"[$a", b""),
            (b"registration name ", b" ip ", b""),
            (b"registration name ", b"a", b""),
            (b"Name server at http://", b"a", b""),
            (b"", b"+ $a" + LINE, b""),
        ),
        (
            b"+ ",
            b"$a",
            b"[",
            b"]",
            b"registration name ",
            b" ip ",
            b" port ",
            b" type ",
            b"\n",
            b"<",
        ),
    ),
    "challenges": Grammar(
        _challenges,
        (
            (b"", b"a", b""),
            (b"", b'"', b""),
            (b"", b"a ", b""),
            (b"a=", b"\\", b""),
            (b"", b"a=", b""),
        ),
        (b"Digest ", b"realm=", b'"', b"a", b",", b"=", b"\\", b" ", b"nonce=", b"qop=", b"Basic "),
    ),
    "constraint": Grammar(
        _of_text(Constraint),
        ((b"", b"(", b""), (b"", b"not ", b"a"), (b"", b"a or ", b"a")),
        (b"a ", b"(", b")", b"not ", b"and ", b"or ", b"true ", b" "),
    ),
    "port command": Grammar(
        _of_text(parse_command),
        ((b"", b"a", b""), (b"d ", b" ", b""), (b"", b"~", b"")),
        (b"d", b"D", b"a", b"~", b"q", b"r", b"*", b" ", b"\0", b"/x", b"!", b"tcp"),
    ),
    "name server": Grammar(
        _named,
        (
            (b"register /a tcp ", b"1", b"e"),
            (b"set /a x ", b"(", b""),
            (b"list ", b"1 ", b""),
            (b"register ", b"/", b""),
            (b"query ", b"/a@", b""),
        ),
        (
            *(b"register ", b"unregister ", b"list ", b"set ", b"get ", b"check "),
            *(b"route ", b"gc "),
            *(b"query ", b"bot ", b"NAME_SERVER ", b"announce ", b"subscribe ", b"topic "),
            *(b"type ",),
            *(b"/a ", b"/b ", b"... ", b"tcp ", b"1 ", b"(", b")", b'"', b"[add] "),
            *(b"@/net", b"help "),
            *(b"untopic ", b"unsubscribe ", b"127.0.0.1 ", b"99999999999 ", b"\0", b"\xff", b"= "),
        ),
    ),
}
