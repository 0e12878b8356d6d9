"""`yarpy name`."""

import json

import pytest

from yarpy.peers.ros2.zenoh.listing import Entry

END = "*** end of message\n"


def test_dialogue(cli, server):
    port = server.port
    said = cli.run("name", "register", "/cam", "mjpeg", "10.0.0.5", "80")
    cam = "registration name /cam ip 10.0.0.5 port 80 type mjpeg\n"
    assert (said.returncode, said.stdout, said.stderr) == (0, cam, "")
    said = cli.run("name", "list")
    root = f"registration name /root ip 127.0.0.1 port {port} type tcp\n"
    fallback = "registration name fallback ip 224.2.1.1 port 10000 type mcast\n"
    assert (said.returncode, said.stdout) == (0, cam + root + fallback + END)
    assert cli.run("name", "list", "/cam").stdout == cam + END
    assert cli.run("name", "query", "/cam").stdout == cam
    said = cli.run("name", "unregister", "/cam")
    assert (said.returncode, said.stdout) == (0, "Unregistered name.\n")
    said = cli.run("name", "query", "/cam")
    assert (said.returncode, said.stdout) == (1, "")
    assert said.stderr.startswith('error: no port "/cam" is registered: ')


def test_properties(here):
    here("name", "register", "/name/p", "tcp", "10.0.0.1", "10005")
    line = "port /name/p property key = -1 2.5 a b word\n"
    said = here("name", "set", "/name/p", "key", "word", "-1", "a b", "2.5")
    assert said == (0, line + END, "")
    assert here("name", "get", "/name/p", "key").out == line + END
    said = here("name", "check", "/name/p", "key", "word")
    assert said.out == "port /name/p property key value word present true\n" + END
    assert here("name", "route", "/a", "/b").out == "port /a route /b = tcp://b\n" + END
    assert here("name", "gc").out == "garbage collection done.\n" + END


def test_unknown_command(here):
    said = here("name", "frobnicate", "x")
    assert (said.code, said.out) == (1, "")
    assert said.err.startswith('error: the name server does not know "frobnicate"')
    assert here("name", "list", "/nothing/begins/so").code == 0


def test_what_is_left_to_the_server(here):
    said = here("name", "register", "/name/any")
    assert said.out.startswith("registration name /name/any ip 127.0.0.1 port ")
    said = here("name", "register", "...", "tcp", "...", "12345")
    assert " ip 127.0.0.1 port 12345 type tcp" in said.out
    assert said.out.startswith("registration name /tmp/port/")
    said = here("name", "register", "")
    assert said.code == 1 and "the name is empty" in said.err


def test_registering_claims_nothing_but_the_address(here, names):
    """A camera does not run in this process, nor at our addresses."""
    here("name", "register", "/name/cam", "mjpeg", "10.0.0.5", "80")
    assert names.get("/name/cam", "process") == names.get("/name/cam", "ips") == []


def test_no_command_is_help(here):
    said = here("name")
    assert said.out.startswith("Here are some ways to use the name server:\n+ help\n")
    assert said == here("name", "help")


@pytest.mark.parametrize(
    ("words", "reply"),
    [
        (("topic", "/name/t"), "[ok]\n"),
        (("topic",), '"/name/t"\n'),
        (("untopic", "/name/t"), "[ok]\n"),
        (("subscribe",), "subscriptions\n"),
        (("announce", "/name/x"), "[ok]\n"),
        (("type", "yarp", "nothing"), "[fail]\n"),
        (("bot", "query", "/name/none"), 'port (error -2 "port not known")\n'),
    ],
)
def test_what_is_answered_with_a_bottle_does_not_hang(here, words, reply):
    if words == ("topic",):
        here("name", "topic", "/name/t")
    assert here("name", *words) == (0, reply, "")


def test_json(here):
    here("name", "register", "/name/j", "tcp", "10.0.0.1", "10006")
    expected = {"name": "/name/j", "host": "10.0.0.1", "port": 10006, "carrier": "tcp"}
    assert json.loads(here("name", "query", "/name/j", "--json").out) == expected
    assert json.loads(here("name", "--json", "list", "/name/j").out) == expected
    here("name", "register", "/name/j/k", "tcp", "10.0.0.1", "10007")
    listed = [
        json.loads(line) for line in here("name", "list", "/name/j", "--json").out.splitlines()
    ]
    assert [one["name"] for one in listed] == ["/name/j", "/name/j/k"]
    here("name", "set", "/name/j", "k", "v", "w")
    assert json.loads(here("name", "get", "/name/j", "k", "--json").out) == ["v", "w"]
    assert json.loads(here("name", "bot", "query", "/name/j", "--json").out)[1] == [
        "name",
        "/name/j",
    ]
    assert json.loads(here("name", "gc", "--json").out) == ["garbage collection done."]


def test_json_of_ros2(here, monkeypatch):
    found = [
        Entry("node", "/n", ""),
        Entry("service", "/s", "std_srvs/srv/Trigger"),
        Entry("topic", "/t", "std_msgs/msg/String"),
    ]
    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_zenoh_cpp")
    monkeypatch.setattr("yarpy.peers.ros2.zenoh.listing.listing", lambda prefix: found)
    plain = here("name", "list", "/nothing").out.splitlines()[:-1]
    assert plain == [f'{item.kind} "{item.target}"' for item in found]
    told = [json.loads(line) for line in here("name", "list", "/x", "--json").out.splitlines()]
    assert [(one["name"], one["carrier"], one["kind"], one["type"]) for one in told] == [
        ("/n", "ros2", "node", ""),
        ("/s", "ros2+srv", "service", "std_srvs/srv/Trigger"),
        ("/t", "ros2", "topic", "std_msgs/msg/String"),
    ]


@pytest.mark.parametrize("port", ["0", "-1", "65536", "x"])
def test_port_numbers_are_checked(here, port):
    said = here("name", "register", "/name/bad", "tcp", "10.0.0.1", port)
    assert said.code == 1 and "is no port number" in said.err
    assert here("name", "query", "/name/bad").code == 1


def test_no_server(lone):
    said = lone.run("name", "list")
    assert (said.returncode, said.stdout) == (1, "")
    assert said.stderr.startswith("error: no name server")
