"""`yarpy status [NAME]`: how a running application is doing.

    yarpy status --page     open its page in a browser, and say where it is

Exit codes: 0 all runs; 1 none runs; 2 something has failed, or is not connected.
"""

from __future__ import annotations

import shutil

import click

from yarpy.cli.output import print_json, print_line


@click.command()
@click.argument("name", default="")
@click.option("--json", "as_json", is_flag=True, help="Print one object.")
@click.option("--page", is_flag=True, help="Open its page, which only you can see.")
def command(name: str, as_json: bool, page: bool) -> int:
    """Show the programs and connections of the application NAME (or the only one)."""
    from yarpy.kits.launch.console import control
    from yarpy.kits.launch.console.chosen import chosen
    from yarpy.kits.launch.console.look import lines

    name = chosen(name)
    if page:
        from yarpy.cli.browser import open_page

        url = control.ask(name, do="page")["url"]
        print_line(f"{name} is shown at {url}")
        open_page(url)
        return 0
    status = control.ask(name, do="status")
    if as_json:
        print_json(status)
    else:
        many = len(status["programs"]) + len(status["connections"]) + 4
        for line, _ in lines(status, max(shutil.get_terminal_size((80, 24)).columns, 40), 2 * many):
            print_line(line)
    wrong = any(one["state"] in ("failed", "pausing", "unknown") for one in status["programs"])
    wrong = wrong or any(one["state"] not in ("connected", "off") for one in status["connections"])
    return 2 if wrong else 0
