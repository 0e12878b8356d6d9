"""Foreign programs that tests meet: which there are, whether they are here, who may use them.

    @pytest.mark.peer("curl")            # on a test, a parameter, or as `pytestmark`
    @brings("ros")                       # below @pytest.fixture: whoever uses the fixture needs it
    curl = program("curl")               # its path

Rules: a test that meets a foreign program declares it, by the marker or by a fixture; `make test`
takes the tests that declare none, `make peers` the others, whatever is installed. So `make test`
means the same everywhere: a test that declares nothing does not find foreign programs on its PATH,
and `demand` fails it where it comes to one in another way. Each peer is looked for once a run;
where it is missing its tests skip, and say what to install. What `pip install 'yarpy[test]'` brings
is no peer.
"""

from __future__ import annotations

import atexit
import ctypes.util
import importlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterable
from functools import cache
from pathlib import Path
from typing import Any, Final, TypeVar

import pytest
from support import (
    cpp_venv,
    namespace,
    rclpy_venv,
    thrift_venv,
    windows,
    wrapyfi_plugins_venv,
    wrapyfi_venv,
)
from support.file_lock import hold
from support.peer_venv import MissingPeer

PATH: Final = os.environ.get("PATH", os.defpath)  # of who started the tests

DEBIAN_PYTHON = Path("/usr/bin/python3")  # the one that Debian's packages of ROS and torch are for
# What every system has, and tests without peers may start.
EVERYWHERE = (
    *("sh", "bash", "cat", "cut", "echo", "env", "false", "git", "grep", "head", "kill", "ls"),
    *(
        "mkdir",
        "mount",
        "rm",
        "sed",
        "sleep",
        "sort",
        "stty",
        "tail",
        "taskset",
        "tee",
        "test",
        "touch",
    ),
    *("tr", "true", "umount", "wc"),
)
_PLACES = ("/usr/local/bin", "/usr/bin", "/bin", "/usr/local/sbin", "/usr/sbin", "/sbin")
CHROMIUM = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")


def _find(name: str) -> str | None:
    return shutil.which(name, path=os.pathsep.join((PATH, *_PLACES)))


def _programs(*names: str, package: str) -> Callable[[], str]:
    """A peer that consists of these programs, in a package of Debian."""

    def look() -> str:
        missing = [name for name in names if _find(name) is None]
        return f"no {missing[0]}: apt-get install {package}" if missing else ""

    return look


def _files(*names: str, package: str) -> Callable[[], str]:
    def look() -> str:
        missing = [name for name in names if not Path(name).exists()]
        return f"no {missing[0]}: apt-get install {package}" if missing else ""

    return look


def _modules(*names: str, packages: str) -> Callable[[], str]:
    """A peer that consists of modules of Debian's own Python."""

    def look() -> str:
        command = [DEBIAN_PYTHON, "-c", f"import {', '.join(names)}"]
        try:
            done = subprocess.run(command, env={}, capture_output=True, text=True, timeout=120)
        except OSError as error:
            return f"{error}; apt-get install {packages}"
        said = done.stderr.strip().splitlines()
        return f"{said[-1]}: apt-get install {packages}" if done.returncode else ""

    return look


def _made(prepare: Callable[[], object]) -> Callable[[], str]:
    def look() -> str:
        try:
            prepare()
        except MissingPeer as missing:
            return str(missing)
        return ""

    return look


def _compiler() -> str:
    name = os.environ.get("CXX", "g++")
    return "" if _find(name) else f"no {name}: apt-get install g++, or name a compiler in CXX"


def _chromium() -> str:
    if not any(map(_find, CHROMIUM)):
        return "no Chromium: apt-get install chromium"
    return _importable("playwright", "pip install playwright")


def _portaudio() -> str:
    try:
        importlib.import_module("sounddevice")
    except (ImportError, OSError):
        return "no PortAudio: pip install sounddevice; apt-get install libportaudio2"
    return _files("/usr/share/alsa/alsa.conf", package="libasound2-data")()


def _torch() -> str:
    if not Path("/usr/lib/python3/dist-packages/torch").exists():
        return "no torch: apt-get install python3-torch"
    site = next(wrapyfi_venv.prepare().glob("lib/python*/site-packages"))
    if not DEBIAN_PYTHON.with_name(site.parent.name).exists():
        return f"torch is for another Python than {site.parent.name}, which runs the tests"
    return ""


def _gl() -> str:
    if ctypes.util.find_library("EGL"):
        return ""
    return "nothing can draw here: apt-get install libegl1 libgl1-mesa-dri"


def _importable(name: str, hint: str) -> str:
    try:
        importlib.import_module(name)
    except ImportError:
        return f"no {name}: {hint}"
    return ""


_ROS_TOOLS = ("rosmaster", "rostopic", "rosnode", "rosservice", "rosparam")
PEERS: dict[str, Callable[[], str]] = {
    "node": _programs("node", package="nodejs"),  # pyright runs on it
    "chromium": _chromium,
    "chrt": _programs("chrt", package="util-linux"),
    "cpp": _made(cpp_venv.prepare),
    "curl": _programs("curl", package="curl"),
    "fast_dds": _files("/usr/include/fastdds/dds/domain", package="libfastrtps-dev"),
    "ffmpeg": _programs("ffmpeg", package="ffmpeg"),
    "fish": _programs("fish", package="fish"),
    "g++": _compiler,
    "gl": _gl,
    "man": _programs("man", package="man-db"),
    "mosquitto": _programs(
        *("mosquitto", "mosquitto_sub", "mosquitto_pub", "mosquitto_rr"),
        package="mosquitto mosquitto-clients",
    ),
    "namespaces": namespace.why_not,
    "nc": _programs("nc", package="netcat-openbsd"),
    "nft": _programs("nft", package="nftables"),
    "openmpi": _programs("ompi-server", package="openmpi-bin"),
    "openssl": _programs("openssl", package="openssl"),
    "portaudio": _portaudio,
    "actionlib": _modules("actionlib", packages="python3-actionlib"),
    "dynamic_reconfigure": _modules(
        *("rospy", "dynamic_reconfigure.server", "dynamic_reconfigure.client"),
        packages="python3-dynamic-reconfigure",
    ),
    "rclpy": _made(rclpy_venv.prepare),
    "ros": _modules(
        *("rospy", "rosmsg", "std_msgs.msg", "sensor_msgs.msg"),
        packages="python3-rospy python3-rosmsg python3-std-msgs python3-sensor-msgs",
    ),
    "rosbag": _modules("rosbag", packages="python3-rosbag"),
    "roscpp": _files(
        *("/usr/lib/rosbag/record", "/usr/lib/topic_tools/relay"),
        package="python3-rosbag topic-tools",
    ),
    "rosmaster": _programs(*_ROS_TOOLS, package=" ".join(f"python3-{n}" for n in _ROS_TOOLS)),
    "tf2": _modules("tf2_py", "geometry_msgs.msg", packages="python3-tf2 python3-geometry-msgs"),
    "tf_echo": _files("/usr/lib/tf/tf_echo", package="tf-tools"),
    "image_view": _files("/usr/lib/image_view/image_saver", package="ros-image-view"),
    "thrift": _made(thrift_venv.prepare),
    "thrift_compiler": _programs("thrift", package="thrift-compiler"),
    "torch": _torch,
    "tsc": _programs("tsc", package="node-typescript"),
    "windows": _made(windows.prepare),
    "wrapyfi": _made(wrapyfi_venv.prepare),
    "wrapyfi_plugins": _made(wrapyfi_plugins_venv.ready),
    "wrk": _programs("wrk", package="wrk"),
    "zsh": _programs("zsh", package="zsh"),
}


_Function = TypeVar("_Function", bound=Callable[..., Any])


class _Now:
    """What the running test has declared; None between tests."""

    declared: frozenset[str] | None = None


def brings(*names: str) -> Callable[[_Function], _Function]:
    """Decorate the function of a fixture: a test that uses the fixture needs these peers."""

    def mark(function: _Function) -> _Function:
        function.peers = names  # type: ignore[attr-defined]
        return function

    return mark


def needed(item: pytest.Item) -> frozenset[str]:
    """The peers that a test declares, by its markers and by the fixtures that it uses."""
    found = {name for marker in item.iter_markers("peer") for name in marker.args}
    info = getattr(item, "_fixtureinfo", None)  # tells which fixtures a test uses, also indirectly
    for fixtures in info.name2fixturedefs.values() if info else ():
        for fixture in fixtures:
            found.update(getattr(fixture.func, "peers", ()))
    unknown = found - PEERS.keys()
    assert not unknown, f"{item.nodeid}: no peers {sorted(unknown)} in tests/support/peer.py"
    return frozenset(found)


def enter(names: Iterable[str]) -> None:
    """Begin a test that has declared these peers; skip it if one is missing."""
    _Now.declared = frozenset(names)
    os.environ["PATH"] = PATH if _Now.declared else _bare_path()
    for name in sorted(_Now.declared):
        reason = why_missing(name)
        if reason:
            pytest.skip(reason)


def leave() -> None:
    """End a test."""
    _Now.declared = None
    os.environ["PATH"] = PATH


def demand(*names: str) -> None:
    """Fail a test that comes here without having declared these peers."""
    for name in names:
        if _Now.declared is not None and name not in _Now.declared:
            pytest.fail(f'this test meets {name} without saying so: @pytest.mark.peer("{name}")')


def program(name: str, *, of: str = "") -> str:
    """The path of a program of a peer, which has the same name unless `of` says it."""
    demand(of or name)
    found = _find(name)
    assert found, f"{name} has gone"
    return found


def chromium() -> str:
    """The path of the installed Chromium."""
    demand("chromium")
    return next(filter(None, map(_find, CHROMIUM)))


@cache
def why_missing(name: str) -> str:
    """Why there is no such peer, and what to do; "" if it is here. The first to ask looks."""
    shared = os.environ.get("YARPY_TEST_PEERS")
    if shared is None:
        return PEERS[name]()
    with open(shared, "r+", encoding="utf-8") as file:
        hold(file)
        known: dict[str, str] = json.loads(file.read() or "{}")
        if name not in known:
            known[name] = PEERS[name]()
            file.seek(0)
            json.dump(known, file)
        return known[name]


def share() -> None:
    """Let all processes of a run share what they have found; called by the one that starts them."""
    number, path = tempfile.mkstemp(prefix="yarpy-peers-")
    os.close(number)
    atexit.register(os.unlink, path)
    os.environ["YARPY_TEST_PEERS"] = path


@cache
def _bare_path() -> str:
    """Python's programs and those that every system has."""
    folder = Path(tempfile.mkdtemp(prefix="yarpy-path-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    for name in EVERYWHERE:
        found = _find(name)
        if found:
            (folder / name).symlink_to(found)
    return os.pathsep.join((str(Path(sys.executable).parent), str(folder)))
