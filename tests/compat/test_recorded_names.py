"""The recorded names of both versions are here; what has no meaning in Python says so."""

import io
import math
from pathlib import Path
from types import ModuleType

import pytest

import yarp
import yarpy


@pytest.mark.parametrize("version", ["3.9.1", "4.0.0"])
def test_every_recorded_name_is_here(generate: ModuleType, version: str) -> None:
    found = generate.score(version)
    assert found.missing == []
    assert found.members == 1.0
    assert found.working >= 0.995, found.refusing
    assert {name.partition(".")[2] for name in found.refusing} == {"get_allocator"}


def test_what_refuses_says_what_to_do(generate: ModuleType) -> None:
    for name in generate.score("3.9.1").refusing:
        owner, _, member = name.partition(".")
        refuse = generate.find(getattr(yarp, owner), member)
        count = refuse.__code__.co_argcount
        with pytest.raises(NotImplementedError, match=r".{20}"):
            refuse(*[None] * count)
    with pytest.raises(NotImplementedError, match="means nothing in Python"):
        yarp.LogStream()


def test_what_bindings_of_4_0_0_have_beside_the_recorded_names() -> None:
    """Macros and what SWIG inherits."""
    version = yarp.YARP_VERSION_MAJOR, yarp.YARP_VERSION_MINOR, yarp.YARP_VERSION_PATCH
    assert yarp.YARP_VERSION_HEX.to_bytes(3, "big") == bytes(version)
    assert isinstance(yarp.PortablePair(), yarp.PortablePairBase)
    assert issubclass(yarp.PortablePairBase, yarp.Portable)
    driver = yarp.PolyDriver()
    assert driver.id() == ""
    assert driver.open("(device fakeJoypad)") and driver.id() == "fakeJoypad"
    assert driver.open("(device fakeJoypad) (id pad)") and driver.id() == "pad"
    driver.setId("other")
    assert driver.id() == "other" and driver.close()


def test_a_topic_of_a_node() -> None:
    contact = yarp.Contact("/a")
    assert not contact.getNested().isNested()
    contact.setNestedContact(yarp.NestedContact("/chatter+@/talker"))
    nested = contact.getNested()
    assert (nested.getNestedName(), nested.getNodeName()) == ("/chatter", "/talker")
    assert nested.getCategory() == "+" and nested.toString() == "/chatter+@/talker"
    service = yarp.NestedContact("tcp://add-1@/adder~Sum")
    assert (service.getNestedName(), service.getCategory()) == ("/add", "-1")
    assert service.getTypeName() == "Sum" and service.getNodeName() == "/adder"
    old = yarp.NestedContact("/node=+/topic")
    assert (old.getNodeName(), old.getCategory(), old.getNestedName()) == ("/node", "+", "/topic")
    older = yarp.NestedContact("/node-#/topic")
    assert (older.getNodeName(), older.getCategory()) == ("/node", "-")
    plain = yarp.NestedContact()
    assert not plain.fromString("/port") and plain.getTypeNameStar() == "*"


def test_pixels_of_a_size_without_a_kind() -> None:
    image = yarp.FlexImage()
    image.setPixelCode(yarp.encode("rgb"))
    image.setPixelSize(3)
    assert image.getPixelCode() == yarp.encode("rgb")
    image.setPixelSize(5)
    assert image.getPixelCode() == -5 and image.getPixelSize() == 5


def test_a_name_server_is_looked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []

    def search(namespace: str, port: int) -> yarpy.Contact:
        asked.append(namespace)
        return yarpy.Contact(namespace, "tcp", "10.0.0.7", 10000)

    def unknown(name: str, **options: object) -> None:
        raise yarpy.NoNameServer("none")

    monkeypatch.setattr("yarpy.names.discovery.search", search)
    monkeypatch.setattr(yarpy, "query", unknown)
    scanned, used = yarp.BVector(1), yarp.BVector(1)
    found = yarp.Network.detectNameServer(False, scanned, used)
    assert (found.getHost(), found.getPort()) == ("10.0.0.7", 10000) and len(asked) == 1
    assert scanned[0] and not used[0]


def test_readers_and_writers_of_streams() -> None:
    stream, bottle = io.BytesIO(), yarp.Bottle("hello 4")
    assert yarp.ConnectionWriter.writeToStream(bottle, stream)
    again = yarp.Bottle()
    stream.seek(0)
    assert yarp.ConnectionReader.readFromStream(again, stream) and again.toString() == "hello 4"
    writer = yarp.ConnectionWriter()
    for number in (1, 2, 3):
        writer.appendInt32(number)
    reader = yarp.ConnectionReader.createConnectionReader(writer.getBuffer())
    assert reader.expectInt32() == 1 and reader.setSize(4) and not reader.setSize(5)
    assert reader.expectInt32() == 2 and reader.getSize() == 0
    assert reader.expectInt32() == 0 and reader.isError()
    assert reader.getConnectionModifiers().toString() == "" and reader.getReference() is None
    there, thing = yarp.DummyConnector(), yarp.Bottle("x")
    there.getWriter().setReference(thing)
    assert there.getReader().getReference() is thing
    child = yarp.ConnectionReader.createConnectionReader(b"")
    child.setParentConnectionReader(yarp.ConnectionReader(_message("/far")))
    assert child.getRemoteContact().getName() == "/far"


def _message(source: str) -> yarpy.Message:
    message = yarpy.Message("D", b"")
    message.source = source
    return message


def test_two_objects_in_a_message() -> None:
    class Pair(yarp.Portable):
        def __init__(self, head: yarp.Bottle, body: yarp.Vector) -> None:
            self.head, self.body = head, body

        def write(self, writer: yarp.ConnectionWriter) -> bool:
            return yarp.PortablePairBase.writePair(writer, self.head, self.body)

        def read(self, reader: yarp.ConnectionReader) -> bool:
            return yarp.PortablePairBase.readPair(reader, self.head, self.body)

    sent = Pair(yarp.Bottle("about (1 2)"), yarp.Vector([1.5, 2.5]))
    got = Pair(yarp.Bottle(), yarp.Vector())
    assert yarp.Portable.copyPortable(sent, got)
    assert got.head.toString() == "about (1 2)" and [*got.body] == [1.5, 2.5]
    three = yarp.ConnectionReader.createConnectionReader(yarp.Bottle("1 2 3").toBinary())
    assert not yarp.PortablePairBase.readPair(three, yarp.Bottle(), yarp.Bottle())
    ready = yarp.PortablePair(body=yarp.Vector())
    assert yarp.Portable.copyPortable(sent, ready)
    assert ready.head.toString() == "about (1 2)" and [*ready.body] == [1.5, 2.5]


def test_words_of_eight_letters() -> None:
    bottle = yarp.Bottle()
    bottle.addVocab64("position")
    bottle.addVocab64(yarp.encode64("velo"))
    first = bottle.get(0)
    assert first.isVocab64() and first.asVocab64() == yarp.encode64("position")
    assert first.asString() == "position" and bottle.toString() == "position velo"
    assert not yarp.Value("position").isVocab64() and yarp.Value(7).asVocab64() == 7
    assert yarp.Value(1.5).asVocab64() == 0
    sent = yarp.Bottle()
    assert yarp.Portable.copyPortable(bottle, sent)
    assert sent.get(0).isString() and not sent.get(0).isVocab64()


def test_markers_of_sounds() -> None:
    sound = yarp.Sound()
    sound.resize(6, 2)
    sound.setFrequency(8000)
    sound.set(70, 3, 1)
    sound.add_marker("begin", 2)
    sound.add_marker("end", 4, 1)
    again = yarp.Sound()
    assert yarp.Portable.copyPortable(sound, again) and again.get(3, 1) == 70
    where, channel = yarp.IVector(1), yarp.IVector(1)
    assert again.get_marker("end", where, channel) and (where[0], channel[0]) == (4, 1)
    assert not again.get_marker("middle", where, channel) and (where[0], channel[0]) == (0, -1)
    assert [each.label for each in again.getMarkers()] == ["begin", "end"]
    assert again.getMarker(7).isEqual(yarp.SoundMarker())
    assert again.subSound("begin", "end").getSamples() == 3
    again.remove_marker("begin")
    assert again.getMarkersCount() == 1
    assert again.zeroChannel(1) and again.get(3, 1) == 0 and again.getMarkersCount() == 0
    assert yarp.Sound(sound).getMarkersCount() == 2


def test_sounds_in_files(tmp_path: Path) -> None:
    sound, again = yarp.Sound(), yarp.Sound()
    yarp.makeTone(sound, 0.01, 2, 8000, 100, 1000)
    assert yarp.write(sound, str(tmp_path / "tone.wav"))
    assert yarp.read(again, str(tmp_path / "tone.wav")) and again.isEqual(sound)
    data = yarp.write_bytestream(sound, ".wav")
    assert yarp.read_bytestream(again, data, len(data), ".wav") and again.isEqual(sound)
    assert yarp.write_bytestream(sound, ".mp3") == b""
    assert not yarp.read_bytestream(again, b"RIFF", 4, ".wav")
    assert not yarp.read(again, str(tmp_path / "none.wav"))


def test_maps_as_pictures() -> None:
    grid, picture = yarp.MapGrid2D(), yarp.ImageRgb()
    grid.setSize_in_cells(6, 5)
    grid.setOrigin(1.0, 2.0, 0.0)
    grid.setResolution(0.5)
    grid.setMapFlag((2, 1), grid.MAP_CELL_WALL)
    assert grid.getMapImage(picture) and picture.pixel(2, 1).r == 0
    assert picture.pixel(0, 0).g == 254
    other = yarp.MapGrid2D()
    assert not other.setMapImage(picture)
    other.setSize_in_cells(6, 5)
    assert other.setMapImage(picture) and other.isWall((2, 1)) and other.isFree((0, 0))
    assert grid.enlargeObstacles(0.4) and not grid.isFree((3, 2)) and grid.isFree((4, 1))
    assert grid.enlargeObstacles(0) and grid.isFree((3, 2))
    for cell in ((1, 1), (4, 3)):
        grid.setOccupancyData(cell, 10)
    seen = yarp.ImageMono()
    assert grid.getOccupancyGrid(seen) and seen.pixel(1, 1) == 10 and seen.pixel(0, 0) == 255
    assert not other.crop(0, 0, 7, 2)
    assert grid.crop(-1, -1, -1, -1) and (grid.width(), grid.height()) == (3, 3)
    assert grid.isWall((1, 0))
    x, y, theta = yarp.DVector(1), yarp.DVector(1), yarp.DVector(1)
    grid.getOrigin(x, y, theta)
    assert (x[0], y[0]) == (1.5, 2.5)
    seen.resize(3, 3)
    seen.zero()
    assert grid.setOccupancyGrid(seen) and grid.getOccupancyData((0, 0)) == 0


def test_maps_in_files(tmp_path: Path) -> None:
    grid, again = yarp.MapGrid2D(), yarp.MapGrid2D()
    grid.setMapName("kitchen")
    grid.setSize_in_cells(3, 2)
    grid.setResolution(0.5)
    grid.setOrigin(1.0, 2.0, 0.0)
    grid.setMapFlag((2, 1), grid.MAP_CELL_WALL)
    grid.setOccupancyData((2, 1), 60)
    path = str(tmp_path / "kitchen.map")
    assert grid.saveToFile(path) and again.loadFromFile(path) and again.isIdenticalTo(grid)
    assert not again.loadFromFile(str(tmp_path / "none.map"))
    grid.setMapName("a/b")
    assert not grid.saveToFile(path)
    (tmp_path / "kitchen_grid.pgm").write_bytes(b"")
    assert not again.loadFromFile(path) and again.getMapName() == "kitchen"


def test_poses_and_rotations_of_frames() -> None:
    class Frames:
        def pose(self, target: str, source: str) -> list[list[float]]:
            quarter = [[0.0, -1.0, 0.0, 1.0], [1.0, 0.0, 0.0, 2.0]]
            return [*quarter, [0.0, 0.0, 1.0, 3.0], [0.0, 0.0, 0.0, 1.0]]

    view = yarp.IFrameTransform(Frames())
    pose = yarp.Vector()
    assert view.transformPose("a", "b", [1.0, 0.0, 0.0, 0.1, 0.2, 0.3], pose)
    expected = [1.0, 3.0, 3.0, 0.1, 0.2, 0.3 + math.pi / 2]
    assert [*pose] == pytest.approx(expected)
    half = math.sqrt(0.5)
    turned = yarp.DVector(4)
    assert view.transformQuaternion("a", "b", [0.0, 0.0, half, half], turned)
    assert [*turned] == pytest.approx([0.0, 0.0, 1.0, 0.0])
    assert not view.transformPose("a", "b", [1.0], pose)
    steep = yarp.Vector()
    assert view.transformPose("a", "b", [0.0, 0.0, 0.0, 0.4, math.pi / 2, 0.0], steep)
    assert steep[4] == pytest.approx(math.pi / 2)


def test_what_is_said_of_controllers() -> None:
    class Controllers:
        details = ({"kp": "V/deg", "description": "position"}, {})

    class Board:
        axis_names = ("a", "b")
        pids = {"pos": Controllers()}

    view = yarp.IPidControl(Board())
    info = yarp.PidExtraInfo()
    kind = yarp.VOCAB_PIDTYPE_POSITION
    assert view.getPidExtraInfo(kind, 0, info) and info.units.units_kp == "V/deg"
    assert info.description.pid_description == "position" and info.units.units_ki == ""
    found: list[yarp.PidExtraInfo] = []
    assert view.getPidExtraInfos(kind, found) and found[0].units.units_kp == "V/deg"
    assert not view.getPidExtraInfo(yarp.encode("trq"), 0, info)
    assert yarp.IPidControlRaw(Board()).getPidExtraInfoRaw(kind, 0, info)


def test_an_analog_sensor() -> None:
    class Sensor:
        def __init__(self) -> None:
            self.offset = 0.0

        def channels(self) -> list[float]:
            return [1.0 - self.offset, 2.0]

        def calibrate(self, values: list[float] | None) -> None:
            self.offset = 1.0

    driver = yarp.PolyDriver()
    driver.give(Sensor())
    view = driver.viewIAnalogSensor()
    assert view is not None and view.getChannels() == 2
    values = yarp.Vector()
    assert view.read(values) == view.AS_OK and [*values] == [1.0, 2.0]
    assert view.calibrateSensor() == view.AS_OK
    assert view.read(values) == view.AS_OK and values[0] == 0.0
    assert view.calibrateChannel(0) == view.AS_ERROR
    assert (view.getState(1), view.getState(2)) == (view.AS_OK, view.AS_ERROR)
    assert yarp.IAnalogSensor(object()).read(values) == view.AS_ERROR


def test_pictures_to_a_device_that_shows_them() -> None:
    shown = []

    class Screen:
        def show(self, image: yarpy.Image) -> None:
            shown.append(image.width)

    image = yarp.ImageRgb()
    image.resize(8, 4)
    assert yarp.IFrameWriterImage(Screen()).putImage(image) and shown == [8]


def test_numbers_as_bytes_and_corners() -> None:
    number = yarp.UnionNetInt64()
    number.d = -2
    assert number.c == b"\xfe" + b"\xff" * 7
    number.c = b"\x05"
    assert number.d == 5
    corner, again = yarp.vertex_t(3, 4), yarp.vertex_t()
    assert yarp.Portable.copyPortable(corner, again) and (again.x, again.y) == (3, 4)


def test_another_name_for_a_device(monkeypatch: pytest.MonkeyPatch) -> None:
    from yarp import _poly_driver

    monkeypatch.setattr(_poly_driver, "ALIASES", {})
    factory = yarp.Drivers.factory()
    assert factory.addDeprecatedAlias("oldBattery", "fakeBattery")
    assert not factory.addDeprecatedAlias("fakeIMU", "fakeBattery")
    driver = yarp.PolyDriver("(device oldBattery)")
    assert driver.isValid() and driver.viewIBattery() is not None
    driver.close()


def test_a_responder_answers_what_it_reads() -> None:
    class Device(yarp.DeviceResponder):
        def respond(self, command: yarp.Bottle, reply: yarp.Bottle) -> bool:
            reply.addString(f"you said {command.toString()}")
            return True

    yarp.Network.setLocalMode(True)
    server, client = yarp.Port(), yarp.RpcClient()
    try:
        responder = Device()
        assert server.open("/responder")
        responder.attach(server)
        assert client.open("/asker") and yarp.Network.connect("/asker", "/responder")
        reply = yarp.Bottle()
        assert client.write(yarp.Bottle("hi"), reply) and reply.get(0).asString() == "you said hi"
    finally:
        client.close()
        server.close()
        yarp.Network.setLocalMode(False)


def test_where_the_program_is() -> None:
    out = io.StringIO()
    yarp.yarp_print_trace(out, "here.py", 7)
    assert out.getvalue().startswith("backtrace here.py:7") and "print_stack" in out.getvalue()
    with yarp.Log.getLogMutex(), yarp.Log.getLogMutex():
        pass


def test_joints_that_motors_share() -> None:
    class Coupling:
        joint_names = ("knee", "ankle")
        axis_names = ("upper", "lower")
        joint_limits = ((-10.0, 20.0), (-5.0, 5.0))
        coupled_joints = coupled_axes = (0, 1)

        def axis_positions(self, joints: list[float]) -> list[float]:
            return [joints[0] + joints[1], joints[0] - joints[1]]

    driver = yarp.PolyDriver()
    driver.give(Coupling())
    view = driver.viewIJointCoupling()
    assert view is not None
    assert (view.getNrOfPhysicalJoints(), view.getNrOfActuatedAxes()) == (2, 2)
    assert (view.getPhysicalJointName(1), view.getActuatedAxisName(5)) == ("ankle", "")
    axes, low, high = yarp.Vector(), yarp.DVector(1), yarp.DVector(1)
    assert view.convertFromPhysicalJointsToActuatedAxesPos(yarp.Vector([3.0, 1.0]), axes)
    assert [*axes] == [4.0, 2.0]
    assert not view.convertFromActuatedAxesToPhysicalJointsTrq(axes, axes, axes)
    assert view.getPhysicalJointLimits(0, low, high) and (low[0], high[0]) == (-10.0, 20.0)
    assert not view.getPhysicalJointLimits(-1, low, high)
    coupled = yarp.IVector()
    assert view.getCoupledActuatedAxes(coupled) and [*coupled] == [0, 1]
