"""C++ yarprun and yarpmanager-console as clients of `yarpy run --server`.

The server of the C++ wheel cannot be met: it ends with "Can't open pipe" before it opens its port,
and its manager starts nothing on its own computer, for the same reason.
tests/kits/launch/run/test_client.py has what other builds of it answer.
"""

import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.cpp import CppYarp
from support.wait import HANG

import yarpy
from yarpy.kits.launch.application.load import load
from yarpy.kits.launch.run.client import RunClient
from yarpy.kits.launch.run.server import RunServer

pytestmark = pytest.mark.peer("cpp")


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
        _until(lambda: manager.stdout.count("<RUNNING>") == 2)
        manager.write_line("connect 0")
        _until(lambda: yarpy.is_connected("/speaker", "/listener"))
        manager.write_line("stop")
        _until(lambda: not node.running())


def _until(condition) -> None:
    deadline = time.monotonic() + HANG
    while not condition():
        assert time.monotonic() < deadline
