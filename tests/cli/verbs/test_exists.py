"""`yarpy exists`."""

import json

import yarpy


def test_a_port(cli, names):
    with yarpy.Port("/exists/a", names=names):
        said = cli.run("exists", "/exists/a")
        assert (said.returncode, said.stdout, said.stderr) == (0, "", "")
    assert cli.run("exists", "/exists/a").returncode == 1


def test_a_name_that_nobody_serves(here, names):
    names.register("/exists/dead", "tcp", "127.0.0.1", 1)
    assert here("exists", "/exists/dead")[:2] == (1, "")


def test_an_address(here, names):
    with yarpy.Port("/exists/b", names=names) as port:
        assert here("exists", f"/{port.address}").code == 0


def test_a_connection(here, names):
    with (
        yarpy.Port("/exists/c", names=names) as c,
        yarpy.Port("/exists/d", names=names, callback=print),
    ):
        said = here("exists", "/exists/c", "/exists/d")
        assert said == (1, "No connection from /exists/c to /exists/d found\n", "")
        c.connect("/exists/d", "fast_tcp")
        said = here("exists", "/exists/c", "/exists/d")
        line = "Connection found between /exists/c and /exists/d using carrier fast_tcp\n"
        assert said == (0, line, "")
        assert here("exists", "/exists/d", "/exists/c").code == 1
        assert here("exists", "/exists/c", "/exists/nobody").code == 1


def test_json(here, names):
    with yarpy.Port("/exists/e", names=names):
        said = here("exists", "--json", "/exists/e")
        assert json.loads(said.out) == {"port": "/exists/e", "exists": True}
        said = here("exists", "/exists/e", "/exists/f", "--json")
        assert said.code == 1
        assert json.loads(said.out) == {
            "source": "/exists/e",
            "target": "/exists/f",
            "exists": False,
            "carrier": "",
        }


def test_no_name_server(lone):
    said = lone.run("exists", "/x")
    assert (said.returncode, said.stdout) == (1, "")
    assert "no name server is configured" in said.stderr
