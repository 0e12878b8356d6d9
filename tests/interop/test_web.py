"""HTTP of C++ YARP and ours, side by side: the same questions give the same JSON."""

import json
import urllib.request
from http.client import HTTPConnection
from urllib.parse import urlsplit

import pytest
from support.cpp_program import CppProgram
from support.wait import HANG

import yarpy
from yarpy.names.client import YarpNameClient

# What a C++ name server can be asked without harm (its other answers are stored with junk).
QUESTIONS = [
    "/?req=query+$port&port=/web/x",
    "/?req=query+/web/x&outer=list",
    "/?req=query+/web/x&outer=dict",
    "/?req=query+/web/none",
    "/?req=list+/web",
    "/?req=bot+list+/web",
    "/?req=help",
    "/?req=gc",
    "/?req=bogus",
    "/?admin=1&req=[ver]",
]

# What a port may say, in the text of a Bottle.
SAID = [
    "1 2.5 hello",
    "(a 1) (b 2)",
    "x (a 1) (b (c 2) (d 3))",
    "x (a (1 2 3)) (b ())",
    '"quoted \\"text\\"" [voc]',
    "list (a 1) (b 2)",
    "dict (a 1)",
    "true false",
]


def body(host: str, port: int, target: str) -> bytes:
    """What comes after the header; C++ closes the connection, ours has a length."""
    connection = HTTPConnection(host, port, timeout=HANG)
    connection.request("GET", target)
    response = connection.getresponse()
    assert response.status == 200
    found = response.read()
    connection.close()
    return found


def test_name_servers_say_the_same(cpp_server):
    with YarpNameClient("127.0.0.1", cpp_server.port) as theirs, yarpy.NameServer() as ours:
        for names in (theirs, ours.client):
            names.register("/web/x", "tcp", "127.0.0.1", 9999)
            names.register("/web/y", "tcp", "127.0.0.1", 9998)
        for question in QUESTIONS:
            expected = json.loads(body("127.0.0.1", cpp_server.port, question))
            assert json.loads(body("127.0.0.1", ours.port, question)) == expected, question


@pytest.fixture
def echoes(our_names):
    """A C++ and a yarpy port that answer what they are asked."""
    with CppProgram(our_names) as program:
        program.do(
            """
class Echo(yarp.PortReader):
    def read(self, connection):
        heard, said = yarp.Bottle(), yarp.Bottle()
        if not heard.read(connection):
            return False
        said.fromString(heard.get(0).asString())
        writer = connection.getWriter()
        if writer is not None:
            said.write(writer)
        return True
echo, server = Echo(), yarp.RpcServer()
server.open("/web/cpp")
server.setReader(echo)
"""
        )
        answer = lambda m: yarpy.Bottle.from_text(m.value[0])  # noqa: E731
        with yarpy.RpcServer("/web/ours", answer) as server:
            yield program.do("server.where().getPort()"), server.contact.port


@pytest.mark.parametrize("said", SAID)
def test_ports_say_the_same(echoes, said):
    text = json.dumps(said)
    target = urllib.request.quote(text)
    theirs, ours = (json.loads(body("127.0.0.1", port, f"/?req={target}")) for port in echoes)
    assert ours == theirs


def test_cpp_page_finds_our_name_server(echoes, our_names):
    """The links that C++ ports put on their pages: all ports, and the style of the page."""
    page = body("127.0.0.1", echoes[0], "/").decode()
    links = [part.partition('"')[0] for part in page.split('href="')[1:]]
    ours = [urlsplit(link) for link in links if f":{our_names.port}/" in link]
    assert {link.path for link in ours} == {"/web/main.css", "/data=list"}
    assert b"color-scheme" in body("127.0.0.1", our_names.port, "/web/main.css")
    listed = body("127.0.0.1", our_names.port, "/data=list").decode()
    assert f'<a href="http://127.0.0.1:{echoes[0]}/">/web/cpp</a>' in listed
