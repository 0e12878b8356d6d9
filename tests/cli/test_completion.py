"""What Tab offers."""

from __future__ import annotations

import pytest
from support.wait import HANG

import yarpy
from yarpy.cli import completion
from yarpy.cli.completion import FILES, complete, split


def values(line: str) -> list[str]:
    return [found.value for found in complete(line)]


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("yarpy", ["yarpy"]),
        ("yarpy ", ["yarpy", ""]),
        ("yarpy re", ["yarpy", "re"]),
        ("yarpy read /a  /b ", ["yarpy", "read", "/a", "/b", ""]),
        ("yarpy read '/a b", ["yarpy", "read", "/a b"]),
        ("yarpy read /a#b", ["yarpy", "read", "/a#b"]),
    ],
)
def test_words_of_a_line_that_is_being_typed(line, words):
    assert split(line) == words


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("yarpy conn", ["connect"]),
        ("yarpy help qo", ["qos"]),
        ("yarpy qos ", ["describe", "get", "set", "time"]),
        ("yarpy qos g", ["get"]),
        ("yarpy name un", ["unregister"]),
        ("yarpy connect /a /b fast", ["fast_tcp"]),
        ("yarpy split /a --carrier fast", ["fast_tcp"]),
        ("yarpy connect --file ", [FILES]),
        ("yarpy server --portdb /tmp/p", [FILES]),
        ("yarpy completion z", ["zsh"]),
        ("yarpy stats --wi", ["--wide"]),
        ("yarpy frobnicate ", []),
        ("yarpy where x", []),
    ],
)
def test_verbs_options_carriers_and_files(line, expected):
    assert values(line) == expected


def test_what_it_is_stands_beside_it():
    [found] = complete("yarpy conn")
    assert found.about == "connect two ports, or list persistent connections"


def test_names_of_ports(server, names, here, monkeypatch):
    monkeypatch.setattr(completion, "TIMEOUT", HANG)
    with yarpy.Port("/tab/rpc:i", names=names), yarpy.Port("/tab/out", names=names) as out:
        names.register("/tab/$(odd)", "tcp", "127.0.0.1", out.contact.port)
        said = here("completion", "--line", "yarpy connect /tab/")
        assert [line.partition("\t")[0] for line in said.out.splitlines()] == [
            "/tab/out",
            "/tab/rpc:i",
        ]
        assert here("completion", "--line", "yarpy read ... udp://tab/o").out.startswith(
            "udp://tab/out\t"
        )


def test_server_that_does_not_answer_offers_nothing(monkeypatch):
    monkeypatch.setattr(completion, "TIMEOUT", 0.05)
    import socket

    with socket.create_server(("127.0.0.1", 0)) as silent:
        monkeypatch.setenv("YARPY_SERVER", f"127.0.0.1:{silent.getsockname()[1]}")
        assert values("yarpy ping /") == []
