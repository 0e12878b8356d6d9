"""`yarpy help`; that it knows every verb is tested with the frame."""


def test_list(cli):
    said = cli.run("help")
    assert said.returncode == 0
    assert said.stdout == cli.run("--help").stdout
    assert "  read " in said.stdout


def test_one_command(here):
    assert "print what arrives" in here("help", "read").out


def test_unknown_command(here):
    said = here("help", "raed")
    assert said.code == 255 and 'did you mean "read"?' in said.err
