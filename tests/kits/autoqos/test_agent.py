"""The agent at real ports: what it sets, what it undoes, and ports that do not play along."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import pytest
from support.cpp import CppYarp
from support.cpp_program import CppProgram
from support.peer import brings
from support.system import NO_MARKS
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits.autoqos.agent import Agent, Event
from yarpy.kits.autoqos.change import Change
from yarpy.kits.autoqos.controls import wanted
from yarpy.kits.autoqos.journal import Journal
from yarpy.kits.autoqos.rules import parse

# What helps: the packets, or the threads where the system marks none for a program.
HELPED = Change("/late/out", "/late/in", "packets", "AF42", "CS0")
if NO_MARKS:
    HELPED = Change("/late/out", "/late/in", "threads", ("SCHED_FIFO", 30), ("SCHED_OTHER", 0))

RULES = parse(
    '[[critical]]\nconnections = ["/late/*"]\ndeadline = 0.05\n'
    '[[best-effort]]\nconnections = ["/bulk/*"]\n'
)


def helped(port: yarpy.Port) -> bool:
    """Whether its first connection has what helps."""
    now = port.outputs[0].qos
    return now.policy in ("SCHED_FIFO", "SCHED_RR") if NO_MARKS else now.packets == "AF42"


class Late:
    """A sender whose messages are late until they matter, and an agent beside it."""

    def __init__(self, folder: Path, dry: bool = False) -> None:
        self.names = yarpy.LocalNames()
        self.out = yarpy.Port("/late/out", names=self.names)
        self.in_ = yarpy.BufferedPort("/late/in", names=self.names)
        self.out.connect("/late/in", "tcp")
        self.events: list[Event] = []
        self.going = True
        self.journal = None if dry else Journal(folder / "journal")
        self.threads = [threading.Thread(target=self._write), threading.Thread(target=self._steer)]

    def _write(self) -> None:
        while self.going:
            late = not helped(self.out)
            # Stamps of the future are in time however busy this machine is.
            self.out.write([1], yarpy.Stamp(1, time.time() + (-1.0 if late else 60.0)))
            time.sleep(0.005)

    def _steer(self) -> None:
        agent = Agent(RULES, self.events.append, self.journal, self.names, period=0.1, timeout=1.0)
        agent.run(lambda: self.going)

    def __enter__(self) -> Late:
        for thread in self.threads:
            thread.start()
        return self

    def end(self) -> None:
        self.going = False
        for thread in self.threads:
            thread.join(30)

    def __exit__(self, *_: object) -> None:
        self.end()
        if self.journal is not None:
            self.journal.close()
        self.out.close()
        self.in_.close()

    def told(self, words: str) -> bool:
        return any(words in event.text for event in self.events)


def test_it_helps_and_leaves_everything_as_it_was(tmp_path: Path) -> None:
    with Late(tmp_path) as late:
        wait_until(lambda: late.told("that helped"), timeout=30)
        assert helped(late.out)
        assert late.told("matches no connection now")
        late.end()
        assert not helped(late.out)
        assert late.in_.inputs[0].qos.packets == "CS0"
        assert not late.in_.inputs[0].qos.timed
        assert late.journal is not None and late.journal.left() == []


def test_a_dry_run_changes_nothing(tmp_path: Path) -> None:
    with Late(tmp_path, dry=True) as late:
        wait_until(lambda: late.told("deadlines of 50 ms"), timeout=30)
        late.end()
        assert not helped(late.out)
        assert not late.in_.inputs[0].qos.timed
        assert not (tmp_path / "journal").exists()


def test_the_next_one_undoes_what_a_killed_one_left(tmp_path: Path) -> None:
    names = yarpy.LocalNames()
    left = Journal(tmp_path / "journal")
    left.write(HELPED)
    left.write(replace(HELPED, port="/gone"))
    left.close()
    with (
        yarpy.Port("/late/out", names=names) as out,
        yarpy.BufferedPort("/late/in", names=names),
    ):
        out.connect("/late/in", "tcp").qos = wanted(HELPED)
        assert helped(out)
        journal, events = Journal(tmp_path / "journal"), list[Event]()
        Agent(RULES, events.append, journal, names).run(lambda: False)
        assert not helped(out)
        assert "an agent that was killed left 2 settings undone" in events[0].text
        assert events[0].failed == ()
        assert journal.left() == []
        journal.close()


def test_a_damaged_journal_is_told(tmp_path: Path) -> None:
    (tmp_path / "journal").write_bytes(b"nonsense\n")
    journal, events = Journal(tmp_path / "journal"), list[Event]()
    Agent(RULES, events.append, journal, yarpy.LocalNames()).run(lambda: False)
    [event] = events
    assert event.text.startswith("1 line of the journal cannot be read")
    assert str(journal.copy) in event.text
    journal.close()


@pytest.fixture
def nonsense() -> Iterator[int]:
    """Something that listens, and answers nonsense; the number of its socket."""
    listener = socket.create_server(("127.0.0.1", 0))
    done = threading.Event()

    def serve() -> None:
        while not done.is_set():
            try:
                conn, _ = listener.accept()
            except OSError:
                return
            with conn, suppress(OSError):
                conn.sendall(b"HTTP/1.0 200 \xff\xff\xff\xff nonsense" * 100)

    thread = threading.Thread(target=serve)
    thread.start()
    yield listener.getsockname()[1]
    done.set()
    socket.create_connection(listener.getsockname()).close()  # which ends the wait for one
    thread.join(HANG)
    listener.close()


def test_ports_that_answer_nonsense_or_never_do_not_hold_it_up(
    tmp_path: Path, nonsense: int
) -> None:
    with Late(tmp_path) as late, socket.create_server(("127.0.0.1", 0)) as mute:
        for name, number in (("/bulk/bad", nonsense), ("/bulk/mute", mute.getsockname()[1])):
            late.names.register(name, "tcp", "127.0.0.1", number)
        assert late.journal is not None
        late.journal.write(Change("/bulk/mute", "/x", "packets", "AF42", "CS0"))
        wait_until(lambda: late.told("that helped"), timeout=60)
        late.end()
        # What nobody answered to stays for the next one.
        assert [one.port for one in late.journal.left()] == ["/bulk/mute"]


@pytest.fixture(scope="module")
@brings("cpp")
def cpp(tmp_path_factory: pytest.TempPathFactory) -> Iterator[CppYarp]:
    programs = CppYarp.prepare(tmp_path_factory.mktemp("cpp"))
    with yarpy.NameServer() as server, programs.at("127.0.0.1", server.port) as found:
        yield found


def test_ports_of_cpp_are_set_and_set_back(cpp: CppYarp, tmp_path: Path) -> None:
    with CppProgram(cpp) as peer, yarpy.BufferedPort("/late/py") as in_:
        peer.do("port = yarp.BufferedPortBottle(); port.open('/late/cpp')")
        peer.do("yarp.Network.connect('/late/cpp', '/late/py', 'tcp')")
        assert in_.wait_for_inputs(timeout=HANG)
        journal, events = Journal(tmp_path / "journal"), list[Event]()
        agent = Agent(RULES, events.append, journal)
        change = Change("/late/cpp", "/late/py", "packets", "AF42", "CS0")
        journal.write(change)
        agent._controls.make(change)
        # C++ 4 asks the system with a length that it has not set, and may get nothing.
        unknown = [[["tos", -1]]] if cpp.version >= (4, 0) else []
        told = yarpy.admin("/late/cpp", "prop", "get", "/late/py").find("qos")
        assert told in [[["tos", 144]], *unknown]
        agent.run(lambda: False)
        told = yarpy.admin("/late/cpp", "prop", "get", "/late/py").find("qos")
        assert told in [[["tos", 0]], *unknown]
        journal.close()
