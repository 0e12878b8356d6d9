"""The client of a YARP name server: what it says, and how it takes bad news."""

import contextlib
import os
import socket
import threading
import time

import pytest
from support.lasted import lasted
from support.name_line import new_service, serve_names
from support.port import free_port
from support.wait import HANG

from yarpy.contact import Contact
from yarpy.data.bottle import Bottle
from yarpy.errors import AccessRefused, AddressError, NoNameServer, RemoteProtocolError, Timeout
from yarpy.names import idle_lines
from yarpy.names import line as line_module
from yarpy.names.client import YarpNameClient
from yarpy.nameserver.reply import Reply
from yarpy.scope import Scope, moment


class Scripted:
    """A server that answers each connection with the same bytes and remembers what it heard."""

    def __init__(self, *answers: bytes | None, close: bool = False) -> None:
        self.heard = b""
        self._answers = answers
        self._close = close
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port: int = self._listener.getsockname()[1]
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        for answer in self._answers:
            try:
                connection, _ = self._listener.accept()
            except OSError:
                return
            with connection, contextlib.suppress(OSError):
                if answer is None:
                    continue
                connection.settimeout(HANG)
                self.heard += connection.recv(4096)
                connection.sendall(answer)
                if not self._close:
                    connection.recv(4096)

    def __enter__(self) -> "Scripted":
        return self

    def __exit__(self, *details: object) -> None:
        with contextlib.suppress(OSError):
            self._listener.shutdown(socket.SHUT_RDWR)  # wakes a thread in accept
        self._listener.close()
        self._thread.join(HANG)


END = b"*** end of message\r\n"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("/x",), 'register "/x"'),
        (("/x", "udp"), 'register "/x" udp "..." -1'),
        (("/x", "tcp", "10.0.0.1", 5), 'register "/x" tcp "10.0.0.1" 5'),
        (("/x", None, None, None, "yarp/image"), 'register "/x" "..." "..." -1 "yarp/image"'),
        (("/x", None, None, 21198), 'register "/x" "..." "..." 21198'),
        (("...",), 'register "..."'),
    ],
)
def test_what_register_says(arguments: tuple[str, ...], said: str) -> None:
    reply = b"registration name /x ip h port 7 type tcp\r\n"
    with Scripted(reply + END) as server, YarpNameClient("127.0.0.1", server.port) as names:
        assert names.register(*arguments) == Contact("tcp", "/x", "h", 7)  # type: ignore[arg-type]
    assert server.heard == f"NAME_SERVER {said}\n".encode()


def test_own_host_goes_where_none_is_given() -> None:
    reply = b"registration name /x ip h port 7 type tcp\n*** end of message\n"
    with Scripted(reply) as server:
        names = YarpNameClient("127.0.0.1", server.port, own_host="10.1.1.1")
        names.register("/x")
        names.close()
    assert server.heard == b'NAME_SERVER register "/x" "..." "10.1.1.1" -1\n'


def test_one_connection_serves_many_commands() -> None:
    with serve_names() as server, YarpNameClient("127.0.0.1", server.port) as names:
        names.register("/x")
        for _ in range(20):
            assert names.query("/x") is not None
        names.announce("/x")
        assert server.connections == 1
        names.set("/x", "k", 1)
        assert names.get("/x", "k") == ["1"]
        assert server.connections == 2, "Bottle replies have a connection of their own"


def test_all_about_a_port_goes_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    told = {"offers": ["tcp", "udp"], "ips": ["::1", "127.0.0.1"], "process": [17]}
    service = new_service()
    said: list[bytes] = []
    answer = service.answer_text

    def listen(line: bytes, peer: str) -> Reply:
        said.append(line)
        return answer(line, peer)

    monkeypatch.setattr(service, "answer_text", listen)
    with serve_names(service) as server, YarpNameClient("127.0.0.1", server.port) as names:
        names.register("/x")
        names.introduce("/x", told)
        assert said[1:] == [
            b'bot set "/x" offers tcp udp',
            b'bot set "/x" ips "::1" "127.0.0.1"',
            b'bot set "/x" process 17',
            b'announce "/x"',
        ]
        for key, values in told.items():
            assert names.get("/x", key) == sorted(map(str, values))
        for connection in server.open:
            connection.shutdown(socket.SHUT_RDWR)
        names.introduce("/x", {"process": [18]})  # all of it over a new connection
        assert names.get("/x", "process") == ["18"]


@pytest.mark.parametrize(
    ("replies", "error"),
    [
        (b"ok\r\n<ACK>\r\nok\r\n", NoNameServer),
        (b'[fail] "Access refused: not you"\r\n<ACK>\r\n[ok]\r\n<ACK>\r\n', AccessRefused),
    ],
)
def test_bad_news_about_a_port(replies: bytes, error: type[Exception]) -> None:
    with (
        Scripted(b"Welcome admin\r\n" + replies, close=True) as server,
        YarpNameClient("127.0.0.1", server.port) as names,
        pytest.raises(error),
    ):
        names.introduce("/x", {"process": [17]})


def test_commands_and_requests() -> None:
    with serve_names() as server, YarpNameClient("127.0.0.1", server.port) as names:
        names.register("/x")
        assert names.command("route", "/x", "/y") == ["port /x route /y = tcp://y"]
        assert names.command("bogus") == []
        assert names.command("help")[0] == "Here are some ways to use the name server:"
        assert names.command("announce", "/x") == []
        assert names.request(["subscribe", "/x", "/y"]) == ["ok"]
        assert names.request(["subscribe"]).group("subscription") is not None
        assert names.request(["topic", "/t"]) == ["ok"]
        assert names.request(["topic"]) == ["/t"]
        assert names.request(["untopic", "/t"]) == ["ok"]
        assert names.request(["topic"]) == []
        assert names.request(["unsubscribe", "/x", "/y"]) == ["ok"]
        assert names.request(["bot", "query", "/no"]) == ["port", ["error", -2, "port not known"]]
        assert names.request(["query", "/x"]) == [
            "registration name /x ip 127.0.0.1 port 10002 type tcp"
        ]
        assert names.request(["bot", "get", "/no", "k"]) == []
        for verb in ("bot", "topic", "subscribe", "unsubscribe", "untopic", "type"):
            with pytest.raises(AddressError, match="request"):
                names.command(verb)
        with pytest.raises(AddressError):
            names.command()


def test_odd_names_survive() -> None:
    odd = ["/with space", '/"quoted"'.replace('"', "'"), "/ünï", "/a,b", "/(x)", "/true", "/12"]
    with serve_names() as server, YarpNameClient("127.0.0.1", server.port) as names:
        for name in odd:
            assert names.register(name).name == name
            assert names.query(name) == names.list(name)[0]
            names.set(name, "k", "v w", "12x")
            assert names.get(name, "k") == ["12x", "v w"]


def test_a_refusal_says_why() -> None:
    service = new_service(65533)
    with serve_names(service) as server, YarpNameClient("127.0.0.1", server.port) as names:
        names.register("/x")
        with pytest.raises(AddressError, match='refused "/y": ran out of port numbers'):
            names.register("/y")
    with (
        Scripted(END) as silent,
        YarpNameClient("127.0.0.1", silent.port) as names,
        pytest.raises(NoNameServer, match="an ordinary port, not a name server"),
    ):
        names.register("/x")


# --- bad news


@pytest.mark.parametrize(
    ("name", "said"),
    [("/root", "is there, but was silent"), ("/arm", "is an ordinary port, /arm,")],
)
def test_a_server_that_is_slow_is_no_ordinary_port(
    name: str, said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Who it is, it says at once."""
    monkeypatch.setenv("YARP_NAMESPACE", "/other /root")
    monkeypatch.setattr("yarpy.names.client.WHO", HANG)
    answer = f"This is {name} at tcp://127.0.0.1:10000/\r\n".encode()
    with (
        Scripted(b"", b"Welcome admin\r\n" + answer) as server,
        YarpNameClient("127.0.0.1", server.port, 0.5) as names,
        pytest.raises(NoNameServer, match=said),
    ):
        names.query("/x")


def test_nobody_there() -> None:
    names = YarpNameClient("127.0.0.1", free_port(), 1.0)
    with pytest.raises(NoNameServer, match="yarpy server"):
        names.query("/x")
    assert not names.alive()
    with pytest.raises(NoNameServer):
        YarpNameClient("no.such.host.invalid", 10000, 1.0).query("/x")


def test_a_server_that_hangs_up() -> None:
    with (
        Scripted(None, None) as server,
        YarpNameClient("127.0.0.1", server.port) as names,
        pytest.raises(NoNameServer, match="hung up"),
    ):
        names.query("/x")


def test_a_server_that_says_nothing() -> None:
    with Scripted(b"") as server, YarpNameClient("127.0.0.1", server.port, 0.2) as names:
        start = time.monotonic()
        with pytest.raises(NoNameServer, match=r"within 0\.2 s.* stopped \(`fg`"):
            names.query("/x")
        assert lasted(start) < 4


def test_a_server_that_went_while_it_was_asked() -> None:
    with Scripted(b"") as server, YarpNameClient("127.0.0.1", server.port, 0.2) as names:
        asked = names._open("lines")
        server.__exit__(None, None, None)
        asked.close()
        with pytest.raises(NoNameServer, match="start one with `yarpy server`"):
            names.query("/x")


def test_the_last_moment_of_a_call_says_nothing_of_the_server() -> None:
    """wait_for() asks again until its time is over: no server answers within the rest of that."""
    with (
        Scripted(b"") as server,
        YarpNameClient("127.0.0.1", server.port) as names,
        Scope(moment(0.05)),
        pytest.raises(Timeout),
    ):
        names.query("/x")


def test_a_server_that_hangs_up_after_each_reply() -> None:
    line = b"registration name /x ip h port 7 type tcp\r\n"
    answers = [line + END] * 3
    with (
        Scripted(*answers, close=True) as server,
        YarpNameClient("127.0.0.1", server.port) as names,
    ):
        for _ in answers:
            assert names.query("/x") == Contact("tcp", "/x", "h", 7)
            time.sleep(0.05)


def test_both_kinds_of_connections_are_kept() -> None:
    """Two threads that ask in one kind leave room for those that ask in the other."""
    with serve_names() as server, YarpNameClient("127.0.0.1", server.port) as client:
        lines = [client._open("lines") for _ in range(3)]
        for line in lines:
            client._idle.give_back(line)
        client.request(["bot", "get", "/x", "y"])
        assert sorted(client._idle.kinds) == ["acked", "lines", "lines"]
        before = server.connections
        client.request(["bot", "get", "/x", "y"])
        assert server.connections == before


def test_a_restarted_server_is_found_again() -> None:
    port = free_port()
    names = YarpNameClient("127.0.0.1", port, 5.0)
    with serve_names(port=port):
        names.register("/x")
        names.set("/x", "k", 1)
    with pytest.raises(NoNameServer):
        names.query("/x")
    with serve_names(port=port):
        assert names.query("/x") is None
        assert names.get("/x", "k") == []
        assert names.register("/x").port == 10002
    names.close()


def test_restarted_between_two_commands() -> None:
    port = free_port()
    names = YarpNameClient("127.0.0.1", port, 5.0)
    with serve_names(port=port):
        names.register("/x")
    with serve_names(port=port) as server:
        assert names.query("/x") is None, "the dead connection is replaced without a word"
        assert server.connections == 1
    names.close()


def test_endless_lines_and_replies_are_cut(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(line_module, "NAME_REPLY", 100_000)
    for answer in (b"x" * 400_000, b"registration\r\n" * 40_000):
        with (
            Scripted(answer) as server,
            YarpNameClient("127.0.0.1", server.port) as names,
            pytest.raises(RemoteProtocolError, match="more than 100000 bytes"),
        ):
            names.list()


def test_what_is_left_over_is_not_taken_for_the_next_reply() -> None:
    line = b"registration name /x ip h port 7 type tcp\r\n"
    other = b"registration name /y ip h port 8 type tcp\r\n"
    with (
        Scripted(line + END + b"trailing", other + END) as server,
        YarpNameClient("127.0.0.1", server.port) as names,
    ):
        assert names.query("/x") == Contact("tcp", "/x", "h", 7)
        assert names.query("/y") == Contact("tcp", "/y", "h", 8)


def test_threads_do_not_mix_replies() -> None:
    service = new_service()
    for n in range(8):
        service.answer_text(f"register /{n} tcp h {n + 1}")
    wrong: list[object] = []

    def ask(n: int) -> None:
        for _ in range(50):
            contact = names.query(f"/{n}")
            if contact is None or contact.port != n + 1:
                wrong.append(contact)

    with serve_names(service) as server, YarpNameClient("127.0.0.1", server.port) as names:
        threads = [threading.Thread(target=ask, args=(n,)) for n in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    assert wrong == []


def test_an_old_connection_is_not_trusted(monkeypatch: pytest.MonkeyPatch) -> None:
    with serve_names() as server, YarpNameClient("127.0.0.1", server.port) as names:
        names.query("/x")
        monkeypatch.setattr(idle_lines, "IDLE", -1.0)  # a clock may not have moved
        names.query("/x")
        assert server.connections == 2


def test_a_fork_does_not_share_a_dialogue(monkeypatch: pytest.MonkeyPatch) -> None:
    with serve_names() as server, YarpNameClient("127.0.0.1", server.port) as names:
        names.query("/x")
        monkeypatch.setattr(os, "getpid", lambda: 1)
        names.query("/x")
        assert server.connections == 2


def test_alive() -> None:
    with serve_names() as server, YarpNameClient("127.0.0.1", server.port) as names:
        assert names.alive()


def test_text_over_several_lines_is_one_bottle() -> None:
    answer = b'Welcome admin\r\n"a\r\nb" c\r\n<ACK>\r\n'
    with Scripted(answer) as server, YarpNameClient("127.0.0.1", server.port) as names:
        assert names.request(["x"]) == Bottle(["a\nb", "c"])


def test_a_new_connection_is_prepared_first() -> None:
    prepared = []

    def prepare(connection: socket.socket) -> None:
        prepared.append(connection)
        connection.sendall(b"key!")

    reply = b"registration name /x ip h port 7 type tcp\r\n" + END
    with Scripted(reply) as server:
        names = YarpNameClient("127.0.0.1", server.port, prepare=prepare)
        assert names.query("/x") == Contact("tcp", "/x", "h", 7)
        names.close()
    assert len(prepared) == 1
    assert server.heard.startswith(b"key!")


def test_a_failed_preparation_is_told() -> None:
    def refuse(connection: socket.socket) -> None:
        raise RemoteProtocolError("compare auth.conf")

    with Scripted(END) as server, pytest.raises(NoNameServer, match=r"compare auth\.conf"):
        YarpNameClient("127.0.0.1", server.port, prepare=refuse).query("/x")


def test_which_name_server_has_to_be_said() -> None:
    with pytest.raises(TypeError, match=r"YarpNameClient\(host, port\)"):
        YarpNameClient()
