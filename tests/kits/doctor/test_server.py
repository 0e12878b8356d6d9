"""Findings about name servers; test_examination.py has the faults."""

from pathlib import Path

from support.doctor import made_up

import yarpy
from yarpy.config.configuration import Server
from yarpy.errors import NoNameServer
from yarpy.kits.doctor.server import find, line_of, said_by
from yarpy.platform.shell import no_setting, setting


def test_who_says_where_the_server_is(tmp_path: Path) -> None:
    (tmp_path / "_lab.conf").write_text("\n[name]\nhost lab.local\nport 10000\n")
    (tmp_path / "yarp_namespace.conf").write_text("/lab")
    server = Server("lab.local", 10000, "yarp", "/lab", tmp_path / "_lab.conf")
    case = made_up(directory=tmp_path)
    case.environment = {"YARP_CONFIG_HOME": str(tmp_path)}
    assert said_by(case, server) == (
        f"{tmp_path / 'yarp_namespace.conf'}, line 1 and {tmp_path / '_lab.conf'}, line 3"
    )
    case.environment["YARP_NAMESPACE"] = "/lab"
    assert said_by(case, server).startswith("YARP_NAMESPACE=/lab and ")
    assert said_by(case, Server("x", 1)) == "the environment variable YARPY_SERVER"
    assert line_of(str(tmp_path / "none"), "x") == str(tmp_path / "none")


def test_what_overrides_the_files_is_named(tmp_path: Path) -> None:
    case = made_up(servers=(Server("127.0.0.1", 1),), directory=tmp_path)
    case.problem, case.others = NoNameServer("nobody"), []
    [finding] = find(case)
    assert no_setting("YARPY_SERVER") in finding.advice
    # A server that would do: a file that names it would not be read.
    with yarpy.NameServer() as server:
        case.others = [Server("127.0.0.1", server.port)]
        [finding] = find(case)
    assert finding.advice == f"`{setting('YARPY_SERVER', f'127.0.0.1:{server.port}')}`"


def test_a_port_that_another_server_knows_where_the_environment_says_which(tmp_path: Path) -> None:
    with yarpy.NameServer() as server, yarpy.Port("/lost", names=server.client):
        other = Server("127.0.0.1", server.port)
        for path in (None, tmp_path / "yarp.conf"):
            used = Server("127.0.0.1", 1, path=path)
            case = made_up(wanted=("/lost",), servers=(used,), directory=tmp_path)
            case.others, case.contacts = [other], {}
            [finding] = [one for one in find(case) if one.probe == "other-namespace"]
            assert finding.advice == (
                f"`yarpy conf 127.0.0.1 {server.port}`"
                if path
                else f"`{setting('YARPY_SERVER', f'127.0.0.1:{server.port}')}`"
            )
