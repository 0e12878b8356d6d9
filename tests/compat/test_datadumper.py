"""yarpdatadumper: beside that of C++, and what it says of its arguments."""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from support import fork_server
from support.cpp import CppYarp
from support.peer import brings
from support.port import free_block
from support.process import Process
from support.wait import HANG, wait_until

import yarpy

BOTTLES = [
    (yarpy.Bottle([1, "ping", 3.14]), yarpy.Stamp(1, 100.25)),
    (yarpy.Bottle([["a", [1, 2]], yarpy.Vocab("set"), "two words"]), yarpy.Stamp(2, 100.5)),
    (yarpy.Bottle([]), yarpy.Stamp(5, 100.75)),
    (yarpy.Vector([0.5, 1.5]), yarpy.Stamp(6, 101.0)),
]
PICTURES = [
    (yarpy.Image(np.arange(36, dtype="u1").reshape(3, 4, 3)), yarpy.Stamp(1, 100.25)),
    (yarpy.Image(np.arange(6, dtype="u1").reshape(2, 3)), yarpy.Stamp(2, 100.5)),
    (yarpy.Image(np.arange(18, dtype="u1").reshape(2, 3, 3), "bgr"), yarpy.Stamp(3, 100.75)),
]


@pytest.fixture
def server() -> Iterator[yarpy.NameServer]:
    with yarpy.NameServer(free_block(200)) as found:
        yield found


@contextmanager
def dumper(
    folder: Path, environment: Mapping[str, str], server: yarpy.NameServer, *options: str
) -> Iterator[Process]:
    """Our program, ready, in a working directory."""
    code = "from yarp._datadumper import main; main()"
    there = {**environment, **server.environment}
    command = [sys.executable, "-c", code, *options]
    with Process(command, env=there, cwd=folder, start=fork_server.start) as process:
        process.wait_line("Data stored in", timeout=HANG)
        yield process


def end(port: str) -> None:
    with yarpy.RpcClient(f"{port}/rpc") as client:
        assert client.call("quit") == ["bye"]


def stored(folder: Path) -> int:
    log = folder / "data.log"
    return log.read_bytes().count(b"\n") if log.exists() else 0


@pytest.fixture
@brings("cpp")
def cpp(server: yarpy.NameServer, tmp_path: Path) -> Iterator[CppYarp]:
    with CppYarp.prepare(tmp_path / "cpp").at("127.0.0.1", server.port) as found:
        yield found


@pytest.mark.parametrize(
    ("options", "sent"),
    [
        ("--type bottle --txTime", BOTTLES),
        ("--type image", PICTURES),
        ("--downsample 2", BOTTLES),
    ],
)
def test_the_same_folder_as_cpp(
    options: str,
    sent: Sequence[tuple[object, yarpy.Stamp]],
    cpp: CppYarp,
    server: yarpy.NameServer,
    environment: Mapping[str, str],
    tmp_path: Path,
) -> None:
    words = options.split()
    with (
        cpp.popen("--name", "/theirs", "--dir", "theirs", *words, program="yarpdatadumper") as cpp_,
        dumper(tmp_path, environment, server, "--name", "/ours", *words) as ours,
        yarpy.Port("/src/a:o") as port,
    ):
        for name in ("/theirs", "/theirs/rpc"):
            wait_until(lambda name=name: server.client.query(name) is not None)
        port.connect("/theirs")
        port.connect("/ours")
        for value, stamp in sent:
            port.write(value, stamp, wait=True)
        wait_until(lambda: stored(tmp_path / "ours") == len(sent) // (2 if "2" in words else 1))
        for name, process in (("/ours", ours), ("/theirs", cpp_)):
            end(name)
            assert process.wait(HANG) == 0, process.stderr
    mine, other = tmp_path / "ours", cpp.home / "theirs"
    assert {file.name for file in mine.iterdir()} == {file.name for file in other.iterdir()}
    for file in mine.iterdir():
        if file.name != "info.log":
            assert file.read_bytes() == (other / file.name).read_bytes(), file.name
    lines = [(folder / "info.log").read_text().splitlines() for folder in (mine, other)]
    assert lines[0][:2] == [line.strip() for line in lines[1][:2]]
    assert lines[0][2].split()[1:] == lines[1][2].split()[1:] == ["/src/a:o", "[connected]"]


def test_it_connects_and_stores_what_it_says(
    server: yarpy.NameServer, environment: Mapping[str, str], tmp_path: Path
) -> None:
    (tmp_path / "we_ird_").mkdir()
    options = ("--name", "d", "--dir", "/we:ird*", "--connect", "/src", "--rxTime", "--addVideo")
    with (
        yarpy.Port("/src") as port,
        dumper(tmp_path, environment, server, *options) as process,
    ):
        assert "Data stored in   :  ./we_ird__00001" in process.stderr
        port.wait_for_outputs()
        port.write(yarpy.Bottle([7]), yarpy.Stamp(3, 1.5), wait=True)
        folder = tmp_path / "we_ird__00001"
        wait_until(lambda: stored(folder) == 1, what="it is in the hands of the system")
        with yarpy.RpcClient() as client:
            client.connect("/d/rpc", timeout=HANG)  # it may not be open yet
            assert client.call("sing") == ["command not recognized"] * 2
        process.signal(signal.SIGTERM)
        assert process.wait(HANG) == 0
    assert "1  items stored" in process.stderr and "--addVideo" in process.stderr
    number, received, content = (folder / "data.log").read_text().split()
    assert number == "3" and float(received) > 1e9 and content == "7"


def test_wrong_arguments(
    server: yarpy.NameServer, environment: Mapping[str, str], tmp_path: Path
) -> None:
    code = "from yarp._datadumper import main; main()"
    there = {**environment, **server.environment}
    for options, said in (
        (("--type", "video"), "films are not written; there are bottle, image"),
        (("--help",), "--downsample N"),
    ):
        command = [sys.executable, "-c", code, *options]
        with Process(command, env=there, cwd=tmp_path, start=fork_server.start) as process:
            assert process.wait(HANG) == int("--help" not in options)
        assert said in process.stderr + process.stdout
    assert not [*tmp_path.glob("dump*")]
