"""Topics of ROS 2 over DDS, which nodes use unless RMW_IMPLEMENTATION says otherwise.

    yarpy connect /out ros2+dds://chatter        yarpy connect ros2+dds://camera/image /in

Rules: topics alone: the services of the usual middleware cannot be reached by the library. It is
given bytes, and gives bytes: its own way of writing and reading messages takes many times as long.
Unlike over Zenoh, whoever promises less than the other side asks for is not connected; the log says
so. DDS opens sockets and looks for others by multicast, in the local network unless
ROS_LOCALHOST_ONLY, ROS_AUTOMATIC_DISCOVERY_RANGE or CYCLONEDDS_URI say otherwise.
"""

from __future__ import annotations

import os
import re
import threading
import time
from collections import deque
from collections.abc import Mapping
from typing import Any, Final

from yarpy.carriers.ros2 import Incoming, Outgoing
from yarpy.errors import LocalProtocolError, UnknownName, UnknownPlugin, UnknownType
from yarpy.idl.ros2msg.hash import dds_name
from yarpy.idl.ros2msg.library import hash_of
from yarpy.idl.rosmsg.model import ListOf, Primitive, Struct, Type
from yarpy.log import logger
from yarpy.ros2 import kind as kinds
from yarpy.ros2.key import NO_HASH, Key
from yarpy.ros2.name import Node
from yarpy.ros2.qos import KEEP_ALL, Qos
from yarpy.ros2.token import PUBLISHER, SUBSCRIBER, Token
from yarpy.transports.inbox import Inbox

log = logger("yarpy.ros2")

WORD: Final = "dds"
PATIENCE: Final = 2.0  # seconds for others to be found
_LONG: Final = 10.0  # seconds of each wait that has no end
BLOCKING: Final = 100  # milliseconds that a reliable writer waits for slow readers
LOCAL: Final = """\
<CycloneDDS><Domain><General><Interfaces><NetworkInterface address="127.0.0.1"/></Interfaces>
<AllowMulticast>false</AllowMulticast></General><Discovery>
<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>
<Peers><Peer address="localhost"/></Peers></Discovery></Domain></CycloneDDS>"""

_HASH = re.compile(rb"typehash=(RIHS01_[0-9a-f]{64})")


def is_local(environment: Mapping[str, str]) -> bool:
    """Whether only programs of this computer are to be found."""
    reach = environment.get("ROS_AUTOMATIC_DISCOVERY_RANGE", "").upper()
    return environment.get("ROS_LOCALHOST_ONLY") == "1" or reach == "LOCALHOST"


def load() -> Any:
    """The library. Raises UnknownPlugin if it is not installed."""
    try:
        import cyclonedds.core
    except ImportError as error:
        raise UnknownPlugin(
            f"DDS needs cyclonedds ({error}): `pip install 'yarpy[dds]'`"
        ) from error
    return cyclonedds.core


class Participant:
    """Our part in a domain, for all topics of this process."""

    def __init__(self, domain: int) -> None:
        from cyclonedds import builtin, core
        from cyclonedds import domain as domains

        self.number = domain
        self.users = 0
        self._domain: Any = None
        if is_local(os.environ) and not os.environ.get("CYCLONEDDS_URI"):
            self._domain = domains.Domain(domain, LOCAL)
        qos = core.Qos(core.Policy.Userdata(b"enclave=/;"))
        self.dds: Any = domains.DomainParticipant(domain, qos=qos)
        self._published: Any = builtin.BuiltinDataReader(
            self.dds, builtin.BuiltinTopicDcpsPublication
        )
        self._subscribed: Any = builtin.BuiltinDataReader(
            self.dds, builtin.BuiltinTopicDcpsSubscription
        )
        self._kinds: dict[str, Any] = {}

    def seen(self, name: str, kind: str) -> list[Token]:
        """Who publishes a topic, or subscribes to it, in the form of tokens."""
        reader = self._published if kind == PUBLISHER else self._subscribed
        found = []
        for sample in reader.read(N=10_000):
            if getattr(sample, "topic_name", "") == f"rt{name}":
                hash_, qos = _promises(sample.qos)
                key = Key(self.number, name, sample.type_name, hash_)
                who = str(sample.participant_key)
                found.append(Token(self.number, who, 0, 0, kind, Node("/", "_"), key, qos))
        return found

    def class_of(self, kind: Any) -> Any:
        """The class of the library for a type, which carries finished bytes."""
        found = self._kinds.get(hash_of(kind))
        if found is None:
            found = self._kinds[hash_of(kind)] = _raw(kind._definition.struct)
        return found


def _delete(entity: Any) -> None:
    """Delete it, now. Left to itself, the library deletes nothing that the garbage collector found
    in a circle of references: it goes on receiving."""
    entity.__del__()


class _Pool:
    """The participants of this process, by domain."""

    def __init__(self) -> None:
        self._held: dict[int, Participant] = {}
        self._lock = threading.Lock()

    def take(self, domain: int) -> Participant:
        with self._lock:
            found = self._held.get(domain)
            if found is None:
                found = self._held[domain] = Participant(domain)
            found.users += 1
            return found

    def leave(self, participant: Participant) -> None:
        with self._lock:
            participant.users -= 1
            if participant.users:
                return
            del self._held[participant.number]
        _delete(participant.dds)  # with what is left of it


_POOL: Final = _Pool()


class DdsEndpoint(Inbox):
    """A port's publisher or subscriber."""

    def __init__(self, domain: int, port: str, name: str, qos: Qos | None, role: str) -> None:
        super().__init__()
        self.port_name, self.name, self.role = port, name, role
        self.qos, self._given = qos or Qos(), qos is not None
        self.kind: Any = None
        self._part = _POOL.take(domain)
        self._class: Any = None
        self._entity: Any = None
        self._waiting: Any = None
        self._bell: Any = None  # wakes who waits
        self._owned: tuple[Any, ...] = ()
        self._refusal = 0
        self._come: deque[Incoming] = deque()
        self._failure: Any = load().DDSException
        self._opening = threading.Lock()

    def begin(self, type_: str) -> None:
        """Find out about the type, and join. Raises UnknownName, UnknownType, DecodeError."""
        peers = PUBLISHER if self.role == SUBSCRIBER else SUBSCRIBER
        deadline = time.monotonic() + (0.0 if type_ else PATIENCE)
        while not (seen := self._part.seen(self.name, peers)) and time.monotonic() < deadline:
            time.sleep(0.05)
        if seen and not self._given:
            self.qos = seen[0].qos  # what is promised, or asked for, there
        with self._opening:
            if type_:
                self._open(kinds.named(type_, kinds.MESSAGE, seen))
                return
            found = kinds.learned(seen, kinds.MESSAGE, _ask)
            if found is not None:
                self._open(found[0])
            elif self.role == SUBSCRIBER:
                raise UnknownName(
                    f"nobody publishes {self.name} over DDS in domain {self._part.number}: name "
                    f"its type to be there first: ros2+dds:/{self.name}~package/msg/Type"
                )

    def settle(self, value: object) -> Any:
        """The class of its messages, chosen by the first value if nobody has said."""
        with self._opening:
            if self.kind is None:
                self._open(kinds.chosen(value))
            return self.kind

    def _open(self, kind: Any) -> None:
        from cyclonedds import pub, sub, topic

        self._class = self._part.class_of(kind)
        where = topic.Topic(self._part.dds, f"rt{self.name}", self._class)
        made = pub.DataWriter if self.role == PUBLISHER else sub.DataReader
        self._entity = made(self._part.dds, where, qos=_qos(self.qos, hash_of(kind)))
        self._owned += (self._entity, where)
        status = load().DDSStatus
        if self.role == SUBSCRIBER:
            self._refusal = status.RequestedIncompatibleQos
            self._entity.set_status_mask(status.DataAvailable | self._refusal)
            self._waiting = load().WaitSet(self._part.dds)
            self._bell = load().GuardCondition(self._part.dds)
            self._waiting.attach(self._entity)
            self._waiting.attach(self._bell)
            self._owned = (self._waiting, self._bell, *self._owned)
        else:
            self._refusal = status.OfferedIncompatibleQos
            self._entity.set_status_mask(self._refusal)
        self.kind = kind

    def give(self, item: Outgoing) -> None:
        sample = self._class.__new__(self._class)
        sample.body = b"".join(item.body)
        self.look()
        self._entity.write(sample, item.time or time.time_ns())

    def receive(self, wait: bool = True) -> tuple[object] | None:
        if not self._greeted:
            return super().receive(wait)
        try:
            while not self._over:
                self.look()
                if not self._come:
                    self._take()
                if self._come:
                    return (self._come.popleft(),)
                if not wait:
                    raise BlockingIOError("nothing has come")
                limit = _LONG if self._timeout is None else self._timeout
                if not self._waiting.wait(int(limit * 1e9)) and self._timeout is not None:
                    raise BlockingIOError("nothing has come")
        except self._failure as error:
            if not self._over:
                raise BrokenPipeError(f"DDS says: {error}") from error
        return None

    def _take(self) -> None:
        """Take what there is; the library keeps no more than the QoS says."""
        for sample in self._entity.take(N=100):
            body = getattr(sample, "body", None)
            if body is not None:
                self._come.append(Incoming(body, 0, int(sample.sample_info.source_timestamp)))

    def look(self) -> None:
        """Say so if somebody is there, and promises or asks for something else."""
        try:
            if self._entity is not None and self._entity.take_status(self._refusal):
                self.refused()
        except self._failure:
            if not self._over:  # another thread has closed it
                raise

    def refused(self) -> None:
        """Somebody is there, and promises or asks for something else."""
        log.warning(
            "%s: somebody at %s promises less than we ask for, or asks for more than we promise "
            "(%s): say ros2+dds+qos.sensor://... or qos.latched",
            *(self.port_name, self.name, self.qos),
        )

    def interrupt(self) -> None:
        super().interrupt()
        if self._bell is not None:
            self._bell.set(True)

    def ended(self) -> bool:
        if not self._over:
            self.look()
        return self._over

    def close(self) -> None:
        with self._opening:
            if self._over:
                return
            self.interrupt()
        for item in self._owned:
            _delete(item)
        _POOL.leave(self._part)


def _ask(token: Token, name: str, kind: str) -> Any:
    raise UnknownType(f"{name} is not known here, and over DDS nobody describes it")


def _promises(qos: Any) -> tuple[str, Qos]:
    """The type hash and the QoS of somebody else."""
    found = {type(policy).__name__: policy for policy in qos}
    text = " ".join(map(str, qos))
    said = _HASH.search(getattr(found.get("Userdata"), "data", b""))
    depth = re.search(r"KeepLast\(depth=(\d{1,9})\)", text.partition("DurabilityService")[0] + text)
    made = Qos(
        reliability=2 if "Reliability.BestEffort" in text else 1,
        durability=1 if "Durability.TransientLocal" in text else 2,
        depth=int(depth[1]) if depth else 10,
    )
    return (said[1].decode() if said else NO_HASH), made


def _qos(qos: Qos, hash_: str) -> Any:
    from cyclonedds.core import Policy
    from cyclonedds.core import Qos as DdsQos
    from cyclonedds.util import duration

    history: Any = Policy.History.KeepLast(qos.kept)
    if qos.history == KEEP_ALL:
        history = Policy.History.KeepAll
    waits = Policy.Reliability.Reliable(duration(milliseconds=BLOCKING))
    policies = [
        history,
        waits if qos.reliable else Policy.Reliability.BestEffort,
        Policy.Durability.TransientLocal if qos.latched else Policy.Durability.Volatile,
        Policy.Userdata(f"typehash={hash_};".encode()),
    ]
    if qos.latched:
        policies.append(Policy.DurabilityService(0, history, -1, -1, -1))
    return DdsQos(*policies)


def _raw(struct: Struct) -> Any:
    """A class that the library takes for the type, and that carries its bytes."""
    made = _dds_class(struct)

    def serialize(self: Any, *arguments: Any, **options: Any) -> bytes:
        body: bytes = self.body
        return body

    def deserialize(cls: Any, data: bytes, *arguments: Any, **options: Any) -> Any:
        found = cls.__new__(cls)
        found.body = bytes(data)
        return found

    made.serialize, made.deserialize = serialize, classmethod(deserialize)
    return made


def _dds_class(struct: Struct) -> Any:
    from cyclonedds.idl import make_idl_struct

    fields = {field.name: _dds_type(field.type) for field in struct.fields}
    if not fields:
        from cyclonedds.idl.types import uint8

        fields = {"structure_needs_at_least_one_member": uint8}
    name = dds_name(struct.name)
    return make_idl_struct(name.rpartition("::")[2], name.replace("::", "."), fields)


def _dds_type(kind: Type) -> Any:
    from cyclonedds.idl import types as known

    types: Any = known
    if isinstance(kind, Struct):
        return _dds_class(kind)
    if isinstance(kind, ListOf):
        element = _dds_type(kind.element)
        if kind.length is not None:
            return types.array[element, kind.length]
        if kind.most is not None:
            return types.sequence[element, kind.most]
        return types.sequence[element]
    assert isinstance(kind, Primitive)
    if kind.name in ("bool", "string"):
        return {"bool": bool, "string": str}[kind.name]
    return getattr(types, kind.name)


def open_dds(
    domain: int, port: str, name: str, type_: str, qos: Qos | None, role: str
) -> DdsEndpoint:
    """The endpoint of a port at a topic; `role`: PUBLISHER or SUBSCRIBER. Raises UnknownPlugin (the
    extra is not installed), UnknownName (nobody says the type), UnknownType, LocalProtocolError."""
    failure = load().DDSException
    endpoint = DdsEndpoint(domain, port, name, qos, role)
    try:
        endpoint.begin(type_)
    except BaseException as error:
        endpoint.close()
        if isinstance(error, failure):
            raise LocalProtocolError(f"DDS says of {name}: {error}") from error
        raise
    return endpoint
