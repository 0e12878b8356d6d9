"""How pictures are stored, by the type of the folder; what comes back."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from support.recordings import payload_of

import yarpy
from yarpy.kits.record.dumper.part import picture_file, type_of
from yarpy.kits.record.dumper.picture import read_picture


@pytest.mark.parametrize(
    ("type_", "code", "ending"),
    [
        ("Image:jpg", "mono", ".pgm"),
        ("Image:jpg", "rgb", ".jpg"),
        ("Image:png", "mono", ".png"),
        ("Image:png", "bgr", ".png"),
        ("Image:png", "grbg", ".pgm"),
        ("DepthCompressed", "dec", ".floatzip"),
        ("Depth", "dec", ".float"),
        ("Image", "dec", ".float"),
        ("Image", "rgba", ".ppm"),
    ],
)
def test_files(type_: str, code: str, ending: str) -> None:
    """Of odd width, too; C++ shears such a JPEG."""
    if ending == ".png":
        pytest.importorskip("cv2", reason='pictures as PNG: pip install "yarpy[vision]"')
    planes = {"rgb": (3,), "bgr": (3,), "rgba": (4,)}.get(code, ())
    ramp = np.broadcast_to(np.arange(5).reshape(1, 5, *([1] * len(planes))), (4, 5, *planes))
    image = yarpy.Image(ramp.astype("f4" if code == "dec" else "u1") * 20, code)
    name, data = picture_file(image, type_)
    assert name == ending
    again = read_picture(data, f"x{ending}", code).array[..., :3]
    wanted = image.array[..., :3]  # alpha is lost
    assert abs(again.astype(int) - wanted).max() <= (3 if name == ".jpg" else 0)


def test_the_type_of_a_port() -> None:
    assert type_of(payload_of([1])) == "Bottle"
    assert type_of(payload_of(yarpy.Image(np.zeros((2, 2), "f4")))) == "Depth"
    assert type_of(payload_of(yarpy.Image(np.zeros((2, 2), "u1")))) == "Image"


@pytest.mark.skipif(not hasattr(os, "fork"), reason="Windows has no fork")
def test_a_forked_child_writes_nothing_twice(tmp_path: Path) -> None:
    program = (
        "import os, sys\nfrom pathlib import Path\nfrom yarpy.data import codec\n"
        "from yarpy.kits.record.dumper.part import Part\n"
        "part = Part(Path(sys.argv[1]), 'Bottle')\n"
        "payload = b''.join(map(bytes, codec.encode(['once'])))\n"
        "part.add('', 1_000_000_000, payload)\n"
        "if child := os.fork(): os.waitpid(child, 0)\n"
    )
    subprocess.run([sys.executable, "-c", program, str(tmp_path)], check=True, timeout=60)
    assert (tmp_path / "data.log").read_text() == "-1 1.000000 once\n"
