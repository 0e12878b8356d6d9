"""C++ yarprun, yarpmanager-console, yarplogger-console and `yarpy run --server`, both ways.

The server of the C++ wheel (3.5) cannot be met: it ends with "Can't open pipe" before it opens its
port, and its manager starts nothing on its own computer, for the same reason.
"""

import os
import signal
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.cpp import CppYarp
from support.process import Process
from support.wait import HANG, wait_until

import yarpy
from yarpy.errors import RemoteError
from yarpy.kits.launch.application.load import load
from yarpy.kits.launch.run.client import RunClient, Running
from yarpy.kits.launch.run.server import RunServer
from yarpy.names.client import YarpNameClient

pytestmark = pytest.mark.peer("cpp")

LATER = "C++ YARP 3.5 cannot be met: YARPY_CPP_YARP says where a later one is"


@pytest.fixture
def server(network: CppYarp, tmp_path: Path) -> Iterator[RunServer]:
    with RunServer("/nodeA", folder=tmp_path, ends=True) as made:
        yield made


def test_every_option(network: CppYarp, server: RunServer) -> None:
    def say(*words: str) -> tuple[int, str]:
        done = network.run("--on", "/nodeA", *words, program="yarprun")
        return done.returncode, done.stdout + done.stderr

    code, text = say("--as", "t1", "--cmd", "sleep 600", "--env", "FOO=bar")
    assert code == 0 and "STARTED: server=/nodeA alias=t1 cmd=sleep 600 pid=" in text
    code, text = say("--ps")
    assert code == 0 and '(tag t1) (status running) (cmd "sleep 600") (env "FOO=bar")' in text
    assert say("--isrunning", "t1")[0] == 0
    code, text = say("--sysinfo")
    assert code == 0 and "Processor cores" in text and "User home dir  : /" in text
    assert "/sh" in say("--which", "sh")[1]
    code, text = say("--as", "t2", "--cmd", "nosuch 1")
    assert code == 2 and "ABORTED: server=/nodeA alias=t2" in text
    assert say("--kill", "t1", "9")[0] == 0
    _until(lambda: say("--isrunning", "t1")[0] == 2)
    assert "sigterm FAILED" in say("--sigterm", "t1")[1]


def test_what_a_terminal_of_cpp_reads_and_writes(network: CppYarp, server: RunServer) -> None:
    """The messages of `yarprun --readwrite`, which in the wheel ends without a word."""
    with RunClient("/nodeA") as node:
        uuid = node.start("sh", ["sh"], stdio="/nodeA").uuid
    yarpy.wait_for(f"{uuid}/stdin", timeout=HANG)
    with (
        network.popen("read", f"{uuid}/stdio:i", f"{uuid}/stdout") as heard,
        network.popen("write", f"{uuid}/stdio:o", f"{uuid}/stdin") as typed,
    ):
        _until(lambda: yarpy.exists(f"{uuid}/stdout", f"{uuid}/stdio:i"))
        _until(lambda: yarpy.exists(f"{uuid}/stdio:o", f"{uuid}/stdin"))
        typed.write_line(r'"echo $((40 + 2))\n"')
        heard.wait_line(r"42")


def test_the_server_of_cpp(network: CppYarp, tmp_path: Path) -> None:
    if network.version < (3, 9):
        pytest.skip(LATER)
    with network.popen("--server", "/nodeX", program="yarprun") as server:
        yarpy.wait_for("/nodeX", timeout=HANG)
        with RunClient("/nodeX") as node:
            started = node.start(
                "t1",
                ["sh", "-c", "echo $FOO > said; exec sleep 600"],
                workdir=str(tmp_path),
                environment={"FOO": "a b"},
            )
            assert node.running() == [
                Running(started.pid, "t1", 'sh -c "echo $FOO > said; exec sleep 600"', "FOO=a b")
            ]
            assert node.is_running("t1") and not node.is_running("t2")
            _until(lambda: (tmp_path / "said").exists() and (tmp_path / "said").read_text())
            assert (tmp_path / "said").read_text() == "a b\n"
            with pytest.raises(RemoteError, match="No such file"):
                node.start("t2", ["nosuch"])
            assert node.which("sh").endswith("/sh")
            with pytest.raises(RemoteError, match="keeps no output"):
                node.output("t1")
            assert node.signal("t1", signal.SIGTERM)
            _until(lambda: not node.is_running("t1"))
            assert not node.signal("t1", signal.SIGKILL)
            node.start("t3", ["sleep", "600"])
            node.end_all()
            _until(lambda: not node.running())
            node.exit()
        assert server.wait(HANG) == 0


PROGRAM = """
import logging, sys, yarpy
port = yarpy.Port("/arm")
logging.getLogger("arm").warning('joint 3 is "hot"')
sys.stdin.read()
"""


def test_the_logger_of_cpp_hears_us(network: CppYarp, tmp_path: Path) -> None:
    if not network.program("yarplogger-console").exists():
        pytest.skip(LATER)
    environment = {**os.environ, "YARP_FORWARD_LOG_ENABLE": "1"}
    saved = tmp_path / "saved.txt"
    with (
        network.popen(program="yarplogger-console"),
        Process([sys.executable, "-c", PROGRAM], env=environment),
    ):
        yarpy.wait_for("/logger", timeout=HANG)
        with YarpNameClient(network.host, network.port) as names:
            wait_until(lambda: names.list("/log/"))
        with yarpy.RpcClient("/logger/rpc:i") as logger:
            logger.call("connect")

            def heard() -> bool:
                time.sleep(0.5)  # it takes no lines while it saves
                logger.call(["save", str(saved)])
                return '\n4\n<#STRING_START#>joint 3 is "hot"<' in saved.read_text()

            wait_until(heard)


def test_we_hear_its_programs(network: CppYarp, tmp_path: Path) -> None:
    if network.version < (3, 9):
        pytest.skip(LATER)
    with Process([sys.executable, "-m", "yarpy", "log"], env=dict(os.environ)) as log:
        log.wait_line("Port /.* active", stream="err", timeout=HANG)
        told = {"YARP_FORWARD_LOG_ENABLE": "1", "YARP_FORWARD_HOSTNAME_ENABLE": "1"}
        with (
            network.at(network.host, network.port, **told) as there,
            there.popen("--server", "/nodeX", program="yarprun"),
        ):
            log.wait_line(r"/yarprun/\d+ \[INFO\] Yarprun successfully started", stream="out")


APPLICATION = """\
<application><name>both</name>
<module><name>PROGRAM</name><parameters>read /listener</parameters><node>/nodeA</node></module>
<module><name>sh</name><parameters>-c "sleep 600 | PROGRAM write /speaker"</parameters>
<node>/nodeA</node></module>
<connection><from>/speaker</from><to>/listener</to><protocol>tcp</protocol></connection>
</application>
"""


def test_an_application_of_its_manager(network: CppYarp, server: RunServer, tmp_path: Path) -> None:
    """The same file is what `yarpy up` reads."""
    file = tmp_path / "both.xml"
    file.write_text(APPLICATION.replace("PROGRAM", str(network.program())), encoding="utf-8")
    assert [one.node for one in load(file).modules] == ["/nodeA", "/nodeA"]
    with (
        network.popen("--application", str(file), program="yarpmanager-console") as manager,
        RunClient("/nodeA") as node,
    ):
        manager.write_line("run")
        _until(lambda: len(node.running()) == 2)
        _until(lambda: yarpy.query("/speaker") and yarpy.query("/listener"))
        manager.write_line("check state")
        manager.write_line("connect 0")
        _until(lambda: yarpy.is_connected("/speaker", "/listener"))
        manager.write_line("stop")
        _until(lambda: not node.running())
        manager.write_line("exit")
        manager.wait(3 * HANG)
        assert manager.stdout.count("<RUNNING>") == 2  # 3.9 keeps it back until it says more


def _until(condition) -> None:
    deadline = time.monotonic() + HANG
    while not condition():
        assert time.monotonic() < deadline
