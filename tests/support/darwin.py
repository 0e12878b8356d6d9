"""Let yarpy and its tests see macOS where Linux is: `make macos`.

    YARPY_TESTS_AS=darwin PYTHONPATH=tests python -m pytest -p support.darwin tests/port

What they import of the standard library lacks what typeshed, the description of it that mypy
brings, says macOS lacks; `sys.platform` is darwin; there is no /proc, /sys, /dev/shm; the path of a
Unix socket has 103 bytes and begins with no zero; a process of `multiprocessing` is spawned.

Rules: only files of this repository see it: the standard library and others go on as on Linux. The
kernel is Linux, so what macOS does otherwise (kqueue, socket buffers) is not met, nor what it alone
has. Programs that tests start are of Linux. It begins when this module is imported, which `-p` does
before the plugin of yarpy itself.
"""

from __future__ import annotations

import ast
import builtins
import errno
import importlib.util
import multiprocessing
import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from types import FrameType, ModuleType, SimpleNamespace
from typing import Any, Final

ASKED: Final = os.environ.get("YARPY_TESTS_AS") == "darwin"
ROOT: Final = str(Path(__file__).parents[2]) + os.sep
SOURCE: Final = ROOT + "src" + os.sep
MODULES: Final = ("errno", "fcntl", "mmap", "os", "resource", "select", "signal", "socket", "time")
LINUX_ONLY: Final = ("/proc", "/sys", "/dev/shm")
UNIX_PATH: Final = 103  # bytes: `sun_path` has 104, with a zero at its end
# It reads structures of this kernel's own C library.
OF_THE_KERNEL: Final = SOURCE + os.path.join("yarpy", "names", "address.py")


def _names(body: Sequence[ast.stmt], platform: str) -> Iterator[str]:
    """What a stub declares for a platform and this Python."""
    seen = {"sys": SimpleNamespace(platform=platform, version_info=sys.version_info)}
    for statement in body:
        match statement:
            case ast.If():
                code = compile(ast.Expression(statement.test), "typeshed", "eval")
                yield from _names(
                    statement.body if eval(code, seen) else statement.orelse, platform
                )
            case ast.FunctionDef() | ast.ClassDef():
                yield statement.name
            case ast.AnnAssign(target=ast.Name(id=name)):
                yield name
            case ast.Assign(targets=[ast.Name(id=name)]):
                yield name
            case ast.ImportFrom():
                yield from (one.asname or one.name for one in statement.names)


def lacking(module: str) -> frozenset[str]:
    """Return what a module of the standard library has on Linux and lacks on macOS."""
    spec = importlib.util.find_spec("mypy")
    assert spec is not None and spec.origin is not None, "mypy brings typeshed"
    stubs = Path(spec.origin).parent / "typeshed/stdlib"
    alone = stubs / f"{module}.pyi"
    stub = alone if alone.exists() else stubs / module / "__init__.pyi"
    body = ast.parse(stub.read_text("utf-8")).body
    return frozenset(_names(body, "linux")) - frozenset(_names(body, "darwin"))


class Seen(ModuleType):
    """A module without some of its names, and with some of its own; all else is the real one's."""

    def __init__(self, real: ModuleType, without: frozenset[str], **own: object) -> None:
        for name, value in {**own, "_real": real, "_without": without, "_own": own}.items():
            object.__setattr__(self, name, value)

    @property
    def __dict__(self) -> dict[str, object]:  # type: ignore[override]
        """What whoever replaces a name for a while puts back."""
        return {**vars(self._real), **self._own}

    def __getattr__(self, name: str) -> Any:
        if name in self._without:
            raise AttributeError(f"macOS has no {self._real.__name__}.{name}")
        return getattr(self._real, name)

    def __setattr__(self, name: str, value: object) -> None:
        if name in self._own:
            object.__setattr__(self, name, value)
        else:
            setattr(self._real, name, value)

    def __delattr__(self, name: str) -> None:
        delattr(self._real, name)

    def __dir__(self) -> list[str]:
        return sorted({*dir(self._real)} - self._without)


def _audit(event: str, words: tuple[object, ...]) -> None:
    """What the system itself refuses."""
    if event in ("socket.bind", "socket.connect"):
        path = words[1]
        if isinstance(path, str | bytes):
            told = os.fsencode(path)
            if told[:1] == b"\0":
                raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT))
            if len(told) > UNIX_PATH:
                raise OSError("AF_UNIX path too long")
    elif event in ("open", "os.listdir", "os.scandir"):
        path = words[0]
        if isinstance(path, str) and path.startswith(LINUX_ONLY) and _asked_by_us():
            raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), path)


def _asked_by_us() -> bool:
    """Whether the next one above the standard library is yarpy."""
    frame: FrameType | None = sys._getframe(2)
    while frame is not None:
        file = frame.f_code.co_filename
        if file.startswith(ROOT) or "site-packages" in file:
            return file.startswith(SOURCE)
        frame = frame.f_back
    return False


def _hide_from_stat() -> None:
    """Asking whether a file exists is no event that an audit hook hears of."""
    real = os.stat

    def stat(path: Any, *words: Any, **named: Any) -> os.stat_result:
        told = os.fspath(path) if isinstance(path, os.PathLike) else path
        if isinstance(told, str) and told.startswith(LINUX_ONLY) and _asked_by_us():
            raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), told)
        return real(path, *words, **named)

    os.stat = stat
    for able in (os.supports_dir_fd, os.supports_fd, os.supports_follow_symlinks):
        if real in able:
            able.add(stat)


def pretend() -> None:
    """Begin, for the rest of this process."""
    seen: dict[str, ModuleType] = {
        name: Seen(importlib.import_module(name), lacking(name)) for name in MODULES
    }
    seen["sys"] = Seen(sys, frozenset(), platform="darwin")
    real = builtins.__import__

    def of_darwin(
        name: str,
        globals: Mapping[str, object] | None = None,
        locals: Mapping[str, object] | None = None,
        fromlist: Sequence[str] | None = (),
        level: int = 0,
    ) -> ModuleType:
        module = real(name, globals, locals, fromlist or (), level)
        asker = str((globals or {}).get("__file__"))
        ours = asker.startswith(ROOT) and "site-packages" not in asker
        if ours and asker not in (__file__, OF_THE_KERNEL):
            return seen.get(module.__name__, module)
        return module

    builtins.__import__ = of_darwin
    sys.addaudithook(_audit)
    _hide_from_stat()
    multiprocessing.set_start_method("spawn")


if ASKED:
    pretend()
