"""`yarpy check FILE...`: say what in files of applications and robots is ignored or misspelt.

    yarpy check demo.toml robot.xml        applications, and robots of yarprobotinterface
    yarpy check --offline *.xml            without asking the name server

Each problem is one line, `file:line:column: warning: text`, as compilers say it. What a file is,
its root tells. Nothing is started or opened. Devices that a robot needs and that are not here are
no errors: it may be for another computer.

Exit codes: 0 all can run; 1 one of them cannot.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from yarpy.cli.output import print_line

if TYPE_CHECKING:
    from yarpy.kits.launch.document.problem import Problem

FEW: Final = 3  # devices that are not here, and each have a line
SHOWN: Final = 6  # ... whose names one line tells

Checked = tuple[list["Problem"], str]  # what is odd, and a summary


@click.command()
@click.argument("files", type=click.Path(path_type=Path), nargs=-1, required=True)
@click.option("--offline", is_flag=True, help="Do not ask the name server for hosts and ports.")
def command(files: tuple[Path, ...], offline: bool) -> int:
    """Say what in FILES does not do what it seems to."""
    wrong = False
    for file in files:
        problems, summary = _checked(file, offline)
        for problem in in_order(problems):
            print_line(str(problem))
        many = len(problems)
        print_line(f"{summary}, {many or 'no'} problem{'' if many == 1 else 's'}")
        wrong = wrong or any(problem.fatal for problem in problems)
    return 1 if wrong else 0


def in_order(problems: Sequence[Problem]) -> list[Problem]:
    """Return problems as one reads: file by file, from the top."""
    files = [*dict.fromkeys(one.where.file for one in problems)]
    return sorted(
        problems, key=lambda one: (files.index(one.where.file), one.where.line, one.where.column)
    )


def _checked(file: Path, offline: bool) -> Checked:
    from yarpy.errors import DecodeError
    from yarpy.kits.launch.document.element import BadFile
    from yarpy.kits.launch.document.problem import Problem, Where

    try:
        if file.suffix.lower() != ".toml" and _is_robot(file):
            return _robot(file)
        return _application(file, offline)
    except BadFile as error:
        return [Problem(error.where, error.text, fatal=True)], str(file)
    except DecodeError as error:
        text = str(error).removeprefix(f"{file}: ")
        return [Problem(Where(str(file)), text, fatal=True)], str(file)


def _is_robot(file: Path) -> bool:
    from yarpy.kits.launch.application.load import content
    from yarpy.kits.launch.document.element import parse

    return parse(content(file), str(file)).tag.lower() == "robot"


def _robot(file: Path) -> Checked:
    from yarpy.kits.launch.robot.checking import unknown_types
    from yarpy.kits.launch.robot.robot_file import load

    found = load(file)
    absent = [one for one in found.missing() if one in found.problems]
    problems = [one for one in found.problems if one not in absent]
    problems += [*folded(absent, "devices that others hand in, as a simulator does")]
    problems += [*folded([*unknown_types(found)], "devices that this computer cannot open")]
    return problems, found.summary


def folded(problems: Sequence[Problem], what: str) -> Iterator[Problem]:
    """Yield problems that a file need not have here: one by one where there is advice, or they are
    few; else one line for all of them."""
    from yarpy.kits.launch.document.problem import Problem

    telling = [one for one in problems if len(problems) <= FEW or "did you mean" in one.text]
    yield from (replace(one, fatal=False) for one in telling)
    rest = [one for one in problems if one not in telling]
    if rest:
        named = [*dict.fromkeys(one.text.rpartition('"')[0].rpartition('"')[2] for one in rest)]
        more = f" and {len(named) - SHOWN} more" if len(named) > SHOWN else ""
        yield Problem(rest[0].where, f"{len(named)} {what}: {', '.join(named[:SHOWN])}{more}")


def _application(file: Path, offline: bool) -> Checked:
    from yarpy.kits.launch.application import checking
    from yarpy.kits.launch.application.load import load

    found = load(file)
    later = checking.here(found) if offline else checking.checked(found)
    return [*found.problems, *later], found.summary
