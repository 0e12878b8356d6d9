"""What is told of a recording."""

from dataclasses import asdict
from pathlib import Path

from support.recordings import START, STEP, payload_of, recorded

from yarpy import record
from yarpy.kits.record.mcap.writer import McapWriter
from yarpy.kits.record.report import lines, report


def test_ports_and_rates(tmp_path: Path) -> None:
    with record.open(recorded(tmp_path / "x.mcap", 101)) as found:
        told = report(found)
    assert told.complete and told.messages == 101 and told.end - told.begin == 1.0
    assert [(port.name, port.messages, port.kinds, port.gap) for port in told.ports] == [
        ("/a", 51, ["yarp/bottle"], None),
        ("/b", 50, ["yarp/bottle"], None),
    ]
    assert told.ports[0].rate == 50.0
    assert asdict(told)["files"][0]["finished"] is True
    text = "\n".join(lines(told))
    assert "messages:  101\nduration:  1.000 s\nstart:     20" in text
    assert "/a        51 messages     50.00 Hz  yarp/bottle" in text


def test_silences_are_looked_for(tmp_path: Path) -> None:
    path = tmp_path / "x.mcap"
    with McapWriter(path) as writer:
        for n in (0, 1, 2, 50, 51):
            writer.add("/a", "", START + n * STEP, payload_of([n]))
    with record.open(path) as found:
        told = report(found, check=True)
        (port,) = told.ports
        assert port.gap == 0.48 and port.gap_at == (START + 2 * STEP) / 1e9
        assert "(longest silence 0.480 s at 0.020 s)" in "\n".join(lines(told))


def test_losses_of_finished_and_unfinished_files(tmp_path: Path) -> None:
    note = {"what": "lost", "port": "/a", "count": 3, "missed": 2, "replaced": 4}
    for finished in (True, False):
        path = tmp_path / f"{finished}.mcap"
        with McapWriter(path) as writer:
            writer.add("/a", "", START, payload_of([1]))
            writer.note(note, START)
            writer.note({"what": "mark", "text": "fell\x1b[2J"}, START + STEP)
            writer.note({"what": "lost", "port": 7, "count": -1}, START)
            writer.flush()
            if finished:
                told = {"lost": '{"/a": 3}', "missed": '{"/a": 2}', "left out": '{"/a": 9}'}
                told["replaced"] = '{"/a": 4}'
                writer.add_metadata("yarpy", {**told, "host": "lab"})
                writer.close()
            with record.open(path) as found:
                told_now = report(found)
            (port,) = told_now.ports
            assert (port.lost, port.missed, port.replaced) == (3, 2, 4)
            assert port.left_out == (9 if finished else 0)
            text = "\n".join(lines(told_now))
            assert "3 lost, 2 never arrived" in text and "0.010 s  mark fell" in text
            assert "\x1b" not in text and ("unfinished" in text) is not finished


def test_damage_is_named(tmp_path: Path) -> None:
    path = recorded(tmp_path / "x.mcap")
    with record.open(path) as found:
        place = found.storages[0]._file.index.places[1]  # type: ignore[attr-defined]
    data = bytearray(path.read_bytes())
    data[place + 70] ^= 1
    path.write_bytes(data)
    with record.open(path) as found:
        assert not report(found).damages
        told = report(found, check=True)
    assert len(told.damages) == 1 and f"x.mcap: byte {place}: " in told.damages[0]
    assert lines(told)[-2] == "damaged:"


def test_an_empty_recording(tmp_path: Path) -> None:
    with McapWriter(tmp_path / "x.mcap"):
        pass
    with record.open(tmp_path / "x.mcap") as found:
        assert "messages:  0" in lines(report(found))
