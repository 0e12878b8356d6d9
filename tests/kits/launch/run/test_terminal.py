"""A terminal for a program on another computer: tests/kits/launch/verbs/test_run.py has a whole
one."""

import threading
from collections.abc import Callable, Iterator

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.errors import UnknownName
from yarpy.kits.launch.run import terminal
from yarpy.testing import private_names

UUID = "/node/1/x-1"


@pytest.fixture(autouse=True)
def _alone(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Names of this test, and nobody who types."""
    monkeypatch.setattr(terminal, "_type", lambda port: None)
    with private_names():
        yield


@pytest.fixture
def stdout() -> Iterator[yarpy.Port]:
    """What the program says; it is told something as well."""
    with (
        yarpy.Port(f"{UUID}/stdout") as port,
        yarpy.Port(f"{UUID}/stdin", callback=lambda message: None),
    ):
        yield port


def ended(stdout: yarpy.Port, *lines: str) -> None:
    """Say the last lines and end, and wait until the terminal knows that."""
    for line in lines:
        stdout.write([f"{line}\n"])
    stdout.close()
    asked = f"{UUID}/stdio:i", "list", "in"
    wait_until(lambda: stdout.name not in yarpy.admin(*asked, timeout=HANG).to_text())


def attached() -> list[str]:
    """Return what a terminal shows until its end."""
    shown: list[str] = []
    patch = pytest.MonkeyPatch()
    patch.setattr(terminal, "_print", shown.append)
    try:
        thread = threading.Thread(target=terminal.attach, args=(UUID,), daemon=True)
        thread.start()
        thread.join(HANG)
    finally:
        patch.undo()
    assert not thread.is_alive()
    return shown


def test_there_is_no_such_program() -> None:
    with pytest.raises(UnknownName):
        terminal.attach(UUID)


def test_what_was_said_last_is_shown_though_the_end_is_known(
    stdout: yarpy.Port, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown: list[str] = []
    over = threading.Event()

    def show(text: str) -> None:
        assert shown or over.wait(HANG)
        shown.append(text)

    def end() -> None:
        assert stdout.wait_for_outputs(timeout=HANG)
        ended(stdout, "one", "two", "three")
        over.set()

    monkeypatch.setattr(terminal, "_print", show)
    program = threading.Thread(target=end)
    program.start()
    assert terminal.attach(UUID) == 0
    program.join(HANG)
    assert shown == ["one\n", "two\n", "three\n"]


def test_one_that_ends_while_its_terminal_comes(
    stdout: yarpy.Port, monkeypatch: pytest.MonkeyPatch
) -> None:
    connect: Callable[..., object] = yarpy.connect

    def connect_and_end(*ends: str) -> None:
        connect(*ends)
        if stdout.name in ends:
            ended(stdout, "bye")

    monkeypatch.setattr(yarpy, "connect", connect_and_end)
    assert attached() == ["bye\n"]
