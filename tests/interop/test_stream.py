"""Streams between C++ ports and yarpy ports: every carrier, both ways, envelopes, sizes, order."""

import pytest
from support.cpp_program import CppProgram
from support.wait import HANG, wait_until

import yarpy
from yarpy import Bottle, Stamp, Vocab

CARRIERS = ("tcp", "fast_tcp", "udp", "mcast", "text", "text_ack")
VALUE = [1, -2.5, "word", "two words", Vocab("set"), [3, ["deep"], []], b"blob\x00", True, 1 << 40]
TEXT = '1 -2.5 word "two words" [set] (3 (deep) ()) {98 108 111 98 0} true 1099511627776'

OPEN = "port = yarp.Port(); assert port.open('/cpp')"
READ = """
bottle, stamp = yarp.Bottle(), yarp.Stamp()
assert port.read(bottle)
port.getEnvelope(stamp)
[bottle.toString(), stamp.getCount(), stamp.getTime()]
"""


@pytest.mark.parametrize("carrier", CARRIERS)
def test_cpp_sends(peer: CppProgram, carrier: str) -> None:
    peer.do(OPEN)
    with yarpy.Port("/ours") as port:
        assert peer.do(f"yarp.Network.connect('/cpp', '/ours', '{carrier}')")
        assert port.wait_for_inputs(timeout=HANG)
        [link] = port.inputs
        assert (link.source, link.target, link.carrier) == ("/cpp", "/ours", carrier)
        for count in range(3):
            peer.begin(
                f"stamp = yarp.Stamp({count}, 5.25); port.setEnvelope(stamp)\n"
                f"port.write(yarp.Bottle('{TEXT} {count}'))"
            )
            message = port.read(timeout=HANG)
            assert message.value == [*VALUE, count]
            assert message.stamp == Stamp(count, 5.25)
            assert message.source == "/cpp"
            assert peer.end() is True
        assert port.inputs[0].stats.messages == 3
        assert peer.do("yarp.Network.disconnect('/cpp', '/ours')")
        wait_until(lambda: not port.inputs, what="the port sees that its sender left")
        assert peer.do("port.getOutputCount()") == 0


@pytest.mark.parametrize("carrier", CARRIERS)
def test_yarpy_sends(peer: CppProgram, carrier: str) -> None:
    peer.do(OPEN)
    with yarpy.Port("/ours") as port:
        port.connect("/cpp", carrier)
        for count in range(3):
            peer.begin(READ)
            assert port.write([*VALUE, count], Stamp(count, 5.25)) == 1
            assert peer.end() == [f"{TEXT} {count}", count, 5.25]
        assert yarpy.is_connected("/ours", "/cpp")
        assert port.disconnect("/cpp")
        assert port.outputs == []
        assert not yarpy.is_connected("/ours", "/cpp")
        wait_until(lambda: peer.do("port.getInputCount()") == 0)  # its thread ends by and by


def test_who_connects_does_not_matter(peer: CppProgram) -> None:
    """From here, from there, by the sender, by the receiver, by a third party."""
    peer.do(OPEN)
    with yarpy.Port("/ours") as port:
        for connect in (
            lambda: port.connect("/cpp"),
            lambda: yarpy.connect("/ours", "/cpp", "fast_tcp"),
            lambda: peer.do("assert yarp.Network.connect('/ours', '/cpp')"),
        ):
            connect()
            peer.begin(READ)
            port.write(["here"])
            assert peer.end()[0] == "here"
        assert len(port.outputs) == 1
        for connect in (
            lambda: port.listen_to("/cpp"),
            lambda: yarpy.connect("/cpp", "/ours", "text_ack"),
            lambda: peer.do("assert port.addOutput('/ours')"),
        ):
            connect()
            peer.begin("port.write(yarp.Bottle('there'))")
            assert port.read(timeout=HANG).value == ["there"]
            assert peer.end()
        wait_until(lambda: len(port.inputs) == 1, what="those before have gone")


def test_sizes_and_envelopes_of_every_kind(peer: CppProgram) -> None:
    """Messages from nothing to megabytes, both ways over each binary carrier, with odd envelopes"""
    peer.do(f"{OPEN}\ndef measure(bottle): return [bottle.size(), bottle.get(0).asString()]")
    values: list[list[object]] = [[], ["x"], ["y" * 1500], ["z" * 70_000], ["w" * 3_000_000, 1.5]]
    # A datagram carrier loses pieces of big messages on a busy machine.
    for carrier, most in (("tcp", 5), ("fast_tcp", 5), ("udp", 3), ("mcast", 3)):
        with yarpy.Port("/ours") as port:
            port.connect("/cpp", carrier)
            for value in values[:most]:
                peer.begin("bottle = yarp.Bottle(); port.read(bottle); measure(bottle)")
                port.write(value)
                assert peer.end() == [len(value), value[0] if value else ""], carrier
            port.disconnect("/cpp")
            assert peer.do(f"yarp.Network.connect('/cpp', '/ours', '{carrier}')")
            assert port.wait_for_inputs(timeout=HANG)
            for value in values[:most]:
                peer.do(f"bottle = yarp.Bottle(); [bottle.addString(s) for s in {value[:1]!r}]; 0")
                if len(value) > 1:
                    peer.do("bottle.addFloat64(1.5)")
                peer.begin("port.write(bottle)")
                assert port.read(timeout=HANG).value == value, carrier
                assert peer.end()
            peer.do("yarp.Network.disconnect('/cpp', '/ours')")


def test_envelopes_that_are_no_stamps(peer: CppProgram) -> None:
    peer.do(OPEN)
    with yarpy.Port("/ours") as port:
        assert peer.do("yarp.Network.connect('/cpp', '/ours', 'text')")
        for text in ("7 8 nine", '(a b) "c d"'):
            peer.do(f"envelope = yarp.Bottle('{text}'); port.setEnvelope(envelope); 0")
            peer.begin("port.write(yarp.Bottle('x'))")
            message = port.read(timeout=HANG)
            assert message.envelope == text
            assert peer.end()
        port.connect("/cpp")
        for text in ("7 8 nine", '(a b) "c d"'):
            peer.begin(
                "bottle = yarp.Bottle(); port.read(bottle)\n"
                "envelope = yarp.Bottle(); port.getEnvelope(envelope); envelope.toString()"
            )
            port.write(["x"], text)
            assert peer.end() == text


def test_many_in_order(peer: CppProgram) -> None:
    """Thousands without a pause: what is gathered into one send here comes apart there."""
    peer.do(OPEN)
    count = 5000
    with yarpy.BufferedPort("/ours", strict=True) as port:
        for carrier in ("tcp", "fast_tcp"):
            port.connect("/cpp", carrier)
            peer.begin(
                "bottle = yarp.Bottle(); seen = []\n"
                f"for _ in range({count}): port.read(bottle); seen.append(bottle.get(0).asInt32())"
                "\nseen == list(range(len(seen)))"
            )
            for number in range(count):
                port.write([number, "some text"])
            assert port.flush(timeout=HANG)
            assert peer.end() is True
            port.disconnect("/cpp")
            assert peer.do(f"yarp.Network.connect('/cpp', '/ours', '{carrier}')")
            peer.begin(
                "bottle = yarp.Bottle()\n"
                f"for number in range({count}):\n"
                "    bottle.clear(); bottle.addInt32(number); assert port.write(bottle)"
            )
            for number in range(count):
                assert port.read(timeout=HANG).value == [number]
            peer.end()
            peer.do("yarp.Network.disconnect('/cpp', '/ours')")


def test_one_sender_to_many(peer: CppProgram) -> None:
    """One multicast group with receivers of both kinds, and every carrier at once."""
    peer.do(
        "ports = [yarp.Port() for _ in range(4)]\n"
        "for i, port in enumerate(ports): assert port.open(f'/cpp{i}')"
    )
    ours = [yarpy.Port(f"/in{i}") for i in range(2)]
    with yarpy.Port("/ours") as port, ours[0], ours[1]:
        carriers = ("mcast", "mcast", "tcp", "text_ack")
        for index, carrier in enumerate(carriers):
            port.connect(f"/cpp{index}", carrier)
        port.connect("/in0", "mcast")
        port.connect("/in1", "udp")
        peer.begin(
            "answers = []\n"
            "for port in ports:\n"
            "    bottle = yarp.Bottle(); port.read(bottle); answers.append(bottle.toString())\n"
            "answers"
        )
        port.write(["to all", 1])
        assert peer.end() == ['"to all" 1'] * 4
        for reader in ours:
            assert reader.read(timeout=HANG).value == Bottle(["to all", 1])
        # Whoever sends to the group when the first receiver goes, the others go on hearing.
        port.disconnect("/cpp0")
        peer.begin("bottle = yarp.Bottle(); ports[1].read(bottle); bottle.toString()")
        port.write(["again"])
        assert peer.end() == "again"
        assert ours[0].read(timeout=HANG).value == ["again"]
