"""Programs at servers: their lines, their end, and servers that vanish."""

import signal
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from support.lasted import lasted
from support.wait import HANG, wait_until

import yarpy
from yarpy import Bottle
from yarpy.errors import LocalProtocolError, RemoteError, Timeout, UnknownName
from yarpy.kits.launch.application.application import Application, Module
from yarpy.kits.launch.run.server import RunServer
from yarpy.kits.launch.supervise import process, remote
from yarpy.kits.launch.supervise.remote import RemoteHandle, RemoteRunner
from yarpy.kits.launch.supervise.runner import Program
from yarpy.kits.launch.supervise.supervisor import Supervisor
from yarpy.port.connect import connecting
from yarpy.port.keep import log_sender

pytestmark = pytest.mark.skipif(not process.known(), reason="this system has no /proc to look at")

Serve = Callable[[], RunServer]
DEAF = "trap '' TERM; echo ready; while :; do sleep 0.05; done"


@pytest.fixture
def serve(network: yarpy.LocalNames, tmp_path: Path) -> Iterator[Serve]:
    """Make servers called /node, one after the other; what they started ends with the test."""
    made: list[RunServer] = []

    def make() -> RunServer:
        made.append(RunServer("/node", folder=tmp_path, names=network))
        return made[-1]

    yield make
    trees = [one.process_tree for server in made for one in server.programs]
    for server in made:
        if not server._closing.is_set():
            server.close()
    for process_tree in trees:
        while process_tree.members():
            process_tree.signal(signal.SIGKILL)


class Started:
    def __init__(self, runner: RemoteRunner, *command: str, name: str = "p") -> None:
        self.lines: list[str] = []
        self.ends: list[int | None] = []
        self.handle: RemoteHandle = runner.start(
            Program(name, command), self.lines.append, self.ends.append
        )

    def end(self) -> int | None:
        wait_until(lambda: self.ends)
        return self.ends[0]


@pytest.fixture
def runner(network: yarpy.LocalNames) -> Iterator[RemoteRunner]:
    with RemoteRunner("/node", "app one", grace=0.3, names=network) as runner:
        yield runner


def test_lines_come_before_the_end_and_its_code(serve: Serve, runner: RemoteRunner) -> None:
    server = serve()
    started = Started(runner, "sh", "-c", "echo one; echo two; exit 3")
    assert started.handle.pid > 0 and started.handle.port.name.startswith("/up/node/app_one:p/")
    assert started.end() == 3 and started.lines == ["one", "two"]
    assert started.handle.state == "ended" and started.handle.wait(1.0) == 3
    assert server.programs == []


def test_one_that_ends_before_its_server_has_connected_is_heard(
    serve: Serve, runner: RemoteRunner, monkeypatch: pytest.MonkeyPatch
) -> None:
    ended = threading.Event()
    finish = RemoteHandle.finish

    def finish_and_tell(handle: RemoteHandle, code: int | None) -> None:
        finish(handle, code)
        ended.set()

    def connect_late(*arguments: Any) -> Any:
        assert ended.wait(HANG)
        return connecting.connect(*arguments)

    monkeypatch.setattr(RemoteHandle, "finish", finish_and_tell)
    monkeypatch.setattr(log_sender, "connecting", SimpleNamespace(connect=connect_late))
    serve()
    started = Started(runner, "sh", "-c", "echo last words; exit 3")
    assert started.end() == 3 and started.lines == ["last words"]


def test_it_ends_when_it_is_asked_to_and_the_deaf_are_killed(
    serve: Serve, runner: RemoteRunner
) -> None:
    serve()
    willing = Started(runner, "sleep", "600")
    deaf = Started(runner, "sh", "-c", DEAF, name="q")
    wait_until(lambda: deaf.lines == ["ready"])
    for one in (willing, deaf):
        one.handle.terminate()
    assert willing.end() == -signal.SIGTERM and deaf.end() == -signal.SIGKILL
    willing.handle.terminate()  # it is over


def test_a_server_that_vanishes_and_comes_back(serve: Serve, runner: RemoteRunner) -> None:
    server = serve()
    started = Started(runner, "sleep", "600")
    server.close()
    wait_until(lambda: started.handle.state == "unknown")
    assert "/node does not answer" in started.handle.detail
    started.handle.terminate()  # the signal waits for the server
    assert started.ends == []
    serve()
    assert started.end() == -signal.SIGTERM, "nobody knows, but it was asked to"


def test_a_program_that_ends_at_another_server_than_its_first(
    serve: Serve, runner: RemoteRunner
) -> None:
    server = serve()
    started = Started(runner, "sleep", "600")
    server.close()
    wait_until(lambda: started.handle.state == "unknown")
    again = serve()
    wait_until(lambda: started.handle.state == "running")
    again.programs[0].process_tree.signal(signal.SIGKILL)
    assert started.end() is None, "it is nobody's child any more"


def test_what_an_earlier_up_has_left_is_not_started_twice(
    serve: Serve, runner: RemoteRunner, network: yarpy.LocalNames
) -> None:
    server = serve()
    first = Started(runner, "sleep", "600")
    with pytest.raises(LocalProtocolError, match="app_one:p runs at /node already: --replace"):
        Started(runner, "sleep", "600")
    with RemoteRunner("/node", "app one", grace=5.0, replace=True, names=network) as replacing:
        second = Started(replacing, "sleep", "600")
        assert second.handle.pid != first.handle.pid
        wait_until(lambda: len(server.programs) == 1)  # it looks for those that have ended
        second.handle.terminate()
        assert second.end() == -signal.SIGTERM


def test_one_that_is_closed_asks_its_server_no_more(
    serve: Serve, network: yarpy.LocalNames
) -> None:
    server = serve()
    with RemoteRunner("/node", "app one", grace=0.3, names=network) as runner:
        started = Started(runner, "sleep", "600")
        server.close()
        wait_until(lambda: started.handle.state == "unknown")
        started.handle.terminate()  # waits for the server
        assert network.list("/up/node")
    assert network.list("/up/node") == []
    words = ("programs at /node", "ends app_one:p")
    wait_until(lambda: not [one for one in threading.enumerate() if one.name.endswith(words)])


def test_what_is_not_started_is_an_error(serve: Serve, runner: RemoteRunner) -> None:
    with pytest.raises(UnknownName, match="/node"):
        Started(runner, "sleep", "600")
    serve()
    with pytest.raises(RemoteError, match="no-such-program"):
        Started(runner, "no-such-program")
    with pytest.raises(LocalProtocolError, match="which has a quote"):
        Started(runner, "echo", 'a"b')


class Cpp:
    """The answers of C++ yarprun, which tells no codes."""

    def __init__(self, network: yarpy.LocalNames) -> None:
        self.running: set[str] = set()
        self.asked: list[str] = []
        self.slow = threading.Event()
        self.slow.set()
        self.server = yarpy.RpcServer("/node", self.answer, names=network)

    def answer(self, message: yarpy.Message) -> Any:
        request = message.as_(Bottle)
        word, tag = request[0][0], request[0][1] if len(request[0]) > 1 else ""
        self.asked.append(word)
        if word == "cmd":
            self.running.add(request.find("as"))
            self.slow.wait(HANG)
            return [7, "STARTED\n"]
        if word == "ps":
            return [
                Bottle([["pid", 7], ["tag", one], ["status", "running"]]) for one in self.running
            ]
        if word == "kill":
            self.running.discard(tag)
            return ["kill OK"]
        return ["running" if tag in self.running else "not running"]


def test_nobody_knows_how_a_program_of_cpp_has_ended(
    runner: RemoteRunner, network: yarpy.LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(remote, "_TELLING", 0.1)  # nobody tells any
    cpp = Cpp(network)
    with cpp.server:
        started = Started(runner, "sleep", "600")
        assert started.handle.pid == 7 and started.handle.state == "running"
        cpp.running.clear()
        assert started.end() is None


def test_a_start_that_is_never_answered_leaves_nothing(
    runner: RemoteRunner, network: yarpy.LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(remote, "STARTING", 1.0)  # the server is reached by then
    cpp = Cpp(network)
    cpp.slow.clear()
    with cpp.server:
        with pytest.raises(Timeout):
            Started(runner, "sleep", "600")
        cpp.slow.set()
        wait_until(lambda: not cpp.running)
        assert "kill" in cpp.asked


def test_a_start_that_was_never_answered_is_tried_again(
    runner: RemoteRunner, network: yarpy.LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What came of the first try ends, and what came of the second one does not."""
    cpp = Cpp(network)
    cpp.slow.clear()
    with cpp.server:
        with monkeypatch.context() as patch:
            patch.setattr(remote, "STARTING", 1.0)
            with pytest.raises(Timeout):
                Started(runner, "sleep", "600")
        cpp.slow.set()
        started = Started(runner, "sleep", "600")
        assert not [one for one in threading.enumerate() if one.name.startswith("yarpy abandons")]
        assert cpp.running == {"app_one:p"} and started.ends == []
        assert cpp.asked.index("kill") < len(cpp.asked) - 1 - cpp.asked[::-1].index("cmd")


def test_a_supervisor_says_what_it_does_not_know(
    serve: Serve, runner: RemoteRunner, network: yarpy.LocalNames
) -> None:
    server = serve()
    module = Module("far", "sleep", words=("sleep", "600"), node="/node")
    running = Supervisor(
        Application("app", modules=[module]), runners=lambda node: runner, grace=0.3, names=network
    )
    running.start()
    wait_until(lambda: running.units["far"].state == "running")
    server.programs[0].process_tree.signal(signal.SIGKILL)
    killed = time.monotonic()
    wait_until(lambda: running.units["far"].restarts == 1)
    assert lasted(killed) < 30
    wait_until(lambda: running.units["far"].state == "running")
    server.close()
    wait_until(lambda: running.status()["programs"][0]["state"] == "unknown")
    assert "/node does not answer" in running.status()["programs"][0]["detail"]
    serve()
    wait_until(lambda: running.status()["programs"][0]["state"] == "running")
    assert running.stop() == [] and running.units["far"].state == "stopped"
