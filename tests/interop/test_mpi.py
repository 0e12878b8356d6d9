"""mpi and bcast between programs that were started apart, with each MPI library we have."""

import contextlib
import socket
import sys
from collections.abc import Iterator

import pytest
from support.mpi import Start, mpi_library
from support.port import free_block
from support.process import Process
from support.wait import HANG

import yarpy

# Takes messages, answers questions, and dies where it is told to.
RECEIVER = """
import os, sys, time, yarpy
names = yarpy.YarpNameClient("127.0.0.1", int(sys.argv[1]))
with yarpy.Port(sys.argv[2], names=names) as port:
    print("ready", flush=True)
    while True:
        message = port.read(timeout=60)
        first, *rest = message.value
        if message.wants_reply:
            message.reply(["answer", *rest])
            continue
        if first == "die" and rest in ([], [sys.argv[2]]):
            os._exit(9)
        print(first, *(len(each) for each in rest), message.source, message.envelope, flush=True)
        if first == "end":
            break
    while port.inputs:
        time.sleep(0.01)
    print("left", flush=True)
print("closed", flush=True)
"""

SENDER = """
import sys, time, yarpy
names = yarpy.YarpNameClient("127.0.0.1", int(sys.argv[1]))
with yarpy.RpcClient(name="/asker", names=names) as client:
    client.connect("/receiver", "mpi")
    print(*client.call("question", 7, timeout=30), flush=True)
with yarpy.Port("/sender", names=names) as port:
    port.connect("/receiver", "mpi")
    print(port.outputs[0].carrier, flush=True)
    for size in (0, 1, 70_000, 3_000_000):
        port.write(["message", bytes(size)], "5 1.5")
    port.write([sys.argv[2]])
    while sys.argv[2] == "die" and port.outputs:
        time.sleep(0.01)
    print("told", flush=True)
print("closed", flush=True)
"""

CASTER = """
import sys, time, yarpy
names = yarpy.YarpNameClient("127.0.0.1", int(sys.argv[1]))
with yarpy.Port("/sender", names=names) as port:
    port.connect("/one", "bcast")
    port.write(["alone"])
    port.connect("/two", "bcast")
    for size in (1, 70_000, 3_000_000):
        port.write(["both", bytes(size)], "5 1.5")
    port.disconnect("/one")
    port.write(["two"])
    port.connect("/one", "bcast")
    port.write(["again"])
    port.write(["die", "/two"])
    while [output.target for output in port.outputs] != ["/one"] or not port.write(["after"]):
        time.sleep(0.05)
    port.write(["end"])
print("closed", flush=True)
"""


HELD = """
import sys, yarpy
names = yarpy.YarpNameClient("127.0.0.1", int(sys.argv[1]))
with yarpy.Port("/held", names=names) as port:
    print("port", port.contact.port, flush=True)
    sys.stdin.read()
    print("loaded", "mpi4py" in sys.modules, flush=True)
"""
ONE = """
import sys, yarpy
names = yarpy.YarpNameClient("127.0.0.1", int(sys.argv[1]))
with yarpy.Port("/sender", names=names) as port:
    port.connect("/held", "mpi")
    print(port.outputs[0].carrier, "to", port.outputs[0].target, flush=True)
"""
PLACES = (
    "tag#0$connentry#00$",
    "tag#0$connentry#" + 255 * "FF" + "$",
    "",
)


@pytest.fixture
def start(request: pytest.FixtureRequest) -> Iterator[Start]:
    with mpi_library(request.param) as start:
        yield start


@contextlib.contextmanager
def program(start: Start, code: str, *words: str) -> Iterator[Process]:
    with Process([*start.command, sys.executable, "-c", code, *words], env=start.environment) as it:
        yield it


@pytest.mark.parametrize(
    ("start", "end"),
    [("mpich", "end"), pytest.param("openmpi", "die", marks=pytest.mark.peer("openmpi"))],
    indirect=["start"],
)
def test_messages_questions_and_the_end(start: Start, end: str) -> None:
    with (
        yarpy.NameServer(free_block(20)) as names,
        program(start, RECEIVER, str(names.port), "/receiver") as receiver,
    ):
        receiver.wait_line("ready", timeout=HANG)
        with program(start, SENDER, str(names.port), end) as sender:
            sender.wait_line("answer 7", timeout=HANG)
            sender.wait_line("^mpi$", timeout=HANG)
            for size in (0, 1, 70_000, 3_000_000):
                receiver.wait_line(f"message {size} /sender 5 1.5", timeout=HANG)
            if end == "end":
                receiver.wait_line("left", timeout=HANG)
                receiver.wait_line("closed", timeout=HANG)
            sender.wait_line("closed", timeout=HANG)
            assert sender.wait(HANG) == 0
            assert receiver.wait(HANG) == (0 if end == "end" else 9)


@pytest.mark.parametrize(
    "start", ["mpich", pytest.param("openmpi", marks=pytest.mark.peer("openmpi"))], indirect=True
)
def test_from_one_to_all(start: Start) -> None:
    """Readers come and go; one dies, and the others are connected again."""
    with (
        yarpy.NameServer(free_block(20)) as names,
        program(start, RECEIVER, str(names.port), "/one") as one,
        program(start, RECEIVER, str(names.port), "/two") as two,
    ):
        for reader in (one, two):
            reader.wait_line("ready", timeout=HANG)
        with program(start, CASTER, str(names.port)) as sender:
            for size in (1, 70_000, 3_000_000):
                for reader in (one, two):
                    reader.wait_line(f"both {size} /sender 5 1.5", timeout=HANG)
            assert two.wait(HANG) == 9
            one.wait_line("after", timeout=HANG)
            one.wait_line("closed", timeout=HANG)
            assert one.wait(HANG) == 0
            assert sender.wait(HANG) == 0
    told = [[line.split()[0] for line in each.stdout.splitlines()] for each in (one, two)]
    assert told[0][:6] == ["ready", "alone", "both", "both", "both", "again"]
    assert told[1] == ["ready", "both", "both", "both", "two", "again"]


@pytest.mark.parametrize("carrier", ["MPI_____", "MPIBCAST"])
def test_a_stranger_cannot_make_a_program_load_mpi(carrier: str) -> None:
    """Where it is installed: MPI ends a program for whom it reads such a place."""
    with (
        yarpy.NameServer(free_block(20)) as names,
        mpi_library("mpich") as start,
        Process(
            [sys.executable, "-c", HELD, str(names.port)],
            env={key: value for key, value in start.environment.items() if key != "YARPY_MPI"},
        ) as held,
    ):
        port = int(held.wait_line(r"port (\d+)", timeout=HANG)[1])
        for number in (port, names.port):
            for place in PLACES:
                with socket.create_connection(("127.0.0.1", number), HANG) as sock:
                    sock.sendall(f"{carrier}/s\r\ninitiator\r\n{place}\r\n".encode())
                    with sock.makefile("rb") as answer:
                        assert b"YARPY_MPI=yes" in answer.read()
        held.end_input()
        held.wait_line("loaded False", timeout=HANG)
        assert held.wait(HANG) == 0


def test_a_program_that_takes_mpi_survives_strangers() -> None:
    """The places that they name end only the helper that went there."""
    with yarpy.NameServer(free_block(20)) as names, mpi_library("mpich") as start:
        asked = [*start.command, sys.executable, "-c", HELD, str(names.port)]
        with Process(asked, env=start.environment) as held:
            port = int(held.wait_line(r"port (\d+)")[1])
            for magic, place in zip(("MPI_____", "MPIBCAST", "MPI_____"), PLACES, strict=True):
                with socket.create_connection(("127.0.0.1", port), 30) as sock:
                    sock.sendall(f"{magic}/s\r\ninitiator\r\n{place}\r\n".encode())
                    with sock.makefile("rb") as answer:
                        assert answer.read().startswith(b"* MPI ")
            with program(start, ONE, str(names.port)) as sender:
                sender.wait_line("mpi to /held")
            held.end_input()
            held.wait_line("loaded False")
            assert held.wait() == 0
