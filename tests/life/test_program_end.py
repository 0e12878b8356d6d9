"""The end of a program that does not close its ports: what it wrote arrives, its names are gone.

Rules: each program is a process of its own, with a name server and a reader here. Which end it
takes is a line of Python.
"""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator

import pytest

import yarpy

WRITER = """
import os, signal, sys, threading, time
import yarpy
port = yarpy.{kind}("/life/out", timeout=60)
port.connect("/life/in", timeout=60)
"""
WRITE = "for n in range({count}): port.write([n])\n"
ENDS = {
    "the end of the file": "",
    "sys.exit": "sys.exit(3)\n",
    "an exception": "raise ZeroDivisionError\n",
    "SIGTERM": "os.kill(os.getpid(), signal.SIGTERM); time.sleep(60)\n",
    "SIGHUP": "os.kill(os.getpid(), signal.SIGHUP); time.sleep(60)\n",
    "Ctrl-C": "os.kill(os.getpid(), signal.SIGINT); time.sleep(60)\n",
}
STATUS = {"sys.exit": 3, "an exception": 1, "SIGTERM": -15, "SIGHUP": -1, "Ctrl-C": -2}

pytestmark = pytest.mark.skipif(os.name != "posix", reason="the ends are those of Unix")


@pytest.fixture
def server() -> Iterator[yarpy.NameServer]:
    with yarpy.NameServer() as server:
        yield server


def run(server: yarpy.NameServer, program: str, **more: str) -> subprocess.CompletedProcess[str]:
    return run_alone(program, YARPY_SERVER=server.address, **more)


def run_alone(program: str, **more: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", program],
        # What is done, not how soon: on a busy machine a second may be over before.
        env={**os.environ, "YARPY_LINGER": "20", **more},
        capture_output=True,
        text=True,
        timeout=60,
    )


class Reader:
    """Reads what comes, in a thread, as fast as it can."""

    def __init__(self) -> None:
        self.port = yarpy.BufferedPort("/life/in", strict=True)
        self.got: list[int] = []
        self._news = threading.Condition()
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        for message in self.port:
            with self._news:
                self.got.append(message.value[0])
                self._news.notify_all()

    def wait_for(self, count: int) -> None:
        with self._news:
            assert self._news.wait_for(lambda: len(self.got) >= count, 20), len(self.got)


@pytest.fixture
def reader(server: yarpy.NameServer) -> Iterator[Reader]:
    found = Reader()
    yield found
    found.port.close()


@pytest.mark.parametrize("end", ENDS)
@pytest.mark.parametrize("kind", ["Port", "BufferedPort"])
def test_what_was_written_arrives(
    kind: str, end: str, server: yarpy.NameServer, reader: Reader
) -> None:
    count = 1000 if kind == "Port" else 1  # of the others it keeps the newest, as it should
    done = run(server, WRITER.format(kind=kind) + WRITE.format(count=count) + ENDS[end])
    assert done.returncode == STATUS.get(end, 0), done.stderr
    reader.wait_for(count)
    assert reader.got == list(range(count))
    assert yarpy.query("/life/out") is None


ASYNC = """
import asyncio, os, signal, time
import yarpy
from yarpy import aio

async def main():
    async with aio.Port("/life/first", timeout=60):
        pass
    async with aio.Port("/life/out", timeout=60) as port:
        await port.connect("/life/in", timeout=60)
        for n in range(100):
            await port.write([n])
        os.kill(os.getpid(), signal.{name})
        await asyncio.sleep(60)

asyncio.run(main())
"""


@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP"])
def test_a_signal_ends_a_program_of_asyncio_in_good_order(
    name: str, server: yarpy.NameServer, reader: Reader
) -> None:
    """Its ports open in other threads, which can hear no signal."""
    done = run(server, ASYNC.format(name=name))
    assert done.returncode == STATUS[name], done.stderr
    reader.wait_for(100)
    assert yarpy.query("/life/out") is None


def test_an_event_loop_leaves_the_signals_as_they_were(server: yarpy.NameServer) -> None:
    program = (
        "import asyncio, signal\nfrom yarpy import aio\n"
        "async def main():\n"
        "    async with aio.Port('/life/out', timeout=60):\n"
        "        assert signal.getsignal(signal.SIGTERM) is not signal.SIG_DFL\n"
        "    assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL\n"
        "    try:\n        await aio.Port('/a b').open()\n"
        "    except ValueError:\n        pass\n"
        "    assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL\n"
        "asyncio.run(main())\n"
    )
    done = run(server, program)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("call", ["register", "introduce"])
@pytest.mark.parametrize("name", ["SIGTERM", "SIGINT"])
def test_a_signal_while_a_port_opens_leaves_no_name(
    name: str, call: str, server: yarpy.NameServer
) -> None:
    """It comes when the name server has done what it was asked, and we do not know that yet."""
    program = (
        "import os, signal, time\nimport yarpy\nfrom yarpy.names.client import YarpNameClient\n"
        f"ask = YarpNameClient.{call}\n"
        "def cut(*words, **more):\n"
        "    ask(*words, **more)\n"
        f"    os.kill(os.getpid(), signal.{name})\n"
        "    time.sleep(60)\n"
        f"YarpNameClient.{call} = cut\n"
        "yarpy.Port('/life/out', timeout=60)\n"
    )
    done = run(server, program)
    assert done.returncode == -getattr(signal, name), done.stderr
    assert yarpy.query("/life/out") is None


@pytest.mark.parametrize("call", ["query", "unregister"])
@pytest.mark.parametrize("name", ["SIGTERM", "SIGINT"])
def test_a_signal_while_a_port_closes_leaves_no_name(
    name: str, call: str, server: yarpy.NameServer
) -> None:
    """It comes before the name server is asked; what it cut is done by another thread."""
    program = (
        "import os, signal, threading, time\nimport yarpy\n"
        "from yarpy.names.client import YarpNameClient\n"
        "port = yarpy.Port('/life/out', timeout=60)\n"
        f"ask = YarpNameClient.{call}\n"
        "def cut(*words, **more):\n"
        f"    YarpNameClient.{call} = ask\n"
        f"    os.kill(os.getpid(), signal.{name})\n"
        "    time.sleep(60)\n"
        f"YarpNameClient.{call} = cut\n"
        "port.close()\n"
    )
    done = run(server, program)
    assert done.returncode == -getattr(signal, name), done.stderr
    assert yarpy.query("/life/out") is None


def test_threads_of_the_program_are_waited_for_first(
    server: yarpy.NameServer, reader: Reader
) -> None:
    program = (
        WRITER.format(kind="Port")
        + "def work():\n    for n in range(100): port.write([n]); time.sleep(0.001)\n"
        + "threading.Thread(target=work).start()\n"
    )
    assert run(server, program).returncode == 0
    reader.wait_for(100)


def test_a_child_of_multiprocessing_ends_in_good_order(
    server: yarpy.NameServer, reader: Reader
) -> None:
    child = "".join(f"    {line}\n" for line in (WRITER.format(kind="Port")).splitlines())
    program = (
        "import multiprocessing\ndef work():\n"
        + child
        + "    for n in range(100): port.write([n])\n"
        + "process = multiprocessing.get_context('fork').Process(target=work)\n"
        + "process.start(); process.join()\nraise SystemExit(process.exitcode)\n"
    )
    done = run(server, program)
    assert done.returncode == 0, done.stderr
    reader.wait_for(100)
    assert yarpy.query("/life/out") is None


def test_a_name_is_given_back_when_all_the_time_was_needed_for_the_rest() -> None:
    program = (
        "import atexit, yarpy\nfrom yarpy import scope\n"
        "class Busy(yarpy.LocalNames):\n"
        "    def unregister(self, name):\n"
        "        scope.left()  # as what asks a server does\n"
        "        super().unregister(name)\n"
        "names = Busy()\n"
        "atexit.register(lambda: print(names.query('/life/out')))\n"
        "port = yarpy.Port('/life/out', names=names, timeout=60)\n"
    )
    done = run_alone(program, YARPY_LINGER="0")
    assert done.stdout == "None\n", done.stderr


def test_a_port_that_is_just_closed_by_the_collector_is_waited_for() -> None:
    program = (
        "import threading, time, yarpy\n"
        "class Slow(yarpy.LocalNames):\n"
        "    asked = threading.Event()\n"
        "    def unregister(self, name):\n"
        "        self.asked.set()\n"
        "        time.sleep(0.3)  # in which the main thread comes to its end\n"
        "        super().unregister(name)\n"
        "        print('gone', flush=True)\n"
        "names = Slow()\n"
        "def work():\n    port = yarpy.Port('/life/out', names=names, timeout=60)\n"
        "work()\n"
        "assert names.asked.wait(60)\n"
    )
    done = run_alone(program)
    assert done.stdout == "gone\n", done.stderr


def test_the_program_s_own_handler_decides(server: yarpy.NameServer) -> None:
    program = (
        "import os, signal, sys\nimport yarpy\n"
        "signal.signal(signal.SIGTERM, lambda *_: sys.exit(9))\n"
        "port = yarpy.Port('/life/own', timeout=60)\n"
        "os.kill(os.getpid(), signal.SIGTERM)\nsignal.pause()\n"
    )
    assert run(server, program).returncode == 9
    assert yarpy.query("/life/own") is None


def test_a_reader_that_takes_nothing_is_waited_for_for_a_while_and_named(
    server: yarpy.NameServer,
) -> None:
    with yarpy.Port("/life/in"):  # nobody reads
        program = (
            WRITER.format(kind="Port")
            + "import logging; logging.basicConfig(level=logging.WARNING)\n"
            + "for n in range(50): port.write(bytes(200_000), timeout=0.02)\n"
        )
        done = run(server, program, YARPY_LINGER="0.5")
    assert done.returncode == 0, done.stderr
    assert "/life/in did not take all that was written" in done.stderr


def test_forty_ports_with_a_stopped_name_server_end_within_the_linger() -> None:
    with yarpy.NameServer() as server:
        where = server.address
        with subprocess.Popen(
            [
                sys.executable,
                "-c",
                "import sys, time\nimport yarpy\n"
                "ports = [yarpy.Port(f'/life/many/{n}', timeout=60) for n in range(40)]\n"
                "print('open', flush=True)\nsys.stdin.readline()\nbegun = time.monotonic()\n"
                "from yarpy import linger\nlinger.end()\n"
                "print(time.monotonic() - begun, flush=True)\n",
            ],
            env={**os.environ, "YARPY_SERVER": where},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        ) as program:
            assert program.stdin is not None and program.stdout is not None
            assert program.stdout.readline() == "open\n"
            # The server is gone; what listens there now says nothing, as one that was stopped.
            number = int(server.address.rpartition(":")[2])
            server.close()
            with socket.create_server(("127.0.0.1", number)):
                program.stdin.write("\n")
                program.stdin.flush()
                taken = float(program.stdout.readline())
    assert taken < 10.0  # 1 s; forty times 1 s would be too long on any machine


def test_a_killed_program_leaves_what_it_leaves(server: yarpy.NameServer) -> None:
    program = "import os, signal\nimport yarpy\nport = yarpy.Port('/life/killed', timeout=60)\n"
    done = run(server, program + "os.kill(os.getpid(), signal.SIGKILL)\n")
    assert done.returncode == -signal.SIGKILL


def test_daemon_threads_end_without_a_word() -> None:
    """A word of theirs may bring down an interpreter that ends."""
    done = run_alone(
        """
import threading, yarpy
names = yarpy.LocalNames()
port, other = (yarpy.BufferedPort(name, names=names) for name in ("/in", "/out"))

def until(call, *words):
    while True:
        call(*words)

threading.Thread(target=until, args=(port.read,), daemon=True).start()
threading.Thread(target=until, args=(other.write, [1]), daemon=True).start()
fails = threading.Thread(target=until, args=(port.connect, 1), daemon=True)
fails.start()
fails.join()
"""
    )
    assert done.returncode == 0
    assert done.stderr.count("Traceback") == 1, done.stderr
