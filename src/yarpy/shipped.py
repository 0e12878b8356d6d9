"""The plug-ins that ship with yarpy: a row for each of the core, the peers and the kits.

Rules: a table, nothing else. A lookup of `tcp` must not cost a scan of every installed distribution
(tens of milliseconds), nor an import to find out that it is not what was asked for; and it works
from a bare source tree. The facts of a row are those of its class.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Final, TypeVar

from yarpy.facts import (
    BROKER,
    PORT,
    SERVER,
    SOCKET,
    TOPIC,
    Call,
    CarrierRow,
    GraphRow,
    Reach,
    Row,
    TransportRow,
)
from yarpy.shipped_devices import DEVICES

R = TypeVar("R", bound=Row)

_OWN: Final = "yarpy.carriers.own"
_WEB: Final = "yarpy.carriers.web"
_PEERS: Final = "yarpy.peers"
_STOCK: Final = "yarpy.monitors.stock"
_KITS: Final = "yarpy.kits"

# A carrier of YARP's own says its number in the low four bits of the third byte.
_INDEXED: Final = b"\xff\xff\x0f\0\0\0\xff\xff"
# A header of ROS: two lengths of at most 1 MiB.
_HEADER: Final = b"\0\0\0\xff\0\0\0\xff"
_METHODS: Final = (b"GET /", b"POST /", b"HEAD /", b"OPTIONS ", b"PUT /", b"DELETE /", b"PATCH /")
_SILENT: Final = Reach(tells=False)
_WEB_SERVER: Final = Reach(
    "server", cpp="which exchanges nothing with other ports over http: use tcp", page=True
)


def _table(*rows: R) -> dict[str, R]:
    return {row.name: row for row in rows}


def _rows(folder: str, places: Iterable[tuple[str, str]], extra: str = "") -> list[Row]:
    return [Row(name, f"{folder}.{place}", extra) for name, place in places]


def _indexed(number: int) -> tuple[bytes, ...]:
    return (b"YA" + bytes([(number + 1) % 16]) + b"\0\0\0RP",)


CARRIERS: Final[Mapping[str, CarrierRow]] = _table(
    CarrierRow("tcp", f"{_OWN}.tcp:Tcp", magic=_indexed(3), mask=_INDEXED),
    CarrierRow("fast_tcp", f"{_OWN}.tcp:FastTcp", magic=_indexed(3), mask=_INDEXED),
    CarrierRow("tls", f"{_OWN}.tcp:Tls"),
    CarrierRow("udp", f"{_OWN}.udp:Udp", magic=_indexed(0), mask=_INDEXED, over="udp"),
    CarrierRow("mcast", f"{_OWN}.mcast:Mcast", magic=_indexed(1), mask=_INDEXED, over="mcast"),
    CarrierRow("text", f"{_OWN}.text:Text", magic=(b"CONNECT ",)),
    CarrierRow("text_ack", f"{_OWN}.text:TextAck", magic=(b"CONNACK ",)),
    CarrierRow(
        "unix_stream",
        f"{_OWN}.unix_stream:UnixStream",
        magic=(b"UNIX_STR", b"UNIX_ACK"),
        over="unix",
    ),
    CarrierRow(
        "local",
        f"{_OWN}.local:Local",
        magic=(b"LOCALITY",),
        reaches=Reach(same_program=True),
        over="inproc",
    ),
    CarrierRow("memory", f"{_OWN}.memory:Memory", magic=(b"YARPYME",), over="memory"),
    CarrierRow("shmem", f"{_OWN}.shmem:Shmem", magic=_indexed(14), mask=_INDEXED, over="shmem"),
    CarrierRow("name_ser", f"{_OWN}.name_ser:NameSer", magic=(b"NAME_SER",), reaches=_SILENT),
    CarrierRow("http", f"{_WEB}.http.carrier:Http", magic=_METHODS, reaches=_WEB_SERVER),
    CarrierRow("mjpeg", f"{_WEB}.mjpeg:Mjpeg", magic=(b"GET /?ac",), push=False, reaches=SERVER),
    CarrierRow(
        "mpi", f"{_PEERS}.mpi.carrier:Mpi", "mpi", magic=(b"MPI_____",), reaches=_SILENT, over="mpi"
    ),
    CarrierRow(
        "bcast",
        f"{_PEERS}.mpi.carrier:Bcast",
        "mpi",
        magic=(b"MPIBCAST",),
        reaches=_SILENT,
        over="bcast",
    ),
    CarrierRow(
        "mqtt",
        f"{_PEERS}.mqtt.carrier:Mqtt",
        magic=(b"\x10",),
        reaches=Reach(BROKER.what, number=1883, number_tls=8883),
        subprotocol="mqtt",
    ),
    CarrierRow("ros2", f"{_PEERS}.ros2.carrier:Ros2", "ros2", reaches=TOPIC, over="ros2"),
    CarrierRow("zenoh", f"{_PEERS}.zenoh.carrier:Zenoh", "zenoh", reaches=TOPIC, over="zenoh"),
    CarrierRow("rossrv", f"{_PEERS}.ros.service.carrier:RosSrv", "ros", reaches=SERVER),
    CarrierRow(
        "tcpros",
        f"{_PEERS}.ros.carrier:TcpRos",
        "ros",
        magic=(bytes(8),),
        mask=_HEADER,
        push=False,
        reaches=SERVER,
    ),
    CarrierRow(
        "thrift",
        f"{_KITS}.thrift.apache.carrier:Thrift",
        magic=(b"\0", b"\x80\x01\0", b"\x82"),
        reaches=SOCKET,
    ),
    CarrierRow(
        "websocket",
        f"{_WEB}.websocket:WebSocket",
        magic=(b"GET /?ws",),
        reaches=Reach(tells=False, page=True),
    ),
    CarrierRow(
        "xmlrpc",
        f"{_WEB}.xmlrpc:XmlRpc",
        magic=(b"POST /RP", b"POST / H"),
        reaches=Reach("server", page=True),
    ),
    CarrierRow("zmq", f"{_PEERS}.zmq.carrier:Zmq", magic=(b"\xff" + bytes(7),), reaches=SOCKET),
)

# Carriers that other programs have, and what names of topics are registered as.
ELSEWHERE: Final[Mapping[str, CarrierRow]] = _table(
    CarrierRow("h264", push=False, reaches=SERVER),
    CarrierRow("topic", reaches=PORT),
)

_MOVES: Final = "yarpy.transports"
_NO_TLS: Final = (
    "it is reached through Zenoh, whose routers pass messages on in TLS if they are at tls/HOST, "
    "but there is no TLS through them: take tcp"
)

_SOCKETS: Final = "Unix sockets in Python"
_MEMFD: Final = "memory without a name (memfd)"
_SYSV: Final = "System V memory of Linux"
_NEAR: Final[Any] = {"meets": False, "stays": True}
_MPI: Final[Any] = {"title": "MPI", "setting": "YARPY_MPI", "meets": False}

TRANSPORTS: Final[Mapping[str, TransportRow]] = _table(
    TransportRow("tcp", f"{_MOVES}.tcp:Tcp"),
    TransportRow("tls", f"{_MOVES}.tls:Tls"),
    TransportRow("udp", f"{_MOVES}.datagram:Udp", meets=False, datagrams=True),
    TransportRow("mcast", f"{_MOVES}.datagram:Mcast", meets=False, datagrams=True),
    TransportRow("unix", f"{_MOVES}.unix:Unix", system="posix", uses=_SOCKETS, **_NEAR),
    TransportRow("inproc", f"{_MOVES}.inproc:Inproc", **_NEAR),
    TransportRow("memory", f"{_MOVES}.shared.memory:Memory", system="linux", uses=_MEMFD, **_NEAR),
    TransportRow("shmem", f"{_MOVES}.shared.shmem:Shmem", system="linux", uses=_SYSV, **_NEAR),
    TransportRow("mpi", f"{_PEERS}.mpi.bcast:MpiOpener", "mpi", **_MPI),
    TransportRow("bcast", f"{_PEERS}.mpi.bcast:BcastOpener", "mpi", **_MPI),
    TransportRow("ros2", f"{_PEERS}.ros2.medium:Ros2Opener", "ros2", meets=False, proves=False),
    TransportRow(
        "zenoh",
        f"{_PEERS}.zenoh.medium:ZenohOpener",
        "zenoh",
        hosts=".zenoh",
        title="Zenoh",
        prefers="fast_tcp",
        no_tls=_NO_TLS,
        proves=False,
        meets=False,
    ),
)

GRAPHS: Final[Mapping[str, GraphRow]] = _table(
    GraphRow(
        "ros",
        f"{_PEERS}.ros.port_graph:RosGraph",
        calls=(
            Call("getPid", "pid", everywhere=True),
            Call("getBusInfo", "bus", everywhere=True),
            Call("requestTopic", "rtop", everywhere=True),
            Call("publisherUpdate", "rpup", changes=True, everywhere=True),
            Call("getBusStats"),
            Call("getMasterUri"),
            Call("getPublications"),
            Call("getSubscriptions"),
            Call("paramUpdate", changes=True),
            Call("shutdown", changes=True),
        ),
    ),
)

# Packages that are attributes of `yarpy`, so that one import is enough.
PACKAGES: Final[Mapping[str, Row]] = _table(
    Row("devices", f"{_KITS}.devices"),
    Row("record", f"{_KITS}.record"),
    Row("ros", f"{_PEERS}.ros"),
    Row("ros2", f"{_PEERS}.ros2"),
    Row("wrap", f"{_KITS}.wrap"),
    Row("zenoh", f"{_PEERS}.zenoh"),
)

_MONITORS: Final[Mapping[str, Row]] = _table(
    *_rows(
        _STOCK,
        (
            ("adaptive", "adaptive:Adaptive"),
            ("bayer", "bayer:Bayer"),
            ("bottle_compression_zlib", "bottle_compression_zlib:BottleCompressionZlib"),
            ("depthimage_compression_zlib", "depthimage_compression_zlib:DepthZlib"),
            ("depthimage_to_mono", "depthimage_to_mono:DepthImageToMono"),
            ("depthimage_to_rgb", "depthimage_to_rgb:DepthImageToRgb"),
            ("depthimage_to_vector", "depthimage_to_vector:DepthImageToVector"),
            ("image_compression_jpeg", "image_compression_jpeg:ImageCompressionJpeg"),
            ("image_compression_png", "image_compression_png:ImageCompressionPng"),
            ("image_rotation", "image_rotation:ImageRotation"),
            ("image_to_mono", "image_to_mono:ImageToMono"),
            ("priority", "priority:Priority"),
            ("segmentationimage_to_rgb", "segmentationimage_to_rgb:LabelColours"),
            ("sensorMeasurements_to_vector", "sensor_measurements_to_vector:SensorPose"),
            ("simulated_network_delay", "simulated_network_delay:SimulatedNetworkDelay"),
            ("soundfilter_resample", "soundfilter_resample:SoundFilterResample"),
            ("sound_marker", "sound_marker:SoundMarker"),
            ("throttleDown", "throttle_down:ThrottleDown"),
        ),
    ),
    Row("portmonitor", "yarpy.monitors.script.portmonitor:portmonitor"),
    # These two have ports of their own, and so live above them.
    Row("rpc_monitor", "yarpy.network.rpc_monitor:RpcMonitor"),
    Row("stats_monitor", "yarpy.network.stats_monitor:StatsMonitor"),
)

# The verbs of the core are the modules of `yarpy.cli.verbs`; these stay in their rooms.
_COMMANDS: Final[Mapping[str, Row]] = _table(
    Row("autoqos", f"{_KITS}.autoqos.verbs.autoqos:command"),
    Row("convert", f"{_KITS}.record.verbs.convert:command"),
    Row("cut", f"{_KITS}.record.verbs.cut:command"),
    Row("dash", f"{_KITS}.views.verbs.dash:command"),
    Row("demo", f"{_KITS}.sim.verbs.demo:command"),
    Row("dev", f"{_KITS}.launch.verbs.dev:command"),
    Row("doctor", f"{_KITS}.doctor.verbs.doctor:command"),
    Row("down", f"{_KITS}.launch.verbs.down:command"),
    Row("filter", f"{_KITS}.record.verbs.filter:command"),
    Row("hear", f"{_KITS}.views.verbs.hear:command", "audio"),
    Row("info", f"{_KITS}.record.verbs.info:command"),
    Row("log", f"{_KITS}.launch.verbs.log:command"),
    Row("logs", f"{_KITS}.launch.verbs.logs:command"),
    Row("new", f"{_KITS}.launch.verbs.new:command"),
    Row("panel", f"{_KITS}.views.verbs.panel:command"),
    Row("play", f"{_KITS}.record.verbs.play:command"),
    Row("record", f"{_KITS}.record.verbs.record:command", "record"),
    Row("restart", f"{_KITS}.launch.verbs.restart:command"),
    Row("robot", f"{_KITS}.launch.verbs.robot:command"),
    Row("router", f"{_PEERS}.zenoh.verbs.router:command", "zenoh"),
    Row("run", f"{_KITS}.launch.verbs.run:command"),
    Row("scope", f"{_KITS}.views.verbs.scope:command"),
    Row("sim", f"{_KITS}.sim.verbs.sim:command"),
    Row("speak", f"{_KITS}.views.verbs.speak:command", "audio"),
    Row("start", f"{_KITS}.launch.verbs.start:command"),
    Row("status", f"{_KITS}.launch.verbs.status:command"),
    Row("stop", f"{_KITS}.launch.verbs.stop:command"),
    Row("up", f"{_KITS}.launch.verbs.up:command"),
    Row("view", f"{_KITS}.views.verbs.view:command"),
)

# What `yarpy doctor` looks for, in this order.
_FINDINGS: Final = (
    *("server", "name", "address", "program", "connection", "flowing", "monitor"),
    *("carrier", "content", "dialect", "priority", "kernel"),
)

SHIPPED: Final[Mapping[str, Mapping[str, Row]]] = {
    "carriers": CARRIERS,
    "transports": TRANSPORTS,
    # What messages can be read as by name.
    "types": _table(
        *_rows(
            "yarpy.data",
            (
                ("bottle", "bottle:Bottle"),
                ("flex_image", "sig.image:FlexImage"),
                ("image", "sig.image:Image"),
                ("matrix", "sig.matrix:Matrix"),
                ("point_cloud", "sig.pointcloud:PointCloud"),
                ("property", "bottle:Property"),
                ("sound", "sig.sound:Sound"),
                ("stamp", "stamp:Stamp"),
                ("vector", "sig.vector:Vector"),
            ),
        )
    ),
    "monitors": _MONITORS,
    "commands": _COMMANDS,
    "findings": _table(*(Row(name, f"{_KITS}.doctor.{name}:find") for name in _FINDINGS)),
    # What methods are decorated with (`yarpy.wrap`).
    "middlewares": _table(
        Row("yarp", f"{_KITS}.wrap.yarp:Yarp"),
        Row("mqtt", f"{_PEERS}.mqtt.middleware:Mqtt"),
        Row("ros", f"{_PEERS}.ros.middleware:Ros", "ros"),
        Row("ros2", f"{_PEERS}.ros2.middleware:Ros2", "ros2"),
        Row("websocket", f"{_KITS}.wrap.websocket:WebSocket"),
        Row("zenoh", f"{_PEERS}.zenoh.middleware:Zenoh", "zenoh"),
        Row("zeromq", f"{_PEERS}.zmq.middleware:ZeroMq", "zmq"),
    ),
    # Name services beside YARP's own, by the word in its configuration files (`names/base.py`).
    "names": _table(
        Row("ros", f"{_PEERS}.ros.names:open_names"),
        Row("zenoh", f"{_PEERS}.zenoh.names:open_names", "zenoh"),
    ),
    # What else there is in the network, for `yarpy name list`.
    "listings": _table(Row("ros2", f"{_PEERS}.ros2.zenoh.listing:listed", "ros2")),
    # Names of others that a name server tells of its own, and asks (`nameserver/delegate.py`).
    "delegates": _table(
        Row("ros", f"{_PEERS}.ros.delegate:open_delegate"),
        Row("zenoh", f"{_PEERS}.zenoh.delegate:open_delegate", "zenoh"),
    ),
    # Types of other systems, by the ending of their files; `name` finds them without a file.
    "idls": _table(
        Row("thrift", f"{_KITS}.thrift.library:load", "thrift"),
        Row("msg", f"{_PEERS}.ros.message.library:load_type", "ros"),
        Row("srv", f"{_PEERS}.ros.message.library:load_type", "ros"),
        Row("name", f"{_PEERS}.ros.message.library:load_type", "ros"),
    ),
    # What bodies of POST requests are read as, by their Content-Type.
    "contents": _table(Row("application/x-thrift", f"{_KITS}.thrift.apache.body:Body")),
    # What messages of other systems are in recordings, by the encoding of their channel in MCAP.
    "encodings": _table(
        Row("ros1", f"{_PEERS}.ros.bag.recorded:reader"),
        Row("cdr", f"{_PEERS}.ros2.recorded:reader"),
    ),
    # What `yarpy check FILE` asks.
    "checks": _table(Row("check_file", f"{_KITS}.launch.verbs.check_file:command")),
    # What `yarpy connect --of` and `yarpy disconnect --of` ask.
    "applications": _table(Row("join", f"{_KITS}.launch.verbs.join:command")),
    # What `yarpy idl` can do with them.
    "idl_commands": _table(
        Row("rosmsg", f"{_PEERS}.ros.verbs.rosmsg:command", "ros"),
        Row("sniff", f"{_PEERS}.ros.verbs.sniff:command"),
        Row("thrift", f"{_KITS}.thrift.verbs.thrift:command", "thrift"),
    ),
    # What tells the questions of a typed connection apart, by the ending of a file of types.
    "interfaces": _table(Row("thrift", f"{_KITS}.thrift.observed:read", "thrift")),
    # Types of devices in the files of robots (`kits/launch/robot/contract.py`).
    "devices": DEVICES,
    # Graphs in which a simulated robot is shown, too (`kits/sim/robot_publisher.py`).
    "robots": _table(
        Row("ros", f"{_PEERS}.ros.robot:RosRobotPublisher"),
        Row("ros2", f"{_PEERS}.ros2.robot:Ros2RobotPublisher"),
    ),
    # What ports may be part of beside their connections; it has ports of its own, too.
    "graphs": GRAPHS,
    # What typed clients call with: `yarpy.idl` is pure, and so below all ports.
    "clients": _table(
        Row("rpc", "yarpy.port.rpc:RpcClient"), Row("aio", "yarpy.aio.rpc:RpcClient")
    ),
}
