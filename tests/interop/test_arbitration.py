"""Senders in C++ YARP 3.5 compete for one port of ours; C++ and netcat tell it who wins."""

from __future__ import annotations

import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.cpp import CppYarp
from support.cpp_program import CppProgram
from support.peer import program
from support.wait import HANG, wait_until

import yarpy
from yarpy.data.bottle import Bottle


@pytest.fixture(scope="module")
def peer(our_names: CppYarp) -> Iterator[CppProgram]:
    """A C++ program with the ports `/ball` and `/line`, which write when they are told."""
    with CppProgram(our_names) as program:
        program.do("""
ports = {}
for name in ("/ball", "/line"):
    ports[name] = yarp.Port()
    assert ports[name].open(name)
def write(*names):
    for name in names:
        bottle = yarp.Bottle()
        bottle.addString(name)
        ports[name].write(bottle)
def connect(name, carrier):
    return yarp.Network.connect(name, "/eye", carrier)
def admin(text):
    command, reply = yarp.Bottle(text), yarp.Bottle()
    contact = yarp.Network.queryName("/eye")
    style = yarp.ContactStyle()
    style.admin = True
    assert yarp.Network.write(contact, command, reply, style)
    return reply.toString()
""")
        yield program


@pytest.fixture
def heard() -> list[str]:
    return []


@pytest.fixture
def eye(heard: list[str]) -> Iterator[yarpy.Port]:
    with yarpy.Port("/eye", callback=lambda message: heard.append(message.value[0])) as port:
        yield port


def passes(peer: CppProgram, heard: list[str], *names: str) -> list[str]:
    """Which of the messages from these get through."""
    before = len(heard)
    peer.do(f"write(*{names!r})")  # each write waits until our port has taken or dropped it
    return heard[before:]


@pytest.mark.peer("nc")
def test_priority(our_names: CppYarp, peer: CppProgram, eye: yarpy.Port, heard: list[str]) -> None:
    assert peer.do("connect('/ball', 'tcp+recv.priority+tc.60+bs.5')")
    assert peer.do("connect('/line', 'tcp+recv.priority+tc.60+bs.10')")
    wait_until(lambda: len(eye.inputs) == 2)
    names = "/ball", "/line"
    assert passes(peer, heard, "/ball", "/line", *names, *names) == ["/ball", *["/line"] * 3]
    assert peer.do("admin('set in /ball (bs 2.0)')") == (
        '0 "Configured connection from /ball\\r\\n"'
    )
    assert passes(peer, heard, *names, *names) == ["/ball", "/ball"]
    expected = '((bs 2.0) (ex "") (st 1.0) (tc 60.0) (tr 0.0) (virtual 0))'
    assert peer.do("admin('get in /ball')") == expected
    typed = "CONNECT person\na\nset in /line (bs 3.5)\n"
    where = [eye.contact.host, str(eye.contact.port)]
    answer = subprocess.run(
        [program("nc"), "-w", "2", *where],
        input=typed,
        capture_output=True,
        text=True,
        timeout=HANG,
    )
    assert "Configured connection from /line" in answer.stdout
    assert passes(peer, heard, *names, *names) == ["/line", "/line"]
    found = our_names.run("connect", "/ball", "/eye", "tcp+recv.priority+ex.(/line,-100)")
    assert "Added connection" in found.stdout
    wait_until(lambda: any("ex." in link.carrier for link in eye.inputs))
    assert passes(peer, heard, *names, *names) == ["/ball", "/ball"]


@pytest.mark.parametrize("kind", ["python", "lua"])
def test_events(
    peer: CppProgram,
    eye: yarpy.Port,
    heard: list[str],
    kind: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The ball holds the line back for a while; scripts named by a C++ program run in ours."""
    if kind == "lua":
        pytest.importorskip("lupa.lua54", reason='Lua is missing: pip install "yarpy[lua]"')
    scripts = {
        "ball.py": "def accept(message):\n"
        "    portmonitor.set_event('e_ball', 60)\n    return True\n",
        "line.py": "def create(options): portmonitor.set_constraint('not e_ball')\n",
        "ball.lua": "PortMonitor.accept = function(thing)\n    PortMonitor.setEvent('e_ball', 60)\n"
        "    thing:asBottle():addString('seen')\n    return true\nend\n",
        "line.lua": "require('yarp')\nPortMonitor.create = function(options)\n"
        "    PortMonitor.setConstraint('not e_ball')\n    return true\nend\n",
    }
    for name, text in scripts.items():
        place = tmp_path / "contexts" / "demo" / name
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(text)
    monkeypatch.setenv("YARP_DATA_HOME", str(tmp_path))
    monkeypatch.setenv("YARPY_SCRIPTS", "network")
    for name in ("ball", "line"):
        assert peer.do(
            f"connect('/{name}', 'tcp+recv.portmonitor+type.{kind}+context.demo+file.{name}')"
        )
    wait_until(lambda: len(eye.inputs) == 2)
    names = "/line", "/ball", "/line", "/ball"
    assert passes(peer, heard, *names) == ["/line", "/ball", "/ball"]
    assert peer.do("yarp.Network.disconnect('/ball', '/eye')")
    wait_until(lambda: len(eye.inputs) == 1)
    assert passes(peer, heard, "/line") == ["/line"]  # its events went with the ball
    assert peer.do("yarp.Network.disconnect('/line', '/eye')")


@pytest.mark.parametrize("kind", ["python", "lua"])
def test_cpp_reads_what_our_script_made(
    peer: CppProgram, kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if kind == "lua":
        pytest.importorskip("lupa.lua54", reason='Lua is missing: pip install "yarpy[lua]"')
    (tmp_path / "tag.py").write_text("def update(message): return [*message.value, 'tag', [1]]")
    (tmp_path / "tag.lua").write_text(
        "PortMonitor.update = function(thing)\n    local b = thing:asBottle()\n"
        "    b:addString('tag') b:addList():addInt32(1)\n    return thing\nend\n"
    )
    monkeypatch.chdir(tmp_path)
    peer.do(f"reader = yarp.Port()\nassert reader.open('/reader/{kind}')")
    with yarpy.Port("/writer") as writer:
        writer.connect(f"/reader/{kind}", f"tcp+send.portmonitor+type.{kind}+file.tag")
        peer.begin("bottle = yarp.Bottle()\nassert reader.read(bottle)\nbottle.toString()")
        writer.write(["hi", 2.5])
        assert Bottle.from_text(peer.end()) == ["hi", 2.5, "tag", [1]]
    peer.do("reader.close()")
