"""Code of Apache's own compiler, on Apache's own library, in both roles: what thriftpy2, which
compiles nothing, does not show."""

from __future__ import annotations

import json
import subprocess
from functools import cache, partial
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from support import thrift_compiled, thrift_venv
from support.peer import brings, program
from support.port import answers, free_port
from support.thrift import GOLDEN
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits.thrift.library import load

SAID = ("compact", "framed", "http")  # of a carrier
PROTOCOLS = ("binary", "compact")
TRANSPORTS = ("buffered", "framed", "http")


@cache
def compiled() -> ModuleType:
    return load(GOLDEN / "compiled.thrift")


@pytest.fixture(scope="module")
@brings("thrift", "thrift_compiler")
def peer(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, ...]:
    """The command that runs what the compiler wrote."""
    folder = tmp_path_factory.mktemp("modules")
    command = [program("thrift"), "-r", "--gen", "py", "-out", str(folder)]
    done = subprocess.run([*command, str(GOLDEN / "compiled.thrift")], capture_output=True)
    assert done.returncode == 0, done.stderr
    where = Path(thrift_compiled.__file__)
    return (str(thrift_venv.prepare()), "-P", str(where), str(folder))


def service() -> Any:
    """What the program's own server does, as a service of ours."""
    m = compiled()
    inner = thrift_compiled.Server(m)

    def forwarded(name: str) -> Any:
        return lambda self, *arguments: getattr(inner, name)(*arguments)

    methods = {method.attribute: forwarded(name) for name, method in m.Peer._methods.items()}
    return type("Server", (m.Peer,), methods)()


@pytest.mark.parametrize("transport", TRANSPORTS)
@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_a_compiled_client(peer: tuple[str, ...], protocol: str, transport: str) -> None:
    with yarpy.RpcServer("/thrift", service(), names=yarpy.LocalNames()) as server:
        port = server.address.rpartition(":")[2]
        command = [*peer, "client", protocol, transport, port]
        done = subprocess.run(command, capture_output=True, text=True, timeout=2 * HANG)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == {
        **dict.fromkeys(("echo", "mirror", "follow", "levels"), True),
        "ping": "pong",
        "read": [True] * 3,
        "get": ["aa", ["Refused", "no", 1], ["Gone", 4, 5], [6, "ValueError: oops"]],
        "put": [None, ["Refused", "full", 5]],
        "match": False,
        "str": "ab",
        "id": 1,
        "close": (1 << 40) + 1,
        "fired": ["x", "y"],
    }


@pytest.mark.parametrize("transport", TRANSPORTS)
@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_a_compiled_server(peer: tuple[str, ...], protocol: str, transport: str) -> None:
    m, port = compiled(), free_port()
    runs = subprocess.Popen([*peer, "server", protocol, transport, str(port)])
    way = "".join(f"+{word}" for word in (protocol, transport) if word in SAID)
    try:
        wait_until(partial(answers, port), what="the server listens")
        with m.Peer.connect(f"thrift{way}://127.0.0.1:{port}", timeout=HANG) as made:
            board = thrift_compiled.board(m)
            assert made.ping() == "pong" and made.echo(board) == board
            assert made.mirror(board.tree) == board.tree
            assert made.follow(m.Chain(1, m.Chain(2))) == m.Chain(2, m.Chain(1))
            for reading in (m.Reading(number=1.5), m.Reading(cell=m.Cell(1, 2))):
                assert made.read(reading) == reading
            assert made.get("a") == "aa" and made.put("a", "v") is None
            with pytest.raises(m.Refused) as refused:
                made.get("refused")
            assert (refused.value.why, refused.value.level) == ("no", m.Level.LOW)
            with pytest.raises(m.Gone) as gone:
                made.get("gone")
            assert gone.value.where == m.Cell(4, 5)
            with pytest.raises(yarpy.RemoteProtocolError, match="Internal error"):
                made.get("broken")
            assert made.levels(m.Level.HIGH) == {m.Cell(0, 5): m.Level.HIGH}
            assert made.match(True) is False and made.str("a", "b") == "ab" and made.id(4, 3) == 1
            assert made.close_(1 << 40) == (1 << 40) + 1
            made.fire("x")
            assert made.fired() == ["x"]
    finally:
        runs.kill()
        runs.wait()


def test_a_server_over_http_that_is_gone_and_comes_back(peer: tuple[str, ...]) -> None:
    port = free_port()
    command = [*peer, "server", "compact", "http", str(port)]
    target = f"thrift+http+compact+path.peer://127.0.0.1:{port}"
    runs = subprocess.Popen(command, stderr=subprocess.DEVNULL)
    try:
        wait_until(partial(answers, port), what="the server listens")
        with compiled().Peer.connect(target, timeout=HANG) as made:
            made.fire("x")
            made.fire("y")
            assert made.fired() == ["x", "y"]
            runs.kill()
            runs.wait()
            with pytest.raises(yarpy.LinkClosed, match="fired"):
                made.fired()
            runs = subprocess.Popen(command, stderr=subprocess.DEVNULL)
            wait_until(partial(answers, port), what="the server listens again")
            assert made.fired() == []
        with (
            compiled().Peer.connect(target.replace("+compact", ""), timeout=HANG) as made,
            pytest.raises(yarpy.LinkClosed, match="went away during the call"),
        ):
            made.ping()  # in the other protocol, of which it makes an exception
    finally:
        runs.kill()
        runs.wait()
