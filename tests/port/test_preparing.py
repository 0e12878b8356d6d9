"""Preparing: arrays that a program fills where its readers look at them, and passes on so."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.process import Process
from support.wait import HANG, wait_until

import yarpy
from yarpy.port import preparing
from yarpy.transports.shared.arena import arena_of
from yarpy.transports.shared.sealed import available
from yarpy.transports.shared.shared_array import HEADROOM, shared_array_type

ECHO = """
import yarpy
came, out = yarpy.BufferedPort("/echo/in", strict=True), yarpy.Port("/echo/out")
print("open", flush=True)
for message in came:
    out.write(message.value)
    del message
"""

shares = pytest.mark.skipif(not available(), reason="this system has no such memory")


@pytest.fixture
def server(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[yarpy.NameServer]:
    with yarpy.NameServer() as server:
        for key, value in server.environment.items():
            monkeypatch.setenv(key, value)
        yield server


@pytest.mark.parametrize(
    ("shape", "dtype", "error"),
    [
        ((300, 300), object, TypeError),
        (9, [("a", "u1"), ("b", object)], TypeError),
        (("a", 3), "u1", TypeError),
        (3.5, "u1", TypeError),
        ((-1, 30_000), "u1", ValueError),
    ],
)
def test_what_cannot_be_prepared(shape: Any, dtype: Any, error: type[Exception]) -> None:
    """Python's objects would be pointers of this process."""
    with yarpy.Port("/out", names=yarpy.LocalNames()) as out, pytest.raises(error):
        out.prepare(shape, dtype)


@pytest.mark.parametrize("carrier", ["tcp", "memory"])
def test_received_pictures_stay_what_they_are(
    carrier: str, server: yarpy.NameServer, tmp_path: Path
) -> None:
    """Of each only the array is kept; over memory, more of them than find room there."""
    with (
        yarpy.Port("/pictures/out") as out,
        yarpy.BufferedPort("/pictures/in", strict=True) as in_,
    ):
        out.connect("/pictures/in", carrier)
        kept = []
        for number in range(300):
            out.write(np.full((60, 100, 3), number % 256, "u1"))
            message = in_.read(timeout=HANG)
            assert message is not None
            kept.append(message.value.array)
            del message
        assert [int(array[7, 7, 1]) for array in kept] == [n % 256 for n in range(300)]


@pytest.mark.parametrize("here", [True, False])
def test_an_array_to_fill(here: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same wherever it lies."""
    if not here:
        monkeypatch.setattr(preparing, "available", lambda: False)
    names = yarpy.LocalNames()
    with yarpy.Port("/out", names=names) as out:
        for shape, dtype in [((10, 20, 3), "u1"), ((300, 300), np.uint16), (100000, float)]:
            array = out.prepare(shape, dtype)
            assert array.shape == (shape if isinstance(shape, tuple) else (shape,))
            assert (type(array), array.dtype) == (np.ndarray, np.dtype(dtype))
            array[...] = 5
            part = array[1:]
            out.write(part)
            with pytest.raises(ValueError, match="read-only"):
                part[0] = 1
        with yarpy.BufferedPort("/in", names=names) as came:
            out.connect("/in")
            array = out.prepare((300, 304))
            array[...] = 7
            out.write(yarpy.Image(array))
            with pytest.raises(ValueError, match="read-only"):
                array[0, 0] = 1
            assert (came.read(5).value.array == 7).all()
            out.write(array)  # once more, as it is
            assert (came.read(5).value.array == 7).all()
        with pytest.raises(TypeError):
            out.prepare("many")  # type: ignore[arg-type]
        with pytest.raises(ValueError, match="negative"):
            out.prepare((-1, 5))
    with pytest.raises(yarpy.PortClosed):
        out.prepare(5)


@shares
def test_without_room_it_is_memory_of_our_own(monkeypatch: pytest.MonkeyPatch) -> None:
    from yarpy.transports.shared import arena

    monkeypatch.setattr(arena.Arena.__init__, "__defaults__", (1 << 20,))
    with yarpy.Port("/out", names=yarpy.LocalNames()) as out:
        kept = [out.prepare(300_000) for _ in range(10)]
        for number, array in enumerate(kept):
            array[...] = number
        assert [int(array.sum()) for array in kept] == [300_000 * n for n in range(10)]


@shares
def test_the_memory_ends_with_the_port() -> None:
    """Not with the garbage collector."""
    with yarpy.Port("/out", names=yarpy.LocalNames()) as out:
        out.prepare(300_000)
        number = arena_of("/out").number
    with pytest.raises(OSError):
        os.fstat(number)


@shares
def test_there_and_back_without_a_copy(
    server: yarpy.NameServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A program fills memory, another passes it on, and nobody copies it."""
    from yarpy.transports.shared import arena

    copied: list[int] = []
    monkeypatch.setattr(arena, "_copy", lambda room, block: copied.append(len(block)))
    with (
        Process([sys.executable, "-c", ECHO], env=os.environ) as echo,
        yarpy.Port("/out") as out,
        yarpy.BufferedPort("/in") as came,
    ):
        echo.wait_line("^open$")
        assert out.connect("/echo/in").carrier == "memory"
        assert yarpy.connect("/echo/out", "/in").carrier == "memory"
        arena_ = arena_of("/out")
        for number in range(20):
            array = out.prepare((500, 400))
            array[...] = number
            out.write(array)
            message = came.read(10)
            found = message.as_(yarpy.Image).array
            assert (found == number).all()
            # Only who looks at the very same memory sees what its writer does against the rules.
            assert isinstance(array.base, shared_array_type())
            arena_.view[array.base.offset + HEADROOM] = 200
            assert found[0, 0] == 200
            del found, message
        assert copied == []
        del array
        wait_until(lambda: len(arena_._spans) <= 3)  # all others were used again


@shares
def test_who_passes_on_may_be_killed(server: yarpy.NameServer) -> None:
    """What others look at by then stays as it is, and comes back after that."""
    with (
        Process([sys.executable, "-c", ECHO], env=os.environ) as echo,
        yarpy.Port("/out") as out,
        yarpy.BufferedPort("/in") as came,
    ):
        echo.wait_line("^open$")
        out.connect("/echo/in")
        yarpy.connect("/echo/out", "/in")
        arena = arena_of("/out")
        array = out.prepare((500, 400))
        array[...] = 1
        out.write(array)
        del array
        message = came.read(10)
        os.kill(echo.pid, signal.SIGKILL)
        echo.wait()
        wait_until(lambda: not out.outputs and not came.inputs)
        assert arena.used == 1
        for _ in range(5):
            out.prepare((500, 400))[...] = 2
        assert (message.value.array == 1).all()
        del message
        wait_until(lambda: arena.used == 0)


@shares
def test_a_forked_process_gives_back_nothing_of_its_parent() -> None:
    """What waits in a port there is dropped there alone."""
    names = yarpy.LocalNames()
    with (
        yarpy.Port("/out", names=names) as out,
        yarpy.BufferedPort("/in", names=names, strict=True) as came,
    ):
        out.connect("/in", "memory")
        for number in range(3):
            out.write(np.full((400, 400), number, np.uint8))
        wait_until(lambda: came.waiting == 3)
        child = os.fork()
        if not child:
            os._exit(0)
        assert os.waitpid(child, 0)[1] == 0
        assert arena_of("/out").used == 3
        for number in range(3):
            assert (came.read(5).value.array == number).all()
