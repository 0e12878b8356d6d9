"""What is known of a network at one moment."""

from __future__ import annotations

import yarpy
from yarpy.contact import Contact
from yarpy.network.traffic import End, Flow, PortState, Snapshot, read, read_port


def test_what_nobody_counts_is_none() -> None:
    flow = Flow("/a", "/b", End("tcp"), None)
    assert (flow.drops, flow.measured("messages"), flow.carrier) == (None, None, "tcp")
    assert read(yarpy.Property(source="/a", target="/b"))[2] == End()


def test_the_side_that_knows_is_asked() -> None:
    flow = Flow("/a", "/b", End("tcp", drops=1), End("tcp+recv.x", messages=7, drops=2))
    assert (flow.drops, flow.measured("messages"), flow.carrier) == (3, 7, "tcp+recv.x")


def test_drops_by_monitor() -> None:
    told = yarpy.Property(
        source="/a", target="/b", monitors=["one", "two"], dropped=[0, 3], failures=["", "bad"],
        port_monitor="Gate", port_dropped=5, port_failures=["worse"],
    )  # fmt: skip
    end = read(told)[2]
    assert end.dropped == {"one": 0, "two": 3, "Gate of the port": 5}
    assert end.failures == {"two": "bad", "Gate of the port": "worse"}


def test_nonsense_is_none() -> None:
    told = yarpy.Property(
        source=5, target=["/b"], messages="many", rate=float("nan"), jitter="x", monitors=3,
        policy="SCHED_NEVER", packets="AF99", dropped="x", failures=7, parameters=9, asked="x",
        failure="y" * 5000, latency=True,
    )  # fmt: skip
    source, target, end = read(told)
    assert (source, target) == ("", "")
    assert len(end.failure) == 1000
    end.failure = ""
    assert end == End(latency=1.0)


def test_a_connection_belongs_to_its_ends() -> None:
    snapshot = Snapshot(0.0)
    snapshot.add(
        "/a",
        [
            ("out", "/a", "/b", End("tcp")),
            ("in", "/c", "/d", End("tcp")),
            ("out", "/a", "/a", End("udp")),
            ("in", "/a", "/a", End("mcast")),
        ],
    )
    snapshot.add("/b", [("in", "/a", "/b", End("tcp", 5))])
    assert set(snapshot.flows) == {("/a", "/b"), ("/a", "/a")}
    assert snapshot.flows["/a", "/b"] == Flow("/a", "/b", End("tcp"), End("tcp", 5))
    assert snapshot.flows["/a", "/a"] == Flow("/a", "/a", End("udp"), End("mcast"))


def test_a_port_about_itself() -> None:
    state = PortState("/a", Contact("tcp", "/a", "127.0.0.1", 1))
    reply = yarpy.Bottle.from_text(
        '(process ((arguments "write /w") (name yarp) (pid 6208))) (platform ((hostname here)))'
        ' (port ((is_rpc 1) (type "yarp/image")))'
    )
    read_port(state, reply)
    assert (state.pid, state.program, state.host) == (6208, "yarp write /w", "here")
    assert (state.is_rpc, state.type) == (True, "yarp/image")
    read_port(state, yarpy.Bottle(["no"]))
    assert (state.pid, state.program) == (0, "")


def test_a_connection_that_was_dialled_by_address_goes_by_the_names() -> None:
    def snapshot(*places: tuple[str, int]) -> Snapshot:
        found = Snapshot(0.0)
        for name, number in places:
            found.ports[name] = PortState(name, Contact("tcp", name, "127.0.0.1", number))
        found.add("/a", [("out", "/a", "/127.0.0.1:5/", End("tcp", 3))])
        return found

    one = snapshot(("/a", 4), ("/b", 5))
    one.add("/b", [("in", "/a", "/b", End("tcp", 2))])
    one.unite()
    assert one.flows == {("/a", "/b"): Flow("/a", "/b", End("tcp", 3), End("tcp", 2))}
    silent = snapshot(("/a", 4), ("/b", 5))
    silent.unite()
    assert [*silent.flows] == [("/a", "/b")]
    for other in (snapshot(("/a", 4), ("/b", 6)), snapshot(("/a", 4), ("/b", 5), ("/old", 5))):
        other.unite()
        assert [*other.flows] == [("/a", "/127.0.0.1:5/")], "nobody knows which port that is"
    certain = snapshot(("/a", 4), ("/b", 5), ("/old", 5))
    certain.add("/b", [("in", "/a", "/b", End("tcp"))])
    certain.unite()
    assert [*certain.flows] == [("/a", "/b")]
    twice = snapshot(("/a", 4), ("/b", 5))
    twice.add("/a", [("out", "/a", "/b", End("udp"))])
    twice.unite()
    assert len(twice.flows) == 2


def test_a_receiver_may_have_dialled() -> None:
    found = Snapshot(0.0)
    for name, number in (("/a", 4), ("/b", 5)):
        found.ports[name] = PortState(name, Contact("tcp", name, "10.0.0.1", number))
    found.add("/b", [("in", "/10.0.0.1:4/", "/b", End("mjpeg"))])
    found.unite()
    assert found.flows == {("/a", "/b"): Flow("/a", "/b", None, End("mjpeg"))}
