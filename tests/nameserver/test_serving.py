"""NameServer: recorded dialogues, commands over every carrier, what survives, what follows."""

from __future__ import annotations

import errno
import os
import re
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from types import SimpleNamespace

import pytest
from support.capture import load_capture
from support.difference import LIVE_DIFFERENT
from support.lasted import lasted
from support.port import free_block
from support.steps import chop
from support.wait import HANG, wait_until

import yarpy
from yarpy import network, registry
from yarpy.data.bottle import Bottle
from yarpy.limit import SERVER_COMMAND, SERVER_UNFINISHED
from yarpy.nameserver.server import NameServer
from yarpy.nameserver.serving import Serving
from yarpy.wire import framing
from yarpy.wire.message import Packet


def test_who_is_killed_while_its_question_is_on_the_way() -> None:
    """Its address is not known any more: the connection has ended, which is no defect."""

    class Gone:
        @property
        def remote(self) -> tuple[str, int]:
            raise OSError(errno.ENOTCONN, "Transport endpoint is not connected")

    link = SimpleNamespace(driver=SimpleNamespace(transport=Gone()))
    with NameServer() as server, pytest.raises(yarpy.LinkClosed, match="not connected"):
        server._serving._answer(link, yarpy.Message("D", b""))  # type: ignore[arg-type]


def test_who_comes_before_it_is_open_waits(monkeypatch: pytest.MonkeyPatch) -> None:
    """Clients of a restarted server knock until it listens, which is before it knows anything."""
    number = free_block(10)
    listens = threading.Event()
    register = Serving._register_self

    def slowly(server: Serving) -> None:
        listens.set()
        time.sleep(0.2)
        register(server)

    monkeypatch.setattr(Serving, "_register_self", slowly)
    servers: list[NameServer] = []
    starting = threading.Thread(target=lambda: servers.append(NameServer(number)))
    starting.start()
    try:
        assert listens.wait(HANG)
        with socket.create_connection(("127.0.0.1", number), 5) as client:
            client.sendall(b"NAME_SERVER query /root\n")
            assert client.recv(1000).startswith(b"registration name /root ip 127.0.0.1 port ")
    finally:
        starting.join(HANG)
        servers[0].close()


def test_numbers_that_strangers_have_are_not_lent() -> None:
    """Ports that outlived an earlier server still listen; C++ ports do not register again."""
    number = free_block(10)
    with socket.socket() as stranger:
        stranger.bind(("", number + 2))
        stranger.listen()
        with NameServer(number), yarpy.Port("/new") as port:
            assert port.contact.port == number + 3


def test_a_living_port_keeps_its_number() -> None:
    """What C++ programs ask: a number for the name, whoever has it."""
    with NameServer() as server:
        with yarpy.Port("/x") as port:
            assert server.client.register("/x").port == port.contact.port
            assert server.client.get("/x", "process") == [str(os.getpid())]
            port._hub.registration.registered = False  # as if it were killed
        again = server.client.register("/x")
        assert again.port == port.contact.port, "it is free again, and the name's own"


def test_a_name_whose_number_another_has_gets_a_new_one() -> None:
    number = free_block(10)
    with NameServer(number) as server, yarpy.Port("/other") as other:
        server.client.register("/x", "tcp", "127.0.0.1", other.contact.port)
        assert server.client.register("/x").port == number + 3


def test_a_port_that_is_silent_keeps_its_number(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("yarpy.nameserver.serving.BUSY", 0.2)
    with NameServer() as server, socket.create_server(("127.0.0.1", 0)) as silent:
        stuck = server.client.register("/stuck", "tcp", "127.0.0.1", silent.getsockname()[1])
        assert server.client.register("/stuck") == stuck


def test_only_a_refused_connection_proves_that_a_port_is_gone(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    there = yarpy.Contact("tcp", "/far", "192.0.2.1", 10002)
    with NameServer() as server:
        for error, lives in (
            (OSError(errno.EHOSTUNREACH, "No route to host"), True),
            (OSError(errno.ENETUNREACH, "Network is unreachable"), True),
            (TimeoutError("timed out"), True),
            (ConnectionRefusedError("Connection refused"), False),
        ):

            def dial(*_: object, error: OSError = error) -> None:
                raise error

            monkeypatch.setattr(registry.transports.load("tcp"), "dial", dial)
            assert server._serving._is_alive(there) is lives, error


# ---------------------------------------------------------------------------------- captures


class Recorded:
    """A server with the numbers of a recording moved to its own."""

    def __init__(self, server: NameServer) -> None:
        self.server = server

    def moved(self, data: bytes) -> bytes:
        """Numbers 216xx of the recorded host are ours plus xx."""
        text = re.sub(rb"216(\d\d)", lambda m: b"%d" % (self.server.port + int(m[1])), data)
        return re.sub(
            rb"(?<=port_number\x01\0\0\0)[\x60-\x90]\x54\0\0",  # 21600 and a few more
            lambda m: (self.server.port + int.from_bytes(m[0], "little") - 21600).to_bytes(
                4, "little"
            ),
            text,
            flags=re.S,
        )


@pytest.fixture
def recorded() -> Iterator[Recorded]:
    with NameServer(free_block(50)) as server:
        yield Recorded(server)


def said(sock: socket.socket, count: int) -> bytes:
    data = b""
    while len(data) < count:
        part = sock.recv(count - len(data))
        if not part:
            break
        data += part
    return data


RAW_LINES = (
    "C++ answers old commands with raw lines on binary carriers too, which have no end that a "
    "binary client could see; we answer with a Bottle that holds the lines"
)
# What the recorded server knew before the dialogue.
KNOWN = {
    "telnet_ns": ["/cap/srv", "/cap/in", "/cap/out"],
    "ns_rpc_text_ack": ["/t/a"],
    "ns_rpc_tcp": ["/t/a"],
    "ns_rpc_fast_tcp": ["/t/a"],
    "ns_text_one_connection": [],
    "ns_text_split_header": ["/t/a"],
    "ns_query": [],
    "ns_admin": [],
    "ns_set_get": ["/t/a"],
    "ns_topics": ["/t/a"],
}


def wanted(recorded: Recorded, name: str, data: bytes, asked: bytes) -> bytes:
    """What we answer instead of `data`."""
    ack = framing.ACK if data.endswith(framing.ACK) else b""
    body = data[: len(data) - len(ack)]
    if asked[:8] == framing.INDEX and body[:4] not in (b"\0\1\0\0", b"\4\1\0\0", b"\t\1\0\0"):
        return Bottle([recorded.moved(body).decode()]).to_bytes() + ack  # RAW_LINES
    return recorded.moved(data)


@pytest.mark.parametrize("piece", [0, 1], ids=["whole", "bytewise"])
@pytest.mark.parametrize(
    "name",
    [
        *("telnet_ns", "ns_rpc_text_ack", "ns_rpc_tcp", "ns_rpc_fast_tcp"),
        *("ns_text_one_connection", "ns_text_split_header", "ns_admin"),
    ],
)
def test_recorded_dialogue(name: str, piece: int, recorded: Recorded) -> None:
    """Commands over every carrier, as C++ 3.9.1 answered them."""
    capture = load_capture(name)
    server = recorded.server
    for known in KNOWN[name]:
        server.client.register(known)
    differences = LIVE_DIFFERENT.get(name, {})
    with socket.create_connection(("127.0.0.1", server.port), 5) as sock:
        sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        for step in capture.steps:
            if step.sender != "a":
                continue
            for part in chop(step.data, piece):
                sock.sendall(part)
            following = capture.steps[step.index + 1 : step.index + 2]
            if step.index in differences:
                check = differences[step.index].ours
                assert callable(check)
                data = b""
                while not data.endswith(b"<ACK>\r\n"):
                    data += sock.recv(1000)
                check(data)
            elif following and following[0].sender == "b":
                answer = wanted(recorded, name, following[0].data, step.data)
                if step.index == 0 and step.data[:2] == b"YA":
                    answer = framing.number(server.port)
                assert said(sock, len(answer)) == answer
        sock.shutdown(socket.SHUT_WR)
        assert sock.recv(100) == b""


def test_events_of_the_server_port(recorded: Recorded) -> None:
    """Who is connected to its output hears of every name that comes and goes."""
    capture = load_capture("ns_events")
    server = recorded.server
    heard: list[bytes] = []
    with yarpy.Port("/listener", callback=lambda m: heard.append(bytes(m.payload))):
        network.connect(server.name, "/listener")
        for name in ("/t/x1", "/t/evout"):
            ask(server, f"register {name}")
            ask(server, f"unregister {name}")
        wait_until(lambda: len(heard) >= 4)
    messages = [s.data for s in capture.steps[2:] if s.sender == "a"]
    for message, payload in zip(messages, heard[:4], strict=True):
        assert message.endswith(payload)


# ---------------------------------------------------------------------------------- behaviour


def ask(server: NameServer, command: str) -> list[str]:
    """What the server answers to one line, as its oldest clients ask."""
    with socket.create_connection(("127.0.0.1", server.port), 5) as sock:
        sock.sendall(f"NAME_SERVER {command}\n".encode())
        lines: list[str] = []
        with sock.makefile() as answer:
            for line in answer:
                lines.append(line.strip())
                if line.startswith(("*", "[", "ports", "port ")):
                    break
        return lines


def test_ports_of_this_process_find_it() -> None:
    with NameServer() as server:
        assert server.environment == {"YARPY_SERVER": f"127.0.0.1:{server.port}"}
        assert repr(server) == f"<NameServer /root at 127.0.0.1:{server.port}>"
        with yarpy.Port("/a") as a, yarpy.Port("/b") as b:
            a.connect("/b")
            a.write([1])
            assert b.read(timeout=HANG).value == [1]
            assert [c.name for c in server.client.list("/")][:3] == ["/a", "/b", "/root"]
        assert server.client.query("/a") is None


def test_child_process_finds_it_by_its_environment() -> None:
    code = "import yarpy; print(yarpy.query('/a').port); print(yarpy.exists('/a'))"
    with NameServer() as server, yarpy.Port("/a") as port:
        done = subprocess.run(
            [sys.executable, "-c", code],
            env={**os.environ, **server.environment},
            capture_output=True,
            text=True,
            timeout=20,
        )
        assert done.stdout.split() == [str(port.contact.port), "True"], done.stderr


def test_servers_inside_each_other() -> None:
    with NameServer() as outer, yarpy.Port("/same") as first:
        with NameServer() as inner, yarpy.Port("/same") as second:
            assert inner.client.query("/same") == second.contact
            assert outer.client.query("/same") == first.contact
            assert network.query("/same") == second.contact
        assert network.query("/same") == first.contact


def test_number_that_is_taken() -> None:
    with NameServer() as server, pytest.raises(yarpy.AddressError, match="cannot listen"):
        NameServer(server.port)


def test_server_is_an_ordinary_port_too() -> None:
    with NameServer() as server:
        assert network.exists("/root")
        assert network.admin("/root", "ver") == [yarpy.Vocab("ver"), 1, 2, 3]
        assert network.ping("/root")[0] == f"This is /root at tcp://127.0.0.1:{server.port}/"
        with yarpy.RpcClient("/root") as client:
            assert client.call("bot", "query", "/root", timeout=HANG)[0] == "port"
            (text,) = client.call("query", "/root", timeout=HANG)
            assert text.startswith("registration name /root ip 127.0.0.1 port")


def test_commands_of_several_clients_at_once() -> None:
    with NameServer() as server:

        def register(who: int) -> None:
            for number in range(30):
                name = f"/t/{who}/{number}"
                contact = server.client.register(name)
                assert server.client.query(name) == contact

        threads = [threading.Thread(target=register, args=(who,)) for who in range(5)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(HANG)
        found = list(server.client.list("/t"))
        assert len(found) == 150
        assert len({c.port for c in found}) == 150


def test_on_command_sees_everything() -> None:
    with NameServer() as server:
        seen: list[tuple[str, str]] = []
        server.on_command = lambda text, peer: seen.append((text, peer))
        ask(server, "query /x")
        assert ('query "/x"', "127.0.0.1") in seen


# ---------------------------------------------------------------------------------- persistence


def test_registrations_and_rules_survive_a_restart(tmp_path: Path) -> None:
    files = {"portdb": tmp_path / "port.db", "subdb": tmp_path / "sub.db"}
    number = free_block(50)
    with NameServer(number, **files) as server:
        contact = server.client.register("/mine")
        server.client.set("/mine", "color", "red")
        network.ask_server(server.client, ["subscribe", "/mine", "/other"])
        network.ask_server(server.client, ["topic", "/news"])
    with NameServer(number, **files) as server:
        assert server.client.query("/mine") == contact
        assert server.client.get("/mine", "color") == ["red"]
        reply = network.ask_server(server.client, ["subscribe"])
        assert reply.to_text() == 'subscriptions (subscription (src "/mine") (dest "/other"))'
        assert network.ask_server(server.client, ["topic"]).to_text() == '"/news"'
        assert server.client.register("/another").port != contact.port
    with NameServer(number) as server:
        assert server.client.query("/mine") is None


def test_living_port_is_still_known_after_a_restart(tmp_path: Path) -> None:
    number = free_block(50)
    server = NameServer(number, portdb=tmp_path / "port.db")
    with yarpy.Port("/mine", names=server.client) as port:
        server.close()
        server = NameServer(number, portdb=tmp_path / "port.db")
        try:
            assert server.client.query("/mine") == port.contact
        finally:
            server.close()


# ---------------------------------------------------------------------------------- topics


def test_topic_joins_publishers_and_subscribers() -> None:
    with (
        NameServer(),
        yarpy.Port("/talker") as talker,
        yarpy.Port("/first") as first,
        yarpy.Port("/second") as second,
    ):
        assert network.connect("/talker", "topic://news").reply == "connection to topic added."
        network.connect("topic://news", "/first")
        network.connect("topic://news", "/second")
        assert talker.wait_for_outputs(2, timeout=HANG)
        talker.write([1])
        assert first.read(timeout=HANG).value == second.read(timeout=HANG).value == [1]
        with yarpy.Port("/late") as late:
            network.connect("topic://news", "/late")
            assert talker.wait_for_outputs(3, timeout=HANG)
            talker.write([2])
            assert late.read(timeout=HANG).value == [2]


def test_persistent_connection_comes_with_its_ports() -> None:
    with NameServer() as server:
        reply = network.ask_server(server.client, ["subscribe", "/out", "fast_tcp://in"])
        assert reply == [yarpy.Vocab("ok")]
        for _ in range(2):
            with yarpy.Port("/in") as in_, yarpy.Port("/out") as out:
                assert out.wait_for_outputs(timeout=HANG)
                out.write([1])
                assert in_.read(timeout=HANG).value == [1]
        reply = network.ask_server(server.client, ["unsubscribe", "/out", "/in"])
        assert reply == [yarpy.Vocab("ok")]
        with yarpy.Port("/in"), yarpy.Port("/out") as out:
            assert not out.wait_for_outputs(timeout=0.3)


def test_command_does_not_wait_for_a_port_that_is_stuck() -> None:
    """What has to be asked of ports is done by others than who answers commands."""
    with NameServer() as server, socket.create_server(("127.0.0.1", 0)) as silent:
        server.client.register("/stuck", "tcp", "127.0.0.1", silent.getsockname()[1])
        server.client.register("/other", "tcp", "127.0.0.1", 9)
        started = time.monotonic()
        network.ask_server(server.client, ["subscribe", "/stuck", "/other"])
        server.client.announce("/stuck")
        assert server.client.query("/other") is not None
        assert lasted(started) < 2


def test_what_strangers_begin_is_limited_far_lower_than_in_a_port() -> None:
    with NameServer() as server:
        assert server.hub.inputs.budget.limit == SERVER_UNFINISHED
        head = b"".join(map(bytes, framing.encode(Packet(bytes(2 * SERVER_COMMAND)))))
        for said in (head, b"POST /form HTTP/1.1\r\nHost: x\r\nContent-Length: 2000000\r\n\r\n"):
            with socket.create_connection(("127.0.0.1", server.port), 5) as sock:
                if said is head:
                    sock.sendall(framing.number(7777 + 3) + framing.encode_name("/stranger"))
                    assert len(sock.recv(8, socket.MSG_WAITALL)) == 8
                sock.sendall(said[: 1 << 16])
                answer = b""
                with suppress(OSError):
                    if said is not head:
                        sock.shutdown(socket.SHUT_WR)
                    while more := sock.recv(1000):
                        answer += more
                assert said is head or b"413" in answer
        assert server.client.query("/nobody") is None
