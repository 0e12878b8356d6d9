"""`yarpy conf`."""

from pathlib import Path

import pytest


def test_write_read_and_clean(lone):
    path = Path(lone.environment["YARP_CONFIG_HOME"], "yarp.conf")
    said = lone.run("conf")
    assert (said.returncode, said.stdout) == (0, f"{path}\n")
    assert not path.exists()

    said = lone.run("conf", "10.0.0.1", "10001")
    assert said.returncode == 0
    assert said.stdout == (
        f"Configuration file:\n  {path}\n"
        "Now stores:\n  host 10.0.0.1 port number 10001 (yarp name server)\n"
    )
    assert path.read_text(encoding="utf-8") == "10.0.0.1 10001 yarp\n"

    said = lone.run("conf", "robot", "10000", "ros")
    assert said.stdout == (
        f"Configuration file:\n  {path}\n"
        "Stored:\n  host 10.0.0.1 port number 10001 (yarp name server)\n"
        "Now stores:\n  host robot port number 10000 (ros name server)\n"
    )

    said = lone.run("conf", "--clean")
    assert (said.returncode, said.stdout) == (0, f"Cleared configuration file:\n  {path}\n")
    assert path.read_text(encoding="utf-8") == ""


def test_the_current_namespace(here, tmp_path, monkeypatch):
    monkeypatch.setenv("YARP_NAMESPACE", "/lab")
    assert here("conf").out == f"{tmp_path / 'config' / '_lab.conf'}\n"
    assert here("conf", "10.0.0.1", "10001").code == 0
    assert (tmp_path / "config/_lab.conf").read_text() == "10.0.0.1 10001 yarp\n"


@pytest.mark.parametrize(
    "words", [("10.0.0.1",), ("h", "0"), ("h", "70000"), ("h", "x"), ("h", "1", "mode")]
)
def test_what_makes_no_sense_is_not_stored(here, tmp_path, words):
    said = here("conf", *words)
    assert (said.code, said.out) == (1, "")
    assert said.err.startswith("error: ")
    assert not (tmp_path / "config").exists()


@pytest.mark.parametrize("text", ["h 1 carrot", "h 70000 yarp", "[nome]\nhost h\n", "\x00\xff"])
def test_a_file_that_cannot_be_used_is_written_anew(here, tmp_path, text):
    """As those are told who meet it."""
    (tmp_path / "config").mkdir()
    path = tmp_path / "config" / "yarp.conf"
    path.write_text(text, encoding="utf-8")
    said = here("conf", "10.0.0.1", "10001")
    assert (said.code, said.err) == (0, "")
    assert path.read_text(encoding="utf-8") == "10.0.0.1 10001 yarp\n"
