"""`yarpy view [PORT...] [--connect SOURCE]...`: look at images, in a browser.
`yarpy view FILE...`: look back, at what was recorded; with `--beside FILE` at two recordings.
`yarpy view --keep 5min PORT...`: at what is.

Opens ports that take images and shows them side by side in a page that the ports serve themselves,
whose address is printed. With a display a browser opens. A recording, or the last minutes of ports,
has a page of its own, for this computer; Foxglove and Lichtblick read from the same address.

Differs from C++ yarpview: the window is a web page, so its place, size and title are the browser's;
pictures of 16 bits and of floating point numbers are stretched to what can be seen.
Exit codes: 1 a port cannot be opened, or a source cannot be one; otherwise it runs until a signal.
"""

from __future__ import annotations

import os
import sys
import time
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import TYPE_CHECKING

import click

import yarpy
from yarpy.cli.browser import has_display, open_page, show_page
from yarpy.cli.output import print_line
from yarpy.cli.ports import open_port
from yarpy.cli.source import Source, also_said
from yarpy.cli.stderr import warn
from yarpy.errors import LinkClosed, LocalProtocolError
from yarpy.platform import waiting
from yarpy.wire.message import Message

if TYPE_CHECKING:
    from yarpy.kits.record.view.beside import BesideSource
    from yarpy.kits.record.view.source import FileSource

NAME = "/view"


@click.command()
@click.argument("ports", nargs=-1, metavar="[PORT...|FILE...]")
@click.option(
    "--connect", "sources", multiple=True, metavar="SOURCE",
    help="Ask SOURCE for its images; again for the next port.",
)  # fmt: skip
@click.option("--carrier", metavar="C", help="How the sources are connected (tcp).")
@click.option(
    "--quality", type=click.IntRange(1, 100), default=75, show_default=True, metavar="N",
    help="Quality of the JPEG files that browsers get, 1 to 100.",
)  # fmt: skip
@click.option(
    "--rate", type=click.FloatRange(0.01, 1000), default=30.0, show_default=True, metavar="HZ",
    help="Pictures per second that a browser gets at most.",
)  # fmt: skip
@click.option(
    "--out", "outs", multiple=True, metavar="PORT",
    help="Open PORT, which sends where people click: x y, or x0 y0 x1 y1 for a drag; again for the "
    "next picture.",
)  # fmt: skip
@click.option("--no-browser", is_flag=True, help="Open no browser.")
@click.option(
    "--keep", metavar="TIME",
    help="Keep the last TIME (30s, 5min) of PORTS, all by default, to look back.",
)  # fmt: skip
@click.option("--foxglove", is_flag=True,
              help="Let Foxglove's page read a recording or what is kept; open it.")  # fmt: skip
@click.option("--rerun", is_flag=True,
              help="Show recordings, or what PORTS send, in Rerun's window.")  # fmt: skip
@click.option("--beside", metavar="FILE", help="Show another recording on the same time line.")
@click.option("--offset", type=float, metavar="S",
              help="It begins S seconds after the first one (0: both together).")  # fmt: skip
@click.option("--lan", is_flag=True, help="Let other computers see a recording, or what is kept.")
def command(
    ports: tuple[str, ...],
    sources: tuple[str, ...],
    carrier: str | None,
    quality: int,
    rate: float,
    outs: tuple[str, ...],
    no_browser: bool,
    keep: str | None,
    foxglove: bool,
    rerun: bool,
    beside: str | None,
    offset: float | None,
    lan: bool,
) -> int:
    """Show the images that arrive at PORTS (/view), or recordings, in a browser."""
    if beside is not None and (keep is not None or rerun or not any(map(is_recording, ports))):
        raise click.UsageError("--beside shows two recordings: yarpy view FILE --beside FILE")
    if offset is not None and beside is None:
        raise click.UsageError("--offset is that of the second recording: --beside FILE")
    if rerun:
        return in_rerun(ports, carrier or "", not no_browser)
    if keep is not None or any(map(is_recording, ports)):
        look_back(ports, keep, carrier, lan, not no_browser, foxglove, beside, offset or 0.0)
        return 0
    if foxglove:
        raise click.UsageError("--foxglove shows recordings, or with --keep 1min what PORTS send")
    from yarpy.kits.views.picture import Picture
    from yarpy.kits.views.viewer import Viewer

    names = names_of(ports, max(len(sources), len(outs)))
    with ExitStack() as stack:
        opened = [stack.enter_context(open_port(yarpy.BufferedPort, name, "-")) for name in names]
        clicks = [stack.enter_context(open_port(yarpy.BufferedPort, out)) for out in outs]
        pictures = [Picture(port) for port in opened]
        Viewer(pictures, quality, rate, clicks)
        for picture, source in zip(pictures, sources, strict=False):
            Source(picture.port, source, carrier, also_said(picture.wait_for))
        show_page(opened[0], not no_browser)
        waiting.wait()
    return 0


def names_of(ports: tuple[str, ...], count: int) -> list[str]:
    """The ports to open: those that are named, and for `count` pictures more of their kind.

    >>> names_of((), 0)
    ['/view']
    >>> names_of(("/left",), 3)
    ['/left', '/view/2', '/view/3']
    """
    named = ports or (NAME,)
    return [*named, *(f"{NAME}/{number}" for number in range(len(named) + 1, count + 1))]


def is_recording(word: str) -> bool:
    """Return whether an argument names a file or folder, and no port."""
    return word.endswith(".mcap") or Path(word).exists()


def look_back(
    words: tuple[str, ...],
    keep: str | None,
    carrier: str | None,
    lan: bool,
    browser: bool,
    foxglove: bool = False,
    beside: str | None = None,
    offset: float = 0.0,
) -> None:
    """Show files, or the last minutes of ports, until a signal."""
    from yarpy.kits.record.capture.disk_space import parse_split
    from yarpy.kits.record.capture.subscriptions import PortSelection
    from yarpy.kits.record.view.elsewhere import FOXGLOVE, foxglove_address
    from yarpy.kits.record.view.ring import LiveSource
    from yarpy.kits.record.view.server import View
    from yarpy.kits.record.view.source import FileSource

    source: FileSource | LiveSource | BesideSource
    if keep is None:
        source = FileSource(words)
        if beside is not None:
            source = _beside(source, beside, offset)
    else:
        seconds = 0.0
        with suppress(LocalProtocolError):
            seconds = parse_split(keep).seconds
        if not seconds:
            raise LocalProtocolError(f'"{keep}" is no time that is kept: 30s, 5min')
        wanted = PortSelection(words, every=not words)
        source = LiveSource(wanted, seconds, carrier=carrier or "", tell=warn)
    if foxglove:  # its page comes from elsewhere, and may read what is asked for here
        known = os.environ.get("YARPY_WEB_ORIGINS", "")
        os.environ["YARPY_WEB_ORIGINS"] = f"{known} {FOXGLOVE}"
    with source, View(source, "" if lan else "127.0.0.1") as view:
        print_line(f"{source.title} is shown at {view.url}")
        page = foxglove_address(view.url) if foxglove else view.url
        if foxglove:
            print_line(f"and by Foxglove at {page}")
        if browser:
            open_page(page)
        waiting.wait()


def _beside(first: FileSource, path: str, offset: float) -> BesideSource:
    """Return both recordings; close the first one where the other cannot be shown."""
    from yarpy.kits.record.view.beside import BesideSource
    from yarpy.kits.record.view.source import FileSource

    with ExitStack() as stack:
        stack.enter_context(first)
        second = stack.enter_context(FileSource([path]))
        try:
            source = BesideSource(first, second, offset)
        except ValueError as error:
            raise LocalProtocolError(str(error)) from None
        stack.pop_all()
    return source


def in_rerun(words: tuple[str, ...], carrier: str, window: bool) -> int:
    """Hand recordings to Rerun, or what ports send until a signal; return the exit code. Without a
    window it is handed to one that listens already. Raises UnknownPlugin, LinkClosed."""
    from yarpy.kits.record.capture.opening import open_port
    from yarpy.kits.record.capture.subscriptions import PortSelection, Subscriptions
    from yarpy.kits.record.recorded import Recorded
    from yarpy.kits.record.recording import open_recording
    from yarpy.kits.record.view.elsewhere import rerun_library, show

    rr = rerun_library()
    if window and not has_display(sys.platform, os.environ):
        raise LinkClosed(
            "there is no display for Rerun's window: `rerun --serve-web` shows it in a browser, "
            "and --no-browser hands it to that one"
        )
    rr.init("yarpy", spawn=window)
    if not window:
        rr.connect_grpc()
    if any(map(is_recording, words)):
        with open_recording(*words) as recording:
            for recorded in recording:
                show(rr, recorded)
            for damage in recording.damages:
                warn(damage)
        try:
            rr.get_global_data_recording().flush()  # what is on its way arrives before we end
        except RuntimeError as error:
            raise LinkClosed(f"Rerun has not got all of it: {error}") from None
        finally:
            rr.disconnect()
        return 0

    def take(message: Message) -> None:
        now, stamp = time.time_ns(), message.stamp
        sent = now if stamp is None or not stamp.valid else round(stamp.time * 1e9)
        payload = bytes(message.to_bytes())
        show(rr, Recorded(message.source, now, sent, message.envelope, payload))

    with open_port("", take, lambda event: None, None, NAME) as port:
        following = Subscriptions(port, PortSelection(words, every=not words), carrier, tell=warn)
        print_line(f"what {port.name} hears is shown in Rerun")
        try:
            waiting.wait()
        finally:
            following.close()
    return 0
