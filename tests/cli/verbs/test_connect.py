"""`yarpy connect`."""

import pytest
from support.wait import HANG

import yarpy
from yarpy.cli.verbs.connect import entry_line


@pytest.fixture(scope="module", autouse=True)
def ports(server, names):
    with (
        yarpy.Port("/connect/a", names=names) as a,
        yarpy.Port("/connect/b", names=names, callback=lambda message: None) as b,
    ):
        yield a, b


@pytest.fixture(autouse=True)
def apart(ports):
    for link in ports[0].outputs:
        link.close()


def carriers(port):
    return [(link.name, link.carrier) for link in port.outputs]


def test_two_ports(cli, ports):
    said = cli.run("connect", "/connect/a", "/connect/b")
    line = "Success: Added connection from /connect/a to tcp://connect/b\n"
    assert (said.returncode, said.stdout, said.stderr) == (0, line, "")
    assert carriers(ports[0]) == [("/connect/b", "tcp")]


def test_again_over_another_carrier(here, ports):
    here("connect", "/connect/a", "/connect/b")
    said = here("connect", "/connect/a", "/connect/b", "fast_tcp")
    assert said.out == (
        "Connection found between /connect/a and /connect/b using carrier tcp\n"
        "Success: Added connection from /connect/a to fast_tcp://connect/b\n"
    )
    assert carriers(ports[0]) == [("/connect/b", "fast_tcp")]


@pytest.mark.parametrize(
    ("words", "carrier"),
    [
        (("/connect/a", "udp://connect/b"), "udp"),
        (("/connect/a", "/connect/b", "fast_tcp+recv.priority"), "fast_tcp+recv.priority"),
        (("text_ack://connect/a", "/connect/b"), "text_ack"),
    ],
)
def test_spellings(here, ports, words, carrier):
    assert here("connect", *words).code == 0
    assert carriers(ports[0]) == [("/connect/b", carrier)]


def test_an_address(here, ports):
    assert here("connect", "/connect/a", f"/{ports[1].address}").code == 0
    assert here("connect", f"tcp://{ports[0].address}/", "/connect/b").code == 0
    assert sorted(name for name, _ in carriers(ports[0]))[-1] == "/connect/b"


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (("/connect/x", "/connect/b"), 'no port "/connect/x" is registered: did you mean'),
        (("/connect/a", "/nobody"), 'no port "/nobody" is registered'),
        (("a", "/connect/b"), "invalid source 'a'"),
        (("/connect/a", "/connect/b/"), "invalid destination '/connect/b/'"),
        (("/connect/a", "/connect/b c"), "contains no blanks"),
        (("/connect/a", "/connect/b", "tpc"), 'no carrier "tpc": did you mean "tcp"?'),
        (("/connect/a", "tpc://connect/b"), 'no carrier "tpc"'),
        (("/connect/dead", "/connect/b"), "/connect/dead"),
    ],
)
def test_failures(here, names, words, complaint):
    names.register("/connect/dead", "tcp", "127.0.0.1", 1)
    said = here("connect", *words)
    names.unregister("/connect/dead")
    assert (said.code, said.out) == (1, "")
    assert said.err.startswith("error: ") and complaint in said.err


def test_persistent(here, ports):
    assert here("connect") == (0, "No persistent connections.\n", "")
    assert here("connect", "--persist", "/connect/a", "/connect/b", "udp") == (0, "", "")
    assert ports[0].wait_for_outputs(timeout=HANG)
    assert carriers(ports[0]) == [("/connect/b", "udp")]
    entry = "Persistent connection /connect/a -> udp://connect/b\n"
    assert here("connect", "--persist").out == entry
    assert here("connect", "--persist", "/connect/a").out == entry
    assert here("connect", "--persist", "/connect/c").out == "No persistent connections.\n"

    said = here("connect", "/connect/b")
    assert said.out.startswith('This is "/connect/b" at "tcp://') and said.out.endswith(entry)
    assert here("connect", "/nobody").code == 1

    assert here("disconnect", "--persist", "/connect/a", "/connect/b").code == 0
    assert here("connect").out == "No persistent connections.\n"


def test_persistent_until_one_side_goes(here):
    here("connect", "--persist-from", "/connect/a", "/connect/x")
    here("connect", "--persist-to", "/connect/y", "/connect/b")
    assert here("connect").out == (
        "Persistent connection /connect/a -> /connect/x [from]\n"
        "Persistent connection /connect/y -> /connect/b [to]\n"
    )
    here("disconnect", "--persist", "/connect/a", "/connect/x")
    here("disconnect", "--persist", "/connect/y", "/connect/b")


def test_persistent_with_a_wrong_carrier_is_not_stored(here):
    assert here("connect", "--persist", "/connect/a", "/connect/b", "tpc").code == 1
    assert here("connect").out == "No persistent connections.\n"


def test_carriers(here):
    said = here("connect", "--list-carriers")
    assert said.code == 0
    assert said.out.splitlines()[:2] == ["tcp", "fast_tcp"]


def test_entry_of_a_cpp_server():
    entry = yarpy.Bottle.from_text('subscription (src "/s") (dest "topic://t") (topic 0 1)')
    assert entry_line(entry) == "Persistent connection /s -> topic://t"
