"""What the system knows of processes."""

import os
import subprocess
import sys

import pytest
from support.wait import HANG, wait_until

from yarpy.kits.launch.supervise import process

pytestmark = pytest.mark.skipif(not process.known(), reason="this system has no /proc to read")


def test_a_name_with_blanks_and_brackets_is_no_obstacle() -> None:
    text = b"7 (a) b (c)) S 1 7 9 " + b" ".join(b"%d" % n for n in range(7, 40))
    found = process.parse(7, text)
    assert found is not None
    assert (found.parent, found.session, found.state, found.start) == (1, 9, "S", 22)
    assert process.parse(7, b"7 (a) S 1") is None


def test_this_process() -> None:
    found = process.look(os.getpid())
    assert found is not None and found.alive
    assert (found.parent, found.session) == (os.getppid(), os.getsid(0))
    assert 1 << 20 < found.memory < 1 << 40
    assert process.look(2**22 + 1) is None


def test_members_are_found_by_session_and_by_mark() -> None:
    code = "import time; print(flush=True); time.sleep(600)"
    marked = {**os.environ, process.MARK: "run/b"}
    children = [
        subprocess.Popen([sys.executable, "-c", code], start_new_session=True),
        subprocess.Popen([sys.executable, "-c", code], env=marked),
        subprocess.Popen([sys.executable, "-c", code]),
    ]
    a, b, other = (child.pid for child in children)
    try:
        expected = {a: "run/a", b: "run/b"}
        wait_until(lambda: process.members({a: "run/a"}, {"run/a", "run/b"}) == expected)
        assert process.mark_of(b) == "run/b" and process.mark_of(other) == ""
    finally:
        for child in children:
            child.kill()
            child.wait()
    assert process.members({a: "run/a"}, {"run/a", "run/b"}) == {}


def test_a_second_look_is_at_what_was_unclear_or_is_new() -> None:
    marked = {**os.environ, "A_BIG_ONE": "x" * 60_000, process.MARK: "run/a"}
    child = subprocess.Popen(["sleep", "600"], env=marked)
    try:
        wait_until(lambda: process.mark_of(child.pid) == "run/a")
        known = {child.pid: (1, "as it was")}
        assert process.rescan(process.Scan(known, set())).found[child.pid] == (1, "as it was")
        for before in (process.Scan(known, {child.pid}), process.Scan({}, set())):
            assert process.rescan(before).found[child.pid] == (os.getsid(0), "run/a")
    finally:
        child.kill()
        child.wait()
    assert child.pid not in process.rescan(process.Scan(known, set())).found


def test_one_that_is_just_becoming_a_program_is_waited_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """The system shows no environment for a moment, and other processes have none at all."""
    monkeypatch.setattr(process, "_BEGINNING", 2 * HANG)  # this computer may be busy
    child = subprocess.Popen(["sleep", "600"], env={**os.environ, process.MARK: "run/c"})
    try:
        wait_until(lambda: process.mark_of(child.pid) == "run/c")
        mark_of, looks = process.mark_of, 0

        def late(pid: int) -> str | None:
            nonlocal looks
            looks += pid == child.pid
            return None if pid == child.pid and looks <= 3 else mark_of(pid)

        monkeypatch.setattr(process, "mark_of", late)
        assert process.members({}, {"run/c"}) == {child.pid: "run/c"}
    finally:
        child.kill()
        child.wait()
