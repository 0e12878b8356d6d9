"""The port of a page: who reaches it, and that it leaves no trace in what programs get."""

import json
import os
import urllib.error
import urllib.request
from collections.abc import Iterator

import pytest
from support.http_error import http_error
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits.launch.application.application import Application, Module
from yarpy.kits.launch.page import serving as serving_file
from yarpy.kits.launch.page.serving import Serving
from yarpy.kits.launch.supervise import process
from yarpy.kits.launch.supervise.supervisor import Supervisor

pytestmark = pytest.mark.skipif(not process.known(), reason="this system tells nobody's owner")


@pytest.fixture
def running(network: yarpy.LocalNames) -> Iterator[tuple[Supervisor, Serving]]:
    words = ("sleep", "600")
    found = Application("app", modules=[Module("nap", "sleep", words=words)])
    supervisor = Supervisor(found, grace=1.0, names=network)
    serving = Serving(supervisor, network)
    supervisor.start()
    wait_until(lambda: supervisor.units["nap"].state == "running")
    yield supervisor, serving
    serving.close()
    supervisor.stop()


def fetch(url: str, body: object = None, **headers: str) -> object:
    data = None if body is None else json.dumps(body).encode()
    if data is not None:
        headers["Content-Type"] = "application/json"
    request = urllib.request.Request(
        url, data, {k.replace("_", "-"): v for k, v in headers.items()}
    )
    with urllib.request.urlopen(request, timeout=HANG) as answer:
        return json.loads(answer.read())


def test_from_the_first_look_to_a_program_that_was_stopped(running) -> None:
    supervisor, serving = running
    url = serving.url()
    assert url == serving.url() and url.startswith("http://127.0.0.1:")
    told = fetch(f"{url}application")
    assert told["programs"][0]["state"] == "running" and told["ports"] == []
    fetch(f"{url}form", {"admin": 1, "req": ["up", "stop", "nap"]})
    wait_until(lambda: supervisor.units["nap"].state == "stopped")
    assert not supervisor.over.is_set()  # it can be started again
    fetch(f"{url}form", {"admin": 1, "req": ["up", "start", "nap"]})
    wait_until(lambda: supervisor.units["nap"].state == "running")


def test_a_page_of_another_origin_sees_and_does_nothing(running) -> None:
    supervisor, serving = running
    url = serving.url()
    foreign = {"Origin": "http://evil.example", "User_Agent": "Mozilla/5.0"}
    for path, body in (
        ("application", None),
        ("lines?name=nap&most=5", None),
        ("form", {"admin": 1, "req": ["up", "stop", "nap"]}),
    ):
        with http_error(403):
            fetch(url + path, body, **foreign)
    assert supervisor.units["nap"].state == "running"


def test_a_program_of_another_user_is_refused(running, monkeypatch: pytest.MonkeyPatch) -> None:
    supervisor, serving = running
    monkeypatch.setattr(
        serving_file, "OwnerGate", lambda name: gate_file.OwnerGate(name, own=lambda peer: False)
    )
    from yarpy.kits.launch.page import gate as gate_file

    url = serving.url()
    for path, body in (("application", None), ("form", {"admin": 1, "req": ["up", "down"]})):
        with http_error(403):
            fetch(url + path, body)
    assert not supervisor.over.is_set()


def test_programs_get_no_setting_of_it(running, monkeypatch: pytest.MonkeyPatch) -> None:
    _, serving = running
    monkeypatch.delenv("YARPY_BIND", raising=False)
    serving.url()
    assert "YARPY_BIND" not in os.environ


def test_without_a_name_server(network: yarpy.LocalNames) -> None:
    class Nobody(yarpy.LocalNames):
        def register(self, *words: object, **more: object) -> yarpy.Contact:
            raise yarpy.NoNameServer("none")

    serving = Serving(Supervisor(Application("app"), names=network), Nobody())
    assert fetch(f"{serving.url()}application")["programs"] == []
    serving.close()
