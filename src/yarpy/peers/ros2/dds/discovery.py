"""The nodes that there are over DDS, and the node of a publisher or subscriber: what the tools of
ROS 2 ask when they list nodes.

Rules: DDS knows programs, not nodes. So each program tells of its nodes at the topic
`ros_discovery_info`, anew whenever something changes, and who comes late is told, too. What others
tell is limited, and forgotten when they have gone. Nodes of Humble have longer identities there,
and are not understood, nor do they understand ours.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any, Final
from uuid import UUID

from yarpy.errors import DecodeError
from yarpy.limit import ROS2_PROGRAMS
from yarpy.log import logger
from yarpy.peers.ros2.dds.library import delete, load
from yarpy.peers.ros2.dds.pump import Pump
from yarpy.peers.ros2.dds.qos import dds_qos
from yarpy.peers.ros2.dds.raw import raw_class
from yarpy.peers.ros2.message.library import default_library, hash_of
from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.qos import KEEP_ALL, TRANSIENT_LOCAL, Qos

log = logger("yarpy.ros2")

TOPIC: Final = "ros_discovery_info"
TYPE: Final = "rmw_dds_common/msg/ParticipantEntitiesInfo"
TOLD: Final = Qos(durability=TRANSIENT_LOCAL, depth=1)
HEARD: Final = Qos(durability=TRANSIENT_LOCAL, history=KEEP_ALL)
_BURST: Final = 1000  # messages that are taken at a time


class Discovery:
    """The nodes of a domain. It takes part with our first node."""

    def __init__(self, dds: Any, pump: Pump) -> None:
        self._dds, self._pump = dds, pump
        self._lock = threading.RLock()
        self._ours: dict[Node, tuple[set[UUID], set[UUID]]] = {}  # readers, writers
        self._theirs: dict[UUID, dict[UUID, Node]] = {}  # by program, then by endpoint
        self._names: dict[UUID, list[Node]] = {}
        self._writer: Any = None
        self._reader: Any = None
        self._kind: Any = None
        self._class: Any = None
        self._topic: Any = None

    def add(
        self, node: Node, *, readers: tuple[Any, ...] = (), writers: tuple[Any, ...] = ()
    ) -> None:
        """Tell that endpoints of the library belong to a node."""
        with self._lock:
            ours = self._ours.setdefault(node, (set(), set()))
            ours[0].update(item.guid for item in readers)
            ours[1].update(item.guid for item in writers)
            self._tell()

    def remove(self, node: Node, *endpoints: Any) -> None:
        """Tell that endpoints are gone; a node without any is gone, too."""
        with self._lock:
            ours = self._ours.get(node)
            if ours is None:
                return
            gone = {item.guid for item in endpoints}
            for half in ours:
                half -= gone
            if not any(ours):
                del self._ours[node]
            self._tell()

    def node_of(self, guid: UUID) -> Node | None:
        """Return the node that an endpoint of anybody belongs to, None if nobody has said."""
        with self._lock:
            for node, ours in self._ours.items():
                if guid in ours[0] or guid in ours[1]:
                    return node
            for theirs in self._theirs.values():
                if guid in theirs:
                    return theirs[guid]
        return None

    def nodes(self, present: set[UUID]) -> list[Node]:
        """Return all nodes, of those programs that are there."""
        with self._lock:
            self._join()
            for gone in self._names.keys() - present:
                del self._names[gone], self._theirs[gone]
            others = [node for nodes in self._names.values() for node in nodes]
            return sorted([*self._ours, *others])

    def _join(self) -> None:
        if self._writer is not None:
            return
        from cyclonedds import pub, sub, topic

        self._kind = default_library().load(TYPE)
        hash_ = hash_of(self._kind)
        self._class = raw_class(self._kind._definition.struct)
        self._topic = topic.Topic(self._dds, TOPIC, self._class)
        made: Any = sub.DataReader(self._dds, self._topic, qos=dds_qos(HEARD, hash_, writes=False))
        # That others come and go stays news until somebody takes it, and would wake for ever.
        made.set_status_mask(load().DDSStatus.DataAvailable)
        self._reader = made
        made = pub.DataWriter(self._dds, self._topic, qos=dds_qos(TOLD, hash_, writes=True))
        self._writer = made
        self._pump.add(self._reader, self._take)

    def _tell(self) -> None:
        self._join()
        nodes = [
            {
                "node_namespace": node.namespace,
                "node_name": node.name,
                "reader_gid_seq": [[guid.bytes] for guid in ours[0]],
                "writer_gid_seq": [[guid.bytes] for guid in ours[1]],
            }
            for node, ours in self._ours.items()
        ]
        told = self._kind.from_bottle([[self._dds.guid.bytes], nodes])
        sample = self._class.__new__(self._class)
        sample.body = b"".join(told.to_ros())
        self._writer.write(sample)

    def _take(self) -> Callable[[], None] | None:
        found = self._reader.take(N=_BURST)
        return lambda: self._hear(found)

    def _hear(self, samples: list[Any]) -> None:
        for sample in samples:
            body = getattr(sample, "body", None)
            if body is None:
                continue
            try:
                told = self._kind.from_ros(body)
            except DecodeError as error:
                log.debug("what somebody tells of nodes is ignored: %s", error)
                continue
            self._learn(told)

    def _learn(self, told: Any) -> None:
        program = UUID(bytes=bytes(told.gid.data))
        if program == self._dds.guid:
            return
        endpoints: dict[UUID, Node] = {}
        names = []
        for each in told.node_entities_info_seq:
            node = Node(each.node_namespace or "/", each.node_name)
            names.append(node)
            for gid in (*each.reader_gid_seq, *each.writer_gid_seq):
                endpoints[UUID(bytes=bytes(gid.data))] = node
        with self._lock:
            if program not in self._names and len(self._names) >= ROS2_PROGRAMS:
                return
            self._names[program], self._theirs[program] = names, endpoints

    def close(self) -> None:
        """Idempotent."""
        with self._lock:
            if self._writer is None:
                return
            self._pump.remove(self._reader)
            for item in (self._reader, self._writer, self._topic):
                delete(item)
            self._writer = None
