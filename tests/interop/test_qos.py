"""What is asked for reaches the kernel: seen by other programs, typed as a person types it."""

import os
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator

import pytest
from support.command_line import CommandLine
from support.wait import HANG

import yarpy


def may_schedule() -> bool:
    """Whether this process may have SCHED_FIFO."""
    allowed = []

    def attempt() -> None:
        try:
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(5))
            allowed.append(True)
        except (OSError, AttributeError):
            pass

    thread = threading.Thread(target=attempt)
    thread.start()
    thread.join()
    return bool(allowed)


@pytest.fixture
def cli(tmp_path) -> Iterator[CommandLine]:
    with yarpy.NameServer() as server:
        yield CommandLine(tmp_path, server.environment)


@pytest.fixture
def ports(cli) -> Iterator[tuple[yarpy.Port, yarpy.Port]]:
    with yarpy.Port("/publisher1") as out, yarpy.Port("/subscriber1") as in_:
        out.connect("/subscriber1")
        yield out, in_


@pytest.mark.skipif(not may_schedule(), reason="real-time scheduling needs root or CAP_SYS_NICE")
@pytest.mark.peer("chrt")
def test_chrt_sees_the_policy_that_was_typed(cli, ports):
    line = "prop set /subscriber1 (sched ((policy SCHED_FIFO) (priority 30)))\n"
    done = subprocess.run(
        [sys.executable, "-m", "yarpy", "admin", "rpc", "/publisher1"],
        input=line, capture_output=True, text=True, env=cli.environment, timeout=HANG,
    )  # fmt: skip
    assert "[ok]" in done.stdout, done
    reply = yarpy.admin("/publisher1", "prop", "get", "/subscriber1")
    found = {str(key): value for key, value in reply.find("sched")}
    told = subprocess.run(
        ["chrt", "-p", str(found["tid"])], capture_output=True, text=True, timeout=HANG
    ).stdout
    assert "SCHED_FIFO" in told
    assert told.rstrip().endswith("30")
    out, in_ = ports
    out.write(["still", "works"])
    assert in_.read(timeout=HANG).value == ["still", "works"]


def test_packets_on_the_wire_carry_the_class_of_each_end(cli, ports):
    try:
        wire = socket.socket(socket.AF_PACKET, socket.SOCK_DGRAM, socket.ntohs(0x0800))
    except (AttributeError, PermissionError):
        pytest.skip("seeing packets needs Linux and root or CAP_NET_RAW")
    out, in_ = ports
    done = cli.run("qos", "set", "/publisher1", "/subscriber1", "--src", "HIGH", "--des", "CRIT")
    assert done.returncode == 0, done
    here = out.outputs[0]._link.driver.transport.sock.getsockname()[1]
    seen = {}
    with wire:
        wire.bind(("lo", 0))
        wire.settimeout(0.2)
        until, again = time.monotonic() + 20, 0.0
        while len(seen) < 2 and time.monotonic() < until:
            if time.monotonic() > again:  # packets get lost in what other programs send
                out.write(["look"])
                in_.read(timeout=HANG)
                out.flush(5)
                again = time.monotonic() + 0.2
            try:
                packet = wire.recv(65535)
            except TimeoutError:
                continue
            header = (packet[0] & 15) * 4
            if packet[9] != socket.IPPROTO_TCP or len(packet) <= header + 4:
                continue
            from_, to = (int.from_bytes(packet[header + n : header + n + 2]) for n in (0, 2))
            payload = packet[header + (packet[header + 12] >> 4) * 4 :]
            if payload and here in (from_, to):
                seen["data" if from_ == here else "acknowledgement"] = packet[1]
    assert seen == {"data": 144, "acknowledgement": 176}
