"""yarpdataplayer: its words, and a C++ program that reads what it plays."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest
from support.cpp import CppYarp
from support.cpp_program import CppProgram
from support.peer import brings
from support.port import free_block
from support.process import Process
from support.recordings import START, STEP, payload_of
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits import record


@pytest.fixture
def server() -> Iterator[yarpy.NameServer]:
    with yarpy.NameServer(free_block(200)) as found:
        yield found


@pytest.fixture
def dataset(tmp_path: Path) -> Path:
    """/a has 20 messages, 10 ms apart; /b every second of these moments."""
    for port, step in (("/a", 1), ("/b", 2)):
        folder = record.SingleFolder(tmp_path / "set" / f"part{port[1:]}")
        folder.note({"what": "connected", "port": port}, START)
        for n in range(0, 20, step):
            moment = START + n * STEP
            seconds = f"{moment // 10**9}.{moment % 10**9:09}"
            folder.add(port, f"{n + 100} {seconds}", START, payload_of([n]))
        folder.close()
    return tmp_path / "set"


def ask(player: object, *words: object) -> list[object]:
    from yarp._dataplayer import answer

    assert player is not None
    return [*answer(player, yarpy.Bottle(list(words)), lambda: None)]  # type: ignore[arg-type]


def test_words(server: yarpy.NameServer, dataset: Path) -> None:
    from yarp._dataplayer import DataPlayer

    player = DataPlayer("/again")
    ok, fail = [yarpy.Vocab("ok")], [yarpy.Vocab("fail")]
    got: list[tuple[str, int, str]] = []

    def take(message: yarpy.Message) -> None:
        got.append((message.source, message.value[0], message.envelope))

    try:
        assert ask(player, "getStatus") == [""] and ask(player, "play") == fail
        assert ask(player, "load", str(dataset / "nowhere")) == fail
        assert ask(player, "load", str(dataset)) == ok
        assert ask(player, "getAllParts") == [["parta", "partb"]]
        assert ask(player, "getPortName", "partb") == ["/again/b"]
        assert ask(player, "setPortName", "partb", "/elsewhere") == ok
        assert ask(player, "getPortName", "partb") == ["/elsewhere"]
        with yarpy.BufferedPort("/reader", callback=take) as port:
            for name in ("/again/a", "/elsewhere"):
                yarpy.connect(name, port.name)
            assert ask(player, "getFrame", "parta") == [0] and ask(player, "getFrame", "no") == [-1]
            # One message of each part, and those between: 0 of both at one time.
            assert ask(player, "step") == ok
            wait_until(lambda: len(got) == 2)
            assert ask(player, "step") == ok  # the next of /b is at the third moment of /a
            assert [ask(player, "getFrame", part) for part in ("parta", "partb")] == [[3], [2]]
            wait_until(lambda: len(got) == 5)
            assert {name for name, *_ in got} == {"/again/a", "/elsewhere"}
            # The envelope is the number in its part, and the time that was recorded.
            assert ("/elsewhere", 2, f"1 {(START + 2 * STEP) / 1e9:.2f}") in got
            assert ask(player, "setFrame", 10) == ok and ask(player, "getFrame", "partb") == [5]
            assert ask(player, "setFrame", 99) == fail and ask(player, "setFrame", -1) == fail
            assert ask(player, "forward", 20) == ok and ask(player, "forward", 90) == fail
            assert ask(player, "backward", 20) == ok and ask(player, "getStatus") == ["paused"]
            assert 50 < ask(player, "getProgress")[0] < 55  # type: ignore[operator]
            assert ask(player, "disable", "partb") == ok and ask(player, "disable", "no") == fail
            assert ask(player, "setSpeed", 2) == ok and ask(player, "getSpeed") == [2.0]
            assert ask(player, "setSpeed", 0) == fail and ask(player, "setStrict") == ok
            del got[:]
            assert ask(player, "play") == ok
            wait_until(lambda: ask(player, "getStatus") == ["stopped"], what="the end is told")
            wait_until(lambda: [n for _, n, _ in got] == [*range(10, 20)])
            assert ask(player, "getFrame", "parta") == [0] and ask(player, "step") == ok
            assert ask(player, "enable", "partb") == ok and ask(player, "stop") == ok
            assert ask(player, "repeat", "maybe") == fail and ask(player, "repeat", 1) == ok
            del got[:]
            assert ask(player, "play") == ok
            wait_until(lambda: [n for _, n, _ in got].count(19) >= 2, what="it was played twice")
        assert ask(player, "sing") == fail and ask(player, "getFrame") == fail
        assert "getAllParts" in ask(player, "help")
        # Another data set takes the place of this one.
        assert ask(player, "load", str(dataset / "parta")) == ok
        assert ask(player, "getAllParts") == [["parta"]]
    finally:
        player.close()


def test_a_name_that_lives_is_left_alone(
    server: yarpy.NameServer, dataset: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from yarp._dataplayer import DataPlayer

    player = DataPlayer()
    with yarpy.Port("/a") as port:
        assert ask(player, "load", str(dataset)) == [yarpy.Vocab("ok")]
        assert ask(player, "play") == [yarpy.Vocab("ok")]
        wait_until(lambda: ask(player, "getStatus") == ["stopped"])
        assert not port.closed
    player.close()
    assert "parta is played to nobody" in capsys.readouterr().err


@pytest.fixture
@brings("cpp")
def peer(server: yarpy.NameServer, tmp_path: Path) -> Iterator[CppProgram]:
    with (
        CppYarp.prepare(tmp_path / "cpp").at("127.0.0.1", server.port) as cpp,
        CppProgram(cpp) as program,
    ):
        yield program


def test_a_cpp_program_steers_it_and_reads(
    peer: CppProgram, server: yarpy.NameServer, dataset: Path, environment: Mapping[str, str]
) -> None:
    code = "from yarp._dataplayer import console; console()"
    command = [sys.executable, "-c", code, "--dataset", str(dataset), "--add_prefix", "1"]
    with Process(command, env={**environment, **server.environment}) as process:
        process.wait_line("/yarpdataplayer/rpc:i is told", timeout=HANG)
        peer.do(
            "yarp.Network.setVerbosity(-1)\n"
            "inp = yarp.BufferedPortBottle(); inp.setStrict(); inp.open('/theirs/in')\n"
            "rpc = yarp.RpcClient(); rpc.open('/theirs/rpc')\n"
            "rpc.addOutput('/yarpdataplayer/rpc:i')\n"
            "assert yarp.Network.connect('/yarpdataplayer/b', '/theirs/in')\n"
            "def ask(words):\n"
            "    said = yarp.Bottle(); rpc.write(yarp.Bottle(words), said)\n"
            "    return said.toString()\n"
            "def take():\n"
            "    stamp, found = yarp.Stamp(), inp.read().toString()\n"
            "    inp.getEnvelope(stamp)\n"
            "    return [found, stamp.getCount(), round(stamp.getTime() % 1, 6)]"
        )
        assert peer.do("ask('getAllParts')") == "(parta partb)"
        assert peer.do("ask('setStrict 1')") == "[ok]" == peer.do("ask('play')")
        assert peer.do("[take() for _ in range(3)]") == [
            ["0", 0, 0.0],
            ["2", 1, 0.02],
            ["4", 2, 0.04],
        ]
        wait_until(lambda: peer.do("ask('getStatus')") == "stopped")
        assert peer.do("ask('quit')") == "[ok]"
        assert process.wait(HANG) == 0, process.stderr
