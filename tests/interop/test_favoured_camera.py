"""Two image streams into one `yarpy view`: the connections say who wins, no program knows of it."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pytest
from support.command_line import CommandLine
from support.wait import HANG, wait_until

import yarpy
from yarpy.network import sampling

RED, BLUE = (255, 0, 0), (0, 0, 255)


@pytest.fixture
def cli(tmp_path) -> Iterator[CommandLine]:
    with yarpy.NameServer() as server:
        yield CommandLine(tmp_path, server.environment)


@contextmanager
def filming(name: str, colour: tuple[int, int, int]) -> Iterator[yarpy.Port]:
    """A camera that always sees one colour, 20 times a second."""
    image = yarpy.Image(np.full((24, 32, 3), colour, "u1"))
    over = threading.Event()
    with yarpy.BufferedPort(name) as port:

        def film() -> None:
            while not over.wait(0.05):
                port.write(image)

        thread = threading.Thread(target=film, daemon=True)
        thread.start()
        try:
            yield port
        finally:
            over.set()
            thread.join(HANG)


class Watcher:
    """Who looks at what /view shows: the stream that its page has in it."""

    def __init__(self) -> None:
        self.seen: list[str] = []
        self.port = yarpy.BufferedPort("/watcher", callback=self.look)
        self.port.connect("/view", "mjpeg")

    def look(self, message: yarpy.Message) -> None:
        pixel = np.asarray(message.as_(yarpy.Image))[12, 16].astype(int)
        self.seen.append("red" if pixel[0] > 128 > pixel[2] else "blue" if pixel[2] > 128 else "?")

    def sees(self, colour: str) -> None:
        """Only this colour comes, for a while; the last pictures of before may still be shown."""

        def only() -> bool:
            del self.seen[:]
            time.sleep(0.5)
            return len(self.seen) >= 3 and set(self.seen) == {colour}

        wait_until(only, HANG, f"{colour} alone is shown")


def test_rules_favour_one_and_a_message_flips_them(cli) -> None:
    with (
        cli.start("view", "/view", "--no-browser") as view,
        filming("/red", RED) as red,
        filming("/blue", BLUE),
    ):
        view.wait_line("is shown at", stream="out", timeout=HANG)
        yarpy.connect("/red", "/view", "tcp+recv.priority+st.10+tc.1+bs.10")
        yarpy.connect("/blue", "/view", "tcp+recv.priority+st.10+tc.1+bs.5")
        watcher = Watcher()
        with watcher.port:
            watcher.sees("red")
            reply = yarpy.admin("/view", "set", "in", "/blue", ["bs", 2.0])
            assert reply[0] == 0
            watcher.sees("blue")
            flows = {flow.source: flow for flow in sampling.flows()}
            loser = flows["/red"].receiver
            assert loser is not None
            assert loser.monitors == ["priority"]
            assert (loser.drops or 0) >= 3
            assert flows["/blue"].receiver.parameters["bs"] == 2.0
            assert loser.state["winner"] == "/blue"
            yarpy.disconnect("/blue", "/view")
            watcher.sees("red")
        assert red.outputs[0].carrier == "tcp+recv.priority+st.10+tc.1+bs.10"
