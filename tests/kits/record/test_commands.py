"""What recorders and players are told over ports."""

from pathlib import Path

import pytest
from support.recordings import recorded
from support.wait import wait_until

import yarpy
from yarpy import record
from yarpy.kits.record.commands import Commands, player_commands, recorder_commands


@pytest.fixture
def names():
    with yarpy.NameServer() as server:
        yield server.client


def ask(names, words: Commands, *lines: list[object]) -> list[object]:
    with (
        yarpy.RpcServer("/rpc", words, names=names),
        yarpy.RpcClient("/rpc", names=names) as client,
    ):
        return [client.call(line) for line in lines]


def test_a_recorder(names, tmp_path: Path) -> None:
    stopped: list[bool] = []
    with record.Recorder("/x", path=tmp_path / "x", names=names, tell=str) as recorder:
        words = recorder_commands(recorder, lambda: stopped.append(True))
        pause, told, *rest = ask(
            names,
            words,
            ["pause"],
            ["status"],
            ["resume"],
            ["mark", "it fell"],
            ["mark"],
            ["mark", "at", 7, "o'clock"],
            ["split"],
        )
        assert pause == ["ok"] and all(answer == ["ok"] for answer in rest)
        assert (
            told[0] == "ok" and told[1] == ["state", "paused"] and told[-1] == ["waiting", ["/x"]]
        )
        wait_until(lambda: len(recorder.files) == 2)
        assert ask(names, words, ["stop"]) == [["ok"]] and stopped == [True]
    with record.open(*recorder.files) as found:
        assert [note.get("text") for note in found.notes()] == [
            *(None, None, "it fell", ""),
            "at 7 o'clock",
        ]


def test_a_player(names, tmp_path: Path) -> None:
    with (
        record.open(recorded(tmp_path / "x.mcap", 101)) as found,
        record.Player(found, names=names) as player,
    ):
        words = player_commands(player)
        found_ = ask(
            names, words, ["seek", 0.5], ["rate", 2], ["getSpeed"], ["getStatus"], ["getProgress"]
        )
        assert found_ == [["ok"], ["ok"], ["ok", 2.0], ["ok", "paused"], ["ok", 50.0]]
        assert player.position == pytest.approx(0.5)
        (told,) = ask(names, words, ["status"])
        assert ["length", 1.0] in told and ["loop", []] in told
        assert ask(names, words, ["loop", 0.25, 0.5], ["loop", 0.75]) == [["ok"], ["ok"]]
        assert player.range == (0.75, 1.0) and player.position == 0.75
        assert ask(names, words, ["loop"]) == [["ok"]] and player.range is None
        assert ask(names, words, ["play"]) == [["ok"]] and not player.paused
        assert ask(names, words, ["pause"]) == [["ok"]] and player.paused
        assert ask(names, words, ["quit"]) == [["ok"]] and not player.play()


def test_a_player_in_the_words_of_cpp(names, tmp_path: Path) -> None:
    with (
        record.open(recorded(tmp_path / "x.mcap", 101)) as found,
        record.Player(found, ["/a"], names=names) as player,
    ):
        words = player_commands(player)
        assert ask(names, words, ["getAllParts"], ["getPortName", "/a"]) == [
            ["ok", ["/a"]],
            ["ok", "/a"],
        ]
        assert ask(names, words, ["setPortName", "/a", "/b"], ["getPortName", "/a"]) == [
            ["ok"],
            ["ok", "/b"],
        ]
        assert ask(names, words, ["forward", 50], ["backward"], ["getSliderPercentage"]) == [
            ["ok"],
            ["ok"],
            ["ok", 45],
        ]
        assert player.position == pytest.approx(0.45)
        for line, why in (
            (["forward", 60], "1.1 s is not within 1.0 s"),
            (["disable", "/c"], '"/c" is not played: there are /a'),
            (["repeat", "maybe"], "'maybe' is neither 0 nor 1"),
        ):
            assert ask(names, words, line) == [["fail", why]]
        ask(names, words, ["disable", "/a"], ["repeat"], ["setStrict"])
        assert (player.muted, player.loop, player.reader_timeout) == ({"/a"}, True, 10.0)
        ask(names, words, ["enable", "/a"], ["repeat", 0], ["setStrict", 0])
        assert (player.muted, player.loop, player.reader_timeout) == (set(), False, 0.5)


def test_what_is_no_word(names, tmp_path: Path) -> None:
    with (
        record.open(recorded(tmp_path / "x.mcap")) as found,
        record.Player(found, names=names) as player,
    ):
        answers = ask(
            names, player_commands(player), ["fly"], ["seek"], ["seek", 1, 2], ["rate", 0], [],
            ["seek", "far"], ["seek", [1]], ["seek", float("nan")], ["loop", 1, 1], ["loop", "x"],
        )  # fmt: skip
        assert [answer[0] for answer in answers] == ["fail"] * 10
        assert answers[0][1].startswith("no word 'fly': there are backward")
        assert answers[1][1] == "seek SECONDS"
        (told,) = ask(names, player_commands(player), ["help"])
        assert "seek" in told and told[0] == "ok"
