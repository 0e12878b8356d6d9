"""`yarpy resource [--context C]... (--from FILE | --find FILE) [--show]`: find configuration files.

Prints the full path of the file that programs with that context would use.

Differs from C++: the path is printed bare, and nothing with it (`--verbose` tells on standard error
where it looks); a file that is not there is exit code 1 with `--find`, too.
Exit codes: 0 found; 1 not.
"""

from __future__ import annotations

import click

from yarpy.cli.output import print_line
from yarpy.cli.stderr import complain


@click.command()
@click.option("--context", "contexts", multiple=True, metavar="C", help="A context to look in.")
@click.option("--from", "configuration", metavar="FILE", help="Find a configuration file.")
@click.option("--find", "name", metavar="FILE", help="Find any file.")
@click.option("--show", is_flag=True, help="Print what the configuration file loads as.")
@click.option("--all", "every", is_flag=True, help="Print every file of that name.")
@click.option("--verbose", is_flag=True, help="Tell where it looks.")
def command(
    contexts: tuple[str, ...],
    configuration: str | None,
    name: str | None,
    show: bool,
    every: bool,
    verbose: bool,
) -> int:
    """Print the path of a configuration file."""
    from yarpy.config.resource import Search

    wanted = configuration or name
    if wanted is None:
        raise click.UsageError("give --from FILE or --find FILE")
    search = Search(contexts=contexts)
    found = []
    for path in search.candidates(wanted):
        is_there = path.is_file()
        if verbose:
            click.echo(f"checking [{path}]{' found' if is_there else ''}", err=True)
        if is_there:
            found.append(path)
            if not every:
                break
    if not found:
        complain(f'"{wanted}" is nowhere; `yarpy resource --verbose` shows where it may be')
        return 1
    for path in found:
        print_line(str(path.resolve()))
        if show:
            from yarpy.config.ini import read_ini

            print_line(f">>> {read_ini(path).to_text()}")
    return 0
