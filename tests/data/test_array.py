import numpy as np
import pytest

from yarpy.data import array, codec
from yarpy.data.bottle import Bottle
from yarpy.data.image import Image
from yarpy.data.matrix import Matrix
from yarpy.data.value import Float32, Int8, Int16
from yarpy.data.vector import Vector


def as_bottle(values):
    return Bottle.from_bytes(b"".join(array.blocks(values)))


@pytest.mark.parametrize(
    ("dtype", "kind"),
    [
        ("f8", "float64"),
        (">f8", "float64"),
        ("f4", "float32"),
        ("i8", "int64"),
        ("i4", "int32"),
        ("i2", "int16"),
        ("i1", "int8"),
        ("?", "int8"),
        ("u1", "int16"),
        ("u2", "int32"),
        ("u4", "int64"),
        ("u8", "int64"),
        ("f2", "float32"),
    ],
)
def test_lists(dtype, kind):
    values = np.array([0, 1, 1], dtype)
    assert array.blocks(values) == Vector([0, 1, 1], kind).to_wire()
    assert as_bottle(values) == [0, 1, 1]
    assert as_bottle(np.array([], dtype)) == []
    if dtype[0] == "u":
        top = np.iinfo(dtype).max
        if dtype == "u8":
            with pytest.raises(OverflowError, match="63 bits"):
                array.blocks(np.array([top], dtype))
        else:
            assert as_bottle(np.array([top], dtype)) == [top]


@pytest.mark.parametrize(
    ("dtype", "shape", "code"),
    [
        ("u1", (2, 3), "mono"),
        ("u1", (2, 3, 1), "mono"),
        ("u1", (2, 3, 3), "rgb"),
        ("u1", (2, 3, 4), "rgba"),
        ("u2", (2, 3), "mo16"),
        ("f4", (2, 3, 3), "rgb."),
    ],
)
def test_images(dtype, shape, code):
    values = np.arange(np.prod(shape)).reshape(shape).astype(dtype)
    image = codec.decode(b"".join(array.blocks(values)))
    assert isinstance(image, Image) and image.code == code
    assert (image.array == values.reshape(image.array.shape)).all()


@pytest.mark.parametrize("dtype", ["f8", "f4"])
def test_matrices(dtype):
    values = np.array([[1, 2], [3, 4]], dtype)
    assert array.blocks(values) == Matrix(values).to_wire()


@pytest.mark.parametrize(
    ("dtype", "shape"),
    [
        ("c16", (3,)),
        ("U3", (3,)),
        ("O", (3,)),
        ("M8[s]", (3,)),
        ("i4", (2, 3)),
        ("?", (2, 3)),
        ("f8", (2, 3, 3)),
        ("u1", (2, 3, 2)),
        ("u1", (2, 3, 3, 1)),
    ],
)
def test_the_rest_must_be_wrapped(dtype, shape):
    with pytest.raises(TypeError, match="say what is meant"):
        array.blocks(np.zeros(shape, dtype))


@pytest.mark.parametrize(
    ("value", "plain"),
    [
        (np.int8(5), Int8(5)),
        (np.int16(5), Int16(5)),
        (np.int32(5), 5),
        (np.int64(5), 5),
        (np.uint64(5), 5),
        (np.float32(0.1), Float32(0.1)),
        (np.float16(0.5), Float32(0.5)),
        (np.float64(0.1), 0.1),
        (np.bool_(True), True),
        (np.str_("x"), "x"),
        (np.bytes_(b"x"), b"x"),
        (np.array(7), 7),
    ],
)
def test_scalars(value, plain):
    found = array.scalar(value)
    assert found == plain and type(found) is type(plain)


def test_scalars_that_are_nothing_here():
    with pytest.raises(TypeError):
        array.scalar(np.complex128(1))
