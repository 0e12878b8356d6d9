"""Completion by Tab at a shell: verbs, options, the names of live ports, carriers, files.

Rules: shells ask `yarpy completion --line TEXT`, where TEXT is what stands before the cursor, and
get a line for each candidate, `value<Tab>what it is`; `FILES` alone has the shell offer files. A
parameter is known by its name, the same in all verbs. A name server that does not answer within a
second offers no ports, and a name that a shell would not take as one word is never offered.
"""

from __future__ import annotations

import re
import shlex
import threading
from collections.abc import Iterable, Iterator
from typing import Final, NamedTuple

import click

from yarpy.cli.verb_list import VERBS

FILES: Final = "//files"
TIMEOUT: Final = 1.0  # seconds that a person waits after pressing Tab

PORTS: Final = frozenset(
    {"port", "ports", "source", "sources", "target", "remotes", "words", "in_port", "outs", "robot"}
)
CARRIERS: Final = frozenset({"carrier", "protocol"})
PATHS: Final = frozenset({"path", "portdb", "subdb", "web", "mujoco", "configuration"})
VERB: Final = "verb"


_ONE_WORD: Final = re.compile(r"/[\w./:+@%~=-]*+")


class Candidate(NamedTuple):
    """A word that may stand here, and what it is."""

    value: str
    about: str = ""


def complete(line: str) -> list[Candidate]:
    """The candidates for the last word of `line`, the command line up to the cursor."""
    words = split(line)[1:]
    before, word = words[:-1], words[-1] if words else ""
    context, waiting = _walk(before)
    found: Iterable[Candidate]
    if waiting is not None:
        found = _values(waiting, word)
    elif word.startswith("-"):
        found = _options(context)
    elif isinstance(context.command, click.Group):
        found = () if context.args else _verbs(context)
    elif context.info_name == "name" and not context.args:
        from yarpy.cli.verbs.name import COMMANDS

        found = map(Candidate, COMMANDS)
    else:
        found = _values(parameter, word) if (parameter := _next_argument(context)) else ()
    return [each for each in found if each.value.startswith(word) or each.value == FILES]


def split(line: str) -> list[str]:
    """The words of a command line that is still being typed; the last is the one at the cursor."""
    lexer = shlex.shlex(line, posix=True, punctuation_chars=False)
    lexer.whitespace_split = True
    lexer.commenters = ""
    words: list[str] = []
    try:
        words.extend(lexer)
    except ValueError:  # an open quotation mark: what it has so far is the word
        words.append(lexer.token)
        return words
    if not line or line[-1].isspace():
        words.append("")
    return words


def _walk(words: list[str]) -> tuple[click.Context, click.Parameter | None]:
    """The verb that is typed, with the arguments it has; and the option that wants a value."""
    from yarpy.cli.main import root

    context = click.Context(root, info_name="yarpy", resilient_parsing=True)
    context.args = []
    waiting: click.Parameter | None = None
    for word in words:
        if waiting is not None:
            waiting = None
        elif word.startswith("-") and len(word) > 1:
            waiting = _option_with_value(context, word)
        elif isinstance(context.command, click.Group) and (
            inner := context.command.get_command(context, word)
        ):
            context = click.Context(inner, parent=context, info_name=word, resilient_parsing=True)
            context.args = []
        else:
            context.args.append(word)
    return context, waiting


def _option_with_value(context: click.Context, word: str) -> click.Parameter | None:
    if "=" in word:
        return None
    for parameter in context.command.params:
        if isinstance(parameter, click.Option) and word in parameter.opts:
            return None if parameter.is_flag or parameter.flag_value is True else parameter
    return None


def _next_argument(context: click.Context) -> click.Parameter | None:
    """The argument that the next word is for."""
    left = len(context.args)
    for parameter in context.command.params:
        if isinstance(parameter, click.Argument):
            if parameter.nargs < 0 or left < parameter.nargs:
                return parameter
            left -= parameter.nargs
    return None


def _options(context: click.Context) -> Iterator[Candidate]:
    for parameter in context.command.get_params(context):
        if isinstance(parameter, click.Option) and not parameter.hidden:
            yield Candidate(max(parameter.opts, key=len), parameter.help or "")


def _verbs(context: click.Context) -> Iterator[Candidate]:
    """Verbs without loading them, where their table is known."""
    from yarpy.cli.main import root

    group = context.command
    assert isinstance(group, click.Group)
    for name in group.list_commands(context):
        if group is root:
            yield Candidate(name, VERBS[name].about if name in VERBS else "")
        else:
            inner = group.get_command(context, name)
            yield Candidate(name, inner.get_short_help_str() if inner is not None else "")


def _values(parameter: click.Parameter, word: str) -> Iterator[Candidate]:
    """Yield the values that an argument, or an option, may have."""
    name = parameter.name or ""
    if isinstance(parameter.type, click.Choice):
        yield from (Candidate(str(choice)) for choice in parameter.type.choices)
    elif isinstance(parameter.type, click.Path) or name in PATHS:
        yield Candidate(FILES)
    elif name in CARRIERS:
        from yarpy.registry import carriers

        yield from (Candidate(carrier, "carrier") for carrier in carriers.offered())
    elif name == VERB:
        yield from (Candidate(name, verb.about) for name, verb in VERBS.items())
    elif name in PORTS or (name == "name" and isinstance(parameter, click.Argument)):
        yield from _ports(word)


def _ports(word: str) -> list[Candidate]:
    """The names that the name service knows, with the carrier before them that `word` has."""
    found: list[Candidate] = []
    carrier, separator, _ = word.partition("://")
    prefix = f"{carrier}:/" if separator else ""

    def ask() -> None:
        from yarpy.errors import YarpError
        from yarpy.names.default import DEFAULT

        try:
            contacts = DEFAULT.current().list()
        except (YarpError, OSError):
            return
        found.extend(
            Candidate(prefix + contact.name, f"{contact.carrier} at {contact.address}")
            for contact in contacts
            if _ONE_WORD.fullmatch(contact.name)
        )

    asking = threading.Thread(target=ask, name="yarpy completion", daemon=True)
    asking.start()
    asking.join(TIMEOUT)
    return list(found)
