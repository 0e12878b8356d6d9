"""Buffered ports between C++ and yarpy: latest or all, slow readers, callbacks, and every drop."""

import queue
import time
from collections.abc import Iterator

import pytest
from support.cpp import CppYarp
from support.cpp_program import CppProgram
from support.lasted import lasted
from support.wait import HANG, wait_until

import yarpy
from yarpy import Message, Stamp
from yarpy.network.peek import Peek

COUNT = 200


@pytest.fixture(scope="module")
def network(our_names: CppYarp) -> CppYarp:
    """One name server is enough: what is shown here does not depend on it."""
    return our_names


def poured(port: yarpy.BufferedPort) -> Iterator[int]:
    """The numbers that are there."""
    while (message := port.poll()) is not None:
        yield message.value[0]


def test_we_keep_the_latest(peer: CppProgram) -> None:
    peer.do("port = yarp.Port(); assert port.open('/cpp')")
    with yarpy.BufferedPort("/ours") as port:
        port.listen_to("/cpp")
        peer.do(f"for n in range({COUNT}): port.write(yarp.Bottle(str(n)))")
        [link] = port.inputs
        wait_until(lambda: link.stats.messages == COUNT, what="all have arrived")
        assert list(poured(port)) == [COUNT - 1]
        assert link.stats.replaced == COUNT - 1


def test_we_keep_all(peer: CppProgram) -> None:
    peer.do("port = yarp.BufferedPortBottle(); assert port.open('/cpp')")
    with yarpy.BufferedPort("/ours", strict=True) as port:
        port.listen_to("/cpp")
        peer.do(
            f"for n in range({COUNT}):\n"
            "    bottle = port.prepare(); bottle.clear(); bottle.addInt32(n); port.writeStrict()\n"
            "port.waitForWrite()"
        )
        [link] = port.inputs
        wait_until(lambda: link.stats.messages == COUNT, what="all have arrived")
        assert port.waiting == COUNT
        assert list(poured(port)) == list(range(COUNT))
        assert link.stats.drops == 0


def test_they_keep_the_latest(peer: CppProgram) -> None:
    peer.do("port = yarp.BufferedPortBottle(); assert port.open('/cpp')")
    with yarpy.BufferedPort("/ours", strict=True) as port:
        port.connect("/cpp")
        for number in range(COUNT):
            port.write([number])
        assert port.flush(timeout=HANG)
        assert peer.do("port.read().get(0).asInt32()") == COUNT - 1
        assert peer.do("port.getPendingReads()") == 0


def test_they_keep_all(peer: CppProgram) -> None:
    peer.do("port = yarp.BufferedPortBottle(); assert port.open('/cpp'); port.setStrict()")
    with yarpy.BufferedPort("/ours", strict=True) as port:
        port.connect("/cpp")
        for number in range(COUNT):
            port.write([number], Stamp(number, number + 0.5))
        assert port.flush(timeout=HANG)
        assert peer.do("port.getPendingReads()") == COUNT
        seen = peer.do(
            "seen, stamp = [], yarp.Stamp()\n"
            f"for _ in range({COUNT}):\n"
            "    number = port.read().get(0).asInt32(); port.getEnvelope(stamp)\n"
            "    seen.append([number, stamp.getCount(), stamp.getTime()])\n"
            "seen"
        )
        assert seen == [[n, n, n + 0.5] for n in range(COUNT)]


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "text_ack"])
def test_a_slow_reader_of_theirs_does_not_hold_us_up(peer: CppProgram, carrier: str) -> None:
    """sent + dropped = written, and what was sent arrives in order."""
    peer.do("port = yarp.Port(); assert port.open('/cpp'); bottle = yarp.Bottle()")
    with yarpy.BufferedPort("/ours") as port:
        port.connect("/cpp", carrier)
        began = time.monotonic()
        sent = [number for number in range(COUNT) if port.write([number])]
        assert lasted(began) < 10
        seen = peer.do(
            f"seen = []\nfor _ in range({len(sent)}):\n"
            "    port.read(bottle); seen.append(bottle.get(0).asInt32())\nseen"
        )
        assert seen == sent
        [link] = port.outputs
        # A message counts once it is confirmed, and the reader has it before that.
        wait_until(lambda: link.stats.messages == len(sent), what="every message sent is counted")
        assert link.stats.replaced == COUNT - len(sent)
        if carrier != "fast_tcp":
            assert 1 <= len(sent) < 10, "the reader did not read while we wrote"
        wait_until(lambda: port.write(["again"]), what="a reader that caught up gets the next one")
        assert peer.do("port.read(bottle); bottle.toString()") == "again"


def test_a_slow_reader_of_ours_does_not_hold_them_up(peer: CppProgram) -> None:
    peer.do("port = yarp.BufferedPortBottle(); assert port.open('/cpp')")
    with yarpy.Port("/ours") as port:
        port.listen_to("/cpp")
        took = peer.do(
            "began = time.time()\n"
            f"for n in range({COUNT}):\n"
            "    bottle = port.prepare(); bottle.clear(); bottle.addInt32(n); port.write()\n"
            "time.time() - began"
        )
        assert took < 10
        seen = [port.read(timeout=HANG).value[0]]
        while True:
            try:
                seen.append(port.read(timeout=0.3).value[0])
            except yarpy.Timeout:
                break
        assert seen[0] == 0
        assert seen == sorted(set(seen))
        assert len(seen) < COUNT, "what came while we did not read was dropped by the sender"


def test_a_plain_port_holds_its_sender_up(peer: CppProgram) -> None:
    """A C++ Port.write returns when the message was read here."""
    peer.do("port = yarp.Port(); assert port.open('/cpp')")
    with yarpy.Port("/ours") as port:
        port.listen_to("/cpp")
        peer.begin("port.write(yarp.Bottle('1')) and port.write(yarp.Bottle('2')) and time.time()")
        time.sleep(0.3)
        before = time.time()
        assert port.read(timeout=HANG).value == [1]
        assert port.read(timeout=HANG).value == [2]
        assert peer.end() >= before


def test_callbacks(peer: CppProgram) -> None:
    """Ours in the thread of the connection; theirs through the binding's director class."""
    arrived: queue.Queue[Message] = queue.Queue()
    peer.do(
        "class Answer(yarp.BottleCallback):\n"
        "    def onRead(self, bottle, *rest):\n"
        "        reply = out.prepare(); reply.copy(bottle); reply.addString('seen')\n"
        "        out.write(True); answered.append(1)\n"
        "answered = []\n"
        "port, out = yarp.BufferedPortBottle(), yarp.BufferedPortBottle()\n"
        "assert port.open('/cpp/in') and out.open('/cpp/out')\n"
        "callback = Answer(); port.setStrict(); port.useCallback(callback)"
    )
    with (
        yarpy.Port("/out") as source,
        yarpy.BufferedPort("/in", callback=arrived.put),
    ):
        source.connect("/cpp/in")
        yarpy.connect("/cpp/out", "/in")
        # The director needs Python over there to run now and then.
        peer.begin("while len(answered) < 5: time.sleep(0.01)")
        for number in range(5):
            source.write([number])
            assert arrived.get(timeout=HANG).value == [number, "seen"]
        peer.end()
        peer.do("port.disableCallback()")


def test_interrupt_and_resume(peer: CppProgram) -> None:
    """An interrupted port eats what comes, and its sender goes on."""
    peer.do("port = yarp.Port(); assert port.open('/cpp')")
    with yarpy.BufferedPort("/ours", strict=True) as port:
        port.listen_to("/cpp")
        peer.do("port.write(yarp.Bottle('1'))")
        assert port.read(timeout=HANG).value == [1]
        port.interrupt()
        assert peer.do("[port.write(yarp.Bottle('2')) for _ in range(3)]") == [True] * 3
        with pytest.raises(yarpy.PortClosed):
            port.read(timeout=1)
        port.resume()
        assert peer.do("port.write(yarp.Bottle('3'))")
        assert port.read(timeout=HANG).value == [3]
        assert port.inputs[0].stats.drops == 3
        # ... and theirs.
        port.connect("/cpp")
        peer.do("port.interrupt()")
        for number in range(3):
            port.write([number])
        port.flush(timeout=2)
        peer.do("port.resume()")
        peer.begin("bottle = yarp.Bottle(); port.read(bottle); bottle.toString()")
        port.write(["after"])
        assert peer.end() == "after"


def test_a_look_at_what_they_write(peer: CppProgram) -> None:
    peer.do("port = yarp.BufferedPortBottle(); assert port.open('/cpp')")
    contact = yarpy.query("/cpp")
    assert contact is not None
    with Peek(contact) as peek:
        wait_until(lambda: peer.do("port.getOutputCount()") == 1)
        peer.do(
            f"for n in range({COUNT}):\n"
            "    bottle = port.prepare(); bottle.clear(); bottle.addInt32(n); port.writeStrict()\n"
            "port.waitForWrite()"
        )
        wait_until(lambda: peek.count == COUNT)
        assert peek.newest is not None
        assert peek.newest.value == yarpy.Bottle([COUNT - 1])
