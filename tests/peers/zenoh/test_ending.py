"""The end of a program that does not close what goes through Zenoh: all that was written arrives,
and its session is there for as long as it runs.

Rules: each program is a process of its own; the router, and who reads, are here.
"""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import closing

import pytest
from support.wait import HANG

import yarpy
from yarpy.kits import wrap
from yarpy.peers.zenoh.names import ZenohNames
from yarpy.peers.zenoh.transport import share

pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[zenoh]"')

pytestmark = [
    pytest.mark.usefixtures("unconfigured"),
    pytest.mark.skipif(os.name != "posix", reason="the ends are those of Unix"),
]

COUNT = 100
BEGIN = """
import os, signal, sys, threading, time
import yarpy
from yarpy import wrap
"""
PORT = """
port = yarpy.Port("/ending/out", names=yarpy.LocalNames())
port.connect(sys.argv[1])
assert port.wait_for_outputs(timeout=30)
"""
ENDS = {
    "the end of the file": "write({count})\n",
    "sys.exit": "write({count})\nsys.exit(3)\n",
    "an exception": "write({count})\nraise ZeroDivisionError\n",
    "SIGTERM": "write({count})\nos.kill(os.getpid(), signal.SIGTERM); time.sleep(60)\n",
    "another thread goes on": """
def work():
    threading.main_thread().join()  # it has come to its end: the session must not
    write({count})
threading.Thread(target=work).start()
""",
}
STATUS = {"sys.exit": 3, "an exception": 1, "SIGTERM": -15}


class Heard:
    """What has come, by any way."""

    def __init__(self) -> None:
        self.values: list[object] = []
        self._changed = threading.Condition()

    def __call__(self, message: yarpy.Message) -> None:
        with self._changed:
            self.values.append(message.value)
            self._changed.notify_all()

    def wait_for(self, count: int) -> None:
        with self._changed:
            came = self._changed.wait_for(lambda: len(self.values) >= count, HANG)
        assert came, f"{len(self.values)} of {count} came"


def run(where: str, program: str, *words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", BEGIN + program, *words],
        env={**os.environ, "YARPY_ZENOH": where, "YARPY_LINGER": "20"},  # the machine may be busy
        capture_output=True,
        text=True,
        timeout=2 * HANG,
    )


@pytest.fixture
def here(lone_router: str, monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """The router's address, also for this process."""
    monkeypatch.setenv("YARPY_ZENOH", lone_router)
    yield lone_router


@pytest.mark.parametrize("end", ENDS)
@pytest.mark.parametrize(
    "target", ["zenoh://ending/key", "ros2://ending~std_msgs/msg/Int32"], ids=["key", "ros2"]
)
def test_what_was_written_arrives(end: str, target: str, here: str) -> None:
    count = 10 if target.startswith("ros2") else COUNT  # a topic keeps ten for a slow reader
    write = "def write(count):\n    for n in range(count): port.write([n])\n"
    heard = Heard()
    with yarpy.Port("/ending/in", callback=heard, names=yarpy.LocalNames()) as port:
        port.listen_to(target)
        done = run(here, PORT + write + ENDS[end].format(count=count), target)
        assert done.returncode == STATUS.get(end, 0), done.stderr
        assert "Traceback" not in done.stderr or end == "an exception", done.stderr
        heard.wait_for(count)


@pytest.mark.parametrize("end", ENDS)
def test_a_connection_inside_zenoh_ends_with_all_that_was_written(end: str, here: str) -> None:
    heard = Heard()
    with (
        closing(ZenohNames(here)) as names,
        yarpy.Port("/ending/in", callback=heard, names=names) as port,
    ):
        program = (
            "from yarpy.peers.zenoh.names import ZenohNames\n"
            "names = ZenohNames(sys.argv[1])\n"
            "port = yarpy.Port('/ending/out', names=names)\n"
            "port.connect(sys.argv[2])\n"
            "def write(count):\n    for n in range(count): port.write([n])\n"
        )
        with share(here) as shared:
            inside = f"/{shared.zid}.zenoh:{port.address.rpartition(':')[2]}"
        done = run(here, program + ENDS[end].format(count=COUNT), here, inside)
        assert done.returncode == STATUS.get(end, 0), done.stderr
        heard.wait_for(COUNT)
        assert heard.values == [[n] for n in range(COUNT)]
        assert names.query("/ending/out") is None


class Arm:
    @wrap.on("/ending/arm", "zenoh", wait=HANG, keep="all")
    def state(self) -> int:
        return 0


@pytest.mark.parametrize("end", ENDS)
def test_what_a_decorated_method_published_arrives(end: str, here: str) -> None:
    arm = Arm()
    program = (
        "class Arm:\n"
        "    @wrap.on('/ending/arm', 'zenoh', wait=30.0)\n"
        "    def state(self, number: int) -> int: return number\n"
        "arm = Arm()\n"
        "wrap.publish(arm.state)\n"
        "def write(count):\n    for n in range(count): arm.state(n)\n"
    )
    with wrap.listen(arm.state):
        done = run(here, program + ENDS[end].format(count=COUNT))
        assert done.returncode == STATUS.get(end, 0), done.stderr
        assert [arm.state(timeout=HANG) for _ in range(COUNT)] == [*range(COUNT)]


@pytest.mark.parametrize("waits", ["port.read()", "names.list()", "port.wait_for_inputs()"])
def test_a_daemon_that_waits_does_not_hold_up_the_end(waits: str, here: str) -> None:
    program = (
        "from yarpy.peers.zenoh.names import ZenohNames\n"
        "names = ZenohNames(sys.argv[1])\n"
        "port = yarpy.Port('/ending/q', names=names)\n"
        "port.listen_to('zenoh://ending/none')\n"
        f"def work():\n    while True: {waits}\n"
        "threading.Thread(target=work, daemon=True).start()\n"
        "sys.exit(3)\n"
    )
    done = run(here, program, here)
    assert done.returncode == 3, done.stderr


def test_a_session_is_not_opened_at_the_end(here: str) -> None:
    program = (
        "from yarpy.peers.zenoh import transport\n"
        "transport.share().close()\n"
        "transport._POOL.close()\n"
        "try: transport.share()\n"
        "except yarpy.LinkClosed as error: print(error)\n"
    )
    assert "the program ends" in run(here, program).stdout
