"""`yarpy admin`."""

import os

from support.wait import HANG

import yarpy


def test_rpc(cli, names):
    with (
        yarpy.Port("/admin/a", names=names, callback=print) as port,
        yarpy.Port("/admin/b", names=names) as other,
    ):
        other.connect("/admin/a")
        assert port.wait_for_inputs(timeout=HANG)
        text = '[ver]\n[list] [in]\n[help]\n[prop] [set] k "v w"\n[prop] [get] k\nnonsense'
        said = cli.run("admin", "rpc", "/admin/a", input=text)
        assert (said.returncode, said.stderr) == (0, "")
        lines = said.stdout.splitlines()
        lines[1] = lines[1].replace(" admin", "")  # asked for its name before, and hung up
        assert lines[:4] == [
            "Response: [ver] 1 2 3",
            'Response: "/admin/b" anon_rpc',
            "Responses:",
            "  [help]                  # give this help",
        ]
        assert lines[-3:] == [
            "Response: [ok]",
            'Response: "v w"',
            'Response: [fail] "send [help] for list of valid commands"',
        ]


def test_rpc_of_what_nodes_of_ros_are_asked(cli, names):
    """Ports hang up behind those answers: what is asked next comes over another connection."""
    with yarpy.Port("/admin/ros", names=names):
        said = cli.run("admin", "rpc", "/admin/ros", input="getPid /me\ngetPid /me\n[ver]\n")
    pid = f'Response: 1 "" {os.getpid()}\n'
    assert said.stdout == f"{pid}{pid}Response: [ver] 1 2 3\n"
    assert (said.returncode, said.stderr) == (0, "")


def test_write(cli, names):
    with (
        yarpy.Port("/admin/c", names=names) as c,
        yarpy.Port("/admin/d", names=names) as d,
        yarpy.Port("/admin/e", names=names, callback=print),
    ):
        said = cli.run("admin", "write", "/me", "/admin/c", "/admin/d", input="[add] /admin/e\n")
        assert (said.returncode, said.stdout, said.stderr) == (0, "", "")
        assert [link.name for link in (*c.outputs, *d.outputs)] == ["/admin/e", "/admin/e"]


def test_alone(here):
    said = here("admin")
    assert said.code == 1
    assert said.err.startswith("error: Please supply a command: rpc or write\n")


def test_what_has_no_administrative_side(here):
    assert here("admin", "dance").code == 1
