"""`yarpy readwrite`."""

import subprocess
from subprocess import PIPE

from support.command_line import YARPY
from support.wait import HANG

import yarpy


def test_two_people_talk(cli):
    with (
        cli.start("readwrite", "/talk/a:i", "/talk/a:o") as ann,
        cli.start("readwrite", "/talk/b:i", "/talk/b:o") as bob,
    ):
        for process in (ann, bob):
            process.wait_line("active", count=2, stream="err")
        assert cli.run("connect", "/talk/a:o", "/talk/b:i").returncode == 0
        assert cli.run("connect", "/talk/b:o", "/talk/a:i").returncode == 0
        ann.write_line('hello "bob"')
        bob.wait_line('^hello "bob"$', stream="out")
        bob.write_line("(hello) ann")
        ann.wait_line(r"^\(hello\) ann$", stream="out")
        ann.end_input()
        assert ann.wait() == 0
        bob.end_input()
        assert bob.wait() == 0
    assert bob.stdout == 'hello "bob"\n'


def test_a_port_that_is_taken(here, names):
    with yarpy.Port("/talk/taken", names=names):
        said = here("readwrite", "/talk/c", "/talk/taken")
        assert said.code == 1 and '"/talk/taken" is in use' in said.err
    assert names.query("/talk/c") is None


def test_nobody_reads_what_it_prints(cli, names):
    command = [*YARPY, "readwrite", "/talk/d:i", "/talk/d:o"]
    with (
        yarpy.Port("/talk/source", names=names) as source,
        subprocess.Popen(
            command, env=cli.environment, stdin=PIPE, stdout=PIPE, stderr=PIPE, text=True
        ) as process,
    ):
        process.stdout.close()
        assert yarpy.wait_for("/talk/d:o", timeout=HANG, names=names)
        source.connect("/talk/d:i")
        for _ in range(3):
            source.write(["x"])
        process.stdin.close()
        assert process.wait() in (0, 1)
        assert "Traceback" not in process.stderr.read()
