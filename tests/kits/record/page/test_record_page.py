"""The page of a recorder: what it tells, and what a browser makes of it."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from support.wait import wait_until

import yarpy
from yarpy import record
from yarpy.kits.record.commands import recorder_commands
from yarpy.kits.record.page.record_page import NEWS, RecordPage

if TYPE_CHECKING:
    from support.browser import Browser

EVIL = "/<b>bold"


@pytest.fixture
def names() -> Iterator[yarpy.names.base.NameClient]:
    with yarpy.NameServer() as server:
        yield server.client


def told(port: yarpy.RpcServer) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(port._program.on_page("/recording", {}).body)
    return found


def test_what_it_tells(names: Any, tmp_path: Path) -> None:
    path = tmp_path / "x"
    news = [*map(str, range(NEWS + 5))]
    with (
        yarpy.Port("/a", names=names) as sender,
        record.Recorder("/a", "/late", path=path, names=names, tell=str) as recorder,
        yarpy.RpcServer("/rpc", lambda message: None, names=names) as port,
    ):
        RecordPage(port, recorder, news)
        assert sender.wait_for_outputs()
        sender.write([1, 2], wait=True)
        wait_until(lambda: recorder.messages == 1)
        found = told(port)
        here, late = found["ports"]
        assert here["name"] == "/a" and here["there"] and here["messages"] == 1
        assert here["bytes"] > 0 and here["lost"] == here["missed"] == here["left"] == 0
        assert late == {**here, "name": "/late", "there": False, "wanted": True,
                        "messages": 0, "bytes": 0}  # fmt: skip
        assert found["state"] == "recording" and found["failure"] == ""
        assert found["files"] == [f"{path}.mcap"] and found["count"] == 1
        assert found["free"] > 0 and found["memory"] == recorder.memory
        assert found["news"] == news[5:]
        recorder.pause()
        assert told(port)["state"] == "paused"


def test_a_person_pauses_marks_splits_and_stops(
    browser: "Browser", names: Any, tmp_path: Path
) -> None:
    stopped: list[bool] = []
    news: list[str] = []
    with (
        yarpy.Port(EVIL, names=names) as sender,
        record.Recorder(
            EVIL, "/late", path=tmp_path / "x", names=names, tell=news.append
        ) as recorder,
        yarpy.RpcServer(
            "/rpc", recorder_commands(recorder, lambda: stopped.append(True)), names=names
        ) as port,
    ):
        RecordPage(port, recorder, news)
        assert sender.wait_for_outputs()
        sender.write([1], wait=True)
        page = browser.open(f"http://{port.address}/")
        row = page.locator("#ports tr", has_text=EVIL)
        wait_until(lambda: row.locator("td").nth(2).inner_text() == "1")
        assert page.locator("#ports tr.waiting").inner_text().startswith("/late")
        page.get_by_text("/late is not there yet").wait_for()
        page.get_by_role("button", name="Pause").wait_for()  # whoever may use keys has buttons
        page.keyboard.press("Space")
        page.get_by_role("button", name="Go on").wait_for()
        assert recorder.paused
        page.get_by_role("button", name="Go on").click()
        page.get_by_role("button", name="Pause").wait_for()
        page.get_by_label("Note of this moment").fill('it "fell"')
        page.get_by_role("button", name="Mark").click()
        page.get_by_text("yarpy rpc /record/rpc:i mark").wait_for()
        page.get_by_role("button", name="New file").click()
        page.get_by_text("file 2").wait_for()
        browser.picture(page, "record")
        small = browser.open(f"http://{port.address}/", dark=True, phone=True)
        small.get_by_text("file 2").wait_for()
        assert small.evaluate("document.documentElement.scrollWidth") == 390
        browser.picture(small, "record-phone")
        page.get_by_role("button", name="Stop").click()
        assert not stopped, "once may be a slip"
        page.get_by_role("button", name="Stop now?").click()
        wait_until(lambda: stopped)
    with record.open(*recorder.files) as found:
        assert [note.get("text") for note in found.notes() if note["what"] == "mark"] == [
            'it "fell"'
        ]
