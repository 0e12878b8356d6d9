"""The client, with the answers of C++ yarprun (as they were recorded from 3.9)."""

import signal
from collections.abc import Iterator

import pytest

import yarpy
from yarpy.errors import AccessRefused, RemoteError, UnknownName
from yarpy.kits.launch.run.client import RunClient, Running, Started
from yarpy.nameserver.local import LocalNames

ANSWERS = {
    '(cmd "sleep 60") (as tag1) (on /cpp)': '31991 "STARTED: server=/cpp\\n"',
    '(stdio /t) (cmd "a \\"b c\\"") (as x) (on /cpp) (workdir "/w") (env "A=b;C=d") (log "/l")': (
        '7 "STARTED\\n" "/cpp/5/x-1" 8 "STARTED\\n"'
    ),
    "(cmd nosuch) (as t) (on /cpp) (log)": (
        '-1 "ABORTED: server=/cpp alias=t\\nCan\'t execute command because No such file\\n"'
    ),
    "(cmd evil) (as t) (on /cpp)": '-1 "ABORTED: evil is not among the programs of /cpp"',
    "(isrunning tag1)": "running",
    "(isrunning x)": '"not running"',
    "(isrunning tag1) (code)": "running",
    "(isrunning x) (code)": '"not running"',
    "(isrunning y) (code)": '"not running" -9',
    "(ps)": '((pid 7) (tag t) (status running) (cmd "sleep 60") (env "")) 1',
    "(kill t 9)": '"kill OK"',
    "(sigterm t)": '"sigterm FAILED"',
    "(sigtermall)": '"sigtermall OK"',
    "(which ls)": '"\\"/usr/bin/ls\\""',
    "(isrunning t) (output)": "running (one two)",
    "(isrunning x) (output)": '"not running"',
    "(exit)": '"exit OK"',
}


@pytest.fixture
def node(names: LocalNames) -> Iterator[RunClient]:
    known = {yarpy.Bottle.from_text(key).to_text(): ANSWERS[key] for key in ANSWERS}

    def answer(message: yarpy.Message) -> object:
        return yarpy.Bottle.from_text(known[message.as_(yarpy.Bottle).to_text()])

    with yarpy.RpcServer("/cpp", answer, names=names), RunClient("/cpp", names=names) as client:
        yield client


def test_starting(node: RunClient) -> None:
    assert node.start("tag1", "sleep 60") == Started(31991, "STARTED: server=/cpp")
    environment = {"A": "b", "C": "d"}
    found = node.start(
        "x", ["a", "b c"], workdir="/w", environment=environment, log="/l", stdio="/t"
    )
    assert found == Started(7, "STARTED", "/cpp/5/x-1")


def test_what_is_not_started_is_an_error(node: RunClient) -> None:
    with pytest.raises(RemoteError, match="No such file"):
        node.start("t", "nosuch", log="")
    with pytest.raises(AccessRefused, match="not among"):
        node.start("t", "evil")


def test_the_rest(node: RunClient) -> None:
    assert node.is_running("tag1") and not node.is_running("x")
    assert node.running() == [Running(7, "t", "sleep 60")]
    assert node.signal("t", 9) and not node.signal("t", signal.SIGTERM)
    node.end_all()
    assert node.which("ls") == "/usr/bin/ls" and node.output("t") == ["one", "two"]
    node.exit()


def test_cpp_keeps_no_output(node: RunClient) -> None:
    with pytest.raises(RemoteError, match=r"/cpp is C.. yarprun, .* --log"):
        node.output("x")  # a word that it does not know would silence it for good


def test_nobody_there(names: LocalNames) -> None:
    with pytest.raises(UnknownName):
        RunClient("/nobody", names=names)


def test_how_a_program_has_ended(node: RunClient) -> None:
    assert node.ending("tag1") == (True, None)
    assert node.ending("x") == (False, None), "C++ does not say"
    assert node.ending("y") == (False, -9)
