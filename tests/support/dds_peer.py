"""A program that speaks DDS with the types of its library, which writes and reads messages itself.

python dds_peer.py hear TOPIC          prints what is published, as JSON
python dds_peer.py say TOPIC           publishes the lines of its input
python dds_peer.py sensor TOPIC        ... as sensors do, by best effort
python dds_peer.py obey                does what the lines of its input say, each a list in JSON:

    ["writer", ID, TOPIC, RELIABILITY, DURABILITY, DEPTH]    RELIABILITY: reliable, best_effort
    ["reader", ID, TOPIC, RELIABILITY, DURABILITY, DEPTH]    DURABILITY: volatile, transient_local
                                  and perhaps {"deadline", "lifespan", "lease": milliseconds},
                                  and {"type": "Int32"} instead of String, or "Growing": one
                                  that is called String, too; "Adding", at a service: requests
                                  that may grow; {"xcdr2": true} takes that alone
    ["events", ID]                 what the library counts of its events, by name
    ["write", ID, TEXT ...]        and waits until reliable readers have confirmed it
    ["close", ID]
    ["readers", TOPIC]             the reliability and durability of those of all programs

Each is answered by ["done", ...]; what is read is ["heard", ID, TEXT]. A depth of 0 keeps all.
"""

import json
import os
import sys
import threading
from dataclasses import dataclass
from typing import Any

from cyclonedds import builtin
from cyclonedds.core import (
    DDSException,
    InstanceState,
    Policy,
    Qos,
    ReadCondition,
    SampleState,
    ViewState,
)
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.annotations import appendable
from cyclonedds.idl.types import int32, int64
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

RELIABLE = Policy.Reliability.Reliable(duration(milliseconds=100))
MOST = 100_000  # readers of all programs


@dataclass
class String_(IdlStruct, typename="std_msgs.msg.dds_.String_"):  # noqa: N801
    data: str


@dataclass
class Int32_(IdlStruct, typename="std_msgs.msg.dds_.Int32_"):  # noqa: N801
    data: int32


@dataclass
@appendable
class Growing(IdlStruct, typename="std_msgs.msg.dds_.String_"):
    data: str


@dataclass
@appendable
class Adding(IdlStruct, typename="example_interfaces.srv.dds_.AddTwoInts_Request_"):
    a: int64
    b: int64


TYPES: dict[str, Any] = {
    "String": String_,
    "Int32": Int32_,
    "Growing": Growing,
    "Adding": Adding,
}


def say(*words: object) -> None:
    # Two threads say something: print would write a line and its end apart.
    sys.stdout.write(json.dumps(words if len(words) > 1 else words[0]) + "\n")
    sys.stdout.flush()


def qos_of(
    reliability: str, durability: str, depth: int, more: dict[str, int] | None = None
) -> Qos:
    kept: Any = Policy.History.KeepLast(depth) if depth else Policy.History.KeepAll
    latched = durability == "transient_local"
    policies: list[Any] = [
        RELIABLE if reliability == "reliable" else Policy.Reliability.BestEffort,
        Policy.Durability.TransientLocal if latched else Policy.Durability.Volatile,
        kept,
    ]
    if latched:
        policies.append(Policy.DurabilityService(0, kept, -1, -1, -1))
    said = dict(more or {})
    if said.pop("xcdr2", False):
        policies.append(Policy.DataRepresentation(False, True))
    for key, value in said.items():
        time = duration(milliseconds=value)
        policies.append(
            {
                "deadline": Policy.Deadline,
                "lifespan": Policy.Lifespan,
                "lease": Policy.Liveliness.ManualByTopic,
            }[key](time)
        )
    return Qos(*policies)


def events_of(item: Any) -> dict[str, int]:
    """What happened to a reader or writer."""
    if isinstance(item, DataReader):
        return {
            "incompatible_qos": item.get_requested_incompatible_qos_status().total_count,
            "deadline_missed": item.get_requested_deadline_missed_status().total_count,
            "alive": item.get_liveliness_changed_status().alive_count,
            "not_alive": item.get_liveliness_changed_status().not_alive_count,
        }
    return {
        "incompatible_qos": item.get_offered_incompatible_qos_status().total_count,
        "deadline_missed": item.get_offered_deadline_missed_status().total_count,
        "liveliness_lost": item.get_liveliness_lost_status().total_count,
    }


def obey() -> None:
    part = DomainParticipant(int(os.environ.get("ROS_DOMAIN_ID", "0")))
    seen = builtin.BuiltinDataReader(part, builtin.BuiltinTopicDcpsSubscription)
    gone = InstanceState.NotAliveDisposed | InstanceState.NotAliveNoWriters
    gone = ReadCondition(seen, SampleState.Any | ViewState.Any | gone)
    held: dict[str, Any] = {}
    topics: dict[tuple[str, Any], Any] = {}
    lock = threading.Lock()

    def hear() -> None:
        while not ended.wait(0.005):
            with lock:
                readers = {k: item for k, item in held.items() if isinstance(item, DataReader)}
                for name, reader in readers.items():
                    for sample in reader.take(N=100):
                        if isinstance(sample, String_):
                            say("heard", name, sample.data)

    ended = threading.Event()
    listens = threading.Thread(target=hear)
    listens.start()
    say("ready")
    for line in sys.stdin:
        verb, name, *rest = json.loads(line)
        answer: list[object] = []
        with lock:
            if verb in ("writer", "reader"):
                topic, reliability, durability, depth, *more = rest
                said = more[0] if more else {}
                key = (topic, TYPES[said.pop("type", "String")])
                if key not in topics:
                    at = f"rq{topic}Request" if key[1] is Adding else f"rt{topic}"
                    topics[key] = Topic(part, at, key[1])
                qos = qos_of(reliability, durability, depth, said)
                made = DataWriter if verb == "writer" else DataReader
                held[name] = made(part, topics[key], qos=qos)
            elif verb == "write":
                for text in rest:
                    held[name].write(String_(text))
            elif verb == "close":
                held.pop(name).__del__()
            elif verb == "events":
                answer.append(events_of(held[name]))
            elif verb == "readers":
                seen.take(N=MOST, condition=gone)  # else those of all tests until now are kept
                for sample in seen.read(N=MOST):
                    alive = sample.sample_info.instance_state == InstanceState.Alive
                    if alive and getattr(sample, "topic_name", "") == f"rt{name}":
                        text = " ".join(map(str, sample.qos))
                        reliable = "Reliability.BestEffort" not in text
                        latched = "Durability.TransientLocal" in text
                        answer.append(
                            [
                                "reliable" if reliable else "best_effort",
                                "transient_local" if latched else "volatile",
                            ]
                        )
        if verb == "write":
            try:
                held[name].wait_for_acks(duration(seconds=5))
            except DDSException as error:
                answer.append(str(error))
        say("done", verb, answer)
    ended.set()
    listens.join()


def main(verb: str, name: str) -> None:
    part = DomainParticipant(int(os.environ.get("ROS_DOMAIN_ID", "0")))
    topic: Any = Topic(part, f"rt{name}", String_)
    how = Policy.Reliability.BestEffort if verb == "sensor" else RELIABLE
    qos = Qos(how, Policy.History.KeepLast(10))
    if verb == "hear":
        reader = DataReader(part, topic, qos=qos)
        ended = threading.Event()
        threading.Thread(target=lambda: (sys.stdin.read(), ended.set()), daemon=True).start()
        say("ready")
        while not ended.wait(0.02):
            for sample in reader.take(N=10):
                say(sample.data)
        return
    writer = DataWriter(part, topic, qos=qos)
    say("ready")
    for line in sys.stdin:
        writer.write(String_(line.rstrip("\n")))


if __name__ == "__main__":
    if sys.argv[1] == "obey":
        obey()
    else:
        main(sys.argv[1], sys.argv[2])
