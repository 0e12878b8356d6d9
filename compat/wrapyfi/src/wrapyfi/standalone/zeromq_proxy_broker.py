"""The broker at which programs over ZeroMQ meet, as a program by itself.

    python -m wrapyfi.standalone.zeromq_proxy_broker --comm_type pubsub

Rules: the options are Wrapyfi's. Nobody needs it, for the first publisher keeps a broker ready. It
waits for its turn where another program has the sockets, and ends with Ctrl-C.
"""

from __future__ import annotations

import argparse
import contextlib
import logging
import threading
from typing import Any

from yarpy.peers.zmq.broker import Broker


def main(
    comm_type: str,
    socket_ip: str,
    socket_pub_port: int,
    socket_sub_port: int,
    socket_rep_port: int,
    socket_req_port: int,
    **kwargs: Any,
) -> None:
    """Be the broker of topics (`pubsub`, `pubsubpoll`) or of requests (`reqrep`), for ever."""
    with contextlib.suppress(KeyboardInterrupt):
        if comm_type == "reqrep":
            from wrapyfi.middlewares.zeromq import keep_proxy

            keep_proxy(socket_ip, socket_req_port, socket_rep_port)
            _say(f"requests at {socket_ip}: clients {socket_req_port}, servers {socket_rep_port}")
            threading.Event().wait()
        broker = Broker(socket_ip, socket_pub_port, socket_sub_port)
        try:
            broker.bound.wait()
            _say(f"topics at {socket_ip}: SUB {socket_pub_port}, PUB {socket_sub_port}")
            threading.Event().wait()
        finally:
            broker.close()


def parse_args() -> argparse.Namespace:
    """The options of the command line."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--socket_ip", default="127.0.0.1", help="where to listen")
    numbers = {"pub": 5555, "sub": 5556, "rep": 5559, "req": 5560}
    for name, number in numbers.items():
        parser.add_argument(f"--socket_{name}_port", type=int, default=number)
    parser.add_argument("--comm_type", default="pubsub", choices=["pubsub", "pubsubpoll", "reqrep"])
    return parser.parse_args()


def _say(text: str) -> None:
    logging.info("[ZeroMQ] broker of %s", text)


if __name__ == "__main__":
    logging.basicConfig(level=logging.INFO)
    main(**vars(parse_args()))
