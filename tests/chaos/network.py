"""Links that are cut, hosts that die, a disk that is full: what only root may make, out of the way.

Rules: a network namespace and a pair of virtual interfaces with the number of this process in their
names and addresses, so that two processes of a test run do not meet; a file system in memory. All
are gone afterwards.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

#: The first three numbers of addresses that no other process of a test run has at the same time.
_OURS: Final = f"10.{100 + os.getpid() // 125 % 100}.{2 * (os.getpid() % 125)}"
_OTHERS: Final = f"10.{100 + os.getpid() // 125 % 100}.{2 * (os.getpid() % 125) + 1}"

#: Our end of the link, and the other one.
HERE: Final = f"{_OURS}.1"
THERE: Final = f"{_OURS}.2"

#: Our address in the network of the hosts that die.
AT_HOME: Final = f"{_OTHERS}.1"


class Missing(Exception):
    """This cannot be made here; the text says why."""


def _run(*command: str) -> None:
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise Missing(f"{' '.join(command[:4])}: {done.stderr.strip()}")


class Link:
    """A network namespace, `name`, at the other end of a link."""

    def __init__(self, name: str, interface: str) -> None:
        self.name = name
        self._interface = interface

    def cut(self) -> None:
        """Over there: with an interface of ours its route would go, and others might answer."""
        _run(*self.inside, "ip", "link", "set", self._interface, "down")

    def restore(self) -> None:
        _run(*self.inside, "ip", "link", "set", self._interface, "up")

    @property
    def inside(self) -> tuple[str, ...]:
        """What to put before a command that is to run there."""
        return "ip", "netns", "exec", self.name


def _needs_root(program: str) -> None:
    if not hasattr(os, "geteuid") or os.geteuid():
        raise Missing("it takes root of a Unix")
    if shutil.which(program) is None:
        raise Missing(f"there is no {program}")


@contextmanager
def link() -> Iterator[Link]:
    """A link to a namespace of its own."""
    _needs_root("ip")
    number = os.getpid()
    name, near, far = f"yarpy-chaos-{number}", f"yc{number}a", f"yc{number}b"
    _run("ip", "netns", "add", name)
    try:
        _run("ip", "link", "add", near, "type", "veth", "peer", "name", far, "netns", name)
        _run("ip", "addr", "add", f"{HERE}/24", "dev", near)
        _run("ip", "link", "set", near, "up")
        found = Link(name, far)
        for command in (
            ("ip", "addr", "add", f"{THERE}/24", "dev", far),
            ("ip", "link", "set", far, "up"),
            ("ip", "link", "set", "lo", "up"),
        ):
            _run(*found.inside, *command)
        yield found
    finally:
        subprocess.run(["ip", "netns", "del", name], capture_output=True)
        subprocess.run(["ip", "link", "del", near], capture_output=True)


class Host:
    """A network namespace on a switch, at `address`."""

    def __init__(self, name: str, address: str, plug: str) -> None:
        self.name = name
        self.address = address
        self._plug = plug

    def die(self) -> None:
        """Nothing comes from it or reaches it any more, and nobody is told."""
        _run("ip", "link", "set", self._plug, "down")

    def programs(self) -> list[int]:
        """The numbers of the processes there."""
        told = subprocess.run(["ip", "netns", "pids", self.name], capture_output=True, text=True)
        return [int(number) for number in told.stdout.split()]

    @property
    def inside(self) -> tuple[str, ...]:
        """What to put before a command that is to run there."""
        return "ip", "netns", "exec", self.name


@contextmanager
def hosts(count: int) -> Iterator[list[Host]]:
    """So many hosts, which share a switch with this one, AT_HOME."""
    _needs_root("ip")
    number = os.getpid()
    switch, names = f"yc{number}s", [f"yarpy-host-{number}-{i}" for i in range(count)]
    try:
        _run("ip", "link", "add", switch, "type", "bridge")
        _run("ip", "addr", "add", f"{AT_HOME}/24", "dev", switch)
        _run("ip", "link", "set", switch, "up")
        found = []
        for place, name in enumerate(names):
            plug, address = f"yc{number}p{place}", f"{_OTHERS}.{place + 2}"
            _run("ip", "netns", "add", name)
            _run("ip", "link", "add", plug, "type", "veth", "peer", "name", "eth0", "netns", name)
            _run("ip", "link", "set", plug, "master", switch)
            _run("ip", "link", "set", plug, "up")
            host = Host(name, address, plug)
            for command in (
                ("ip", "addr", "add", f"{address}/24", "dev", "eth0"),
                ("ip", "link", "set", "eth0", "up"),
                ("ip", "link", "set", "lo", "up"),
            ):
                _run(*host.inside, *command)
            found.append(host)
        yield found
    finally:
        for place, name in enumerate(names):
            subprocess.run(["ip", "link", "del", f"yc{number}p{place}"], capture_output=True)
            subprocess.run(["ip", "netns", "del", name], capture_output=True)
        subprocess.run(["ip", "link", "del", switch], capture_output=True)


@contextmanager
def small_disk() -> Iterator[Path]:
    """A directory on a disk of 512 kB."""
    _needs_root("mount")
    with tempfile.TemporaryDirectory(prefix="yarpy-chaos-") as where:
        _run("mount", "-t", "tmpfs", "-o", "size=512k", "tmpfs", where)
        try:
            yield Path(where)
        finally:
            _run("umount", where)


def fill(directory: Path) -> None:
    """Leave no byte free there."""
    with (directory / "filler").open("wb", buffering=0) as file:
        for size in (1 << 14, 1):
            try:
                while True:
                    file.write(bytes(size))
            except OSError:
                continue
