"""Everything that reads bytes of strangers, with texts and bytes to begin from.

Rules: a target takes bytes, whatever they are, and raises what is in `refusals` or nothing. Those
of the grammars begin from pieces that are put together at random, those of messages and carriers
from what C++ YARP was recorded to say (tests/golden). Whoever adds a decoder adds a line here.
"""

from __future__ import annotations

import io
import itertools
import random
import struct
import tempfile
import zipfile
import zlib
from collections.abc import Callable
from contextlib import redirect_stdout, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from fuzz import curve_login, launch, recording
from fuzz.grammar import GRAMMARS, REFUSALS
from monitors.test_shipped import CASES
from peers.ros2.message.test_description import description_of
from support.capture import CAPTURES, load_capture
from support.ros_link import AddTwoInts, String
from support.ros_value import filled
from support.thrift import CALLS, GOLDEN
from support.thrift import rows as thrift_rows
from support.thrift_module import ROWS, SPELLINGS, apache, data, service
from support.vectors import binaries, rows
from support.way_back import way_back

import yarpy
from yarpy import registry
from yarpy.carriers.base import Carrier
from yarpy.carriers.own.memory import Memory
from yarpy.carriers.payload import message_of, payload_of
from yarpy.data import codec, yarp4
from yarpy.data.sig import jpeg, png
from yarpy.data.sig.image import Image
from yarpy.errors import DecodeError, YarpError
from yarpy.kits.devices.control_board.state import State
from yarpy.kits.devices.multi_sensor.client import read_names
from yarpy.kits.devices.multi_sensor.interface import KINDS
from yarpy.kits.thrift.apache import protocol
from yarpy.kits.thrift.apache.client import result as apache_result
from yarpy.kits.thrift.apache.decode import READERS
from yarpy.kits.thrift.apache.message import Asked, Returned
from yarpy.kits.thrift.apache.message import Call as ApacheCall
from yarpy.kits.thrift.apache.scan import Scan
from yarpy.kits.thrift.client import is_failure, version
from yarpy.kits.thrift.library import load as load_thrift
from yarpy.kits.wrap.middleware import question_of
from yarpy.kits.wrap.value.frame import Frame, from_bytes, to_bytes
from yarpy.kits.wrap.value.hint import shape_of
from yarpy.kits.wrap.value.npy import from_npy, to_npy
from yarpy.kits.wrap.value.payload import asked, unpack
from yarpy.kits.wrap.value.tensor import as_floats
from yarpy.kits.wrap.value.tensor import read as read_tensor
from yarpy.kits.wrap.value.tree import to_text
from yarpy.limit import SCRIPT_SECONDS
from yarpy.link.begin.handshake import find_carrier, recognise
from yarpy.monitors.base import Place
from yarpy.monitors.chain import Chain
from yarpy.monitors.stock.zlib_limit import unpacked
from yarpy.names.discovery import respond
from yarpy.peers.mqtt.carrier import Mqtt, Reader
from yarpy.peers.ros.bag.reader import BagReader
from yarpy.peers.ros.bag.writer import BagWriter
from yarpy.peers.ros.header import LENGTH, encode_header
from yarpy.peers.ros.message.convert.native import to_value
from yarpy.peers.ros.message.library import Library
from yarpy.peers.ros.message.sniff import sniff
from yarpy.peers.ros.message.source import Standard
from yarpy.peers.ros2.message.description import type_of
from yarpy.peers.ros2.message.library import Library as Library2
from yarpy.peers.ros2.message.library import hash_of
from yarpy.peers.ros2.message.source import Standard as Standard2
from yarpy.peers.zmq import zmtp
from yarpy.peers.zmq.carrier import ROLES, Pub
from yarpy.route import UNDECLARED, Declared, Route, parse_carrier
from yarpy.testing import End
from yarpy.testing.drive import SimulatedMemory, Stalled
from yarpy.wire.datagram import Assembler
from yarpy.wire.message import CALL, DATA, Message, Packet
from yarpy.wire.shared_stream import SharedStream
from yarpy.wire.stream import DatagramStream

try:
    import cv2
except ImportError:
    cv2 = None  # type: ignore[assignment]

LIMIT = 1 << 22  # bytes of a message here: what takes more is a finding
TYPES = (
    *(yarpy.Bottle, yarpy.Property, yarpy.Vector, yarpy.Image, yarpy.Sound, yarpy.Stamp),
    *(yarpy.Matrix, yarpy.PointCloud, str, int, float, bool, bytes, yarpy.Vocab, np.ndarray),
)


@dataclass(frozen=True)
class Target:
    """`read` is tried; inputs are made of `seeds` that are changed, or of `pieces` in a row.
    `slow`: seconds of a processor that are too many."""

    read: Callable[[bytes], Any]
    seeds: tuple[bytes, ...] = ()
    pieces: tuple[bytes, ...] = ()
    refusals: tuple[type[BaseException], ...] = (YarpError,)
    slow: float = 1.0


def _decode_all(data: bytes) -> None:
    kind = TYPES[data[-1] % len(TYPES)] if data else object
    for convert in (codec.decode, lambda view: codec.decode_as(view, kind)):
        try:
            value = convert(data)
        except YarpError:
            continue
        if isinstance(value, np.ndarray):
            continue  # not every array that can be read can be sent without saying what it is
        b"".join(codec.encode(value))
        codec.encode_text(value)


@dataclass
class _Observation:
    rgb: np.ndarray
    q: list[float]
    pose: tuple[float, dict[str, Any]] | None = None


_DESCRIBED = (
    {"rgb": np.zeros((2, 3, 3), "u1"), "q": np.ones(3), "pose": (1.5, {"a": None})},
    [None, (1, 1j), {"k": np.ones((2, 2), "f2"), 2: yarpy.Stamp(1, 2.0)}],
    (
        np.zeros((1, 2)),
        np.zeros((2, 2), "f4"),
        np.zeros(3, "?"),
        yarpy.Image(np.ones((1, 2), "u1")),
    ),
    np.ones((2, 1, 3), "c8"),
)


def _described(data: bytes) -> None:
    kinds = (dict, list, np.ndarray, _Observation, list[_Observation], yarpy.Matrix, complex)
    with suppress(YarpError):
        codec.decode(data)
    with suppress(YarpError):
        codec.decode_text(data)
    codec.decode_as(data, kinds[data[0] % len(kinds)] if data else dict)


def _yarp4(data: bytes) -> None:
    for look in (yarp4.is_yarp4, yarp4.to_yarp3, yarp4.to_yarp4):
        with suppress(YarpError):
            look(data)
    _decode_all(data)


def _walk(data: bytes) -> None:
    walker = codec.Walker(LIMIT)
    for end in range(8, len(data) + 1, 7):
        walker.advance(data[:end])
        if walker.done:
            return


def _picture(data: bytes) -> None:
    jpeg.comment(data)
    extent = jpeg.Extent()
    extent.advance(bytearray(data[: len(data) // 2]))
    jpeg.decode(data, LIMIT)


def _png(data: bytes) -> None:
    # The checksums are set right: a damaged file would not come further than to them.
    fixed, at = bytearray(data), 8
    while at + 12 <= len(fixed):
        end = at + 12 + int.from_bytes(fixed[at : at + 4], "big")
        if end > len(fixed):
            break
        fixed[end - 4 : end] = zlib.crc32(fixed[at + 4 : end - 4]).to_bytes(4, "big")
        at = end
    png.decode(cv2, bytes(fixed), "rgb", LIMIT)


def _unpack(data: bytes) -> None:
    unpacked(data[4:], int.from_bytes(data[:4], "little", signed=True), LIMIT)


def _datagrams(data: bytes) -> None:
    assembler = Assembler(LIMIT)
    for at in range(0, len(data), 64):
        assembler.add(data[at : at + 64])


def _references(data: bytes) -> None:
    """What comes beside a piece of shared memory."""
    end, carrier = End(piece=1 + len(data) % 97), Memory(Route("/w", "/r", "memory"))
    end.stream = SharedStream(SimulatedMemory([bytes(20000)]), LIMIT)

    def read() -> Any:
        while True:
            message = yield from carrier.decode(end.stream)
            with suppress(DecodeError):
                _ = message.value

    end.begin(read())
    end.feed(data)


def _pictures() -> tuple[bytes, ...]:
    """A JPEG in one scan and, where OpenCV is, one in several."""
    once = jpeg.encode(Image(_PIXELS))
    if cv2 is None:
        return (once,)
    return once, cv2.imencode(".jpg", _PIXELS, (cv2.IMWRITE_JPEG_PROGRESSIVE, 1))[1].tobytes()


_MPI = tuple(
    magic + b"/out\r\nvm____pid____4711\r\ntag#0$description#5\r\n"
    for magic in (b"MPI_____", b"MPIBCAST")
)
_MEETING = b"YARPYME1\x03\0\0\0/w\0" + bytes(8)
_REFERENCE = struct.pack("<4sc3x3I2Q", b"\0MEM", b"D", 0, 1, 5, 0, 20000) + b"1 0.5"


def _accept(declared: Declared = UNDECLARED) -> Callable[[bytes], None]:
    """Whoever dials, in pieces, a port that says this of itself."""

    def read(data: bytes) -> None:
        end = End(piece=1 + len(data) % 97, limit=LIMIT)
        end.begin(_serve(end, declared))
        end.feed(data)

    return read


def _serve(end: End, declared: Declared) -> Any:
    """What a port does with a connection, reduced to its bytes."""
    stream = end.stream
    first = bytes((yield from stream.read_exact(8)))
    kind = recognise(first)
    if kind is None:
        return
    carrier = kind(Route("", "/r", kind.name, 10002, "127.0.0.1", declared=declared))
    while (other := (yield from carrier.welcome(end.stream, first))) is not None:
        carrier = other
    for _ in range(100):
        message = yield from carrier.decode(end.stream)
        if message.key in ("q", "r"):
            return
        if message.key in ("d", "D", "a"):
            with suppress(DecodeError):
                _ = message.value
        if message.key in ("d", "a"):
            carrier.encode_reply(end.stream, [1, "two"])
        elif message.key != "D":
            carrier.encode_lines(end.stream, ["a line"])
        if carrier.acks:
            carrier.encode_ack(end.stream, 1)


def _dial(name: str) -> Callable[[bytes], None]:
    """Whoever is dialled: greet, send a message, read what comes for an answer."""
    kind = find_carrier(parse_carrier(name))

    def read(data: bytes) -> None:
        carrier = kind(Route("/w", "/r", name, 10002, "127.0.0.1"))
        end = End(piece=1 + len(data) % 97, limit=LIMIT)

        def steps() -> Any:
            yield from carrier.greet(end.stream)
            if not carrier.push:
                while True:
                    message = yield from carrier.decode(end.stream)
                    with suppress(DecodeError):
                        _ = message.value
            if isinstance(end.stream, DatagramStream):
                return
            carrier.encode(end.stream, Packet([1, "two"], key=DATA))
            while True:
                reply = yield from carrier.expect_reply(end.stream)
                if reply is not None:
                    with suppress(DecodeError):
                        _ = reply.value
                if carrier.acks:
                    yield from carrier.expect_ack(end.stream)

        end.begin(steps())
        end.feed(data)

    return read


def _dial_apache(name: str) -> Callable[[bytes], None]:
    """A server of Apache Thrift that is dialled, and asked again and again."""
    spec = parse_carrier(name)
    kind = find_carrier(spec)
    asked = Asked("compact" if "compact" in spec.tokens else "binary", protocol.CALL, "add", b"\0")

    def read(data: bytes) -> None:
        carrier = kind(Route("/w", "/r", name, 10002, "127.0.0.1"))
        end = End(piece=1 + len(data) % 97, limit=LIMIT)

        def steps() -> Any:
            yield from carrier.greet(end.stream)
            while True:
                carrier.encode(end.stream, Packet(asked, key=CALL))
                yield from carrier.expect_reply(end.stream)

        end.begin(steps())
        end.feed(data)

    return read


def _encoded(value: object) -> bytes:
    return b"".join(codec.encode(value))


def _zmq(kind: bytes, content: bytes = b"") -> bytes:
    """What a socket of ZeroMQ says."""
    return zmtp.GREETING + zmtp.ready({"Socket-Type": kind}) + content


def _hear(made: Callable[[], Carrier]) -> Callable[[bytes], None]:
    """What a subscriber says while it is written to."""

    def read(data: bytes) -> None:
        end = End(piece=1 + len(data) % 97, limit=LIMIT)
        steps = made().listen(end.stream)
        assert steps is not None
        end.begin(steps)
        end.feed(data)

    return read


def _payload(data: bytes) -> None:
    """A payload of programs that know nothing of YARP."""
    message = message_of(DATA, [data])
    for kind in (object, *TYPES):
        try:
            message.as_(kind)
        except YarpError:
            continue
    payload_of(message.value)


def _said(sender: str) -> tuple[bytes, ...]:
    """What one side said in the recordings, short ones."""
    found = {
        load_capture(path.stem).said(sender)
        for path in sorted(CAPTURES.glob("*.json"))
        if path.stem != "groups"
    }
    return tuple(sorted(said for said in found if 0 < len(said) < 4000))


def _monitor(name: str, spelled: str, value: Any) -> Target:
    """What comes to a monitor at the receiver's end; it may refuse, in its own time."""
    _, *tokens = spelled.split("+")
    place = Place("/w", "/r", tokens=tuple(tokens), limit=LIMIT)
    there = replace(place, sending=True)
    kind = registry.monitors.load(name)
    packet = Packet(value)
    packed = (
        Chain([kind(there)], "there").send(packet)
        if name.endswith(("zlib", "peg", "png"))
        else None
    )
    seed = b"".join((packed or packet).blocks)
    return Target(lambda data: Chain([kind(place)], "here").take(Message(DATA, data)), (seed,))


def _devices(data: bytes) -> None:
    """What clients of devices are told."""
    message = codec.decode_as(data, yarpy.Bottle)
    with suppress(TypeError, ValueError):
        read_names(message)
    State.from_bottle(message)


def _bag(data: bytes) -> None:
    """A file of rosbag."""
    with tempfile.NamedTemporaryFile(suffix=".bag") as file:
        file.write(data)
        file.flush()
        with BagReader(file.name) as bag:
            _ = bag.topics
            for _ in itertools.islice(bag, 1000):
                pass


def _bags() -> tuple[bytes, ...]:
    """Small ones, of each compression."""
    found = []
    with tempfile.TemporaryDirectory() as folder:
        for compression in ("none", "bz2", "lz4"):
            path = Path(folder) / compression
            with BagWriter(path, compression) as bag:  # type: ignore[arg-type]
                for number in range(4):
                    bag.write("/a", f"text {number}", float(number), "std_msgs/String")
                    bag.write("/b", number, float(number), "std_msgs/Int32")
            found.append(path.read_bytes())
    return tuple(found)


def _sniffed(data: bytes) -> None:
    """A type for the bytes of a port, and the bytes read by it."""
    _ROS.message_of("p/Sniffed", sniff(data)).from_ros(data)


def _described(data: bytes) -> None:
    """What a node says of its types."""
    said = _ROS_2.message("type_description_interfaces/TypeDescription").from_ros(data)
    type_of(said, "sensor_msgs/Image", "msg", hash_of(_ROS_2.message("sensor_msgs/Image")))


def _ros(name: str, library: Library | Library2 | None = None) -> Target:
    """What a peer of ROS sends, and what comes as that type on connections of YARP."""
    cls = (library or _ROS).message(name)

    def read(data: bytes) -> None:
        for convert in (cls.from_ros, cls.from_wire):
            try:
                message = convert(data)
            except YarpError:
                continue
            message.to_ros()
            message.to_bottle()
            for kind in (object, *TYPES):
                try:
                    to_value(message, kind)
                except YarpError:
                    continue

    full = [filled(cls, random.Random(seed)) for seed in range(3)]
    seeds = [b"".join(message.to_ros()) for message in full]
    if isinstance(library, Library2):  # as other computers and programs spell it
        seeds += [bytes((0, head)) + seed[2:] for seed in seeds for head in (0, 6, 9)]
    return Target(read, (*seeds, *(b"".join(message.to_wire()) for message in full)))


def _unpacked(data: bytes) -> None:
    """A payload, as each kind of listener takes it."""
    for shape in map(shape_of, (Any, dict, str, np.ndarray, list[int])):
        with suppress(DecodeError):
            unpack(data, shape)
    with suppress(DecodeError):
        question_of(asked(data))


def _served(data: bytes) -> None:
    """What a service is asked; it answers whatever comes, and what it answers can be sent."""
    for spelling in ("binary", "text"):
        message = Message("d", data, spelling=spelling)
        message.answer = way_back()
        b"".join(codec.encode(_SERVER(message)))


def _answered(data: bytes) -> None:
    """What clients are answered, and structs that come from anywhere."""
    for method in _THRIFT.Capt._methods.values():
        for read in (method.read_answer, lambda view, m=method: is_failure(view, m, False)):
            with suppress(YarpError):
                read(data)
        if method.ending is not None:
            extent, size = method.ending(LIMIT), 0
            with suppress(YarpError):
                while not extent.done and size <= len(data):
                    size = max(extent.advance(data[:size]), size + 1)
    version(data)
    for name in ("Nest", "Deep", "Prims", "Lists", "Maps", "Sets", "Anno"):
        cls = getattr(_THRIFT, name)
        with suppress(YarpError):
            made = cls.from_wire(data)
            b"".join(made.to_wire())
            repr(made), made.to_dict(), made.to_bottle()


def _apache(data: bytes) -> None:
    """A message of Apache Thrift: its end, what a service answers, what a client reads."""
    for spelling in SPELLINGS:
        scan = Scan(spelling)
        with suppress(YarpError):
            scan.advance(data)
        reader = READERS[spelling](data)
        try:
            head = reader.head()
            at = reader.at
            reader.skip(protocol.STRUCT)
        except YarpError:
            pass
        else:
            assert scan.done and scan.advance(data) == reader.at, "two ends of a message"
        with suppress(YarpError):
            reader = READERS[spelling](data)
            head = reader.head()
            at = reader.at
            b"".join(codec.encode(_APACHE(ApacheCall(spelling, head, data, at))))
            for method in apache().Test._methods.values():
                named = replace(head, name=method.name)
                with suppress(YarpError, *_THROWN):
                    apache_result(method, Returned(spelling, named, data, at))


class _ApacheServer(type(service())):  # type: ignore[misc]
    def _reason(self, error: Exception, message: Any) -> tuple[str, str]:
        return "", ""

    def numbers(self, count: int) -> list[float]:
        return []


_APACHE: Any = _ApacheServer()
_THROWN = (apache().Bad, apache().Worse)
_APACHE_SAID = tuple(data(name, spelling) for name in ROWS for spelling in SPELLINGS)
_APACHE_FRAMED = tuple(len(each).to_bytes(4, "big") + each for each in _APACHE_SAID)
_APACHE_CALLS = (*_APACHE_SAID, *_APACHE_FRAMED)

_THRIFT = load_thrift(GOLDEN / "capt.thrift")


class _Server(_THRIFT.Capt):
    def _failed(self, error: Exception, message: Any, person: bool) -> Any:
        if not isinstance(error, YarpError):
            raise error
        return super()._failed(error, message, person)


_RESULTS = {"tail_defaults": "x", "check_defaults": True, "const_method": True}
for _name in _THRIFT.Capt._methods:
    _result = _RESULTS.get(_name, 5)
    setattr(
        _Server,
        _name,
        lambda self, *values, name=_name, result=_result: (
            values[0] if name.startswith("r_") else result
        ),
    )
_SERVER = _Server()
_THRIFT_SAID = tuple(
    bytes.fromhex(row[part]) for row in CALLS.values() for part in ("request", "reply") if row[part]
)
_THRIFT_STRUCTS = tuple(bytes.fromhex(row["hex"]) for row in thrift_rows("structs"))

_ROS = Library([Standard()])
_ROS_2 = Library2([Standard2()])
_PIXELS = np.arange(24 * 32 * 3, dtype="u1").reshape(24, 32, 3)
_MESSAGES = tuple(
    bytes.fromhex(row["binary"]) for kind in ("bottle", "types") for row in rows(kind)
)
_ANSWERS = (
    b"HTTP/1.1 200 OK\r\nContent-Length: 2\r\n\r\n[]HTTP/1.1 204 No Content\r\n\r\n",
    b"HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n2\r\n[]\r\n0\r\n\r\n",
    b'HTTP/1.0 401 No\r\nWWW-Authenticate: Digest realm="a", nonce="b", qop="auth"\r\n\r\n',
    b"HTTP/1.0 200 OK\r\nContent-Type: multipart/x-mixed-replace;boundary=b\r\n\r\n--b\r\n"
    b"Content-Type: image/jpeg\r\n\r\n" + jpeg.encode(Image(_PIXELS)) + b"\r\n--b\r\n",
    b"HTTP/1.1 101 x\r\nSec-WebSocket-Accept: x\r\n\r\n\x82\x08\x00\x01\x00\x00\x00\x00\x00\x00",
    b"Welcome /r\r\n(1 two)\r\n<ACK>\r\n",
)
_COMMANDS = zmtp.command(b"SUBSCRIBE", b"cam") + zmtp.command(b"PING", b"\0\1x") + b"\4\7\6CANCEL"
_CLIENTS = tuple(
    bytes.fromhex(text)
    for text in (
        "100e00044d5154540402003c00026d65 820a0001000561726d2f2301 320a000361726d00015b315d e000",
        "101200044d5154540502003c0321001400026d65 820b000100000561726d2f2300 c000",
        "101200044d5154540502003c0321000100026d65 3010000171090900026331080001615b315d",
        "101400044d51545404c2003c00026d65000175000170 a20700020003612f23",
    )
)
_BROKERS = tuple(
    bytes.fromhex(text)
    for text in (
        "20020000 9003000100 320a000361726d00015b315d 30060001615b315d",
        "20020000 40020001",
    )
)
_SOCKETS = (
    _zmq(b"SUB", _COMMANDS),
    _zmq(b"PUB", b"\1\3cam\0\3[1]\1\4raw:\2" + (8).to_bytes(8, "big") + bytes(8)),
    _zmq(b"PUSH", b"\0\5hello" + zmtp.command(b"PING", b"\0\1x") + b"\0\3[1]"),
    _zmq(b"PULL"),
    _zmq(b"REQ", b"\1\0\0\3[1]" * 3),
    _zmq(b"DEALER", b"\1\2id\1\0\0\3[1]"),
    _zmq(b"REP", b"\1\0\0\3[1]" * 3),
    zmtp.GREETING + zmtp.error("no"),
)

_TYPED = {"callerid": "/a", "md5sum": "*", "type": "*"}
_SUBSCRIBER = encode_header(_TYPED | {"topic": "/topic", "message_definition": "string data\n"})
_CLIENT = encode_header(_TYPED | {"service": "/add", "persistent": "1"})
_DEVICES = (
    codec.decode(State(2, {}).to_bytes()),
    yarpy.Bottle([[[[["name", "frame"]]] for _ in KINDS]]),
)
_FRAMES = (Frame({"a": np.arange(3.0), "b": [b"x", (1, {2})]}, 1, 2.0, "/x"), Frame([None, 1j]))
_PAYLOADS = (
    *(to_text({"t": (1, {2}), "a": np.arange(2)}).encode(), b'[[1], {"a": "x"}]', b"text"),
    *(b"".join(to_bytes(frame)) for frame in _FRAMES),
    b'{"timestamp": 1.5, "shape": [2, 3], "dtype": "uint8"}\n123456',
    b'\0\0\0\x16{"timestamp": 1795.25}' + jpeg.encode(Image(_PIXELS)),
)
_PASSIVE = ("simulated_network_delay", "throttleDown", "stats_monitor")  # read nothing of it

_TENSOR = (
    b"\x80\x02ctorch._utils\n_rebuild_tensor_v2\nq\0((X\7\0\0\0storageq\1ctorch\nFloatStorage\nq\2"
    b"X\1\0\0\x000q\3X\3\0\0\0cpuq\4K\6tq\5QK\0K\2K\3\x86q\6K\3K\1\x86q\7\x89ccollections\nOrderedDict\n"
    b"q\x08)Rq\x09tq\nRq\x0b."
)
_GRAPH = _TENSOR.replace(b"K\2K\3\x86q\6", b"K\7q\6" + b"h\6h\6\x86q\6" * 24)


def _tensor(data: bytes) -> object:
    """A file of torch around this pickle."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as file:
        file.writestr("archive/data.pkl", data)
        file.writestr("archive/data/0", bytes(24))
    return np.array(as_floats(read_tensor(out.getvalue())))


_LUA_BODIES = (
    b"local b = t:asBottle() b:addString('x') b:get(0):asList():addInt32(3) t:setPortReader(b)",
    b"local v = yarp.Vector(3) v[1] = 2.5 t:setPortWriter(v) return t",
    b"local i = t:asImage('rgb') i:setPixel(1, 1, 2, 3, 4) local m = yarp.Matrix(2, 3) m:zero()",
    b"for w in ('a b'):gmatch('(%a+)') do t:asBottle():find(w):asFloat64() end",
    b"local ok, why = pcall(error, {}) return coroutine.wrap(function() coroutine.yield(1) end)()",
    b"table.sort({3, 1, 2}, function(a, b) return b < a end) return ('%5d'):format(#'x' << 3)",
    b"local p = yarp.Property('(a 1) (b (1 2))') p:put('c', p:find('b')) yarp.Time.now()",
    b"return setmetatable({}, {__index = string, __len = function() return 1 << 60 end})",
    b"local s = string.rep('a', 99) return load('return ' .. #s)() + math.tointeger('7')",
    b"PortMonitor.setEvent('e', 1) PortMonitor.setConstraint('e and not f') return true",
    b"local s <const> = string.pack('<i4z', 1, 'x') return utf8.char(0x20ac), s:unpack('<i4z')",
)
# Each is whole, so that most rows of them can be run.
_LUA_STATEMENTS = tuple(
    line.encode() + b"\n"
    for line in """\
s = 'a,b c'
b = t:asBottle()
n = 1 << 40
n = -1
n = 2.5
s = ('x'):rep(1000)
s = s .. s
n = n * 3 // 7 - #s
for i = 1, 10 do s = s .. i end
for i = 1, 1e15 do n = i end
while n ~= 0 do n = n // 2 end
repeat n = n + 1 until n > 100
if s == 'x' then b = nil elseif n then s = 'y' else n = 0 end
pcall(function() error(t) end)
xpcall(function() f(f) end, function(e) return e .. s end)
f = coroutine.wrap(function(...) coroutine.yield(...) f(...) end)
f = function(...) return f(...) end
f = coroutine.create(f)
f(n, s)
coroutine.resume(f, s) coroutine.close(f)
s = s:gsub('(%w+)(.-)', '%2%1')
s = s:gsub('.', function(c) return c:byte() end)
s = s:find(s) and s:match('(a*)-b') or tostring(b)
for w in s:gmatch('a*') do n = #w end
s = string.format('%s %q %d %g', s, s, 3, 2.5)
s = string.pack('s4>i8z', s, n, 'x')
n = string.unpack('<i4', s, n)
t = {1, 2, n = s, b}
table.sort(t)
table.sort(t, function(a, b) return true end)
table.insert(t, 1, s)
table.move(t, 1, n, 2)
s = table.concat(t, s)
setmetatable(t, {__index = t, __newindex = rawset, __call = print, __eq = rawequal})
setmetatable(t, {__close = f, __mode = 'kv', __len = function() return n end})
do local c <close> = setmetatable({}, {__close = function() f(n) end}) end
getmetatable('').__index = function(s, k) return k end
string.rep = nil
_G.pcall = error
print(s, n, b)
s = load(s)()
load(function() return s end)
collectgarbage('step', n)
s = require(s)
b:addString(s) b:addFloat64(n)
b:addList():addInt32(n)
b:append(b)
b:fromString(s)
b:clear()
n = b:get(0):asList():get(n)
s = b:find(s):asString()
s = b:toString() .. b:tail():toString()
b:addVocab32(s) n = b:pop():asVocab32()
p = yarp.Property() p:put(s, n)
p:fromString(s) b = p:findGroup(s)
i = t:asImage('rgb')
i:resize(3, 2)
i:resize(n, n)
i:setPixel(n, 1, 255, 0, 0)
n = i:pixel(1, 1)
v = yarp.Vector(n)
v = t:asVector()
v:resize(4) v:set(0, n)
v:push_back(n)
m = yarp.Matrix(3, n)
m:eye() m:set(n, 1, 2.5)
t:setPortWriter(b)
t:setPortWriter(v)
PortMonitor.setEvent(s, n)
PortMonitor.setConstraint(s)
PortMonitor.update = f
do return b end
do return t end
do return n end
""".splitlines()
)


def _script(data: bytes) -> None:
    """A Lua script and all of its callbacks, with little time and memory."""
    from yarpy.monitors.event import Events
    from yarpy.monitors.script.control import Control
    from yarpy.monitors.script.lua import LuaScript

    control = Control(events=Events())
    path = Path("/nowhere/fuzz.lua")
    if b"PortMonitor." not in data[:60]:
        begin = (
            b"local s, n, f, b, v = 'x', 3, print, yarp.Bottle('1 (2 x)'), yarp.Vector(3) "
            b"local m, p, _, i = yarp.Matrix(2, 2), yarp.Property(), pcall(t.asImage, t, 'rgb')"
        )
        data = b'require("yarp") PortMonitor.accept = function(t)\n%s\n%s\nend' % (begin, data)
    with redirect_stdout(io.StringIO()):
        try:
            script = LuaScript(path, data, control, limit=1_000_000, memory=8 << 20)
            script.create(yarpy.Property())
            for value in (yarpy.Bottle([1, "two", [3.5]]), Image(_PIXELS), yarpy.Vector([1.0])):
                message = Message(DATA, b"".join(codec.encode(value)), "3 0.5")
                for callback in (script.accept, script.update, script.update_reply):
                    with suppress(YarpError):
                        callback(message)
            for act in (script.trigger, script.parameters, script.close):
                with suppress(YarpError):
                    act()
        finally:
            control.close()


TARGETS = {
    **{
        f"grammar {name}": Target(
            grammar.read,
            tuple(begin + piece * 3 + end for begin, piece, end in grammar.shapes),
            grammar.pieces,
            REFUSALS,
        )
        for name, grammar in GRAMMARS.items()
    },
    "messages": Target(_decode_all, _MESSAGES),
    "described messages": Target(
        _described, tuple(b"".join(codec.encode(value)) for value in _DESCRIBED)
    ),
    **{
        f"ros {name}": _ros(f"sensor_msgs/{name}")
        for name in ("JointState", "PointCloud2", "Image")
    },
    **{
        f"ros 2 {name}": _ros(f"sensor_msgs/{name}", _ROS_2)
        for name in ("JointState", "PointCloud2", "Image")
    },
    "ros 2 description": Target(
        _described, (b"".join(description_of(_ROS_2.message("sensor_msgs/Image")).to_ros()),)
    ),
    "sniff": Target(_sniffed, _MESSAGES),
    "thrift requests": Target(_served, (*_THRIFT_SAID, b"help add", b"r_nest 1 2 () () () ()")),
    "thrift of Apache": Target(_apache, _APACHE_SAID),
    "thrift answers": Target(_answered, (*_THRIFT_SAID, *_THRIFT_STRUCTS)),
    "frames": Target(lambda data: from_bytes(data), tuple(b"".join(to_bytes(f)) for f in _FRAMES)),
    "payloads": Target(_unpacked, _PAYLOADS),
    "torch": Target(_tensor, (_TENSOR, _GRAPH)),
    "npy": Target(from_npy, tuple(map(to_npy, (np.eye(2), np.arange(3, dtype="u1"))))),
    "walker": Target(_walk, _MESSAGES),
    "yarp 4": Target(_yarp4, tuple(bytes(yarp4.to_yarp4(each)) for each in binaries())),
    "jpeg": Target(
        _picture, (jpeg.encode(Image(_PIXELS)), jpeg.encode(Image(_PIXELS[..., 0].copy())))
    ),
    "zlib": Target(
        _unpack, tuple(struct.pack("<i", n) + zlib.compress(bytes(n)) for n in (0, 9, 5000))
    ),
    "discovery": Target(
        lambda data: respond(data, str), (b"NAME_SERVER query /root", *_MESSAGES[:9])
    ),
    "datagrams": Target(_datagrams, _said("a")[:40]),
    "references": Target(_references, (_REFERENCE, *_said("a")[:40])),
    "accepting": Target(
        _accept(),
        (*_said("a"), _SUBSCRIBER, *_SOCKETS, *_CLIENTS, _MEETING, *_MPI, *_APACHE_CALLS),
        refusals=(YarpError, Stalled),
    ),
    "accepting tcpros": Target(
        _accept(Declared("/node", "/topic", "std_msgs/String", String)),
        (_SUBSCRIBER,),
        refusals=(YarpError, Stalled),
    ),
    "accepting rossrv": Target(
        _accept(Declared("/node", "/add", "rospy_tutorials/AddTwoInts", AddTwoInts)),
        (_CLIENT + LENGTH.pack(16) + bytes(16) + LENGTH.pack(16) + bytes(16),),
        refusals=(YarpError, Stalled),
    ),
    "devices": Target(_devices, (*_MESSAGES[:20], *map(_encoded, _DEVICES))),
    **{
        f"monitor {name}": _monitor(name, spelled, value)
        for spelled, _, value, _ in CASES
        if (name := spelled.partition("+")[0]) not in _PASSIVE
        and not (name.endswith("png") and cv2 is None)
    },
    "subscriptions mqtt": Target(_hear(lambda: Reader(Mqtt(Route("/w", "/r", "mqtt")))), _CLIENTS),
    "subscriptions zmq": Target(
        _hear(lambda: Pub(Route("/w", "/r", "zmq+pub"))), (_COMMANDS, b"\0\4\1cam\0\4\0cam")
    ),
    "login curve": Target(curve_login.greet, curve_login.GREETINGS, refusals=(YarpError, Stalled)),
    "boxes curve": Target(curve_login.unbox, curve_login.BOXES),
    "payload": Target(_payload, (b'[1, "two", {"a": [3.5]}]', b"\xff\0", *_pictures())),
    **{
        f"dialling zmq+{role}": Target(
            _dial(f"zmq+{role}"), _SOCKETS, refusals=(YarpError, Stalled)
        )
        for role in ROLES
    },
    **{
        f"dialling {name}": Target(_dial(name), _BROKERS, refusals=(YarpError, Stalled))
        for name in ("mqtt", "mqtt+qos.1", "mqtt+rpc", "mqtt+sub", "mqtt+sub+raw")
    },
    **{
        f"dialling {name}": Target(_dial_apache(name), _APACHE_CALLS, refusals=(YarpError, Stalled))
        for name in ("thrift", "thrift+framed", "thrift+compact", "thrift+compact+framed")
    },
    **{
        f"dialling {name}": Target(
            _dial(name), (*_said("b")[:60], *_ANSWERS), refusals=(YarpError, Stalled)
        )
        for name in (
            *("tcp", "fast_tcp", "text", "text_ack", "http", "xmlrpc", "mjpeg", "websocket"),
            *("tcpros", "rossrv"),
            *("unix_stream", "memory", "shmem", "mpi", "bcast", "udp", "mcast", "name_ser"),
        )
    },
}
try:
    import lupa.lua54  # noqa: F401
except ImportError:
    pass
else:
    _CALLBACKS = (b"accept", b"update", b"update_reply", b"trig", b"setparam", b"create")
    TARGETS["lua"] = Target(
        _script,
        tuple(
            b'require("yarp")\nPortMonitor.%s = function(t)\n%s\nend\n' % (name, body)
            for name, body in zip(itertools.cycle(_CALLBACKS[:2]), _LUA_BODIES, strict=False)
        )
        + tuple(b"PortMonitor.%s = function(t) return t end " % name for name in _CALLBACKS),
        _LUA_STATEMENTS,
        slow=4 * SCRIPT_SECONDS,  # of each call; strings that grow, for three messages
    )
if cv2 is not None:
    TARGETS["png"] = Target(_png, (png.encode(cv2, Image(_PIXELS)),))
try:
    import rosbags.rosbag1  # noqa: F401
except ImportError:
    pass
else:
    TARGETS["bag"] = Target(_bag, _bags())
try:
    import mcap  # noqa: F401
except ImportError:
    pass
else:
    TARGETS["recording"] = Target(recording.read_mcap, recording.mcap_files())
    try:
        import pyarrow  # noqa: F401
    except ImportError:
        pass
    else:
        TARGETS["data set"] = Target(recording.read_set, recording.sets())
TARGETS["dumper"] = Target(recording.read_folder, recording.folders())
TARGETS["page"] = Target(recording.read_page, recording.pages())
TARGETS["application xml"] = Target(launch.read_application, (launch.APPLICATION,))
TARGETS["application toml"] = Target(launch.read_toml, (launch.TOML,))
TARGETS["robot xml"] = Target(launch.read_robot, (launch.ROBOT,))
TARGETS["run requests"] = Target(launch.read_request, launch.requests_())
TARGETS["log lines"] = Target(launch.read_log, launch.logs())
