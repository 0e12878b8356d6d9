"""The server: every request of C++ yarprun, its end, and that of its programs."""

import signal
import struct
import sys
import threading
from pathlib import Path

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.errors import AddressError, RemoteError
from yarpy.kits.launch.run.client import RunClient
from yarpy.kits.launch.supervise import process
from yarpy.nameserver.local import LocalNames

pytestmark = pytest.mark.skipif(not process.known(), reason="this system has no /proc to look at")


def ask(node: RunClient, text: str) -> object:
    return node._client.call(yarpy.Bottle.from_text(text))


def test_the_answers_of_yarprun(node: RunClient) -> None:
    pid, text = ask(node, '(cmd "sleep 60") (as tag1) (env "FOO=bar")')
    assert text == f"STARTED: server=/node alias=tag1 cmd=sleep 60 pid={pid}\n"
    assert ask(node, "(isrunning tag1)") == ["running"]
    [row] = ask(node, "(ps)")
    assert row.to_text() == (
        f'(pid {pid}) (tag tag1) (status running) (cmd "sleep 60") (env "FOO=bar")'
    )
    assert ask(node, "(on /node) (sigterm tag1)") == ["sigterm OK"]
    wait_until(lambda: ask(node, "(isrunning tag1)") == ["not running"])
    assert ask(node, "(ps)") == []
    assert ask(node, "(sigterm tag1)") == ["sigterm FAILED"]
    assert ask(node, "(kill tag1 9)") == ["kill FAILED"]
    assert ask(node, "(killstdio x)") == ["killstdio OK"]
    assert ask(node, "(which nosuch)") == ["nosuch"]


@pytest.mark.parametrize("cmd", ["nosuch 1", '""', '\\"x'])
def test_what_cannot_be_started_says_why(node: RunClient, cmd: str) -> None:
    number, text = ask(node, f'(cmd "{cmd}") (as t)')
    assert number == -1 and text.startswith("ABORTED: server=/node alias=t cmd=")
    assert "Can't execute command because" in text
    assert ask(node, "(ps)") == []


def test_a_folder_that_is_not_there_is_the_end_of_it(node: RunClient) -> None:
    number, text = ask(node, '(cmd "sleep 60") (as t) (workdir "/no/such")')
    assert number == -1 and "working directory /no/such" in text and ask(node, "(ps)") == []


def test_what_is_not_understood_is_answered(node: RunClient) -> None:
    for text in ("(hello)", "cmd x", "1 2 3"):
        number, why = ask(node, text)
        assert number == -1 and "does not understand" in why


def test_signals_reach_everybody_with_that_tag(node: RunClient) -> None:
    for _ in range(2):
        node.start("two", ["sleep", "60"])
    assert len(node.running()) == 2
    assert ask(node, "(kill two 0)") == ask(node, "(kill two 999)") == ["kill FAILED"]
    assert node.signal("two", signal.SIGKILL)
    wait_until(lambda: not node.running())
    node.start("one", ["sleep", "60"])
    node.end_all()
    wait_until(lambda: not node.running())


def test_one_that_ignores_sigterm_and_was_stopped(node: RunClient) -> None:
    code = "import signal, time; signal.signal(15, signal.SIG_IGN); print('x', flush=True)"
    node.start("deaf", [sys.executable, "-c", f"{code}; time.sleep(600)"])
    wait_until(lambda: node.output("deaf") == ["x"])
    assert node.signal("deaf", signal.SIGTERM) and node.is_running("deaf")
    node.start("still", ["sleep", "600"])
    assert node.signal("still", signal.SIGSTOP)
    assert node.signal("still", signal.SIGTERM)
    wait_until(lambda: not node.is_running("still"))
    assert node.signal("deaf", signal.SIGKILL)
    wait_until(lambda: not node.is_running("deaf"))


def test_no_zombies(node: RunClient) -> None:
    pids = [node.start("quick", ["true"]).pid for _ in range(5)]
    wait_until(lambda: not node.running())
    wait_until(lambda: all(process.look(pid) is None for pid in pids))


def test_what_one_has_said_is_whole_as_soon_as_it_has_ended(
    node: RunClient, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also before the watch has looked again."""
    monkeypatch.setattr("yarpy.kits.launch.run.server.PERIOD", HANG)
    gate = tmp_path / "gate"
    code = f"while [ ! -e {gate} ]; do sleep 0.01; done; echo one; printf two"
    node.start("last", ["sh", "-c", code])
    gate.touch()
    wait_until(lambda: not node.is_running("last"))
    assert node.output("last") == ["one", "two"]
    assert node.output("last") == ["one", "two"]


def test_as_many_as_the_limit_says(node: RunClient, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("yarpy.kits.launch.run.server.RUN_PROGRAMS", 2)
    for tag in "ab":
        node.start(tag, ["sleep", "60"])
    with pytest.raises(RemoteError, match="2 programs already"):
        node.start("c", ["sleep", "60"])


def test_programs_go_on_and_are_found_again(serve, names: LocalNames) -> None:
    first = serve()
    with RunClient("/node", names=names) as node:
        pid = node.start("a", ["sleep", "60"]).pid
    [left] = first.close()
    assert left.entry.pid == pid and left.process_tree.leads
    serve(ends=True)
    with RunClient("/node", names=names) as node:
        assert [(one.pid, one.tag) for one in node.running()] == [(pid, "a")]
        assert node.is_running("a")


def test_programs_end_with_their_server_if_asked(serve, names: LocalNames) -> None:
    server = serve(ends=True)
    code = "import signal, time; signal.signal(15, signal.SIG_IGN); print('x', flush=True)"
    with RunClient("/node", names=names) as node:
        node.start("a", ["sleep", "60"])
        node.start("deaf", [sys.executable, "-c", f"{code}; time.sleep(600)"])
        wait_until(lambda: node.output("deaf"))
        trees = [one.process_tree for one in server.programs]
    assert server.close() == []
    assert [tree.members() for tree in trees] == [[], []]


def test_one_server_of_a_name(serve) -> None:
    serve()
    with pytest.raises(AddressError):
        serve()


def test_exit(serve, names: LocalNames) -> None:
    over = threading.Event()
    serve(on_exit=over.set)
    with RunClient("/node", names=names) as node:
        node.exit()
    assert over.wait(HANG)


def test_what_programs_say_goes_to_the_logger(serve, names: LocalNames) -> None:
    with yarpy.BufferedPort("/yarplogger", strict=True, names=names) as logger:
        serve()
        with RunClient("/node", names=names) as node:
            code = "print('one'); print('two')"
            environment = {"YARP_LOG_PROCESS_LABEL": "lab"}
            pid = node.start("a", [sys.executable, "-c", code], log="", environment=environment).pid
            header, text = logger.read(HANG).value
            assert text == "one\n"
            assert header.startswith("[/log/node/python") and header.endswith(f"[lab]/{pid}]")
            assert logger.read(HANG).value[1] == "two\n"


def test_a_wild_writer_is_kept_short(node: RunClient) -> None:
    """1 GB without a line end would fill a disk; it loses what is too fast."""
    code = "import os\nwhile True: os.write(1, b'x' * 65536)"
    node.start("wild", [sys.executable, "-c", code])
    wait_until(lambda: any("too fast" in line for line in node.output("wild")))
    assert node.signal("wild", signal.SIGKILL)
    wait_until(lambda: not node.is_running("wild"))


def test_what_computer_it_is(node: RunClient) -> None:
    """A message that is no Bottle; tests/interop/test_run.py has C++ read it."""
    from yarpy.kits.launch.run.system import described

    data = bytes(described().data)
    assert struct.unpack_from("<i", data)[0] > 0


def test_a_terminal(node: RunClient, names: LocalNames) -> None:
    started = node.start("sh", ["sh", "-c", "read x; echo you said $x"], stdio="/node")
    assert started.uuid.startswith("/node/") and started.uuid.endswith("/sh-1")
    with (
        yarpy.BufferedPort("/i", strict=True, names=names) as heard,
        yarpy.Port("/o", names=names) as typed,
    ):
        wait_until(lambda: names.query(f"{started.uuid}/stdout"))
        heard.listen_to(f"{started.uuid}/stdout")
        typed.connect(f"{started.uuid}/stdin")
        typed.write(yarpy.Bottle(["hello\n"]))
        assert heard.read(HANG).value == ["you said hello\n"]


def test_the_terminal_of_nobody(node: RunClient) -> None:
    answer = ask(node, '(cmd "sleep 60") (as t) (stdio /nobody)')
    assert answer[0] > 0 and answer[3] == -1 and "no terminal at /nobody" in answer[4]
    assert ask(node, "(stdio /node) (cmd x) (stdiouuid /u)")[0] == -1
