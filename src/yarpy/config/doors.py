"""Doors: who reaches the ports of programs that are started here, and with what, in words.

Rules: what holds by default is also the table of SECURITY.md, which a test compares.
"""

from __future__ import annotations

import os
from dataclasses import dataclass

from yarpy.config import access_file
from yarpy.errors import YarpError
from yarpy.link.begin.admission import SCRIPT
from yarpy.shipped import TRANSPORTS
from yarpy.transports.bind import SETTING as BIND
from yarpy.transports.bind import reach


@dataclass(frozen=True, slots=True)
class Entry:
    """Somebody or something, what it may do here, and the setting that changes that."""

    who: str
    may: str
    setting: str


def doors() -> list[Entry]:
    """Return who may do what with ports of programs that get this environment."""

    def said(name: str) -> str:
        return os.environ.get(name, "").strip()

    words = said("YARPY_SCRIPTS").replace(",", " ").split()
    origins = said("YARPY_WEB_ORIGINS")
    guarded = {row.setting: row.title for row in TRANSPORTS.values() if row.setting}
    every_page = "*" in origins.split()
    named = origins not in ("", "none")
    here = reach()
    return [
        Entry(
            "every program that reaches this computer"
            if here == "all networks"
            else f"programs of {here}",
            _programs(),
            f"`{BIND}`, `access.toml`",
        ),
        Entry(
            "web pages of this network",
            "everything"
            if every_page
            else f"read what ports write{f'; those of {origins} everything' if named else ''}",
            "`YARPY_WEB_ORIGINS`",
        ),
        Entry(
            "web pages of the internet",
            "everything"
            if every_page
            else f"nothing{f', but those of {origins} everything' if named else ''}",
            "`YARPY_WEB_ORIGINS`",
        ),
        Entry(
            "scripts (Lua, Python) that others ask for",
            _scripts("network" in words),
            "`YARPY_SCRIPTS=network`, `yarpy access allow script FROM`",
        ),
        *(
            Entry(
                f"peers that come by {title}",
                "are met" if said(setting) == "yes" else "are refused",
                f"`{setting}=yes`",
            )
            for setting, title in guarded.items()
        ),
        Entry("connections", _connections(said("YARPY_TLS")), "`YARPY_TLS`"),
    ]


def _programs() -> str:
    try:
        access = access_file.current()
    except YarpError as error:
        return f"nothing, since no port opens: {error}"
    if access is not None:
        return f"what {access.path} lists (`yarpy check --access`)"
    return "read, write, administer, attach installed monitors, register names"


def _scripts(all_peers: bool) -> str:
    if all_peers:
        return "run, from a context's folder"
    try:
        access = access_file.current()
    except YarpError:
        access = None
    named = (
        [one for rule in access.rules if SCRIPT in rule.may for one in rule.who] if access else []
    )
    if named:
        return f"run, from a context's folder, for {', '.join(dict.fromkeys(named))}"
    return "do not run"


def _connections(setting: str) -> str:
    if not setting:
        return "are plain, or TLS where the dialling side asks for it"
    return "are TLS alone" + (", with certificates of both sides" if setting == "mutual" else "")
