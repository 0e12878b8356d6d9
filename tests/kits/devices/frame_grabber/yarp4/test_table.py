"""Functions and requests: every row is a function, and what it changes can be changed back."""

import numpy as np
import pytest

from yarpy.data.bottle import Bottle, Property
from yarpy.data.sig.image import Image
from yarpy.data.value import Vocab
from yarpy.kits.devices.frame_grabber.yarp4.functions import Configuration, Corner, FrameGrabberMsgs
from yarpy.kits.devices.frame_grabber.yarp4.table import BY_WORDS, FUNCTIONS


def test_rows_are_functions() -> None:
    known = {name.removesuffix("RPC") for name in FrameGrabberMsgs._methods}
    assert FUNCTIONS.keys() <= known and len(BY_WORDS) == len(FUNCTIONS)
    assert all("DC1394" in name for name in known - FUNCTIONS.keys())


@pytest.mark.parametrize(
    ("name", "arguments", "elements"),
    [
        ("getImageCrop", [0, [Corner(1, 2), Corner(3, 4)]], [0, [1, 2, 3, 4]]),
        ("setRgbMirroring", [True], [1]), ("setActive", [12, False], [12, 0]),
        ("setFeature1", [0, 0.5], [0, 0.5]),
    ],
)  # fmt: skip
def test_arguments(name: str, arguments: list[object], elements: list[object]) -> None:
    row = FUNCTIONS[name]
    assert row.ask(arguments) == elements and row.asked(elements) == arguments


@pytest.mark.parametrize(
    ("name", "elements", "fields"),
    [
        ("getRgbMirroring", [1], [True]), ("hasFeature", [0], [False]),
        ("getRgbFOV", [1.5, 2.5], [1.5, 2.5]),
        ("getRgbSupportedConfigurations", [1, 8, 6, 30.0, Vocab("rgb")],
         [[Configuration(8, 6, 30.0, 6449010)]]),
        ("getRgbIntrinsicParam", [Bottle([["k1", 1.5]])], [Property(k1=1.5)]),
    ],
)  # fmt: skip
def test_results(name: str, elements: list[object], fields: list[object]) -> None:
    row = FUNCTIONS[name]
    assert row.tell(elements) == fields and list(row.told(fields)) == elements


def test_images() -> None:
    row = FUNCTIONS["getImage"]
    image = Image(np.arange(36, dtype="uint8").reshape(3, 4, 3))
    (elements,) = row.told([image])
    (found,) = row.tell([elements])
    assert np.array_equal(found.array, image.array)
