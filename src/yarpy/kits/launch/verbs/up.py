"""`yarpy up FILE`: start an application, make its connections, and keep all of it running.

    yarpy up robot.toml                 yarpmanager's XML is read, too
    yarpy up robot.xml --check          say what in the file is ignored, misspelt or missing

On a terminal a table shows each program: its state, processors, memory and last line; elsewhere
each line of output is printed behind the program's name. ^C stops all in reverse order, a second
one at once. `yarpy status`, `logs`, `restart` and `down` reach it from other terminals.

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
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from yarpy.cli.output import print_line
from yarpy.cli.signals import Interrupted
from yarpy.cli.stderr import complain, warn

if TYPE_CHECKING:
    from yarpy.kits.launch.application.application import Application
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
@click.option("--wait", "patience", default=60.0, type=click.FloatRange(0), metavar="S",
              help="How long a program waits for a port.")  # fmt: skip
@click.option("--grace", default=5.0, type=click.FloatRange(0, min_open=True), metavar="S",
              help="How long a program may take to end before it is killed.")  # fmt: skip
@click.option(
    "--stop-on-failure", is_flag=True, help="Stop all as soon as one has failed for good."
)
@click.option("--replace", is_flag=True, help="End programs that a killed `yarpy up` has left.")
@click.option("--lines", "as_lines", is_flag=True, help="Print lines, on a terminal too.")
def command(
    file: Path,
    check: bool,
    policy: str,
    patience: float,
    grace: float,
    stop_on_failure: bool,
    replace: bool,
    as_lines: bool,
) -> int:
    """Start the application of FILE and keep it running."""
    from yarpy.kits.launch.application.checking import checked
    from yarpy.kits.launch.application.load import load

    application = load(file)
    if check:
        problems = [*application.problems, *checked(application)]
        for problem in problems:
            print_line(str(problem))
        many = len(problems)
        print_line(
            f"{application.name}: {len(application.modules)} programs, "
            f"{len(application.connections)} connections, "
            f"{many or 'no'} problem{'' if many == 1 else 's'}"
        )
        return 1 if any(problem.fatal for problem in problems) else 0
    for problem in application.problems:
        (complain if problem.fatal else warn)(f"{problem.where}: {problem.text}")
    if application.fatal:
        return 1
    if not application.modules and not application.connections:
        complain(f"{file}: there are no programs and no connections in it")
        return 1
    return _run(application, policy, patience, grace, stop_on_failure, replace, as_lines)


def _run(
    application: Application,
    policy: str,
    patience: float,
    grace: float,
    stop_on_failure: bool,
    replace: bool,
    as_lines: bool,
) -> int:
    from yarpy.kits.launch.console.control import Control, Record
    from yarpy.kits.launch.console.service import answer
    from yarpy.kits.launch.supervise.leftover import end_all, told
    from yarpy.kits.launch.supervise.remote import RemoteRunner
    from yarpy.kits.launch.supervise.supervisor import Supervisor

    live = sys.stdout.isatty() and not as_lines
    printer = _Printer(live)

    @functools.cache
    def runners(node: str) -> RemoteRunner:
        return RemoteRunner(node, application.name, grace=grace, replace=replace)

    supervisor = Supervisor(
        application,
        runners=runners,
        usual=policy,
        patience=patience,
        grace=grace,
        news=printer.news,
        said=printer.line,
    )
    record = Record(application.name)
    found = record.left()
    if found and not replace:
        complain(
            f"programs of an earlier `yarpy up`, which was killed, are still there: {told(found)}; "
            f"`yarpy down {application.name}` ends them, and so does --replace"
        )
        return 1
    end_all(found, grace)
    record.write(supervisor.local.run, [*supervisor.units])
    control = Control(application.name, lambda asked: answer(supervisor, asked))
    left: list[str] = []
    why = ""
    try:
        try:
            why = supervisor.start()
            if not why:
                _follow(supervisor, printer, live, stop_on_failure)
        except Interrupted:
            pass
        _at_once(supervisor)
        left = supervisor.stop()
    finally:
        control.close()
        record.close()
    for text in [why, *supervisor.failed] if why else supervisor.failed:
        complain(text)
    for label in left:
        handle = supervisor.units[label].handle
        lost = handle.detail if handle is not None else ""
        complain(f"{label} {f'may go on: {lost}' if lost else _UNKILLABLE}")
    return 1 if why or left or supervisor.failed else 0


def _at_once(supervisor: Supervisor) -> None:
    """Let another signal kill what still runs, instead of this process alone."""

    def kill(number: int, frame: object) -> None:
        threading.Thread(target=supervisor.kill, name="yarpy kill", daemon=True).start()

    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), kill)


def _follow(supervisor: Supervisor, printer: _Printer, live: bool, stop_on_failure: bool) -> None:
    """Until all has ended, or somebody wants it to."""

    def over() -> bool:
        failed = stop_on_failure and bool(supervisor.failed)
        return failed or supervisor.over.wait(PERIOD if not stop_on_failure else 0.2)

    if not live:
        while not over():
            pass
        return
    from rich.console import Console
    from rich.live import Live

    from yarpy.kits.launch.console.look import text

    console = Console(highlight=False)
    with Live(console=console, auto_refresh=False, screen=True) as screen:
        while True:
            size = shutil.get_terminal_size((80, 24))
            shown = text(supervisor.status(), printer.told, size.columns, size.lines)
            screen.update(shown, refresh=True)
            if over():
                return


class _Printer:
    """Lines of programs and news of them, printed whole; for the screen only kept."""

    def __init__(self, live: bool) -> None:
        self.told: list[str] = []
        self._live = live
        self._lock = threading.Lock()

    def news(self, label: str, text: str) -> None:
        whole = f"{label} {text}" if label else text
        if self._live:
            self.told = [*self.told[-_NEWS:], f"{time.strftime('%H:%M:%S')} {whole}"]
        else:
            self._print(f"* {whole}")

    def line(self, label: str, line: str) -> None:
        if not self._live:
            self._print(f"{label} | {line}")

    def _print(self, line: str) -> None:
        with self._lock:
            try:
                print_line(line)
            except OSError:
                pass  # nobody reads any more; the programs go on
