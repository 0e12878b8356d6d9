"""Playing: the same bytes in the same time, from the same names."""

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from support.recordings import START, STEP, payload_of, recorded
from support.wait import HANG, wait_until

import yarpy
from yarpy import record
from yarpy.clock import NetworkClock
from yarpy.errors import AddressError, LocalProtocolError, UnknownName
from yarpy.kits.record.mcap.writer import McapWriter
from yarpy.kits.record.playback import player as player_module
from yarpy.kits.record.playback.player import Player

Got = list[tuple[str, str, bytes, float]]
ROUNDED = 0.001  # seconds


@pytest.fixture
def names():
    with yarpy.NameServer() as server:
        yield server.client


@pytest.fixture
def patience(monkeypatch: pytest.MonkeyPatch) -> None:
    """No reader is given up, however slow the machine is."""
    monkeypatch.setattr(player_module, "READER_TIMEOUT", HANG)


@pytest.fixture
def recording(tmp_path: Path, patience):
    """100 messages, 10 ms apart, of /a and /b in turn."""
    with record.open(recorded(tmp_path / "x.mcap", 100)) as found:
        yield found


@contextmanager
def reader(names, *sources: str) -> Iterator[Got]:
    """What comes from these ports: name, envelope, payload, time."""
    got: Got = []

    def take(message: yarpy.Message) -> None:
        payload = bytes(message.payload)
        got.append((message.source, message.envelope, payload, time.monotonic()))

    with yarpy.BufferedPort("/reader", callback=take, names=names) as port:
        for source in sources:
            yarpy.connect(source, port.name, names=names)
        yield got


def numbers(got: Got) -> list[int]:
    return [int(one[1].split()[0]) for one in got]


def test_the_same_bytes_in_the_same_time(names, recording) -> None:
    with Player(recording, names=names) as player, reader(names, "/a", "/b") as got:
        assert player.wait_for_readers() and player.ports == {"/a": "/a", "/b": "/b"}
        began = time.monotonic()
        assert player.play()
        took = time.monotonic() - began
        wait_until(lambda: len(got) == 100)
    assert sorted((source, text, data) for source, text, data, _ in got) == sorted(
        (one.port, one.envelope, bytes(one.payload)) for one in recording
    )
    # Each is sent when it is due or later, never before, but for what clocks round; there is one
    # clock for both.
    assert took >= 0.99 - ROUNDED
    due = {text: one.received - recording.begin for one in recording for text in [one.envelope]}
    assert all(at - began >= due[text] - ROUNDED for _, text, _, at in got)
    assert (player.played, player.dropped) == (100, 0)


def test_messages_of_every_kind_come_back(names, tmp_path, patience) -> None:
    payloads = [payload_of(value) for value in ([1, "x"], "word", [], yarpy.Vector([1.5]))]
    with McapWriter(tmp_path / "y.mcap") as writer:
        for n, payload in enumerate(payloads):
            writer.add("/a", ("", "free text", "3 1.50", f"{n} 1")[n], START + n, payload)
    with (
        record.open(tmp_path / "y.mcap") as found,
        Player(found, names=names) as player,
        reader(names, "/a") as got,
    ):
        assert player.play()
        wait_until(lambda: len(got) == 4)
    assert [(text, data) for _, text, data, _ in got] == [
        (text, data)
        for text, data in zip(("", "free text", "3 1.50", "3 1"), payloads, strict=True)
    ]


def test_a_start_behind_the_end(names, recording) -> None:
    with pytest.raises(LocalProtocolError, match=r"after 99 s: the recording lasts 1\.\d s"):
        Player(recording, start=99.0, names=names)


def test_a_part_of_it_at_another_rate(names, recording) -> None:
    with (
        Player(recording, ["/b"], rate=10.0, start=0.2, duration=0.2, names=names) as player,
        reader(names, "/b") as got,
    ):
        assert player.play() and abs(player.length - 0.2) < 1e-6
        wait_until(lambda: len(got) == 10)
        assert numbers(got) == [*range(21, 41, 2)]
        assert player.position == player.length


def test_names(names, recording) -> None:
    with Player(recording, rename={"/a": "/other"}, prefix="/replay", names=names) as player:
        assert player.ports == {"/a": "/other", "/b": "/replay/b"}
    with yarpy.Port("/b", names=names) as mine:
        with pytest.raises(AddressError, match="beside what lives with --prefix /replay"):
            Player(recording, names=names)
        assert yarpy.query("/b", names=names).port == mine.contact.port
        assert not yarpy.exists("/a", names=names)  # which was open already


def test_what_cannot_be_played(names, recording) -> None:
    with pytest.raises(UnknownName, match='"/x" was not recorded: there are /a /b'):
        Player(recording, ["/x"], names=names)
    for rate in (0.0, -1.0, float("nan"), 1e9):
        with pytest.raises(LocalProtocolError, match="a rate of"):
            Player(recording, rate=rate, names=names)


def test_an_empty_recording(names, tmp_path) -> None:
    with McapWriter(tmp_path / "y.mcap"):
        pass
    with (
        record.open(tmp_path / "y.mcap") as found,
        pytest.raises(LocalProtocolError, match="nothing was recorded"),
    ):
        Player(found, names=names)


def test_loops_until_it_is_stopped(names, recording) -> None:
    with Player(recording, rate=20.0, loop=True, names=names) as player, reader(names, "/a") as got:
        thread = threading.Thread(target=player.play)
        thread.start()
        wait_until(lambda: numbers(got).count(98) >= 3)
        player.stop()
        thread.join(HANG)
        assert not thread.is_alive()
    found = numbers(got)
    assert found[:100] == [*range(0, 100, 2)] * 2


def test_pause_and_seek(names, recording) -> None:
    with Player(recording, rate=0.02, names=names) as player, reader(names, "/a") as got:
        done: list[bool] = []
        thread = threading.Thread(target=lambda: done.append(player.play(paused=True)))
        thread.start()
        assert player.paused and player.position == 0.0
        player.seek(0.5)
        assert player.position == pytest.approx(0.5)
        player.resume()
        wait_until(lambda: len(got) >= 2)  # a second; the end is half a minute away
        player.pause()
        assert player.paused and player.position >= 0.52
        player.seek(0.2)
        player.rate = 100.0
        player.resume()
        thread.join(HANG)
        wait_until(lambda: numbers(got)[-1] == 98)
    found = numbers(got)
    again = found.index(20)
    assert found[:again] == [*range(50, 50 + 2 * again, 2)]
    assert found[again:] == [*range(20, 100, 2)] and done == [True]


def test_a_reader_that_sticks_holds_nobody_up_for_long(names, tmp_path) -> None:
    """It is waited for once; the others get everything."""
    with McapWriter(tmp_path / "y.mcap") as writer:
        for n in range(300):
            for port in ("/a", "/b"):
                writer.add(port, f"{n} 1", START + n * STEP // 100, payload_of([n, bytes(200_000)]))
    free = threading.Event()
    with (
        record.open(tmp_path / "y.mcap") as found,
        Player(found, names=names) as player,
        yarpy.BufferedPort("/stuck", callback=lambda m: free.wait(HANG), names=names),
        reader(names, "/b") as got,
    ):
        yarpy.connect("/a", "/stuck", "tcp", names=names)
        try:
            assert player.play()
            wait_until(lambda: len(got) == 300)
        finally:
            free.set()
    assert numbers(got) == [*range(300)]
    assert 0 < player.dropped < 300 and player.played == 600


def test_programs_live_by_the_time_of_the_recording(names, recording) -> None:
    with (
        Player(recording, clock="/clock", rate=0.5, names=names) as player,
        NetworkClock(names=names) as clock,
    ):
        assert clock.now() == pytest.approx(recording.begin)
        assert player.play()
        wait_until(lambda: clock.now() == pytest.approx(recording.end))
        player.seek(0.5)
        wait_until(lambda: clock.now() == pytest.approx(recording.begin + 0.5, abs=0.4))


def test_message_by_message(names, recording) -> None:
    with Player(recording, names=names) as player, reader(names, "/a", "/b") as got:
        assert player.wait_for_readers()
        playing = threading.Thread(target=player.play, args=(True,))
        playing.start()
        for _ in range(3):
            before = len(got)
            player.step()
            wait_until(lambda before=before: len(got) == before + 1)
            assert player.paused
        assert player.position == pytest.approx(0.02)
        player.resume()
        playing.join(HANG)
        wait_until(lambda: len(got) == 100)
    assert sorted(numbers(got)) == sorted(int(one.envelope.split()[0]) for one in recording)


def test_a_range_again_and_again(names, recording) -> None:
    with Player(recording, rate=20.0, names=names) as player, reader(names, "/a") as got:
        assert player.range is None
        with pytest.raises(LocalProtocolError, match=r"nothing lies between 0\.5 and 0\.5 s"):
            player.loop_range(0.5, 0.5)
        player.loop_range(0.2, 0.29)
        assert player.range == (pytest.approx(0.2), pytest.approx(0.29))
        thread = threading.Thread(target=player.play)
        thread.start()
        wait_until(lambda: numbers(got).count(28) >= 3)
        player.end_range()
        assert player.range is None
        thread.join(HANG)
        assert not thread.is_alive()
        wait_until(lambda: numbers(got)[-1] == 98)
    found = numbers(got)
    assert found[:15] == [20, 22, 24, 26, 28] * 3
    assert found[-34:] == [*range(32, 100, 2)]


def test_from_a_mark_on(names, tmp_path) -> None:
    with McapWriter(tmp_path / "y.mcap") as writer:
        for n in range(3):
            writer.add("/a", f"{n} 1", START + n * 1_000_000_000, payload_of([n]))
        writer.note({"what": "mark", "text": "it fell"}, START + 1_500_000_000)
    with record.open(tmp_path / "y.mcap") as found:
        assert found.mark("it fell") == pytest.approx(1.5)
        with pytest.raises(UnknownName, match='nothing is marked "nothing": "it fell"'):
            found.mark("nothing")
        with Player(found, start=1.0, names=names) as player:
            player.seek_mark("it fell")
            assert player.position == pytest.approx(0.5)
