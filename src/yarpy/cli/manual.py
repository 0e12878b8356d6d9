"""The manual page yarpy(1), made of what `yarpy help` says.

Rules: nothing is written here that a verb says itself. `docs/yarpy.1` is the result, which a test
compares; `yarpy help --man > docs/yarpy.1` makes it anew.
"""

from __future__ import annotations

import inspect
from collections.abc import Iterator

import click

from yarpy import __version__
from yarpy.cli.verb_list import GROUPS, Verb

WIDTH = 72  # of what is kept as it is typed


def manual(root: click.Group) -> str:
    """The page, in the language of man(7)."""
    return "\n".join(_page(root)) + "\n"


def _page(root: click.Group) -> Iterator[str]:
    top = click.Context(
        root, info_name="yarpy", max_content_width=WIDTH, terminal_width=WIDTH, show_default=True
    )
    yield '.\\" Made by `yarpy help --man`.'
    yield f'.TH YARPY 1 "" "yarpy {__version__}" "YARP in Python"'
    yield ".SH NAME"
    yield "yarpy \\- named ports and the tools around them, compatible with YARP"
    yield ".SH SYNOPSIS"
    yield ".B yarpy"
    yield "COMMAND [ARGUMENTS]..."
    yield ".SH DESCRIPTION"
    yield _text(
        "yarpy speaks to ports and name servers, of yarpy and of C++ YARP. Standard output is what "
        "a command is about; errors are one line on standard error."
    )
    for title, verbs in GROUPS.items():
        yield f".SH {_text(title).upper()}"
        for name, verb in verbs.items():
            command = root.get_command(top, name)
            assert command is not None
            yield from _verb(click.Context(command, parent=top, info_name=name), verb)
    yield ".SH EXIT STATUS"
    yield _text(
        "0: done, yes, found. 1: not done, no, not found, or used wrongly. 255: no such command. "
        "128 + N: ended by signal N, with its ports closed and its names given back."
    )
    yield ".SH ENVIRONMENT"
    for variable, meaning in ENVIRONMENT.items():
        yield ".TP"
        yield f".B {_text(variable)}"
        yield _text(meaning)
    yield ".SH FILES"
    yield ".TP"
    yield ".I ~/.config/yarp/yarp.conf"
    yield "the address of the name server, also of C++ YARP; YARP_CONFIG_HOME moves it"
    yield ".SH SEE ALSO"
    yield _text("`yarpy help COMMAND`, and the pages in docs/ of the project.")


ENVIRONMENT = {
    "YARPY_SERVER": "HOST:PORT of the name server, before any file.",
    "YARP_CONFIG_HOME, YARP_DATA_HOME": "Folders of configuration files and of data.",
    "YARP_QUIET, YARP_VERBOSE": "Log only warnings; log everything.",
    "YARP_COLORED_OUTPUT": "Whether there are colours.",
    "YARP_PORT_RANGE": "The default port of name servers, and of the search for them.",
}


def _verb(context: click.Context, verb: Verb) -> Iterator[str]:
    command = context.command
    yield f".SS {_text(str(context.info_name))}"
    usage = " ".join(command.collect_usage_pieces(context))
    yield f".B {_text(context.command_path)} {_text(usage)}"
    yield ".PP"
    yield _text(inspect.cleandoc(command.help or verb.about))
    if isinstance(command, click.Group):
        for name in command.list_commands(context):
            inner = command.get_command(context, name)
            if inner is not None:
                yield from _entry(f"{name} ...", inner.get_short_help_str(200))
    for parameter in command.get_params(context):
        record = parameter.get_help_record(context)
        if record is not None and record[1] and "--help" not in parameter.opts:
            yield from _entry(*record)
    yield ".PP"
    yield "Example:"
    yield ".PP"
    yield ".EX"
    yield f"    yarpy {_text(verb.example)}"
    yield ".EE"


def _entry(term: str, meaning: str) -> Iterator[str]:
    yield ".TP"
    yield f".B {_text(term)}"
    yield _text(meaning)


def _text(text: str) -> str:
    """`text` with nothing in it that troff takes for a request."""
    escaped = text.replace("\\", "\\e").replace("-", "\\-")
    return "\n".join(
        f"\\&{line}" if line[:1] in (".", "'") else line for line in escaped.splitlines() if line
    )
