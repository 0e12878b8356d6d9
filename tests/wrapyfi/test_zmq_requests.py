"""Questions between a port and real Wrapyfi over ZeroMQ, in both roles, with no broker of ours.

Rules: Wrapyfi's server starts a broker of its own, which a client dials; there a port asks as any
client. Wrapyfi's client dials what it takes for the broker, and that may be a port.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest
from support.peer import brings
from support.port import free_block
from support.process import Process
from support.wait import HANG
from support.wrapyfi_venv import prepare

import yarpy

PROGRAM = Path(__file__).parent / "programs" / "asked.py"
ANSWER = {"sum": 7, "words": ["a", [1, 2.5]]}


@pytest.fixture(scope="module")
@brings("wrapyfi")
def wrapyfi() -> Path:
    return prepare() / "bin" / "python"


@pytest.fixture
def names() -> Iterator[yarpy.LocalNames]:
    yield yarpy.LocalNames()


def environment(**more: str) -> Mapping[str, str]:
    prefixes = ("YARP", "WRAPYFI", "PYTHON")
    clean = {k: v for k, v in os.environ.items() if not k.startswith(prefixes)}
    return {**clean, **{f"WRAPYFI_ZEROMQ_{name}": value for name, value in more.items()}}


def test_a_port_asks_a_server_of_wrapyfi(wrapyfi: Path, names: yarpy.LocalNames) -> None:
    front = free_block(2)
    env = environment(SOCKET_REQ_PORT=str(front), SOCKET_REP_PORT=str(front + 1))
    with (
        Process([wrapyfi, PROGRAM, "reply"], env=env) as server,
        yarpy.RpcClient(names=names) as ask,
    ):
        server.wait_line("ready", timeout=HANG, stream="out")
        ask.connect(f"zmq+req://127.0.0.1:{front}", timeout=HANG)
        for second in (4, 5):
            answer = ask.ask([[3], {"second": second}], HANG)
            assert json.loads(answer.as_(bytes)) == ANSWER | {"sum": 3 + second}


def test_a_client_of_wrapyfi_asks_a_port(wrapyfi: Path, names: yarpy.LocalNames) -> None:
    asked = []

    def answer(message: yarpy.Message) -> object:
        tagged, kwargs = json.loads(message.as_(bytes))
        kind, args = tagged["__wrapyfi__"]  # a tuple, which JSON has no word for
        asked.append((kind, args, kwargs))
        return {"sum": args[0] + kwargs["second"], "words": ["a", [1, 2.5]]}

    with yarpy.RpcServer("/asked", answer, names=names) as server:
        where = server.contact
        env = environment(SOCKET_IP=where.host, SOCKET_REP_PORT=str(where.port))
        with Process([wrapyfi, PROGRAM, "request"], env=env) as client:
            assert client.wait(HANG) == 0, client.stderr
            assert json.loads(client.stdout.splitlines()[-1]) == ANSWER
    assert asked == [("tuple", [3], {"second": 4})]
