"""`yarpy doctor`; tests/kits/doctor has the faults."""

import json

from support.port import free_port

import yarpy
from yarpy.kits.doctor import Finding
from yarpy.kits.doctor.verbs.doctor import told


def test_a_fault_and_what_mends_it(here, names, monkeypatch):
    monkeypatch.setenv("YARP_PORT_RANGE", str(free_port()))
    with yarpy.Port("/doc/a", names=names), yarpy.Port("/doc/b", names=names):
        said = here("doctor", "/doc/a", "/doc/b")
        assert said.code == 1
        assert said.out == (
            "fault: not-connected, /doc/a -> /doc/b\n"
            '    "/doc/a" and "/doc/b" are there, and are not connected\n'
            "    > `yarpy connect /doc/a /doc/b`\n"
            "\n"
            "1 fault (2 ports asked)\n"
        )
        [found] = map(json.loads, here("doctor", "--json", "/doc/a", "/doc/b").out.splitlines())
        assert (found["probe"], found["level"]) == ("not-connected", "fault")


def test_a_healthy_network(here, names, monkeypatch):
    monkeypatch.setenv("YARP_PORT_RANGE", str(free_port()))  # where others look for servers, too
    with yarpy.Port("/doc/a", names=names):
        said = here("doctor")
        head, _, last = said.out.rpartition("\n\n")
        assert (said.code, last) == (0, "nothing is wrong (2 ports answer)\n")
        assert head.startswith("who reaches programs that are started here, and with what:\n")
        assert "scripts (Lua, Python) that others ask for: do not run" in head


def test_no_server(lone):
    done = lone.run("doctor", "/a")
    assert done.returncode == 1
    assert done.stdout.startswith("fault: no-server, name server\n    no name server is configured")


def test_three_ports_are_too_many(here):
    assert here("doctor", "/a", "/b", "/c").code == 1


def test_strangers_are_shown_and_not_obeyed():
    lines = told(Finding("x", "/a\x1b[2J", "says\x1b]0;pwned\x07 and\u202e more", "`y\nz`"), 60)
    assert lines == [
        "fault: x, /a\\x1b[2J",
        "    says\\x1b]0;pwned\\x07 and\\u202e more",
        "    > `y\\nz`",
    ]
