"""fields: a language for types, in which a line is a field. The file pose.fields

    x float
    y float
    label str

is read by `Pose = yarpy.idl.load("pose.fields")`, and by `yarpy idl fields pose.fields`.
"""

import os
from dataclasses import fields, make_dataclass
from pathlib import Path

import click

from yarpy.errors import DecodeError

TYPES = {"int": int, "float": float, "str": str, "bool": bool, "bytes": bytes}


def load(what: str | os.PathLike[str]) -> type:
    """The class of a file: a dataclass, which ports send and `message.as_` reads."""
    path = Path(what)
    found = []
    for number, line in enumerate(path.read_text("utf-8").splitlines(), 1):
        words = line.split()
        if not words:
            continue
        if len(words) != 2 or not words[0].isidentifier() or words[1] not in TYPES:
            known = ", ".join(TYPES)
            raise DecodeError(f"{path}:{number}: a field is NAME TYPE, with a type of {known}")
        found.append((words[0], TYPES[words[1]]))
    return make_dataclass(path.stem.capitalize(), found)


@click.command()
@click.argument("path", type=click.Path(exists=True))
def command(path: str) -> int:
    """Show the fields of the type in PATH."""
    for field in fields(load(path)):
        click.echo(f"{field.name}: {field.type.__name__}")
    return 0
