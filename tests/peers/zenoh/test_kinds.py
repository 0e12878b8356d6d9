"""Every kind of message in the payloads of Zenoh."""

from __future__ import annotations

import pytest
from support.foreign_payload import as_payload
from support.kinds import read, walk
from support.wait import HANG, wait_until

import yarpy


@pytest.mark.usefixtures("router")
def test_every_kind_arrives(names: yarpy.LocalNames) -> None:
    with (
        yarpy.Port("/out", names=names) as out,
        yarpy.BufferedPort("/in", strict=True, names=names) as reader,
    ):
        reader.connect("zenoh+sub://every/kind")
        out.connect("zenoh://every/kind")

        def heard() -> bool:
            """Write until something comes; what was lost before that does not matter."""
            out.write("first")
            try:
                return bool(reader.read(timeout=0.2))
            except yarpy.Timeout:
                return False

        wait_until(heard)
        out.write("last")
        while reader.read(timeout=HANG).value != "last":
            pass
        walk(out, read(reader), as_payload, ("long integer",))
