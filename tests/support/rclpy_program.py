"""The program `rclpy_node.py`, a node of ROS 2 itself on this computer alone."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from support import rclpy_venv
from support.process import Process
from support.wait import HANG

PROGRAM = Path(rclpy_venv.__file__).with_name("rclpy_node.py")


class Rclpy(Process):
    """The program `support/rclpy_node.py`, which does what it is told."""

    def __init__(self, name: str) -> None:
        python = rclpy_venv.prepare()
        super().__init__(
            [str(python), "-P", str(PROGRAM), name],
            env={
                "PATH": str(python.parent),
                "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
                "ROS_LOG_DIR": str(python.parent.parent / "log"),
            },
        )
        self.name = f"/{name}"
        self.wait_line("ready", stream="out", timeout=HANG)
        self._asked = 0

    def do(self, *words: object) -> Any:
        """Have something done; return what it found."""
        self._asked += 1
        self.write_line(json.dumps(words))
        found = self.wait_line(r'^\["done".*$', stream="out", count=self._asked, timeout=HANG)
        return json.loads(found.string)[2]

    def heard(self, topic: str) -> list[str]:
        rows = [json.loads(line) for line in self.stdout.splitlines()]
        return [row[2] for row in rows if row[:2] == ["heard", topic]]
