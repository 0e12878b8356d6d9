"""`yarpy idl rosmsg`: messages and services of ROS 1.

    idl rosmsg NAME...              show them, as `rosmsg show` does
    idl rosmsg --raw NAME...        the text of their files, with the comments
    idl rosmsg --md5 NAME...        their checksums
    idl rosmsg --python NAME...     a Python module with their classes
    idl rosmsg --stubs NAME...      the .pyi file for that module
    idl rosmsg --name /typ@/yarpros answer those who ask for types, until interrupted

A NAME is package/Type, or the path of a .msg or .srv file. Names are looked for in the folders of
--folder, in folders `msgs` where `yarpy resource` looks for files of the --context, in the packages
of ROS, among those that rosbags and yarpy bring, and at last at the type server of the network.

Differs from C++ (yarpidl_rosmsg): Python is written, not C++, and nothing is fetched from the web.
Exit codes: 0 done; 1 not found, or wrong.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from yarpy.cli.output import print_line
from yarpy.errors import YarpError
from yarpy.platform import waiting

if TYPE_CHECKING:
    from yarpy.peers.ros.message.library import Library
    from yarpy.peers.ros.type_server import TypeClient


@click.command(short_help="Messages of ROS: show them, write Python, serve them.")
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
def command(
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
    from yarpy.peers.ros.message.library import Service
    from yarpy.peers.ros.message.show import show
    from yarpy.peers.ros.message.stub import python, stubs

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

    from yarpy.cli import log, signals
    from yarpy.peers.ros.type_server import TypeServer

    log.show()
    with signals.held():
        server = TypeServer(name, library)
        click.get_current_context().call_on_close(server.close)
    print_line(f"{server.name} answers `twiddle TYPE` and `raw TYPE`")
    try:
        waiting.wait()
    except signals.Interrupted:
        pass
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
        from yarpy.peers.ros.type_server import HINT

        return HINT


def _type_servers() -> list[TypeClient]:
    from yarpy.peers.ros.names import RosNames
    from yarpy.peers.ros.role import services, without_masters
    from yarpy.peers.ros.type_server import TypeClient

    try:
        names, master = services(None)
    except YarpError:
        return []
    yarp = without_masters(names)
    return [TypeClient(each) for each in (master and RosNames(master), yarp) if each]


def library_of(folders: tuple[str, ...], contexts: tuple[str, ...]) -> Library:
    """The library that looks in these folders and contexts first."""
    from yarpy.config.resource import Search
    from yarpy.peers.ros.message.catalogue import standard_sources
    from yarpy.peers.ros.message.library import Library
    from yarpy.peers.ros.message.source import Folder

    search = Search(contexts=contexts)
    wanted = [path for path in search.candidates("msgs") if path.is_dir()] if contexts else []
    return Library([*map(Folder, folders), *map(Folder, wanted), *standard_sources()])
