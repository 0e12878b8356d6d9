"""A base for servers and clients of devices, which hold ports and threads until closed."""

from __future__ import annotations

import os
from contextlib import ExitStack
from itertools import count
from typing import Self

_numbers = count(1)


class Closeable:
    """Closes what is on its stack, once. A context manager."""

    _resources: ExitStack

    def close(self) -> None:
        """Close the ports and end their threads. Idempotent."""
        self._resources.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()


def prefix(name: str) -> str:
    """The prefix of a device's port names: one leading slash, no trailing one."""
    return "/" + name.strip("/")


def local_prefix(local: str, remote: str) -> str:
    """The prefix of a client's own ports: `local`, or a unique one."""
    return prefix(local or f"yarpy/{os.getpid()}-{next(_numbers)}{remote}")
