"""`yarpy connect --of` and `yarpy disconnect --of`, at an application that is idle at first."""

from collections.abc import Callable, Iterator

import pytest

import yarpy
from yarpy.kits.launch.application.application import Application, Connection
from yarpy.kits.launch.console.control import Control
from yarpy.kits.launch.console.service import answer
from yarpy.kits.launch.supervise.supervisor import Supervisor
from yarpy.kits.launch.verbs import join


@pytest.fixture
def names() -> yarpy.LocalNames:
    return yarpy.LocalNames()


@pytest.fixture
def running(here, runtime, names: yarpy.LocalNames) -> Iterator[str]:
    """An application without programs, whose connections are off."""
    application = Application(
        "joined", connections=[Connection("/a", "/b", "fast_tcp"), Connection("/a", "/c")]
    )
    supervisor = Supervisor(application, names=names)
    control = Control("joined", lambda asked: answer(supervisor, asked))
    supervisor.rest()
    try:
        yield "joined"
    finally:
        control.close()
        supervisor.stop()


def test_one_and_all(
    here,
    running: str,
    names: yarpy.LocalNames,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # As long as it takes: both ports are there.
    monkeypatch.setattr(join, "_TIMEOUT", 60.0)
    sink: Callable[[object], None] = lambda message: None  # noqa: E731
    with (
        yarpy.Port("/a", names=names) as a,
        yarpy.Port("/b", names=names, callback=sink),
        yarpy.Port("/c", names=names, callback=sink),
    ):
        said = here("connect", "--of", running, "/a", "/b")
        assert (said.code, said.out) == (0, "/a -> /b  connected\n")
        assert len(a.outputs) == 1
        assert here("disconnect", "--of", running, "/a", "/b").code == 0
        assert a.outputs == []
        said = here("connect", "--of", running)
        assert said.out == "/a -> /b  connected\n/a -> /c  connected\n"
        assert len(a.outputs) == 2
        assert here("disconnect", "--of", running).code == 0
        assert a.outputs == []


def test_a_port_that_is_missing_is_named(
    here, running: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(join, "_TIMEOUT", 0.0)
    said = here("connect", "--of", running, "/a", "/b")
    assert said.code == 1 and said.out.startswith("/a -> /b  waiting")


def test_what_cannot_be_joined(here, running: str) -> None:
    said = here("connect", "--of", running, "/a", "/x")
    assert said.code == 1
    assert "has no connection /a -> /x" in said.err
    said = here("disconnect", "--of", running, "/a")
    assert said.code == 1 and "name both ports" in said.err
    said = here("connect", "--of", "nobody")
    assert said.code == 1
    assert 'no application called "nobody" runs here' in said.err
