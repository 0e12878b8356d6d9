"""Finding the servers: directories, files in both forms, environment, writing."""

import errno
import os
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yarpy.config.configuration import (
    Server,
    clear_server,
    configuration,
    default_port,
    namespaces,
    parse_server,
    port_name,
    port_number,
    read_server,
    safe_name,
    server_file,
    write_namespaces,
    write_server,
)
from yarpy.errors import AddressError


def test_file_names(tmp_path: Path) -> None:
    assert server_file(tmp_path, "/root").name == "yarp.conf"
    assert server_file(tmp_path, "/robotA").name == "_robotA.conf"
    assert server_file(tmp_path, "/env/ns").name == "_env_ns.conf"
    assert safe_name("/a-b.c:i é") == "_a_b_c_i__"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("127.0.0.1 10000 yarp\n", Server("127.0.0.1", 10000)),
        ("127.0.0.1 10000", Server("127.0.0.1", 10000)),
        ('"127.0.0.1"\t10000\n//', Server("127.0.0.1", 10000)),
        ("\n\n host\n11311 ros", Server("host", 11311, "ros")),
        ("h 1 local extra words", Server("h", 1, "local")),
        ("::1 10000", Server("::1", 10000)),
        ("", None),
        ("  \n", None),
        (
            "[name]\nhost 127.0.0.1\nport 21122\nmode yarp\n",
            Server("127.0.0.1", 21122),
        ),
        (
            '[other]\nhost wrong\n[ name ]\r\n# note\nhost "h"\r\nport 5 // why\r\n',
            Server("h", 5),
        ),
    ],
)
def test_address_files(text: str, expected: Server | None) -> None:
    assert parse_server(text) == expected


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("onlyhost", 'only "onlyhost" is no address'),
        ("[name]\nport 5\n", "without host"),
        ("[name]\nhost\n", "without host"),
        ("[name]\nhost h\n", '"" is no port'),
        ("h 1 carrot", 'mode "carrot"'),
        ("\x01\x02 \x03", r'"\'\\x03\'\.\.\." is no port'),
        ("h port", '"port" is no port'),
        ("h 70000", '"70000" is no port'),
        ("h 0 yarp", '"0" is no port'),
        ("[nome]\nhost h\nport 1", r"section \[name\]"),
        ("[", "name"),
    ],
)
def test_unusable_address_files(text: str, complaint: str, tmp_path: Path) -> None:
    with pytest.raises(AddressError, match=complaint):
        parse_server(text)
    (tmp_path / "yarp.conf").write_text(text)
    with pytest.raises(
        AddressError, match=r"yarp\.conf: .*; `yarpy conf HOST PORT` writes the file"
    ):
        read_server(tmp_path)


def test_a_disk_that_cannot_be_written_is_told_with_the_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(path: Path, *args: object, **options: object) -> None:
        raise OSError(errno.EROFS, os.strerror(errno.EROFS), str(path))

    monkeypatch.setattr(Path, "write_text", refuse)
    monkeypatch.setattr(Path, "unlink", refuse)
    with pytest.raises(OSError) as told:
        write_server(tmp_path, Server("h", 1))
    assert told.value.filename == str(tmp_path / "yarp.conf")


def test_who_writes_the_file_anew_goes_on(tmp_path: Path) -> None:
    (tmp_path / "yarp.conf").write_text("hello")
    with pytest.raises(AddressError, match=r"yarp\.conf: only \"hello\""):
        configuration({}, tmp_path)
    told: list[str] = []
    found = configuration({}, tmp_path, told.append)
    assert (found.servers, found.missing) == ((), ("/root",))
    assert told == [
        f'{tmp_path / "yarp.conf"}: only "hello" is no address of a name server, which is HOST PORT'
    ]
    with pytest.raises(AddressError):  # what the environment says, nobody writes anew
        configuration({"YARPY_SERVER": ":"}, tmp_path, told.append)


def test_write_and_clear(tmp_path: Path) -> None:
    directory = tmp_path / "new" / "yarp"
    path = write_server(directory, Server("127.0.0.1", 10000))
    assert path.read_bytes() == b"127.0.0.1 10000 yarp\n"
    assert read_server(directory) == Server("127.0.0.1", 10000, "yarp", "/root", path)
    write_server(directory, Server("h", 11311, "ros", "/my ros"))
    assert read_server(directory, "/my ros") == Server(
        "h", 11311, "ros", "/my ros", directory / "_my_ros.conf"
    )
    clear_server(directory)
    assert path.read_bytes() == b""
    assert read_server(directory) is None
    assert [p.name for p in directory.iterdir() if p.suffix != ".conf"] == []


def test_namespaces(tmp_path: Path) -> None:
    assert namespaces({}, tmp_path) == ["/root"]
    assert write_namespaces(tmp_path, ["/a", "/b"]).read_bytes() == b'"/a" "/b"'
    assert namespaces({}, tmp_path) == ["/a", "/b"]
    (tmp_path / "yarp_namespace.conf").write_text("/a\n")
    assert namespaces({}, tmp_path) == ["/a"]
    assert namespaces({"YARP_NAMESPACE": '/n1 "/n2"'}, tmp_path) == ["/n1", "/n2"]
    (tmp_path / "yarp_namespace.conf").write_text("")
    assert namespaces({}, tmp_path) == ["/root"]


def test_all_together(tmp_path: Path) -> None:
    env: dict[str, str] = {}
    nothing = configuration(env, tmp_path)
    assert (nothing.servers, nothing.missing, nothing.namespace) == ((), ("/root",), "/root")
    write_namespaces(tmp_path, ["/one", "/two", "/three"])
    write_server(tmp_path, Server("h1", 1, namespace="/one"))
    write_server(tmp_path, Server("h3", 3, namespace="/three"))
    found = configuration(env, tmp_path)
    assert [(s.namespace, s.host, s.port) for s in found.servers] == [
        ("/one", "h1", 1),
        ("/three", "h3", 3),
    ]
    assert found.missing == ("/two",)
    assert found.namespace == "/one"
    # What the first namespace lacks the others do not make good.
    assert configuration({"YARP_NAMESPACE": "/two /one"}, tmp_path).servers == ()
    assert configuration({"YARP_NAMESPACE": "/two /one"}, tmp_path).namespace == "/two"
    by_variable = configuration({"YARP_CONFIG_HOME": str(tmp_path), "YARP_NAMESPACE": "/three"})
    assert by_variable.servers[0].host == "h3"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("127.0.0.1:10001", [("127.0.0.1", 10001)]),
        ("a:1, b:2 ,", [("a", 1), ("b", 2)]),
        ("host", [("host", 10000)]),
        ("[::1]:5", [("::1", 5)]),
        ("[::1]", [("::1", 10000)]),
    ],
)
def test_our_own_variable_wins(text: str, expected: list[tuple[str, int]], tmp_path: Path) -> None:
    write_server(tmp_path, Server("file", 9))
    found = configuration({"YARPY_SERVER": text}, tmp_path)
    assert [(server.host, server.port) for server in found.servers] == expected
    assert all(server.path is None for server in found.servers)
    assert configuration({"YARPY_SERVER": " "}, tmp_path).servers[0].host == "file"


@pytest.mark.parametrize("text", ["h:0", "h:x", ":5", "h:70000"])
def test_our_own_variable_may_be_wrong(text: str, tmp_path: Path) -> None:
    with pytest.raises(AddressError, match="YARPY_SERVER"):
        configuration({"YARPY_SERVER": text}, tmp_path)


def test_port_range() -> None:
    assert default_port({}) == 10000
    assert default_port({"YARP_PORT_RANGE": "21100"}) == 21100
    for text in ("0", "x", "", "-5", "99999999999"):
        assert default_port({"YARP_PORT_RANGE": text}) == 10000


def test_names_of_ports() -> None:
    env = {
        "YARP_RENAME_foo": "/bar",
        "YARP_PORT_PREFIX": "/robot",
        "YARP_PORTNUMBER_cam_left_i": "21198",
        "YARP_PORTNUMBER_bad": "many",
    }
    assert port_name("/foo", env) == "/robot/bar"
    assert port_name("/other", env) == "/robot/other"
    assert port_name("/foo", {}) == "/foo"
    assert port_number("/cam/left:i", env) == 21198
    assert port_number("/bad", env) == port_number("/none", env) == 0


@given(st.text(max_size=60))
def test_any_file(text: str) -> None:
    try:
        server = parse_server(text)
    except AddressError:
        return
    assert server is None or (server.host and 0 <= server.port <= 65535)
