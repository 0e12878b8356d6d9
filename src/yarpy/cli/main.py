"""`yarpy VERB ...`: finds the verb, runs it, and turns errors into one line and an exit code.

Rules: a verb is a module of `verbs` that has a click command called `command`, and a line in
`verb_list`; it is imported when it is used, so that `yarpy --help` and small verbs start fast.
Packages add verbs by the entry point group `yarpy.commands`. What a command returns is the exit
code, None is 0. Standard output belongs to the verb; errors go to standard error as `error: ...`.

Exit codes: 0 done; 1 not done, or used wrongly; 255 no such verb; 128 + N ended by signal N.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Sequence
from typing import Any, Final, NoReturn

import click

from yarpy.cli import signals
from yarpy.cli.stderr import complain, complain_of
from yarpy.cli.verb_list import GROUPS, VERBS
from yarpy.errors import UnknownPlugin, YarpError
from yarpy.platform.console import is_unread

ALIASES: Final = {"priority-qos": "qos", "priority-sched": "sched"}  # the spellings of C++
NO_SUCH_VERB: Final = 255


class _NoSuchVerb(click.UsageError):
    exit_code = NO_SUCH_VERB


class Verbs(click.Group):
    """The verbs of `VERBS` and of installed packages, loaded when they are asked for."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        from yarpy.registry import commands

        return sorted({*VERBS, *commands.names()})

    def get_command(self, ctx: click.Context, name: str) -> click.Command | None:
        return find_verb(name)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        command = find_verb(args[0])
        if command is None:
            raise _NoSuchVerb(_advice(args[0], self.list_commands(ctx)), ctx)
        return args[0], command, args[1:]

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """The groups of verbs, from the table: loading them all would take a second."""
        groups = {
            title: [(name, verb.about) for name, verb in group.items()]
            for title, group in GROUPS.items()
        }
        foreign = [name for name in self.list_commands(ctx) if name not in VERBS]
        groups["Of installed packages"] = [(name, "") for name in foreign]
        wide = max(len(name) for rows in groups.values() for name, _ in rows)
        for title, rows in groups.items():
            if rows:
                with formatter.section(title):
                    formatter.write_dl([(name.ljust(wide), about) for name, about in rows])


def find_verb(name: str) -> click.Command | None:
    """The command called `name`, or None. Raises UnknownPlugin for one that does not load."""
    from importlib import import_module

    from yarpy.registry import commands

    name = ALIASES.get(name, name)
    if name in VERBS and commands.row(name) is None:
        command: Any = import_module(f"yarpy.cli.verbs.{name}").command
    elif name in commands.names():
        command = commands.load(name)
    else:
        return None
    if not isinstance(command, click.Command):
        raise UnknownPlugin(
            f'the command "{name}" is installed, but is not a click command '
            "(its entry point in the group yarpy.commands must name one)"
        )
    if name in VERBS:
        command.epilog = f"Example: yarpy {VERBS[name].example}"
    return command


def _advice(name: str, known: Sequence[str]) -> str:
    return f'no command "{name}": {_near(name, known)}`yarpy help` lists them'


def _near(name: str, known: Sequence[str]) -> str:
    from difflib import get_close_matches

    near = get_close_matches(name, known, n=1)
    return f'did you mean "{near[0]}"? ' if near else ""


_UNKNOWN = re.compile(r"No such command '(.*?)'\.", re.DOTALL)


def _told(error: click.UsageError) -> str:
    """Return what is wrong with a line; of a verb with commands of its own also which there are,
    since a port or a file in their place is what people try first."""
    text = error.format_message()
    ctx = error.ctx
    found = _UNKNOWN.match(text)
    if found is None or ctx is None or not isinstance(ctx.command, click.Group):
        return _plain(text)
    known = ctx.command.list_commands(ctx)
    have = f"{', '.join(known[:-1])} and {known[-1]}" if known[1:] else "".join(known) or "none"
    hint = _near(found[1], known)
    example = f". {ctx.command.epilog}" if ctx.command.epilog else ""
    return f'no command "{found[1]}" of {ctx.command_path}: {hint}there are {have}{example}'


@click.group(
    cls=Verbs,
    invoke_without_command=True,
    context_settings={
        "help_option_names": ["-h", "--help"],
        "max_content_width": 100,
        "show_default": True,
    },
)
@click.option("--version", is_flag=True, help="Print the version.")
@click.pass_context
def root(ctx: click.Context, version: bool) -> int:
    """Named ports and the tools around them, compatible with YARP.

    `yarpy COMMAND --help` explains a command.
    """
    if ctx.invoked_subcommand is None:
        from yarpy.cli.verbs.version import text

        click.echo(text() if version else ctx.get_help())
    return 0


def _plain(text: str) -> str:
    """Return what click says of a number in words for people who know no types."""
    text = re.sub(r"is not a valid integer( range)?", "is no whole number", text)
    text = re.sub(r"is not a valid float( range)?", "is no number", text)
    return re.sub(r"is not in the range (\S+)<=x<=(\S+?)\.$", r"is not from \1 to \2.", text)


def run(arguments: Sequence[str]) -> int:
    """Run `yarpy ARGUMENTS` in this process; the exit code."""
    try:
        code = root.main([*arguments], "yarpy", standalone_mode=False)
    except signals.Interrupted as signal:
        return 128 + signal.number
    except click.Abort:  # click's word for ^C and for the end of input at one of its prompts
        return 130
    except click.exceptions.NoArgsIsHelpError as error:  # of a verb with verbs of its own
        click.echo(error.format_message(), err=True)
        return 1
    except click.UsageError as error:
        complain(_told(error))
        if error.ctx is not None and error.exit_code != NO_SUCH_VERB:
            click.echo(error.ctx.get_usage(), err=True)
        return NO_SUCH_VERB if error.exit_code == NO_SUCH_VERB else 1
    except click.ClickException as error:
        complain(error.format_message())
        return 1
    except (YarpError, OSError) as error:
        if not (isinstance(error, OSError) and is_unread(error)):
            complain_of(error)
        return 1
    return code if isinstance(code, int) else 0


def main() -> NoReturn:
    """The program `yarpy`."""
    for stream in (sys.stdin, sys.stdout):
        # Port data is UTF-8 with whatever else a peer put there: bytes go through as they are.
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(encoding="utf-8", errors="surrogateescape")
    signals.watch()
    code = run(sys.argv[1:])
    try:
        if sys.stdout is not None:  # closed before we began
            sys.stdout.flush()
    except OSError as error:
        if not is_unread(error):
            raise
        sys.stdout = None  # nobody reads: no complaint at exit
        code = code or 1
    sys.exit(code)
