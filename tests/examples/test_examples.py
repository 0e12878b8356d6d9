"""Every example, run as its first lines say: what it prints, how it ends, and how long it is."""

import ast
import os
import re
import signal
import sys
from collections.abc import Iterator, Mapping
from contextlib import ExitStack
from pathlib import Path

import pytest
from support import fork_server
from support.process import Process
from support.wait import HANG, wait_until

import yarpy

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "examples"
LONGEST = 60
LONGER = {"open_robot.py": 85}  # it is four programs in one

# What an example that needs no server prints, in this order, among other things.
ALONE = {
    "asyncio_reader.py": [r"/left got .*'four', 0.* from /right", r"messages: \[2, 3\]"],
    "images.py": [
        r"Image\(320 x 240, 'rgb', quantum=8\) at 0.000 s, \(240, 320, 3\), .*\[119\.5 +19\.5\]",
        r"at 0.067 s, .*\[119\.5 +39\.5\]",
        r"Image\(5 x 2, 'dec', quantum=8\)",
        r"Image\(320 x 240, 'mono', quantum=1\)",
    ],
    "no_server.py": [r"by a name that only", r"to .*, without any name", r"<ping>", r"^2 4 6$"],
    "realtime.py": [r"^alone +mean", r"busy thread +mean", r"realtime\(\) +mean", r"SCHED_FIFO"],
    "robot_head.py": [
        r"^<ControlBoard /robot/head, 3 joints> \['pitch', 'roll', 'yaw'\]$",
        r"^it went to \[0.0, 0.0, 20.0\]$",
        r"^and then to \[30.0, -5.0, 20.0\] - its limits are \(-30.0, 30.0\)$",
    ],
    "several_carriers.py": [
        r"^tcp +Bottle\(\['hello', 1, 2.5, Bottle\(\['nested', b'.*'\]\)\]\) over tcp$",
        r"^fast_tcp +Bottle.* over fast_tcp$",
        r"^udp +Bottle.* over udp$",
        r"^mcast +(Bottle.* over mcast|not here: .*)$",
        r"^text +Bottle.* over text$",
        r"^text_ack +Bottle.* over text_ack$",
        r"^unix_stream +(Bottle.* over unix_stream|not here: .*)$",
        r"^unix_stream\+ack +(Bottle.* over unix_stream\+ack|not here: .*)$",
        r"^local +\['hello', .* over local$",
        r'no carrier "tpc": did you mean "tcp"\?',
    ],
    "stamps_and_drops.py": [r"were skipped", r"^written +1000$", r"replaced at the reader \d+"],
}
TOGETHER = {
    "channelling.py",
    "forwarding.py",
    "listener.py",
    "mirroring.py",
    "module.py",
    "netcat.sh",
    "open_robot.py",  # run in tests/interop/test_open_robot.py
    "rpc_client.py",
    "rpc_server.py",
    "talker.py",
    "thrift_client.py",
    "thrift_server.py",
}
FILES = sorted(path for path in EXAMPLES.iterdir() if path.suffix in (".py", ".sh"))


def start(name: str, *arguments: str, **variables: str) -> Process:
    """Start an example in an environment that knows no name server but what is given."""
    return Process(
        [sys.executable, EXAMPLES / name, *arguments],
        env=environment(variables),
        cwd=ROOT,
        start=fork_server.start,
    )


def environment(variables: Mapping[str, str]) -> dict[str, str]:
    clean = {k: v for k, v in os.environ.items() if not k.startswith(("YARP", "XDG_"))}
    return {**clean, "YARP_CONFIG_HOME": str(ROOT / "no such directory"), **variables}


def interrupt(process: Process) -> None:
    """Ctrl-C: the program ends in good order, and says nothing about it."""
    process.signal(signal.SIGINT)
    assert process.wait() == 0, process.stderr
    assert "Traceback" not in process.stderr, process.stderr


@pytest.fixture
def server() -> Iterator[yarpy.NameServer]:
    with yarpy.NameServer() as server:
        yield server


def test_every_example_is_run_here():
    assert {path.name for path in FILES} == TOGETHER | ALONE.keys()


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_it_is_short_and_says_how_to_run_it(path: Path):
    text = path.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= LONGER.get(path.name, LONGEST)
    words = ast.get_docstring(ast.parse(text)) if path.suffix == ".py" else text
    assert words
    assert f"examples/{path.name}" in words


@pytest.mark.parametrize("name", ALONE)
def test_alone(name: str):
    with start(name) as process:
        assert process.wait() == 0, process.stderr
        rest = process.stdout.splitlines()
        for pattern in ALONE[name]:
            places = [number for number, line in enumerate(rest) if re.search(pattern, line)]
            assert places, f"no line {pattern!r} at its place in:\n{process.stdout}"
            del rest[: places[0] + 1]
        assert "Traceback" not in process.stderr, process.stderr
        assert "did not take all" not in process.stderr, process.stderr


@pytest.mark.parametrize("name", ["channelling.py", "forwarding.py", "mirroring.py"])
def test_one_that_wants_a_word_says_so(name: str):
    with start(name) as process:
        assert process.wait() == 1
    assert f"python examples/{name} " in process.stderr and "Traceback" not in process.stderr


def test_talker_and_listener(server: yarpy.NameServer):
    pattern = r"^/talker Bottle\(\[\d+, 'hello'\]\) Stamp\(count=\d+, time=\d"
    with start("listener.py", **server.environment) as listener:
        assert yarpy.wait_for("/listener", timeout=HANG)  # it waits for the talker now
        with start("talker.py", **server.environment) as talker:
            listener.wait_line(pattern)
            talker.kill()
        before = len(listener.stdout.splitlines())
        with start("talker.py", **server.environment) as talker:
            listener.wait_line(pattern, count=before + 2)
            interrupt(talker)
            assert yarpy.query("/talker") is None
        interrupt(listener)


def test_talker_and_listener_end_by_themselves(server: yarpy.NameServer):
    with start("listener.py", "2", **server.environment) as listener:
        assert yarpy.wait_for("/listener", timeout=HANG)  # it waits for the talker now
        with start("talker.py", "10", **server.environment) as talker:
            assert listener.wait() == 0, listener.stderr
            assert talker.wait() == 0, talker.stderr
        assert len(listener.stdout.splitlines()) == 2


def test_rpc(server: yarpy.NameServer):
    with start("rpc_server.py", **server.environment) as calculator:
        with start("rpc_client.py", **server.environment) as client:
            assert client.wait() == 0, client.stderr
            assert client.stdout.splitlines() == [
                "add 1 2 3   -> 6",
                "set speed 4 -> ok",
                "get speed   -> 4",
                "get other   -> nobody has set other",
            ]
        interrupt(calculator)


def test_module(server: yarpy.NameServer):
    with start("module.py", "--name", "/tock", "--rate", "50", **server.environment) as module:
        assert yarpy.wait_for("/tock/quit", timeout=HANG)
        with yarpy.RpcClient("/tock/rpc") as client:
            wait_until(lambda: client.call("count")[0] > 0)
            assert client.call("rate", 100) == ["ok"]
            assert client.call("rate", 0)[0] == "fail"
        interrupt(module)
        assert yarpy.query("/tock/out") is None


@pytest.mark.parametrize(
    ("name", "background", "last", "pattern"),
    [
        (
            "mirroring.py",
            [["publish", "hello"]],
            ["listen"],
            r"^\{'text': 'hello', 'said by': 'publish'\}$",
        ),
        (
            "mirroring.py",
            [["serve"]],
            ["call", "hello"],
            r"^\{'text': 'HELLO', 'said by': 'serve'\}$",
        ),
        ("forwarding.py", [["start"], ["middle"]], ["end"], r"^message \d+, handed on$"),
        (
            "channelling.py",
            [["publish"]],
            ["listen"],
            r"^\(48, 64, 3\) Sound\(1 channels, 1600 samples, .*\) \{'elbow': \d",
        ),
    ],
)
def test_decorators(
    server: yarpy.NameServer, name: str, background: list[list[str]], last: list[str], pattern: str
):
    assert len((EXAMPLES / name).read_text().splitlines()) <= 40
    with ExitStack() as stack:
        for arguments in background:
            stack.enter_context(start(name, *arguments, **server.environment))
        with start(name, *last, **server.environment) as process:
            assert process.wait(HANG) == 0, process.stderr
            assert re.search(pattern, process.stdout, re.M), process.stdout
            assert process.stderr == ""


@pytest.mark.peer("nc")
def test_netcat(server: yarpy.NameServer):
    with (
        start("talker.py", **server.environment) as talker,
        start("rpc_server.py", **server.environment) as calculator,
    ):
        addresses = [process.wait_line(r"listens at (\S+)")[1] for process in (talker, calculator)]
        with Process(["sh", EXAMPLES / "netcat.sh", *addresses]) as script:
            assert script.wait() == 0, script.stderr
            said = script.stdout.replace("\r", "").splitlines()
        assert said[0].startswith("---")
        assert said[1] == "* Error. Protocol not found."
        assert "* Goodbye." in said
        welcome = said.index("Welcome test")
        assert said[welcome + 1 : welcome + 3] == ["3", "[ok]"]
        assert f"This is /talker at tcp://{addresses[0]}/" in said
        assert "[ver] 1 2 3" in said
        assert re.fullmatch(r"D \d+ \d+\.\d+", said[-2])
        assert re.fullmatch(r"\d+ hello", said[-1])


def test_page_is_quoted_as_it_is():
    """The browser's side of a WebSocket, which a browser runs in tests/interop/test_browser.py."""
    page = (EXAMPLES / "websocket.html").read_text()
    assert len(page.splitlines()) <= 40
    assert f"```html\n{page}```" in (ROOT / "docs" / "web.md").read_text()


def test_thrift(server: yarpy.NameServer):
    with start("thrift_server.py", **server.environment) as serving:
        serving.wait_line(r"^/arm/rpc listens at http://")
        with start("thrift_client.py", **server.environment) as client:
            assert client.wait() == 0, client.stderr
            lines = client.stdout.splitlines()
        assert lines[0] == "True False 5"
        assert lines[1].startswith("Status(mode=<Mode.TORQUE: 5>, pose=Pose(x=0.0, y=0.0, frame=")
        assert lines[1].endswith("angles=[0.0, 30.0, 0.0, 0.0], counts={})")
        assert lines[2].count("Pose(") == 3
        assert lines[3:] == [
            "[2. 5.] {'e': 1, 'h': 1, 'l': 2, 'o': 1} {1, 3}",
            "hello hello b'cba' Vector([3.0])",
            "move.joint: expected an integer, got 'one'",
            "the server refuses path: a path has at least two steps",
        ]
        serving.wait_line("^stopped$")
        interrupt(serving)
