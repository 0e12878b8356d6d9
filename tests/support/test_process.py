"""Nothing of a started program survives, and what it said is known."""

import os
import sys

import pytest
from support import process as module
from support.process import Process, descendants
from support.wait import HANG, wait_until


def python(code: str) -> Process:
    return Process([sys.executable, "-u", "-c", code])


def is_running(pid: int) -> bool:
    try:
        with open(f"/proc/{pid}/stat", encoding="utf-8") as status:
            return status.read().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


def test_line_is_waited_for_and_input_arrives() -> None:
    with python("print('ready'); print('got', input())") as process:
        process.wait_line("^ready$")
        process.write_line("hello")
        assert process.wait_line(r"got (\w+)")[1] == "hello"
        assert process.wait() == 0
        assert process.stdout == "ready\ngot hello\n"


def test_the_nth_line_and_the_stream() -> None:
    code = "import sys\nfor i in range(3): print('row', i)\nprint('row err', file=sys.stderr)"
    with python(code) as process:
        assert process.wait_line(r"row (\d)", count=3, stream="out")[1] == "2"
        process.wait_line("row err", stream="err")
        assert process.wait() == 0


def test_end_without_the_line_shows_what_was_said() -> None:
    with (
        python("print('something else')") as process,
        pytest.raises(AssertionError, match="something else"),
    ):
        process.wait_line("never")


def test_waiting_ends() -> None:
    with python("import time; time.sleep(60)") as process:
        with pytest.raises(AssertionError, match="in time"):
            process.wait_line("never", timeout=0.1)
        with pytest.raises(AssertionError, match="still runs"):
            process.wait(0.1)
    assert process.returncode is not None


def test_who_hangs_says_where(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "HANG", 0.2)
    with python("def stuck():\n    print('here')\n    while True: pass\nstuck()") as process:
        process.wait_line("here")
        with pytest.raises(AssertionError, match="line 3 in stuck"):
            process.wait(0.2)


FAMILY = """
import os, signal, subprocess, sys, time
signal.signal(signal.SIGTERM, signal.SIG_IGN)
child = "import os, signal, time; signal.signal(15, signal.SIG_IGN); os.setsid(); " \\
        "print(os.getpid()); time.sleep(60)"
subprocess.Popen([sys.executable, "-u", "-c", child])
time.sleep(60)
"""


@pytest.mark.parametrize("method", ["stop", "kill"])
def test_whole_family_ends_even_if_it_does_not_want_to(method: str) -> None:
    process = python(FAMILY)
    child = int(process.wait_line(r"^(\d+)$")[1])
    assert descendants(process.pid) == [child]
    assert is_running(child)
    if method == "stop":
        process.stop(grace=0.1)
    else:
        process.kill()
    wait_until(lambda: not is_running(child))
    assert not is_running(process.pid)
    process.stop()


def test_who_lost_its_parent_ends_too() -> None:
    code = "import os, time\nif os.fork() == 0: print('child', os.getpid()); time.sleep(60)"
    with python(code) as process:
        child = int(process.wait_line(r"child (\d+)")[1])
        assert process._popen.wait(HANG) == 0
        assert is_running(child)
    wait_until(lambda: not is_running(child))


def test_interpreter_exit_ends_what_was_forgotten(tmp_path: os.PathLike[str]) -> None:
    support = os.path.dirname(os.path.dirname(__file__))
    code = (
        f"import sys; sys.path.insert(0, {support!r})\n"
        "from support.process import Process\n"
        "forgotten = Process([sys.executable, '-c', 'import time; time.sleep(60)'])\n"
        "print(forgotten.pid)\n"
    )
    with python(code) as process:
        forgotten = int(process.wait_line(r"^(\d+)$")[1])
        process.wait()
    assert not is_running(forgotten)
