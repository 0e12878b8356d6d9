"""`yarpy disconnect`."""

import pytest
from support.wait import HANG

import yarpy


@pytest.mark.parametrize("carrier", ["tcp", "udp"])
def test_two_ports(cli, names, carrier):
    with (
        yarpy.Port("/disconnect/a", names=names) as a,
        yarpy.Port("/disconnect/b", names=names, callback=lambda message: None) as b,
    ):
        a.connect("/disconnect/b", carrier)
        assert b.wait_for_inputs(timeout=HANG)
        said = cli.run("disconnect", "/disconnect/a", "/disconnect/b")
        line = "Success: Removed connection from /disconnect/a to /disconnect/b\n"
        assert (said.returncode, said.stdout, said.stderr) == (0, line, "")
        assert a.outputs == []
        said = cli.run("disconnect", "/disconnect/a", "/disconnect/b")
        assert (said.returncode, said.stdout) == (1, "")
        assert 'error: "/disconnect/a" is not connected to "/disconnect/b"' in said.stderr


@pytest.mark.parametrize("topic", ["mqtt://127.0.0.1:1/in", "zenoh://in"])
def test_who_can_be_asked_about_a_topic(here, names, topic):
    with yarpy.Port("/disconnect/c", names=names):
        for ends in ((topic, "/disconnect/c"), ("/disconnect/c", topic)):
            said = here("disconnect", *ends)
            assert said.code == 1
            assert "`yarpy ping /disconnect/c` shows to what" in said.err


def test_unknown_port(here):
    assert here("disconnect", "/nobody", "/neither").code == 1


def test_both_names_are_needed(here):
    assert here("disconnect", "/a").code == 1
