"""`yarpy check`."""

import re
import sys


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


RULES = '[[allow]]\nwho = "loopback"\nmay = "all"\n[[allow]]\nwho = "10.0.0.0/8"\nmay = "read"\n'


def test_access(here, monkeypatch, tmp_path):
    file = tmp_path / "rules.toml"
    file.write_text(RULES)
    monkeypatch.setenv("YARPY_ACCESS", str(file))
    said = here("check", "--access")
    assert said.code == 0
    assert said.out.startswith(f"The rules of {file}:\n\n1. loopback\n   may everything\n")
    assert "note:" not in said.out
    said = here("check", "--access", "10.1.1.1", "read", "/arm")
    assert (said.code, said.out) == (0, "yes: rule 2 (line 4): 10.0.0.0/8 may read: all ports\n")
    said = here("check", "--access", "10.1.1.1", "write", "/arm")
    assert said.code == 1
    assert said.out.startswith("no: no rule lets 10.1.1.1 write /arm\n")


def test_access_without_rules(here, monkeypatch, tmp_path):
    monkeypatch.delenv("YARPY_ACCESS", raising=False)
    monkeypatch.setenv("YARP_CONFIG_HOME", str(tmp_path / "none"))
    said = here("check", "--access")
    assert said.code == 0
    assert said.out.startswith("There is no access.toml; it would be ")


def test_access_with_a_mistake(here, monkeypatch, tmp_path):
    file = tmp_path / "broken.toml"
    file.write_text('[[allow]]\nwho = "loopback"\nmay = "raed"\n')
    monkeypatch.setenv("YARPY_ACCESS", str(file))
    said = here("check", "--access")
    assert said.code == 1
    assert 'line 3: may: there is no right "raed" (did you mean "read"?)' in said.err
    for words in (("--access", "loopback"), ("loopback", "read", "/arm")):
        assert here("check", *words).code != 0


def test_files(here, tmp_path):
    file = tmp_path / "a.toml"
    file.write_text(f"nmae = 'x'\n[programs.a]\ncommand = ['{sys.executable}']\n")
    said = here("check", "--offline", str(file))
    assert said.code == 0
    assert said.out.splitlines() == [
        f'{file}:1:1: warning: "nmae" is ignored: did you mean "name"?',
        "a: 1 program, 0 connections, 1 problem",
    ]
