"""Topics and persistent connections between C++ and yarpy ports, kept by servers of both kinds."""

import time
from collections.abc import Callable

from support.cpp import CppYarp
from support.cpp_program import CppProgram
from support.wait import HANG, wait_until

import yarpy


def flows(send: Callable[[int], object], port: yarpy.BufferedPort) -> None:
    """Send until something arrives that was sent just now."""
    for count in range(int(HANG / 0.1)):
        send(count)
        try:
            while port.read(timeout=0.1).value != [count]:
                pass
            return
        except yarpy.Timeout:
            continue
    raise AssertionError(f"nothing arrives at {port.name}")


def test_topics(network: CppYarp, peer: CppProgram) -> None:
    """Publishers and subscribers of both kinds, in any order of coming."""
    peer.do("port = yarp.Port(); assert port.open('/cpp/out')")
    assert network.run("topic", "/news").stdout == "Topic /news created\n"
    assert network.run("topic", "--list").stdout == 'Topics: "/news"\n'
    with yarpy.BufferedPort("/in", strict=True) as reader:
        assert network.run("connect", "/cpp/out", "topic://news").returncode == 0
        assert network.run("connect", "topic://news", "/in").returncode == 0
        flows(lambda n: peer.do(f"port.write(yarp.Bottle('{n}'))"), reader)
        # A second publisher and a second subscriber, by our means.
        with yarpy.Port("/out") as writer:
            yarpy.connect("/out", "topic://news")
            flows(lambda n: writer.write([n]), reader)
            peer.do("got = yarp.BufferedPortBottle(); assert got.open('/cpp/in'); got.setStrict()")
            yarpy.connect("topic://news", "/cpp/in")
            wait_until(lambda: yarpy.is_connected("/out", "/cpp/in"), HANG, "it hears /out")
            wait_until(lambda: yarpy.is_connected("/cpp/out", "/cpp/in"), HANG, "and /cpp/out")
            writer.write(["to all"])
            assert peer.do("got.read().toString()") == '"to all"'
        yarpy.disconnect("topic://news", "/in")
    assert network.run("topic", "--remove", "/news").stdout == "Topic /news deleted\n"
    assert network.run("topic", "--list").stdout == "No topics\n"


def test_persistent_connections(network: CppYarp, peer: CppProgram) -> None:
    """Asked for before the ports exist; made when they do; made again when one comes back."""
    assert network.run("connect", "--persist", "/pw", "/pr").returncode == 0
    assert "Persistent connection /pw -> /pr" in network.run("connect", "--persist").stdout
    with yarpy.Port("/pw") as writer:
        for _ in range(2):
            with yarpy.BufferedPort("/pr", strict=True) as reader:
                flows(lambda n: writer.write([n]), reader)
        # The next one of that name is a C++ program.
        peer.do("port = yarp.BufferedPortBottle(); assert port.open('/pr')")
        wait_until(lambda: writer.outputs, HANG, "the connection to the C++ port is made")
        writer.write([1, 2])
        assert peer.do("port.read().toString()") == "1 2"
        peer.do("port.close()")
    peer.do("port = yarp.Port(); assert port.open('/pw')")
    with yarpy.BufferedPort("/pr", strict=True) as reader:
        flows(lambda n: peer.do(f"port.write(yarp.Bottle('{n}'))"), reader)
        assert network.run("disconnect", "--persist", "/pw", "/pr").returncode == 0
    with yarpy.BufferedPort("/pr", strict=True) as reader:
        time.sleep(1.0)
        assert reader.inputs == [], "a connection that nobody keeps any more does not come back"


def test_a_carrier_of_ones_own(network: CppYarp, peer: CppProgram) -> None:
    """Persistent connections over another carrier than tcp."""
    peer.do("port = yarp.Port(); assert port.open('/pw')")
    assert network.run("connect", "--persist", "/pw", "/pr", "udp").returncode == 0
    with yarpy.BufferedPort("/pr", strict=True) as reader:
        flows(lambda n: peer.do(f"port.write(yarp.Bottle('{n}'))"), reader)
        assert [link.carrier for link in reader.inputs] == ["udp"]
    assert network.run("disconnect", "--persist", "/pw", "/pr").returncode == 0
