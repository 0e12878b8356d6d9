"""What has ports and threads open until it is closed, as all servers and clients of devices do."""

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
        """Close the ports, and end what runs for them. Idempotent."""
        self._resources.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()


def prefix(name: str) -> str:
    """The name of a device as ports begin with it: one slash before, none behind."""
    return "/" + name.strip("/")


def local_prefix(local: str, remote: str) -> str:
    """The prefix of a client's own ports: `local`, or one that nobody else has."""
    return prefix(local or f"yarpy/{os.getpid()}-{next(_numbers)}{remote}")
