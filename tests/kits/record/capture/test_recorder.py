"""Recorders: what comes is in the file, and nobody who sends waits for a disk."""

import errno
import io
import itertools
import json
import os
import shutil
import threading
import time
from contextlib import ExitStack
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from chaos.network import Missing, small_disk
from support.recordings import START
from support.system import NO_UNLINK
from support.wait import HANG, wait_until

import yarpy
from yarpy import record
from yarpy.errors import LocalProtocolError, UnknownPlugin
from yarpy.kits.record.capture import recorder as module
from yarpy.kits.record.capture.disk_space import DiskSpace
from yarpy.kits.record.capture.recorder import Recorder
from yarpy.kits.record.dumper.part import Part
from yarpy.platform import file_bytes


class Disk(NamedTuple):
    total: int
    free: int


@pytest.fixture
def names():
    with yarpy.NameServer() as server:
        yield server.client


@pytest.fixture
def out(names):
    with yarpy.Port("/out", names=names) as port:
        yield port


def recorded(*files: Path) -> list[record.Recorded]:
    with record.open(*files) as found:
        assert found.complete and not found.damages
        return [*found]


def kinds(*files: Path) -> list[str]:
    with record.open(*files) as found:
        return [note["what"] for note in found.notes()]


def test_every_message_to_the_byte(tmp_path: Path, names, out) -> None:
    picture = yarpy.Image(np.arange(60 * 80 * 3, dtype="u1").reshape(60, 80, 3))
    values = [[1, "two"], picture, yarpy.Vector([1.5, 2.5]), "word", [], {"a": 1}]
    with Recorder("/out", path=tmp_path / "x", names=names) as recorder:
        assert out.wait_for_outputs(timeout=HANG)
        for n in range(300):
            out.write(values[n % 6], yarpy.Stamp(n // 2, 100 + n / 8) if n % 2 else None)
        wait_until(lambda: recorder.messages == 300)
        assert recorder.name == "/record" and recorder.connected == {"/out"}
    assert recorder.files == [tmp_path / "x.mcap"] and (recorder.lost, recorder.failure) == (0, "")
    found = recorded(*recorder.files)
    assert len(found) == 300
    for n, one in enumerate(found):
        assert bytes(one.payload) == b"".join(map(bytes, yarpy.data.codec.encode(values[n % 6])))
        assert one.envelope == (f"{n // 2} {100 + n / 8:.15g}" if n % 2 else "")
    assert found[1].value == picture
    assert kinds(*recorder.files) == ["connected", "disconnected"]


@pytest.mark.parametrize("carrier", ["", "tcp", "fast_tcp"])
def test_what_was_just_written_is_in_it(tmp_path: Path, names, out, carrier: str) -> None:
    for run in range(10):
        with Recorder("/out", path=tmp_path / f"{run}", names=names, carrier=carrier) as recorder:
            assert out.wait_for_outputs(timeout=HANG)
            for n in range(50):
                out.write([n])
        assert [one.value[0] for one in recorded(*recorder.files)] == [*range(50)]


@pytest.mark.parametrize("compression", ["lz4", "zstd"])
def test_what_was_flushed_can_be_read_meanwhile(tmp_path, names, out, compression) -> None:
    path = tmp_path / "x.mcap"
    with Recorder("/out", path=path, compression=compression, names=names):
        assert out.wait_for_outputs(timeout=HANG)
        out.write([1, 2, 3])

        def there() -> bool:
            with record.open(path) as found:
                return [one.value for one in found] == [[1, 2, 3]]

        wait_until(there)


def test_a_slow_disk_costs_messages_and_holds_nobody_up(tmp_path, names, out, monkeypatch) -> None:
    """The disk does not take anything until it is let; writers go on."""
    free = threading.Event()
    real = file_bytes.write

    def slow(file: io.FileIO, views: list[memoryview]) -> int:
        if not free.wait(HANG):
            raise OSError(errno.EIO, "the test hangs")
        return real(file, views)

    told: list[str] = []
    with Recorder("/out", path=tmp_path / "x", memory=100_000, names=names, tell=told.append) as r:
        assert out.wait_for_outputs(timeout=HANG)
        monkeypatch.setattr(file_bytes, "write", slow)
        for n in range(100):
            assert out.write([n, bytes(5000)], yarpy.Stamp(n, 1.0), timeout=HANG) == 1
        wait_until(lambda: r.messages + r.lost == 100)
        assert r.lost > 50 and r.held <= 100_000
        free.set()
        wait_until(lambda: r.held < 10_000)
        out.write([100, bytes(5000)], yarpy.Stamp(100, 1.0))
        wait_until(lambda: r.messages + r.lost == 101)
    found = [one.value[0] for one in recorded(*r.files)]
    assert found[-1] == 100 and len(found) == 101 - r.lost
    assert sum("were lost: the disk is too slow" in line for line in told) >= 1
    with record.open(*r.files) as file:
        assert json.loads(file.storages[0].facts["lost"]) == {"/out": r.lost}
        notes = [note for note in file.notes() if note["what"] == "lost"]
        assert sum(note["count"] for note in notes) == r.lost


def test_a_disk_that_fails(tmp_path, names, out, monkeypatch) -> None:
    """It stops, says so, and leaves a file that can be read."""
    told: list[str] = []
    with Recorder("/out", path=tmp_path / "x", names=names, tell=told.append) as recorder:
        assert out.wait_for_outputs(timeout=HANG)
        out.write([1])
        wait_until(lambda: recorder.messages == 1 and recorder.held == 0)

        def full(file: io.FileIO, views: list[memoryview]) -> int:
            raise OSError(errno.ENOSPC, "No space left on device")

        monkeypatch.setattr(file_bytes, "write", full)
        out.write([2])
        assert recorder.ended.wait(HANG)
        monkeypatch.undo()
        assert "x.mcap cannot be written: No space left on device" in recorder.failure
        assert told[0] == recorder.failure
        assert recorder.lost == 1
        assert out.write([3], timeout=HANG) == 1
    with record.open(*recorder.files) as found:
        assert [one.value for one in found] == [[1]]


@pytest.mark.parametrize("failing", ["file", "folder"])
def test_what_one_of_both_has_is_not_lost(tmp_path, names, out, monkeypatch, failing) -> None:
    with Recorder("/out", path=tmp_path / "x", format="both", names=names) as recorder:
        assert out.wait_for_outputs(timeout=HANG)
        out.write([1])
        wait_until(lambda: recorder.messages == 1 and recorder.held == 0)

        def full(*words: object) -> int:
            raise OSError(errno.ENOSPC, "No space left on device")

        with monkeypatch.context() as patch:
            if failing == "file":
                patch.setattr(file_bytes, "write", full)
            else:
                patch.setattr(Part, "add", full)
            out.write([2])
            wait_until(lambda: recorder.messages == 2 and recorder.held == 0)
            assert recorder.lost == 0
            out.write([3])
            assert recorder.ended.wait(HANG)
        assert "No space left on device" in recorder.failure
        assert recorder.lost == 1
    with record.open(recorder.files[0]) as file, record.open(tmp_path / "x") as folder:
        found = [len([*one]) for one in (file, folder)]
    assert found == ([1, 2] if failing == "file" else [2, 1])


def test_a_full_disk_ends_it_cleanly(tmp_path, names, out) -> None:
    left, told = [50], []
    room = DiskSpace(tmp_path, lambda where: Disk(100, left[0]))
    with Recorder(
        "/out", path=tmp_path / "x", room=room, names=names, tell=told.append
    ) as recorder:
        assert out.wait_for_outputs(timeout=HANG)
        out.write([1])
        wait_until(lambda: recorder.messages == 1)
        left[0] = 9
        wait_until(lambda: told == ["9 B are left on the disk"])
        left[0] = 1
        for number in itertools.count(2):  # what was on its way to the disk is there, or lost
            if recorder.ended.is_set:
                break
            out.write([number], wait=True)
        assert recorder.failure == "the disk is full but for 1 B: recording stops"
    found = [one.value[0] for one in recorded(*recorder.files)]
    assert found == [*range(1, 1 + recorder.messages)]
    assert "disk low" in kinds(*recorder.files)


@pytest.fixture
def small():
    """A folder on a disk of 512 kB."""
    with ExitStack() as stack:
        try:
            where = stack.enter_context(small_disk())
        except Missing as error:
            pytest.skip(f"no small disk can be mounted: {error}")
        yield where


def test_a_disk_of_half_a_megabyte(small, names, out) -> None:
    """What was written of a flood can be read; the rest is counted, and the writer never waited."""
    told: list[str] = []
    with Recorder("/out", path=small / "x", names=names, tell=told.append) as recorder:
        assert out.wait_for_outputs(timeout=HANG)
        out.write([0, bytes(20_000)])
        wait_until(lambda: recorder.size > 20_000)
        sent = 1
        while not recorder.ended.is_set and sent < 1000:
            assert out.write([sent, bytes(20_000)], timeout=HANG) == 1
            sent += 1
        assert recorder.ended.wait(HANG)
        assert told and recorder.failure in told
    with record.open(*recorder.files) as found:
        assert [one.value[0] for one in found] == [*range(recorder.messages)]
    assert 0 < recorder.messages < sent


def test_pause_mark_split(tmp_path, names, out) -> None:
    with Recorder("/out", path=tmp_path / "x", paused=True, names=names) as recorder:
        assert out.wait_for_outputs(timeout=HANG)
        assert recorder.paused
        out.write([0], wait=True)
        recorder.resume()
        out.write([1], wait=True)
        recorder.mark("it fell over")
        recorder.split()
        wait_until(lambda: len(recorder.files) == 2)
        out.write([2], wait=True)
        recorder.pause()
        out.write([3], wait=True)
    assert [[one.value for one in recorded(file)] for file in recorder.files] == [[[1]], [[2]]]
    assert kinds(*recorder.files) == ["connected", "resume", "mark", "pause", "disconnected"]


def test_a_recording_that_starts_paused_begins_when_it_goes_on(tmp_path, names, out) -> None:
    """An hour between the connection and `resume` is no part of it."""
    clock = [START]
    with Recorder("/out", path=tmp_path / "x", paused=True, names=names, now=lambda: clock[0]) as r:
        assert out.wait_for_outputs(timeout=HANG)
        out.write([0], wait=True)  # what is read has been told of before
        clock[0] += 3600 * 10**9
        r.resume()
        clock[0] += 10**9
        out.write([1], wait=True)
    with record.open(*r.files) as found:
        assert (found.begin, found.end) == (START / 10**9 + 3600, START / 10**9 + 3601)
        assert [note["what"] for note in found.notes()] == ["connected", "resume", "disconnected"]


def test_a_port_that_comes_back(tmp_path, names) -> None:
    with Recorder("/out", path=tmp_path / "x", names=names, tell=lambda line: None) as recorder:
        for n in range(3):
            with yarpy.Port("/out", names=names) as port:
                assert port.wait_for_outputs(timeout=HANG)
                port.write([n], wait=True)
            wait_until(lambda: not recorder.connected)
    assert [one.value for one in recorded(*recorder.files)] == [[0], [1], [2]]


@pytest.mark.skipif(bool(NO_UNLINK), reason=NO_UNLINK)
def test_a_folder_that_goes(tmp_path, names, out) -> None:
    told: list[str] = []
    where = tmp_path / "deep" / "x"
    with Recorder("/out", path=where, names=names, tell=told.append) as recorder:
        assert out.wait_for_outputs(timeout=HANG)
        shutil.rmtree(where.parent)
        wait_until(lambda: told)
        assert told[0].endswith("x-0002.mcap")
        out.write([1], wait=True)
    assert [one.value for one in recorded(*recorder.files)] == [[1]]
    assert "file gone" in kinds(*recorder.files)


def test_a_clock_that_is_set(tmp_path, names, out, monkeypatch) -> None:
    told: list[str] = []
    with Recorder("/out", path=tmp_path / "x", names=names, tell=told.append) as recorder:
        assert out.wait_for_outputs(timeout=HANG)
        out.write([1], wait=True)
        wait_until(lambda: recorder.free > 0)  # it has looked around
        real = time.time_ns
        monkeypatch.setattr(time, "time_ns", lambda: real() - 3600 * 10**9)
        wait_until(lambda: told)
        out.write([2], wait=True)
        monkeypatch.undo()
    assert told[0] == "the clock was set by -3600.0 s"
    assert sorted(one.value[0] for one in recorded(*recorder.files)) == [1, 2]


def test_two_recorders_and_a_name(tmp_path, names, out) -> None:
    with (
        Recorder("/out", path=tmp_path / "a", names=names) as one,
        Recorder("/out", path=tmp_path / "b", names=names) as two,
        Recorder("/out", path=tmp_path / "c", name="/mine", names=names) as three,
    ):
        assert one.name == "/record" and two.name == f"/record/{os.getpid()}"
        assert three.name == "/mine"
        assert out.wait_for_outputs(3, timeout=HANG)
        out.write([1], wait=True)
    for recorder in (one, two, three):
        assert [found.value for found in recorded(*recorder.files)] == [[1]]
    with pytest.raises(FileExistsError):
        Recorder("/out", path=tmp_path / "a.mcap", names=names)
    wait_until(lambda: not out.outputs)  # its port was closed again


def test_by_default_the_date(tmp_path, names, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    with Recorder("/x", names=names, tell=lambda line: None) as recorder:
        assert recorder.files[0].name.startswith("record-20")


def test_a_carrier_that_nobody_has(tmp_path, names) -> None:
    with pytest.raises(UnknownPlugin, match='no carrier "tpc": did you mean "tcp"'):
        Recorder("/x", path=tmp_path / "x", carrier="tpc", names=names)
    assert not [*tmp_path.iterdir()]


def test_a_defect_is_told(tmp_path, names, out, monkeypatch) -> None:
    told: list[str] = []

    def broken(self: object, step: int, batch: object) -> int:
        raise ValueError("broken")

    monkeypatch.setattr(module.Recorder, "_look_around", broken)
    with Recorder("/out", path=tmp_path / "x", names=names, tell=told.append) as recorder:
        assert recorder.ended.wait(HANG)
    assert recorder.failure == "ValueError: broken" and told[0] == recorder.failure


def test_nothing_but_snapshots(tmp_path, names, out) -> None:
    with Recorder("/out", path=tmp_path / "x", names=names, snapshot=3600) as recorder:
        assert out.wait_for_outputs(timeout=HANG)
        assert (recorder.state, recorder.files, recorder.snapshots) == ("keeping", [], True)
        with pytest.raises(LocalProtocolError, match="only snapshots"):
            recorder.split()
        for number in (1, 2):
            for n in range(50):
                out.write([number, n])
            wait_until(lambda number=number: recorder.messages == 50 * number)
            wait_until(lambda: recorder.held > 0)
            recorder.mark(f"mark {number}")
            recorder.snapshot()
            wait_until(lambda number=number: len(recorder.files) == number)
            wait_until(lambda: recorder.held == 0)
        assert [*tmp_path.iterdir()] != []
    assert recorder.files == [tmp_path / "x-0001.mcap", tmp_path / "x-0002.mcap"]
    first, second = ([one.value for one in recorded(file)] for file in recorder.files)
    # What came between the message that was waited for and the snapshot may be in either.
    assert first + second == [[number, n] for number in (1, 2) for n in range(50)]
    assert len(first) == 50
    assert {"mark", "snapshot", "connected"} <= {*kinds(recorder.files[0])}
    assert recorder.lost == 0


def test_a_message_that_is_waited_for(tmp_path, names, out) -> None:
    told: list[str] = []
    with Recorder(  # the port of a trigger need not be named again
        path=tmp_path / "x", names=names, snapshot=60, triggers={"/out": "fall"}, tell=told.append
    ) as recorder:
        assert out.wait_for_outputs(timeout=HANG)
        for word in ("stands", "stands", "falls"):
            out.write([word])
        wait_until(lambda: recorder.files)
        wait_until(lambda: recorder.held == 0)
    assert [one.value for one in recorded(*recorder.files)] == [["stands"], ["stands"], ["falls"]]
    assert any("/out" in line for line in told)


def test_snapshots_are_asked_for_in_vain(tmp_path, names, out) -> None:
    with pytest.raises(LocalProtocolError, match="snapshots"):
        Recorder("/out", path=tmp_path / "y", names=names, triggers={"/out": "x"})
    with (
        Recorder("/out", path=tmp_path / "x", names=names) as recorder,
        pytest.raises(LocalProtocolError, match="--snapshot"),
    ):
        recorder.snapshot()
    with Recorder("/out", path=tmp_path / "z", names=names, snapshot=10) as recorder:
        pass
    assert recorder.files == [] and not (tmp_path / "z-0001.mcap").exists()


def test_a_type_that_changes(tmp_path, names, out) -> None:
    values = [[1, 2.5], "word", yarpy.Vector([1.5]), yarpy.Image(np.zeros((3, 5), "u1")), [3, 4]]
    with Recorder("/out", path=tmp_path / "x", names=names) as recorder:
        assert out.wait_for_outputs(timeout=HANG)
        for value in values * 3:
            out.write(value)
        wait_until(lambda: recorder.messages == 15)
    found = recorded(*recorder.files)
    assert [one.value for one in found] == values * 3
    with record.open(*recorder.files) as recording:
        told = recording.ports["/out"].kinds
    assert told == ["yarp/bottle", "yarp/vector", "yarp/image"]
