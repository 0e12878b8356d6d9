"""Files of web pages that come with the package: `asset("view.html")` is a Page.

Rules: a page, its scripts and its styles are files next to this module, or those at `/*/` that
every port has; nothing is loaded from elsewhere. Names, numbers and errors reach a page as JSON and
are put into it as text, so that nothing needs to be escaped.
"""

from __future__ import annotations

import json
from functools import cache
from typing import Any, Final

import yarpy

_KINDS: Final = {
    "html": "text/html; charset=utf-8",
    "css": "text/css; charset=utf-8",
    "js": "text/javascript; charset=utf-8",
}


@cache
def asset(name: str) -> yarpy.Page:
    """The file `name`, read once."""
    from importlib.resources import files

    text = files("yarpy.views").joinpath("assets", name).read_text("utf-8")
    return yarpy.Page(text, _KINDS[name.rpartition(".")[2]])


def page_of(program: str, path: str) -> yarpy.Page | None:
    """The page of a program: `PROGRAM.html` with `PROGRAM.js`."""
    if path == "/":
        return asset(f"{program}.html")
    name = f"{program}.js"
    return asset(name) if path == f"/{name}" else None


def jsonpage(value: Any) -> yarpy.Page:
    """A value for a script. Numbers that JSON cannot express are null."""
    try:
        text = json.dumps(value, allow_nan=False)
    except ValueError:
        text = json.dumps(_finite(value))
    return yarpy.Page(text, "application/json")


def _finite(value: Any) -> Any:
    if isinstance(value, float):
        return value if abs(value) < float("inf") else None
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    return [_finite(item) for item in value] if isinstance(value, list | tuple) else value
