"""`yarpy access`."""

import pytest


@pytest.fixture
def file(monkeypatch, tmp_path):
    monkeypatch.delenv("YARPY_ACCESS", raising=False)
    monkeypatch.setenv("YARP_CONFIG_HOME", str(tmp_path))
    return tmp_path / "access.toml"


def test_shows_what_holds(here, file):
    said = here("access")
    assert said.code == 0
    assert said.out.startswith("There is no access.toml; it would be ")


def test_allows_and_refuses(here, file):
    said = here("access", "allow", "script", "10.0.0.1")
    assert said.code == 0
    assert said.out.startswith("10.0.0.1 may script from now on")
    said = here("access")
    assert "2. 10.0.0.1\n   may script\n" in said.out
    assert here("access", "refuse", "script", "10.0.0.1").code == 0
    assert "10.0.0.1" not in file.read_text()


def test_says_that_scripts_need_attach(here, file):
    file.write_text('[[allow]]\nwho = "loopback"\nmay = "read"\n')
    said = here("access", "allow", "script", "10.0.0.1")
    assert "note: scripts need attach as well: yarpy access allow attach 10.0.0.1" in said.out


@pytest.mark.parametrize(
    "words",
    [("allow",), ("allow", "script"), ("give", "script", "key"), ("allow", "script", "robot")],
)
def test_wrong_words(here, file, words):
    said = here("access", *words)
    assert said.code != 0
    assert said.err
    assert not file.exists()
