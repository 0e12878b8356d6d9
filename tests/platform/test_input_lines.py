"""Lines of standard input, and signals that end the wait for them."""

from __future__ import annotations

import io
import os
import signal
import sys
from collections.abc import Iterator

import pytest
from support.main_signal import signalled

from yarpy.platform.input_lines import AHEAD, lines


class Asked(Exception):
    """What a signal handler raises."""


@pytest.fixture
def pipe(monkeypatch: pytest.MonkeyPatch) -> Iterator[io.TextIOWrapper]:
    """A pipe whose reader is standard input; its writer."""
    reading, writing = os.pipe()
    with open(reading, encoding="utf-8") as source:  # a thread that reads it ends with its writer
        monkeypatch.setattr(sys, "stdin", source)
        with open(writing, "w", encoding="utf-8", buffering=1) as end:
            yield end


def test_lines_come_with_their_ends(pipe: io.TextIOWrapper) -> None:
    found = lines()
    pipe.write("one\n")
    assert next(found) == "one\n"
    pipe.write("two\n\nno end")
    pipe.close()
    assert [*found] == ["two\n", "\n", "no end"]


def test_more_than_are_read_ahead(monkeypatch: pytest.MonkeyPatch) -> None:
    all_of_it = [f"{number}\n" for number in range(3 * AHEAD)]
    monkeypatch.setattr(sys, "stdin", io.StringIO("".join(all_of_it)))
    assert [*lines()] == all_of_it


def test_no_standard_input(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", None)
    assert [*lines()] == []


def test_what_reading_raises(monkeypatch: pytest.MonkeyPatch) -> None:
    closed = io.StringIO("x\n")
    closed.close()
    monkeypatch.setattr(sys, "stdin", closed)
    with pytest.raises(ValueError, match="closed"):
        next(lines())


@pytest.mark.parametrize("number", ["SIGINT", "SIGTERM", "SIGBREAK"])
def test_a_signal_ends_the_wait_for_a_line(number: str, pipe: io.TextIOWrapper) -> None:
    """A read of a pipe goes on on Windows: it was for ever."""
    if not hasattr(signal, number):
        pytest.skip(f"{sys.platform} has no {number}")

    def asked() -> None:
        raise Asked

    found = lines()
    pipe.write("one\n")
    assert next(found) == "one\n"
    with signalled("lines", getattr(signal, number), asked), pytest.raises(Asked):
        next(found)
