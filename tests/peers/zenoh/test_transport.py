"""Sessions of Zenoh: where they go, that they are shared, and what is said when they fail."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.port import free_port
from support.wait import HANG, wait_until
from support.zenoh_session import ask, listening

from yarpy import linger
from yarpy.peers.zenoh import transport
from yarpy.peers.zenoh.library import Calls
from yarpy.peers.zenoh.place import place
from yarpy.peers.zenoh.transport import _Pool, share

pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[zenoh]"')


pytestmark = pytest.mark.usefixtures("unconfigured")


def test_a_session_is_shared_until_the_last_gives_it_back(lone_router: str) -> None:
    first, second = share(lone_router), share(lone_router)
    assert first.session is second.session and first.zid == second.zid
    first.close()
    first.close()
    assert not second.session.is_closed()
    session = second.session
    second.close()
    assert session.is_closed()
    with share(lone_router) as third:
        assert third.session is not session


@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
def test_sessions_meet_at_a_router_and_open_no_socket(lone_router: str, tmp_path: Path) -> None:
    file = tmp_path / "client.json5"
    scouting = "scouting: {multicast: {enabled: false}}"
    file.write_text(f'{{mode: "client", connect: {{endpoints: ["{lone_router}"]}}, {scouting}}}')
    before = listening()
    with share(lone_router) as one, share(str(file)) as other:
        assert one.zid != other.zid
        queryable = one.session.declare_queryable("a/b", lambda query: query.reply("a/b", b"yes"))
        wait_until(lambda: ask(other.session, "a/b") == [b"yes"])
        assert ask(other.session, "a/c") == []
        queryable.undeclare()
        assert listening() == before
        assert [str(link.dst) for link in one.session.info.links()] == [lone_router]


PROGRAM = """
import sys
from zenoh.handlers import Callback
from yarpy.peers.zenoh.transport import share
shared = share(sys.argv[1])
session = shared.session
subscriber = session.declare_subscriber("a", Callback(print, indirect=False))
queryable = session.declare_queryable("b", Callback(print, indirect=False))
token = session.liveliness().declare_token("c")
"""


def test_a_program_ends_by_itself(lone_router: str) -> None:
    subprocess.run([sys.executable, "-c", PROGRAM, lone_router], check=True, timeout=30)


FORKING = """
import os, sys
from yarpy.errors import LocalProtocolError
from yarpy.peers.zenoh.transport import share
shared = share(sys.argv[1])
child = os.fork()
if not child:
    try:
        share(sys.argv[1])
    except LocalProtocolError as error:
        print(error)
    sys.exit()
os.waitpid(child, 0)
print(len(list(shared.session.get("nothing"))))
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork here")
def test_a_forked_process_is_told_that_it_cannot(lone_router: str) -> None:
    command = [sys.executable, "-c", FORKING, lone_router]
    said = subprocess.run(command, check=True, timeout=30, capture_output=True, text=True).stdout
    assert "forked" in said and said.endswith("0\n")


ROUTER = """
import sys, time
from yarpy.peers.zenoh.router import open_router
router = open_router([sys.argv[1]])
print("ready", flush=True)
time.sleep(600)
"""


@pytest.fixture
def stoppable() -> Iterator[tuple[str, subprocess.Popen[str]]]:
    """A router in a process of its own, and its address."""
    where = f"tcp/127.0.0.1:{free_port()}"
    with subprocess.Popen(
        [sys.executable, "-c", ROUTER, where], stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        try:
            yield where, process
        finally:
            process.kill()


@pytest.mark.skipif(os.name != "posix", reason="stops a process as Unix does")
@pytest.mark.parametrize("way", ["given back", "the end of the program"])
def test_what_was_put_is_taken_before_the_session_is_closed(
    stoppable: tuple[str, subprocess.Popen[str]], monkeypatch: pytest.MonkeyPatch, way: str
) -> None:
    monkeypatch.setenv("YARPY_LINGER", str(HANG))
    where, router = stoppable
    pool = _Pool()
    writing = pool.take(place(where))
    router.send_signal(signal.SIGSTOP)
    publisher = writing.session.declare_publisher("settled/key")
    for number in range(100):
        publisher.put(b"%d" % number)
        time.sleep(0.001)  # so that they go in many pieces
    publisher.undeclare()
    monkeypatch.setattr(transport, "CALLS", Calls())
    monkeypatch.setattr(transport, "_POOL", pool)
    ending = threading.Thread(target=writing.close if way == "given back" else pool.close)
    ending.start()
    ending.join(0.3)
    assert not writing.session.is_closed()
    router.send_signal(signal.SIGCONT)
    ending.join(HANG)
    linger.remove(pool)
    assert not ending.is_alive() and writing.session.is_closed()


@pytest.mark.skipif(os.name != "posix", reason="stops a process as Unix does")
def test_a_router_that_stays_stopped_does_not_hold_up_the_end(
    stoppable: tuple[str, subprocess.Popen[str]],
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    monkeypatch.setenv("YARPY_LINGER", "0.2")
    where, router = stoppable
    shared = share(where)
    session = shared.session
    router.send_signal(signal.SIGSTOP)
    os.waitpid(router.pid, os.WUNTRACED)  # it has stopped: it can answer no more
    shared.close()
    assert session.is_closed()
    assert "Zenoh's router may not have taken all: no answer in 0.2 s" in caplog.text
