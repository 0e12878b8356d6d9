"""The server of a page: what it answers, to whom, and what its clients are sent."""

from __future__ import annotations

import json
import urllib.error
import urllib.request
from http.client import HTTPMessage
from pathlib import Path

import pytest
from support.foxglove_client import Client
from support.recordings import START, STEP, payload_of
from support.wait import HANG, wait_until

from yarpy import record
from yarpy.kits.record.mcap.writer import McapWriter
from yarpy.kits.record.view import server
from yarpy.kits.record.view.server import View
from yarpy.kits.record.view.source import FileSource


def get(url: str, headers: dict[str, str] | None = None) -> tuple[int, HTTPMessage, bytes]:
    asked = urllib.request.Request(url, headers=headers or {})
    try:
        with urllib.request.urlopen(asked, timeout=HANG) as answer:
            return answer.status, answer.headers, answer.read()
    except urllib.error.HTTPError as error:
        with error:
            return error.code, error.headers, error.read()


def test_pages(view: View) -> None:
    for path in ("", "look.js", "look_card.js", "look_link.js", "look_time.js", "look.css"):
        code, headers, body = get(view.url + path)
        assert code == 200 and body and headers["X-Content-Type-Options"] == "nosniff", path
    assert get(view.url + "*/plot.js")[0] == get(view.url + "favicon.ico")[0] == 200
    for path in ("nothing", "*/nothing", "../../etc/passwd", "server.py", "curve?port=/none"):
        assert get(view.url + path)[0] == 404, path
    for path in ("curve?port=/a&begin=x", "data.csv?port=/a&begin=nan", "curve?port=/a&end=1e400"):
        assert get(view.url + path)[0] == 400, path


def test_questions(view: View) -> None:
    told = json.loads(get(view.url + "timeline")[2])
    assert [one["name"] for one in told["ports"]] == ["/a", "/cam"]
    found = json.loads(get(view.url + "curve?port=/a&begin=0.1&end=0.13")[2])
    assert found["columns"] == [[10, 11, 12], [0.5] * 3]
    later = START + 20 * STEP
    found = json.loads(get(view.url + f"curve?port=/a&origin={later}&begin=0&end=0.02")[2])
    assert found["columns"][0] == [20, 21] and found["times"] == pytest.approx([0, 0.01])
    lines = get(view.url + "data.csv?port=/a")[2].splitlines()
    assert len(lines) == 101 and lines[1] == b"1795000000.000000000,0.500000000,0.0,0.5"


def test_a_stretch_is_cut_out(view: View, tmp_path: Path) -> None:
    code, _, body = get(view.url + "cut.mcap?begin=0.1&end=0.2")
    (tmp_path / "cut.mcap").write_bytes(body)
    assert code == 200
    with record.open(tmp_path / "cut.mcap") as recording:
        assert recording.complete
        assert [one.value[0] for one in recording.messages(["/a"])] == [*range(10, 20)]


def test_only_pages_of_its_own_may_see(view: View, monkeypatch: pytest.MonkeyPatch) -> None:
    """As every page of a program."""
    other = {"Origin": "https://app.foxglove.dev"}
    code, _, body = get(view.url + "timeline", other)
    assert code == 403 and b"YARPY_WEB_ORIGINS=https://app.foxglove.dev" in body
    assert get(view.url + "timeline", {"Host": "evil.example"})[0] == 421
    with Client(view.url, headers=other) as client:
        assert client.refused == 403
    monkeypatch.setenv("YARPY_WEB_ORIGINS", "https://app.foxglove.dev")
    with Client(view.url, headers=other) as client:
        assert client.protocol == "foxglove.sdk.v1"
    own = {"Origin": view.url.rstrip("/")}
    assert get(view.url + "timeline", own)[0] == 200


@pytest.mark.parametrize("protocol", ["foxglove.sdk.v1", "foxglove.websocket.v1"])
def test_both_names_of_the_protocol(protocol: str, view: View) -> None:
    with Client(view.url, protocol) as client:
        assert client.protocol == protocol
        info, channels = client.next(), client.next()
        assert info["op"] == "serverInfo" and info["capabilities"] == ["time", "playbackControl"]
        assert info["dataStartTime"] == {"sec": 1795000000, "nsec": 0}
        assert [one["encoding"] for one in channels["channels"]] == ["json", "protobuf"]


def test_the_server_outlives_its_clients(view: View) -> None:
    clients = [Client(view.url) for _ in range(5)]
    wait_until(lambda: len(view.sessions) == 5)
    for client in clients:
        client.control(False)
        client.line.close()
    wait_until(lambda: not view.sessions, what="all have gone")
    assert get(view.url)[0] == 200


def test_a_text_in_many_small_pieces(view: View, monkeypatch: pytest.MonkeyPatch) -> None:
    """Ends however little is in each of them, and is counted without looking back."""
    monkeypatch.setattr(server, "VIEW_ORDER", 2000)
    with Client(view.url) as client, pytest.raises((OSError, EOFError)):
        client.line.sendall(b"\x01\x80" + bytes(4) + (b"\x00\x80" + bytes(4)) * 2000)
        while True:
            client.next()
    assert get(view.url + "timeline")[0] == 200


def test_one_stretch_is_cut_out_at_a_time(view: View, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server, "VIEW_SECONDS", 0.01)
    with view._cutting:
        code, _, body = get(view.url + "cut.mcap?begin=0.1&end=0.2")
    assert code == 503 and b"another stretch" in body
    assert get(view.url + "cut.mcap?begin=0.1&end=0.2")[0] == 200


def test_files_and_lines_of_a_log(tmp_path: Path) -> None:
    with McapWriter(tmp_path / "x.mcap") as writer:
        writer.attach("walk.xml", b"<application/>", "application/xml")
        for n in range(2):
            line = ["[/log/lab/demo/7]", f"(level INFO) (systemtime 12.5) (message {'ab'[n]})"]
            writer.add("/log", "", START + n * STEP, payload_of(line))
    with FileSource([tmp_path / "x.mcap"]) as source, View(source, port=0) as view:
        told = json.loads(get(view.url + "timeline")[2])
        assert told["attached"] == [{"name": "walk.xml", "size": 14}]
        code, headers, body = get(view.url + "attached?name=walk.xml")
        assert (code, body) == (200, b"<application/>")
        assert headers["Content-Type"] == "application/octet-stream"
        assert get(view.url + "attached?name=other")[0] == get(view.url + "attached")[0] == 404
        assert get(view.url + "log?port=/none")[0] == 404
        assert get(view.url + "log?port=/log&end=x")[0] == 400
        lines = json.loads(get(view.url + "log?port=/log&end=0.001")[2])
        assert [one["text"] for one in lines] == ["a"]
        assert len(json.loads(get(view.url + "log?port=/log")[2])) == 2


def test_names_of_joints(tmp_path: Path) -> None:
    with McapWriter(tmp_path / "x.mcap") as writer:
        state = [[[1, 2], "f"], ["hip", "knee"], [0.5, 1.5], [], []]
        writer.add("/joints", "", START, payload_of(state))
    with FileSource([tmp_path / "x.mcap"]) as source, View(source, port=0) as view:
        found = json.loads(get(view.url + "curve?port=/joints")[2])
    assert found["names"] == ["", "", "hip position", "knee position"]
    assert len(found["columns"]) == 4
