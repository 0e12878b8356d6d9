"""Recordings that strangers made: MCAP files, the folders of C++, data sets of LeRobot.

Rules: a folder is one input, its files with `CUT` between them. What is read is asked for all
that `yarpy info`, `play` and `convert` ask for.
"""

from __future__ import annotations

import io
import itertools
import json
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import numpy as np
from support.recordings import START, STEP, episode, payload_of

import yarpy
from yarpy import record
from yarpy.errors import YarpError
from yarpy.kits.record.form.converter import Converter
from yarpy.kits.record.form.form import Form
from yarpy.kits.record.kind import kind_of
from yarpy.kits.record.lerobot.dataset import Plan, export
from yarpy.kits.record.lerobot.layout import INFO
from yarpy.kits.record.mcap.pieces import COMPRESSIONS
from yarpy.kits.record.mcap.writer import McapWriter
from yarpy.kits.record.report import lines, report
from yarpy.kits.record.view import foxglove

CUT = b"\n--\n"
_SET = (INFO, "meta/episodes/chunk-000/file-000.parquet", "data/chunk-000/file-000.parquet")
GOLDEN = Path(__file__).parents[1] / "golden" / "datadumper"


def _read(path: Path) -> None:
    with record.open(path) as found:
        lines(report(found, check=True))
        for one in itertools.islice(found.between(list(found.ports), 0), 1000):
            with suppress(YarpError):
                _ = one.value, one.stamp


def read_mcap(data: bytes) -> None:
    """Read a file."""
    with tempfile.NamedTemporaryFile(suffix=".mcap") as file:
        file.write(data)
        file.flush()
        _read(Path(file.name))


def mcap_files() -> tuple[bytes, ...]:
    """Return small ones: finished and not, of each compression."""
    found = []
    with tempfile.TemporaryDirectory() as folder:
        for compression in COMPRESSIONS:
            path = Path(folder) / compression
            with McapWriter(path, compression, {"host": "lab", "lost": '{"/a": 3}'}) as writer:
                for n in range(6):
                    envelope = ("", f"{n} {n}.5", "free text")[n % 3]
                    values = ([n, "x"], yarpy.Vector([1.5]), "word")
                    payload = payload_of(values[n // 2])
                    writer.add(f"/{'ab'[n % 2]}", envelope, START + n * STEP, payload)
                    if n % 3 == 2:
                        writer.note({"what": "lost", "port": "/a", "count": n}, START + n)
                        writer.flush()
                found.append(path.read_bytes())
            found.append(path.read_bytes())
    return (*found, *map(_without_checksums, (False, True)))


def _without_checksums(chunks: bool) -> bytes:
    """Return a file whose changes nothing but its reader notices."""
    from mcap.writer import CompressionType, Writer

    file = io.BytesIO()
    writer = Writer(file, use_chunking=chunks, enable_crcs=False, compression=CompressionType.NONE)
    writer.start()
    schema = writer.register_schema("yarp/bottle", "", b"")
    forms = [
        writer.register_channel(f"/{form}", "yarp", schema, {"port": "/a", "envelope": form})
        for form in ("none", "stamp", "text")
    ]
    notes = writer.register_channel("yarpy.record", "json", 0)
    converted = [*_converted()]
    writer.add_attachment(START, START, "robot.ini", "text/plain", b"[group]")
    writer.add_metadata("yarpy", {"missed": '{"/a": 3}'})
    for n in range(8):
        front = b"\4\0\0\0text" if n % 3 == 2 else b""
        writer.add_message(forms[n % 3], START + n, front + payload_of([n]), START, n)
        writer.add_message(notes, START + n, b'{"what": "lost", "port": "/a", "count": 1}', START)
    for n, (form, data) in enumerate(converted):
        described = writer.register_schema(form.schema, form.schema_encoding, form.description)
        facts = {"port": "/a", "envelope": "text", "yarp.form": form.name, "kind": "yarp/any"}
        channel = writer.register_channel(f"/form{n}", form.encoding, described, facts)
        writer.add_message(channel, START + n, data, START, n)
    writer.finish()
    return file.getvalue()


def _converted() -> Iterator[tuple[Form, bytes]]:
    """Yield a message of each form that others see."""
    picture = yarpy.Image(np.zeros((2, 3, 3), "u1"))
    for value in (picture, yarpy.Sound(np.zeros((2, 3), "i2")), yarpy.Vector([1.5]), [1, 2.5]):
        payload = payload_of(value)
        found = Converter().converted("/a", kind_of(payload), payload, START)
        assert found is not None
        yield found.form, b"".join(map(bytes, found.parts(b"text")))


def read_folder(data: bytes) -> None:
    """Read a folder: info.log, data.log, a picture."""
    parts = [*data.split(CUT), b"", b""]
    with tempfile.TemporaryDirectory() as folder:
        for name, part in zip(("info.log", "data.log", "00000000.ppm"), parts, strict=False):
            Path(folder, name).write_bytes(part)
        _read(Path(folder))


def folders() -> tuple[bytes, ...]:
    """Return what C++ has written."""
    found = []
    for folder in sorted(path for path in GOLDEN.iterdir() if path.is_dir()):
        names = ["info.log", "data.log"]
        names += [path.name for path in folder.glob("00000000.*")]
        found.append(CUT.join((folder / name).read_bytes() for name in names))
    return tuple(found)


def read_set(data: bytes) -> None:
    """Read a data set of LeRobot: what it says of itself, its episodes, its rows."""
    with tempfile.TemporaryDirectory() as folder:
        for name, part in zip(_SET, [*data.split(CUT), b"", b""], strict=False):
            path = Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(part)
        _read(Path(folder))


def sets() -> tuple[bytes, ...]:
    """Return one with two episodes."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        paths = [episode(folder / f"{n}.mcap", n) for n in (3, 2)]
        export(paths, folder / "set", Plan(["/arm"], ["/goal"], fps=10, task="Reach"))
        return (CUT.join((folder / "set" / one).read_bytes() for one in _SET),)


def read_page(data: bytes) -> None:
    """Read what a page says: a wish for another time, or a text."""
    foxglove.control_of(data)
    _, order = foxglove.order_of(data.decode("utf-8", "replace"))
    foxglove.subscriptions_of(order)
    foxglove.numbers_of(order, "subscriptionIds")


def pages() -> tuple[bytes, ...]:
    """Return some of what a page says."""
    order = {"op": "subscribe", "subscriptions": [{"id": 7, "channelId": 1}]}
    wish = bytes.fromhex("030100000040010072d985fe1ee918020000007231")
    return wish, json.dumps({**order, "subscriptionIds": [1, 2]}).encode()
