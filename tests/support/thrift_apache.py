"""What Apache's own library writes, for tests/golden/thrift/apache.json.

    python -P tests/support/thrift_apache.py      the rows as JSON

Each message of `MESSAGES` is written by the classes TBinaryProtocol and TCompactProtocol of the
package `thrift`, field by field, as its compiler's code would.
"""

import json
from typing import Any

# Types as the library numbers them.
BOOL, BYTE, DOUBLE, I16, I32, I64, STRING, STRUCT, MAP, SET, LIST = (
    2,
    3,
    4,
    6,
    8,
    10,
    11,
    12,
    13,
    14,
    15,
)
CALL, REPLY, EXCEPTION, ONEWAY = 1, 2, 3, 4


def inner(x: int, note: str | None = None) -> list[Any]:
    return [(I32, 1, x), *([(STRING, 2, note)] if note is not None else [])]


#: the struct All of apache.thrift, with every kind of field
ALL: list[Any] = [
    (BOOL, 1, True), (BYTE, 2, -5), (I16, 3, -300), (I32, 4, 70000), (I64, 5, -(1 << 50)),
    (DOUBLE, 6, 1.5), (STRING, 7, "grüß"), (STRING, 8, "\0\1"), (LIST, 9, (I32, [1, -2, 300000])),
    (SET, 10, (STRING, ["x", "y"])), (MAP, 11, (STRING, I64, [["k", 1 << 40]])), (I32, 12, 7),
    (STRUCT, 13, inner(1, "n")), (LIST, 14, (STRUCT, [inner(3), inner(2)])),
    (MAP, 15, (I32, LIST, [[1, (DOUBLE, [0.5, 2.0])]])), (STRUCT, 16, [(DOUBLE, 2, 2.0)]),
    (LIST, 17, (BOOL, [True, False])), (STRUCT, 19, inner(9)), (I16, 40, 6),
    (LIST, 21, (I32, [7, 0])), (LIST, 22, (LIST, [(STRING, ["a"]), (STRING, [])])),
    (LIST, 23, (BYTE, [1, -1])), (LIST, 24, (I64, list(range(20)))),
]  # fmt: skip

MESSAGES: list[tuple[str, str, int, int, list[Any]]] = [
    ("echo", "echo", CALL, 7, [(STRUCT, 1, ALL)]),
    ("echoed", "echo", REPLY, 7, [(STRUCT, 0, ALL)]),
    ("add", "add", CALL, 1, [(I32, 1, 1), (I32, 2, -2)]),
    ("added", "add", REPLY, 1, [(I32, 0, -1)]),
    ("defaults", "add", CALL, 2, [(I32, 1, 1)]),
    ("true", "is_on", CALL, 3, [(BOOL, 3, True)]),
    ("false", "is_on", REPLY, 3, [(BOOL, 0, False)]),
    ("nothing", "nothing", CALL, 300, []),
    ("done", "nothing", REPLY, 300, []),
    ("fire", "fire", ONEWAY, 5, [(STRING, 1, "x")]),
    ("bad", "fail", REPLY, 6, [(STRUCT, 1, [(I32, 1, 5), (STRING, 2, "bad")])]),
    ("worse", "fail", REPLY, 6, [(STRUCT, 4, [(STRING, 1, "worse")])]),
    ("unknown", "what", EXCEPTION, 8, [(STRING, 1, "no method"), (I32, 2, 1)]),
]


def write(out: Any, kind: int, value: Any) -> None:
    """Write a value by the methods of a protocol."""
    if kind == STRUCT:
        out.writeStructBegin("")
        for sort, number, item in value:
            out.writeFieldBegin("", sort, number)
            write(out, sort, item)
            out.writeFieldEnd()
        out.writeFieldStop()
        out.writeStructEnd()
    elif kind == MAP:
        key, sort, pairs = value
        out.writeMapBegin(key, sort, len(pairs))
        for name, item in pairs:
            write(out, key, name)
            write(out, sort, item)
        out.writeMapEnd()
    elif kind in (LIST, SET):
        sort, items = value
        begin, end = ("List", "List") if kind == LIST else ("Set", "Set")
        getattr(out, f"write{begin}Begin")(sort, len(items))
        for item in items:
            write(out, sort, item)
        getattr(out, f"write{end}End")()
    elif kind == STRING:
        out.writeBinary(value.encode())
    else:
        names = {BOOL: "Bool", BYTE: "Byte", DOUBLE: "Double", I16: "I16", I32: "I32", I64: "I64"}
        getattr(out, f"write{names[kind]}")(value)


def rows() -> list[dict[str, Any]]:
    """The messages, as the installed library writes them."""
    from thrift.protocol.TBinaryProtocol import TBinaryProtocol
    from thrift.protocol.TCompactProtocol import TCompactProtocol
    from thrift.transport.TTransport import TMemoryBuffer

    found = []
    for name, method, kind, number, fields in MESSAGES:
        row: dict[str, Any] = {"name": name, "method": method, "kind": kind, "number": number}
        for spelling, protocol in (("binary", TBinaryProtocol), ("compact", TCompactProtocol)):
            buffer = TMemoryBuffer()
            out = protocol(buffer)
            out.writeMessageBegin(method, kind, number)
            write(out, STRUCT, fields)
            out.writeMessageEnd()
            row[spelling] = buffer.getvalue().hex()
        found.append(row)
    return found


if __name__ == "__main__":
    print(json.dumps(rows(), indent=1))
