"""Who is let in, and how long a request may take."""

from __future__ import annotations

import http.client
import socket
import threading
import time
from contextlib import ExitStack
from types import SimpleNamespace
from urllib.parse import urlsplit

import pytest
from support.wait import HANG, wait_until

from yarpy.kits.record.view import limited_server
from yarpy.kits.record.view.limited_server import LimitedServer
from yarpy.kits.record.view.server import View


def dial(view: View) -> socket.socket:
    return socket.create_connection(("127.0.0.1", urlsplit(view.url).port or 0), HANG)


def answers(view: View) -> bool:
    asked = http.client.HTTPConnection("127.0.0.1", urlsplit(view.url).port or 0, timeout=HANG)
    try:
        asked.request("GET", "/timeline")
        return asked.getresponse().status == 200
    except (OSError, http.client.HTTPException):
        return False
    finally:
        asked.close()


def test_who_sends_a_byte_now_and_then_does_not_hold_a_place(
    view: View, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(limited_server, "VIEW_CLIENTS", 3)
    monkeypatch.setattr(limited_server, "VIEW_SECONDS", 0.5)
    over = threading.Event()
    with ExitStack() as stack:
        lines = [stack.enter_context(dial(view)) for _ in range(3)]

        def drip() -> None:
            while not over.wait(0.02):
                for line in lines:
                    try:
                        line.sendall(b"G")
                    except OSError:
                        return

        thread = threading.Thread(target=drip)
        thread.start()
        try:
            wait_until(lambda: answers(view), what="a place is free again")
        finally:
            over.set()
            thread.join()


def test_a_slow_answer_is_no_late_request(view: View, monkeypatch: pytest.MonkeyPatch) -> None:
    told = view.source.told

    def slow() -> dict[str, object]:
        later = time.monotonic() + 2 * limited_server.VIEW_SECONDS
        with monkeypatch.context() as patch:
            patch.setattr(limited_server, "time", SimpleNamespace(monotonic=lambda: later))
            view._server.service_actions()
        return told()

    monkeypatch.setattr(view.source, "told", slow)
    assert answers(view)


def test_one_other_computer_holds_a_part(view: View, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limited_server, "VIEW_CLIENTS", 8)
    monkeypatch.setattr(limited_server, "FROM_ELSEWHERE", 2)
    monkeypatch.setattr(limited_server, "same_computer", lambda remote, local: False)
    with ExitStack() as stack:
        for _ in range(2):
            line = stack.enter_context(dial(view))
            line.sendall(b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
            assert line.recv(15) == b"HTTP/1.1 200 OK"
        assert not answers(view)
        monkeypatch.setattr(limited_server, "same_computer", lambda remote, local: True)
        assert answers(view)
    wait_until(lambda: not _open(view), what="all are counted out")


def _open(view: View) -> int:
    server = view._server
    assert isinstance(server, LimitedServer)
    return server._open.total()
