"""Files of web pages that come with the package: `asset("view.html")` is a Page.

Rules: a page, its scripts and its styles are files next to this module, or in the same folder of
another kit whose page shares some of these, or those at `/*/` that
every port has; nothing is loaded from elsewhere. Names, numbers and errors reach a page as JSON and
are put into it as text, so that nothing needs to be escaped.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from functools import cache, partial
from typing import Any, Final

import yarpy
from yarpy.carriers.web.http.page import Site

HERE: Final = "yarpy.kits.views"
_KINDS: Final = {
    "html": "text/html; charset=utf-8",
    "css": "text/css; charset=utf-8",
    "js": "text/javascript; charset=utf-8",
}


@cache
def asset(name: str, room: str = HERE) -> yarpy.Page:
    """The file `name` of the folder `assets` of a package, read once."""
    from importlib.resources import files

    text = files(room).joinpath("assets", name).read_text("utf-8")
    return yarpy.Page(text, _KINDS[name.rpartition(".")[2]])


def site(program: str, *files: str, room: str = HERE, shared: Sequence[str] = ()) -> Site:
    """The page of a program: `PROGRAM.html` at `/`, `PROGRAM.js`, and what they load from the same
    package; `shared` are files of this one."""
    names = {"/": f"{program}.html", **{f"/{name}": name for name in (f"{program}.js", *files)}}
    pages = {path: partial(_asset, name, room) for path, name in names.items()}
    return Site({**pages, **{f"/{name}": partial(_asset, name, HERE) for name in shared}})


def _asset(name: str, room: str, fields: Mapping[str, str]) -> yarpy.Page:
    return asset(name, room)


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
