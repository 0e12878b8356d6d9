"""`yarpy where`."""

import json
from pathlib import Path

import pytest

import yarpy
from yarpy.names import client


def test_it_is_there(cli, server):
    said = cli.run("where")
    assert (said.returncode, said.stderr) == (0, "")
    assert said.stdout == (
        f"Looking for name server on 127.0.0.1, port number {server.port}\n"
        "If there is a long delay, try:\n"
        "  yarpy conf --clean\n"
        f"Name server /root is available at ip 127.0.0.1 port {server.port}\n"
    )


def test_it_is_not_there(here, monkeypatch):
    monkeypatch.delenv("YARPY_SERVER")
    assert here("conf", "127.0.0.1", "1").code == 0
    said = here("where")
    assert said.code == 1
    assert "== No valid YARP name server is available.\n" in said.out
    assert "yarp.conf expects it at ip 127.0.0.1 port 1\n" in said.out


@pytest.mark.parametrize("words", [("where",), ("name", "list"), ("read", "/where/new")])
def test_ordinary_port_is_there_instead(here, names, monkeypatch, words):
    monkeypatch.setattr(client.YarpNameClient.__init__, "__defaults__", (1.0,))  # seconds
    with (
        yarpy.BufferedPort("/where/silent", names=names) as silent,
        yarpy.RpcServer("/where/chatty", lambda message: [], names=names) as chatty,
    ):
        for port in (silent, chatty):
            monkeypatch.setenv("YARPY_SERVER", port.address)
            said = here(*words)
            assert said.code == 1
            assert f"what listens at {port.address} is an ordinary port" in said.err


def test_none_is_configured(lone):
    said = lone.run("where")
    assert said.returncode == 1
    assert "== No address for a YARP name server is available.\n" in said.stdout
    assert str(Path(lone.environment["YARP_CONFIG_HOME"], "yarp.conf")) in said.stdout


def test_one_of_several(here, server, monkeypatch):
    monkeypatch.setenv("YARPY_SERVER", f"127.0.0.1:1,{server.address}")
    assert here("where").code == 0


def test_json(here, server, monkeypatch):
    said = here("where", "--json")
    assert (said.code, json.loads(said.out)) == (
        0,
        {
            "namespace": "/root",
            "host": "127.0.0.1",
            "port": server.port,
            "configuration": "YARPY_SERVER",
            "available": True,
        },
    )
    monkeypatch.delenv("YARPY_SERVER")
    said = here("where", "--json")
    assert (said.code, json.loads(said.out)) == (1, {"namespace": "/root", "available": False})
