"""A page that a command shows: its address for people, and a browser where there is a display."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from contextlib import suppress
from typing import TYPE_CHECKING

from yarpy.cli.output import print_line
from yarpy.transports.tls_setting import required

if TYPE_CHECKING:
    from yarpy.port.base import BasePort


def show_page(port: BasePort, browser: bool = True) -> None:
    """Print where the page of `port` is, and open it unless `browser` is False."""
    url = url_of(port.address)
    print_line(f"{port.name} is shown at {url}")
    if browser:
        open_page(url)


def url_of(address: str) -> str:
    """Return the URL by which browsers find a page of this program: https if it takes nothing
    else."""
    return f"http{'s' if required() else ''}://{address}/"


def open_page(url: str) -> None:
    """Show a page in a browser, if there is a display."""
    if has_display(sys.platform, os.environ):
        import webbrowser

        with suppress(webbrowser.Error, OSError):  # the address was printed
            webbrowser.open(url)


def has_display(platform: str, environment: Mapping[str, str]) -> bool:
    """Return whether a window can appear; elsewhere a browser would take over the terminal."""
    if platform in ("win32", "darwin"):
        return True
    return bool(environment.get("DISPLAY") or environment.get("WAYLAND_DISPLAY"))
