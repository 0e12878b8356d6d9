"""`yarpy check`."""

import re


def test_with_a_name_server(cli, names):
    said = cli.run("check")
    assert said.returncode == 0
    assert "\n*** Read number 42\n" in said.stdout
    assert said.stdout.endswith("*** YARP seems okay!\n")
    assert re.search(r"Added|Receiving input from /tmp/port/\d+ to /tmp/port/\d+", said.stderr)
    assert [contact.name for contact in names.list()] == ["/root", "fallback"]


def test_without(lone):
    said = lone.run("check")
    assert said.returncode == 0
    assert "=== NO NAME SERVER!  Switching to local, fake mode\n" in said.stdout
    assert "*** Read number 42\n" in said.stdout
    assert "*** YARP seems okay, but there is no name server available.\n" in said.stdout


def test_broken(here, monkeypatch):
    import yarpy

    def refuse(*args, **options):
        raise yarpy.LinkClosed("no network today")

    monkeypatch.setattr(yarpy, "connect", refuse)
    said = here("check")
    assert said.code == 1
    assert said.out.endswith("*** no network today\n*** YARP seems broken.\n")
