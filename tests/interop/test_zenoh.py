"""Ports that reach each other through routers of Zenoh, as if there were no other way."""

from __future__ import annotations

import random
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from support import tls
from support.cpp import CppYarp
from support.port import free_block, free_port
from support.wait import HANG, wait_until

import yarpy
from yarpy.config.authority import make
from yarpy.errors import AccessRefused, LocalProtocolError, YarpError
from yarpy.peers.zenoh import reachability as direct
from yarpy.peers.zenoh.names import ZenohNames
from yarpy.peers.zenoh.router import open_router
from yarpy.peers.zenoh.transport import close
from yarpy.peers.zenoh.tunnel import exchange as zenoh_exchange

pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[zenoh]"')


class Lab:
    """Two routers, each with a program's names; there is no way between the two but through
    them."""

    def __init__(self) -> None:
        self.numbers = [free_port(), free_port()]
        self.first = open_router([self.where(0)])
        self.start()
        self.near, self.far = (ZenohNames(self.where(i)) for i in (0, 1))

    def where(self, number: int) -> str:
        return f"127.0.0.1:{self.numbers[number]}"

    def start(self) -> None:
        """Start the router of the far side."""
        self.second = open_router([self.where(1)], [self.where(0)])

    def stop(self) -> None:
        close(self.second)


@pytest.fixture(autouse=True)
def _far_away(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("YARPY_ZENOH", "YARPY_TLS", "YARPY_BIND", "YARPY_ACCESS"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(direct.Reachability, "to", lambda self, entry: entry.through)


@pytest.fixture
def lab() -> Iterator[Lab]:
    made = Lab()
    yield made
    made.near.close()
    made.far.close()
    made.stop()
    close(made.first)
    wait_until(lambda: not zenoh_exchange._open)


def test_messages_answers_and_administration(lab: Lab) -> None:
    with (
        yarpy.Port("/out", names=lab.near) as out,
        yarpy.BufferedPort("/in", names=lab.far, strict=True) as in_,
        yarpy.RpcServer("/adder", lambda message: [sum(message.value)], names=lab.far),
    ):
        wait_until(lambda: lab.near.query("/adder") and lab.far.query("/out"))
        assert lab.near.query("/in").host.endswith(".zenoh")  # type: ignore[union-attr]
        connection = yarpy.connect("/out", "/in", names=lab.near)
        for number in range(300):
            out.write([number])
        assert [in_.read(timeout=HANG).value[0] for _ in range(300)] == [*range(300)]
        large = random.Random(1).randbytes(5_000_000)
        out.write(large)
        assert in_.read(timeout=HANG).value == large
        with yarpy.RpcClient("/adder", names=lab.near) as client:
            assert client.ask([1, 2, 3], timeout=HANG).value == [6]
        assert yarpy.admin("/in", "list", "in", names=lab.near)[0] == "/out"
        assert yarpy.exists("/out", "/in", names=lab.near)
        connection.qos = yarpy.Qos(packets="HIGH")
        assert connection.qos.packets == "AF42"
        out.write("with another priority")
        assert in_.read(timeout=HANG).value == "with another priority"
        assert yarpy.disconnect("/out", "/in", names=lab.far)
        wait_until(lambda: not (out.outputs or in_.inputs))


def test_a_slow_reader_holds_up_its_own_sender_alone(lab: Lab) -> None:
    with (
        yarpy.Port("/out/slow", names=lab.near) as held,
        yarpy.Port("/out", names=lab.near) as out,
        yarpy.Port("/slow", names=lab.far) as slow,
        yarpy.BufferedPort("/fast", names=lab.far, strict=True) as fast,
    ):
        wait_until(lambda: lab.near.query("/fast") and lab.near.query("/slow"))
        held.connect("/slow")
        out.connect("/fast")
        large = bytes(1 << 21)
        sender = threading.Thread(target=lambda: [held.write(large) for _ in range(20)])
        sender.start()
        for number in range(20):
            out.write([number, large])
            assert fast.read(timeout=HANG).value[0] == number
        assert sender.is_alive()
        for _ in range(20):
            assert slow.read(timeout=HANG).value == large
        sender.join(HANG)


def test_a_router_that_was_restarted_brings_names_and_connections_back(lab: Lab) -> None:
    with (
        yarpy.Port("/out", names=lab.near) as out,
        yarpy.BufferedPort("/in", names=lab.far, strict=True) as in_,
    ):
        wait_until(lambda: lab.near.query("/in"))
        out.connect("/in")
        out.write([0])
        assert in_.read(timeout=HANG).value == [0]
        lab.stop()
        sent = 1
        wait_until(lambda: not out.outputs)
        assert out.write([-1]) == 0
        lab.start()

        def arrives() -> bool:
            nonlocal sent
            sent += out.write([sent])
            return in_.waiting >= 2

        wait_until(arrives, 30)
        came = []
        while in_.waiting:
            came.append(in_.read(timeout=HANG).value[0])
        assert came == [*range(came[0], came[0] + len(came))]
        assert lab.near.query("/in")


def test_what_needs_a_direct_way_says_so(lab: Lab, monkeypatch: pytest.MonkeyPatch) -> None:
    with (
        yarpy.Port("/out", names=lab.near) as out,
        yarpy.BufferedPort("/in", names=lab.far) as in_,
    ):
        wait_until(lambda: lab.near.query("/in"))
        for carrier in ("udp", "mcast", "unix_stream", "local"):
            with pytest.raises(YarpError, match="Zenoh"):
                out.connect("/in", carrier)
        for carrier in ("fast_tcp", "text_ack", "websocket"):
            out.connect("/in", carrier)
            out.write([carrier])
            assert in_.read(timeout=HANG).value == [carrier]
        with pytest.raises(LocalProtocolError, match="tls/HOST"):
            out.connect("/in", "tls")


CARELESS = """
import sys, yarpy
from yarpy.peers.zenoh import reachability
reachability.Reachability.to = lambda self, entry: entry.through
near, far = (yarpy.zenoh.ZenohNames(f"{host}:{sys.argv[1]}") for host in ("127.0.0.1", "localhost"))
out, in_ = yarpy.Port("...", names=near), yarpy.BufferedPort("...", names=far)
out.connect(in_.name, timeout=10)
for number in range(20):
    out.write([number])
in_.read(timeout=10)
"""


def test_a_program_that_closes_nothing_ends_by_itself() -> None:
    """Threads that wait in a library when Python ends would abort the program."""
    number = free_port()
    router = open_router([f"127.0.0.1:{number}"])
    command = [sys.executable, "-W", "ignore", "-c", CARELESS, str(number)]
    programs = [subprocess.Popen(command, stderr=subprocess.PIPE, text=True) for _ in range(3)]
    for program in programs:
        _, said = program.communicate(timeout=HANG)
        assert program.returncode == 0, said
    close(router)


def test_rules_hold_for_those_who_come_through_zenoh(
    lab: Lab, monkeypatch: pytest.MonkeyPatch, tmp_path: object
) -> None:
    rules = tmp_path / "access.toml"  # type: ignore[operator]
    rules.write_text('[[allow]]\nwho = ["loopback"]\nmay = ["all"]\n')
    monkeypatch.setenv("YARPY_ACCESS", str(rules))
    with (
        yarpy.Port("/out", names=lab.near) as out,
        yarpy.BufferedPort("/in", names=lab.far),
    ):
        wait_until(lambda: lab.near.query("/in"))
        with pytest.raises(AccessRefused):
            out.connect("/in")


def test_where_tls_is_required_the_links_of_zenoh_are(
    tmp_path: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    tls.prepare(tmp_path / "tls", monkeypatch, "require")  # type: ignore[operator]
    where = f"127.0.0.1:{free_port()}"
    router = open_router([where])
    names, others = ZenohNames(where), ZenohNames(where.replace("127.0.0.1", "localhost"))
    with (
        yarpy.Port("/out", names=names) as out,
        yarpy.BufferedPort("/in", names=others) as in_,
    ):
        wait_until(lambda: names.query("/in"))
        out.connect("/in")
        out.write("in tls from router to router")
        assert in_.read(timeout=HANG).value == "in tls from router to router"
    names.close()
    others.close()
    close(router)
    wait_until(lambda: not [one for one in threading.enumerate() if ".zenoh" in one.name])


@pytest.mark.parametrize("direct_way", [True, False])
def test_cpp_programs_take_part(
    cpp: CppYarp, monkeypatch: pytest.MonkeyPatch, direct_way: bool
) -> None:
    """Through a server beside the names; where there is no direct way, through its gateway."""
    if direct_way:
        monkeypatch.setattr(direct.Reachability, "to", lambda self, entry: entry.contact)
    where = f"127.0.0.1:{free_port()}"
    router = open_router([where])
    names = ZenohNames(where.replace("127.0.0.1", "localhost"))
    with (
        yarpy.NameServer(free_block(200), beside={"zenoh": where}) as server,
        cpp.at("127.0.0.1", server.port) as programs,
        yarpy.BufferedPort("/ours/in", names=names, strict=True) as in_,
        yarpy.RpcServer("/ours/rpc", lambda message: ["echo", *message.value], names=names),
        yarpy.Port("/ours/out", names=names) as out,
        programs.popen("read", "/cpp/in") as reader,
    ):
        wait_until(lambda: names.query("/cpp/in") and server.client.query("/ours/rpc"))
        assert programs.run("exists", "/ours/in").returncode == 0
        written = programs.run("write", "/cpp/out", "/ours/in", input="1 2 (a b)\n")
        assert written.returncode == 0
        assert in_.read(timeout=HANG).value == [1, 2, ["a", "b"]]
        answer = programs.run("rpc", "/ours/rpc", input="hello\n").stdout
        assert "Response: echo hello" in answer
        out.connect("/cpp/in")
        out.write(["from", "Zenoh", 3])
        reader.wait_line("from Zenoh 3")
    names.close()
    close(router)


def test_the_access_list_of_the_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A guest may ask where ports are, and no more."""
    page = (Path(__file__).parents[2] / "docs" / "zenoh.md").read_text()
    (tmp_path / "router.json5").write_text(page.partition("```json5\n")[2].partition("```")[0])
    folder = tls.prepare(tmp_path / "tls", monkeypatch, "mutual")
    where = f"127.0.0.1:{free_port()}"
    router = open_router([where], file=str(tmp_path / "router.json5"))

    def names(who: str, host: str) -> ZenohNames:
        make(tmp_path / who, [who], folder)
        monkeypatch.setenv("YARPY_TLS_DIR", str(tmp_path / who))
        found = ZenohNames(f"tls/{where.replace('127.0.0.1', host)}")
        found.open()
        return found

    robot, guest = names("robot.lab", "127.0.0.1"), names("guest", "localhost")
    third = names("robot.lab", "127.0.0.1")
    with yarpy.BufferedPort("/robot/in", names=robot) as in_:
        wait_until(lambda: guest.query("/robot/in"))
        assert [contact.name for contact in guest.list()] == ["/robot/in"]
        with yarpy.Port("/guest/out", names=guest) as out:
            assert robot.query("/guest/out") is None and len(robot.list()) == 1
            with pytest.raises(YarpError, match="Zenoh"):
                out.connect("/robot/in")
        with yarpy.Port("/robot/out", names=third) as out:
            out.connect("/robot/in")
            out.write("from a robot")
            assert in_.read(timeout=HANG).value == "from a robot"
    for one in (robot, guest, third):
        one.close()
    close(router)
