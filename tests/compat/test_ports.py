"""Classes that ports have in common, what they carry, and what is said to name servers."""

import threading
import time

import pytest
from support.lasted import lasted
from support.wait import HANG, wait_until

import yarp


@pytest.fixture
def alone():
    yarp.Network.setLocalMode(True)
    yield
    yarp.Network.setLocalMode(False)


def test_bases() -> None:
    assert issubclass(yarp.BufferedPortBottle, yarp.TypedReaderBottle)
    assert issubclass(yarp.BufferedPortImageRgb, yarp.TypedReaderImageRgb)
    assert not issubclass(yarp.BufferedPortImageRgb, yarp.TypedReaderBottle)
    assert issubclass(yarp.Port, yarp.UnbufferedContactable)
    assert issubclass(yarp.RpcServer, yarp.AbstractContactable)
    assert issubclass(yarp.RpcClient, yarp.AbstractContactable)


def test_a_port_that_is_another_one(alone) -> None:
    class Named(yarp.AbstractContactable):
        def __init__(self) -> None:
            self.inner = yarp.Port()

        def asPort(self) -> yarp.Port:
            return self.inner

    port, into = Named(), yarp.BufferedPortBottle()
    assert into.open("/bases/in") and port.open("/bases/out")
    assert port.getName() == "/bases/out" and port.addOutput("/bases/in")
    assert port.write(yarp.Bottle("hello"))
    assert into.read().toString() == "hello"
    port.close()
    into.close()
    assert not port.inner.isOpen()


def test_ports_of_maps(alone) -> None:
    out, into = yarp.BufferedPortMap2DArea(), yarp.BufferedPortMap2DArea()
    assert into.open("/maps/in") and out.open("/maps/out")
    assert yarp.Network.connect("/maps/out", "/maps/in", "tcp")
    area = out.prepare()
    area.map_id, area.points = "kitchen", [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0)]
    out.write(True)
    came = into.read()
    assert came.isEqual(area) and isinstance(into, yarp.TypedReaderMap2DArea)
    out.close()
    into.close()


def test_one_message_without_a_port(alone) -> None:
    into = yarp.BufferedPortBottle()
    assert into.open("/message/in")
    assert yarp.Network.sendMessage("/message/in", yarp.Bottle("5 apples"))
    assert into.read().toString() == "5 apples"
    assert not yarp.Network.sendMessage("/message/nobody", yarp.Bottle("5"), True)
    into.close()


def test_types() -> None:
    image = yarp.ImageRgb()
    assert image.getType().getName() == "yarp/image" and image.getWriteType().isValid()
    assert yarp.Vector(2).getReadType().toString() == "yarp/vector"
    assert not yarp.Bottle().getType().hasName() and yarp.Type.anon().toString() == "null"
    kind = yarp.Type.byName("a", "b").addProperty("key", yarp.Value(5))
    assert kind.toString() == "a:b" and kind.readProperties().find("key").asInt32() == 5
    assert yarp.Type.byNameOnWire("x").getName() == "yarp/bottle"
    port = yarp.Port()
    port.promiseType(kind)
    assert port.getType() is kind


def test_namespace_and_address_of_the_server(monkeypatch, tmp_path) -> None:
    monkeypatch.setenv("YARP_CONFIG_HOME", str(tmp_path))
    for name in ("YARP_NAMESPACE", "YARPY_SERVER"):
        monkeypatch.delenv(name, raising=False)
    assert yarp.Network.setNameServerName("/lab") and not yarp.Network.setNameServerName("lab")
    assert yarp.Network.getNameServerName() == "/lab"
    assert yarp.Network.setNameServerContact(yarp.Contact("", "tcp", "127.0.0.1", 10123))
    assert not yarp.Network.setNameServerContact(yarp.Contact())
    kept = [each.read_text().split() for each in tmp_path.rglob("*") if each.is_file()]
    assert ["127.0.0.1", "10123", "yarp"] in kept


def test_things_are_read_as_what_they_are_asked_for() -> None:
    things = yarp.Things()
    assert things.asBottle() is None
    bottle = yarp.Bottle("1 2")
    things.setPortWriter(bottle)
    assert things.asBottle() is bottle and things.asVector() is None
    dummy = yarp.DummyConnector()
    assert things.write(dummy.getWriter())
    things.setConnectionReader(dummy.getReader())
    assert things.getPortWriter() is None and not things.hasBeenRead()
    assert things.asBottle().toString() == "1 2" and things.hasBeenRead()
    assert things.asProperty() is None
    again = yarp.DummyConnector()
    assert things.write(again.getCleanWriter())
    assert yarp.Bottle().read(again.getReader())
    things.reset()
    assert not things.write(dummy.getCleanWriter())


def test_pictures_as_things() -> None:
    image = yarp.ImageRgb()
    image.resize(2, 2)
    dummy = yarp.DummyConnector()
    image.write(dummy.getWriter())
    things = yarp.Things()
    things.setConnectionReader(dummy.getReader())
    assert things.asImage().width() == 2 and things.asImageOfPixelBgr() is None
    things.setConnectionReader(dummy.getReader())
    assert things.asImageOfPixelRgb().height() == 2 and things.asImageOfPixelMono() is None


def test_pieces_of_a_connection() -> None:
    dummy = yarp.DummyConnector()
    writer = yarp.ConnectionWriter.createBufferedConnectionWriter()
    assert isinstance(writer, yarp.ConnectionWriter)
    out = dummy.getWriter()
    out.appendInt32(7)
    out.appendBlock(b"abcd")
    reader = dummy.getReader()
    assert reader.pushInt(5) and not reader.pushInt(6)
    assert [reader.expectInt32(), reader.expectInt32()] == [5, 7]
    block = bytearray(4)
    assert reader.expectBlock(block, 2) and block == b"ab\0\0"
    assert not reader.expectBlock(block) and reader.isError()
    dummy = yarp.DummyConnector()
    dummy.setTextMode(True)
    yarp.Bottle("hello 42").write(dummy.getWriter())
    text = dummy.getReader()
    assert text.isTextMode() and text.expectText() == "hello 42"


def test_who_looks_for_what() -> None:
    heard = []

    class Monitor(yarp.SearchMonitor):
        def report(self, report: yarp.SearchReport, context: str) -> None:
            heard.append((context, report.key, report.isFound, report.isGroup, report.isDefault))

    options = yarp.Property("(width 5) (camera (left 1))")
    monitor = Monitor()
    options.setMonitor(monitor, "grabber")
    assert options.find("width").asInt32() == 5 and options.find("height").isNull()
    options.findGroup("camera")
    assert options.check("height", yarp.Value(3)).asInt32() == 3
    assert heard[:3] == [
        ("grabber", "width", True, False, False),
        ("grabber", "height", False, False, False),
        ("grabber", "camera", True, True, False),
    ]
    assert ("grabber", "height", False, False, True) in heard
    assert options.getMonitor() is monitor and options.getMonitorContext() == "grabber"
    options.setMonitor(None)
    count = len(heard)
    options.find("width")
    assert len(heard) == count


def test_readers_that_are_made(alone) -> None:
    seen = []

    class Reader(yarp.PortReader):
        def read(self, connection) -> bool:
            bottle = yarp.Bottle()
            bottle.read(connection)
            seen.append(bottle.toString())
            return True

    class Creator(yarp.PortReaderCreator):
        def create(self) -> Reader:
            return Reader()

    into = yarp.Port()
    into.setReaderCreator(Creator())
    assert into.open("/made/in") and yarp.Network.sendMessage("/made/in", yarp.Bottle("hi"))
    wait_until(lambda: seen == ["hi"])
    into.close()


def test_a_reader_that_is_at_work_is_not_waited_for_for_long(
    alone, capsys: pytest.CaptureFixture[str]
) -> None:
    """As where Ctrl-C ends a module whose `respond` asks somebody who is silent."""
    begun, go_on = threading.Event(), threading.Event()

    class Reader(yarp.PortReader):
        def read(self, connection: yarp.ConnectionReader) -> bool:
            if connection.isValid():  # it is not, where the reader is told of the end
                begun.set()
                go_on.wait(HANG)
            return True

    reader, into = Reader(), yarp.Port()
    into.setReader(reader)
    assert into.open("/slow/in") and yarp.Network.sendMessage("/slow/in", yarp.Bottle("hi"))
    assert begun.wait(HANG)
    started = time.monotonic()
    into.close()
    assert lasted(started) < 8
    go_on.set()
    assert "/slow/in: its reader is still at work" in capsys.readouterr().err
