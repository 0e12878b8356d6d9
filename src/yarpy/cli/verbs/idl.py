"""`yarpy idl`: types of other systems - messages and services of ROS, interfaces of Thrift.

    idl thrift FILE...              a Python module and its stubs for each .thrift file
    idl thrift --check FILE...      whether they are right, and what is in them
    idl rosmsg NAME...              show them, as `rosmsg show` does
    idl rosmsg --raw NAME...        the text of their files, with the comments
    idl rosmsg --md5 NAME...        their checksums
    idl rosmsg --python NAME...     a Python module with their classes
    idl rosmsg --stubs NAME...      the .pyi file for that module
    idl rosmsg --name /typ@/yarpros answer those who ask for types, until interrupted
    idl sniff PORT                  a .msg file for what a port sends

A NAME is package/Type, or the path of a .msg or .srv file. Names are looked for in the folders of
--folder, in folders `msgs` where `yarpy resource` looks for files of the --context, in the packages
of ROS, among those that rosbags and yarpy bring, and at last at the type server of the network.

Files that a .thrift file includes are looked for beside it, then in the folders of --folder; they
are written, too.

Differs from C++ (yarpidl_rosmsg, yarpidl_thrift): Python is written, not C++, and nothing is
fetched from the web.
Exit codes: 0 done; 1 not found, or wrong.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from yarpy.cli.output import print_line
from yarpy.cli.stderr import complain_of
from yarpy.errors import YarpError

if TYPE_CHECKING:
    from yarpy.idl.rosmsg.library import Library
    from yarpy.ros.type_server import TypeClient


@click.group()
def command() -> None:
    """Types of other systems: show them, write code for them."""


@command.command(short_help="Messages of ROS: show them, write Python, serve them.")
@click.argument("names", nargs=-1, metavar="NAME...")
@click.option("--raw", "form", flag_value="raw", help="Print their files, with the comments.")
@click.option("--md5", "form", flag_value="md5", help="Print their checksums.")
@click.option("--python", "form", flag_value="python", help="Print a Python module for them.")
@click.option("--stubs", "form", flag_value="stubs", help="Print the stubs for that module.")
@click.option(
    "--folder",
    "folders",
    multiple=True,
    metavar="DIR",
    type=click.Path(exists=True, file_okay=False),
    help="A folder of packages to look in first.",
)
@click.option("--context", "contexts", multiple=True, metavar="C", help="A context with `msgs`.")
@click.option("--name", "port", metavar="PORT", help="Serve types on this port (/typ@/yarpros).")
def rosmsg(
    names: tuple[str, ...],
    form: str | None,
    folders: tuple[str, ...],
    contexts: tuple[str, ...],
    port: str | None,
) -> int:
    """Show messages and services of ROS, write Python for them, or tell others of them."""
    if port is not None:
        return _serve(port, library_of(folders, contexts))
    if not names:
        raise click.UsageError("which types? Give names, such as sensor_msgs/Image")
    from yarpy.idl.rosmsg.library import Service
    from yarpy.idl.rosmsg.show import show
    from yarpy.idl.rosmsg.stub import python, stubs

    library = library_of(folders, contexts)
    library.catalogue.sources.append(TypeServers())
    found = [library.load(name) for name in names]
    if form in ("python", "stubs"):
        print_line((python if form == "python" else stubs)(found).rstrip("\n"))
        return 0
    for each in found:
        definition = each.definition if isinstance(each, Service) else each._definition
        if form == "md5":
            behind = f" {definition.name}" if len(found) > 1 else ""
            print_line(definition.md5sum + behind)
            continue
        if len(found) > 1:
            print_line(f"[{definition.name}]:")
        print_line(definition.text.rstrip("\n") if form == "raw" else show(definition))
    return 0


def _serve(name: str, library: Library) -> int:
    import threading

    from yarpy.cli import log, signals
    from yarpy.ros.type_server import TypeServer

    log.show()
    with signals.held():
        server = TypeServer(name, library)
        click.get_current_context().call_on_close(server.close)
    print_line(f"{server.name} answers `twiddle TYPE` and `raw TYPE`")
    try:
        threading.Event().wait()
    except signals.Interrupted:
        pass
    return 0


@command.command(short_help="Write Python for .thrift files, or check them.")
@click.argument("files", nargs=-1, required=True, metavar="FILE...")
@click.option("--check", is_flag=True, help="Write nothing, only say what is in them.")
@click.option("--out", default=".", metavar="DIR", help="Where to write (here).")
@click.option(
    "--folder",
    "folders",
    multiple=True,
    metavar="DIR",
    type=click.Path(exists=True, file_okay=False),
    help="A folder of files to include.",
)
def thrift(files: tuple[str, ...], check: bool, out: str, folders: tuple[str, ...]) -> int:
    """Write a Python module and its stubs for .thrift files, or check them."""
    from yarpy.idl.thrift.interface import Interface, read_interface
    from yarpy.idl.thrift.module import python, stubs, summary

    places = [Path(folder) for folder in folders]
    found: dict[Path | None, Interface] = {}
    texts: dict[str, tuple[str, str]] = {}
    wrong = 0
    for file in files:  # all are right before one is written
        try:
            all_ = read_interface(Path(file), places).all()
            for each in all_:
                texts[each.module_name] = python(each), stubs(each)
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
    for name, (module, stub) in texts.items():
        (folder / f"{name}.py").write_text(module)
        (folder / f"{name}.pyi").write_text(stub)
        print_line(f"{folder / name}.py, {folder / name}.pyi")
    return 0


@command.command(short_help="Write a .msg file for what PORT sends.")
@click.argument("port")
@click.option("--count", default=1, help="Messages to look at; they must have one structure.")
def sniff(port: str, count: int) -> int:
    """Write a .msg file for what PORT sends, so that ROS can read its bytes unchanged."""
    import yarpy
    from yarpy.cli.ports import ANY, hear_from, open_port
    from yarpy.idl.rosmsg.sniff import sniff as write

    with open_port(yarpy.BufferedPort, ANY, strict=True) as reader:
        hear_from(reader, port)
        samples = [bytes(reader.read().to_bytes()) for _ in range(max(count, 1))]
    print_line(write(*samples).rstrip("\n"))
    return 0


class TypeServers:
    """A source of definitions: the type servers of the graph of ROS and of the YARP network, which
    are looked for when it is asked."""

    def __init__(self) -> None:
        self._clients: list[TypeClient] | None = None

    def find(self, name: str, kind: str) -> str | None:
        """The text of a type, from the first that knows it."""
        if self._clients is None:
            self._clients = _type_servers()
        found = (client.find(name, kind) for client in self._clients)
        return next((text for text in found if text is not None), None)

    def __str__(self) -> str:
        from yarpy.ros.type_server import HINT

        return HINT


def _type_servers() -> list[TypeClient]:
    from yarpy.names.ros import RosNames
    from yarpy.ros.part import services, without_masters
    from yarpy.ros.type_server import TypeClient

    try:
        names, master = services(None)
    except YarpError:
        return []
    yarp = without_masters(names)
    return [TypeClient(each) for each in (master and RosNames(master), yarp) if each]


def library_of(folders: tuple[str, ...], contexts: tuple[str, ...]) -> Library:
    """The library that looks in these folders and contexts first."""
    from yarpy.config.resource import Search
    from yarpy.idl.rosmsg.catalogue import standard_sources
    from yarpy.idl.rosmsg.library import Library
    from yarpy.idl.rosmsg.source import Folder

    search = Search(contexts=contexts)
    wanted = [path for path in search.candidates("msgs") if path.is_dir()] if contexts else []
    return Library([*map(Folder, folders), *map(Folder, wanted), *standard_sources()])
