"""Faults, made for real: each is one way in which nothing arrives, and what the doctor must find.

Rules: `make` sets the fault up in a World, yields what is asked for (no name, one, or two), and
cleans up. Nothing is faked that can be had: programs are killed and stopped, sockets closed,
clocks and types wrong. docs/doctor.md has a table made of this one.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final
from unittest import mock

import numpy as np
import pytest
from support.multicast import needs_multicast
from support.port import free_port
from support.process import Process
from support.wait import HANG, wait_until

import yarpy
import yarpy.network.qos
from yarpy import network
from yarpy.data.value import Vocab
from yarpy.kits.doctor import process
from yarpy.port.keep.keepalive import Keepalive


class World:
    """A name server, found by the files of a home directory, and the ports of the faults."""

    def __init__(self, home: Path, server: yarpy.NameServer) -> None:
        self.home = home
        self.server = server
        self.names = server.client
        self.stack = ExitStack()
        self.options: dict[str, Any] = {}  # for the Case
        self.acts: list[Counter[str]] = []  # what is done again and again, and how often it was

    def open(self, name: str, kind: Any = yarpy.BufferedPort, **options: Any) -> Any:
        return self.stack.enter_context(kind(name, names=self.names, **options))

    def again(self, act: Callable[[], object], pause: float = 0.01) -> None:
        """Do it again and again, in a thread, until the fault is over."""
        over = threading.Event()
        done: Counter[str] = Counter()
        self.acts.append(done)

        def run() -> None:
            while not over.wait(pause):
                with contextlib.suppress(yarpy.YarpError):
                    act()
                done["times"] += 1

        thread = threading.Thread(target=run, daemon=True)
        thread.start()
        self.stack.callback(thread.join, HANG)
        self.stack.callback(over.set)

    def sleep(self, seconds: float) -> None:
        """Sleep as the doctor does between two looks, and on a busy machine until all that is done
        again and again was done a few times."""
        before = [done["times"] for done in self.acts]
        time.sleep(seconds)
        for done, times in zip(self.acts, before, strict=True):
            wait_until(lambda done=done, times=times: done["times"] > times + 2)  # type: ignore[misc]

    def program(self, code: str) -> Process:
        """A program of its own that opens ports at this server, and has said so."""
        code = f"import yarpy\n{code}\nprint('ready', flush=True)\nimport time\ntime.sleep(600)"
        environment = {**os.environ, **self.server.environment}
        process = self.stack.enter_context(
            Process([sys.executable, "-c", code], env=environment, cwd=self.home)
        )
        process.wait_line("ready")
        return process


Make = Callable[[World], Iterator[tuple[str, ...]]]


@dataclass(frozen=True)
class Fault:
    """`what` is done, which the doctor calls `probe`."""

    probe: str
    what: str
    make: Callable[[World], Any]
    also: tuple[str, ...] = ()  # what it brings with it


FAULTS: Final[list[Fault]] = []


def fault(probe: str, what: str, *also: str) -> Callable[[Make], Make]:
    def add(make: Make) -> Make:
        FAULTS.append(Fault(probe, what, contextmanager(make), also))
        return make

    return add


# --- name servers


@fault("no-server", "`yarp.conf` says where a name server was, and it has ended")
def ended_server(world: World) -> Iterator[tuple[str, ...]]:
    (world.home / "yarp.conf").write_text(f"127.0.0.1 {free_port()} yarp\n")
    yield ("/talker", "/listener")


@fault("no-server", "no name server was ever configured")
def no_configuration(world: World) -> Iterator[tuple[str, ...]]:
    (world.home / "yarp.conf").unlink()
    yield ()


@fault("two-servers", "somebody starts a second name server in the same network")
def second_server(world: World) -> Iterator[tuple[str, ...]]:
    needs_multicast()
    with yarpy.NameServer(discoverable=True) as second:
        from yarpy.names.default import DEFAULT

        DEFAULT.pop(second.client)  # it is not that of this program
        yield ()


@fault("other-namespace", "the port is registered in the namespace /lab, the shell uses /root")
def other_namespace(world: World) -> Iterator[tuple[str, ...]]:
    lab = yarpy.NameServer(name="/lab")
    try:
        with yarpy.Port("/listener", names=lab.client):
            (world.home / "_lab.conf").write_text(f"127.0.0.1 {lab.port} yarp\n")
            world.open("/talker")
            yield ("/talker", "/listener")
    finally:
        lab.close()


# --- names and addresses


@fault("unknown-name", "a name is misspelt")
def misspelt(world: World) -> Iterator[tuple[str, ...]]:
    world.open("/talker")
    world.open("/listener")
    yield ("/talker", "/listner")


@fault("dead-name", "the receiver's program is killed with -9")
def killed(world: World) -> Iterator[tuple[str, ...]]:
    world.open("/talker")
    program = world.program("port = yarpy.BufferedPort('/listener')")
    program.kill()
    yield ("/talker", "/listener")


@fault("other-port", "the number of a dead port was given to another one")
def other_port(world: World) -> Iterator[tuple[str, ...]]:
    arm = world.open("/arm")
    world.open("/talker")
    world.names.register("/listener", "tcp", "127.0.0.1", arm.contact.port)
    yield ("/talker", "/listener")


@fault("duplicate-name", "a second program takes a name that a living one has",
       "one-sided", "writes-nothing")  # fmt: skip
def duplicate(world: World) -> Iterator[tuple[str, ...]]:
    if sys.platform == "darwin":
        pytest.skip("macOS says who listens to nobody but root")
    world.open("/talker").connect(world.open("/listener").name)
    world.names.unregister("/listener")
    # The first one may have noticed, and be registered again.
    with mock.patch("yarpy.port.keep.registration.Registration._refuse_taken"):
        world.open("/listener")
    yield ("/talker", "/listener")


@fault("unreachable", "the port has registered an address that does not exist here")
def unreachable(world: World) -> Iterator[tuple[str, ...]]:
    world.open("/talker")
    world.names.register("/listener", "tcp", "listener.invalid", free_port())
    look_up = socket.getaddrinfo

    def resolver(host: Any, *others: Any, **more: Any) -> Any:
        """One that says the same in every network."""
        if host == "listener.invalid":
            raise socket.gaierror(socket.EAI_NONAME, "Name or service not known")
        return look_up(host, *others, **more)

    with mock.patch("socket.getaddrinfo", resolver):
        yield ("/talker", "/listener")


# --- programs


@fault("stopped", "the receiver's program is stopped with SIGSTOP")
def stopped(world: World) -> Iterator[tuple[str, ...]]:
    if sys.platform != "linux":
        pytest.skip("only Linux says which programs are stopped")
    talker = world.open("/talker")
    program = world.program("port = yarpy.BufferedPort('/listener')")
    talker.connect("/listener")
    program.signal(signal.SIGSTOP)
    try:
        yield ("/talker", "/listener")
    finally:
        program.signal(signal.SIGCONT)


@fault("hangs", "a program listens and never answers")
def hangs(world: World) -> Iterator[tuple[str, ...]]:
    world.open("/talker")
    with socket.create_server(("127.0.0.1", 0)) as silent:
        world.names.register("/listener", "tcp", "127.0.0.1", silent.getsockname()[1])
        yield ("/talker", "/listener")


@fault("descriptors", "a program has used up its file descriptors")
def descriptors(world: World) -> Iterator[tuple[str, ...]]:
    if sys.platform != "linux":
        pytest.skip("only Linux says how many descriptors a program has")
    world.program(
        "port = yarpy.BufferedPort('/listener')\n"
        "import os, resource\n"
        "resource.setrlimit(resource.RLIMIT_NOFILE, (64, 64))\n"
        "files = [open(os.devnull) for _ in range(60 - len(os.listdir('/proc/self/fd')))]"
    )
    yield ("/listener",)


# --- connections


@fault("not-connected", "both ports are there, and nobody has connected them")
def not_connected(world: World) -> Iterator[tuple[str, ...]]:
    world.open("/talker")
    world.open("/listener")
    yield ("/talker", "/listener")


@fault("wrong-way", "source and target were mixed up in `yarpy connect`")
def wrong_way(world: World) -> Iterator[tuple[str, ...]]:
    world.open("/talker")
    world.open("/listener").connect("/talker")
    yield ("/talker", "/listener")


@fault("one-sided", "the sender's end of a udp connection is lost")
def one_sided(world: World) -> Iterator[tuple[str, ...]]:
    yield from _forgotten(world, "udp")


@fault("stale-multicast", "the sender's end of a multicast connection is lost")
def stale_multicast(world: World) -> Iterator[tuple[str, ...]]:
    yield from _forgotten(world, "mcast")


def _forgotten(world: World, carrier: str) -> Iterator[tuple[str, ...]]:
    talker, listener = world.open("/talker"), world.open("/listener")
    talker.connect("/listener", carrier)
    assert listener.wait_for_inputs(timeout=HANG)
    [link] = talker._hub.outputs.links
    # The listener would notice within a second, and mend it.
    with mock.patch.object(Keepalive, "look", lambda self, hubs: None):
        assert talker._hub.outputs.drop(link)
        yield ("/talker", "/listener")
    link.driver.transport.close()


# --- the flow of messages


@fault("writes-nothing", "the sender's program writes nothing")
def writes_nothing(world: World) -> Iterator[tuple[str, ...]]:
    talker = world.open("/talker")
    world.open("/listener", callback=lambda message: None)
    talker.connect("/listener")
    yield ("/talker", "/listener")


@fault("never-reads", "the receiver's program never reads")
def never_reads(world: World) -> Iterator[tuple[str, ...]]:
    talker = world.open("/talker")
    listener = world.open("/listener")
    talker.connect("/listener")
    world.again(lambda: talker.write([1.5]))
    wait_until(lambda: listener.waiting)
    yield ("/talker", "/listener")


@fault("held-up", "the receiver's callback does not return, and the sender waits for it")
def held_up(world: World) -> Iterator[tuple[str, ...]]:
    busy, called = threading.Event(), threading.Event()

    def callback(message: yarpy.Message) -> None:
        called.set()
        busy.wait(60)

    talker = world.open("/talker", yarpy.Port)
    world.open("/listener", callback=callback)
    world.stack.callback(busy.set)
    talker.connect("/listener")
    thread = threading.Thread(target=lambda: [talker.write([2], timeout=30) for _ in range(300)])
    thread.start()
    world.stack.callback(thread.join, 10)
    world.stack.callback(busy.set)
    assert called.wait(HANG)
    time.sleep(0.05)
    yield ("/talker", "/listener")


@fault("too-slow", "the receiver takes a while for each of many messages")
def too_slow(world: World) -> Iterator[tuple[str, ...]]:
    talker = world.open("/talker")
    listener = world.open("/listener", callback=lambda message: time.sleep(0.05))
    talker.connect("/listener")
    world.again(lambda: talker.write([1.5]), 0.002)
    wait_until(lambda: listener.inputs and listener.inputs[0].stats.messages > 2)
    yield ("/talker", "/listener")


@fault("late", "messages are older than the deadline of their connection")
def late(world: World) -> Iterator[tuple[str, ...]]:
    talker = world.open("/talker")
    listener = world.open("/listener", callback=lambda message: None)
    talker.connect("/listener")
    assert listener.wait_for_inputs(timeout=HANG)
    network.qos.grant(
        "/talker", "/listener", receiver=yarpy.Qos(deadline=0.02, rate=50), names=world.names
    )
    world.again(lambda: talker.write([1], yarpy.Stamp(1, time.time() - 0.1)))
    wait_until(lambda: listener.inputs[0].stats.missed)
    yield ("/talker", "/listener")


# --- what is sent


@fault("type-mismatch", "a program that wants images gets lists")
def unusable(world: World) -> Iterator[tuple[str, ...]]:
    talker = world.open("/talker")
    listener = world.open("/listener", callback=lambda message: message.as_(yarpy.Image))
    talker.connect("/listener")
    world.again(lambda: talker.write([1, "two"]))
    wait_until(lambda: listener.inputs and listener.inputs[0].stats.drops > 1)
    yield ("/talker", "/listener")


@fault("type-mismatch", "a port that says it takes images gets vectors")
def undeclared(world: World) -> Iterator[tuple[str, ...]]:
    talker = world.open("/talker")
    world.open("/listener", port_type="yarp/image", callback=lambda message: None)
    talker.connect("/listener")
    world.again(lambda: talker.write(yarpy.Vector([1.0, 2.0])))
    yield ("/talker", "/listener")


@fault("clock-skew", "the clock of the sender's computer is an hour ahead")
def clock_skew(world: World) -> Iterator[tuple[str, ...]]:
    talker = world.open("/talker")
    world.open("/listener", callback=lambda message: None)
    talker.connect("/listener")
    world.again(lambda: talker.write([1], yarpy.Stamp(1, time.time() + 3600)))
    yield ("/talker", "/listener")


@fault("two-dialects", "the sender is a port of C++ YARP 3, the receiver one of C++ YARP 4")
def two_dialects(world: World) -> Iterator[tuple[str, ...]]:
    """They answer as those do."""
    talker = world.open("/talker")
    listener = world.open("/listener", callback=lambda message: None)
    talker.connect("/listener")
    unheard = yarpy.Bottle([Vocab("fail"), "send [help] for list of valid commands"])
    listener._hub.callbacks.node = lambda request: (
        unheard if str(request[0]) in ("bus", "stat") else None
    )
    told = {"bus": yarpy.Bottle([1, "", []]), "stat": unheard}
    talker._hub.callbacks.node = lambda request: told.get(str(request[0]))
    world.again(lambda: talker.write([1.5]))
    yield ("/talker", "/listener")


# --- monitors and carriers


@fault("monitor-drops", "a monitor for images rides on a connection for lists")
def monitor_drops(world: World) -> Iterator[tuple[str, ...]]:
    talker = world.open("/talker")
    world.open("/listener", callback=lambda message: None)
    talker.connect("/listener", "tcp+recv.image_to_mono")
    world.again(lambda: talker.write([1, 2]))
    yield ("/talker", "/listener")


@fault("monitor-drops", "a monitor of the port itself lets nothing out")
def port_monitor_drops(world: World) -> Iterator[tuple[str, ...]]:
    talker = world.open("/talker")
    world.open("/listener", callback=lambda message: None)
    talker.connect("/listener")
    talker.attach("out", {"monitor": "image_to_mono"})
    world.again(lambda: talker.write([1, 2]))
    yield ("/talker", "/listener")


@fault("starved", "a stronger connection has priority at the receiver")
def starved(world: World) -> Iterator[tuple[str, ...]]:
    talker, strong = world.open("/talker"), world.open("/strong")
    listener = world.open("/listener", callback=lambda message: None)
    talker.connect("/listener", "tcp+recv.priority+st.10+tc.5+bs.1")
    strong.connect("/listener", "tcp+recv.priority+st.10+tc.5+bs.20")
    assert listener.wait_for_inputs(2, timeout=HANG)
    strong.write([0])
    wait_until(lambda: sum(one.stats.messages for one in listener.inputs))
    world.again(lambda: strong.write([0]))
    world.again(lambda: talker.write([1]))
    yield ("/talker", "/listener")


@fault("lost-datagrams", "messages over udp are larger than the receiver takes")
def lost_datagrams(world: World) -> Iterator[tuple[str, ...]]:
    talker = world.open("/talker")
    world.open("/listener", callback=lambda message: None, limit=50_000)
    talker.connect("/listener", "udp")
    data = yarpy.Vector(np.zeros(20_000))
    world.again(lambda: talker.write(data), 0.02)
    yield ("/talker", "/listener")


@fault("small-buffers", "messages over udp are larger than the system's buffers for it")
def small_buffers(world: World) -> Iterator[tuple[str, ...]]:
    most = process.setting("net/core/rmem_max")
    if most is None or most > 1 << 25:
        pytest.skip("this system sets no such limit, or a large one")
    talker = world.open("/talker")
    world.open("/listener", callback=lambda message: None)
    talker.connect("/listener", "udp")
    data = yarpy.Vector(np.zeros(most // 8 + 1000))
    talker.write(data)
    world.again(lambda: talker.write(data), 0.05)
    yield ("/talker", "/listener")


@fault("nothing-arrives", "multicast does not reach the receiver, as where a switch stops it")
def nothing_arrives(world: World) -> Iterator[tuple[str, ...]]:
    talker = world.open("/talker")
    listener = world.open("/listener", callback=lambda message: None)
    talker.connect("/listener", "mcast")
    assert listener.wait_for_inputs(timeout=HANG)
    [link] = [one for one in listener._hub.inputs.links if one.carrier.name == "mcast"]
    transport = link.driver.transport
    group = socket.inet_aton(transport._group)
    with contextlib.suppress(OSError):  # IP_MULTICAST_ALL: not what others here have joined, either
        transport.sock.setsockopt(socket.IPPROTO_IP, 49, 0)
    for address in ("0.0.0.0", talker.contact.host):
        with contextlib.suppress(OSError):
            transport.sock.setsockopt(
                socket.IPPROTO_IP, socket.IP_DROP_MEMBERSHIP, group + socket.inet_aton(address)
            )
    world.again(lambda: talker.write([1]))
    yield ("/talker", "/listener")


@fault("text-of-images", "images go over the carrier text")
def text_of_images(world: World) -> Iterator[tuple[str, ...]]:
    talker = world.open("/talker")
    world.open("/listener", callback=lambda message: None)
    talker.connect("/listener", "text")
    image = yarpy.Image(np.zeros((8, 8, 3), np.uint8))
    world.again(lambda: talker.write(image), 0.05)
    yield ("/talker", "/listener")


# --- priorities and the system


@fault("not-granted", "a thread's priority was asked for, and taken away by `chrt`")
def not_granted(world: World) -> Iterator[tuple[str, ...]]:
    if not hasattr(os, "sched_setscheduler"):
        pytest.skip("this system has no priorities of threads")
    talker = world.open("/talker")
    listener = world.open("/listener", callback=lambda message: None)
    talker.connect("/listener")
    assert listener.wait_for_inputs(timeout=HANG)
    with contextlib.suppress(yarpy.LocalProtocolError):  # or it was not given in the first place
        listener.inputs[0].qos = yarpy.Qos("FIFO", 5)
    [link] = [one for one in listener._hub.inputs.links if one.route.source == "/talker"]
    thread = link.thread.native_id
    os.sched_setscheduler(thread, os.SCHED_OTHER, os.sched_param(0))
    world.again(lambda: talker.write([1]))
    yield ("/talker", "/listener")


@fault("shared-memory", "`/dev/shm` is full")
def shared_memory(world: World) -> Iterator[tuple[str, ...]]:
    folder = world.home / "shm"
    folder.mkdir()
    mounted = (
        shutil.which("mount")
        and not subprocess.run(
            ["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", folder], capture_output=True
        ).returncode
    )
    if not mounted:
        pytest.skip("only root can mount a small file system")
    world.options["shared_memory"] = folder
    try:
        (folder / "left behind").write_bytes(b"x" * 60_000)
        yield ()
    finally:
        subprocess.run(["umount", folder], check=True)
