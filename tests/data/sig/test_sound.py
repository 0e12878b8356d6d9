import struct

import numpy as np
import pytest
from support.vectors import rows

from yarpy.data.bottle import Bottle
from yarpy.data.sig.sound import Sound
from yarpy.errors import DecodeError, Truncated

(GOLDEN,) = (row for row in rows("types") if row["type"] == "sound")
MESSAGE = bytes.fromhex(GOLDEN["binary"])


def joined(sound):
    return b"".join(sound.to_wire())


def test_golden():
    sound = Sound.from_wire(MESSAGE)
    params = GOLDEN["params"]
    assert (sound.length, sound.channels) == (params["samples"], params["channels"])
    assert sound.frequency == params["frequency"]
    assert sound.array.tolist() == [[0, 100, 200, 300], [-1, 99, 199, 299]]
    assert sound.samples.dtype == np.int16
    assert joined(sound) == MESSAGE
    assert joined(Sound(sound.array, 8000)) == MESSAGE
    assert Sound(sound.array, 8000) == sound != Sound(sound.array, 16000)
    for size in range(len(MESSAGE)):
        with pytest.raises(Truncated) as caught:
            Sound.from_wire(MESSAGE[:size])
        assert size < caught.value.need <= len(MESSAGE)


def test_captured_reply():
    message = bytes.fromhex(
        "00010000040000000000000002000000010000000100000001000000020000000100000044ac00000500faff"
    )
    assert joined(Sound([5, -6], 44100)) == message
    assert Sound.from_wire(message).array.tolist() == [[5, -6]]


# From C++ YARP 3.5: 3 samples of 2 channels, 8000 a second.
OLD = bytes.fromhex(
    "00010000020000000001000004000000090000006d617400090000006d6f313601010000050000000200"
    "00000c0000000200000003000000020000000c0000000c0000000500faff07000000010008000101000001000000"
    "401f0000"
)


def test_form_of_old_peers():
    sound = Sound.from_wire(OLD)
    assert sound == Sound([[5, -6, 7], [0, 1, 8]], 8000)
    assert sound.to_bottle().to_bytes() == OLD
    assert sound.to_bottle() == Bottle.from_bytes(OLD)
    for size in range(16, len(OLD)):
        with pytest.raises(Truncated) as caught:
            Sound.from_wire(OLD[:size])
        assert size < caught.value.need <= len(OLD)


@pytest.mark.parametrize("at", [*range(16, 48, 4), 52, 56, 60, 64, 80, 84])
@pytest.mark.parametrize("word", [-1, 77, 0x7FFFFFFF])
def test_old_form_with_a_wrong_word(at, word):
    message = bytearray(OLD)
    struct.pack_into("<i", message, at, word)
    with pytest.raises(DecodeError):
        Sound.from_wire(message)


# 2 samples of 3 channels, as YARP 3.10 and 4.0 write them; 4.0 adds markers, here one.
NEW = bytes.fromhex(
    "00010000050000000100000002000000010000000300000001000000020000000100000080bb0000"
    "40010000060000000100ffff0200feff0300fdff"
)
NEWEST = NEW.replace(b"\5", b"\6", 1) + bytes.fromhex(
    "00010000010000000001000004000000020000006100020000006200010000000700000000000000"
)


def test_forms_of_new_peers():
    sound = Sound([[1, -1], [2, -2], [3, -3]], 48000)
    assert Sound.from_wire(NEW) == Sound.from_wire(NEWEST) == sound
    assert sound.to_bottle("3.10").to_bytes() == NEW
    assert sound.to_bottle("4.0").to_bytes() == NEWEST[: len(NEW)] + bytes.fromhex(
        "0001000000000000"
    )
    for size in range(40, len(NEW)):
        with pytest.raises(Truncated) as caught:
            Sound.from_wire(NEW[:size])
        assert size < caught.value.need <= len(NEW)
    with pytest.raises(ValueError, match=r"not '3\.9'"):
        sound.to_bottle("3.9")


@pytest.mark.parametrize("at", [0, 4, 8, 12, 16, 20, 24, 32, 40, 44])
@pytest.mark.parametrize("word", [-1, 77, 0x7FFFFFFF])
def test_new_form_with_a_wrong_word(at, word):
    message = bytearray(NEW)
    struct.pack_into("<i", message, at, word)
    with pytest.raises(DecodeError):
        Sound.from_wire(message)


def test_takes_integers_of_any_width():
    assert Sound(np.array([1, 2], "u1")).array.tolist() == [[1, 2]]
    assert Sound([[1], [2]]).channels == 2
    assert Sound([]).length == 0 and Sound.from_wire(joined(Sound([]))).length == 0
    assert Sound(np.zeros((2, 3), ">i2")).array.dtype == "<i2"
    with pytest.raises(OverflowError, match="16 bits"):
        Sound([40000])
    with pytest.raises(TypeError, match="int16"):
        Sound([0.5])
    with pytest.raises(ValueError, match="shape"):
        Sound(np.zeros((1, 1, 1), "i2"))


def test_memory():
    samples = np.zeros((2, 4000), "i2")
    head, data = Sound(samples).to_wire()
    assert len(head) == 40 and np.shares_memory(np.frombuffer(data, "i2"), samples)
    message = bytearray(MESSAGE)
    sound = Sound.from_wire(message)
    message[40] = 9
    assert sound.array[0, 0] == 9
    assert repr(sound) == "Sound(2 channels, 4 samples, 8000 per second)"
    assert sound != "word"


@pytest.mark.parametrize("at", [0, 4, 8, 12, 16, 20, 24, 32])
@pytest.mark.parametrize("word", [-1, 77, 0x7FFFFFFF])
def test_wrong_header(at, word):
    message = bytearray(MESSAGE)
    struct.pack_into("<i", message, at, word)
    with pytest.raises(DecodeError):
        Sound.from_wire(message)
