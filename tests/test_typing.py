"""Type checkers understand what programs do with yarpy: they find mistakes, accept the pages."""

from pathlib import Path

import pytest
from support import page as pages
from support.type_check import CHECKERS, faults

from yarpy.kits.thrift.file.include import text_interface
from yarpy.kits.thrift.generate.module import python, stubs

ROOT = Path(__file__).parents[1]

CAMERA = "service Camera { bool set_speed(1: double speed, 2: bool exactly = false); }"

PROGRAM = """\
from dataclasses import dataclass

import numpy as np
from camera import Camera
from numpy.typing import NDArray

import yarpy


@dataclass
class Observation:
    rgb: NDArray[np.uint8]
    joints: NDArray[np.float64]


def show(message: yarpy.Message[yarpy.Image]) -> None:
    print(message.source, message.value.array.shape)
    print(message.value.size_in_metres)  # mistake: no such attribute of an Image


with (
    yarpy.Port[yarpy.Image]("/eye", callback=show) as eye,
    yarpy.BufferedPort[Observation]("/seen") as seen,
    yarpy.RpcClient[Camera]("/camera", timeout=1.0) as client,
):
    eye.write(yarpy.Image(np.zeros((2, 3, 3), np.uint8)), yarpy.Stamp(1, 2.0))
    eye.write("no picture")  # mistake: no Image
    for message in seen:
        print(message.value.joints.mean() + message.value.rgb.max())
        print(message.value.joint)  # mistake: the field is called joints
    print(seen.read(timout=1.0).value)  # mistake: timeout
    fast: bool = client.remote.set_speed(30.0, exactly=True)
    client.remote.set_speed("fast")  # mistake: no number
    client.remote.set_sped(30.0)  # mistake: no such method
    print(eye.stats.outputs[0].dropped, fast)  # mistake: the counter is called drops
    yarpy.Prot("/other")  # mistake: Port
"""


@pytest.mark.timeout(300)
@pytest.mark.parametrize("checker", CHECKERS)
def test_every_mistake_of_a_program_is_found_and_nothing_else(tmp_path: Path, checker: str) -> None:
    interface = text_interface(CAMERA, "camera.thrift")
    (tmp_path / "camera.py").write_text(python(interface))
    (tmp_path / "camera.pyi").write_text(stubs(interface))
    (tmp_path / "program.py").write_text(PROGRAM)
    mistakes = {at for at, line in enumerate(PROGRAM.splitlines(), 1) if "# mistake" in line}
    assert len(mistakes) == 8
    found = faults(checker, tmp_path, "program.py")
    assert {fault.line for fault in found} == mistakes, found


# What pages do that no checker can follow, by a part of what it says of it.
BEYOND = (
    # Messages of ROS have this one attribute more than others.
    '"ros"',
    # They do not look whether there is what they know to be there.
    'of "None"',
    # Classes that come from a file while the program runs.
    '"camera.Camera"',
    '"Message" has no attribute',
    'for class "Message"\n',
    # paho says of its own class that it is private.
    '"paho.mqtt.client"',
)


@pytest.mark.timeout(300)
@pytest.mark.parametrize("checker", CHECKERS)
def test_every_line_of_the_pages_is_accepted(tmp_path: Path, checker: str) -> None:
    written = []
    for page in sorted([*(ROOT / "docs").glob("*.md"), ROOT / "README.md"]):
        blocks = [block.text for block in pages.blocks(page) if block.kind == "python"]
        if blocks:
            written.append(f"page_{page.stem.replace('-', '_')}.py")
            (tmp_path / written[-1]).write_text("".join(blocks))
    assert len(written) > 20
    found = faults(checker, tmp_path, *written, strict=False)
    assert [one for one in found if not any(part in one.text for part in BEYOND)] == []
