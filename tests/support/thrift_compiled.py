"""A client or a server of compiled.thrift: the code of Apache's compiler, on Apache's own library.

python -P thrift_compiled.py MODULES client PROTOCOL TRANSPORT PORT     what it hears, as JSON
python -P thrift_compiled.py MODULES server PROTOCOL TRANSPORT PORT     serves until it is killed

MODULES: the folder that the compiler wrote. TRANSPORT: buffered, framed or http.
"""

import json
import sys
from typing import Any


def board(t: Any) -> Any:
    """The struct that is echoed."""
    cells = {t.Cell(1, 2): "one", t.Cell(-3, 1 << 30): "two"}
    tree = t.Tree("top", t.Tree("left", t.Tree("end")), [t.Tree("a"), t.Tree("b", None, [])])
    return t.Board(cells, {t.Cell(0, 0), t.Cell(9, 9)}, {"x": {t.Cell(1, 1): [1, 1 << 40]}}, tree)


def client(made: Any, t: Any, application: Any) -> dict[str, Any]:
    """Call a server; what it answers."""

    def failed(call: Any, *arguments: Any) -> Any:
        try:
            return call(*arguments)
        except t.Refused as error:
            return ["Refused", error.why, error.level]
        except t.Gone as error:
            return ["Gone", error.where.row, error.where.column]
        except application as error:
            return [error.type, error.message]

    chain = t.Chain(1, t.Chain(2, t.Chain(3)))
    tree = board(t).tree
    heard = {
        "ping": made.ping(),
        "echo": made.echo(board(t)) == board(t),
        "mirror": made.mirror(tree) == tree,
        "follow": made.follow(chain) == t.Chain(3, t.Chain(2, t.Chain(1))),
        "read": [
            made.read(item) == item
            for item in (t.Reading(number=1.5), t.Reading(text="ü"), t.Reading(cell=t.Cell(1, 2)))
        ],
        "get": [failed(made.get, key) for key in ("a", "refused", "gone", "broken")],
        "put": [failed(made.put, key, "v") for key in ("a", "refused")],
        "levels": made.levels(t.Level.LOW) == {t.Cell(0, 1): 1, t.Cell(0, 5): 5},
        "match": made.match(True),
        "str": made.str("a", "b"),
        "id": made.id(4, 3),
        "close": made.close(1 << 40),
    }
    made.fire("x")
    made.fire("y")
    heard["fired"] = made.fired()
    return heard


class Server:
    """The service."""

    def __init__(self, t: Any) -> None:
        self.t = t
        self.heard: list[str] = []

    def ping(self) -> str:
        return "pong"

    def echo(self, board: Any) -> Any:
        return board

    def mirror(self, tree: Any) -> Any:
        return tree

    def follow(self, chain: Any) -> Any:
        found = None
        while chain is not None:
            found, chain = self.t.Chain(chain.value, found), chain.next
        return found

    def read(self, reading: Any) -> Any:
        return reading

    def get(self, key: str) -> str:
        if key == "refused":
            raise self.t.Refused("no", self.t.Level.LOW)
        if key == "gone":
            raise self.t.Gone(self.t.Cell(4, 5))
        if key == "broken":
            raise ValueError("oops")
        return key * 2

    def put(self, key: str, value: str) -> None:
        if key == "refused":
            raise self.t.Refused("full")

    def levels(self, lowest: int) -> Any:
        t = self.t
        return {t.Cell(0, level): level for level in (t.Level.LOW, t.Level.HIGH) if level >= lowest}

    def match(self, type: bool) -> bool:
        return not type

    def str(self, len: str, object: str) -> str:
        return len + object

    def id(self, dict: int, int: int) -> int:
        return dict - int

    def fire(self, what: str) -> None:
        self.heard.append(what)

    def fired(self) -> list[str]:
        return self.heard

    def close(self, connect: int) -> int:
        return connect + 1


def main(modules: str, role: str, protocol: str, transport: str, port: int) -> None:
    """Be a client or a server."""
    sys.path.insert(0, modules)
    from compiled_peer import Peer, ttypes  # type: ignore[import-not-found]
    from thrift.protocol.TBinaryProtocol import TBinaryProtocol, TBinaryProtocolFactory
    from thrift.protocol.TCompactProtocol import TCompactProtocol, TCompactProtocolFactory
    from thrift.server import THttpServer, TServer
    from thrift.Thrift import TApplicationException
    from thrift.transport import THttpClient, TSocket, TTransport

    binary = protocol == "binary"
    if role == "client":
        way: Any = (
            THttpClient.THttpClient(f"http://127.0.0.1:{port}/thrift")
            if transport == "http"
            else TSocket.TSocket("127.0.0.1", port)
        )
        if transport != "http":
            framed = transport == "framed"
            way = (TTransport.TFramedTransport if framed else TTransport.TBufferedTransport)(way)
        made = Peer.Client((TBinaryProtocol if binary else TCompactProtocol)(way))
        way.open()
        print(json.dumps(client(made, ttypes, TApplicationException)))
        way.close()
        return
    processor = Peer.Processor(Server(ttypes))
    protocols = (TBinaryProtocolFactory if binary else TCompactProtocolFactory)()
    if transport == "http":
        THttpServer.THttpServer(processor, ("127.0.0.1", port), protocols).serve()
    else:
        transports = {
            "buffered": TTransport.TBufferedTransportFactory,
            "framed": TTransport.TFramedTransportFactory,
        }[transport]()
        listens = TSocket.TServerSocket("127.0.0.1", port)
        TServer.TThreadedServer(processor, listens, transports, protocols, daemon=True).serve()


if __name__ == "__main__":
    main(*sys.argv[1:5], int(sys.argv[5]))
