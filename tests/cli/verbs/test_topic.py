"""`yarpy topic`, and connections through one."""

import json

from support.wait import HANG

import yarpy


def test_make_list_and_remove(cli):
    assert cli.run("topic", "--list").stdout == "No topics\n"
    assert cli.run("topic", "/topic/a").stdout == "Topic /topic/a created\n"
    assert cli.run("topic", "/topic/b", "x").stdout == "Topic /topic/b created\n"
    assert cli.run("topic", "--list").stdout == 'Topics: "/topic/a" "/topic/b"\n'
    said = cli.run("topic", "--remove", "/topic/a")
    assert (said.returncode, said.stdout) == (0, "Topic /topic/a deleted\n")
    said = cli.run("topic", "--remove", "/topic/a")
    assert (said.returncode, said.stdout) == (1, "")
    assert 'no topic "/topic/a"' in said.stderr


def test_json(here):
    here("topic", "/topic/c")
    assert "/topic/c" in json.loads(here("topic", "--list", "--json").out)


def test_name_is_needed(here):
    assert here("topic").code == 1
    assert here("topic", "").code == 1


def test_joins_ports(here, names):
    with (
        yarpy.Port("/topic/from", names=names) as source,
        yarpy.Port("/topic/to", names=names) as sink,
    ):
        said = here("connect", "/topic/from", "topic://topic/t")
        assert said == (0, "Success: connection to topic added.\n", "")
        assert here("connect", "topic://topic/t", "/topic/to").code == 0
        assert source.wait_for_outputs(timeout=HANG)
        source.write(["x"])
        assert sink.read(timeout=HANG).value == ["x"]
