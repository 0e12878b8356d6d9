"""The parameter server of ZeroMQ: what it answers, what it tells, and a client of the original."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.peer import brings
from support.port import free_block
from support.process import Process
from support.wait import HANG
from support.wrapyfi_venv import prepare

zmq = pytest.importorskip("zmq", reason="needs pyzmq (pip install pyzmq)")

from wrapyfi.middlewares._parameters import (  # type: ignore[import-not-found]  # noqa: E402
    Parameters,
    ZeroMQMiddlewareParamServer,
)
from wrapyfi.standalone import (  # type: ignore[import-not-found]  # noqa: E402
    zeromq_param_server as program,
)

SOURCE = Path(__file__).parents[2] / "compat" / "wrapyfi" / "src"
UNKNOWN = "error:::parameter does not exist"
MALFORMED = "error:::malformed request"


def test_answers() -> None:
    """Those that the original gives, in the order in which they were asked there."""
    server = Parameters()
    for request, answer in (
        ("get WRAPYFI_ACTIVE", "True"),
        ("set /foo/bar/42", "success:::/foo"),
        ("set /foo/baz/q/1", "success:::/foo/baz"),
        ("get /foo/bar", "42"),
        ("read /foo", "success:::/foo"),
        ("read /other", UNKNOWN),
        ("delete /foo/bar", "success:::/foo"),
        ("delete /foo/bar", UNKNOWN),
        ("delete foo", MALFORMED),
        ("get /foo/bar", UNKNOWN),
        ("set nothing", MALFORMED),
        ("bla", "error:::invalid request"),
        ("", "error:::invalid request"),
    ):
        assert server.answer(request) == answer, request
    assert [*server.told("/foo")] == [[b"/foo/baz", b"q", b"1"]]
    assert [b"", b"WRAPYFI_ACTIVE", b"True"] in [*server.told()]


def test_nested_dicts() -> None:
    """As the original's functions of these names."""
    topics: dict[str, object] = {}
    for line in ("/foo/bar/42", "/foo/baz/q/1", "/foo/bar/43"):
        assert program.parse_prefix(line, topics) is topics
    foo = {"bar": {"": "43"}, "baz": {"q": {"": "1"}}}
    assert topics == {"": {"foo": foo}}
    assert program.access_nested_dict(topics, ["", "foo"]) == foo
    assert program.reverse_parse_prefix(topics, "set ") == ["set /foo/bar/43", "set /foo/baz/q/1"]


@pytest.fixture
def numbers() -> Iterator[dict[str, int]]:
    """A server in this program, and where it is."""
    first = free_block(3)
    found = {"pub": first, "sub": first + 1, "reqrep": first + 2}
    places = {f"param_{name}_address": f"tcp://127.0.0.1:{n}" for name, n in found.items()}
    ZeroMQMiddlewareParamServer.activate(**places)
    yield found
    ZeroMQMiddlewareParamServer.deinit()


def test_requests_and_topics(numbers: dict[str, int]) -> None:
    context = zmq.Context()
    try:
        ask, told, wake = (context.socket(kind) for kind in (zmq.REQ, zmq.SUB, zmq.PUB))
        ask.connect(f"tcp://127.0.0.1:{numbers['reqrep']}")
        told.connect(f"tcp://127.0.0.1:{numbers['pub']}")
        wake.connect(f"tcp://127.0.0.1:{numbers['sub']}")
        ask.send_string("set /robot/speed/3")
        assert ask.poll(HANG * 1000) and ask.recv_string() == "success:::/robot"
        told.subscribe("/robot")
        for _ in range(3):  # again and again
            assert told.poll(HANG * 1000) and told.recv_multipart() == [b"/robot", b"speed", b"3"]
        told.unsubscribe("/robot")
        # With the subscription it ends to be told; the server lives.
        ask.send_string("get /robot/speed")
        assert ask.poll(HANG * 1000) and ask.recv_string() == "3"
        with pytest.raises(OSError, match="another one may be there"):
            type.__call__(
                ZeroMQMiddlewareParamServer,
                {"param_reqrep_address": f"tcp://127.0.0.1:{numbers['reqrep']}"},
            )
    finally:
        context.destroy(linger=0)


@pytest.fixture(scope="module")
@brings("wrapyfi")
def python() -> Path:
    return prepare() / "bin" / "python"


def test_a_client_of_the_original(python: Path, numbers: dict[str, int]) -> None:
    options = [word for name, n in numbers.items() for word in (f"--param_{name}_port", str(n))]
    command = ["-W", "ignore", "-u", "-m", "wrapyfi.standalone.zeromq_param_server"]
    clean = {k: v for k, v in os.environ.items() if not k.startswith(("WRAPYFI", "PYTHON"))}
    here = {**clean, "PYTHONPATH": os.pathsep.join((str(SOURCE), str(SOURCE.parents[2] / "src")))}
    said = []
    for interpreter, environment in ((python, clean), (sys.executable, here)):
        with Process(
            [interpreter, *command, *options, "--role", "client"], env=environment
        ) as client:
            client.write("set /foo/bar/42\n")
            client.wait_line(r"^\['set /foo/bar/42'\]", timeout=HANG, stream="out")
            client.write("get /foo/bar\n")
            client.wait_line(r"from server: 42$", timeout=HANG, stream="out")
            client.write("delete /foo/bar\n")
            client.wait_line(r"from server: success:::/foo$", timeout=HANG, count=2, stream="out")
            said.append(next(line for _, line in client.lines if line.startswith("{")))
    assert said[0] == said[1] == '{"/foo": {"bar": {"": "42"}}}'
