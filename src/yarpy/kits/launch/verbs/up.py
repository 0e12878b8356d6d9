"""`yarpy up FILE`: start an application, make its connections, and keep all of it running.

    yarpy up robot.toml                 yarpmanager's XML is read, too
    yarpy up robot.xml --check          say what in the file is ignored, misspelt or missing
    yarpy up robot.toml --page          show it in a browser, too
    yarpy up robot.toml -d              in the background, until `yarpy down`
    yarpy up robot.toml --server        with a name server of its own, if none answers
    yarpy up robot.toml --watch         start again what changes on the disk

On a terminal a table shows each program: its state, processors, memory and last line; elsewhere
each line of output is printed behind the program's name. ^C stops all in reverse order, a second
one at once. `yarpy status`, `logs`, `start`, `stop`, `restart` and `down` reach it from other
terminals; `yarpy status --page` opens its page.

Exit codes: 0 all ended well, or were stopped; 1 the file has errors, something failed, or would not
end.
"""

from __future__ import annotations

import functools
import shutil
import signal
import sys
import threading
import time
from collections.abc import Iterable
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import click

from yarpy.cli.output import print_line
from yarpy.cli.signals import Interrupted
from yarpy.cli.stderr import complain, warn

if TYPE_CHECKING:
    from yarpy.kits.launch.application.application import Application
    from yarpy.kits.launch.supervise.log_stream import LogStream
    from yarpy.kits.launch.supervise.supervisor import Supervisor

PERIOD: Final = 1.0  # seconds between looks
_UNKILLABLE: Final = "does not end, not even when it is killed"
_NEWS: Final = 100  # that are kept for the screen


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--check", is_flag=True, help="Start nothing: say what is odd in the file.")
@click.option("--restart", "policy", default="on-failure", metavar="WHEN",
              type=click.Choice(["no", "on-failure", "always"]),
              help="no, on-failure or always, for programs that say nothing.")  # fmt: skip
@click.option("--wait", "port_timeout", default=60.0, type=click.FloatRange(0), metavar="S",
              help="How long a program waits for a port.")  # fmt: skip
@click.option("--grace", default=5.0, type=click.FloatRange(0, min_open=True), metavar="S",
              help="How long a program may take to end before it is killed.")  # fmt: skip
@click.option(
    "--stop-on-failure", is_flag=True, help="Stop all as soon as one has failed for good."
)
@click.option("--replace", is_flag=True, help="End programs that a killed `yarpy up` has left.")
@click.option("-d", "--detach", "detached", is_flag=True,
              help="Run in the background: `yarpy down` ends it.")  # fmt: skip
@click.option("--idle", is_flag=True,
              help="Start nothing until `yarpy start`, or the page, does.")  # fmt: skip
@click.option("--log", is_flag=True, help="Show what programs print in `yarpy log`, too.")
@click.option("--watch", is_flag=True,
              help="Follow changes of the file, and of files of programs.")  # fmt: skip
@click.option("--server", is_flag=True,
              help="Bring a name server along, if none answers.")  # fmt: skip
@click.option("--page", is_flag=True, help="Show a page of it, which only you can see.")
@click.option("--lines", "as_lines", is_flag=True, help="Print lines, on a terminal too.")
def command(
    file: Path,
    check: bool,
    policy: str,
    port_timeout: float,
    grace: float,
    stop_on_failure: bool,
    replace: bool,
    detached: bool,
    idle: bool,
    log: bool,
    watch: bool,
    server: bool,
    page: bool,
    as_lines: bool,
) -> int:
    """Start the application of FILE and keep it running."""
    from yarpy.kits.launch.application.checking import checked
    from yarpy.kits.launch.application.load import load
    from yarpy.kits.launch.supervise.name_server import name_server

    application = load(file)
    if check:
        problems = [*application.problems, *checked(application)]
        for problem in problems:
            print_line(str(problem))
        many = len(problems)
        print_line(f"{application.summary}, {many or 'no'} problem{'' if many == 1 else 's'}")
        return 1 if any(problem.fatal for problem in problems) else 0
    for problem in application.problems:
        (complain if problem.fatal else warn)(f"{problem.where}: {problem.text}")
    if application.fatal:
        return 1
    options = _Options(
        policy,
        port_timeout,
        grace,
        stop_on_failure,
        replace,
        idle,
        log,
        watch,
        server,
        page,
        as_lines,
    )
    if detached:
        return _detach(application, file, options)
    with name_server(application, server) as told:
        return _run(application, file, options, told)


@dataclass(frozen=True, slots=True)
class _Options:
    """The options, as the command line gives them."""

    policy: str
    port_timeout: float
    grace: float
    stop_on_failure: bool
    replace: bool
    idle: bool
    log: bool
    watch: bool
    server: bool
    page: bool
    as_lines: bool

    def words(self) -> list[str]:
        """Return the options that say the same, but for what only a terminal has."""
        flags = ("stop_on_failure", "replace", "idle", "log", "watch", "server")
        return [
            *(
                "--restart",
                self.policy,
                "--wait",
                f"{self.port_timeout:g}",
                "--grace",
                f"{self.grace:g}",
            ),
            *(f"--{name.replace('_', '-')}" for name in flags if getattr(self, name)),
        ]


def _detach(application: Application, file: Path, options: _Options) -> int:
    from yarpy.cli.browser import open_page
    from yarpy.kits.launch.console import control
    from yarpy.kits.launch.console.detach import detach

    name = application.name
    path = detach(name, [str(file), *options.words()])
    print_line(f"{name} runs in the background: `yarpy status {name}`, `yarpy down {name}`")
    print_line(
        f"what it says is in {path}, and what its programs print in `yarpy logs --of {name}`"
    )
    if options.page:
        url = control.ask(name, do="page")["url"]
        print_line(f"{name} is shown at {url}")
        open_page(url)
    return 0


def _run(application: Application, file: Path, options: _Options, told: str) -> int:
    from yarpy.kits.launch.application.load import load
    from yarpy.kits.launch.console.control import Control, Record
    from yarpy.kits.launch.console.service import answer
    from yarpy.kits.launch.page.serving import Serving
    from yarpy.kits.launch.supervise.leftover import end_all
    from yarpy.kits.launch.supervise.leftover import told as named
    from yarpy.kits.launch.supervise.log_stream import LogStream
    from yarpy.kits.launch.supervise.remote import RemoteRunner
    from yarpy.kits.launch.supervise.supervisor import Supervisor
    from yarpy.kits.launch.supervise.watch import Watch

    live = sys.stdout.isatty() and not options.as_lines
    stream = LogStream(application) if options.log else None
    printer = _Printer(live, stream)

    remote, servers = ExitStack(), list[RemoteRunner]()

    @functools.cache
    def runners(node: str) -> RemoteRunner:
        runner = RemoteRunner(node, application.name, grace=options.grace, replace=options.replace)
        servers.append(runner)
        return remote.enter_context(runner)

    supervisor = Supervisor(
        application,
        runners=runners,
        usual=options.policy,
        port_timeout=options.port_timeout,
        grace=options.grace,
        news=printer.news,
        said=printer.line,
    )
    record = Record(application.name)
    found = record.left()
    if found and not options.replace:
        record.leave()
        complain(
            "programs of an earlier `yarpy up`, which was killed, are still there: "
            f"{named(found)}; `yarpy down {application.name}` ends them, and so does --replace"
        )
        return 1
    end_all(found, options.grace)

    def note() -> None:
        units = supervisor.units
        record.write(supervisor.local.run, [*units], _away(supervisor, units))

    note()
    serving = Serving(supervisor)

    def told_of(asked: dict[str, Any]) -> dict[str, Any]:
        return {"url": serving.url()} if asked.get("do") == "page" else answer(supervisor, asked)

    control = Control(application.name, told_of)
    watch = Watch(supervisor, lambda: load(file), printer.news, note) if options.watch else None
    left: list[str] = []
    all_over = False
    why = ""
    if told:
        printer.news("", told)
    try:
        try:
            if options.page:
                _show(serving.url(), printer)
            if options.idle:
                supervisor.rest()
            else:
                why = supervisor.start()
            if watch is not None:
                watch.start()
            if not why:
                _follow(supervisor, printer, live, options.stop_on_failure)
        except Interrupted:
            pass
        finally:  # whatever has gone wrong
            _at_once(supervisor)
            if watch is not None:
                watch.close()
            left = supervisor.stop()
            all_over = True
    finally:
        control.close()
        serving.close()
        doubtful = {tag: one.server for one in servers for tag in one.doubtful}
        remote.close()
        if stream is not None:
            stream.close()
        away = _away(supervisor, left if all_over else supervisor.units)
        record.close({**doubtful, **away})
    for text in [why, *supervisor.failed] if why else supervisor.failed:
        complain(text)
    again = f"; `yarpy down {application.name}` tries again"
    for label in left:
        handle = supervisor.units[label].handle
        lost = handle.detail if handle is not None else ""
        complain(f"{label} {f'may go on: {lost}{again}' if lost else _UNKILLABLE}")
    for tag in doubtful.keys() - away.keys():
        complain(f"{tag} may have been started at {doubtful[tag]}, which does not answer{again}")
    return 1 if why or left or doubtful or supervisor.failed else 0


def _away(supervisor: Supervisor, labels: Iterable[str]) -> dict[str, str]:
    """Return the tags of those programs that are at servers, each with its server."""
    from yarpy.kits.launch.supervise.remote import tag_of

    name = supervisor.application.name
    modules = [supervisor.units[label].module for label in labels]
    return {tag_of(name, one.label): one.node for one in modules if one.node}


def _show(url: str, printer: _Printer) -> None:
    """Say where the page is, and open it where there is a display."""
    from yarpy.cli.browser import open_page

    printer.page = url
    printer.news("", f"shown at {url}")
    open_page(url)


def _at_once(supervisor: Supervisor) -> None:
    """Let another signal kill what still runs, instead of this process alone. A hangup does not:
    the end of a terminal sends several."""

    def kill(number: int, frame: object) -> None:
        threading.Thread(target=supervisor.kill, name="yarpy kill", daemon=True).start()

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, kill)
    if hasattr(signal, "SIGHUP"):
        signal.signal(signal.SIGHUP, lambda number, frame: None)  # programs would inherit SIG_IGN


def _follow(supervisor: Supervisor, printer: _Printer, live: bool, stop_on_failure: bool) -> None:
    """Show the programs until all have ended, or somebody wants it to end; a screen that is gone is
    somebody, too."""

    def over() -> bool:
        failed = stop_on_failure and bool(supervisor.failed)
        return failed or supervisor.over.wait(PERIOD if not stop_on_failure else 0.2)

    if not live:
        while not over():
            pass
        return
    from rich.console import Console
    from rich.live import Live

    from yarpy.kits.launch.console.look import KEYS, text

    console = Console(highlight=False)
    with suppress(OSError), Live(console=console, auto_refresh=False, screen=True) as screen:
        while True:
            size = shutil.get_terminal_size((80, 24))
            keys = f"{KEYS}; {printer.page}" if printer.page else KEYS
            shown = text(supervisor.status(), printer.told, size.columns, size.lines, keys)
            screen.update(shown, refresh=True)
            if over():
                return


class _Printer:
    """Lines of programs and news of them, printed whole; for the screen only kept."""

    def __init__(self, live: bool, stream: LogStream | None = None) -> None:
        self.told: list[str] = []
        self.page = ""
        """The address of the page, if it was asked for."""
        self._live = live
        self._stream = stream
        self._lock = threading.Lock()

    def news(self, label: str, text: str) -> None:
        whole = f"{label} {text}" if label else text
        if self._live:
            self.told = [*self.told[-_NEWS:], f"{time.strftime('%H:%M:%S')} {whole}"]
        else:
            self._print(f"* {whole}")

    def line(self, label: str, line: str) -> None:
        if self._stream is not None:
            self._stream.hear(label, line)
        if not self._live:
            self._print(f"{label} | {line}")

    def _print(self, line: str) -> None:
        with self._lock:
            try:
                print_line(line)
            except OSError:
                pass  # nobody reads any more; the programs go on
