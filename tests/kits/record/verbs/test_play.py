"""`yarpy play`; tests/kits/record/test_player.py has how."""

import signal

import pytest
from support.recordings import recorded
from support.wait import HANG, wait_until

import yarpy
from yarpy import record
from yarpy.errors import LocalProtocolError
from yarpy.kits.record.playback.player import Player
from yarpy.kits.record.verbs.play import Keys, parse_rename, progress, summary


def test_from_the_command_line(cli, names, tmp_path) -> None:
    path = recorded(tmp_path / "x.mcap", 50)
    got: list[str] = []
    take = lambda message: got.append(message.envelope)  # noqa: E731
    with (
        yarpy.BufferedPort("/in", callback=take, names=names),
        cli.start("play", str(path), "--prefix", "/replay", "--ports", "/a", "--wait") as process,
    ):
        wait_until(lambda: yarpy.exists("/replay/a", names=names))
        yarpy.connect("/replay/a", "/in", names=names)
        assert process.wait(HANG) == 0
        assert process.stdout.startswith("the end: 25 messages, late by")
        wait_until(lambda: len(got) == 25)
    assert got == [f"{n} {n}.5" for n in range(0, 50, 2)]


def test_an_interrupt_ends_it(cli, names, tmp_path) -> None:
    path = recorded(tmp_path / "x.mcap")
    with cli.start("play", str(path), "-l") as process:
        wait_until(lambda: yarpy.exists("/play/rpc:i", names=names))
        process.signal(signal.SIGINT)
        assert process.wait(HANG) == 0
        assert "stopped at 0." in process.stdout


def test_what_is_used_wrongly(here, names, tmp_path) -> None:
    path = str(recorded(tmp_path / "x.mcap"))
    with yarpy.Port("/b", names=names):
        said = here("play", path)
        assert said.code == 1 and "--prefix /replay" in said.err
    assert "does not rename a port" in here("play", path, "--rename", "x").err
    assert '"/x" was not recorded' in here("play", path, "--ports", "/x").err
    assert '"/x" was not recorded' in here("play", path, "--rename", "/x=/y").err
    assert "a rate of 0" in here("play", path, "-r", "0").err
    assert "cannot be read" in here("play", str(tmp_path / "gone")).err


def test_what_is_damaged_is_told_and_the_rest_played(here, tmp_path) -> None:
    path = recorded(tmp_path / "x.mcap")
    data = path.read_bytes()
    path.write_bytes(data[: len(data) // 2])
    said = here("play", str(path), "--prefix", "/damaged")
    assert said.code == 0 and said.out.startswith("the end: 5 messages")
    assert "x.mcap: byte " in said.err


def test_what_has_no_message_left_is_an_error(here, tmp_path) -> None:
    path = recorded(tmp_path / "x.mcap")
    with record.open(path) as found:
        payload = bytes(next(iter(found)).payload)
    data = path.read_bytes()
    path.write_bytes(data.replace(payload[:4], bytes(4)))
    said = here("play", str(path), "--prefix", "/damaged")
    assert said.code == 1 and said.out.startswith("the end: 0 messages"), said
    assert "x.mcap: byte " in said.err


def test_names_of_ports() -> None:
    assert parse_rename("/a=/b") == ("/a", "/b")
    for text in ("/a", "a=/b", "/a=b", "="):
        with pytest.raises(LocalProtocolError):
            parse_rename(text)


def test_keys(names, tmp_path) -> None:
    with (
        record.open(recorded(tmp_path / "x.mcap", 1001)) as found,
        Player(found, names=names) as player,
    ):
        press = Keys(player).press
        assert player.paused
        press("\x1b[C")
        assert player.position == pytest.approx(5.0)
        press("\x1b[D")
        assert player.position == 0.0
        press("+")
        press("+")
        press("-")
        assert progress(player).startswith("paused 0.0 of 10.0 s  x2  0 messages")
        press("l")
        press("l")  # nothing lies between
        assert player.range is None
        press("\x1b[C")
        press("l")
        press("\x1b[D")
        press("l")
        assert player.range == (0.0, pytest.approx(5.0)) and player.position == 0.0
        assert "0.0 to 5.0 s again and again" in progress(player)
        press("l")
        assert player.range is None
        press(" ")
        assert not player.paused
        press(" ")
        press("?")
        press("q")
        assert not player.play()
        assert summary(player, False).startswith("stopped at ")


def test_a_key_sends_the_next_message(names, tmp_path) -> None:
    with (
        record.open(recorded(tmp_path / "x.mcap", 3)) as found,
        Player(found, names=names) as player,
    ):
        for _ in range(3):
            Keys(player).press("s")
        Keys(player).press("s")  # to the end
        assert player.play(paused=True) and player.played == 3


def test_it_is_told_what_to_do(cli, names, tmp_path) -> None:
    path = recorded(tmp_path / "x.mcap", 50)
    with (
        cli.start("play", str(path), "-p", "--prefix", "/one") as one,
        cli.start("play", str(path), "-p", "--prefix", "/two", "--name", "/two/rpc") as two,
    ):
        for process, port in ((one, "/play/rpc:i"), (two, "/two/rpc")):
            with yarpy.RpcClient(names=names) as client:
                client.connect(port, timeout=HANG)
                assert client.call(["getStatus"]) == ["ok", "paused"]
                client.call(["seek", 0.4])
                assert client.call(["play"]) == ["ok"]
            assert process.wait(HANG) == 0
            assert process.stdout.startswith("the end: 10 messages")


def test_several_players(here, names, tmp_path) -> None:
    path = recorded(tmp_path / "x.mcap")
    with yarpy.Port("/play/rpc:i", names=names):
        assert here("play", str(path), "--prefix", "/three").code == 0
        assert here("play", str(path), "--prefix", "/four", "--name", "/play/rpc:i").code == 1
