"""mpi and bcast between programs that were started apart, with each MPI library we have."""

import contextlib
import sys
from collections.abc import Iterator

import pytest
from support.mpi import LIBRARIES, Start, mpi_library
from support.patience import patience
from support.port import free_block
from support.process import Process

import yarpy

LONG = patience(30.0)

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


@pytest.fixture
def start(request: pytest.FixtureRequest) -> Iterator[Start]:
    with mpi_library(request.param) as start:
        yield start


@contextlib.contextmanager
def program(start: Start, code: str, *words: str) -> Iterator[Process]:
    with Process([*start.command, sys.executable, "-c", code, *words], env=start.environment) as it:
        yield it


@pytest.mark.parametrize(
    ("start", "end"), [("mpich", "end"), ("openmpi", "die")], indirect=["start"]
)
def test_messages_questions_and_the_end(start: Start, end: str) -> None:
    with (
        yarpy.NameServer(free_block(20)) as names,
        program(start, RECEIVER, str(names.port), "/receiver") as receiver,
    ):
        receiver.wait_line("ready", timeout=LONG)
        with program(start, SENDER, str(names.port), end) as sender:
            sender.wait_line("answer 7", timeout=LONG)
            sender.wait_line("^mpi$", timeout=LONG)
            for size in (0, 1, 70_000, 3_000_000):
                receiver.wait_line(f"message {size} /sender 5 1.5", timeout=LONG)
            if end == "end":
                receiver.wait_line("left", timeout=LONG)
                receiver.wait_line("closed", timeout=LONG)
            sender.wait_line("closed", timeout=LONG)
            assert sender.wait(LONG) == 0
            assert receiver.wait(LONG) == (0 if end == "end" else 9)


@pytest.mark.parametrize("start", LIBRARIES, indirect=True)
def test_from_one_to_all(start: Start) -> None:
    """Readers come and go; one dies, and the others are connected again."""
    with (
        yarpy.NameServer(free_block(20)) as names,
        program(start, RECEIVER, str(names.port), "/one") as one,
        program(start, RECEIVER, str(names.port), "/two") as two,
    ):
        for reader in (one, two):
            reader.wait_line("ready", timeout=LONG)
        with program(start, CASTER, str(names.port)) as sender:
            for size in (1, 70_000, 3_000_000):
                for reader in (one, two):
                    reader.wait_line(f"both {size} /sender 5 1.5", timeout=LONG)
            assert two.wait(LONG) == 9
            one.wait_line("after", timeout=LONG)
            one.wait_line("closed", timeout=LONG)
            assert one.wait(LONG) == 0
            assert sender.wait(LONG) == 0
    told = [[line.split()[0] for line in each.stdout.splitlines()] for each in (one, two)]
    assert told[0][:6] == ["ready", "alone", "both", "both", "both", "again"]
    assert told[1] == ["ready", "both", "both", "both", "two", "again"]
