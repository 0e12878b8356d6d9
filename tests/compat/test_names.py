"""Names that programs of YARP 3.9.1 and 4.0.0 import: integers, priorities, maps, pixels."""

import pytest
from support.system import NO_MARKS
from support.wait import wait_until

import yarp
import yarpy


def test_integers_of_so_many_bits() -> None:
    assert yarp.NetInt32(5) == 5 and int(yarp.NetInt64(-(1 << 40))) == -(1 << 40)
    assert [1, 2, 3][yarp.NetInt16(1)] == 2
    with pytest.raises(OverflowError):
        yarp.NetInt16(40_000)


def test_qos_style() -> None:
    style = yarp.QosStyle()
    assert style.getPacketPriorityAsTOS() == -1
    assert style.setPacketPriority("LEVEL:HIGH") and style.getPacketPriorityAsDSCP() == 36
    assert style.getPacketPriorityAsLevel() == yarp.QosStyle.PacketPriorityHigh
    assert style.setPacketPriority("DSCP:AF42") and style.getPacketPriorityAsTOS() == 144
    assert style.setPacketPriority("TOS:48") and style.getPacketPriorityAsLevel() == -1
    for wrong in ("HIGH", "LEVEL:BOGUS", "TOS:-1", "TOS:300", "DSCP:"):
        assert not style.setPacketPriority(wrong), wrong
    style.setPacketPriorityByDscp(yarp.QosStyle.DSCP_EF)
    assert style.getPacketPriorityAsTOS() == 46 << 2
    assert yarp.QosStyle.getLevelByVocab(yarp.encode("CRIT")) == 44


@pytest.mark.skipif(bool(NO_MARKS), reason=NO_MARKS)
def test_priority_of_a_connection() -> None:
    yarp.Network.setLocalMode(True)
    out, into = yarp.Port(), yarp.BufferedPortBottle()
    try:
        assert into.open("/qos/in") and out.open("/qos/out")
        style, begin, end = yarp.QosStyle(), yarp.QosStyle(), yarp.QosStyle()
        style.setPacketPriority("LEVEL:LOW")
        assert not yarp.Network.setConnectionQos("/qos/out", "/qos/in", style)
        wait_until(lambda: yarp.Network.connect("/qos/out", "/qos/in", "tcp"))
        wait_until(lambda: yarp.Network.setConnectionQos("/qos/out", "/qos/in", style))
        wait_until(lambda: yarp.Network.getConnectionQos("/qos/out", "/qos/in", begin, end))
        assert begin.getPacketPriorityAsLevel() == yarp.QosStyle.PacketPriorityLow
    finally:
        out.close()
        into.close()
        yarp.Network.setLocalMode(False)


def test_map() -> None:
    grid = yarp.MapGrid2D()
    assert grid.setSize_in_cells(4, 3) and (grid.width(), grid.height()) == (4, 3)
    assert grid.setMapFlag((1, 2), grid.MAP_CELL_WALL) and grid.isWall((1, 2))
    assert grid.setOccupancyData((1, 2), 80) and grid.getOccupancyData((1, 2)) == 80.0
    assert grid.getOccupancyData((0, 0)) == -1.0 and not grid.setMapFlag((4, 0), 0)
    assert grid.getMapFlag((9, 9)) == -1 and not grid.isNotFree((9, 9))
    assert grid.setMapName("kitchen") and grid.setResolution(0.5) and grid.setOrigin(1, 2, 90)
    again = yarp.MapGrid2D()
    assert yarp.Portable.copyPortable(grid, again) and again.isIdenticalTo(grid)
    assert again.setMapFlag((0, 0), grid.MAP_CELL_TEMPORARY_OBSTACLE)
    again.clearMapTemporaryFlags()
    assert again.isFree((0, 0)) and again.getMapName() == "kitchen"


def test_a_map_from_a_server_of_maps() -> None:
    maps = yarp.PolyDriver("(device map2DStorage)")
    view = maps.viewIMap2D()
    grid, found = yarp.MapGrid2D(), yarp.MapGrid2D()
    grid.setMapName("kitchen")
    assert view.store_map(grid) and view.get_map("kitchen", found)
    assert found.isIdenticalTo(grid)
    maps.close()


def test_result_of_a_call() -> None:
    good, bad = yarp.ReturnValue(True), yarp.ReturnValue(False)
    assert good and not bad and good == True and bad.toString() == "it failed"  # noqa: E712
    assert not yarp.ReturnValue() and yarp.ReturnValue(good) == good
    again = yarp.ReturnValue()
    assert yarp.Portable.copyPortable(good, again) and again
    wire = yarpy.Bottle([yarpy.Vocab("err5")]).to_bytes()
    again._take(yarpy.Message("D", wire))
    assert again.isEqual(
        yarp.ReturnValue(yarp.ReturnValue.return_code_return_value_error_method_failed)
    )


def test_pixels_rows_and_vectors() -> None:
    pixel = yarp.PixelBgr(1, 2, 3)
    assert (pixel.r, pixel.b) == (3, 1) and yarp.PixelHsvFloat().v == 0.0
    one, other = yarp.ImageRgb(), yarp.ImageRgb()
    for image in (one, other):
        image.resize(3, 2)
        image.zero()
    one.pixel(1, 1).g = 7
    assert one.getRow(1) == bytes([0, 0, 0, 0, 7, 0, 0, 0, 0]) and not one.isEqual(other)
    other.pixel(1, 1).g = 7
    assert one.isEqual(other)
    with pytest.raises(IndexError):
        one.getRow(2)
    numbers = yarp.DVector([1.0, 2.0, 3.0])
    assert numbers.erase(numbers.begin()) == 0 and [*numbers] == [2.0, 3.0]
    numbers.insert(numbers.end(), 4)
    assert [*numbers] == [2.0, 3.0, 4.0]


def test_devices() -> None:
    factory = yarp.Drivers.factory()
    assert factory.find("remote_controlboard") and factory.find("bogus") is None
    assert "'fakeDepthCamera'" in factory.toString()
    driver = factory.open("(device fakeBattery)")
    assert driver.isValid() and factory.open("(device bogus)") is None
    driver.close()
    device = yarp.DeviceDriver()
    device.setId("arm")
    assert device.id() == "arm" and device.getImplementation() is device and device.open()


def test_constants_of_enumerations() -> None:
    assert yarp.ControlModeEnum_VOCAB_CM_TORQUE == yarp.VOCAB_CM_TORQUE == yarp.encode("torq")
    assert yarp.cameraFeature_id_t_YARP_FEATURE_GAIN == 8
    assert yarp.navigation_status_moving == yarp.encode("movg")
