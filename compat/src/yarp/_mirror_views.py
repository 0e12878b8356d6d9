"""The views of a PolyDriver beyond those of boards and cameras."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from yarp._controller_view import ICartesianControl
from yarp._device_view import IAnalogSensor, IControlDebug, IFrameWriterImage, IJointCoupling
from yarp._firewire_view import IFrameGrabberControlsDC1394
from yarp._gaze_view import IGazeControl
from yarp._mirror import (
    ILLM,
    ILocalization2D,
    IMap2D,
    IOdometry2D,
    IRGBDSensor,
    ISimulatedWorld,
    ISpeechSynthesizer,
    ISpeechTranscription,
)
from yarp._navigation_view import INavigation2D
from yarp._place_view import IBattery, IFrameTransform
from yarp._sensor_view import (
    IContactLoadCellArrays,
    IEncoderArrays,
    IOrientationSensors,
    IPositionSensors,
    ISixAxisForceTorqueSensors,
    ISkinPatches,
    ITemperatureSensors,
    IThreeAxisGyroscopes,
    IThreeAxisLinearAccelerometers,
    IThreeAxisMagnetometers,
)

V = TypeVar("V")


class MirrorViews:
    """The views that a PolyDriver has."""

    def _view(self, kind: Callable[[Any], V], member: str) -> V | None:
        raise NotImplementedError

    def viewICartesianControl(self) -> ICartesianControl | None:
        return self._view(ICartesianControl, "solve")

    def viewIGazeControl(self) -> IGazeControl | None:
        return self._view(IGazeControl, "look_at_pixel")

    def viewILocalization2D(self) -> ILocalization2D | None:
        return self._view(ILocalization2D, "localization_status")

    def viewIMap2D(self) -> IMap2D | None:
        return self._view(IMap2D, "map_names")

    def viewINavigation2D(self) -> INavigation2D | None:
        return self._view(INavigation2D, "go")

    def viewIOdometry2D(self) -> IOdometry2D | None:
        return self._view(IOdometry2D, "odometry")

    def viewISpeechSynthesizer(self) -> ISpeechSynthesizer | None:
        return self._view(ISpeechSynthesizer, "synthesize")

    def viewISpeechTranscription(self) -> ISpeechTranscription | None:
        return self._view(ISpeechTranscription, "transcribe")

    def viewIRGBDSensor(self) -> IRGBDSensor | None:
        return self._view(IRGBDSensor, "depth")

    def viewILLM(self) -> ILLM | None:
        return self._view(ILLM, "conversation")

    def viewISimulatedWorld(self) -> ISimulatedWorld | None:
        return self._view(ISimulatedWorld, "make_box")

    def viewIBattery(self) -> IBattery | None:
        return self._view(IBattery, "charge")

    def viewIFrameTransform(self) -> IFrameTransform | None:
        found: IFrameTransform | None = self._view(IFrameTransform, "place")
        return found if self._view(IFrameTransform, "frames") is not None else None

    def viewIThreeAxisGyroscopes(self) -> IThreeAxisGyroscopes | None:
        return self._view(IThreeAxisGyroscopes, IThreeAxisGyroscopes.kind)

    def viewIThreeAxisLinearAccelerometers(self) -> IThreeAxisLinearAccelerometers | None:
        return self._view(IThreeAxisLinearAccelerometers, IThreeAxisLinearAccelerometers.kind)

    def viewIThreeAxisMagnetometers(self) -> IThreeAxisMagnetometers | None:
        return self._view(IThreeAxisMagnetometers, IThreeAxisMagnetometers.kind)

    def viewIOrientationSensors(self) -> IOrientationSensors | None:
        return self._view(IOrientationSensors, IOrientationSensors.kind)

    def viewITemperatureSensors(self) -> ITemperatureSensors | None:
        return self._view(ITemperatureSensors, ITemperatureSensors.kind)

    def viewISixAxisForceTorqueSensors(self) -> ISixAxisForceTorqueSensors | None:
        return self._view(ISixAxisForceTorqueSensors, ISixAxisForceTorqueSensors.kind)

    def viewIPositionSensors(self) -> IPositionSensors | None:
        return self._view(IPositionSensors, IPositionSensors.kind)

    def viewIContactLoadCellArrays(self) -> IContactLoadCellArrays | None:
        return self._view(IContactLoadCellArrays, IContactLoadCellArrays.kind)

    def viewIEncoderArrays(self) -> IEncoderArrays | None:
        return self._view(IEncoderArrays, IEncoderArrays.kind)

    def viewISkinPatches(self) -> ISkinPatches | None:
        return self._view(ISkinPatches, ISkinPatches.kind)

    def viewIAnalogSensor(self) -> IAnalogSensor | None:
        return self._view(IAnalogSensor, "channels")

    def viewIJointCoupling(self) -> IJointCoupling | None:
        return self._view(IJointCoupling, "coupled_joints")

    def viewIFrameWriterImage(self) -> IFrameWriterImage | None:
        return self._view(IFrameWriterImage, "show")

    def viewIControlDebug(self) -> IControlDebug | None:
        return self._view(IControlDebug, "load_boot_memory")

    def viewIFrameGrabberControlsDC1394(self) -> IFrameGrabberControlsDC1394 | None:
        return self._view(IFrameGrabberControlsDC1394, "firewire")
