import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.table import for_each
from support.vectors import rows

from yarpy.data.bottle import Bottle
from yarpy.data.sig.image import FlexImage, Image, is_image
from yarpy.data.sig.pixel import NAMES, pixel_of
from yarpy.data.value import Vocab
from yarpy.errors import DecodeError, Truncated

GOLDEN = [row for row in rows("types") if row["type"] == "image"]


def joined(image):
    return b"".join(image.to_wire())


def picture(name, height=3, width=5, seed=1):
    """Random pixels of a code, as numpy sees them."""
    kind = pixel_of(name)
    raw = np.random.default_rng(seed).integers(0, 100, (height, width, kind.channels))
    array = raw.astype(kind.dtype)
    return array[:, :, 0] if kind.channels == 1 else array


@pytest.mark.parametrize("row", GOLDEN, ids=lambda row: str(row["params"]["pixel"]))
def test_golden(row):
    message, params = bytes.fromhex(row["binary"]), row["params"]
    image = Image.from_wire(message)
    assert (image.width, image.height) == (params["width"], params["height"])
    assert image.code.code == params["code"] and image.quantum == params["quantum"]
    assert image.array.strides[:2] == (params["rowsize"], params["pixelsize"])
    assert joined(image) == message
    # the recorded pixels count up by 7, row after row
    pixels = np.ascontiguousarray(image.array).view("u1").ravel()
    assert pixels.tolist() == [i * 7 % 256 for i in range(len(pixels))]
    again = Image(image.array.copy(), image.code, params["quantum"])
    assert again == image
    assert joined(again) == message, "C++ leaves the padding at zero here, and so do we"
    for size in range(len(message)):
        with pytest.raises(Truncated) as caught:
            Image.from_wire(message[:size])
        assert size < caught.value.need <= len(message)


@for_each(NAMES, [0, 1, 4, 8, 16], [True, False])
def test_every_code_and_padding(name, quantum, top_down):
    array = picture(name)
    image = Image(array, name, quantum, top_down=top_down)
    message = joined(image)
    kind = pixel_of(name)
    step = quantum or 8
    row = -(-5 * kind.stride // step) * step
    assert len(message) == 60 + 3 * row
    assert struct.unpack_from("<iihhii", message, 32) == (
        kind.depth,
        3 * row,
        step,
        0 if top_down else 1,
        5,
        3,
    )
    first = array[0] if top_down else array[-1]
    assert message[60 : 60 + 5 * kind.stride] == first.tobytes()
    again = Image.from_wire(message)
    assert (again.array == array).all() and again.array.dtype == array.dtype
    assert again == image and again.code == name and again.top_down == top_down
    assert (image.array == array).all()
    assert again.quantum == step and joined(again) == message


def test_is_a_bottle_too():
    image = Image(np.array([[[1, 2, 3], [4, 5, 6]]], "u1"))
    text = Bottle.from_bytes(joined(image)).to_text()
    assert text == "[mat] [rgb] (3 8 8 2 1) {1 2 3 4 5 6 0 0}"
    assert is_image(joined(image)) and not is_image(joined(image)[:59])
    assert FlexImage.from_wire(joined(image)) == image


@pytest.mark.parametrize(
    ("dtype", "shape", "code"),
    [
        ("u1", (2, 3), "mono"),
        ("u1", (2, 3, 1), "mono"),
        ("u1", (2, 3, 3), "rgb"),
        ("u1", (2, 3, 4), "rgba"),
        ("u2", (2, 3), "mo16"),
        (">u2", (2, 3), "mo16"),
        ("i1", (2, 3), "sign"),
        ("i4", (2, 3), "int"),
        ("i4", (2, 3, 3), "rgbi"),
        ("f4", (2, 3), "dec"),
        (">f4", (2, 3, 3), "rgb."),
    ],
)
def test_natural_codes(dtype, shape, code):
    array = np.arange(np.prod(shape)).reshape(shape).astype(dtype)
    image = Image(array)
    assert image.code == code
    assert (image.array == array.reshape(image.array.shape)).all()


def test_no_copy_of_pixels():
    array = np.zeros((480, 640, 3), "u1")
    _, pixels = Image(array).to_wire()
    assert np.shares_memory(np.frombuffer(pixels, "u1"), array)
    _, pixels = Image(array[::-1], top_down=False).to_wire()
    assert np.shares_memory(np.frombuffer(pixels, "u1"), array)
    message = bytearray(joined(Image(array)))
    image = Image.from_wire(memoryview(message))
    image.array[0, 0] = 1, 2, 3
    assert message[60:63] == b"\1\2\3"
    assert np.shares_memory(np.asarray(image), np.frombuffer(message, "u1"))
    assert not Image.from_wire(bytes(message)).array.flags.writeable


def test_padded_and_sliced_arrays_are_copied():
    array = np.arange(100, dtype="u1").reshape(10, 10)
    for part in (array, array[::2], array[:, ::2], array.T, array[3:7, 2:5]):
        image = Image(part)
        assert (image.array == part).all()
        assert (Image.from_wire(joined(image)).array == part).all()


@pytest.mark.parametrize("shape", [(0, 0), (0, 5), (5, 0), (0, 5, 3)])
def test_empty(shape):
    image = Image(np.zeros(shape, "u1"))
    message = joined(image)
    assert len(message) == 60
    again = Image.from_wire(message)
    assert again.array.shape[:2] == shape[:2] and again == image


def test_empty_of_no_type():
    # what C++ sends for an image that was never set
    head = (256, 4, 9, 0x0074616D, 9, 0, 257, 5, 0, 0, 0, 0, 0, 0, 12, 0)
    message = struct.pack("<10ihh4i", *head)
    image = Image.from_wire(message)
    assert (image.width, image.height, image.array.size) == (0, 0, 0)
    assert len(joined(image)) == 60


def test_anonymous_pixels():
    image = Image(np.zeros((2, 2, 7), "u1"), -7)
    again = Image.from_wire(joined(image))
    assert again.code.code == -7 and again.array.shape == (2, 2, 7)
    assert repr(again) == "Image(2 x 2, '-7', quantum=8)"
    assert Image(np.zeros((2, 2), "u2"), -2).array.dtype == "u2"


def test_quantum_zero_from_the_wire_means_eight():
    message = bytearray(joined(Image(np.zeros((2, 5), "u1"))))
    struct.pack_into("<h", message, 40, 0)
    image = Image.from_wire(message)
    assert image.quantum == 8 and image.array.strides[0] == 8


def test_what_is_no_image():
    with pytest.raises(ValueError, match="that you give"):
        Image(np.zeros((2, 2, 5), "u1"))
    with pytest.raises(ValueError, match="that you give"):
        Image(np.zeros((2, 2), "f8"))
    with pytest.raises(ValueError, match="that you give"):
        Image(np.zeros(5, "u1"))
    with pytest.raises(ValueError, match="rgb"):
        Image(np.zeros((2, 2), "u1"), "rgb")
    with pytest.raises(ValueError, match="no pixel code"):
        Image(np.zeros((2, 2), "u1"), "what")
    with pytest.raises(ValueError, match="quantum"):
        Image(np.zeros((2, 2), "u1"), quantum=-1)


@pytest.mark.parametrize("at", [0, 4, 8, 12, 16, 20, 24, 28, 32, 44, 48, 52])
@pytest.mark.parametrize("word", [-1, 77, 0x7FFFFFFF])
def test_wrong_header(at, word):
    message = bytearray(joined(Image(picture("rgb"))))
    struct.pack_into("<i", message, at, word)
    with pytest.raises(DecodeError):
        Image.from_wire(message)


def test_header_size_is_not_believed():
    message = bytearray(joined(Image(picture("rgb"))))
    for at in (36, 56):
        struct.pack_into("<i", message, at, 1)
    assert Image.from_wire(message).array.shape == (3, 5, 3)


def test_comparison():
    image = Image(picture("rgb"))
    assert image == Image(picture("rgb"), quantum=1) == Image(picture("rgb"), top_down=False)
    assert image != Image(picture("rgb", seed=2)) and image != Image(picture("rgb"), "bgr")
    assert image != "word"
    assert image.code == "rgb" and image.code == Vocab("rgb")


@given(
    st.sampled_from(NAMES),
    st.integers(1, 9),
    st.integers(1, 9),
    st.integers(1, 20),
    st.booleans(),
)
def test_round_trip(name, width, height, quantum, top_down):
    array = picture(name, height, width)
    image = Image.from_wire(joined(Image(array, name, quantum, top_down=top_down)))
    assert (image.array == array).all()


@given(st.data())
def test_mutated(data):
    message = bytearray(joined(Image(picture("rgb", 2, 2))))
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(16, 59))
        message[at] = data.draw(st.integers(0, 255))
    try:
        image = Image.from_wire(message)
    except DecodeError:
        return
    image.array.sum()
    joined(image)


def test_memory_that_is_laid_out_as_on_the_wire() -> None:
    rows = bytearray(range(16))
    image = Image.over(memoryview(rows), 3, 2, "mono", 8)
    assert image.array.tolist() == [[0, 1, 2], [8, 9, 10]]
    rows[0] = 99
    assert image.array[0, 0] == 99
    assert Image.from_wire(b"".join(image.to_wire())) == image
    with pytest.raises(ValueError, match="3 times 3 pixels take 24 bytes, here are 16"):
        Image.over(memoryview(rows), 3, 3, "mono", 8)


def test_an_image_without_pixels_cannot_be_vast():
    """82 bytes had a Bayer filter take a gigabyte for the rows around none."""
    head = b"".join(map(bytes, Image(np.zeros((0, 5), "u1")).to_wire()))
    assert Image.from_wire(head).width == 5
    at = head.index(struct.pack("<i", 5) + bytes(4))
    for width, height in ((1 << 28, 0), (0, 1 << 28), (65537, 0)):
        with pytest.raises(DecodeError, match="an Image of"):
            Image.from_wire(head[:at] + struct.pack("<2i", width, height) + head[at + 8 :])
