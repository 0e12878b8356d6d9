"""Our part in a domain of DDS, which nodes of ROS 2 use unless RMW_IMPLEMENTATION says otherwise.

    yarpy connect /out ros2+dds://chatter        yarpy connect ros2+dds://camera/image /in

Rules: the library is given bytes, and gives bytes: its own way of writing and reading messages
takes many times as long. DDS opens sockets and looks for others by multicast, in the local network
unless CYCLONEDDS_URI, ROS_LOCALHOST_ONLY, ROS_AUTOMATIC_DISCOVERY_RANGE or YARPY_BIND say
otherwise, the first of them that is set. What Fast DDS says of its types is not listened to: the
library understands none with a list or array, and would not let these meet ours. Names are
compared, and our log tells of other versions.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from os import environ
from typing import Any, Final

from yarpy.log import logger
from yarpy.peers.ros2.dds.discovery import Discovery
from yarpy.peers.ros2.dds.library import delete, turn
from yarpy.peers.ros2.dds.pump import Pump
from yarpy.peers.ros2.dds.qos import promises_of
from yarpy.peers.ros2.dds.raw import raw_class
from yarpy.peers.ros2.dds.watch import Watch
from yarpy.peers.ros2.key import Key
from yarpy.peers.ros2.message.library import hash_of
from yarpy.peers.ros2.name import NOBODY, Node
from yarpy.peers.ros2.pool import Pool
from yarpy.peers.ros2.token import PUBLISHER, SUBSCRIBER, Token
from yarpy.transports.bind import listening_host, reach

log = logger("yarpy.ros2")

WORD: Final = "dds"
LOCAL: Final = """\
<CycloneDDS><Domain><General><Interfaces><NetworkInterface address="127.0.0.1"/></Interfaces>
<AllowMulticast>false</AllowMulticast></General><Discovery>
<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>
<Peers><Peer address="localhost"/></Peers></Discovery></Domain></CycloneDDS>"""
_AT: Final = """\
<CycloneDDS><Domain><General><Interfaces><NetworkInterface address="{}"/></Interfaces>
</General></Domain></CycloneDDS>"""

# 1.15 is Fast DDS. Settings of the program or its user come behind, and count more.
FITTING: Final = """\
<CycloneDDS><Domain><Compatibility><IgnoreTypeInformation>1.15</IgnoreTypeInformation>
</Compatibility></Domain></CycloneDDS>"""
URI: Final = "CYCLONEDDS_URI"


def settings(environment: Mapping[str, str], host: str) -> tuple[str, str]:
    """Return what the library is told, "" for nothing, and who reaches us, for people. `host`:
    where ports listen."""
    if environment.get(URI):
        return "", "whom CYCLONEDDS_URI lets in"
    found = environment.get("ROS_AUTOMATIC_DISCOVERY_RANGE", "").upper()
    only = environment.get("ROS_LOCALHOST_ONLY", "")
    if only == "1" or found == "LOCALHOST" or (host.startswith("127.") and not only and not found):
        return LOCAL, "this computer alone"
    if host and not only and not found:
        return _AT.format(host), reach()
    return "", "all networks"


@contextmanager
def _fitting() -> Iterator[None]:
    """Let a domain that is joined meanwhile have `FITTING`. The library reads the environment, and
    a domain that we made ourselves would end for all of the program when we leave it."""
    before = environ.get(URI)
    environ[URI] = f"{FITTING},{before}" if before else FITTING
    try:
        yield
    finally:
        if before is None:
            del environ[URI]
        else:
            environ[URI] = before


class _Domains:
    """The domains that we made ourselves, with how many of us are in each. The library refuses to
    make one twice, and one of us may join while the last of before is leaving."""

    def __init__(self) -> None:
        self._held: dict[int, tuple[Any, int]] = {}
        self._lock = threading.RLock()

    def join(self, number: int, told: str) -> None:
        """Be in a domain, which is made with these settings for the first of us."""
        from cyclonedds.domain import Domain

        with self._lock:
            domain, count = self._held.get(number, (None, 0))
            if domain is None:
                domain = Domain(number, f"{FITTING},{told}")
            self._held[number] = domain, count + 1

    def leave(self, number: int) -> None:
        """Be in it no longer; it ends with the last of us."""
        with self._lock:
            domain, count = self._held.pop(number)
            if count > 1:
                self._held[number] = domain, count - 1
            else:
                delete(domain)


_DOMAINS: Final = _Domains()


class Participant:
    """Our part in a domain, for all topics of this process."""

    def __init__(self, domain: int) -> None:
        from cyclonedds import builtin, core
        from cyclonedds import domain as domains

        self.number = domain
        self.users = 0
        told, who = settings(environ, listening_host())
        self._made = bool(told)  # the domain is one that we make ourselves
        if told:
            _DOMAINS.join(domain, told)
        qos = core.Qos(core.Policy.Userdata(b"enclave=/;"))
        try:
            with _fitting():
                self.dds: Any = domains.DomainParticipant(domain, qos=qos)
        except core.DDSException:
            self._leave_domain()
            raise
        self._published: Any = builtin.BuiltinDataReader(
            self.dds, builtin.BuiltinTopicDcpsPublication
        )
        self._subscribed: Any = builtin.BuiltinDataReader(
            self.dds, builtin.BuiltinTopicDcpsSubscription
        )
        self._participants: Any = builtin.BuiltinDataReader(
            self.dds, builtin.BuiltinTopicDcpsParticipant
        )
        self._kinds: dict[tuple[str, str], Any] = {}
        self._alive: Any = core.InstanceState.Alive
        gone = core.ViewState.Any | core.SampleState.Any | core.InstanceState.NotAliveDisposed
        gone |= core.InstanceState.NotAliveNoWriters
        self._gone: dict[str, Any] = {
            kind: core.ReadCondition(reader, gone)
            for kind, reader in ((PUBLISHER, self._published), (SUBSCRIBER, self._subscribed))
        }

        self.pump = Pump(self.dds)
        self.discovery = Discovery(self.dds, self.pump)
        self.watch = Watch(self.dds, self.pump, self.token, self.seen)
        log.info("DDS is spoken in domain %d, open to %s", domain, who)

    def endpoints(self, kind: str) -> Iterator[Any]:
        """Yield the writers of all programs, ours too, or with SUBSCRIBER their readers."""
        reader = self._published if kind == PUBLISHER else self._subscribed
        with turn:
            reader.take(N=10_000, condition=self._gone[kind])  # the library keeps who has left
            found = reader.read(N=10_000)
        for sample in found:
            if sample.sample_info.instance_state == self._alive and hasattr(sample, "topic_name"):
                yield sample

    def seen(self, name: str, kind: str) -> list[Token]:
        """Return the publishers of a topic, or its subscribers, as tokens."""
        topic = f"rt{name}"
        return [self.token(i, kind) for i in self.endpoints(kind) if i.topic_name == topic]

    def token(self, sample: Any, kind: str) -> Token:
        """Return a publisher or subscriber that the library tells of as a token."""
        hash_, qos = promises_of(sample.qos)
        key = Key(self.number, sample.topic_name.removeprefix("rt"), sample.type_name, hash_)
        node = self.discovery.node_of(sample.key) or NOBODY
        return Token(self.number, str(sample.participant_key), 0, 0, kind, node, key, qos)

    def nodes(self) -> list[Node]:
        """Return the nodes of all programs that are there, ours too."""
        return self.discovery.nodes({item.key for item in self._present()})

    def _present(self) -> Iterator[Any]:
        with turn:
            found = self._participants.read(N=10_000)
        for sample in found:
            if sample.sample_info.instance_state == self._alive:
                yield sample

    def end(self) -> None:
        """End it; everything in it is deleted."""
        self.watch.close()
        self.discovery.close()
        self.pump.close()
        delete(self.dds)
        self._leave_domain()

    def ended(self) -> bool:
        """Return False: it is there until it is ended."""
        return False

    def _leave_domain(self) -> None:
        """Leave the domain, if we made it."""
        if self._made:
            _DOMAINS.leave(self.number)

    def class_of(self, kind: Any, what: str = "msg") -> Any:
        """The class of the library for a type, which carries finished bytes; `what`: `srv` for the
        request or response of a service."""
        key = (what, hash_of(kind))
        found = self._kinds.get(key)
        if found is None:
            found = self._kinds[key] = raw_class(kind._definition.struct, what)
        return found


POOL: Final = Pool(Participant)  # by domain
