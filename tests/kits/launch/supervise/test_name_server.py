"""A name server for an application that finds none."""

import os

import pytest
from support.port import free_port

import yarpy
from yarpy.kits.launch.application import toml_file
from yarpy.kits.launch.supervise.name_server import missing, name_server


def application(text: str):
    return toml_file.read(text.encode(), "a.toml", {}).application


LINKED = application('connections = ["/a -> /b"]')
PLAIN = application("[programs]\na = 'sleep 1'\n")


@pytest.fixture
def nowhere(monkeypatch: pytest.MonkeyPatch) -> str:
    """Where no name server answers."""
    place = f"127.0.0.1:{free_port()}"
    monkeypatch.setenv("YARPY_SERVER", place)
    return place


def test_one_that_answers_is_left_alone() -> None:
    with yarpy.NameServer(), name_server(LINKED, bring=True) as told:
        assert told == ""


def test_that_none_answers_is_told_to_those_who_need_one(nowhere: str) -> None:
    with name_server(LINKED, bring=False) as told:
        assert nowhere in told and "--server" in told
    with name_server(PLAIN, bring=False) as told:
        assert told == ""


def test_one_is_brought_along_and_ends_with_the_application(
    nowhere: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("YARP_PORT_RANGE", str(free_port()))
    with name_server(PLAIN, bring=True) as told:
        place = os.environ["YARPY_SERVER"]
        assert f"YARPY_SERVER={place}" in told and place.startswith("127.0.0.1:")
        assert not missing()
    assert os.environ["YARPY_SERVER"] == nowhere
    assert nowhere in missing()
