"""`yarpy resource`; where it looks is tested with `yarpy.config.resource`."""

import pytest


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "data/contexts/demo/demo.ini"
    path.parent.mkdir(parents=True)
    path.write_text("name /demo // a comment\n[group]\nsize 3\n")
    return path


def test_find(lone, file):
    said = lone.run("resource", "--context", "demo", "--find", "demo.ini")
    assert (said.returncode, said.stdout, said.stderr) == (0, f"{file}\n", "")
    assert lone.run("resource", "--context", "demo", "--from", "demo.ini").stdout == f"{file}\n"


def test_show(here, file):
    said = here("resource", "--context", "demo", "--from", "demo.ini", "--show")
    assert said.out == f'{file}\n>>> (group (size 3)) (name "/demo")\n'


def test_every_file_of_that_name(here, file, tmp_path):
    other = tmp_path / "data/demo.ini"
    other.write_text("")
    words = ("resource", "--context", "demo", "--find", "demo.ini")
    assert here(*words).out == f"{file}\n"
    assert here(*words, "--all").out == f"{file}\n{other}\n"


def test_where_it_looks(here, file):
    said = here("resource", "--verbose", "--context", "demo", "--find", "demo.ini")
    assert said.out == f"{file}\n"
    assert f"checking [{file}] found\n" in said.err


@pytest.mark.parametrize("option", ["--from", "--find"])
def test_nowhere(here, option):
    said = here("resource", option, "no_such.ini")
    assert (said.code, said.out) == (1, "")
    assert '"no_such.ini" is nowhere' in said.err


def test_nothing_asked(here):
    assert here("resource").code == 1
