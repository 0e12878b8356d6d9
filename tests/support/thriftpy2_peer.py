"""A client or a server of apache.thrift that runs on thriftpy2, in an environment of its own.

python -P thriftpy2_peer.py client PROTOCOL TRANSPORT PORT     what it hears, as JSON
python -P thriftpy2_peer.py server PROTOCOL TRANSPORT PORT     serves until it is killed

TRANSPORT: buffered, framed or http.
"""

import json
import sys
import time
from pathlib import Path
from typing import Any

FILE = Path(__file__).parents[1] / "golden" / "thrift" / "apache.thrift"


def everything(m: Any) -> Any:
    """The struct All, as `thrift_module.everything` has it."""
    return m.All(
        a=True, b=-5, c=-300, d=70000, e=-(1 << 50), f=1.5, g="grüß", h=b"\0\1",
        i=[1, -2, 300000], j={"x", "y"}, k={"k": 1 << 40}, l=m.Mode.MANUAL, m=m.Inner(1, "n"),
        n=[m.Inner(), m.Inner(2)], o={1: [0.5, 2.0]}, p=m.Shape(radius=2.0), q=[True, False],
        s=m.Inner(9), t=6, u=[7, 0], v=[["a"], []], w=[1, -1], y=[*range(20)],
    )  # fmt: skip


def client(m: Any, made: Any) -> dict[str, Any]:
    """Call a server; what it answers."""
    from thriftpy2.thrift import TApplicationException

    heard: dict[str, Any] = {
        "ping": made.ping(),
        "add": [made.add(1, 2), made.add(1)],
        "is_on": made.is_on(True),
        "nothing": made.nothing(),
        "numbers": sum(made.numbers(1000)),
    }
    sent = everything(m)
    found = made.echo(sent)
    found.j = set(found.j)
    heard["echo"] = found == sent
    made.fire("x")
    heard["fail"] = []
    for how in range(5):
        try:
            heard["fail"].append(made.fail(how))
        except (m.Bad, m.Worse, TApplicationException) as error:
            heard["fail"].append(repr(error))
    try:
        made.missing()
    except TApplicationException as error:
        heard["missing"] = error.type
    made.close()
    return heard


class Server:
    """The service, with what it hears."""

    def __init__(self, m: Any) -> None:
        self.m = m
        self.fired: list[str] = []

    def ping(self) -> str:
        return "pong"

    def echo(self, all: Any) -> Any:
        assert all.r is None and all.p.radius == 2.0 and all.l == 7
        return all

    def add(self, a: int, b: int) -> int:
        return a + b

    def is_on(self, value: bool) -> bool:
        return not value

    def nothing(self) -> None:
        pass

    def fire(self, what: str) -> None:
        self.fired.append(what)

    def fail(self, how: int) -> str:
        if how == 1:
            raise self.m.Bad(5, "bad")
        if how == 2:
            raise self.m.Worse("worse")
        if how == 9:
            time.sleep(60)
        return ",".join(self.fired)

    def missing(self) -> None:
        pass

    def numbers(self, count: int) -> list[float]:
        return [each / 2 for each in range(count)]


def main(role: str, protocol: str, transport: str, port: int) -> None:
    """Be a client or a server."""
    import thriftpy2
    from thriftpy2 import http, rpc
    from thriftpy2 import protocol as protocols
    from thriftpy2 import transport as transports

    m = thriftpy2.load(str(FILE), module_name="apache_thrift")
    way = {
        "proto_factory": {
            "binary": protocols.TBinaryProtocolFactory,
            "compact": protocols.TCompactProtocolFactory,
        }[protocol](),
        "trans_factory": {
            "buffered": transports.TBufferedTransportFactory,
            "framed": transports.TFramedTransportFactory,
            "http": transports.TBufferedTransportFactory,
        }[transport](),
    }
    over: Any = http if transport == "http" else rpc
    if role == "client":
        made = over.make_client(m.Test, "127.0.0.1", port, timeout=30_000, **way)
        print(json.dumps(client(m, made)))
    elif transport == "http":
        http.make_server(m.Test, Server(m), "127.0.0.1", port, **way).serve()
    else:
        rpc.make_server(m.Test, Server(m), "127.0.0.1", port, **way).serve()


if __name__ == "__main__":
    main(*sys.argv[1:4], int(sys.argv[4]))
