"""Programs that outlive whoever started them, and what is left of them."""

import sys
from dataclasses import replace
from pathlib import Path

import pytest
from support.wait import wait_until

from yarpy.kits.launch.run import process_tree, program
from yarpy.kits.launch.run.program import Program
from yarpy.kits.launch.run.state_folder import Entry, StateFolder
from yarpy.kits.launch.supervise import process

pytestmark = pytest.mark.skipif(not process.known(), reason="this system has no /proc to look at")


class Ear:
    def __init__(self) -> None:
        self.lines: list[str] = []
        self.closed = False

    def hear(self, lines: list[str]) -> None:
        self.lines += lines

    def close(self) -> None:
        self.closed = True

    def wait(self, seconds: float) -> None:
        assert seconds >= 0


@pytest.fixture
def state(tmp_path: Path):
    state = StateFolder("/node", tmp_path)
    yield state
    state.close()


def begin(state: StateFolder, code: str, **more: str) -> Program:
    entry = Entry(state.fresh(), "it", "python", **more)
    return program.start(state, entry, [sys.executable, "-c", code], {"FOO": "bar"})


def test_what_it_says_and_how_it_ends(state: StateFolder) -> None:
    code = "from os import environ as e; print(e['FOO'], e['YARP_IS_YARPRUN']); exit(3)"
    found = begin(state, code)
    ear = Ear()
    found.listeners.append(ear)
    wait_until(found.ended)
    found.finish()
    assert ear.lines == ["bar 1"] == [*found.kept] and ear.closed and found.code == 3
    assert [*state.entries()] == []


def test_one_that_is_dead_at_once_and_one_without_a_line_end(state: StateFolder) -> None:
    found = begin(state, "import os; os.write(1, b'x' * 5000); os.kill(os.getpid(), 9)")
    wait_until(found.ended)
    found.finish()
    assert found.code == -9 and "".join(found.kept) == "x" * 5000


def test_the_next_server_finds_it_again(state: StateFolder, tmp_path: Path) -> None:
    gate, said, last = (tmp_path / name for name in ("gate", "said", "last"))
    code = f"""
import os, time
def passes(gate):
    while not os.path.exists(gate):
        time.sleep(0.01)
print("before", flush=True)
passes({str(gate)!r})
print("after", flush=True)
open({str(said)!r}, "w").close()
passes({str(last)!r})
"""
    first = begin(state, code)
    wait_until(first.look)
    first.leave()
    gate.touch()
    wait_until(said.exists)  # while nobody hears it
    [entry] = state.entries()
    again = program.found_again(state, entry)
    last.touch()
    assert again is not None
    assert again.entry.pid == first.entry.pid
    assert first._child is not None
    first._child.returncode = None
    wait_until(lambda: first._child.poll() is not None)  # this process is its parent, still
    wait_until(again.ended)
    again.finish()
    assert [*again.kept] == ["after"]


def test_one_that_was_just_being_started_is_found_by_its_mark(state: StateFolder) -> None:
    found = begin(state, "import time; time.sleep(600)", port="/log/node/python")
    entry = replace(found.entry, pid=0, began=0, port="/log/node/python")
    wait_until(lambda: process_tree.leader(entry.id))  # it has its mark
    again = program.found_again(state, entry)
    assert again is not None
    pid = found.entry.pid
    assert (again.entry.pid, again.entry.port) == (pid, f"/log/node/python/{pid}")
    assert again.process_tree.signal(9)
    wait_until(found.ended)
    found.finish()
    again.leave()
    assert program.found_again(state, entry) is None


def test_its_code_stays_though_somebody_else_asked_meanwhile(state: StateFolder) -> None:
    """Who finds another thread at it is told nothing, which must not count."""
    found = begin(state, "exit(3)")

    class Child:
        returncode: int | None = None

        def poll(self) -> None:
            found.code = 3  # as the other thread notes

    assert found._child is not None
    found._child.wait()
    found._child = Child()  # type: ignore[assignment]
    assert not found.reap() and found.code == 3
    found.finish()


def test_what_a_program_leaves_behind_counts(state: StateFolder) -> None:
    found = begin(state, "import os, time\nif os.fork() == 0: time.sleep(600)")
    wait_until(lambda: not found.reap())
    assert found.running and not found.ended()
    [left] = found.process_tree.members()
    assert left != found.entry.pid
    found.process_tree.signal(9)
    wait_until(found.ended)
    found.finish()


def test_what_cannot_be_started_leaves_nothing(state: StateFolder, tmp_path: Path) -> None:
    entry = Entry(state.fresh(), "it", "x")
    for words, change in ((["nosuch"], {}), (["sleep", "1"], {"workdir": str(tmp_path / "no")})):
        with pytest.raises(OSError, match=r"no program nosuch|working directory"):
            program.start(state, replace(entry, **change), words, {})
    text = tmp_path / "text"
    text.write_text("no program")
    text.chmod(0o755)
    with pytest.raises(OSError):
        program.start(state, entry, ["text"], {}, path=str(text))
    assert [one.name for one in state.folder.iterdir()] == ["lock"]


def test_a_program_of_its_working_directory_comes_first(state: StateFolder, tmp_path: Path) -> None:
    (tmp_path / "sleep").write_text("#!/bin/sh\necho mine; pwd\n")
    (tmp_path / "sleep").chmod(0o755)
    entry = Entry(state.fresh(), "it", "sleep", workdir=str(tmp_path))
    found = program.start(state, entry, ["sleep"], {})
    wait_until(found.ended)
    found.finish()
    assert [*found.kept] == ["mine", str(tmp_path)]
