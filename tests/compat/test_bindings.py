"""What the tests of YARP's own Python bindings try, tried anew; old names; files of pictures."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from support.wait import HANG, wait_until

import yarp


@pytest.fixture(autouse=True)
def local() -> Iterator[None]:
    """Names inside this process."""
    yarp.Network.init()
    yarp.Network.setLocalMode(True)
    yield
    yarp.Network.setLocalMode(False)
    yarp.Network.fini()


def test_buffered_ports_open_connect_and_talk() -> None:
    source, target = yarp.BufferedPortBottle(), yarp.BufferedPortBottle()
    assert source.open("/one") and target.open("/two")
    assert yarp.Network.connect(source.getName(), target.getName())
    message = source.prepare()
    message.clear()
    message.addInt32(10)
    source.write(True)
    received = target.read(True)
    assert received.size() == 1 and received.get(0).asInt32() == 10
    source.close()
    target.close()


def test_image_over_the_memory_of_a_vector() -> None:
    out, inp = yarp.Port(), yarp.Port()
    out.enableBackgroundWrite(True)
    assert inp.open("/image/in") and out.open("/image/out")
    assert yarp.Network.connect("/image/out", "/image/in")
    memory = yarp.Vector()
    memory.resize(6 * 4, 0)
    sent, got = yarp.ImageMono(), yarp.ImageMono()
    sent.setExternal(memory, 6, 4)
    assert out.write(sent) and inp.read(got)
    assert (got.width(), got.height()) == (6, 4)
    out.close()
    inp.close()


def test_thread_runs_and_is_joined() -> None:
    class Counter(yarp.Thread):
        def __init__(self) -> None:
            yarp.Thread.__init__(self)
            self.count = 0

        def run(self) -> None:
            self.count += 1

    counter = Counter()
    assert counter.start()
    counter.join()
    assert counter.count == 1 and not counter.isRunning()


def test_periodic_threads() -> None:
    class Periodic(yarp.PeriodicThread):
        def run(self) -> None:
            done.set()

    for thread in (Periodic(0.005),):
        done = threading.Event()
        assert thread.start() and done.wait(HANG)
        wait_until(lambda thread=thread: thread.getIterations() > 2)
        thread.suspend()
        assert thread.isSuspended()
        assert thread.stop() and not thread.isRunning()
    assert yarp.RateThread(20).getPeriod() == pytest.approx(0.02)


def test_vectors_and_rows_of_matrices() -> None:
    assert [*yarp.Vector(3)] == [0, 0, 0]
    vector = yarp.Vector([1, 2, 3])
    again = yarp.Vector(vector)
    again[0] = 5
    assert vector[0] == 1 and again.get(0) == 5
    matrix = yarp.Matrix(3, 3)
    row = matrix.eye().getRow(1)
    assert [*row] == [0, 1, 0]
    assert vector.setSubvector(1, yarp.Vector([8, 9])) and [*vector] == [1, 8, 9]
    assert not vector.setSubvector(2, yarp.Vector([8, 9]))


def test_matrices() -> None:
    matrix = yarp.Matrix(2, 3)
    assert matrix.setRow(0, yarp.Vector([1, 2, 3])) and matrix.setCol(1, yarp.Vector([7, 8]))
    assert matrix.toString(1) == " 1.0\t 7.0\t 3.0\n 0.0\t 8.0\t 0.0"
    assert matrix.submatrix(0, 1, 1, 2).toString(0) == " 7\t 3\n 8\t 0"
    assert matrix.transposed().getRow(1).toString(0) == " 7\t 8"
    assert not matrix.setRow(5, yarp.Vector(3)) and not matrix.setCol(0, yarp.Vector(9))
    assert matrix.setSubmatrix(yarp.Matrix(1, 1), 0, 0) and matrix.get(0, 0) == 0.0
    assert matrix.setSubrow(yarp.Vector([4, 5]), 1, 0) and [*matrix.getRow(1)] == [4, 5, 0]
    assert matrix.setSubcol(yarp.Vector([6]), 0, 2) and matrix[0, 2] == 6
    assert [*matrix.subrow(1, 0, 2)] == [4, 5] and [*matrix.subcol(0, 0, 2)] == [0, 4]
    assert matrix.removeCols(0, 1).cols() == 2 and matrix.removeRows(0, 1).rows() == 1
    diagonal = yarp.Matrix(2, 2).diagonal(yarp.Vector([1, 2]))
    assert diagonal[1, 1] == 2 and diagonal.isEqual(yarp.Matrix(diagonal))


def test_what_nobody_can_read_or_send() -> None:
    assert yarp.Bottle("(" * 5000).size() == 0
    assert yarp.Property("(" * 5000).toString() == ""
    port, buffered = yarp.Port(), yarp.BufferedPortBottle()
    reader = yarp.BufferedPortBottle()
    assert port.open("/p") and buffered.open("/b") and reader.open("/r")
    assert yarp.Network.connect("/p", "/r") and yarp.Network.connect("/b", "/r")
    deep = inner = yarp.Bottle()
    for _ in range(200):
        inner = inner.addList()
    assert not port.write(deep)
    buffered.prepare().copy(deep)
    buffered.write()
    assert port.write(yarp.Bottle("fine")) and reader.read().toString() == "fine"
    for one in (port, buffered, reader):
        one.close()


def test_reader_that_fails_goes_on() -> None:
    class Failing(yarp.PortReader):
        def read(self, connection: yarp.ConnectionReader) -> bool:
            seen.append(connection.getSize())
            raise ValueError("a mistake in the program")

    seen: list[int] = []
    reader, inp, out = Failing(), yarp.Port(), yarp.Port()
    inp.setReader(reader)
    assert inp.open("/in") and out.open("/out") and yarp.Network.connect("/out", "/in")
    assert out.write(yarp.Bottle("1")) and out.write(yarp.Bottle("2"))
    wait_until(lambda: len(seen) == 2)
    out.close()
    inp.close()


def test_texts_for_people() -> None:
    assert repr(yarp.Bottle("1 (2)")) == "<yarp.Bottle 1 (2)>"
    assert repr(yarp.Value(3)) == "<yarp.Value 3>"
    assert repr(yarp.Property("(a 1)")) == "<yarp.Property (a 1)>"


@pytest.mark.parametrize("carrier", ["local", "tcp"])
def test_what_was_written_may_be_changed_at_once(carrier: str) -> None:
    inp, out = yarp.BufferedPortBottle(), yarp.Port()
    inp.setStrict()
    assert inp.open("/in") and out.open("/out")
    assert yarp.Network.connect("/out", "/in", carrier)
    bottle = yarp.Bottle("first")
    for text in ("second", "third"):
        assert out.write(bottle)
        bottle.fromString(text)
    assert [inp.read().toString() for _ in range(2)] == ["first", "second"]
    image, got = yarp.ImageMono(), yarp.ImageMono()
    image.resize(2, 2)
    reader = yarp.Port()
    assert reader.open("/reader") and yarp.Network.connect("/out", "/reader", carrier)
    assert yarp.Network.disconnect("/out", "/in")
    writer = threading.Thread(target=out.write, args=(image,))
    writer.start()
    assert reader.read(got) and got.width() == 2
    writer.join()
    for port in (inp, out, reader):
        port.close()


def test_old_names() -> None:
    bottle = yarp.Bottle()
    bottle.addInt(1)
    bottle.addDouble(2.5)
    assert bottle.get(0).asInt() == 1 and bottle.get(1).asDouble() == 2.5
    yarp.Time.delay(0.001)
    yarp.Time_delay(0.001)
    assert yarp.Time.now() > 0 and yarp.Time_now() > 0
    assert yarp.Value_makeInt(3).isInt() and yarp.Value_makeDouble(2).isDouble()
    assert yarp.TypedReaderCallbackVector is yarp.VectorCallback


def test_pictures_in_files(tmp_path: Path) -> None:
    image = yarp.ImageRgb()
    image.resize(3, 2)
    image.zero()
    image.pixel(2, 1).g = 200
    path = str(tmp_path / "picture.ppm")
    assert yarp.write(image, path)
    again = yarp.ImageRgb()
    assert yarp.read(again, path) and again.pixel(2, 1).g == 200
    grey = yarp.ImageMono()
    assert yarp.read(grey, path) and grey.pixel(2, 1) == 66
    assert yarp.write(grey, path) and yarp.read(grey, path) and grey.width() == 3
    numbers = yarp.ImageFloat()
    assert yarp.read(numbers, path)
    assert yarp.write(numbers, path) and yarp.read(numbers, path)
    assert numbers.pixel(2, 1) == 66.0
    assert not yarp.read(image, str(tmp_path / "none.ppm"))
    for wrong in (b"P6\n9999999 9999999\n255\n", b"P6\nx", b"P5", b"\xff\xfe"):
        Path(path).write_bytes(wrong)
        assert not yarp.read(image, path)


def test_numpy_and_images() -> None:
    array = np.arange(24, dtype=np.uint8).reshape(2, 4, 3)
    image = yarp.ImageRgb()
    image.setExternal(array, 4, 2)
    image.pixel(0, 0).r = 99
    assert array[0, 0, 0] == 99
    assert (np.asarray(image) == array).all()
    other = yarp.ImageRgb()
    other.resize(4, 2)
    other.zero()
    assert image.copy(other) and not array.any()  # foreign memory is filled
    with pytest.raises(ValueError, match="24 bytes, here are 5"):
        image.setExternal(bytes(5), 4, 2)
    with pytest.raises(TypeError, match="contiguous"):
        image.setExternal(array[:, ::2], 2, 2)
    with pytest.raises(IndexError):
        image.pixel(9, 9)
    fixed = yarp.ImageRgb()
    fixed.setExternal(bytes(24), 4, 2)  # cannot be written to
    assert fixed.copy(image)


def test_numbers_of_another_size_earn_one_warning(capfd: pytest.CaptureFixture[str]) -> None:
    image = yarp.ImageMono16()
    numbers = np.ones((2, 4), np.float64)
    image.setExternal(numbers, 4, 2)  # as in C++: bytes are bytes
    assert (image.width(), image.pixel(3, 0)) == (4, 0x3FF0)
    said = capfd.readouterr().err
    assert "ImageMono16.setExternal takes the bytes" in said and "8 (format 'd')" in said
    image.setExternal(numbers, 4, 2)
    image.setExternal(numbers.astype("u2"), 4, 2)
    image.setExternal(yarp.Vector(8), 4, 2)
    assert capfd.readouterr().err == ""


def test_received_picture_fills_foreign_memory() -> None:
    out, inp = yarp.Port(), yarp.Port()
    assert inp.open("/in") and out.open("/out") and yarp.Network.connect("/out", "/in")
    array = np.zeros((2, 4, 3), np.uint8)
    target = yarp.ImageRgb()
    target.setExternal(array, 4, 2)
    source = yarp.ImageRgb()
    source.resize(4, 2)
    source.zero()
    source.pixel(3, 1).b = 7
    assert out.write(source) and inp.read(target)
    assert array[1, 3, 2] == 7
    out.close()
    inp.close()


def test_reports_of_connections() -> None:
    class Report(yarp.PortReport):
        def report(self, info: yarp.PortInfo) -> None:
            seen.append((info.incoming, info.created, info.sourceName))

    seen: list[tuple[bool, bool, str]] = []
    report = Report()
    out, inp = yarp.Port(), yarp.Port()
    inp.setReporter(report)
    assert inp.open("/in") and out.open("/out") and yarp.Network.connect("/out", "/in")
    wait_until(lambda: (True, True, "/out") in seen)
    out.close()
    wait_until(lambda: (True, False, "/out") in seen)
    inp.close()


def test_reader_that_reads_piece_by_piece() -> None:
    class Reader(yarp.PortReader):
        def read(self, connection: yarp.ConnectionReader) -> bool:
            head = [connection.expectInt32() for _ in range(4)]
            seen.append((head, connection.getSize(), connection.isError()))
            connection.expectInt64()
            seen.append(connection.isError())
            writer = connection.getWriter()
            if writer is not None:
                for number in (256, 1, 1, 42):
                    writer.appendInt32(number)
            return True

    seen: list[object] = []
    reader = Reader()
    inp, out, reply = yarp.Port(), yarp.Port(), yarp.Bottle()
    inp.setReader(reader)
    assert inp.open("/in") and out.open("/out") and yarp.Network.connect("/out", "/in")
    assert out.write(yarp.Bottle("5"), reply)
    assert seen == [([257, 1, 5, 0], 0, True), True]
    assert reply.toString() == "42"
    inp.close()
    out.close()


def test_asking_without_a_port() -> None:
    class Reader(yarp.PortReader):
        def read(self, connection: yarp.ConnectionReader) -> bool:
            command = yarp.Bottle()
            command.read(connection)
            writer = connection.getWriter()
            if writer is not None:
                command.write(writer)
            return True

    reader, inp, reply = Reader(), yarp.Port(), yarp.Bottle()
    inp.setReader(reader)
    assert inp.open("/echo")
    contact = yarp.Network.queryName("/echo")
    assert yarp.Network.write(contact, yarp.Bottle("hello"), reply) and reply.toString() == "hello"
    style = yarp.ContactStyle()
    style.admin = True
    assert yarp.Network.write(contact, yarp.Bottle("[ver]"), reply, style)
    assert reply.get(0).asString() == "ver"
    assert not yarp.Network.write(yarp.Contact("/none"), yarp.Bottle("x"), reply)
    inp.close()


def test_port_without_a_name_opens_without_a_name_server(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("YARP_CONFIG_HOME", str(tmp_path))
    monkeypatch.delenv("YARPY_SERVER", raising=False)
    yarp.Network.setLocalMode(False)
    source, target = yarp.Port(), yarp.BufferedPortBottle()
    assert source.open("") and target.open("")
    assert not yarp.Port().open("/named") and not yarp.Port().open("...")
    place = target.where()
    assert place.isValid() and target.getName().startswith("/")
    assert source.addOutput(f"tcp://{place.getHost()}:{place.getPort()}")
    source.write(yarp.Bottle("hello"))
    assert target.read().toString() == "hello"
    source.close()
    target.close()
