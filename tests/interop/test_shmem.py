"""shmem with C++ YARP: streams and calls both ways, memory that grows, peers that are killed."""

import os
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.cpp import CppYarp
from support.cpp_carrier import carrier_program
from support.peer import brings
from support.wait import HANG, wait_until

import yarpy
from yarpy.transports.shared.sysv import available

pytestmark = pytest.mark.skipif(not available(), reason="no memory of System V here")

SIZES = (3, 6000, 10, 200_000, 5)


@pytest.fixture(scope="module")
@brings("g++")
def program(cpp: CppYarp) -> str:
    return carrier_program(cpp, "shmem")


@pytest.fixture(autouse=True)
def nothing_left() -> Iterator[None]:
    """Neither files of mutexes nor memory of programs that have ended."""

    def files() -> set[str]:
        return {name for name in os.listdir("/tmp") if name.startswith("SHMEM_")}

    def memory() -> set[str]:
        lines = [
            line.split()
            for line in Path("/proc/sysvipc/shm").read_text(encoding="utf-8").splitlines()[1:]
        ]
        return {line[1] for line in lines if line[6] == "0"}  # nobody has it

    before = files(), memory()
    yield
    wait_until(
        lambda: files() <= before[0] and memory() <= before[1],
        what="all that was shared has gone",
    )


def connect(programs: CppYarp, program: str) -> None:
    said = programs.run("connect", "/cpp", "/ours", "shmem", program=program)
    assert "Success" in said.stdout, said


@pytest.mark.parametrize("end", ["leaves", "is killed"])
def test_cpp_sends(our_names: CppYarp, program: str, end: str) -> None:
    with (
        yarpy.Port("/ours") as port,
        our_names.popen("write", "/cpp", program=program) as peer,
    ):
        peer.wait_line("/cpp active")
        assert (
            "Success" in our_names.run("connect", "/cpp", "/ours", "shmem", program=program).stdout
        )
        for size in SIZES:
            peer.write_line("x" * size)
            message = port.read(timeout=HANG)
            assert (message.value, message.source) == (["x" * size], "/cpp")
        assert port.inputs[0].carrier == "shmem"
        if end == "leaves":
            peer.end_input()
        else:
            peer.signal(signal.SIGKILL)
        wait_until(lambda: not port.inputs, what="the port sees that its sender has gone")


@pytest.mark.parametrize("end", ["stays", "is killed"])
def test_cpp_receives(our_names: CppYarp, program: str, end: str) -> None:
    with (
        yarpy.Port("/ours") as port,
        our_names.popen("read", "/cpp", program=program) as peer,
    ):
        peer.wait_line("/cpp active")
        port.connect("/cpp", "shmem")
        for number, size in enumerate(SIZES):
            assert port.write([f"n{number}", "x" * size]) == 1
        peer.wait_line(f"n{len(SIZES) - 1} xxxxx", stream="out")
        came = [line for line in peer.stdout.splitlines() if line.endswith("x")]
        assert came == [f"n{number} {'x' * size}" for number, size in enumerate(SIZES)]
        if end == "stays":
            assert port.disconnect("/cpp")
            peer.wait_line("Removing input from /ours to /cpp")
        else:
            peer.signal(signal.SIGKILL)
            wait_until(lambda: not port.outputs, what="the port sees that its reader has gone")


def test_cpp_answers(our_names: CppYarp, program: str) -> None:
    with (
        our_names.popen("rpcserver", "/cpp", program=program) as peer,
        yarpy.RpcClient(name="/ours") as client,
    ):
        peer.wait_line("/cpp active")
        client.connect("/cpp", "shmem")
        for text in ("one", "x" * 6000):
            peer.write_line(f"reply {text}")
            assert client.call("question", timeout=HANG) == ["reply", text]


def test_cpp_asks(our_names: CppYarp, program: str) -> None:
    with (
        yarpy.RpcServer("/ours", lambda message: ["answer", len(message.value[0]), "y" * 6000]),
        our_names.popen("rpc", "--client", "/cpp", program=program) as peer,
    ):
        peer.wait_line("/cpp active")
        connect(our_names, program)
        peer.write_line("x")
        peer.write_line("x" * 6000)
        peer.end_input()
        assert peer.wait(HANG) == 0
        for size in (1, 6000):
            assert f"answer {size} {'y' * 6000}" in peer.stdout
