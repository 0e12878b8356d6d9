"""A recording with its server."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from support.recordings import START, STEP, payload_of
from support.wait import wait_until

import yarpy
from yarpy.kits.record.mcap.writer import McapWriter
from yarpy.kits.record.view.server import View
from yarpy.kits.record.view.source import FileSource


@pytest.fixture
def view(tmp_path: Path) -> Iterator[View]:
    """100 messages of /a, 10 ms apart; ten pictures of /cam."""
    with McapWriter(tmp_path / "x.mcap") as writer:
        for n in range(100):
            writer.add("/a", f"{n} {n}.5", START + n * STEP, payload_of([n, 0.5]))
            if n % 10 == 0:
                image = yarpy.Image(np.full((4, 6, 3), n, "u1"))
                writer.add("/cam", "", START + n * STEP, payload_of(image))
    with FileSource([tmp_path / "x.mcap"]) as source, View(source, port=0) as found:
        wait_until(lambda: source.seen == 1)
        yield found
