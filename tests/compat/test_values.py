"""Vectors and places in them, sounds, matrices, words of 64 bits, variables, the log."""

import sys

import pytest

import yarp


def test_places_in_vectors() -> None:
    numbers = yarp.DVector([1.0, 2.0, 3.0])
    place = numbers.begin()
    assert place.value() == 1.0 and place.incr().value() == 2.0
    assert numbers.end() - numbers.begin() == 3 and place.distance(numbers.end()) == 2
    assert [*numbers.begin()] == [1.0, 2.0, 3.0] and [*numbers.rbegin()] == [3.0, 2.0, 1.0]
    assert numbers.rend() == 3 and (numbers.begin() + 1) == place and place.previous() == 1.0
    with pytest.raises(StopIteration):
        numbers.end().value()
    assert numbers.erase(numbers.begin(), numbers.begin() + 2).value() == 3.0
    assert numbers.insert(numbers.begin(), 2, 7.0) is None and [*numbers] == [7.0, 7.0, 3.0]
    vector = yarp.Vector([1.0, 2.0, 3.0])
    assert vector.cbegin().next() == 1.0 and vector.erase(vector.begin()).value() == 2.0
    assert vector.getMemoryBlock() == b"\0\0\0\0\0\0\0@" + b"\0\0\0\0\0\0\x08@"
    pairs = yarp.SPairVector([("a", "b")])
    pairs.push_back(("c", "d"))
    assert [*pairs] == [("a", "b"), ("c", "d")]
    with pytest.raises(TypeError):
        pairs.push_back((1, 2))


def test_sounds() -> None:
    sound = yarp.Sound()
    assert yarp.makeTone(sound, 0.1, 2, 8000, 100, 1000)
    assert (sound.getSamples(), sound.getChannels(), sound.getFrequency()) == (800, 2, 8000)
    assert sound.get(20, 1) == 1000  # a quarter of a turn
    channel, sample, value = yarp.IVector(1), yarp.IVector(1), yarp.IVector(1)
    sound.set(2000, 33, 1)
    sound.findPeak(channel, sample, value)
    assert (channel[0], sample[0], value[0]) == (1, 33, 2000)
    sound.findPeakInChannel(0, sample, value)
    assert value[0] == 1000
    assert sound.getChannel(1)[33] == 2000
    assert [*sound.getInterleavedAudioRawData()][:2] == [0, 0]
    assert len(sound.getNonInterleavedAudioRawData()) == 1600
    square, tooth = yarp.Sound(), yarp.Sound()
    assert yarp.makeSquareWave(square, 1, 1, 10, 1, 5) and yarp.makeSawTooth(tooth, 1, 1, 10, 1, 50)
    assert [square.get(at) for at in (1, 7)] == [5, -5] and tooth.get(2) == 20
    assert not yarp.makeTone(sound, 0.0)
    both = yarp.mix(square, tooth, 0.5)
    assert both.get(2) == (5 + 20) // 2 and yarp.mix(square, yarp.Sound(), 0.5).getSamples() == 0
    square.overwrite(tooth, 8, 5)
    assert [square.get(at) for at in (8, 9)] == [tooth.get(0), tooth.get(1)]
    assert yarp.SoundMarker().isEqual(yarp.SoundMarker())


def test_matrices_and_rows() -> None:
    matrix, out = yarp.Matrix(3, 4), yarp.Matrix()
    matrix[2, 3] = 5.0
    assert yarp.submatrix(matrix, out, 1, 2, 2, 3) and (out.rows(), out[1, 1]) == (2, 5.0)
    assert not yarp.submatrix(matrix, out, 1, 3, 0, 0)
    assert yarp.removeCols(matrix, out, 0, 3) and (out.cols(), out[2, 0]) == (1, 5.0)
    assert yarp.removeRows(matrix, out, 0, 2) and out.rows() == 1 and matrix.rows() == 3
    assert not yarp.removeRows(matrix, out, 2, 2)
    assert yarp.PAD_BYTES(9, 8) == 7 and yarp.PAD_BYTES(8, 8) == 0


def test_words_of_64_bits() -> None:
    assert yarp.decode64(yarp.encode64("position")) == "position"
    assert yarp.createVocab64("s", "e", "t") == yarp.encode("set")
    assert yarp.clockTypeToString(yarp.YARP_CLOCK_NETWORK) == "Network clock"
    assert yarp.clockTypeToString() == "System clock"


def test_variables_and_directories(monkeypatch) -> None:
    for name in ("YARP_DATA_HOME", "XDG_DATA_HOME", "YARP_CONFIG_DIRS"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("HOME", "/somebody")
    if sys.platform == "linux":  # the only one with these variables
        monkeypatch.setenv("XDG_CONFIG_DIRS", "/etc/a:/etc/b")
        assert yarp.yarpdatahome() == "/somebody/.local/share/yarp"
        assert [*yarp.yarpconfigdirs()] == ["/etc/a/yarp", "/etc/b/yarp"]
        assert yarp.datahome() == "/somebody/.local/share"
    monkeypatch.setenv("YARP_DATA_HOME", "/data")
    assert yarp.yarpdatahome() == "/data"
    monkeypatch.setenv("THIS_TEST", "yes")
    found = yarp.BVector(1)
    assert yarp.get_string("THIS_TEST", found) == "yes" and found[0]
    assert yarp.set_bool("THIS_TEST", True) and yarp.get_bool("THIS_TEST")
    assert yarp.set_path("THIS_TEST", ["/a", "/b"]) and [*yarp.get_path("THIS_TEST")] == [
        "/a",
        "/b",
    ]
    assert not yarp.set_string("THIS=TEST", "x")
    assert yarp.unset("THIS_TEST") and not yarp.is_set("THIS_TEST")
    assert yarp.get_string("THIS_TEST", "HOME", "/nowhere", "/deep") == "/somebody/deep"


def test_what_the_log_prints(capsys) -> None:
    heard = []
    try:
        yarp.Log.setMinimumPrintLevel(yarp.Log.WarningType)
        yarp.Log.info("quiet")
        yarp.Log.warning("loud")
        yarp.Log.setPrintCallback(lambda level, text: heard.append((level, text)))
        yarp.Log.error("called")
        yarp.Log.setForwardCallback(lambda level, text: heard.append((text, level)))
        yarp.Log.setMinimumForwardLevel(yarp.Log.ErrorType)
        yarp.Log.warning("near")
        yarp.Log.error("far")
    finally:
        yarp.Log.setMinimumPrintLevel(yarp.Log.defaultMinimumPrintLevel())
        yarp.Log.setMinimumForwardLevel(yarp.Log.defaultMinimumForwardLevel())
        yarp.Log.setPrintCallback(None)
        yarp.Log.setForwardCallback(None)
    shown = capsys.readouterr()
    assert shown.out == "" and shown.err == "[WARNING] loud\n"
    assert heard == [
        ("ERROR", "called"),
        ("WARNING", "near"),
        ("ERROR", "far"),
        ("far", "ERROR"),
    ]
    assert yarp.Log.printCallback() is yarp.Log.defaultPrintCallback()


def test_areas_and_paths() -> None:
    area = yarp.Map2DArea("kitchen", [(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (0.0, 2.0)])
    least, most, middle, some = (yarp.Map2DLocation() for _ in range(4))
    assert area.findAreaBounds(least, most) and (most.x, most.y, least.x) == (4.0, 2.0, 0.0)
    assert area.getCentroid(middle) and (middle.x, middle.y) == (2.0, 1.0)
    assert area.getRandomLocation(some) and area.checkLocationInsideArea(some)
    thing = yarp.Map2DObject("kitchen", 1.0, 1.0, 0.5, 0.0, 0.0, 0.0, "cup")
    assert area.checkObjectInsideArea(thing) and thing.is_near_to(middle, 1.5)
    assert not thing.is_near_to(yarp.Map2DObject("kitchen", 1.0, 1.0, 9.0), 1.5)
    path = yarp.Map2DPath([least, most])
    assert path.begin().value().isEqual(least) and path.cend() - path.cbegin() == 2
    assert path.isEqual(yarp.Map2DPath([least, most])) and path.notEqual(yarp.Map2DPath())
    assert not area.isEqual(yarp.Map2DArea()) and area.toString_c() == area.toString()
    assert not yarp.Map2DArea().findAreaBounds(least, most)


def test_raw_views_and_more_of_boards() -> None:
    driver = yarp.PolyDriver("(device fakeMotionControl)")
    board = driver.getImplementation()
    values = yarp.DVector(4)
    assert (
        yarp.IEncodersRaw(board).getEncodersRaw(values) and yarp.IEncodersRaw(board).getAxes() == 4
    )
    assert yarp.IPositionControlRaw(board).positionMoveRaw(1, 5.0)
    assert not yarp.IEncodersRaw(board).getEncoderRaw(9, values)
    board.motor_torque_parameters = [(0.0,) * 9 for _ in range(4)]
    torque, params = yarp.ITorqueControl(board), yarp.MotorTorqueParameters()
    params.bemf, params.viscousNeg = 1.5, 2.5
    again = yarp.MotorTorqueParameters()
    assert torque.setMotorTorqueParams(2, params) and torque.getMotorTorqueParams(2, again)
    assert (again.bemf, again.viscousNeg, again.ktau) == (1.5, 2.5, 0.0)
    assert not torque.getMotorTorqueParams(7, again)
    driver.close()


def test_raw_pictures_and_cameras() -> None:
    driver = yarp.PolyDriver("(device fakeFrameGrabber) (width 8) (height 4)")
    raw = yarp.IFrameGrabber(driver.getImplementation())
    buffer = bytearray(raw.getRawBufferSize())
    assert len(buffer) == 8 * 4 * 3 and raw.getRawBuffer(buffer)
    assert yarp.CameraDescriptor().busType == 0
    driver.close()
