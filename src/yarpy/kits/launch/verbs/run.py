"""`yarpy run`: start programs through a server, here or on other computers; C++ yarprun's options.

    run --server /nodeA                            be the server of this computer
    run --on /nodeA --as cam -- yarpdev --device fakeFrameGrabber
    run --on /nodeA --as cam --cmd "yarpdev ..."   the same, as yarprun has it
    run --on /nodeA --ps                           what runs there
    run --on /nodeA --sigterm cam                  end it; --kill cam 9 makes it
    run --on /nodeA --as sh --stdio -- bash        start it, and talk to it here

A server starts programs for its own user on this computer alone, unless it is told more: --allow
PROGRAM, and in access.toml the right `run` for peers with a certificate. Programs go on when their
server ends, and the next one of that name finds them again; with --end-programs they end with it.

Exit codes: 0 done, running; 2 the server says no, or not running; 1 no answer, or used wrongly.
"""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING, Final

import click

from yarpy.cli import log as shown_log
from yarpy.cli.output import print_json, print_line
from yarpy.cli.signals import Interrupted
from yarpy.cli.stderr import complain
from yarpy.errors import AccessRefused, RemoteError
from yarpy.kits.launch.run import terminal
from yarpy.log import logger
from yarpy.port.keep.log_sender import LOGGER
from yarpy.scope import Waiter

if TYPE_CHECKING:
    from yarpy.kits.launch.run.client import RunClient

NO: Final = 2  # exit code: the server says no
HERE: Final = "."  # the terminal of this command

log = logger("yarpy.run")


@click.command(context_settings={"ignore_unknown_options": False})
@click.argument("words", nargs=-1, metavar="[-- WORD]")
@click.option("--server", metavar="NAME", help="Be the server of that name.")
@click.option("--allow", multiple=True, metavar="PROGRAM",
              help="Start this one and no others, for everybody who may (server).")  # fmt: skip
@click.option("--allow-env", multiple=True, metavar="NAME",
              help="... with this variable in its environment (server).")  # fmt: skip
@click.option("--end-programs", is_flag=True, help="End programs with their server (server).")
@click.option("--on", metavar="NAME", help="Ask the server of that name.")
@click.option("--as", "tag", metavar="TAG", help="Call the program so, else by its file.")
@click.option("--cmd", metavar="COMMAND", help="Start this.")
@click.option("--workdir", metavar="FOLDER", help="... in that folder over there.")
@click.option("--env", metavar="A=B;C=D", help="... with these variables.")
@click.option("--log", "logger_", is_flag=False, flag_value=LOGGER, metavar="[LOGGER]",
              help="Send what programs say to a logger.")  # fmt: skip
@click.option("--stdio", is_flag=False, flag_value=HERE, metavar="[SERVER]",
              help="Give it a terminal: this one, or that of a server of C++.")  # fmt: skip
@click.option("--attach", "--readwrite", "uuid", metavar="UUID",
              help="Be the terminal of a program that was started with --stdio.")  # fmt: skip
@click.option("--ps", is_flag=True, help="List what runs.")
@click.option("--isrunning", metavar="TAG", help="Tell whether it runs.")
@click.option("--output", metavar="TAG", help="Show what it said last.")
@click.option("--sigterm", metavar="TAG", help="Ask it to end.")
@click.option("--sigtermall", is_flag=True, help="Ask all to end.")
@click.option("--kill", nargs=2, type=(str, int), metavar="TAG SIGNAL", help="Send it a signal.")
@click.option("--which", metavar="FILE", help="Tell where a program is over there.")
@click.option("--exit", "exit_", is_flag=True, help="Ask the server to end.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON (--ps).")
def command(
    words: tuple[str, ...],
    server: str | None,
    allow: tuple[str, ...],
    allow_env: tuple[str, ...],
    end_programs: bool,
    on: str | None,
    tag: str | None,
    cmd: str | None,
    workdir: str | None,
    env: str | None,
    logger_: str | None,
    stdio: str | None,
    uuid: str | None,
    ps: bool,
    isrunning: str | None,
    output: str | None,
    sigterm: str | None,
    sigtermall: bool,
    kill: tuple[str, int] | None,
    which: str | None,
    exit_: bool,
    as_json: bool,
) -> int:
    """Start programs here or on other computers, or be the server that does."""
    if server:
        return serve(server, allow, allow_env, end_programs, logger_ or "")
    if uuid is not None:
        return terminal.attach(uuid)
    if not on:
        raise click.UsageError("say which server: --on /NAME, or be one: --server /NAME")
    from yarpy.kits.launch.run.client import RunClient

    try:
        with RunClient(on) as node:
            if cmd is not None or words:
                started = node.start(
                    tag or "",
                    cmd if cmd is not None else words,
                    workdir=workdir or "",
                    environment=env or "",
                    log=None if logger_ is None else logger_,
                    stdio=(on if stdio == HERE else stdio) or "",
                )
                print_line(started.text)
                if stdio == HERE and started.uuid:
                    return terminal.attach(started.uuid)
                return 0
            if kill is not None:
                return _done(node.signal(*kill), f"nothing runs as {kill[0]}")
            if sigterm is not None:
                return _done(node.signal(sigterm, 15), f"nothing runs as {sigterm}")
            if isrunning is not None:
                runs = node.is_running(isrunning)
                print_line("running" if runs else "not running")
                return 0 if runs else NO
            return _ask(node, ps, output, sigtermall, which, exit_, as_json)
    except (RemoteError, AccessRefused) as error:
        complain(str(error))
        return NO


def _ask(
    node: RunClient,
    ps: bool,
    output: str | None,
    sigtermall: bool,
    which: str | None,
    exit_: bool,
    as_json: bool,
) -> int:
    if ps:
        for one in node.running():
            if as_json:
                keys = {"pid": one.pid, "tag": one.tag, "cmd": one.command}
                print_json(keys | {"env": one.environment})
            else:
                print_line(f"{one.pid:>8}  {one.tag:<20} {one.command}")
    elif output is not None:
        for line in node.output(output):
            print_line(line)
    elif sigtermall:
        node.end_all()
    elif which is not None:
        print_line(node.which(which))
    elif exit_:
        node.exit()
    else:
        raise click.UsageError("say what: -- PROGRAM, --ps, --sigterm TAG, --output TAG ...")
    return 0


def _done(done: bool, why: str) -> int:
    if not done:
        complain(why)
    return 0 if done else NO


def serve(
    name: str, allow: tuple[str, ...], allow_env: tuple[str, ...], ends: bool, log_to: str
) -> int:
    """Start programs until a signal comes, or somebody says exit."""
    from yarpy.config import access_file
    from yarpy.kits.launch.run.allowed import Allowed
    from yarpy.kits.launch.run.permission import audience
    from yarpy.kits.launch.run.server import RunServer
    from yarpy.link.begin.admission import RUN
    from yarpy.transports.bind import SETTING

    allowed = Allowed(allow, allow_env)
    rules = access_file.current()
    others = rules is not None and any(RUN in rule.may for rule in rules.rules)
    if not (allowed and others):
        os.environ.setdefault(SETTING, "local")  # nobody else may: then nobody else need reach it
    shown_log.show()
    over = Waiter()
    server = RunServer(name, allowed=allowed, log=log_to, ends=ends, on_exit=over.wake)
    whom = audience(bool(allowed) and others)
    what = ", ".join(" ".join(entry) for entry in allowed.entries) or "programs"
    log.info("%s starts %s for %s", name, what, whom)
    try:
        over.wait()
    except Interrupted:
        pass
    finally:
        left = server.close()
        for one in left:
            log.info("%s goes on as process %d", one.entry.tag, one.entry.pid)
        if left:
            log.info("`yarpy run --server %s` finds them again", name)
    sys.stderr.flush()
    return 0
