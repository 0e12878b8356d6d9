"""Buffered ports: writing does not wait, and what it does not send it counts."""

from collections.abc import Iterator

import numpy as np
import pytest

import yarpy


@pytest.fixture
def names() -> yarpy.LocalNames:
    return yarpy.LocalNames()


@pytest.fixture
def ports(names: yarpy.LocalNames) -> Iterator[tuple[yarpy.BufferedPort, yarpy.BufferedPort]]:
    """A writer connected to a reader that keeps every message."""
    with (
        yarpy.BufferedPort("/writer", names=names) as writer,
        yarpy.BufferedPort("/reader", strict=True, names=names) as reader,
    ):
        writer.connect("/reader")
        yield writer, reader


def test_what_cannot_be_sent_is_the_writers_error_and_the_connection_goes_on(ports):
    writer, reader = ports
    for bad in (object(), [1, object()], {"key": object()}):
        with pytest.raises(TypeError):
            writer.write(bad)
    assert writer.write([1]) == 1
    assert reader.read(timeout=5).value == [1]


def test_a_list_may_be_changed_after_writing(ports):
    writer, reader = ports
    for number in range(50):
        numbers = [number] * 100
        assert writer.write(numbers) == 1
        numbers[:] = [-1] * 100
        assert reader.read(timeout=5).value == [number] * 100
        writer.flush(timeout=5)


def test_an_array_may_be_changed_after_writing(ports):
    """Also when it leaves later, in the thread of its connection, and is too large to be copied."""
    writer, reader = ports
    for turn in range(20):
        image = np.full((200, 200), turn, np.uint8)
        assert writer.write(image) == 1
        image[:] = 255
        assert int(reader.read(timeout=5).value.array.max()) == turn
        writer.flush(timeout=5)
