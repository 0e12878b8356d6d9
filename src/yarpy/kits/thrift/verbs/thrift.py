"""`yarpy idl thrift`: Python for .thrift files.

    idl thrift FILE...              a Python module and its stubs for each .thrift file
    idl thrift --gen ts FILE...     a module of TypeScript for each, and yarpy.ts, which they import
    idl thrift --check FILE...      whether they are right, and what is in them

Files that a .thrift file includes are looked for beside it, then in the folders of --folder; they
are written, too.

Differs from C++ (yarpidl_thrift): Python or TypeScript is written, not C++.
Exit codes: 0 done; 1 not found, or wrong.
"""

from __future__ import annotations

from pathlib import Path

import click

from yarpy.cli.output import print_line
from yarpy.cli.stderr import complain_of
from yarpy.errors import YarpError


@click.command(short_help="Write Python or TypeScript for .thrift files, or check them.")
@click.argument("files", nargs=-1, required=True, metavar="FILE...")
@click.option("--check", is_flag=True, help="Write nothing, only say what is in them.")
@click.option(
    "--gen", type=click.Choice(("py", "ts")), default="py", help="The language to write (py)."
)
@click.option("--out", default=".", metavar="DIR", help="Where to write (here).")
@click.option(
    "--folder",
    "folders",
    multiple=True,
    metavar="DIR",
    type=click.Path(exists=True, file_okay=False),
    help="A folder of files to include.",
)
def command(
    files: tuple[str, ...], check: bool, gen: str, out: str, folders: tuple[str, ...]
) -> int:
    """Write a Python module and its stubs for .thrift files, or TypeScript, or check them."""
    from yarpy.kits.thrift.file.include import read_interface
    from yarpy.kits.thrift.file.interface import Interface
    from yarpy.kits.thrift.generate.module import python, stubs, summary
    from yarpy.kits.thrift.generate.typescript import RUNTIME, runtime, typescript

    places = [Path(folder) for folder in folders]
    found: dict[Path | None, Interface] = {}
    texts: dict[str, dict[str, str]] = {}  # of each module, by the names of its files
    wrong = 0
    for file in files:  # all are right before one is written
        try:
            all_ = read_interface(Path(file), places).all()
            for each in all_:
                name, module = each.module_name, python(each)
                if gen == "ts":
                    texts[name] = {f"{name}.ts": typescript(each)}
                else:
                    texts[name] = {f"{name}.py": module, f"{name}.pyi": stubs(each)}
        except (YarpError, OSError) as error:
            complain_of(error)
            wrong += 1
        else:
            found.update((each.path, each) for each in all_ if each.path not in found)
    if check:
        for each in found.values():
            print_line(f"{each.document.file}: {summary(each)}")
    if check or wrong:
        return 1 if wrong else 0
    folder = Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    if gen == "ts":
        texts[RUNTIME] = {f"{RUNTIME}.ts": runtime()}
    for written in texts.values():
        for file, text in written.items():
            (folder / file).write_text(text, "utf-8")
        print_line(", ".join(str(folder / file) for file in written))
    return 0
