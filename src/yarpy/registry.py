"""Name -> plug-in: the one place where carriers, types, monitors and commands are looked up.

Rules: our plug-ins and third-party ones come the same way, from packaging entry points (groups
`yarpy.carriers`, `yarpy.types`, `yarpy.monitors`, `yarpy.commands`, `yarpy.findings`,
`yarpy.middlewares`). Nothing registers itself by being imported. A lookup loads only what it needs;
a plug-in that fails to load is an error that names its distribution.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator, Mapping
from typing import Any, Final

from yarpy.errors import UnknownPlugin

_STOCK: Final = "yarpy.monitors.stock"

# What ships with yarpy is listed here as well as in pyproject.toml: a lookup of `tcp` must not cost
# a scan of every installed distribution (tens of milliseconds), and works from a bare source tree.
SHIPPED: Final[dict[str, dict[str, str]]] = {
    "carriers": {
        "tcp": "yarpy.carriers.tcp:Tcp",
        "fast_tcp": "yarpy.carriers.tcp:FastTcp",
        "tls": "yarpy.carriers.tcp:Tls",
        "udp": "yarpy.carriers.udp:Udp",
        "mcast": "yarpy.carriers.mcast:Mcast",
        "text": "yarpy.carriers.text:Text",
        "text_ack": "yarpy.carriers.text:TextAck",
        "unix_stream": "yarpy.carriers.unix_stream:UnixStream",
        "local": "yarpy.carriers.local:Local",
        "memory": "yarpy.carriers.memory:Memory",
        "shmem": "yarpy.carriers.shmem:Shmem",
        "name_ser": "yarpy.carriers.name_ser:NameSer",
        "http": "yarpy.carriers.http.carrier:Http",
        "mjpeg": "yarpy.carriers.mjpeg:Mjpeg",
        "mpi": "yarpy.carriers.mpi:Mpi",
        "bcast": "yarpy.carriers.mpi:Bcast",
        "mqtt": "yarpy.carriers.mqtt:Mqtt",
        "ros2": "yarpy.carriers.ros2:Ros2",
        "zenoh": "yarpy.carriers.zenoh:Zenoh",
        "rossrv": "yarpy.carriers.rossrv:RosSrv",
        "tcpros": "yarpy.carriers.tcpros:TcpRos",
        "websocket": "yarpy.carriers.websocket:WebSocket",
        "xmlrpc": "yarpy.carriers.xmlrpc:XmlRpc",
        "zmq": "yarpy.carriers.zmq:Zmq",
    },
    "monitors": {
        "adaptive": f"{_STOCK}.adaptive:Adaptive",
        "bayer": f"{_STOCK}.bayer:Bayer",
        "bottle_compression_zlib": f"{_STOCK}.bottle_compression_zlib:BottleCompressionZlib",
        "depthimage_compression_zlib": f"{_STOCK}.depthimage_compression_zlib:DepthZlib",
        "depthimage_to_mono": f"{_STOCK}.depthimage_to_mono:DepthImageToMono",
        "depthimage_to_rgb": f"{_STOCK}.depthimage_to_rgb:DepthImageToRgb",
        "depthimage_to_vector": f"{_STOCK}.depthimage_to_vector:DepthImageToVector",
        "image_compression_jpeg": f"{_STOCK}.image_compression_jpeg:ImageCompressionJpeg",
        "image_compression_png": f"{_STOCK}.image_compression_png:ImageCompressionPng",
        "image_rotation": f"{_STOCK}.image_rotation:ImageRotation",
        "image_to_mono": f"{_STOCK}.image_to_mono:ImageToMono",
        "portmonitor": "yarpy.monitors.script.portmonitor:portmonitor",
        "priority": f"{_STOCK}.priority:Priority",
        "segmentationimage_to_rgb": f"{_STOCK}.segmentationimage_to_rgb:LabelColours",
        "sensorMeasurements_to_vector": f"{_STOCK}.sensor_measurements_to_vector:SensorPose",
        "simulated_network_delay": f"{_STOCK}.simulated_network_delay:SimulatedNetworkDelay",
        "soundfilter_resample": f"{_STOCK}.soundfilter_resample:SoundFilterResample",
        "sound_marker": f"{_STOCK}.sound_marker:SoundMarker",
        "throttleDown": f"{_STOCK}.throttle_down:ThrottleDown",
        # These two have ports of their own, and so live above them.
        "rpc_monitor": "yarpy.network.rpc_monitor:RpcMonitor",
        "stats_monitor": "yarpy.network.stats_monitor:StatsMonitor",
    },
    # What `yarpy doctor` looks for, in this order.
    "findings": {
        name: f"yarpy.network.doctor.{name}:find"
        for name in (
            *("server", "name", "address", "program", "connection", "flowing", "monitor"),
            *("carrier", "content", "dialect", "priority", "kernel"),
        )
    },
    # What methods are decorated with (`yarpy.wrap`).
    "middlewares": {
        name.lower(): f"yarpy.wrap.middlewares.{name.lower()}:{name}"
        for name in ("Yarp", "Mqtt", "Ros", "Ros2", "WebSocket", "Zenoh", "ZeroMq")
    },
    # What carriers go over that have no connections of their own.
    "media": {
        "ros2": "yarpy.ros2.medium:open_medium",
        "zenoh": "yarpy.zenoh.medium:open_medium",
    },
    # What ports may be part of beside their connections; it has ports of its own, too.
    "graphs": {"ros": "yarpy.ros.part:part_of"},
    # What typed clients call with: `yarpy.idl` is pure, and so below all ports.
    "clients": {"rpc": "yarpy.port.rpc:RpcClient", "aio": "yarpy.aio.rpc:RpcClient"},
}


class Registry:
    """Plug-ins of one kind by name. `kind` is `carriers`, `types`, `monitors` or `commands`."""

    def __init__(self, kind: str, shipped: Mapping[str, str] | None = None) -> None:
        self.kind = kind
        self._shipped = dict(SHIPPED.get(kind, {}) if shipped is None else shipped)
        self._loaded: dict[str, Any] = {}
        self._foreign: dict[str, Any] | None = None
        self._lock = threading.RLock()  # two acceptors may meet an unknown protocol at once

    def add(self, name: str, plugin: Any) -> None:
        """Add a plug-in by hand (a test, a notebook); it wins over installed ones."""
        with self._lock:
            self._loaded[name] = plugin

    def remove(self, name: str) -> None:
        """Undo `add`; an installed plug-in of that name can be found again."""
        with self._lock:
            self._loaded.pop(name, None)

    def names(self) -> list[str]:
        """Every name that `load` would find, ours first."""
        with self._lock:
            return list(dict.fromkeys([*self._shipped, *self._entries(), *self._loaded]))

    def load(self, name: str) -> Any:
        """The plug-in called `name`. Raises UnknownPlugin with the nearest match."""
        try:
            return self._loaded[name]
        except KeyError:
            pass
        with self._lock:
            if name in self._shipped:
                plugin = _resolve(name, self._shipped[name])
            else:
                entry = self._entries().get(name)
                if entry is None:
                    raise UnknownPlugin(self._advice(name))
                plugin = self._load_entry(entry)
            self._loaded[name] = plugin
            return plugin

    def __iter__(self) -> Iterator[Any]:
        """Every plug-in that loads; asking for one of the others by name says why."""
        for name in self.names():
            try:
                yield self.load(name)
            except UnknownPlugin:
                continue

    def _entries(self) -> dict[str, Any]:
        if self._foreign is None:
            from importlib.metadata import entry_points

            self._foreign = {
                entry.name: entry
                for entry in entry_points(group=f"yarpy.{self.kind}")
                if entry.name not in self._shipped
            }
        return self._foreign

    def _load_entry(self, entry: Any) -> Any:
        try:
            return entry.load()
        except Exception as error:
            owner = entry.dist.name if entry.dist is not None else "an installed package"
            raise UnknownPlugin(
                f'"{entry.name}" of {owner} is installed but cannot be loaded '
                f"({type(error).__name__}: {error}); repair or uninstall {owner}"
            ) from error

    def _advice(self, name: str) -> str:
        from difflib import get_close_matches

        known = self.names()
        near = get_close_matches(name, known, n=1)
        hint = f'did you mean "{near[0]}"? ' if near else ""
        singular = self.kind.removesuffix("s")
        return (
            f'no {singular} "{name}": {hint}known are {", ".join(known) or "none"}; '
            f"others come with a package that has the entry point group yarpy.{self.kind}"
        )


def _resolve(name: str, target: str) -> Any:
    from importlib import import_module

    module, _, attribute = target.partition(":")
    try:
        return getattr(import_module(module), attribute)
    except ImportError as error:  # a library that it needs; the others do without
        raise UnknownPlugin(
            f'"{name}" cannot be loaded ({error}): install what is missing, as `pip install yarpy` '
            "does"
        ) from error


carriers: Final = Registry("carriers")
types: Final = Registry("types")
monitors: Final = Registry("monitors")
commands: Final = Registry("commands")
findings: Final = Registry("findings")
media: Final = Registry("media")
graphs: Final = Registry("graphs")
clients: Final = Registry("clients")
middlewares: Final = Registry("middlewares")
