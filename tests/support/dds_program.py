"""Programs of another kind that speak DDS, which do what a test tells them."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

from support import dds_node, dds_peer
from support.process import Process


class Peer(Process):
    """The program `support/dds_peer.py`, which does what it is told."""

    def __init__(self) -> None:
        super().__init__([sys.executable, "-P", str(Path(dds_peer.__file__)), "obey"])
        self.wait_line("ready", stream="out")
        self._asked = 0

    def do(self, *words: object) -> list[object]:
        self._asked += 1
        self.write_line(json.dumps(words))
        found = self.wait_line(r'^\["done".*$', stream="out", count=self._asked)
        answer: list[object] = json.loads(found.string)[2]
        return answer

    def heard(self, name: str) -> list[str]:
        rows = [json.loads(line) for line in self.stdout.splitlines()]
        return [row[2] for row in rows if row[:2] == ["heard", name]]


class NodePeer(Process):
    """The program `support/dds_node.py`, which does what it is told."""

    def __init__(self) -> None:
        super().__init__([sys.executable, "-P", str(Path(dds_node.__file__))])
        self.wait_line("ready", stream="out")
        self._asked = 0

    def do(self, *words: object) -> Any:
        """Have something done; return what it found."""
        self.begin(*words)
        return self.end()

    def begin(self, *words: object) -> None:
        self._asked += 1
        self.write_line(json.dumps(words))

    def end(self) -> Any:
        found = self.wait_line(r'^\["done".*$', stream="out", count=self._asked)
        return json.loads(found.string)[2]
