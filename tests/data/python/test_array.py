import array as array_module
import ctypes
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from support.table import for_each

from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.data.python import array
from yarpy.data.sig.image import Image
from yarpy.data.sig.matrix import Matrix
from yarpy.data.sig.vector import Vector
from yarpy.data.value import Float32, Int8, Int16


def sent(obj: Any) -> bytes:
    return b"".join(codec.encode(obj))


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
    ],
)
def test_lists(dtype: str, kind: str) -> None:
    values = np.array([0, 1, 1], dtype)
    assert array.blocks(values) == Vector([0, 1, 1], kind).to_wire()
    assert Bottle.from_bytes(sent(values)) == [0, 1, 1]
    assert Bottle.from_bytes(sent(np.array([], dtype))) == []


@pytest.mark.parametrize(
    ("dtype", "shape", "code"),
    [
        ("u1", (2, 3), "mono"),
        ("u1", (2, 3, 1), "mono"),
        ("u1", (2, 3, 3), "rgb"),
        ("u1", (2, 3, 4), "rgba"),
        ("u2", (2, 3), "mo16"),
        ("i1", (2, 3), "sign"),
        ("i4", (2, 3), "int"),
        ("f4", (2, 3), "dec"),
        ("i1", (2, 3, 3), "rgb-"),
        ("i4", (2, 3, 3), "rgbi"),
        ("f4", (2, 3, 3), "rgb."),
    ],
)
def test_images(dtype: str, shape: tuple[int, ...], code: str) -> None:
    values = np.arange(np.prod(shape)).reshape(shape).astype(dtype)
    image = codec.decode(sent(values))
    assert isinstance(image, Image) and image.code == code
    assert (image.array == values.reshape(image.array.shape)).all()


def test_rows_of_a_table_are_not_padded() -> None:
    """Those of a picture are, as in C++."""
    table = np.zeros((10_000, 1), "f4")
    assert len(sent(table)) == 60 + table.nbytes
    assert codec.decode(sent(np.zeros((2, 101), "u1"))).quantum == 8
    assert codec.decode(sent(np.zeros((2, 8), "u1"))).quantum == 8


def test_matrices() -> None:
    values = np.array([[1.0, 2], [3, 4]])
    assert array.blocks(values) == Matrix(values).to_wire()
    assert array.blocks(np.zeros((0, 3))) == Matrix(np.zeros((0, 3))).to_wire()


# What else there is, with its bytes: the memory as a blob, and what it means.
DESCRIBED = [
    (
        np.array([1, 2, 255], "u1"),
        "00010000 02000000 0c000000 03000000 0102ff"
        "00010000 03000000 04000000 0a000000 79617270792e74797065"
        "00010000 03000000 04000000 05000000 6172726179 04000000 03000000 7c7531 01000000 03000000"
        "01000000 4a000000",
        '{1 2 255} (yarpy.type (array "|u1" 3) 74)',
    ),
    (
        np.array([[[0.5]]], "f2"),
        "00010000 02000000 0c000000 02000000 0038"
        "00010000 03000000 04000000 0a000000 79617270792e74797065"
        "00010000 05000000 04000000 05000000 6172726179 04000000 03000000 3c6632"
        "01000000 01000000 01000000 01000000 01000000 01000000 01000000 5a000000",
        '{0 56} (yarpy.type (array "<f2" 1 1 1) 90)',
    ),
    (
        np.array([True, False]),
        "00010000 02000000 0c000000 02000000 0100"
        "00010000 03000000 04000000 0a000000 79617270792e74797065"
        "00010000 03000000 04000000 05000000 6172726179 04000000 03000000 7c6231 01000000 02000000"
        "01000000 4a000000",
        '{1 0} (yarpy.type (array "|b1" 2) 74)',
    ),
]


@pytest.mark.parametrize(("values", "wire", "text"), DESCRIBED, ids=lambda it: str(it)[:20])
def test_described(values: NDArray[Any], wire: str, text: str) -> None:
    assert sent(values) == bytes.fromhex(wire)
    assert codec.encode_text(values).decode() == text
    for found in (codec.decode(bytes.fromhex(wire)), codec.decode_text(text)):
        assert type(found) is np.ndarray and found.dtype == values.dtype
        assert found.shape == values.shape and (found == values).all()


DTYPES = [
    *("?", "i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f2", "f4", "f8", "c8", "c16"),
    *(">i4", ">f8", ">c8"),
]
SHAPES = [
    *((0,), (1,), (7,), (3, 5), (0, 3), (3, 0), (2, 3, 3), (2, 3, 4), (2, 3, 2), (2, 0, 3)),
    *((4, 5, 6), (1, 1, 1, 1), (2, 3, 4, 5), (9, 1), (1, 9), (70000, 0), (1,) * 32),
]


@for_each(DTYPES, SHAPES)
def test_every_type_and_shape_comes_back(dtype: str, shape: tuple[int, ...]) -> None:
    count = int(np.prod(shape))
    values = (np.arange(count) * 7 % 5).astype(dtype).reshape(shape)
    message = sent(values)
    for found in (
        codec.decode_as(message, np.ndarray),
        np.asarray(codec.decode(message)),
        codec.decode_as(memoryview(message), NDArray[Any]),
    ):
        assert found.dtype == values.dtype.newbyteorder("<") and found.shape == shape
        assert (found == values).all()


def test_what_a_last_axis_of_one_becomes() -> None:
    """A picture in grey, as C++ knows it: the axis is lost."""
    values = np.zeros((4, 5, 1), "u1")
    assert codec.decode_as(sent(values), np.ndarray).shape == (4, 5)
    assert codec.decode_as(sent({"a": values}), dict)["a"].shape == (4, 5, 1)


@pytest.mark.parametrize("dtype", DTYPES)
def test_memory_is_not_copied(dtype: str) -> None:
    for shape in ((40_000,), (200, 200), (20, 20, 100)):
        values = np.ones(shape, dtype)
        blocks = codec.encode(values)
        big = max(blocks, key=len)
        shared = np.shares_memory(np.frombuffer(big, "u1"), values)
        assert shared == (dtype[0] != ">"), shape
        message = b"".join(blocks)
        found = codec.decode_as(message, np.ndarray)
        assert np.shares_memory(np.frombuffer(message, "u1"), found)


def test_other_orders_of_memory() -> None:
    values = np.arange(24).reshape(2, 3, 4)
    for odd in (values.T, values[:, ::-1], np.asfortranarray(values), values[..., ::2]):
        assert (codec.decode(sent(odd)) == odd).all()


# Where these are no wider than float64, numpy sends them as that.
LONG = ("g", "G") if np.dtype("g").itemsize > 8 else ()


@pytest.mark.parametrize(
    "values",
    [
        *(np.zeros(3, kind) for kind in ("U3", "S3", "O", "M8[s]", "V4", *LONG)),
        np.zeros(3, [("x", "f4")]),
    ],
    ids=lambda values: str(values.dtype),
)
def test_what_holds_no_numbers(values: NDArray[Any]) -> None:
    with pytest.raises(TypeError, match=r"cannot be sent: .*astype"):
        array.blocks(values)


@pytest.mark.parametrize("kind", [int, "u1", ">i4"])
def test_what_is_masked_is_not_sent(kind: str) -> None:
    """What numpy puts in place of it would be taken for numbers."""
    masked = np.ma.masked_array(np.arange(6, dtype=kind).reshape(2, 3)[0], mask=[0, 1, 0])
    with pytest.raises(TypeError, match=r"masked array cannot be sent.*filled"):
        array.blocks(masked)
    for within in ([masked], {"a": masked}):
        with pytest.raises(TypeError, match="masked array"):
            codec.encode(within)
    assert array.blocks(masked.filled(7)) == array.blocks(np.array([0, 7, 2], kind))


def test_too_many_dimensions(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(array, "ARRAY_DIMENSIONS", 4)
    with pytest.raises(ValueError, match="5 dimensions; 4 are sent"):
        array.blocks(np.zeros((1,) * 5))


class Foreign:
    """An array of another library: what it shares, it says by one of the protocols."""

    def __init__(self, values: NDArray[Any], *protocols: str) -> None:
        for name in protocols:
            setattr(self, name, getattr(values, name))


class Dlpack:
    def __init__(self, values: NDArray[Any]) -> None:
        self.values = values

    def __dlpack__(self, **options: Any) -> Any:
        return self.values.__dlpack__(**options)

    def __dlpack_device__(self) -> Any:
        return self.values.__dlpack_device__()


class Tensor:
    """As torch has them: a tensor with a gradient shares its memory once it is detached."""

    def __init__(self, values: NDArray[Any], attached: bool = True) -> None:
        self.values, self.attached = values, attached

    def detach(self) -> "Tensor":
        return Tensor(self.values, False)

    def cpu(self) -> "Tensor":
        return self

    def __array__(self, dtype: Any = None, copy: Any = None) -> NDArray[Any]:
        assert not self.attached
        return self.values


@pytest.mark.parametrize(
    "share",
    [
        Dlpack,
        Tensor,
        lambda values: Foreign(values, "__array_interface__"),
        lambda values: array_module.array("H", values.tobytes()),
        lambda values: (ctypes.c_uint16 * 5000).from_buffer(values),
    ],
    ids=["dlpack", "tensor", "interface", "array.array", "ctypes"],
)
def test_what_shares_its_memory(share: Any) -> None:
    values = np.arange(5000, dtype="u2")
    shared = share(values)
    blocks = codec.encode(shared)
    assert len(blocks) == 3 and (codec.decode(b"".join(blocks)) == values).all()
    if not isinstance(shared, array_module.array):
        values[0] = 777
    else:
        shared[0] = 777
    assert codec.decode(b"".join(blocks))[0] == 777, "it was copied"
    assert (codec.decode(sent({"a": shared}))["a"] == np.asarray([777, *values[1:]])).all()
    assert isinstance(Bottle.from_bytes(sent(Bottle(["x", shared])))[1], Bottle)


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
def test_scalars(value: Any, plain: object) -> None:
    found = array.scalar(value)
    assert found == plain and type(found) is type(plain)


def test_scalars_that_are_nothing_here() -> None:
    with pytest.raises(TypeError):
        array.scalar(np.complex128(1))


@pytest.mark.parametrize("kind", ["u4", "u1", "?", "f2", "c8"])
@pytest.mark.parametrize("shape", [(6,), (2, 3), (0,), (2, 1, 3, 1)])
def test_a_blob_of_numbers_is_read_in_place(kind: str, shape: tuple[int, ...]) -> None:
    array = np.arange(np.prod(shape)).reshape(shape).astype(kind)
    message = bytearray(sent(array))
    found = np.asarray(codec.decode(message))
    assert found.dtype == array.dtype and found.shape == shape and (found == array).all()
    if array.size:
        assert np.shares_memory(found, np.frombuffer(message, "u1"))
