"""`yarpy info FILE...`: what is in a recording: when, which ports, how many messages, what is lost.

Exit codes: 0; 1 it cannot be read, or some of it is damaged.
"""

from __future__ import annotations

from dataclasses import asdict

import click

from yarpy.cli.output import print_json, print_line


@click.command()
@click.argument("files", nargs=-1, required=True, metavar="FILE...")
@click.option("--check", is_flag=True, help="Read all of it: find what is damaged, and silences.")
@click.option("--json", "as_json", is_flag=True, help="Print a JSON object.")
def command(files: tuple[str, ...], check: bool, as_json: bool) -> int:
    """Say what is in a recording. Several FILEs are taken as one."""
    from yarpy.kits.record.recording import open_recording
    from yarpy.kits.record.report import lines, report

    with open_recording(*files) as recording:
        found = report(recording, check)
    if as_json:
        print_json(asdict(found))
    else:
        for line in lines(found):
            print_line(line)
    return 1 if found.damages else 0
