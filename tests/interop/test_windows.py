"""yarpy on the Python of Windows, under wine, beside C++ YARP, yarpy and a browser of Linux."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from support import windows
from support.browser import Browser
from support.cpp import CppYarp
from support.cpp_program import CppProgram
from support.environment import configured_for
from support.port import free_block
from support.process import Process
from support.wait import HANG, wait_until

import yarpy

pytestmark = pytest.mark.peer("windows")

BEGIN = 3 * HANG  # seconds for a program of Windows to begin on a busy machine

# It sends on what comes, in words or as a picture, and answers.
ECHO = """
import yarpy
with (
    yarpy.BufferedPort("/windows/in") as came,
    yarpy.Port("/windows/out") as out,
    yarpy.RpcServer("/windows/rpc", lambda asked: ["windows", *asked.value]),
):
    print("open", flush=True)
    for message in came:
        print("came", out.write(message.value), flush=True)
"""


@contextlib.contextmanager
def on_windows(home: Path, *words: str, server: str = "") -> Iterator[Process]:
    """The Python of Windows, with files in a folder of its own."""
    folder = windows.prepare()
    variables = {name: windows.path_of(home) for name in ("YARP_CONFIG_HOME", "YARP_DATA_HOME")}
    variables |= {"YARPY_SERVER": server} if server else {}
    # Else a demo takes those where programs of other tests look for a name server.
    variables["YARP_PORT_RANGE"] = str(free_block(200))
    environment = {**windows.environment(folder), **variables, "PYTHONUNBUFFERED": "1"}
    command = [*windows.interpreter(folder), *words]
    with Process(command, env=environment, cwd=windows.ROOT) as process:
        yield process


@pytest.fixture(scope="module")
def programs(cpp: CppYarp, tmp_path_factory: pytest.TempPathFactory) -> Iterator[CppYarp]:
    """C++ programs, and yarpy of Linux, around `yarpy server` on Windows."""
    port = free_block(200)
    words = ("-m", "yarpy", "server", "--ip", "127.0.0.1", "--socket", str(port))
    with (
        on_windows(tmp_path_factory.mktemp("server"), *words) as server,
        cpp.at("127.0.0.1", port) as programs,
        configured_for(programs, by_file=False),
    ):
        server.wait_line("Ready!", timeout=BEGIN)
        yield programs


@pytest.fixture(scope="module")
def echo(programs: CppYarp, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Process]:
    """A program on Windows with ports."""
    server = f"127.0.0.1:{programs.port}"
    with on_windows(tmp_path_factory.mktemp("echo"), "-c", ECHO, server=server) as process:
        process.wait_line("^open$", timeout=BEGIN)
        yield process


def test_cpp_asks_a_name_server_on_windows(programs: CppYarp) -> None:
    assert programs.run("name", "register", "/x", "tcp", "127.0.0.1", "5").stdout == (
        "registration name /x ip 127.0.0.1 port 5 type tcp\n\n"
    )
    assert programs.run("name", "query", "/nope").returncode == 1
    found = programs.run("where").stdout
    assert f"/root is available at ip 127.0.0.1 port {programs.port}\n" in found


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "udp", "text"])
@pytest.mark.parametrize("answer", ["tcp", "fast_tcp", "udp", "text"])
def test_cpp_both_ways(programs: CppYarp, echo: Process, carrier: str, answer: str) -> None:
    # Names of its own: the end of the one before may not have been noticed.
    out, back = (f"/cpp/{carrier}/{answer}/{end}" for end in ("out", "back"))
    with CppProgram(programs) as peer:
        peer.do("out, back = yarp.Port(), yarp.BufferedPortBottle()")
        peer.do("back.setStrict(True)")
        assert peer.do(f"out.open('{out}'), back.open('{back}')") == [True, True]
        assert peer.do(f"yarp.Network.connect('/windows/out', '{back}', '{answer}')")
        assert peer.do(f"yarp.Network.connect('{out}', '/windows/in', '{carrier}')")
        peer.do("bottle = yarp.Bottle('hello (1 2.5) \"a b\"')")
        peer.do("out.write(bottle)")
        assert peer.do("back.read().toString()") == 'hello (1 2.5) "a b"'


def test_cpp_and_windows_ask_each_other(programs: CppYarp, echo: Process) -> None:
    with CppProgram(programs) as peer:
        peer.do("client, asked, said = yarp.RpcClient(), yarp.Bottle('5 b'), yarp.Bottle()")
        assert peer.do("client.open('/cpp/client')")
        assert peer.do("yarp.Network.connect('/cpp/client', '/windows/rpc')")
        assert peer.do("client.write(asked, said)")
        assert peer.do("said.toString()") == "windows 5 b"


def test_pictures_come_from_linux_and_go_back(programs: CppYarp, echo: Process) -> None:
    picture = yarpy.Image(np.arange(480 * 640 * 3, dtype=np.uint8).reshape(480, 640, 3))
    with yarpy.Port("/linux/out") as out, yarpy.BufferedPort("/linux/back") as back:
        yarpy.connect("/windows/out", "/linux/back")
        out.connect("/windows/in")
        out.write(picture)
        message = back.read(HANG)
        assert message is not None
        assert (message.value.array == picture.array).all()


def test_the_program_of_the_readme(tmp_path: Path) -> None:
    program, expected = windows.example()
    with on_windows(tmp_path, "-c", program) as process:
        assert process.wait(BEGIN) == 0, process.said()
        assert process.stdout.strip() == expected


def test_the_page_of_the_demo(browser: Browser, tmp_path: Path) -> None:
    with on_windows(tmp_path, "-m", "yarpy", "demo", "--no-browser") as demo:
        url = demo.wait_line(r"(http://\S+)\s+<- open this", timeout=BEGIN)[1]
        demo.wait_line("Ctrl-C ends it all", timeout=BEGIN)
        page = browser.open()
        page.goto(url, wait_until="commit")
        body = page.locator("body")
        wait_until(lambda: body.inner_text().count("320 \u00d7 240") == 2, BEGIN, "both eyes see")
