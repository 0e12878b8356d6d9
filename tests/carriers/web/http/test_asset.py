"""The files that pages share: all are there, load only each other, and nothing else is shown."""

from __future__ import annotations

import re

import pytest

from yarpy.carriers.web.http.asset import KINDS, asset
from yarpy.carriers.web.http.intent import Refusal, Request
from yarpy.carriers.web.http.request import page_asked, read_intent


def get(path: str) -> Refusal:
    found = read_intent(Request("GET", path, {}))
    assert isinstance(found, Refusal)
    return found


@pytest.mark.parametrize("name", KINDS)
def test_files(name: str) -> None:
    found = get(f"/*/{name}")
    assert (found.status, found.kind) == (200, KINDS[name])
    assert found.text == asset(name)
    assert {*re.findall(r'from "/\*/([\w.]+)"', found.text)} <= {*KINDS}
    assert "innerHTML" not in found.text and "http:" not in found.text


@pytest.mark.parametrize("path", ["/*/", "/*/x", "/*/../asset.py", "/*/%2e%2e/asset.py", "/*/a/b"])
def test_what_is_no_file(path: str) -> None:
    assert get(path).status == 404


def test_no_program_is_asked_for_them() -> None:
    for path in ("/*", "/*/port.js", "/*/x"):
        assert page_asked(Request("GET", path, {})) is None
