"""A link that can be cut, and a disk that is full: what only root may make, in places of their own.

Rules: a network namespace and a pair of virtual interfaces with the number of this process in their
names; a file system in memory. All are gone afterwards.
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

#: Our end of the link, and the other one.
HERE: Final = "10.231.77.1"
THERE: Final = "10.231.77.2"


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
        _run("ip", "link", "set", self._interface, "down")

    def mend(self) -> None:
        _run("ip", "link", "set", self._interface, "up")

    @property
    def inside(self) -> tuple[str, ...]:
        """What to put before a command that is to run there."""
        return "ip", "netns", "exec", self.name


def _needs_root(program: str) -> None:
    if os.geteuid():
        raise Missing("it takes root")
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
        found = Link(name, near)
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
