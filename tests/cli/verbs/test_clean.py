"""`yarpy clean`."""

import socket

import pytest

import yarpy
from yarpy.cli.verbs.clean import is_kept, reason_of_death

HEAD = "Requesting list of ports from name server...\n"
TAIL = (
    "Giving name server a chance to do garbage collection.\n"
    "Name server says: garbage collection done.\n"
)


def test_living_and_dead(cli, names):
    with yarpy.Port("/clean/alive", names=names) as alive:
        names.register("/clean/dead", "tcp", "127.0.0.1", 1)
        names.register("/clean/group", "mcast")
        taken = names.register("/clean/taken", "tcp", "127.0.0.1", int(alive.address[10:]))
        said = cli.run("clean", "--timeout", "30")
        assert (said.returncode, said.stderr) == (0, "")
        assert said.stdout == (
            "Using a timeout of 30 seconds\n" + HEAD + "got 6 port(s)\n"
            f"Testing /clean/alive at tcp://{alive.address}/\n"
            "Testing /clean/dead at tcp://127.0.0.1:1/\n"
            "* No response, removing port /clean/dead\n"
            "Skipping mcast port /clean/group...\n"
            f"Testing /clean/taken at tcp://{taken.address}/\n"
            "* /clean/alive is there now, removing port /clean/taken\n"
            "Ignoring /root\n"
            "Ignoring fallback\n" + TAIL
        )
        left = [contact.name for contact in names.list()]
        assert left == ["/clean/alive", "/clean/group", "/root", "fallback"]


def test_without_a_timeout(here):
    said = here("clean")
    assert said.code == 0
    assert said.out.startswith("Waiting 3 seconds for each port; `--timeout S` changes that\n")


@pytest.mark.parametrize("carrier", ["tcp", "mjpeg"])
def test_who_listens_and_does_not_answer_is_not_dead(carrier):
    with socket.create_server(("127.0.0.1", 0)) as silent:
        contact = yarpy.Contact(carrier, "/x", "127.0.0.1", silent.getsockname()[1])
        assert reason_of_death(contact, 0.3) == ""


@pytest.mark.parametrize("host", ["no.such.host.invalid", "x" * 70])
def test_host_whose_name_is_not_found_proves_nothing(host):
    """The service that finds it may be away."""
    assert reason_of_death(yarpy.Contact("tcp", "/x", host, 10000), 0.3) == ""


@pytest.mark.parametrize("error", [TimeoutError, OSError(113, "No route to host")])
def test_a_host_that_cannot_be_reached_proves_nothing(error, monkeypatch):
    """A cable may be out: its ports keep their names."""

    def connect(*arguments):
        raise error

    monkeypatch.setattr(socket, "create_connection", connect)
    assert reason_of_death(yarpy.Contact("tcp", "/far", "192.0.2.1", 10002), 1.0) == ""


def test_a_port_may_have_any_name_in_front(names):
    """Only an address at which somebody else says who he is was taken over."""
    with yarpy.Port("/clean/who", names=names) as port:
        assert reason_of_death(port.contact, 1.0) == ""


@pytest.mark.parametrize(
    ("contact", "kept"),
    [
        (yarpy.Contact("tcp", "/a", "127.0.0.1", 10001), False),
        (yarpy.Contact("tcp", "/ns1", "127.0.0.1", 10000), True),
        (yarpy.Contact("mcast", "/m", "224.2.1.2", 10001), True),
        (yarpy.Contact("topic", "/t", "", 0), True),
        (yarpy.Contact("mjpeg", "/cam", "10.0.0.1", 80), False),
    ],
)
def test_who_is_tried(contact, kept):
    assert is_kept(contact, ("127.0.0.1", 10000)) is kept
