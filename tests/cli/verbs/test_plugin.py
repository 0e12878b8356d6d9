"""`yarpy plugin`."""

import json
from importlib.metadata import EntryPoint

import pytest

from yarpy import facts, registry


def test_list(cli):
    said = cli.run("plugin")
    assert said.returncode == 0
    lines = said.stdout.splitlines()
    assert lines[:2] == ["core:", "  carrier     tcp"]
    assert "  command     read" in lines
    assert "tcp" in cli.run("plugin", "--list").stdout.splitlines()


def test_one(here):
    said = here("plugin", "fast_tcp")
    assert said.code == 0
    assert said.out.startswith(
        "Yes, fast_tcp is a carrier\n"
        "  * module: yarpy.carriers.own.tcp\n"
        "  * object: FastTcp\n"
        "  * about:  Messages follow one another"
    )
    assert "module: yarpy.cli.verbs.read" in here("plugin", "read").out


def test_nobody(here):
    said = here("plugin", "nonsense")
    assert (said.code, said.out) == (1, "")
    assert 'no plug-in "nonsense"' in said.err


def test_one_that_does_not_load(here, monkeypatch):
    entry = EntryPoint("broken", "yarpy_no_such_package:X", "yarpy.monitors")
    monkeypatch.setattr(registry, "entry_points", lambda group: [entry])
    monkeypatch.setattr(registry, "monitors", registry.Registry("monitors", {}))
    said = here("plugin", "broken")
    assert said.code == 1
    assert said.err.startswith('error: "broken" of an installed package is installed but cannot')


def test_json(here):
    found = [json.loads(line) for line in here("plugin", "--json").out.splitlines()]
    assert {"kind": "carrier", "name": "udp", "home": "core", "needs": "", "lacks": ""} in found
    assert len(found) > 30


def test_core_peers_and_kits_are_apart_with_what_each_needs(here):
    lines = here("plugin").out.splitlines()
    homes = [line[:-1] for line in lines if not line.startswith(" ")]
    rings = [home.partition(".")[0] for home in homes]
    assert homes[0] == "core" and {"peers.zenoh", "kits.sim"} <= set(homes)
    ours = [ring for ring in rings if ring in ("core", "peers", "kits")]
    assert ours == sorted(ours, key=("core", "peers", "kits").index)
    zenoh = lines[lines.index("peers.zenoh:") :]
    assert zenoh[1].split(maxsplit=2) == ["carrier", "zenoh", 'pip install "yarpy[zenoh]"']
    needs = {tuple(line.split(maxsplit=2)[:2]): line.split(maxsplit=2)[2:] for line in lines}
    assert needs["name", "zenoh"] == ['pip install "yarpy[zenoh]"'] and needs["name", "ros"] == []
    assert needs["idl", "thrift"] == ['pip install "yarpy[thrift]"']


def test_the_list_loads_nothing(here, monkeypatch):
    monkeypatch.setattr(
        registry.Registry, "load", lambda self, name: pytest.fail(f"{name} was loaded")
    )
    assert "transport   mpi" in here("plugin").out


SYSTEMS = {
    "linux": ("posix", {}),
    "darwin": (
        "posix",
        {
            "memory": "not on macOS: it needs memory without a name (memfd)",
            "shmem": "not on macOS: it needs System V memory of Linux",
        },
    ),
    "win32": (
        "nt",
        {
            "unix_stream": "not on Windows: it needs Unix sockets in Python",
            "memory": "not on Windows: it needs memory without a name (memfd)",
            "shmem": "not on Windows: it needs System V memory of Linux",
        },
    ),
}


@pytest.mark.parametrize("system", SYSTEMS)
def test_what_a_system_has_not_got_is_told(here, monkeypatch, system: str):
    name, lacks = SYSTEMS[system]
    monkeypatch.setattr(facts, "SYSTEM", (system, name))
    lines = [line for line in here("plugin").out.splitlines() if " not on " in line]
    told = {line.split()[1]: line.split(maxsplit=2)[2] for line in lines if "carrier " in line}
    assert told == lacks
    assert len(lines) == 2 * len(lacks)  # and the transports
    found = [json.loads(line) for line in here("plugin", "--json").out.splitlines()]
    assert {one["name"]: one["lacks"] for one in found if one["kind"] == "carrier"} == {
        **dict.fromkeys(registry.carriers.names(), ""),
        **lacks,
    }
    one = here("plugin", "memory").out
    assert one.startswith("Yes, memory is a carrier")
    assert ("* here:   not on" in one) == ("memory" in lacks)
