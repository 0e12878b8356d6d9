"""A program that speaks DDS with the types of its library, which writes and reads messages itself.

python dds_peer.py hear TOPIC          prints what is published, as JSON
python dds_peer.py say TOPIC           publishes the lines of its input
python dds_peer.py sensor TOPIC        ... as sensors do, by best effort
"""

import json
import sys
import threading
from dataclasses import dataclass
from typing import Any

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration


@dataclass
class String_(IdlStruct, typename="std_msgs.msg.dds_.String_"):  # noqa: N801
    data: str


def main(verb: str, name: str) -> None:
    part = DomainParticipant(0)
    topic: Any = Topic(part, f"rt{name}", String_)
    reliable = Policy.Reliability.Reliable(duration(milliseconds=100))
    how = Policy.Reliability.BestEffort if verb == "sensor" else reliable
    qos = Qos(how, Policy.History.KeepLast(10))
    if verb == "hear":
        reader = DataReader(part, topic, qos=qos)
        ended = threading.Event()
        threading.Thread(target=lambda: (sys.stdin.read(), ended.set()), daemon=True).start()
        print(json.dumps("ready"), flush=True)
        while not ended.wait(0.02):
            for sample in reader.take(N=10):
                print(json.dumps(sample.data), flush=True)
        return
    writer = DataWriter(part, topic, qos=qos)
    print(json.dumps("ready"), flush=True)
    for line in sys.stdin:
        writer.write(String_(line.rstrip("\n")))


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
