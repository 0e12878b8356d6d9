"""Every member of the interface, over the network, by Thrift and in words."""

from functools import partial

from support.interface import Recorder, check_every_member, value
from support.wait import HANG, wait_until

import yarpy
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.kits.devices.interfaces.depth import STATES, DepthCamera
from yarpy.kits.devices.simulated.depth_camera import SimulatedDepthCamera
from yarpy.nameserver.local import LocalNames


def test_depthcamera(names: LocalNames) -> None:
    check_every_member(DepthCamera, names)
    assert len(STATES) == 7


def test_every_word(names: LocalNames) -> None:
    device = Recorder(DepthCamera)
    with (
        DepthCamera.serve("/eyes", device, 0.01, names=names),
        DepthCamera.connect("/eyes", timeout=HANG, names=names) as client,
    ):
        client._in_words = True  # type: ignore[attr-defined]  # as servers of YARP 3 are asked
        for each in DepthCamera.members.values():
            if not each.function:
                continue
            parameters = [*each.signature.parameters.values()][1:]
            given = tuple(value(one.annotation) for one in parameters)
            found = getattr(client, each.name)(*given)
            wanted = tuple(value(annotation) for annotation in each.results)
            assert found == (wanted[0] if len(wanted) == 1 else wanted or None), each.name
            assert (each.name, given) in device.told


def test_the_words_of_cpp(names: LocalNames) -> None:
    """Requests and answers of RGBDSensorClient and RgbdSensor_nws_yarp of YARP 3.9."""
    camera = SimulatedDepthCamera(64, 48)
    with (
        DepthCamera.serve("/eyes", camera, names=names),
        yarpy.RpcClient("/eyes/rpc:i", names=names) as port,
    ):

        def ask(text: str) -> Bottle:
            message = port.ask(Bottle.from_text(text), 10.0)
            assert message is not None
            return message.as_(Bottle)

        assert ask("[visr] [get] [w]") == Bottle.from_text("[visr] [w] [is] 64")
        assert ask("[visd] [get] [fov]") == Bottle.from_text("[visd] [fov] [is] 60.0 45.0")
        assert ask("[visd] [set] [fov] 70.0 50.0") == Bottle.from_text("[visd] [set] 1")
        assert ask("[visd] [set] [fov] 0.0 50.0") == Bottle.from_text("[visd] [set] 0")
        assert ask("[visd] [get] [clip]") == Bottle.from_text("[visd] [clip] [is] 0.2 10.0")
        assert ask("[visr] [get] [conf]") == [
            "visr",
            "conf",
            "is",
            1,
            64,
            48,
            30.0,
            Vocab("rgb").code,
        ]
        assert ask("[rgdb] [get] [stat]") == Bottle.from_text("[rgdb] [stat] [is] 2")
        assert ask("[fgc] [has] [feat] 0")[4:] == [1]
        assert ask("[fgc] [set] [feat] 0 0.75") == Bottle.from_text("[nak]")
        assert ask("[fgc] [get] [feat] 0") == Bottle.from_text("[fgc] [feat] [is] 0.75")
        assert ask("[fgc] [get] [feat] 7") == Bottle.from_text("[fail]")
        assert ask("[visd] [get]") == Bottle.from_text("[fail]")


def test_pictures(names: LocalNames) -> None:
    camera = SimulatedDepthCamera(64, 48, clock=lambda: 0.0)
    with (
        DepthCamera.serve("/eyes", camera, 0.01, names=names),
        DepthCamera.connect("/eyes", timeout=HANG, names=names) as client,
    ):
        wait_until(partial(_same, client, camera))
        assert client.depth().code == "dec" and client.depth().array.dtype == "float32"


def _same(client: DepthCamera, camera: SimulatedDepthCamera) -> bool:
    return client.colour() == camera.colour() and client.depth() == camera.depth()
