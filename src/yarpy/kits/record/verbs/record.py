"""`yarpy record PORT... | -a | -e REGEX`: keep what ports send in a file.

    yarpy record /icub/head/state:o /icub/cam/left -o walk
    yarpy record -a --exclude /log/ --split 1GB --max-files 10

Ports may come later, and come back: they are recorded as soon as they are there. On a terminal a
table shows how each is doing, and keys pause (space), begin a new file (s), mark a moment (m, note,
Enter) and stop (q); elsewhere only what is odd is told. So do the words pause, resume, split,
mark TEXT, status and stop at the port /record/rpc:i (`yarpy rpc`), and its page in a browser, which
--page opens. ^C and SIGTERM finish the file; what was written can be read even after a kill.

Exit codes: 0 recorded, also when ^C or SIGTERM ends it; 1 nothing was, or it had to stop.
"""

from __future__ import annotations

import queue
import shutil
import sys
import time
from collections import deque
from collections.abc import MutableSequence, Sequence
from typing import TYPE_CHECKING, Final, Literal

import click

from yarpy.cli import log
from yarpy.cli.output import print_json, print_line
from yarpy.cli.signals import Interrupted
from yarpy.cli.stderr import complain, warn
from yarpy.errors import LocalProtocolError
from yarpy.port.rpc import RpcServer

if TYPE_CHECKING:
    from yarpy.kits.record.capture.recorder import Recorder
    from yarpy.kits.record.capture.screen import Rates, Status

PERIOD: Final = 0.5  # seconds between looks
NEWS: Final = 100  # lines that are kept
LEAST: Final = 1_000_000  # bytes of --memory


@click.command()
@click.argument("ports", nargs=-1, metavar="[PORT]...")
@click.option("-a", "--all", "every", is_flag=True, help="Record all ports, but for those of rpc.")
@click.option("-e", "--regex", "pattern", default="", show_default=False, metavar="REGEX",
              help="Record ports whose names contain a match.")  # fmt: skip
@click.option("--exclude", default="", show_default=False, metavar="REGEX",
              help="... but not those.")  # fmt: skip
@click.option(
    "-o", "--output", "path", metavar="NAME", help="Write NAME.mcap (by default the date)."
)
@click.option("--format", "format_", default="mcap", metavar="NAME",
              type=click.Choice(["mcap", "dumper", "both"]),
              help="mcap, dumper (the folders of C++ yarpdatadumper) or both.")  # fmt: skip
@click.option("--split", metavar="SIZE|TIME", help="Begin a new file after 1GB, 10min ...")
@click.option("--max-files", "most", type=click.IntRange(2), metavar="N",
              help="Keep the newest N files.")  # fmt: skip
@click.option("--compress", "compression", default="none", metavar="NAME",
              type=click.Choice(["none", "lz4", "zstd"]), help="none, lz4 or zstd.")  # fmt: skip
@click.option("--max-rate", "rates", multiple=True, metavar="PORT=N",
              help="Take N messages a second of a port (/cam/*=10) at most.")  # fmt: skip
@click.option("--newest", multiple=True, metavar="PORT",
              help="Where memory is full, its newer messages replace older ones.")  # fmt: skip
@click.option(
    "--memory", default="256MB", metavar="SIZE", help="For messages that wait for the disk."
)
@click.option("--snapshot", metavar="TIME",
              help="Write the last TIME (30s, 5min) when asked, by key or rpc.")  # fmt: skip
@click.option("--trigger", "triggers", multiple=True, metavar="PORT=REGEX",
              help="... or when a message of PORT has a match.")  # fmt: skip
@click.option("--recover", metavar="FILE",
              help="Record nothing: make a whole file of what is left of FILE.")  # fmt: skip
@click.option("--attach", "attached", multiple=True, metavar="FILE",
              type=click.Path(exists=True, dir_okay=False),
              help="Keep an application, a .thrift, a .msg ... within, too.")  # fmt: skip
@click.option("--start-paused", "paused", is_flag=True, help="Record nothing before the space bar.")
@click.option("--duration", type=click.FloatRange(0, min_open=True), metavar="S",
              help="Stop after so many seconds.")  # fmt: skip
@click.option("--carrier", default="", show_default=False, metavar="C",
              help="How ports are connected.")  # fmt: skip
@click.option("--name", default="", show_default=False, metavar="PORT",
              help="The recorder's own port (/record).")  # fmt: skip
@click.option("--page", is_flag=True, help="Open the page, which is there anyway, in a browser.")
@click.option("--json", "as_json", is_flag=True, help="Print a JSON object at the end.")
def command(
    ports: tuple[str, ...],
    every: bool,
    pattern: str,
    exclude: str,
    path: str | None,
    format_: Literal["mcap", "dumper", "both"],
    split: str | None,
    most: int | None,
    compression: str,
    rates: tuple[str, ...],
    newest: tuple[str, ...],
    memory: str,
    snapshot: str | None,
    triggers: tuple[str, ...],
    recover: str | None,
    attached: tuple[str, ...],
    paused: bool,
    duration: float | None,
    carrier: str,
    name: str,
    page: bool,
    as_json: bool,
) -> int:
    """Keep what PORTs send in a file, which yarpy play plays and Foxglove reads."""
    from yarpy.cli.browser import open_page, url_of
    from yarpy.kits.record.capture.disk_space import parse_split, parse_time
    from yarpy.kits.record.capture.recorder import Recorder
    from yarpy.kits.record.capture.screen import Rates, summary
    from yarpy.kits.record.commands import recorder_commands
    from yarpy.kits.record.page.record_page import RecordPage

    if recover is not None:
        return recovered(recover, path, compression)
    if not (ports or every or pattern):
        raise click.UsageError("say which ports: names, -a for all, or -e REGEX")
    if most is not None and split is None and snapshot is None:
        raise click.UsageError("--max-files needs --split, which says when a file is full")
    if snapshot is not None and split is not None:
        raise click.UsageError("--snapshot writes a file each time: --split has nothing to do")
    if triggers and snapshot is None:
        raise click.UsageError("--trigger needs --snapshot, which says how much is written")
    live = sys.stdout.isatty() and not as_json
    if not live:
        log.show()
    news: deque[str] = deque(maxlen=NEWS)

    def tell(line: str) -> None:
        news.append(line)
        if not live:
            warn(line)

    try:
        recorder = Recorder(
            *ports,
            every=every,
            pattern=pattern,
            exclude=exclude,
            path=path,
            format=format_,
            compression=compression,
            split=None if split is None else parse_split(split),
            most=most or 0,
            memory=parse_memory(memory),
            rates=dict(map(parse_rate, rates)),
            newest=newest,
            snapshot=0.0 if snapshot is None else parse_time(snapshot),
            triggers=dict(map(parse_trigger, triggers)),
            paused=paused,
            attach=attached,
            carrier=carrier,
            name=name,
            tell=tell,
        )
    except FileExistsError as error:
        complain(f"{error.filename} is there already: choose another name with -o")
        return 1
    began = time.monotonic()
    seen, stop = Rates(), recorder.ended
    try:
        with RpcServer(f"{recorder.name}/rpc:i", recorder_commands(recorder, stop.set)) as server:
            RecordPage(server, recorder, news)
            shown = f"its page is at {url_of(server.address)}"
            if page:
                open_page(url_of(server.address))
            if live:
                news.append(shown)
                _live(recorder, began, duration, news)
            else:
                click.echo(f"{beginning(recorder)}; {shown}", err=True)
                stop.wait(duration)
    except Interrupted:
        pass  # how it ends
    finally:
        recorder.close()
    status = status_of(recorder, began, seen, news)
    if as_json:
        print_json(facts(recorder, status))
    else:
        for line in summary(status):
            print_line(line)
    if recorder.failure:
        complain(recorder.failure)
        return 1
    came = {name for name, count in status.counts.items() if count.messages}
    silent = [_absence(port, port in status.counts) for port in ports if port not in came]
    if recorder.messages or recorder.snapshots:
        for line in silent:
            warn(line)
        return 0
    complain(f"nothing was recorded: {'; '.join(silent) or 'no wanted port sent anything'}")
    return 1


def _absence(port: str, there: bool) -> str:
    """Return why nothing came of a port that was named."""
    return (
        f"{port} {'sent nothing' if there else 'was not there (yarpy name list tells which are)'}"
    )


def parse_rate(text: str) -> tuple[str, float]:
    """Return the pattern and the rate of `/cam/*=10`. Raises LocalProtocolError."""
    name, equals, number = text.rpartition("=")
    try:
        rate = float(number)
    except ValueError:
        rate = 0.0
    if not (name and equals and 0 < rate < 1e9):
        raise LocalProtocolError(f'"{text}" is no rate of a port: /cam/*=10')
    return name, rate


def parse_memory(text: str) -> int:
    """Return the bytes of `256MB`. Raises LocalProtocolError, also for too few."""
    from yarpy.kits.record.capture.disk_space import parse_size

    size = parse_size(text)
    if size < LEAST:
        raise LocalProtocolError(f'"{text}" of memory keeps next to nothing: 1MB or more')
    return size


def parse_trigger(text: str) -> tuple[str, str]:
    """Return the port and the pattern of `/imu=fall`. Raises LocalProtocolError."""
    name, equals, pattern = text.partition("=")
    if not (name.startswith("/") and equals and pattern):
        raise LocalProtocolError(f'"{text}" is no trigger: /imu=fall')
    return name, pattern


def beginning(recorder: Recorder) -> str:
    """Return the first line."""
    if recorder.snapshots:
        return (
            f"keeping what comes to {recorder.name} in memory: "
            f"yarpy rpc {recorder.name}/rpc:i, snapshot, writes it"
        )
    return f"recording into {recorder.files[0]} through the port {recorder.name}"


def recovered(file: str, path: str | None, compression: str) -> int:
    """Write what can be read of a file into a whole one; return the exit code."""
    from yarpy.kits.record.convert import convert
    from yarpy.kits.record.recording import open_recording

    with open_recording(file) as recording:
        try:
            done = convert(
                recording,
                path or f"{file.removesuffix('.mcap')}-recovered",
                compression=compression,
            )
        except FileExistsError as error:
            complain(f"{error.filename} is there already: choose another name with -o")
            return 1
        for damage in recording.damages:
            warn(damage)
    print_line(f"{done.path}: {done.messages} messages")
    return 0 if done.messages else 1


def status_of(recorder: Recorder, began: float, seen: Rates, news: Sequence[str]) -> Status:
    """Return how a recorder is doing now."""
    from yarpy.kits.record.capture.screen import Status

    counts = recorder.counts
    files = recorder.files
    return Status(
        file=(
            f"{files[0]} ... {files[-1]}"
            if len(files) > 3
            else ", ".join(map(str, files)) or "nothing was written"
        ),
        snapshots=recorder.snapshots,
        seconds=time.monotonic() - began,
        size=recorder.size,
        held=recorder.held,
        memory=recorder.memory,
        free=recorder.free,
        paused=recorder.paused,
        counts=counts,
        rates=seen.take(counts, time.monotonic()),
        connected=recorder.connected,
        waiting=recorder.waiting,
        news=news[-1] if news else "",
    )


def facts(recorder: Recorder, status: Status) -> dict[str, object]:
    """Return what is printed as JSON at the end."""
    from yarpy.kits.record.capture.loss import KINDS, numbers_of

    return {
        "files": [*map(str, recorder.files)],
        "seconds": round(status.seconds, 3),
        "bytes": status.size,
        "failure": recorder.failure,
        "ports": {
            name: {
                "messages": count.messages,
                "bytes": count.bytes,
                **dict(zip(KINDS, numbers_of(count), strict=True)),
            }
            for name, count in sorted(status.counts.items())
        },
    }


def _live(
    recorder: Recorder, began: float, duration: float | None, news: MutableSequence[str]
) -> None:
    """Show it on a terminal, until `q`."""
    from rich.console import Console
    from rich.live import Live

    from yarpy.kits.record.capture.screen import Rates, text
    from yarpy.platform.keys import keys

    seen, console, typing = Rates(), Console(highlight=False), Keys(recorder, news)
    until = None if duration is None else began + duration
    with keys() as pressed, Live(console=console, auto_refresh=False, screen=True) as live:
        while not recorder.ended.is_set and (until is None or time.monotonic() < until):
            size = shutil.get_terminal_size((80, 24))
            status = status_of(recorder, began, seen, [*news, *typing.shown])
            live.update(text(status, size.columns, size.lines), refresh=True)
            end = time.monotonic() + PERIOD
            while (left := end - time.monotonic()) > 0:
                try:
                    key = pressed.get(timeout=left)
                except queue.Empty:
                    break
                if not typing.press(key):
                    return
                if typing.shown:
                    break


class Keys:
    """The keys of a recorder's terminal. Behind `m` a note may be typed: Enter marks the
    moment of the `m` with it, Escape does not."""

    def __init__(self, recorder: Recorder, news: MutableSequence[str]) -> None:
        self._recorder = recorder
        self._news = news
        self._note: str | None = None  # while one is typed
        self._began = 0.0

    @property
    def shown(self) -> list[str]:
        """Return the line for what is being typed."""
        return [] if self._note is None else [f"note, then Enter: {self._note}_"]

    def press(self, key: str) -> bool:
        """Do what a key stands for; return whether to go on."""
        note = self._note
        if key in ("\x03", "\x04"):
            return False
        if note is None:
            if key != "m":
                return press(self._recorder, key, self._news)
            self._note, self._began = "", time.monotonic()
        elif key in "\r\n":
            ago = time.monotonic() - self._began
            self._recorder.mark(note, ago)
            at = time.strftime("%H:%M:%S", time.localtime(time.time() - ago))
            self._news.append(f"marked at {at}" + (f": {note}" if note else ""))
            self._note = None
        elif key == "\x1b":
            self._note = None
        elif key in "\x7f\b":
            self._note = note[:-1]
        elif key.isprintable():
            self._note = note + key
        return True


def press(recorder: Recorder, key: str, news: MutableSequence[str]) -> bool:
    """Do what a key stands for that is no note's; return whether to go on."""
    if key == "q":
        return False
    if key == " ":
        if recorder.paused:
            recorder.resume()
        else:
            recorder.pause()
    elif key == "s":
        if recorder.snapshots:
            recorder.snapshot("a key")
            news.append("a snapshot")
        else:
            recorder.split()
            news.append("a new file")
    return True
