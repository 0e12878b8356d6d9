"""The parameter server of ZeroMQ, and a client at its prompt.

    python -m wrapyfi.standalone.zeromq_param_server
    python -m wrapyfi.standalone.zeromq_param_server --role client
    input command: (default - set /foo/bar/42) set /robot/speed/3

Rules: the options, words and lines are Wrapyfi's. Both end with Ctrl-C, the client with the end of
its input, too.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import logging
import threading
from collections import Counter
from collections.abc import Iterator, Sequence
from functools import reduce
from typing import Any

import zmq

from wrapyfi.middlewares.zeromq import ZeroMQMiddlewareParamServer

DEFAULT_COMMAND = "set /foo/bar/42"
_PATIENCE = 2000  # milliseconds for what is told of a parameter


def access_nested_dict(d: Any, keys: Sequence[Any]) -> Any:
    """Return the value in nested dicts under these keys, one below the other. Raises KeyError."""
    return reduce(lambda inner, key: inner[key], keys, d)


def parse_prefix(param_full: str, topics: dict[str, Any]) -> dict[str, Any]:
    """Enter `a/b/value` in nested dicts, as {"a": {"b": {"": "value"}}}, and return them."""
    *path, value = param_full.split("/")
    inner = topics
    for key in path:
        if not isinstance(inner.get(key), dict):
            inner[key] = {}
        inner = inner[key]
    inner[""] = value
    return topics


def reverse_parse_prefix(topics: dict[str, Any], prefix: str = "") -> list[str]:
    """The lines of nested dicts: `a/b/value`, each with the prefix before it."""
    return [prefix + line.replace("//", "/") for line in _lines(topics)]


def _lines(topics: dict[str, Any]) -> Iterator[str]:
    for key, inner in topics.items():
        if isinstance(inner, str):
            yield f"{key}/{inner}"
        else:
            for line in reverse_parse_prefix(inner):
                yield f"{key}/{line}"


def main(
    role: str,
    param_ip: str,
    param_pub_port: int,
    param_sub_port: int,
    param_reqrep_port: int,
    param_poll_interval: int,
    param_poll_repeat: int,
    **kwargs: Any,
) -> None:
    """Be the server, or its client, for ever."""
    place = f"tcp://{param_ip}"
    if role == "client":
        _ask(f"{place}:{param_pub_port}", f"{place}:{param_reqrep_port}", param_poll_repeat)
        return
    ZeroMQMiddlewareParamServer.activate(
        param_pub_address=f"{place}:{param_pub_port}",
        param_sub_address=f"{place}:{param_sub_port}",
        param_reqrep_address=f"{place}:{param_reqrep_port}",
        param_poll_interval=param_poll_interval,
        **kwargs,
    )
    logging.info("[ZeroMQ] parameters at %s: requests %d", param_ip, param_reqrep_port)
    try:
        threading.Event().wait()
    finally:
        ZeroMQMiddlewareParamServer.deinit()


def _ask(told_at: str, asked_at: str, repeat: int) -> None:
    context = zmq.Context()
    try:
        requests, told = context.socket(zmq.REQ), context.socket(zmq.SUB)
        requests.connect(asked_at)
        told.connect(told_at)
        last = DEFAULT_COMMAND
        while True:
            last = input(f"input command: (default - {last})") or last
            for command in _commands(last):
                print("Sending request ", command)
                requests.send_string(command)
                reply = requests.recv_string()
                print("Received reply from server:", reply, flush=True)
                if "success:::" in reply:
                    _show(told, reply.split(":::")[1], repeat)
    finally:
        context.destroy(linger=0)


def _commands(line: str) -> list[str]:
    """`['set /a/b/1', 'get /a/b']`, `write {"a": {"b": {"": "1"}}}`, or one command."""
    if line.startswith("write "):
        return reverse_parse_prefix(json.loads(line.removeprefix("write ")), prefix="set ")
    if line.startswith("['"):
        return line.removeprefix("['").removesuffix("']").split("', '")
    return [line]


def _show(told: Any, prefix: str, repeat: int) -> None:
    """Print what is below a prefix."""
    told.subscribe(prefix)
    topics: dict[str, Any] = {}
    times: Counter[str] = Counter()
    while told.poll(_PATIENCE):
        path = "/".join(part.decode("utf-8", "replace") for part in told.recv_multipart())
        name = path.rpartition("/")[0]
        if not name.startswith(prefix):
            continue  # of a subscription before this
        if times[name] == repeat:
            break
        times[name] += 1
        parse_prefix(path, topics)
    told.unsubscribe(prefix)
    try:
        found = access_nested_dict(topics, prefix.split("/"))
    except KeyError:
        print(f"{prefix} has no children", flush=True)
        return
    print(json.dumps({prefix: found}))
    print("Reverse parse (always in set mode regardless of the transmitted command):")
    print(reverse_parse_prefix(found, prefix=f"set {prefix}/"), flush=True)


def parse_args() -> argparse.Namespace:
    """The options of the command line."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--param_ip", default="127.0.0.1", help="where the server is")
    numbers = {"pub": 5655, "sub": 5656, "reqrep": 5659}
    for name, number in numbers.items():
        parser.add_argument(f"--param_{name}_port", type=int, default=number)
    for name, number, what in (
        ("interval", 1, "milliseconds between two rounds of the server"),
        ("repeat", 5, "how often a client hears each parameter"),
    ):
        parser.add_argument(f"--param_poll_{name}", type=int, default=number, help=what)
    parser.add_argument("--role", default="server", choices=["server", "client"])
    return parser.parse_args()


if __name__ == "__main__":
    logging.basicConfig(level=logging.INFO)
    with contextlib.suppress(KeyboardInterrupt, EOFError):
        main(**vars(parse_args()))
