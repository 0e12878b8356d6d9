"""`yarpy record`; tests/kits/record has what it writes."""

import json
import signal
import time

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy import record
from yarpy.errors import LocalProtocolError
from yarpy.kits.record.verbs.record import Keys, parse_memory, parse_rate


@pytest.fixture
def out(names):
    with yarpy.Port("/out", names=names) as port:
        yield port


def values(path) -> list[object]:
    with record.open(path) as found:
        return [one.value for one in found]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_finishes_the_file(cli, out, tmp_path, number) -> None:
    with cli.start("record", "/out", "-o", str(tmp_path / "x")) as process:
        assert out.wait_for_outputs(timeout=HANG)
        for n in range(10):
            out.write([n, 1], wait=True)
        process.signal(number)
        assert process.wait() == 0
        assert "x.mcap: 0:0" in process.stdout and "  /out: 10\n" in process.stdout
    with record.open(tmp_path / "x.mcap") as found:
        assert found.complete and len([*found]) == 10


def test_what_is_in_the_file_outlives_a_kill(cli, out, tmp_path) -> None:
    """It gets there while the recorder runs: nobody has to finish the file."""
    path = tmp_path / "x.mcap"
    with cli.start("record", "-e", "^/o", "-o", str(path)) as process:
        assert out.wait_for_outputs(timeout=HANG)
        until = time.monotonic() + HANG
        sent, written = 0, []
        while len(written) < 10:
            assert time.monotonic() < until, f"of {sent} messages {written} are in the file"
            out.write([sent, 1], wait=True)
            sent += 1
            written = [first for first, _ in values(path)]
        process.kill()
    with record.open(path) as found:
        assert not found.complete
        got = [one.value[0] for one in found]
    assert got == [*range(len(got))] and len(written) <= len(got) <= sent


def test_json(cli, out) -> None:
    (cli.home / "walk.xml").write_text("<application/>")
    words = ("-a", "--exclude", "root", "--json", "--split", "1h", "--attach", "walk.xml")
    with cli.start("record", *words, "-o", "y", "--compress", "zstd") as process:
        assert out.wait_for_outputs(timeout=HANG)
        out.write([1, 2], wait=True)
        process.signal(signal.SIGINT)
        assert process.wait() == 0
        told = json.loads(process.stdout)
    assert told["files"] == ["y-0001.mcap"] and told["failure"] == ""
    assert told["ports"]["/out"]["messages"] == 1
    assert values(cli.home / "y-0001.mcap") == [[1, 2]]
    with record.open(cli.home / "y-0001.mcap") as found:
        assert found.attachments() == {"walk.xml": b"<application/>"}


def test_a_duration_in_which_nothing_comes(cli, server) -> None:
    with cli.start("record", "/none", "--duration", "0.1", "-o", "y") as process:
        assert process.wait() == 1
        assert "its page is at http://" in process.stderr
        assert "error: nothing was recorded: /none was not there (" in process.stderr
    assert values(cli.home / "y.mcap") == []
    with cli.start("record", "-e", "none", "--duration", "0.1", "-o", "z") as process:
        assert process.wait() == 1
        assert "error: nothing was recorded: no wanted port sent" in process.stderr


def test_a_port_of_which_nothing_comes(cli, out, names) -> None:
    with cli.start("record", "/out", "/none", "/still", "-o", "w") as process:
        with yarpy.Port("/still", names=names) as still:
            assert out.wait_for_outputs(timeout=HANG) and still.wait_for_outputs(timeout=HANG)
            out.write([1], wait=True)
            process.signal(signal.SIGINT)
            assert process.wait() == 0
        assert "warning: /none was not there (" in process.stderr
        assert "warning: /still sent nothing" in process.stderr


def test_what_is_used_wrongly(here, tmp_path) -> None:
    assert "say which ports" in here("record").err
    assert here("record", "/x", "--max-files", "3").code == 1
    assert "is no regular expression" in here("record", "-e", "(").err
    assert "is no size" in here("record", "/x", "--memory", "lots").err
    (tmp_path / "x.mcap").write_text("mine")
    said = here("record", "/x", "-o", str(tmp_path / "x"))
    assert said.code == 1 and "is there already: choose another name" in said.err


def test_without_a_name_server(lone) -> None:
    said = lone.run("record", "/x")
    assert said.returncode == 1 and "no name server" in said.stderr.lower()
    assert not [*lone.home.glob("*.mcap")]


def test_rates() -> None:
    assert parse_rate("/cam/*=10") == ("/cam/*", 10.0)
    assert parse_rate("/a=b=0.5") == ("/a=b", 0.5)
    for text in ("/cam", "=3", "/cam=", "/cam=0", "/cam=-1", "/cam=nan", "/cam=inf"):
        with pytest.raises(LocalProtocolError, match="is no rate of a port"):
            parse_rate(text)


def test_keys(tmp_path, names, out) -> None:
    news: list[str] = []
    with record.Recorder("/out", path=tmp_path / "x", names=names) as recorder:
        keys = Keys(recorder, news)
        assert keys.press(" ") and recorder.paused
        assert keys.press(" ") and not recorder.paused
        assert all(map(keys.press, "mqe\x7f is up")) and keys.shown == [
            "note, then Enter: q is up_"
        ]
        assert all(map(keys.press, "\rmno\x1bm\rs?")) and not keys.shown
        wait_until(lambda: len(recorder.files) == 2)
        assert keys.press("m") and not keys.press("\x03")
        assert not Keys(recorder, news).press("q")
    assert len(news) == 3 and news[0].endswith(": q is up")
    with record.open(*recorder.files) as found:
        notes = [note for note in found.notes() if "connected" not in note["what"]]
        assert [note["what"] for note in notes] == ["pause", "resume", "mark", "mark"]
        assert [note.get("text") for note in notes[2:]] == ["q is up", ""]


def test_memory() -> None:
    assert parse_memory("1MB") == 1_000_000
    with pytest.raises(LocalProtocolError, match="1MB or more"):
        parse_memory("10")


def test_it_is_told_what_to_do(cli, names, out, tmp_path) -> None:
    words = ("record", "/out", "--start-paused", "-o", str(tmp_path / "x"))
    with cli.start(*words) as process, yarpy.RpcClient(names=names) as client:
        client.connect("/record/rpc:i", timeout=HANG)
        assert out.wait_for_outputs(timeout=HANG)
        out.write([1, 0], wait=True)
        assert client.call(["resume"]) == ["ok"]
        out.write([2, 0], wait=True)
        assert ["messages", 1] in client.call(["status"])
        assert client.call(["stop"]) == ["ok"]
        assert process.wait() == 0
    assert values(tmp_path / "x.mcap") == [[2, 0]]
