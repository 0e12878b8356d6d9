"""`yarpy access`: who may do what with the ports of this computer, and changes to that.

    access                       the rules in force (access.toml), or what holds without any
    access allow RIGHT FROM      give a right: script, or read, write, administer, attach, register
    access refuse RIGHT FROM     take it back

FROM is written as in access.toml: an address, a range, loopback, anyone, tls:NAME, key, token:NAME.
Programs read the file when they start. Exit codes: 0 done; 1 not.
"""

from __future__ import annotations

import os
import textwrap

import click

from yarpy.cli.output import print_line


@click.command()
@click.argument("change", required=False, type=click.Choice(["allow", "refuse"]))
@click.argument("right", required=False)
@click.argument("who", required=False, metavar="[FROM]")
def command(change: str | None, right: str | None, who: str | None) -> int:
    """Show who may do what with the ports here, or allow and refuse a right."""
    from yarpy.config import access_edit, access_file

    if change is None:
        show()
        return 0
    if right is None or who is None:
        raise click.UsageError(f"say what and to whom, for example: {change} script 192.168.1.9")
    edit = access_edit.allow if change == "allow" else access_edit.refuse
    where = access_file.path(os.environ)
    print_line(edit(where, right, who))
    if (change, right) == ("allow", "script"):
        rules = access_file.load(where).rules
        if not any("attach" in rule.may and {who, "anyone"} & {*rule.who} for rule in rules):
            print_line(f"note: scripts need attach as well: yarpy access allow attach {who}")
    return 0


def show() -> None:
    """Print the rules in force. Raises AddressError where there is a mistake in them."""
    from yarpy.config import access_file, access_report
    from yarpy.names.default import secret
    from yarpy.transports.bind import reach
    from yarpy.transports.tls_setting import folder

    access = access_file.current()
    if access is None:
        lines = access_report.defaults(access_file.path(os.environ), reach())
    else:
        lines = access_report.listing(access)
        authority = folder() / "ca.pem"
        for note in access_report.notes(access, authority=authority, has_key=bool(secret())):
            lines += textwrap.wrap(note, 79, initial_indent="note: ", subsequent_indent="      ")
    for line in lines:
        print_line(line)
