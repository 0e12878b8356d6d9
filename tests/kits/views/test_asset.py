"""Files of pages: what is there, under which type, and that JSON is valid whatever is told."""

from __future__ import annotations

import json
import math
import re

import pytest

import yarpy
from yarpy.carriers.web.http.asset import KINDS
from yarpy.kits.views.asset import asset, jsonpage, site


@pytest.mark.parametrize("program", ["view", "scope"])
def test_a_program_has_its_page_and_what_the_page_loads(program: str) -> None:
    pages = site(program)
    page = pages("/", {})
    assert isinstance(page, yarpy.Page)
    assert page.kind.startswith("text/html")
    loaded = re.findall(r'(?:src|href)="(/[\w.]+)"', str(page.body))
    assert f"/{program}.js" in loaded
    assert 'href="/*/style.css"' in str(page.body)
    for path in loaded:
        found = pages(path, {})
        assert isinstance(found, yarpy.Page), path
        assert found.kind.startswith(("text/javascript", "text/css"))
        imported = re.findall(r'from "\./([\w.]+)"', str(found.body))
        assert all(f"/{name}" in pages for name in imported)
        assert {*re.findall(r'from "/\*/([\w.]+)"', str(found.body))} <= {*KINDS}
    # Nothing written into the page runs, and nothing comes from elsewhere.
    policy = re.search(r'Content-Security-Policy" content="([^"]+)"', str(page.body))
    assert policy is not None
    assert "default-src 'none'; script-src 'self';" in policy[1]
    assert "unsafe" not in policy[1]


def test_what_is_no_file_of_the_page() -> None:
    for path in ("/x", "/view.html", "/asset.py", "/../asset.py", "/assets/view.js", "/scope.html"):
        assert site("view")(path, {}) is None
    assert asset("view.html") is asset("view.html")


def test_numbers_that_json_lacks_are_null() -> None:
    value = {"a": [math.nan, 1.5, -math.inf], "b": "<script>", "c": (None, True)}
    page = jsonpage(value)
    assert page == yarpy.Page(page.body, "application/json")
    assert json.loads(page.body) == {"a": [None, 1.5, None], "b": "<script>", "c": [None, True]}
