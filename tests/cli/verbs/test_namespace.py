"""`yarpy namespace`."""

import pytest


def test_default(cli):
    said = cli.run("namespace")
    assert (said.returncode, said.stdout) == (0, "YARP namespace: /root\n")


def test_set(here, tmp_path):
    path = tmp_path / "config/yarp_namespace.conf"
    said = here("namespace", "/lab")
    assert said == (
        0,
        f"Setting namespace in: {path}\n"
        "Remove this file to revert to the default namespace (/root)\n"
        "YARP namespace: /lab\n",
        "",
    )
    assert here("namespace").out == "YARP namespace: /lab\n"
    assert here("namespace", "/a", "/b").out.endswith('YARP namespaces: "/a" "/b"\n')
    path.unlink()
    assert here("namespace").out == "YARP namespace: /root\n"


@pytest.mark.parametrize("name", ["list", "", "root"])
def test_words_are_no_namespaces(here, tmp_path, name):
    said = here("namespace", name)
    assert said.code == 1 and 'begins with "/"' in said.err
    assert not (tmp_path / "config").exists()


def test_the_variable_wins_and_it_says_so(here, monkeypatch):
    monkeypatch.setenv("YARP_NAMESPACE", "/env")
    said = here("namespace", "/lab")
    assert said.out.endswith("YARP namespace: /env\n")
    assert "YARP_NAMESPACE" in said.err
