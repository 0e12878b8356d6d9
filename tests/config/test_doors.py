"""Who may do what: the table of SECURITY.md, held against what ports really do."""

from __future__ import annotations

import socket
from http.client import HTTPConnection
from pathlib import Path

import pytest
from support.guest import guest

import yarpy
from yarpy.config.doors import Entry, doors
from yarpy.monitors.base import Place
from yarpy.monitors.script.permission import look_for

PAGE = Path(__file__).parents[2] / "SECURITY.md"
SETTINGS = ("BIND", "ACCESS", "WEB_ORIGINS", "SCRIPTS", "MPI", "TLS")


@pytest.fixture(autouse=True)
def default(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    for name in SETTINGS:
        monkeypatch.delenv(f"YARPY_{name}", raising=False)
    monkeypatch.setenv("YARP_CONFIG_HOME", str(tmp_path))


def test_the_table_is_what_holds() -> None:
    text = PAGE.read_text("utf-8").partition("## By default")[2].partition("## Promised")[0]
    rows = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("| ")]
    assert [Entry(*row) for row in rows[1:]] == doors()


SET = [
    ("BIND", "local", 0, "programs of this computer alone"),
    ("WEB_ORIGINS", "http://dash:8080", 1, "those of http://dash:8080 everything"),
    ("WEB_ORIGINS", "http://dash:8080", 2, "nothing, but those of http://dash:8080 everything"),
    ("WEB_ORIGINS", "*", 1, "everything"),
    ("WEB_ORIGINS", "*", 2, "everything"),
    ("SCRIPTS", "network", 3, "run, from a context's folder"),
    ("MPI", "yes", 4, "are met"),
    ("TLS", "require", 5, "are TLS alone"),
    ("TLS", "mutual", 5, "certificates of both sides"),
    ("ACCESS", "/nowhere/access.toml", 0, "nothing, since no port opens"),
]


@pytest.mark.parametrize(("name", "value", "row", "said"), SET)
def test_what_a_setting_changes(
    name: str, value: str, row: int, said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(f"YARPY_{name}", value)
    assert said in f"{doors()[row].who}: {doors()[row].may}"


def test_ports_do_what_the_table_says() -> None:
    names = yarpy.LocalNames()
    heard: list[object] = []

    def take(message: yarpy.Message) -> None:
        heard.append(message.value)

    with (
        yarpy.Port("/arm", names=names, callback=take) as arm,
        yarpy.Port("/program", names=names) as program,
    ):
        program.connect("/arm")
        program.write(["moves"])
        page = HTTPConnection("127.0.0.1", arm.contact.port, timeout=30)
        for target, status in (("/?", 200), ("/?req=set+pos", 403), ("/?cmd=/there", 403)):
            for origin in ("http://10.0.0.9:8080", "http://site.example"):
                page.request("GET", target, headers={"Origin": origin})
                answer = page.getresponse()
                assert answer.read()
                assert answer.status == (status if "10" in origin else 403)
        page.close()
        with pytest.raises(yarpy.LocalProtocolError, match="YARPY_SCRIPTS=network"):
            look_for(Place("/program", "/arm", foreign=True), "clip.py", "demo")
    assert heard == [["moves"]]


def test_programs_of_mpi_are_met_if_the_setting_says_so() -> None:
    guest("mpi")
    with (
        yarpy.Port("/arm", names=yarpy.LocalNames()) as arm,
        socket.create_connection(("127.0.0.1", arm.contact.port), 30) as sock,
    ):
        sock.sendall(b"MPI_____/s\r\nother\r\ntag#0$connentry#00$\r\n")
        with sock.makefile("rb") as file:
            assert b"YARPY_MPI=yes" in file.read()


def test_scripts_run_for_whom_the_rules_name(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    file = tmp_path / "rules.toml"
    file.write_text('[[allow]]\nwho = ["10.0.0.1", "key"]\nmay = ["all", "script"]\n')
    monkeypatch.setenv("YARPY_ACCESS", str(file))
    assert doors()[3].may == "run, from a context's folder, for 10.0.0.1, key"
