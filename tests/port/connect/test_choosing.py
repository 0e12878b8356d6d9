"""Choosing: memory between two programs of one computer, tcp for all others."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from support import fork_server
from support.build import changes_a_constant
from support.process import Process
from support.wait import HANG, wait_until

import yarpy
from yarpy.contact import Contact
from yarpy.errors import NoNameServer
from yarpy.port.connect import choosing, connecting
from yarpy.port.connect.choosing import choose, instead
from yarpy.route import parse_carrier
from yarpy.transports.shared.arena import arena_of
from yarpy.transports.shared.sealed import available

pytestmark = pytest.mark.skipif(not available(), reason="this system has no such memory")

HERE = Contact("tcp", "/there", "127.0.0.1", 10002)


class Names(yarpy.LocalNames):
    """What a name service knows of a port."""

    def __init__(self, accepts: tuple[str, ...] = ("tcp", "memory"), process: int = 1) -> None:
        super().__init__()
        self.register("/there", "tcp", "127.0.0.1", 10002)
        self.set("/there", "accepts", *accepts)
        self.set("/there", "process", process)


def chosen(contact: Contact = HERE, names: yarpy.LocalNames | None = None) -> str:
    return choose(contact, names or Names(), True).base


def test_memory_for_another_program_of_this_computer() -> None:
    spec = choose(HERE, Names(), True)
    assert (spec.base, spec.chosen, spec.own) == ("memory", True, True)


def test_tcp_for_all_others(monkeypatch: pytest.MonkeyPatch) -> None:
    assert chosen(Contact("tcp", "/there", "192.0.2.1", 10002)) == "tcp"  # elsewhere
    assert chosen(Contact("tcp", "", "127.0.0.1", 10002)) == "tcp"  # by its address
    assert chosen(Contact("mjpeg", "/there", "127.0.0.1", 10002)) == "tcp"
    assert chosen(names=Names(("tcp", "shmem"))) == "tcp"  # C++ YARP
    assert chosen(names=Names(process=os.getpid())) == "tcp"  # this program
    assert choose(HERE, None, True).base == "tcp"
    monkeypatch.setenv("YARPY_TLS", "require")
    assert chosen() == "tcp"
    monkeypatch.delenv("YARPY_TLS")
    monkeypatch.setattr(choosing, "available", lambda: False)
    assert chosen() == "tcp"


def test_a_name_service_that_has_gone() -> None:
    class Gone(Names):
        def get(self, name: str, key: str) -> list[str]:
            raise NoNameServer("gone")

    assert chosen(names=Gone()) == "tcp"


@changes_a_constant
def test_a_port_that_is_just_opening(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its name is known first. How often it is asked within OPENING is the machine's affair: three
    pauses of a busy one may take longer."""
    monkeypatch.setattr(choosing, "OPENING", HANG)

    class Opening(Names):
        asked = 0

        def get(self, name: str, key: str) -> list[str]:
            self.asked += 1
            return [*super().get(name, key)] if self.asked > 3 else []

    assert chosen(names=Opening()) == "memory"


def test_a_name_that_somebody_entered() -> None:
    names = yarpy.LocalNames()
    names.register("/there", "tcp", "127.0.0.1", 10002)
    assert chosen(names=names) == "tcp"


def test_what_nobody_chose_is_not_replaced() -> None:
    assert instead(parse_carrier("memory")) is None
    assert instead(choose(HERE, None, True)) is None
    other = instead(choose(HERE, Names(), True))
    assert other is not None
    assert (other.base, other.chosen, other.own) == ("tcp", True, True)


# -- two programs ---------------------------------------------------------------------------------

READER = """
import sys, yarpy
port = yarpy.BufferedPort(sys.argv[1], strict=True)
kept = []
print("open", flush=True)
for message in port:
    array = message.as_(yarpy.Image).array
    if sys.argv[2:]:
        kept.append(array)
    number = int(array[0, 0])
    assert (array == number).all()
    print(port.inputs[0].carrier, number, array.flags.writeable, flush=True)
"""


@pytest.fixture
def server(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[yarpy.NameServer]:
    with yarpy.NameServer() as server:
        for key, value in server.environment.items():
            monkeypatch.setenv(key, value)
        yield server


def reader(name: str, *arguments: str) -> Process:
    program = [sys.executable, "-c", READER, name, *arguments]
    process = Process(program, env=os.environ, start=fork_server.start)
    process.wait_line("^open$")
    return process


def picture(number: int) -> np.ndarray:
    return np.full((400, 400), number, np.uint8)


def test_pictures_to_two_programs(server: yarpy.NameServer) -> None:
    with yarpy.Port("/out") as out, reader("/one") as one, reader("/two") as two:
        made = yarpy.connect("/out", "/one")
        assert made.carrier == "memory"
        assert made.reply == "Added connection from /out to memory://one"
        assert out.connect("/two").carrier == "memory"
        for number in range(1, 21):
            assert out.write(picture(number)) == 2
        for process in (one, two):
            process.wait_line("^memory 20 False$")
        assert out.flush(10)
        stats = out.outputs[0].stats
        assert (stats.messages, stats.drops) == (20, 0)
        assert stats.bytes > 20 * 160_000  # as over any other carrier
        wait_until(lambda: arena_of("/out").used <= 1)  # what they looked at last


WRITER = """
import sys, yarpy
with yarpy.Port("/writer") as port:
    print("open", flush=True)
    while sys.stdin.readline():
        port.write([1])
"""


@pytest.mark.parametrize("lost", [False, True])
def test_listening_without_a_name(
    lost: bool, server: yarpy.NameServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Only the listener knows what it speaks. Where memory cannot be had, it asks for tcp."""
    asked: list[str] = []

    def ask(contact: Contact, command: list[str], **options: object) -> object:
        asked.append(command[1])
        return [1, "no"] if lost and "memory" in command[1] else probe_ask(contact, command)

    probe_ask = connecting.probe.ask
    monkeypatch.setattr(connecting.probe, "ask", ask)
    with Process([sys.executable, "-c", WRITER], env=os.environ) as writer:
        writer.wait_line("^open$")
        with yarpy.BufferedPort("", strict=True) as port:
            port.listen_to("/writer")
            assert port.wait_for_inputs(timeout=HANG)
            assert port.inputs[0].carrier == ("tcp" if lost else "memory")
            assert len(asked) == 1 + lost
            writer.write_line()
            assert port.read(HANG).value == [1]


def test_persistent_connections(server: yarpy.NameServer) -> None:
    """Whatever the name server has to keep, the port chooses how."""
    from yarpy.network.asking import ask_server

    ask_server(None, ["subscribe", "/out", "/in"])
    with yarpy.Port("/out") as out, reader("/in") as process:
        assert out.wait_for_outputs(timeout=HANG)
        assert out.outputs[0].carrier == "memory"
        out.write(picture(1))
        process.wait_line("^memory 1 False$")


def test_tcp_on_request(server: yarpy.NameServer) -> None:
    with yarpy.Port("/out") as out, reader("/in") as process:
        made = yarpy.connect("/out", "/in", "tcp")
        assert (made.carrier, made.reply) == ("tcp", "Added connection from /out to tcp://in")
        out.write(picture(1))
        process.wait_line("^tcp 1 True$")


def test_a_program_that_sees_nothing_of_ours(
    server: yarpy.NameServer, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """It finds out while it is greeted; nobody has to be told."""
    code = "from yarpy.transports.shared import memory as m\n"
    code += "m._path = lambda number: chr(0) + 'elsewhere'\n"
    program = [sys.executable, "-c", code + READER, "/in"]
    with (
        yarpy.Port("/out") as out,
        Process(program, env=os.environ, start=fork_server.start) as process,
    ):
        process.wait_line("^open$")
        assert out.connect("/in").carrier == "tcp"
        out.write(picture(1))
        process.wait_line("^tcp 1 True$")
        assert not process.stderr
        with pytest.raises(yarpy.LocalProtocolError, match="shares no memory"):
            out.connect("/in", "memory")
        wait_until(lambda: out.outputs)  # the one of before is back
        assert out.disconnect("/in")
    assert not [one for one in caplog.records if one.levelname == "WARNING"]


def test_a_program_that_keeps_everything_gets_copies(
    server: yarpy.NameServer, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    from yarpy.transports.shared import arena

    monkeypatch.setattr(arena.Arena.__init__, "__defaults__", (1 << 20,))
    with yarpy.Port("/greedy/out") as out, reader("/in", "keep") as process:
        out.connect("/in")
        for number in range(1, 31):
            out.write(picture(number))
        process.wait_line("^memory 30 True$")  # a copy is its own
        said = [one.getMessage() for one in caplog.records if "shared memory" in one.getMessage()]
        assert len(said) == 1
        assert said[0].startswith("/greedy/out: readers keep 6 large messages")


def test_killed_readers_leave_nothing(server: yarpy.NameServer) -> None:
    """They die with views of what came."""
    with yarpy.Port("/out") as out:
        arena = arena_of("/out")
        for number in range(1, 4):
            with reader("/in", "keep") as process:
                out.connect("/in")
                for _ in range(number):
                    out.write(picture(number))
                process.wait_line(f"^memory {number} ", count=number)
                assert arena.used >= number
                os.kill(process.pid, signal.SIGKILL)
                process.wait()
            wait_until(lambda: not out.outputs and arena.used == 0)


def test_inside_zenoh_nothing_is_acknowledged_twice() -> None:
    assert chosen(Contact("tcp", "/there", "a1b2.zenoh", 10002)) == "fast_tcp"
