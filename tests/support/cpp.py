"""A real C++ YARP to talk to: its programs, its name server and its Python binding.

    cpp = CppYarp.prepare(directory)             # MissingPeer says why there is none
    with cpp.server() as names:                  # a C++ name server on 127.0.0.1, ready
        names.run("name", "list").stdout         # `yarp name list` against that server
        names.popen("read", "/r")                # a support.process.Process
        names.python("import yarp; ...")         # a script with the C++ binding (CPython 3.10)
    with cpp.at("127.0.0.1", port) as client:    # the same programs against another name server
        client.run("where")

Rules: every CppYarp has a configuration directory of its own and none of our YARP_* variables, so
nothing on the machine is read or changed; the compiled programs are started directly, not through
their Python wrappers (a signal then reaches the program itself).
"""

import contextlib
import functools
import os
import signal
import socket
import subprocess
import tempfile
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from support.cpp_venv import prepare
from support.peer_venv import MissingPeer
from support.port import free_block
from support.process import Process
from support.wait import HANG

__all__ = ["CppYarp", "MissingPeer"]

# A C++ server hands out the numbers after its own; it never looks whether they are free.
_BLOCK = 200


@dataclass(frozen=True)
class CppYarp:
    """C++ YARP with one configuration: which name server it uses, in which directory it runs."""

    root: Path
    """The prefix or virtual environment that holds the programs."""
    home: Path
    """Working directory of what is started, with `config/` and `data/` (YARP_CONFIG_HOME ...)."""
    host: str = ""
    port: int = 0
    """Address of the name server; empty and 0 where none is configured."""
    variables: Mapping[str, str] = field(default_factory=dict)
    """Environment variables besides those of `environment`, such as YARP_IP."""
    server_process: Process | None = None
    """The name server, where `server` started it."""

    @classmethod
    def prepare(cls, home: Path) -> "CppYarp":
        """C++ YARP without a name server; makes its virtual environment the first time."""
        return cls(prepare(), home)

    @property
    def interpreter(self) -> Path:
        """CPython in whose environment `import yarp` is the C++ binding."""
        return self.root / "bin/python"

    @property
    def package(self) -> Path | None:
        """Where the package has everything, linked statically; None in an installation."""
        package = self.root / "lib/python3.10/site-packages/yarp"
        return package if (package / "bin").is_dir() else None

    @property
    def version(self) -> tuple[int, int]:
        """Its version, as (3, 9)."""
        return _version(self.program())

    def program(self, name: str = "yarp") -> Path:
        """A compiled program: yarp, yarpserver, yarprun, yarpdev, yarpros, yarpidl_thrift ...

        Skips the test where it was not built."""
        found = (self.package or self.root) / "bin" / name
        if not found.exists():
            pytest.skip(f"{found} is missing: build it, or name another C++ in YARPY_CPP_YARP")
        return found

    @property
    def environment(self) -> dict[str, str]:
        """The whole environment for a program that shall use this configuration."""
        drop = ("PYTHONPATH", "PYTHONHOME", "VIRTUAL_ENV")
        ours = {
            name: value
            for name, value in os.environ.items()
            if not name.startswith(("YARP_", "YARPY_", "ROS_")) and name not in drop
        }
        ours["YARP_CONFIG_HOME"] = str(self.home / "config")
        ours["YARP_DATA_HOME"] = str(self.home / "data")
        # C++ looks for servers on the multicast port of this number, whatever the server's own:
        # with a number of its own no test finds the server of another.
        if self.port:
            ours["YARP_PORT_RANGE"] = str(self.port)
        if self.package is None:
            ours["YARP_DATA_DIRS"] = str(self.root / "share/yarp")
        ours["PYTHONUNBUFFERED"] = "1"
        return {**ours, **self.variables}

    def run(
        self,
        *args: str,
        program: str = "yarp",
        input: str = "",
        timeout: float = HANG,
    ) -> "subprocess.CompletedProcess[str]":
        """Run `yarp ARGS` (or another program) to its end; its output and exit code.

        After `timeout` seconds it is killed and AssertionError shows what it had said.
        """
        with self.popen(*args, program=program) as process:
            return _finish(process, input, timeout)

    def popen(self, *args: str, program: str = "yarp") -> Process:
        """Start `yarp ARGS`; a context manager that ends it."""
        return self._start([self.program(program), *args])

    def python(
        self, code: str, *args: str, input: str = "", timeout: float = HANG
    ) -> "subprocess.CompletedProcess[str]":
        """Run a script under CPython 3.10 with the C++ binding to its end; its output and code."""
        with self.python_popen(code, *args) as process:
            return _finish(process, input, timeout)

    def python_popen(self, code: str, *args: str) -> Process:
        """Start such a script; a context manager that ends it."""
        return self._start([self.interpreter, "-c", code, *args])

    @contextlib.contextmanager
    def at(self, host: str, port: int, **variables: str) -> Iterator["CppYarp"]:
        """These programs, configured for the name server at HOST:PORT."""
        with tempfile.TemporaryDirectory(prefix="yarpy-cpp-") as home:
            config = Path(home) / "config"
            config.mkdir()
            (config / "yarp.conf").write_text(f"{host} {port} yarp\n")
            yield CppYarp(self.root, Path(home), host, port, variables)

    @contextlib.contextmanager
    def server(
        self, *options: str, port: int | None = None, **variables: str
    ) -> Iterator["CppYarp"]:
        """A C++ name server on 127.0.0.1 that answers, and the programs configured for it.

        `options` go to yarpserver in addition; `port` is a free one unless given.
        """
        number = free_block(_BLOCK) if port is None else port
        with self.at("127.0.0.1", number, **variables) as client:
            # `--ip 127.0.0.1` alone is overridden wherever another interface exists, also with
            # `--write`; with `--read` the address file decides, on every host.
            fixed = ("--read", "--ip", "127.0.0.1", "--socket", str(number))
            databases = (
                *("--portdb", str(client.home / "port.db")),
                *("--subdb", str(client.home / "subscription.db")),
            )
            with client.popen(*fixed, *databases, *options, program="yarpserver") as process:
                _wait_until_it_answers(process, number)
                yield CppYarp(
                    client.root, client.home, client.host, client.port, variables, process
                )

    def _start(self, args: list[str | os.PathLike[str]]) -> Process:
        self.home.mkdir(parents=True, exist_ok=True)
        return Process(args, env=self.environment, cwd=self.home)


@functools.cache
def _version(program: Path) -> tuple[int, int]:
    said = subprocess.run([program, "version"], capture_output=True, text=True, timeout=HANG).stdout
    major, minor = said.removeprefix("YARP version ").split(".")[:2]
    return int(major), int(minor)


def _finish(process: Process, input: str, timeout: float) -> "subprocess.CompletedProcess[str]":
    with contextlib.suppress(BrokenPipeError):  # it may end without reading
        process.write(input)
    process.end_input()
    code = process.wait(timeout)
    return subprocess.CompletedProcess(process.args, code, process.stdout, process.stderr)


def _wait_until_it_answers(process: Process, port: int) -> None:
    """Ask for the last name the server registers itself, as telnet would: its output is no sign,
    it is block buffered when it does not go to a terminal."""
    deadline = time.monotonic() + HANG
    while time.monotonic() < deadline:
        if process.returncode is not None:
            break
        with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port), 1) as line:
            line.settimeout(1)
            line.sendall(b"NAME_SERVER query fallback\n")
            if line.recv(200).startswith(b"registration name fallback "):
                return
        time.sleep(0.02)
    process.signal(signal.SIGTERM)
    raise AssertionError(
        f"the C++ name server does not answer on port {port}; it said:\n"
        f"{process.stdout}{process.stderr}"
    )
