"""`yarpy convert`; tests/kits/record/test_convert.py has what it writes."""

import errno
import os

import pytest
from support.recordings import START, STEP, payload_of, recorded

from yarpy import record
from yarpy.kits.record.lerobot import dataset
from yarpy.kits.record.mcap.writer import McapWriter


def test_there_and_back(here, tmp_path) -> None:
    path = recorded(tmp_path / "x.mcap")
    cpp, back = str(tmp_path / "cpp"), str(tmp_path / "back")
    said = here("convert", str(path), "-o", cpp, "--format", "dumper", "--times", "tx+rx")
    assert (said.code, said.out) == (0, f"{cpp}: 10 messages\n")
    said = here("convert", cpp, "-o", back, "--compress", "lz4", "--ports", "/a")
    assert (said.code, said.out) == (0, f"{back}.mcap: 5 messages\n")
    said = here("convert", cpp, "-o", back)
    assert said.code == 1 and "is there already: choose another name" in said.err


@pytest.mark.parametrize("form", ["mcap", "dumper", "bag1", "bag2", "robometry"])
def test_a_path_without_a_name(form, here, tmp_path) -> None:
    path = recorded(tmp_path / "x.mcap")
    said = here("convert", str(path), "-o", ".", "--format", form)
    assert (said.code, said.out) == (1, "") and "is no name of a recording" in said.err


def test_what_is_damaged_is_told(here, tmp_path) -> None:
    path = recorded(tmp_path / "x.mcap")
    path.write_bytes(path.read_bytes()[:400])
    said = here("convert", str(path), "-o", str(tmp_path / "y"))
    assert said.code == 1 and "x.mcap: byte " in said.err and "messages" in said.out


def test_several_as_one(here, tmp_path) -> None:
    paths = [tmp_path / "even.mcap", tmp_path / "odd.mcap"]
    for n, path in enumerate(paths):
        with McapWriter(path) as writer:
            for m in range(5):
                writer.add(f"/{n}", "", START + (2 * m + n) * STEP, payload_of([2 * m + n]))
    out = tmp_path / "both"
    assert here("convert", *map(str, paths), "-o", str(out)).code == 0
    with record.open(f"{out}.mcap") as found:
        assert [one.value for one in found] == [[n] for n in range(10)]
    said = here("convert", *map(str, paths), "-o", str(out))
    assert said.code == 1 and "there already" in said.err


def test_a_data_set_of_lerobot(here, tmp_path) -> None:
    pytest.importorskip("pyarrow", reason="data sets need pyarrow: pip install 'yarpy[table]'")
    path, folder = str(recorded(tmp_path / "x.mcap")), str(tmp_path / "set")
    words = ("convert", path, path, "-o", folder, "--format", "lerobot", "--fps", "100")
    said = here(*words, "--state", "/a", "--action", "/b", "--task", "Wave")
    assert (said.code, said.err) == (0, "") and said.out.startswith(f"{folder}: 2 episodes, ")
    said = here(*words, "--state", "/a")
    assert said.code == 1 and "is there already: choose another name" in said.err
    said = here("convert", folder, "-o", str(tmp_path / "y"))
    assert (said.code, said.err) == (0, "")
    said = here("info", str(tmp_path / "y.mcap"))
    assert "/observation/state" in said.out and "mark episode 1" in said.out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ((), "--state /PORT"),
        (("--state", "/a", "--ports", "/a"), "--state --action"),
        (("--state", "/a", "--image", "/cam"), "--image /cam/left=left"),
    ],
)
def test_what_is_no_data_set(words, said, here, tmp_path) -> None:
    path = str(recorded(tmp_path / "x.mcap"))
    done = here("convert", path, "-o", str(tmp_path / "set"), "--format", "lerobot", *words)
    assert done.code == 1 and said in done.err


def test_a_full_disk_is_told_with_the_name(here, tmp_path, monkeypatch) -> None:
    def add(*_: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    path = recorded(tmp_path / "x.mcap")
    monkeypatch.setattr(McapWriter, "add", add)
    said = here("convert", str(path), "-o", str(tmp_path / "y"))
    assert (said.code, said.err) == (1, f"error: {os.strerror(errno.ENOSPC)}: {tmp_path / 'y'}\n")
    monkeypatch.setattr(dataset, "export", add)
    said = here("convert", str(path), "-o", "y", "--format", "lerobot", "--state", "/a")
    assert said.code == 1 and said.err.startswith("error: y cannot be written: ")
