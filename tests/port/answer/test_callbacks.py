"""What a program does for its port, and what its defects cost."""

from __future__ import annotations

from collections.abc import Mapping

import pytest
from support.wait import HANG

from yarpy import network
from yarpy.carriers.web.http.page import Page
from yarpy.errors import LinkClosed
from yarpy.nameserver.local import LocalNames
from yarpy.port.answer.callbacks import Callbacks
from yarpy.port.connection import ConnectionEvent
from yarpy.port.keep.registration import Registration
from yarpy.port.port import Port
from yarpy.wire.message import Message


@pytest.fixture
def callbacks() -> Callbacks:
    return Callbacks(Registration("/here", None, "", register=False))


def test_port_without_callbacks_does_everything_itself(callbacks: Callbacks) -> None:
    callbacks.connection(ConnectionEvent(True, True, "/a", "/here", "tcp"))
    assert callbacks.page("/", {}) is None
    assert callbacks.lines_for_people() == []


def test_page_may_be_a_string_a_page_or_left_to_the_port(callbacks: Callbacks) -> None:
    def shown(path: str, fields: Mapping[str, str]) -> Page | str | None:
        return {"/": "<h1>hello</h1>", "/page": Page(b"here", "text/plain")}.get(path)

    callbacks.program.on_page = shown
    assert callbacks.page("/", {}) == Page("<h1>hello</h1>")
    assert callbacks.page("/page", {}) == Page(b"here", "text/plain")
    assert callbacks.page("/other", {}) is None


def test_page_that_fails_is_logged_and_told(
    callbacks: Callbacks, caplog: pytest.LogCaptureFixture
) -> None:
    def fail(path: str, fields: Mapping[str, str]) -> str:
        raise ValueError("a defect of mine")

    callbacks.program.on_page = fail
    page = callbacks.page("/", {})
    assert page is not None and page.status == 500
    assert "/here: the page / failed" in caplog.text
    assert "a defect of mine" in caplog.text


def test_failing_callback_is_logged(names: LocalNames, caplog: pytest.LogCaptureFixture) -> None:
    def fail(event: ConnectionEvent) -> None:
        raise ValueError("oh")

    with Port("/in", names=names, on_connection=fail) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        out.write([1])
        assert in_.read(timeout=HANG).value == [1]
    assert "the connection callback failed" in caplog.text


def test_failing_administrative_callback_ends_that_connection_alone(
    names: LocalNames, caplog: pytest.LogCaptureFixture
) -> None:
    def fail(message: Message) -> object:
        raise ValueError("oh")

    with Port("/it", names=names) as port:
        port.on_admin(fail)
        with pytest.raises(LinkClosed):
            network.admin("/it", "unknown", names=names)
        assert network.exists("/it", names=names)
    assert "oh" in caplog.text
