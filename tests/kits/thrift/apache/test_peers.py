"""Apache's own library and thriftpy2 at the other end, in both roles, over each protocol."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from support import thrift_venv
from support.peer import brings
from support.port import answers, free_port
from support.thrift_module import ROWS, apache, everything, service
from support.wait import HANG, wait_until

import yarpy

SUPPORT = Path(thrift_venv.__file__).parent
SAID = ("compact", "framed", "http")  # of a carrier
WAYS = [(p, t) for p in ("binary", "compact") for t in ("buffered", "framed", "http")]


@pytest.fixture
@brings("thrift")
def python() -> str:
    """A Python that has both libraries."""
    return str(thrift_venv.prepare())


def said(*command: str) -> str:
    done = subprocess.run(command, capture_output=True, text=True, timeout=2 * HANG)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_recorded_bytes_are_those_of_the_library(python: str) -> None:
    rows = json.loads(said(python, "-P", str(SUPPORT / "thrift_apache.py")))
    assert {row["name"]: row for row in rows} == ROWS


@pytest.mark.parametrize(("protocol", "transport"), WAYS)
def test_a_client_of_thriftpy2(python: str, protocol: str, transport: str) -> None:
    names = yarpy.LocalNames()
    with yarpy.RpcServer("/thrift", service(), names=names) as server:
        port = server.address.rpartition(":")[2]
        peer = str(SUPPORT / "thriftpy2_peer.py")
        heard = json.loads(said(python, "-P", peer, "client", protocol, transport, port))
    assert heard == {
        "ping": "pong",
        "add": [3, 11],
        "is_on": False,
        "nothing": None,
        "echo": True,
        "numbers": 249_750.0,
        "fail": [
            *("x", "Bad(code=5, message='bad')", "Worse(why='worse')"),
            "TApplicationException(type=6, message='no')",
            "TApplicationException(type=6, message='ValueError: oops')",
        ],
        "missing": 5,
    }


@pytest.fixture(params=WAYS, ids="-".join)
def target(request: pytest.FixtureRequest, python: str) -> Iterator[str]:
    """A server of thriftpy2."""
    protocol, transport = request.param
    port = free_port()
    command = [python, "-P", str(SUPPORT / "thriftpy2_peer.py"), "server"]
    peer = subprocess.Popen([*command, protocol, transport, str(port)])
    try:
        wait_until(lambda: answers(port), what="the server listens")
        way = "".join(f"+{word}" for word in (protocol, transport) if word in SAID)
        yield f"thrift{way}://127.0.0.1:{port}"
    finally:
        peer.kill()
        peer.wait()


def test_a_server_of_thriftpy2(target: str) -> None:
    m = apache()
    with m.Test.connect(target, timeout=HANG) as client:
        assert client.ping() == "pong" and client.add(1) == 11 and client.is_on(True) is False
        assert client.nothing() is None and client.echo(everything()) == everything()
        client.fire("x")
        assert client.fail(0) == "x"
        with pytest.raises(m.Bad, match="bad"):
            client.fail(1)
        with pytest.raises(m.Worse, match="worse"):
            client.fail(2)
        with pytest.raises(yarpy.RemoteProtocolError, match="missing"):
            client.missing()
        assert client.numbers(1000).sum() == 249_750


def test_a_server_that_does_not_answer_in_time(target: str) -> None:
    with (
        apache().Test.connect(target) as client,
        pytest.raises(yarpy.Timeout, match=r"fail: no answer within 0\.2 s"),
    ):
        client.timeout = 0.2
        client.fail(9)
