"""A recording of the demo robot, in the readers of Foxglove and Rerun: their own libraries.

Foxglove's library for Python writes files and reads none, but it has the descriptions of its
messages: what is recorded is parsed by these. Rerun checks a whole file, and shows it.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from support.command_line import CommandLine
from support.process import Process
from support.wait import HANG

PORTS = ("/icubSim/head/state:o", "/icubSim/head/stateExt:o", "/icubSim/cam/left")


@pytest.fixture(scope="module")
def walk(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """The recording of some seconds."""
    line = CommandLine(tmp_path_factory.mktemp("demo"))
    with line.start("demo", "--no-browser") as demo:
        demo.wait_line("Ctrl-C ends it all", timeout=HANG)
        server = demo.wait_line(r"export YARPY_SERVER=(\S+)", timeout=HANG)[1]
        beside = CommandLine(line.home, {"YARPY_SERVER": server})
        found = beside.run("record", *PORTS, "-o", "walk", "--duration", "3")
        assert found.returncode == 0, found.stderr
    yield line.home / "walk.mcap"


def rerun(*words: str | Path) -> str:
    """What Rerun's program says."""
    pytest.importorskip("rerun", reason="Rerun's own library: pip install rerun-sdk")
    with Process([sys.executable, "-m", "rerun", *words]) as program:
        assert program.wait(2 * HANG) == 0, program.stderr
        return program.stdout


def test_rerun_finds_nothing_amiss(walk: Path) -> None:
    said = rerun("mcap", "check", walk)
    states = {words[-2]: words[0] for line in said.splitlines() if len(words := line.split()) == 5}
    assert {port: states.get(port) for port in PORTS} == dict.fromkeys(PORTS, "ok")


def test_rerun_shows_it(walk: Path) -> None:
    shown = walk.with_suffix(".rrd")
    rerun("mcap", "convert", walk, "-o", shown)
    said = rerun("rrd", "print", shown).replace("\\:", ":")  # as Rerun writes a path
    for port, kind in zip(PORTS, ("Scalars:scalars", "JointStates", "Image:buffer"), strict=True):
        assert any(f" - {port} - " in line and kind in line for line in said.splitlines()), port


def test_messages_are_those_of_foxglove(walk: Path) -> None:
    messages = pytest.importorskip(
        "foxglove.messages", reason="Foxglove's own library: pip install foxglove-sdk"
    )
    pool_of = pytest.importorskip("google.protobuf.descriptor_pool", reason="pip install protobuf")
    from google.protobuf import descriptor_pb2, message_factory
    from mcap.reader import make_reader

    classes: dict[str, Any] = {}
    seen: dict[str, Any] = {}
    with walk.open("rb") as file:
        for schema, channel, message in make_reader(file, validate_crcs=True).iter_messages():
            if schema is None or not schema.name.startswith("foxglove."):
                continue
            if schema.name not in classes:
                theirs = getattr(messages, schema.name.partition(".")[2]).get_schema()
                assert (theirs.name, theirs.encoding) == (schema.name, schema.encoding)
                pool = pool_of.DescriptorPool()
                for one in descriptor_pb2.FileDescriptorSet.FromString(theirs.data).file:
                    pool.Add(one)
                found = pool.FindMessageTypeByName(schema.name)
                classes[schema.name] = message_factory.GetMessageClass(found)
            seen[channel.topic] = classes[schema.name].FromString(message.data)
    picture, joints = seen["/icubSim/cam/left"], seen["/icubSim/head/stateExt:o"]
    assert (picture.width, picture.height, picture.encoding) == (320, 240, "rgb8")
    assert len(picture.data) == picture.step * picture.height
    assert len(joints.joints) == 6
    assert picture.timestamp.seconds > 0
