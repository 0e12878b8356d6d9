"""JPEG files: pixels in and out, comments, ends, and what is no JPEG."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.steps import measured

from yarpy.data.sig import jpeg
from yarpy.data.sig.image import Image
from yarpy.errors import DecodeError

Y, X = np.mgrid[:24, :37]
COLOUR = np.stack([X * 6, Y * 9, (X + Y) * 4], -1).astype("u1")
GREY = (X * 6).astype("u1")
PICTURE = jpeg.encode(Image(COLOUR))


def shown(data: bytes) -> Image:
    return Image.from_wire(jpeg.decode(data))


def distance(one: np.ndarray, other: np.ndarray) -> float:
    return float(np.abs(one.astype(int) - other.astype(int)).mean())


def test_colours_survive_nearly() -> None:
    image = shown(jpeg.encode(Image(COLOUR), 95))
    assert (image.width, image.height, image.code, image.quantum) == (37, 24, "rgb", 8)
    assert distance(image.array, COLOUR) < 6


@pytest.mark.parametrize("width", [32, 37])
def test_scans_that_go_over_the_picture_again_and_again(
    width: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What is kept from scan to scan is more than the pixels are."""
    cv2 = pytest.importorskip("cv2", reason="pip install opencv-python-headless")
    full = (cv2.IMWRITE_JPEG_SAMPLING_FACTOR, cv2.IMWRITE_JPEG_SAMPLING_FACTOR_444)
    colour = np.ascontiguousarray(COLOUR[:, :width, ::-1])
    _, encoded = cv2.imencode(".jpg", colour, (cv2.IMWRITE_JPEG_PROGRESSIVE, 1, *full))
    data = encoded.tobytes()
    assert distance(shown(data).array, COLOUR[:, :width]) < 6
    monkeypatch.setenv("YARPY_MAX_PICTURE", str(24 * width * 6 - 1))
    with pytest.raises(DecodeError, match=r"several scans: .* bytes are kept .*MAX_PICTURE"):
        jpeg.decode(data)
    _, encoded = cv2.imencode(".jpg", colour, full)
    at_once = encoded.tobytes()
    assert distance(shown(at_once).array, COLOUR[:, :width]) < 6
    head = at_once.index(b"\xff\xda\0\x0c\x03")
    with pytest.raises(DecodeError, match="several scans"):  # the first has one colour of three
        jpeg.decode(at_once[:head] + b"\xff\xda\0\x08\x01\x01\0\0\x3f\0" + at_once[head + 14 :])


def test_rows_are_padded_with_zeros() -> None:
    row = 8 * ((37 * 3 + 7) // 8)
    rows = np.frombuffer(jpeg.decode(PICTURE)[60:], "u1").reshape(24, row)
    assert not rows[:, 37 * 3 :].any()
    assert rows[:, : 37 * 3].any(axis=1).all()


def test_grey_stays_grey() -> None:
    image = shown(jpeg.encode(Image(GREY)))
    assert image.code == "mono"
    assert distance(image.array, GREY) < 3


def test_quality_is_size() -> None:
    sizes = [len(jpeg.encode(Image(COLOUR), quality)) for quality in (1, 50, 75, 100)]
    assert sizes == sorted(sizes)
    assert sizes[0] < sizes[-1] - 200


@pytest.mark.parametrize(
    ("array", "code"),
    [
        (np.ascontiguousarray(COLOUR[..., ::-1]), "bgr"),
        (np.dstack([COLOUR, GREY]), "rgba"),
        (np.dstack([COLOUR[..., ::-1], GREY]), "bgra"),
        (COLOUR.astype("f4"), "rgb."),
        (COLOUR.astype("i4"), "rgbi"),
    ],
)
def test_other_pixels_give_the_same_picture(array: np.ndarray, code: str) -> None:
    assert distance(shown(jpeg.encode(Image(array, code))).array, shown(PICTURE).array) < 1.5


@pytest.mark.parametrize("code", ["dec", "int", "mo16", "sign"])
def test_other_greys_become_grey(code: str) -> None:
    kinds = {"dec": "f4", "int": "i4", "mo16": "u2", "sign": "i1"}
    image = shown(jpeg.encode(Image((X % 100).astype(kinds[code]), code)))
    assert image.code == "mono"


def test_rows_may_be_stored_upside_down() -> None:
    turned = Image(COLOUR, top_down=False)
    assert distance(shown(jpeg.encode(turned)).array, shown(PICTURE).array) < 0.1


@pytest.mark.parametrize(
    "image",
    [
        Image(np.zeros((0, 5, 3), "u1")),
        Image(np.zeros((1, 65501), "u1")),
        Image(np.zeros((4, 4), "u1"), "yuva"),
    ],
    ids=repr,
)
def test_what_cannot_be_compressed(image: Image) -> None:
    with pytest.raises(ValueError):
        jpeg.encode(image)


# ------------------------------------------------------------------------------------- comments


def test_comment_comes_behind_the_header() -> None:
    data = jpeg.commented(PICTURE, b"0 1795218227.46942")
    assert data[20:43] == bytes.fromhex(
        "fffe0015 3020313739353231383232372e343639343200".replace(" ", "")
    )
    assert data[:20] + data[43:] == PICTURE
    assert jpeg.comment(data) == "0 1795218227.46942"
    assert shown(data) == shown(PICTURE)


def test_comment_that_is_missing_or_odd() -> None:
    assert jpeg.comment(PICTURE) == ""
    assert jpeg.comment(b"") == ""
    assert jpeg.comment(jpeg.commented(PICTURE, b"")) == ""
    assert jpeg.comment(jpeg.commented(PICTURE, b"one\ntwo")) == "one"
    assert jpeg.comment(jpeg.commented(PICTURE, "grün".encode())) == "grün"
    long = jpeg.commented(PICTURE, b"x" * 100_000)
    assert len(jpeg.comment(long)) == 65532
    assert shown(long) == shown(PICTURE)


# ----------------------------------------------------------------------------------- what comes in


@pytest.mark.parametrize(
    "data", [b"", b"\xff", b"\xff\xd8", b"GIF89a" * 20, PICTURE[:-40], PICTURE[:100], bytes(5000)]
)
def test_no_jpeg(data: bytes) -> None:
    with pytest.raises(DecodeError):
        jpeg.decode(data)


def test_size_is_looked_at_before_memory_is_taken() -> None:
    at = PICTURE.index(b"\xff\xc0") + 5
    huge = PICTURE[:at] + b"\xff\x00\xff\x00" + PICTURE[at + 4 :]
    with measured() as peak, pytest.raises(DecodeError, match="the limit is 1000000 bytes"):
        jpeg.decode(huge, 1_000_000)
    assert peak.bytes < 1_000_000


@settings(max_examples=150)
@given(st.data())
def test_damage_is_our_error(data: st.DataObject) -> None:
    broken = bytearray(PICTURE)
    for _ in range(data.draw(st.integers(1, 5))):
        at = data.draw(st.integers(0, len(broken) - 1))
        broken[at] = data.draw(st.integers(0, 255))
    try:
        Image.from_wire(jpeg.decode(broken, 1 << 22))
    except DecodeError:
        pass
    jpeg.comment(broken)
    jpeg.Extent().advance(broken)


# ------------------------------------------------------------------------------------------ ends


@pytest.mark.parametrize("data", [PICTURE, jpeg.commented(PICTURE, b"\xff\xd9" * 9)])
def test_end_is_found_however_it_comes(data: bytes) -> None:
    whole = bytearray(data + b"\r\n--more\xff\xd9")
    assert jpeg.Extent().advance(whole) == len(data)
    extent = jpeg.Extent()
    for size in range(len(data)):
        assert extent.advance(whole[:size]) == 0
    assert extent.advance(whole) == len(data)


@pytest.mark.parametrize("data", [b"no picture", b"\xff\xd8text", b"\xff\xd8\xff\xe0\0\1\xff\xd9"])
def test_what_has_no_end(data: bytes) -> None:
    assert jpeg.Extent().advance(bytearray(data)) == -1
