"""The words of a command, and of the environment that goes with it, as yarprun takes them.

    "yarpdev --name \\"/my cam\\""       yarpdev, --name, /my cam
    "FOO=bar;BAZ=qux"                 FOO is bar, BAZ is qux

Rules: pure. Blanks divide words, double quotes keep them together, and nothing else has a meaning:
no shell ever sees a command.
"""

from __future__ import annotations

import shlex

from yarpy.errors import LocalProtocolError
from yarpy.limit import RUN_COMMAND


def words_of(command: str) -> list[str]:
    """Return the words of a command. Raises LocalProtocolError for one that is none."""
    if len(command) > RUN_COMMAND:
        raise LocalProtocolError(
            f"the command has {len(command)} characters, more than {RUN_COMMAND}: put its "
            "parameters into a file"
        )
    if "\0" in command:
        raise LocalProtocolError("the command has a character 0")
    lexer = shlex.shlex(command, posix=True, punctuation_chars=False)
    lexer.whitespace_split = True
    lexer.commenters = lexer.escape = ""
    lexer.quotes = lexer.escapedquotes = '"'
    try:
        words = list(lexer)
    except ValueError:
        raise LocalProtocolError(f"a quote of {command!r} has no end") from None
    if not words or not words[0]:
        raise LocalProtocolError("there is no command")
    return words


def joined(words: list[str]) -> str:
    """Return the command of these words. Raises LocalProtocolError for a word that has both a blank
    and a quote, which yarprun cannot write."""
    found = []
    for word in words:
        if '"' in word:
            raise LocalProtocolError(f"yarprun has no way to write {word!r}, which has a quote")
        found.append(f'"{word}"' if not word or any(c.isspace() for c in word) else word)
    return " ".join(found)


def variables_of(text: str) -> dict[str, str]:
    """Return the environment variables of `A=b;C=d`. Raises LocalProtocolError."""
    if len(text) > RUN_COMMAND or "\0" in text:
        raise LocalProtocolError("the environment is too long, or has a character 0")
    found = {}
    for part in text.split(";"):
        name, equals, value = part.partition("=")
        if not part.strip():
            continue
        if not equals or not name.strip():
            raise LocalProtocolError(f'"{part}" is no variable: write NAME=value;OTHER=value')
        found[name.strip()] = value
    return found
