"""Every kind of message in the frames of ZeroMQ."""

from __future__ import annotations

import pytest
from support.foreign_payload import as_payload
from support.kinds import as_sent, read, walk

import yarpy


@pytest.mark.parametrize("carrier", ["zmq+push", "zmq+push+raw"])
def test_every_kind_arrives(carrier: str) -> None:
    names = yarpy.LocalNames()
    with (
        yarpy.Port("/out", names=names) as out,
        yarpy.BufferedPort("/in", strict=True, names=names) as reader,
    ):
        out.connect("/in", carrier)
        if "raw" in carrier:
            walk(out, read(reader), as_sent)
        else:
            walk(out, read(reader), as_payload, ("long integer",))
