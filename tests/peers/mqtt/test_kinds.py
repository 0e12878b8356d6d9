"""Every kind of message in the payloads of MQTT."""

from __future__ import annotations

import pytest
from support.foreign_payload import as_payload
from support.kinds import read, walk

import yarpy


@pytest.mark.parametrize("carrier", ["mqtt", "mqtt+qos.1", "mqtt+v5"])
def test_every_kind_arrives(carrier: str) -> None:
    names = yarpy.LocalNames()
    with (
        yarpy.Port("/out", names=names) as out,
        yarpy.BufferedPort("/in", strict=True, names=names) as reader,
    ):
        out.connect("/in", carrier)
        walk(out, read(reader), as_payload, ("long integer",))
