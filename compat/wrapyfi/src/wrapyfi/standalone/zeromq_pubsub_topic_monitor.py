"""Shows how many subscribe to each topic at the broker of ZeroMQ, whenever that changes.

    python -m wrapyfi.standalone.zeromq_pubsub_topic_monitor --topic ZEROMQ/CONNECTIONS

Rules: the options are Wrapyfi's. It ends with Ctrl-C.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import logging


def monitor_active_connections(socket_pub_address: str, topic: str) -> None:
    """Log what comes at a topic of JSON, for ever."""
    import zmq

    context = zmq.Context()
    subscriber = context.socket(zmq.SUB)
    try:
        subscriber.connect(socket_pub_address)
        subscriber.setsockopt_string(zmq.SUBSCRIBE, topic)
        while True:
            name, *rest = subscriber.recv_multipart()
            try:
                data = json.loads(rest[0]) if rest else None
            except ValueError as error:
                logging.error("[ZeroMQ] %s: no JSON: %s", name.decode("utf-8", "replace"), error)
                continue
            logging.info("[ZeroMQ] Topic: %s, Data: %s", name.decode("utf-8", "replace"), data)
    finally:
        context.destroy(linger=0)


def parse_args() -> argparse.Namespace:
    """The options of the command line."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--socket_pub_address", default="tcp://127.0.0.1:5555")
    parser.add_argument("--topic", default="ZEROMQ/CONNECTIONS")
    return parser.parse_args()


if __name__ == "__main__":
    logging.basicConfig(level=logging.INFO)
    args = parse_args()
    with contextlib.suppress(KeyboardInterrupt):
        monitor_active_connections(args.socket_pub_address, args.topic)
