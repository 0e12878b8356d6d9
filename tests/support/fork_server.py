"""Start programs of yarpy as forks of one that has imported it, which spares each a cold start.

    start([sys.executable, "-m", "yarpy", "read", "/x"], env=..., cwd=...)  # as subprocess.Popen

Rules: a program is a process and a session of its own, with its environment, folder and streams,
and ends as Python ends. Only the start of the interpreter and the imports are not its own: tests of
those use `subprocess`, as does `start` for variables that count when Python starts. Each process of
tests has one server, a program without threads, which waits for the ends of the others; they end
with it.
"""

from __future__ import annotations

import atexit
import contextlib
import faulthandler
import gc
import importlib
import json
import os
import pkgutil
import runpy
import select
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Mapping, Sequence
from functools import cache
from typing import IO, Any, Final

LARGEST: Final = 100_000  # bytes of a request
# Variables that count when Python starts, or a library of C is loaded.
AT_THE_START: Final = ("PYTHON", "LC_", "LANG", "LD_", "TZ")
_ENVIRONMENT: Final = dict(os.environ)
_TURN: Final = threading.Lock()  # one request and its answer at a time
ROOMS: Final = ("wire", "data", "names", "network", "transports", "link", "port", "nameserver")


class Program:
    """A running program: what tests use of `subprocess.Popen`."""

    def __init__(
        self, args: Sequence[str], env: Mapping[str, str], cwd: str | os.PathLike[str] | None
    ) -> None:
        self.args = [*args]
        self.returncode: int | None = None
        (stdin, given), (taken, stdout), (told, stderr), (self._end, status) = (
            os.pipe() for _ in range(4)
        )
        request = {"args": self.args[1:], "env": dict(env), "cwd": os.fspath(cwd or os.getcwd())}
        theirs = [stdin, stdout, stderr, status]
        link = _link()
        with _TURN:
            socket.send_fds(link, [json.dumps(request).encode()], theirs)
            self.pid = int(link.recv(LARGEST))
        for descriptor in theirs:
            os.close(descriptor)
        self.stdin: IO[bytes] = open(given, "wb")  # noqa: SIM115
        self.stdout: IO[bytes] = open(taken, "rb")  # noqa: SIM115
        self.stderr: IO[bytes] = open(told, "rb")  # noqa: SIM115

    def poll(self) -> int | None:
        return self._look(0)

    def wait(self, timeout: float | None = None) -> int:
        code = self._look(timeout)
        if code is None:
            raise subprocess.TimeoutExpired(self.args, timeout or 0)
        return code

    def send_signal(self, number: int) -> None:
        if self.poll() is None:
            with contextlib.suppress(ProcessLookupError):
                os.kill(self.pid, number)

    def terminate(self) -> None:
        self.send_signal(signal.SIGTERM)

    def _look(self, timeout: float | None) -> int | None:
        if self.returncode is None and _readable(self._end, timeout):
            said = os.read(self._end, 64)
            os.close(self._end)
            # Without a word the server has been killed, and its programs with it.
            self.returncode = int(said) if said else -signal.SIGKILL
        return self.returncode


def _readable(descriptor: int, timeout: float | None) -> bool:
    waiting = select.poll()
    waiting.register(descriptor, select.POLLIN)
    return bool(waiting.poll(None if timeout is None else timeout * 1000))


def start(
    args: Sequence[str],
    *,
    env: Mapping[str, str],
    cwd: str | os.PathLike[str] | None,
    **options: Any,
) -> Any:
    """Start `python -m MODULE ...`, `python -c CODE ...` or `python FILE ...`, as
    `subprocess.Popen` does with the same options."""
    known = args[0] == sys.executable and (args[1][0] != "-" or args[1] in ("-m", "-c"))
    same = _of_the_start(env) == _of_the_start(_ENVIRONMENT)
    if known and same and hasattr(os, "pidfd_open"):
        return Program(args, env, cwd)
    return subprocess.Popen(args, env=env, cwd=cwd, **options)


def _of_the_start(env: Mapping[str, str]) -> set[tuple[str, str]]:
    return {
        (name, value)
        for name, value in env.items()
        if name.startswith(AT_THE_START) and name not in ("PYTHONFAULTHANDLER", "PYTHONPATH")
    }


@cache
def _link() -> socket.socket:
    """The server of this process, which ends when this end of the socket is closed."""
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    with theirs:
        server = subprocess.Popen(
            [sys.executable, __file__, str(theirs.fileno())],
            env={**_ENVIRONMENT, "OPENBLAS_NUM_THREADS": "1"},  # a fork has no other threads
            pass_fds=[theirs.fileno()],
            stdin=subprocess.PIPE,  # as programs have it, whose streams Python makes beforehand
            stdout=subprocess.PIPE,
            start_new_session=True,
        )

    def end() -> None:
        ours.close()
        for pipe in (server.stdin, server.stdout):
            assert pipe is not None
            pipe.close()
        server.wait()

    atexit.register(end)
    return ours


# -- the server -----------------------------------------------------------------------------------


def _import_all() -> None:
    from yarpy.cli.main import find_verb
    from yarpy.cli.verb_list import VERBS
    from yarpy.errors import UnknownPlugin

    for verb in VERBS:
        with contextlib.suppress(UnknownPlugin):  # of a kit that is not in this copy
            find_verb(verb)
    for room in ROOMS:
        package = importlib.import_module(f"yarpy.{room}")
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            importlib.import_module(module.name)


def _serve(link: socket.socket) -> tuple[dict[str, Any], list[int]] | None:
    """Fork programs until nobody wants any more; in a program, return what it is to be."""
    programs: dict[int, tuple[int, int]] = {}  # by the descriptor of each: its pid, where it ends
    waiting = select.poll()
    waiting.register(link, select.POLLIN)
    while True:
        for ready, _ in waiting.poll():
            if ready != link.fileno():
                waiting.unregister(ready)
                os.close(ready)
                pid, status = programs.pop(ready)
                code = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
                with contextlib.suppress(BrokenPipeError):  # nobody asks
                    os.write(status, str(code).encode())
                os.close(status)
                continue
            request, descriptors, _, _ = socket.recv_fds(link, LARGEST, 4)
            if not request:
                for pid, _ in programs.values():
                    os.kill(pid, signal.SIGKILL)
                return None
            pid = os.fork()
            if not pid:
                for program, (_, status) in programs.items():
                    os.close(program)
                    os.close(status)
                os.close(descriptors.pop())
                link.close()
                return json.loads(request), descriptors
            link.send(str(pid).encode())
            program = os.pidfd_open(pid)
            programs[program] = pid, descriptors.pop()
            waiting.register(program, select.POLLIN)
            for descriptor in descriptors:
                os.close(descriptor)


def _become(request: dict[str, Any], descriptors: list[int]) -> None:
    """Be the program that is wished for, to its end."""
    os.setsid()
    for number, descriptor in enumerate(descriptors):
        os.dup2(descriptor, number)
        os.close(descriptor)
    os.chdir(request["cwd"])
    os.environ.clear()
    os.environ.update(request["env"])
    faulthandler.enable()
    what, *words = request["args"]
    wanted = request["env"].get("PYTHONPATH", "")
    sys.path[:0] = ["", *filter(None, wanted.split(os.pathsep))]
    if what == "-m":
        sys.path[0], sys.argv = request["cwd"], words
        runpy.run_module(words[0], run_name="__main__", alter_sys=True)
        return
    # As Python does it: names of the program are those of this module, and live as long.
    code, names = "", vars(sys.modules["__main__"])
    if what == "-c":
        code, file = words.pop(0), "<string>"
    else:
        file, sys.path[0] = what, os.path.dirname(os.path.abspath(what))
        with open(what, encoding="utf-8") as script:
            code = script.read()
    sys.argv = [what, *words]
    for name in [name for name in names if not name.startswith("__")]:
        del names[name]
    if what == "-c":
        del names["__file__"]
    else:
        names["__file__"] = file
    exec(compile(code, file, "exec"), names)


if __name__ == "__main__":
    del sys.path[0]  # files here have the names of libraries
    _import_all()
    gc.freeze()  # programs share it
    wished = _serve(socket.socket(fileno=int(sys.argv[1])))
    if wished is not None:
        _become(*wished)
