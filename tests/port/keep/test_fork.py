"""Forked processes: the parent's ports are the parent's, the child opens its own."""

from __future__ import annotations

import os
import subprocess
import sys
from textwrap import dedent

import pytest

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")

# Each runs in a process of its own, with ports /in and /out that are connected, and ends with the
# words that its child and itself print.
START = """
import os, signal, sys, time, warnings
import yarpy
warnings.simplefilter("ignore")  # newer Pythons warn of forks beside threads

def wait_until(condition):
    deadline = time.monotonic() + 20
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.01)

def child_of(work):
    number = os.fork()
    if not number:
        try:
            work()
        except SystemExit:
            pass
        finally:
            sys.stdout.flush()
            os._exit(0)
    return number

server = yarpy.NameServer().__enter__()
in_ = yarpy.BufferedPort("/in", strict=True)
out = yarpy.Port("/out")
out.connect("/in")
"""


def run(program: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", START + dedent(program)],
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_child_with_a_port_of_its_own_leaves_its_parents_connections_alone() -> None:
    """It used to take the acknowledgements away that its parent waited for."""
    said = run(
        """
        ready, free = os.pipe(), os.pipe()

        def work():
            with yarpy.Port("/child") as port:
                port.connect("/in")
                port.write(["from the child"], wait=True)
                os.write(ready[1], b"x")
                os.read(free[0], 1)

        number = child_of(work)
        os.read(ready[0], 1)
        print(in_.read(timeout=20).value)
        for count in range(1000):
            out.write([count])
            assert in_.read(timeout=20).value == [count]
        link = in_.inputs[0]._link
        link.driver.transport.interrupt()  # a failure; one of the two dials again
        wait_until(lambda: len(in_.inputs) == 2)
        os.write(free[1], b"x")
        os.waitpid(number, 0)
        print(yarpy.exists("/out"), yarpy.exists("/in"), yarpy.exists("/child"))
        """
    )
    assert said.splitlines() == ["Bottle(['from the child'])", "True True False"]


@pytest.mark.parametrize("use", ["out.write([1])", "in_.read(timeout=20)", "in_.read()"])
def test_child_is_told_that_the_ports_are_not_its_own(use: str) -> None:
    said = run(
        f"""
        def work():
            try:
                {use}
            except yarpy.PortClosed as error:
                print(error)
            in_.close(), out.close(), server.close()  # of no effect on the parent's

        os.waitpid(child_of(work), 0)
        out.write(["on"])
        print(in_.read(timeout=20).value[0], len(in_.inputs), yarpy.exists("/in"))
        """
    )
    assert "forked" in said
    assert "open one here" in said
    assert said.splitlines()[-1] == "on 1 True"


def test_others_notice_the_death_of_a_parent_whose_child_lives_on() -> None:
    said = run(
        """
        ready, end = os.pipe(), os.pipe()

        def work():
            with yarpy.Port("/parent") as port:
                port.connect("/in")
                def grandchild():
                    os.write(ready[1], b"x")
                    os.close(1)
                    os.close(end[1])
                    os.read(end[0], 1)  # until the test is over
                child_of(grandchild)
                os.read(ready[0], 1)
                os.kill(os.getpid(), signal.SIGKILL)

        wait_until(lambda: len(in_.inputs) == 1)
        events = []
        in_.on_connection(events.append)
        os.waitpid(child_of(work), 0)
        wait_until(
            lambda: [e.created for e in events if e.source == "/parent"] == [True, False]
        )
        print(yarpy.exists("/parent"))
        """
    )
    assert said == "False\n"


def test_child_opens_a_port_while_another_thread_of_its_parent_looked_something_up() -> None:
    """It waited for ever for a lock of a thread that it has not."""
    said = run(
        """
        import threading
        from yarpy import registry
        taken, over = threading.Event(), threading.Event()
        def look_up():
            with registry.carriers._lock, yarpy.names.default.DEFAULT._lock:
                taken.set()
                over.wait()
        thread = threading.Thread(target=look_up)
        thread.start()
        taken.wait()
        def work():
            signal.alarm(30)
            names = yarpy.LocalNames()
            with yarpy.Port("/one", names=names) as one, yarpy.Port("/two", names=names) as two:
                one.connect("/two", "udp")
                print(yarpy.exists("/in"))
        child = child_of(work)
        assert os.waitpid(child, 0)[1] == 0
        over.set()
        in_.close()
        out.close()
        server.__exit__(None, None, None)
        """
    )
    assert said == "True\n"
